// Descriptor set layouts, pools, sets and update templates.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "api/vulkan/handle.h"
#include "runtime/limits.h"
#include "runtime/resource/descriptor.h"

namespace vernier::vulkan {

/// Shared with the sets made from it: a layout may be destroyed before them.
struct DescriptorSetLayoutObject {
    explicit DescriptorSetLayoutObject(std::shared_ptr<const DescriptorSetLayout> made) : layout(std::move(made)) {}
    std::shared_ptr<const DescriptorSetLayout> layout;
};

/// Sets are resolved by (set, binding) when a draw runs: the layouts are kept for push descriptors alone.
struct PipelineLayout {
    std::array<std::shared_ptr<const DescriptorSetLayout>, kMaxDescriptorSets> sets;
};

struct DescriptorSetObject {
    DescriptorSetObject(std::shared_ptr<const DescriptorSetLayout> of, uint32_t count)
        : layout(std::move(of)), variableCount(count), set(*layout, count) {}
    std::shared_ptr<const DescriptorSetLayout> layout;
    uint32_t variableCount;
    DescriptorSet set;
};

/// The types of core 1.0 by number, and inline uniform blocks.
inline constexpr size_t kInlineBlocks = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT + 1;
inline constexpr size_t kDescriptorTypeCount = kInlineBlocks + 1;
/// The place of a type among these; kDescriptorTypeCount or more for others.
constexpr size_t placeOf(VkDescriptorType type) {
    if (type == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK) return kInlineBlocks;
    return type < kInlineBlocks ? static_cast<size_t>(type) : kDescriptorTypeCount;
}

struct DescriptorPool {
    DescriptorPool(const VkAllocationCallbacks* given, const VkDescriptorPoolCreateInfo& info);
    ~DescriptorPool();

    /// VK_ERROR_OUT_OF_POOL_MEMORY when the pool's counts do not allow another set of this layout.
    VkResult allocate(const std::shared_ptr<const DescriptorSetLayout>& layout, uint32_t variableCount,
                      VkDescriptorSet* out);
    void free(DescriptorSetObject* set);
    void reset();

  private:
    bool hasCallbacks_;
    VkAllocationCallbacks callbacks_{};
    const VkAllocationCallbacks* callbacks() const { return hasCallbacks_ ? &callbacks_ : nullptr; }

    /// Descriptors by type, of inline uniform blocks the bytes; and the number of these blocks. Sums over any number of
    /// pool sizes and bindings.
    struct Counts {
        std::array<uint64_t, kDescriptorTypeCount> of{};
        uint64_t blocks = 0;
        bool take(const Counts& wanted);
        void put(const Counts& back);
    };
    static Counts countsOf(const DescriptorSetLayout& layout, uint32_t variableCount);

    uint32_t setsLeft_;
    Counts left_;
    std::vector<DescriptorSetObject*> sets_;
};

struct DescriptorUpdateTemplate {
    DescriptorUpdateTemplate(std::vector<VkDescriptorUpdateTemplateEntry> given, VkPipelineBindPoint of)
        : entries(std::move(given)), bindPoint(of) {}
    std::vector<VkDescriptorUpdateTemplateEntry> entries;
    VkPipelineBindPoint bindPoint;  // of push descriptors
};

/// Writes that name no set, into this one (descriptor_update.cpp).
void writeDescriptors(const Device& device, DescriptorSet& set, uint32_t count, const VkWriteDescriptorSet* writes);
void writeDescriptors(const Device& device, DescriptorSet& set, const DescriptorUpdateTemplate& entries,
                      const void* data);

}  // namespace vernier::vulkan
