// Writing and copying descriptors, directly and through templates (VK_KHR_descriptor_update_template).
#include <algorithm>
#include <cstring>
#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "runtime/resource/buffer_view.h"
#include "runtime/resource/image.h"

namespace vernier::vulkan {
namespace {

/// A slot of a set and the binding it belongs to. Slots of consecutive bindings are neighbours, so that
/// updates run over from one binding into the next by counting on ("consecutive binding updates").
class SlotCursor {
  public:
    SlotCursor(const DescriptorSet& set, uint32_t binding, uint32_t element)
        : set_(set), binding_(set.layout().find(binding)), element_(element) {
        settle();
    }

    bool valid() const { return binding_ != nullptr; }
    uint32_t slot() const { return binding_->firstSlot + element_; }
    VkDescriptorType type() const { return binding_->type; }
    const SamplerState* immutableSampler() const {
        return binding_->immutableSamplers.empty() ? nullptr : binding_->immutableSamplers[element_];
    }
    void next() {
        ++element_;
        settle();
    }

  private:
    void settle() {
        const std::vector<DescriptorBinding>& all = set_.layout().bindings;
        while (binding_ != nullptr && element_ >= set_.countOf(*binding_)) {
            element_ -= set_.countOf(*binding_);
            ++binding_;
            if (binding_ == all.data() + all.size()) binding_ = nullptr;
        }
    }

