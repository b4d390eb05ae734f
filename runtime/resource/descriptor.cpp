#include "runtime/resource/descriptor.h"

#include <algorithm>
#include <optional>

#include "spirv_interp/needs_descriptor.h"

namespace vernier {
namespace {

/// Inline uniform blocks begin where scalars of any width may.
constexpr uint32_t kBlockAlignment = 16;

bool isDynamic(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

uint32_t clampSize(VkDeviceSize size) {
    return static_cast<uint32_t>(std::min<VkDeviceSize>(size, kMaxBufferBytes));
}

enum class Table : uint8_t { buffers, images, samplers };

Table tableOf(ir::ResourceKind kind) {
    switch (kind) {
        case ir::ResourceKind::uniformBuffer:
        case ir::ResourceKind::storageBuffer:
        case ir::ResourceKind::pushConstants:
            return Table::buffers;
        case ir::ResourceKind::sampler:
            return Table::samplers;
        default:
            return Table::images;
    }
}

/// The sampler with no more than `accuracy` allows: itself, or another one in the arena.
const SamplerState* limitSampler(const SamplerState* sampler, const Accuracy& accuracy, Arena& arena) {
    const auto most = static_cast<float>(accuracy.anisotropy);
    if (sampler == nullptr || !(sampler->maxAnisotropy > most)) return sampler;
    SamplerState* const limited = arena.create(*sampler);
    limited->maxAnisotropy = most;
    return limited;
}

const TextureUnit& limitUnit(const TextureUnit& unit, const Accuracy& accuracy, Arena& arena) {
    const SamplerState* const sampler = limitSampler(unit.sampler, accuracy, arena);
    if (sampler == unit.sampler) return unit;
    const Result<TextureUnit> limited = makeTextureUnit(unit.view, sampler, unit.isa);
    return limited ? *arena.create(*limited) : unit;
}

/// The layer of the attachment at which the view begins; empty where it is of other memory.
std::optional<uint32_t> firstLayerIn(const ImageView& attachment, const TextureView& view) {
    const TextureView& whole = attachment.texture();
    const auto from = reinterpret_cast<uintptr_t>(whole.levels[0].data);
    const auto to = reinterpret_cast<uintptr_t>(view.levels[0].data);
    const uint64_t pitch = whole.levels[0].slicePitch;
    if (to < from || (to - from) % pitch != 0 || (to - from) / pitch >= whole.layerCount) return std::nullopt;
    return static_cast<uint32_t>((to - from) / pitch);
}

/// An input attachment as the pass sees it. The descriptor may have another view of the attachment than the pass, of
/// one of its aspects, say.
const TextureUnit& inputUnit(const TextureUnit& unit, std::span<const SampledInput> inputs, Arena& arena) {
    if (unit.view == nullptr) return unit;
    for (const SampledInput& input : inputs) {
        const std::optional<uint32_t> layer = firstLayerIn(*input.single, *unit.view);
        if (!layer) continue;
        const TextureView& samples = input.samples->texture();
        TextureView* const view = arena.create(*unit.view);
        view->samples = samples.samples;
        view->samplePitch = samples.samplePitch;
        view->levels[0].rowPitch = samples.levels[0].rowPitch;
        view->levels[0].slicePitch = samples.levels[0].slicePitch;
        view->levels[0].data = samples.levels[0].data + *layer * samples.levels[0].slicePitch;
        const Result<TextureUnit> made = makeTextureUnit(view, nullptr, unit.isa);
        return made ? *arena.create(*made) : unit;
    }
    return unit;
}

}  // namespace

DescriptorSetLayout DescriptorSetLayout::create(std::vector<DescriptorBinding> bindings) {
    std::sort(bindings.begin(), bindings.end(), [](const auto& a, const auto& b) { return a.binding < b.binding; });
    DescriptorSetLayout layout;
    for (DescriptorBinding& binding : bindings) {
        binding.firstSlot = layout.slotCount;
        layout.slotCount += binding.count;
        binding.firstDynamic = layout.dynamicCount;
        if (isDynamic(binding.type)) layout.dynamicCount += binding.count;
        binding.blockOffset = layout.blockBytes;
        layout.blockBytes += (binding.blockBytes + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
        layout.mayChange = layout.mayChange || binding.mayChange;
    }
    layout.bindings = std::move(bindings);
    return layout;
}

const DescriptorBinding* DescriptorSetLayout::find(uint32_t binding) const {
    const auto found = std::lower_bound(bindings.begin(), bindings.end(), binding,
                                        [](const DescriptorBinding& b, uint32_t number) { return b.binding < number; });
    return found != bindings.end() && found->binding == binding ? &*found : nullptr;
}

DescriptorSet::DescriptorSet(const DescriptorSetLayout& layout, uint32_t variableCount)
    : layout_(&layout), variableCount_(variableCount) {
    uint32_t slots = layout.slotCount;
    bool keeping = false;
    for (const DescriptorBinding& binding : layout.bindings) {
        // The binding that is variable is the last one.
        if (binding.variable) slots = binding.firstSlot + countOf(binding);
        keeping = keeping || binding.mayBeInvalid;
    }
    slots_.resize(slots);
    if (keeping) kept_.resize(slots);
    if (layout.mayChange) mutex_ = std::make_unique<std::mutex>();
    if (layout.blockBytes != 0) blocks_.resize((layout.blockBytes + Memory::kSlack) / sizeof(uint64_t));
    for (const DescriptorBinding& binding : layout.bindings) {
        const uint32_t samplers = std::min<uint32_t>(countOf(binding), binding.immutableSamplers.size());
        for (uint32_t i = 0; i < samplers; ++i) slots_[binding.firstSlot + i].sampler = binding.immutableSamplers[i];
        if (const std::span<std::byte> bytes = block(binding); !bytes.empty())
            slots_[binding.firstSlot].buffer = {bytes.data(), static_cast<uint32_t>(bytes.size())};
    }
}

uint32_t DescriptorSet::countOf(const DescriptorBinding& binding) const {
    const bool block = binding.type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
    return binding.variable && !block ? std::min(binding.count, variableCount_) : binding.count;
}

std::span<std::byte> DescriptorSet::block(const DescriptorBinding& binding) {
    const uint32_t bytes = binding.variable ? std::min(binding.blockBytes, variableCount_) : binding.blockBytes;
    if (bytes == 0) return {};
    return {reinterpret_cast<std::byte*>(blocks_.data()) + binding.blockOffset, bytes};
}

std::unique_lock<std::mutex> DescriptorSet::lock() const {
    return mutex_ ? std::unique_lock(*mutex_) : std::unique_lock<std::mutex>();
}

bool DescriptorSet::keeps(uint32_t slot) const {
    if (kept_.empty()) return false;
    const auto after =
        std::upper_bound(layout_->bindings.begin(), layout_->bindings.end(), slot,
                         [](uint32_t number, const DescriptorBinding& binding) { return number < binding.firstSlot; });
    return after != layout_->bindings.begin() && std::prev(after)->mayBeInvalid;
}

void DescriptorSet::keep(uint32_t slot) {
    if (kept_.empty()) kept_.resize(slots_.size());
    if (kept_[slot] == nullptr) kept_[slot] = std::make_unique<Kept>();
    Kept& kept = *kept_[slot];
    const auto take = [](auto& pointer, auto& copy) {
        if (pointer == nullptr) return;
        copy = *pointer;
        pointer = &copy;
    };
    Descriptor& descriptor = slots_[slot];
    take(descriptor.texture.view, kept.view);
    if (descriptor.texture.view != nullptr && kept.view.planar != nullptr) {
        if (kept.planes == nullptr) kept.planes = std::make_unique<PlanarView>();
        *kept.planes = *kept.view.planar;
        kept.view.planar = kept.planes.get();
    }
    take(descriptor.texture.sampler, kept.sampler);
    take(descriptor.sampler, kept.sampler);
}

Status DescriptorSet::copySlot(uint32_t slot, const DescriptorSet& from, uint32_t fromSlot,
                               const SamplerState* immutable, Isa isa) {
    const bool keptThere = fromSlot < from.kept_.size() && from.kept_[fromSlot] != nullptr;
    Status status;
    if (immutable != nullptr) {
        status = writeImage(slot, from.slots_[fromSlot].texture.view, immutable, isa);
    } else {
        slots_[slot] = from.slots_[fromSlot];
    }
    // What the other set keeps goes with it.
    if (keptThere || keeps(slot)) keep(slot);
    return status;
}

void DescriptorSet::writeBuffer(uint32_t slot, const Buffer* buffer, VkDeviceSize offset, VkDeviceSize range) {
    Descriptor& descriptor = slots_[slot];
    descriptor.buffer = {};
    descriptor.bufferBytesLeft = 0;
    if (!buffer || !buffer->data() || offset > buffer->size()) return;
    descriptor.bufferBytesLeft = buffer->size() - offset;
    descriptor.buffer = {buffer->data() + offset, clampSize(std::min(range, descriptor.bufferBytesLeft))};
}

Status DescriptorSet::writeImage(uint32_t slot, const TextureView* view, const SamplerState* sampler, Isa isa) {
    Descriptor& descriptor = slots_[slot];
    descriptor.sampler = sampler;
    descriptor.texture = {};
    Result<TextureUnit> unit = makeTextureUnit(view, sampler, isa);
    if (unit) {
        descriptor.texture = *unit;
    } else if (const Result<TextureUnit> fetched = makeTextureUnit(view, nullptr, isa)) {
        descriptor.texture = *fetched;  // fetches do not mind a sampler that does not go with the view
    }
    if (keeps(slot)) keep(slot);
    return unit ? Status() : unit.error();
}

void DescriptorSet::writeTexelBuffer(uint32_t slot, const TextureView* view, Isa isa) {
    slots_[slot].texture = makeTexelBufferUnit(view, isa);
    if (keeps(slot)) keep(slot);
}

BoundDescriptorRange findDescriptors(const ir::Resource& resource, const BoundDescriptors& bound) {
    if (resource.set >= std::size(bound.sets) || !bound.sets[resource.set]) return {};
    const DescriptorSet& set = *bound.sets[resource.set];
    const DescriptorBinding* binding = set.layout().find(resource.binding);
    if (!binding) return {};
    const uint32_t has = set.countOf(*binding);
    const uint32_t count = resource.arraySize ? std::min(resource.arraySize, has) : has;
    return {set.slots().subspan(binding->firstSlot, count), binding, bound.dynamicOffsets[resource.set], set.lock()};
}

BufferBinding boundBuffer(const BoundDescriptorRange& found, uint32_t index) {
    const Descriptor& descriptor = found.slots[index];
    const uint32_t dynamic = found.binding->firstDynamic + index;
    if (!isDynamic(found.binding->type) || dynamic >= found.dynamicOffsets.size()) return descriptor.buffer;
    const VkDeviceSize offset = std::min<VkDeviceSize>(found.dynamicOffsets[dynamic], descriptor.bufferBytesLeft);
    return {descriptor.buffer.data + offset,
            clampSize(std::min<VkDeviceSize>(descriptor.buffer.size, descriptor.bufferBytesLeft - offset))};
}

ResourceBindings resolveBindings(const ir::Program& program, const BoundDescriptors& bound, const Accuracy& accuracy,
                                 Arena& arena) {
    const size_t resources = program.resources.size();
    const std::span<uint32_t> base = arena.array<uint32_t>(resources);
    const std::span<uint32_t> count = arena.array<uint32_t>(resources);
    uint32_t sizes[3] = {};
    for (size_t r = 0; r < resources; ++r) {
        const ir::Resource& resource = program.resources[r];
        uint32_t& size = sizes[static_cast<size_t>(tableOf(resource.kind))];
        base[r] = size;
        count[r] = needsDescriptor(resource) ? static_cast<uint32_t>(findDescriptors(resource, bound).slots.size())
                   : resource.kind == ir::ResourceKind::pushConstants ? 1
                                                                      : 0;
        size += count[r];
    }
    const std::span<BufferBinding> buffers = arena.array<BufferBinding>(sizes[0]);
    const std::span<ImageBinding> images = arena.array<ImageBinding>(sizes[1]);
    const std::span<const void*> samplers = arena.array<const void*>(sizes[2]);
    for (size_t r = 0; r < resources; ++r) {
        const ir::Resource& resource = program.resources[r];
        if (resource.kind == ir::ResourceKind::pushConstants) {
            // Programs only read push constants; the binding type is shared with storage buffers.
            buffers[base[r]] = {const_cast<std::byte*>(bound.pushConstants.data()),
                                static_cast<uint32_t>(bound.pushConstants.size())};
            continue;
        }
        if (count[r] == 0) continue;
        const BoundDescriptorRange found = findDescriptors(resource, bound);
        for (uint32_t i = 0; i < count[r]; ++i) {
            switch (tableOf(resource.kind)) {
                case Table::buffers:
                    buffers[base[r] + i] = boundBuffer(found, i);
                    break;
                case Table::images:
                    images[base[r] + i] = bindingOf(resource.kind == ir::ResourceKind::inputAttachment
                                                        ? inputUnit(found.slots[i].texture, bound.sampledInputs, arena)
                                                        : limitUnit(found.slots[i].texture, accuracy, arena));
                    break;
                case Table::samplers:
                    samplers[base[r] + i] = limitSampler(found.slots[i].sampler, accuracy, arena);
                    break;
            }
        }
    }
    return {buffers.data(), images.data(), samplers.data(), base.data(), count.data(), combineBinding};
}

}  // namespace vernier
