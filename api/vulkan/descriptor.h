// Descriptor set layouts, pools, sets and update templates.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "api/vulkan/handle.h"
#include "runtime/resource/descriptor.h"

namespace vernier::vulkan {

/// Shared with the sets made from it: a layout may be destroyed before them.
struct DescriptorSetLayoutObject {
    explicit DescriptorSetLayoutObject(std::shared_ptr<const DescriptorSetLayout> made) : layout(std::move(made)) {}
    std::shared_ptr<const DescriptorSetLayout> layout;
};

/// Sets are resolved by (set, binding) when a draw runs, so that nothing of the layouts is kept.
struct PipelineLayout {};

struct DescriptorSetObject {
    explicit DescriptorSetObject(std::shared_ptr<const DescriptorSetLayout> of) : layout(std::move(of)), set(*layout) {}
    std::shared_ptr<const DescriptorSetLayout> layout;
    DescriptorSet set;
};

inline constexpr size_t kDescriptorTypeCount = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT + 1;

struct DescriptorPool {
    DescriptorPool(const VkAllocationCallbacks* given, const VkDescriptorPoolCreateInfo& info);
    ~DescriptorPool();

    /// VK_ERROR_OUT_OF_POOL_MEMORY when the pool's counts do not allow another set of this layout.
    VkResult allocate(const std::shared_ptr<const DescriptorSetLayout>& layout, VkDescriptorSet* out);
    void free(DescriptorSetObject* set);
    void reset();

  private:
    bool hasCallbacks_;
    VkAllocationCallbacks callbacks_{};
    const VkAllocationCallbacks* callbacks() const { return hasCallbacks_ ? &callbacks_ : nullptr; }

    uint32_t setsLeft_;
    std::array<uint32_t, kDescriptorTypeCount> left_{};
    std::vector<DescriptorSetObject*> sets_;
};

struct DescriptorUpdateTemplate {
    explicit DescriptorUpdateTemplate(std::vector<VkDescriptorUpdateTemplateEntry> given) : entries(std::move(given)) {}
    std::vector<VkDescriptorUpdateTemplateEntry> entries;
};

}  // namespace vernier::vulkan
