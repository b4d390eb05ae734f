#include "runtime/resource/descriptor.h"

#include <algorithm>

namespace vernier {
namespace {

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

}  // namespace

DescriptorSetLayout DescriptorSetLayout::create(std::vector<DescriptorBinding> bindings) {
    std::sort(bindings.begin(), bindings.end(), [](const auto& a, const auto& b) { return a.binding < b.binding; });
    DescriptorSetLayout layout;
    for (DescriptorBinding& binding : bindings) {
        binding.firstSlot = layout.slotCount;
        layout.slotCount += binding.count;
        binding.firstDynamic = layout.dynamicCount;
        if (isDynamic(binding.type)) layout.dynamicCount += binding.count;
    }
    layout.bindings = std::move(bindings);
    return layout;
}

const DescriptorBinding* DescriptorSetLayout::find(uint32_t binding) const {
    const auto found = std::lower_bound(bindings.begin(), bindings.end(), binding,
                                        [](const DescriptorBinding& b, uint32_t number) { return b.binding < number; });
    return found != bindings.end() && found->binding == binding ? &*found : nullptr;
}

DescriptorSet::DescriptorSet(const DescriptorSetLayout& layout) : layout_(&layout), slots_(layout.slotCount) {
    for (const DescriptorBinding& binding : layout.bindings)
        for (uint32_t i = 0; i < binding.immutableSamplers.size(); ++i)
            slots_[binding.firstSlot + i].sampler = binding.immutableSamplers[i];
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
    if (!unit) return unit.error();
    descriptor.texture = *unit;
    return {};
}

void DescriptorSet::writeTexelBuffer(uint32_t slot, const TextureView* view, Isa isa) {
    slots_[slot].texture = makeTexelBufferUnit(view, isa);
}

BoundDescriptorRange findDescriptors(const ir::Resource& resource, const BoundDescriptors& bound) {
    if (resource.set >= std::size(bound.sets) || !bound.sets[resource.set]) return {};
    const DescriptorSet& set = *bound.sets[resource.set];
    const DescriptorBinding* binding = set.layout().find(resource.binding);
    if (!binding) return {};
    const uint32_t count = resource.arraySize ? std::min(resource.arraySize, binding->count) : binding->count;
    return {set.slots().subspan(binding->firstSlot, count), binding, bound.dynamicOffsets[resource.set]};
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
        count[r] = resource.kind == ir::ResourceKind::pushConstants ? 1
                   : resource.kind == ir::ResourceKind::workgroupMemory
                       ? 0  // the work-group's context owns it
                       : static_cast<uint32_t>(findDescriptors(resource, bound).slots.size());
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
                    images[base[r] + i] = bindingOf(limitUnit(found.slots[i].texture, accuracy, arena));
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
