// Compute shaders over storage buffers on a Vulkan device, without a scene.
#pragma once

#include <span>

#include "conformance/drivers/vulkan_resources.h"

namespace vernier::conformance {

/// Storage buffers at bindings 0, 1, ... of set 0, each as a whole, and room for push constants.
struct StorageBuffers {
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
};
/// What is made lives until the cleanup runs.
Result<StorageBuffers> bindStorageBuffers(VkDevice device, Cleanup& cleanup, std::span<const VulkanBuffer> buffers,
                                          uint32_t pushBytes = 0);

Result<VkShaderModule> createShaderModule(VkDevice device, Cleanup& cleanup, std::span<const uint32_t> words);
/// The entry point is "main".
Result<VkPipeline> createComputePipeline(VkDevice device, Cleanup& cleanup, VkPipelineLayout layout,
                                         VkShaderModule module);

/// Makes what compute shaders have written visible to accesses of a stage.
void computeBarrier(VkCommandBuffer commands, VkAccessFlags access, VkPipelineStageFlags stage);

}  // namespace vernier::conformance