    const DescriptorSet& set_;
    const DescriptorBinding* binding_;
    uint32_t element_;
};

const TextureView* textureOf(VkImageView view) {
    return view != VK_NULL_HANDLE ? &object(view)->texture() : nullptr;
}

const TextureView* texelsOf(VkBufferView view) {
    return view != VK_NULL_HANDLE ? &object(view)->texture() : nullptr;
}

void writeOne(const Device& device, DescriptorSet& set, const SlotCursor& cursor, const void* source) {
    const auto& image = *static_cast<const VkDescriptorImageInfo*>(source);
    const auto& buffer = *static_cast<const VkDescriptorBufferInfo*>(source);
    const Isa isa = device.runtime->isa();
    const SamplerState* immutable = cursor.immutableSampler();
    Status status;
    switch (cursor.type()) {
        case VK_DESCRIPTOR_TYPE_SAMPLER:
            status =
                set.writeImage(cursor.slot(), nullptr, immutable != nullptr ? immutable : object(image.sampler), isa);
            break;
        case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
            status = set.writeImage(cursor.slot(), textureOf(image.imageView),
                                    immutable != nullptr ? immutable : object(image.sampler), isa);
            break;
        case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
        case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
        case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
            status = set.writeImage(cursor.slot(), textureOf(image.imageView), nullptr, isa);
            break;
        case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
        case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
            set.writeTexelBuffer(cursor.slot(), texelsOf(*static_cast<const VkBufferView*>(source)), isa);
            break;
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
            set.writeBuffer(cursor.slot(), object(buffer.buffer), buffer.offset, buffer.range);
            break;
        default:
            break;  // layouts with other types cannot be made
    }
    if (!status) (void)device.report("vkUpdateDescriptorSets", status.error());
}

/// The types must agree: a source of another type would be read as what it is not.
bool matches(const SlotCursor& cursor, VkDescriptorType type) {
    return cursor.valid() && cursor.type() == type;
}

/// Element `i` of the array that the descriptor type reads; nullptr when the array is.
const void* sourceOf(const VkWriteDescriptorSet& info, uint32_t i) {
    const auto element = [i](const auto* array) -> const void* { return array != nullptr ? array + i : nullptr; };
    switch (info.descriptorType) {
        case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
        case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
            return element(info.pTexelBufferView);
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
            return element(info.pBufferInfo);
        default:
            return element(info.pImageInfo);
    }
}

/// The bytes of an inline uniform block from `first` on, as many as there are of `count`.
std::span<std::byte> blockBytes(DescriptorSet& set, uint32_t binding, uint32_t first, uint32_t count) {
    const DescriptorBinding* found = set.layout().find(binding);
    if (found == nullptr || found->type != VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) return {};
    const std::span<std::byte> bytes = set.block(*found);
    if (first > bytes.size()) return {};
    return bytes.subspan(first, std::min<size_t>(count, bytes.size() - first));
}

void writeBlock(DescriptorSet& set, const VkWriteDescriptorSet& info) {
    const auto* data = findInChain<VkWriteDescriptorSetInlineUniformBlock>(info.pNext);
    if (data == nullptr) return;
    const auto to =
        blockBytes(set, info.dstBinding, info.dstArrayElement, std::min(info.descriptorCount, data->dataSize));
    if (!to.empty()) std::memcpy(to.data(), data->pData, to.size());
}

void write(const Device& device, DescriptorSet& set, const VkWriteDescriptorSet& info) {
    if (info.descriptorType == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) return writeBlock(set, info);
    SlotCursor cursor(set, info.dstBinding, info.dstArrayElement);
    for (uint32_t i = 0; i < info.descriptorCount && matches(cursor, info.descriptorType); ++i, cursor.next()) {
        if (const void* source = sourceOf(info, i)) writeOne(device, set, cursor, source);
    }
}

void copy(const Device& device, const VkCopyDescriptorSet& info) {
    DescriptorSet& source = object(info.srcSet)->set;
    DescriptorSet& destination = object(info.dstSet)->set;
    const auto fromBytes = blockBytes(source, info.srcBinding, info.srcArrayElement, info.descriptorCount);
    const auto toBytes = blockBytes(destination, info.dstBinding, info.dstArrayElement, info.descriptorCount);
    const std::unique_lock lock = destination.lock();
    if (const size_t bytes = std::min(fromBytes.size(), toBytes.size()); bytes != 0)
        return static_cast<void>(std::memmove(toBytes.data(), fromBytes.data(), bytes));
    SlotCursor from(source, info.srcBinding, info.srcArrayElement);
    SlotCursor to(destination, info.dstBinding, info.dstArrayElement);
    for (uint32_t i = 0; i < info.descriptorCount && from.valid() && matches(to, from.type()); ++i) {
        if (from.type() == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) return;
        const Status status =
            destination.copySlot(to.slot(), source, from.slot(), to.immutableSampler(), device.runtime->isa());
        if (!status) (void)device.report("vkUpdateDescriptorSets", status.error());
        from.next();
        to.next();
    }
}

}  // namespace

void writeDescriptors(const Device& device, DescriptorSet& set, uint32_t count, const VkWriteDescriptorSet* writes) {
    for (uint32_t i = 0; i < count; ++i) write(device, set, writes[i]);
}

void writeDescriptors(const Device& device, DescriptorSet& set, const DescriptorUpdateTemplate& entries,
                      const void* data) {
    for (const VkDescriptorUpdateTemplateEntry& entry : entries.entries) {
        const auto* source = static_cast<const std::byte*>(data) + entry.offset;
        if (entry.descriptorType == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) {
            const auto to = blockBytes(set, entry.dstBinding, entry.dstArrayElement, entry.descriptorCount);
            if (!to.empty()) std::memcpy(to.data(), source, to.size());
            continue;
        }
        SlotCursor cursor(set, entry.dstBinding, entry.dstArrayElement);
        for (uint32_t i = 0; i < entry.descriptorCount && matches(cursor, entry.descriptorType); ++i) {
            writeOne(device, set, cursor, source + i * entry.stride);
            cursor.next();
        }
    }
}

VKAPI_ATTR void VKAPI_CALL UpdateDescriptorSets(VkDevice device, uint32_t descriptorWriteCount,
                                                const VkWriteDescriptorSet* pDescriptorWrites,
                                                uint32_t descriptorCopyCount,
                                                const VkCopyDescriptorSet* pDescriptorCopies) {
    (void)guarded([&] {
        for (uint32_t i = 0; i < descriptorWriteCount; ++i) {
            DescriptorSet& set = object(pDescriptorWrites[i].dstSet)->set;
            const std::unique_lock lock = set.lock();
            write(*object(device), set, pDescriptorWrites[i]);
        }
        for (uint32_t i = 0; i < descriptorCopyCount; ++i) copy(*object(device), pDescriptorCopies[i]);
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDescriptorUpdateTemplate(VkDevice,
                                                              const VkDescriptorUpdateTemplateCreateInfo* pCreateInfo,
                                                              const VkAllocationCallbacks* pAllocator,
                                                              VkDescriptorUpdateTemplate* pDescriptorUpdateTemplate) {
    return guarded([&] {
        const auto* first = pCreateInfo->pDescriptorUpdateEntries;
        return createHandle(pAllocator, pDescriptorUpdateTemplate,
                            std::vector(first, first + pCreateInfo->descriptorUpdateEntryCount),
                            pCreateInfo->pipelineBindPoint);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyDescriptorUpdateTemplate(VkDevice,
                                                           VkDescriptorUpdateTemplate descriptorUpdateTemplate,
                                                           const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, descriptorUpdateTemplate);
}

VKAPI_ATTR void VKAPI_CALL UpdateDescriptorSetWithTemplate(VkDevice device, VkDescriptorSet descriptorSet,
                                                           VkDescriptorUpdateTemplate descriptorUpdateTemplate,
                                                           const void* pData) {
    (void)guarded([&] {
        DescriptorSet& set = object(descriptorSet)->set;
        const std::unique_lock lock = set.lock();
        writeDescriptors(*object(device), set, *object(descriptorUpdateTemplate), pData);
        return VK_SUCCESS;
    });
}

}  // namespace vernier::vulkan
