// A render pass, a framebuffer and a pipeline in a few lines: the defaults draw opaque triangles into one
// colour image.
#pragma once

#include <optional>

#include "tests/vulkan/test_device.h"

namespace vernier::test {

class DrawTest : public VulkanTest {
  protected:
    struct Pass {
        VkRenderPass pass = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkExtent2D extent{};
        std::vector<VkClearValue> clears;
    };
    /// One subpass: clears the colour, and the depth to 1 if there is one, and stores both. `samples` counts when there
    /// is something to resolve to. `layers` are the framebuffer's; a view mask that is not 0 makes it multiview.
    Pass makePass(const TestImage& color, const TestImage* depth = nullptr, const TestImage* resolve = nullptr,
                  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_4_BIT, uint32_t layers = 1, uint32_t viewMask = 0);

    /// The framebuffer of a pass that has its render pass and extent; both are destroyed at the end.
    void makeFramebuffer(Pass& pass, const std::vector<VkImageView>& views, uint32_t layers = 1);

    VkDescriptorSetLayout makeSetLayout(const std::vector<VkDescriptorSetLayoutBinding>& bindings);
    /// A set from a pool of these sizes, in which nothing is written yet.
    VkDescriptorSet makeEmptySet(VkDescriptorSetLayout layout, const std::vector<VkDescriptorPoolSize>& sizes,
                                 VkDescriptorPoolCreateFlags flags = 0);

    /// What a test may change before the pipeline is made of it.
    struct PipelineStates {
        VkPipelineVertexInputStateCreateInfo& input;
        VkPipelineInputAssemblyStateCreateInfo& assembly;
        VkPipelineViewportStateCreateInfo& viewport;
        VkPipelineRasterizationStateCreateInfo& raster;
        VkPipelineMultisampleStateCreateInfo& multisample;
        VkPipelineDepthStencilStateCreateInfo& depth;
        VkPipelineColorBlendStateCreateInfo& colors;
        std::vector<VkPipelineColorBlendAttachmentState>& blends;
    };
    struct PipelineDesc {
        VkShaderModule vertex = VK_NULL_HANDLE, geometry = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
        VkShaderModule control = VK_NULL_HANDLE, evaluation = VK_NULL_HANDLE;
        uint32_t patchControlPoints = 0;  // 0: there is no tessellation state
        bool domainLowerLeft = false;
        VkPipelineLayout layout = VK_NULL_HANDLE;  // VK_NULL_HANDLE: an empty one
        uint32_t subpass = 0;
        VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
        VkPipelineCreateFlags flags = 0;
        bool depthTest = false;
        uint32_t colorCount = 1;
        const VkSpecializationInfo* specialization = nullptr;  // of the geometry and the fragment stage
        std::vector<VkVertexInputBindingDescription> bindings;
        std::vector<VkVertexInputAttributeDescription> attributes;
        std::vector<VkDynamicState> dynamic;
        VkExtent2D extent{};
        std::function<void(const PipelineStates&)> change;
        const void* next = nullptr;  // chain of the pipeline's description
    };
    VkPipeline makePipeline(VkRenderPass pass, const PipelineDesc& desc, VkResult expected = VK_SUCCESS);
    /// Makes the pipeline that makePipeline() has described.
    virtual VkResult createPipeline(const VkGraphicsPipelineCreateInfo& info, VkPipeline* pipeline);

    VkPipelineLayout makeLayout(const std::vector<VkDescriptorSetLayout>& sets, uint32_t pushBytes,
                                VkShaderStageFlags pushStages = VK_SHADER_STAGE_VERTEX_BIT |
                                                                VK_SHADER_STAGE_FRAGMENT_BIT);

    void beginPass(VkCommandBuffer commands, const Pass& pass, VkSubpassContents contents = VK_SUBPASS_CONTENTS_INLINE);
    /// A submission of one pass that draws three vertices; nothing is bound but the pipeline and, of `layout`, a set.
    void drawTriangle(const Pass& pass, VkPipeline pipeline, VkPipelineLayout layout = VK_NULL_HANDLE,
                      VkDescriptorSet set = VK_NULL_HANDLE);

    /// A full-screen triangle without vertex buffers: gl_Position from gl_VertexIndex, at depth `z`.
    VkShaderModule fullScreen(const std::string& z = "0.5");
    /// Writes a constant.
    VkShaderModule constantColor(const std::string& rgba);
};

/// The colour of an RGBA8 pixel as 0xAABBGGRR.
uint32_t pixelAt(const std::vector<uint8_t>& texels, const TestImage& image, uint32_t x, uint32_t y);
/// Texels of 32 bits.
inline std::vector<uint32_t> asWords(const std::vector<uint8_t>& bytes) {
    std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
}

}  // namespace vernier::test
