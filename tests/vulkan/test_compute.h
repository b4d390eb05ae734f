// Compute pipelines and their descriptor sets in a few lines.
#pragma once

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {

/// One descriptor of set 0; the binding is its place in the list. What the type does not use stays empty.
struct TestDescriptor {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;
    VkImageView image = VK_NULL_HANDLE;  // in VK_IMAGE_LAYOUT_GENERAL
    VkSampler sampler = VK_NULL_HANDLE;  // of a combined image sampler; immutable
    VkShaderStageFlags stages = VK_SHADER_STAGE_ALL;
    VkDeviceSize range = VK_WHOLE_SIZE;  // of a buffer
};

inline TestDescriptor storageBuffer(const TestBuffer& buffer) {
    return {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            buffer.buffer,
            VK_NULL_HANDLE,
            VK_NULL_HANDLE,
            VK_NULL_HANDLE,
            VK_SHADER_STAGE_ALL,
            VK_WHOLE_SIZE};
}
inline TestDescriptor texelBuffer(VkBufferView view, bool storage) {
    return {storage ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
            VK_NULL_HANDLE,
            view,
            VK_NULL_HANDLE,
            VK_NULL_HANDLE,
            VK_SHADER_STAGE_ALL,
            VK_WHOLE_SIZE};
}
inline TestDescriptor storageImage(const TestImage& image) {
    return {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
            VK_NULL_HANDLE,
            VK_NULL_HANDLE,
            image.view,
            VK_NULL_HANDLE,
            VK_SHADER_STAGE_ALL,
            VK_WHOLE_SIZE};
}

inline TestDescriptor sampledImage(VkImageView view, VkSampler sampler) {
    return {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            VK_NULL_HANDLE,
            VK_NULL_HANDLE,
            view,
            sampler,
            VK_SHADER_STAGE_ALL,
            VK_WHOLE_SIZE};
}

class ComputeTest : public DrawTest {
  protected:
    struct Compute {
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    Compute makeCompute(const std::string& glsl, const std::vector<TestDescriptor>& descriptors, uint32_t pushBytes = 0,
                        const VkSpecializationInfo* specialization = nullptr, VkResult expected = VK_SUCCESS,
                        VkPipelineCreateFlags flags = 0);
    VkPipeline makeComputePipeline(VkPipelineLayout layout, VkShaderModule shader,
                                   const VkSpecializationInfo* specialization = nullptr, VkResult expected = VK_SUCCESS,
                                   VkPipelineCreateFlags flags = 0);
    VkPipeline makeComputePipeline(VkPipelineLayout layout, const std::string& glsl,
                                   const VkSpecializationInfo* specialization = nullptr, VkResult expected = VK_SUCCESS,
                                   VkPipelineCreateFlags flags = 0);
    /// A set for all stages, and its layout.
    VkDescriptorSet makeSet(const std::vector<TestDescriptor>& descriptors, VkDescriptorSetLayout* layout);
    VkBufferView makeTexels(const TestBuffer& buffer, VkFormat format, VkDeviceSize offset = 0,
                            VkDeviceSize range = VK_WHOLE_SIZE);
    void bind(VkCommandBuffer commands, const Compute& compute);
    /// Binds, dispatches and makes the results visible to everything that follows, the host included.
    void dispatch(VkCommandBuffer commands, const Compute& compute, uint32_t x, uint32_t y = 1, uint32_t z = 1);
    void makeVisible(VkCommandBuffer commands);
    /// Takes an image to VK_IMAGE_LAYOUT_GENERAL.
    void toGeneral(VkCommandBuffer commands, const TestImage& image, VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED);
    void run(const Compute& compute, uint32_t x, uint32_t y = 1, uint32_t z = 1);

    /// The buffer as words.
    static uint32_t* words(const TestBuffer& buffer) { return static_cast<uint32_t*>(buffer.data); }
    TestBuffer makeStorage(uint32_t wordCount, VkBufferUsageFlags moreUsage = 0) {
        return makeBuffer(VkDeviceSize{wordCount} * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | moreUsage);
    }
};

}  // namespace vernier::test
