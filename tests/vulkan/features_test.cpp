// Features that no other test of the driver uses.
#include "tests/vulkan/test_compute.h"

namespace vernier::test {
namespace {

class FeaturesTest : public ComputeTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_IMAGE_2D_VIEW_OF_3D_EXTENSION_NAME}; }
    void* moreFeatures() override {
        slices_ = make<VkPhysicalDeviceImage2DViewOf3DFeaturesEXT>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_2D_VIEW_OF_3D_FEATURES_EXT);
        slices_.image2DViewOf3D = slices_.sampler2DViewOf3D = VK_TRUE;
        return &slices_;
    }

  private:
    VkPhysicalDeviceImage2DViewOf3DFeaturesEXT slices_{};
};

// inheritedQueries: a query that is open in the primary command buffer counts what the secondary one draws.
TEST_F(FeaturesTest, queriesCountInSecondaryCommandBuffers) {
    const TestImage image = makeImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 8}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(image);
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = constantColor("1");
    desc.extent = image.extent;
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    constexpr VkQueryPipelineStatisticFlags kStatistics = VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT;
    const VkQueryPool pools[] = {makeQueries(VK_QUERY_TYPE_OCCLUSION),
                                 makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, kStatistics)};
    const VkCommandBuffer secondary = makeCommands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
    auto inheritance = make<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO);
    inheritance.renderPass = pass.pass;
    inheritance.framebuffer = pass.framebuffer;
    inheritance.occlusionQueryEnable = VK_TRUE;
    inheritance.queryFlags = VK_QUERY_CONTROL_PRECISE_BIT;
    inheritance.pipelineStatistics = kStatistics;
    auto beginInfo = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
    beginInfo.pInheritanceInfo = &inheritance;
    ASSERT_EQ(vkBeginCommandBuffer(secondary, &beginInfo), VK_SUCCESS);
    vkCmdBindPipeline(secondary, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(secondary, 3, 1, 0, 0);
    ASSERT_EQ(vkEndCommandBuffer(secondary), VK_SUCCESS);
    const VkCommandBuffer commands = begin();
    for (const VkQueryPool queries : pools) vkCmdResetQueryPool(commands, queries, 0, 1);
    vkCmdBeginQuery(commands, pools[0], 0, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdBeginQuery(commands, pools[1], 0, 0);
    beginPass(commands, pass, VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS);
    vkCmdExecuteCommands(commands, 1, &secondary);
    vkCmdEndRenderPass(commands);
    vkCmdEndQuery(commands, pools[1], 0);
    vkCmdEndQuery(commands, pools[0], 0);
    submit(commands);
    for (const bool statistics : {false, true}) {
        uint64_t count = 0;
        ASSERT_EQ(vkGetQueryPoolResults(device, pools[statistics ? 1 : 0], 0, 1, sizeof count, &count, sizeof count,
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  VK_SUCCESS);
        EXPECT_EQ(count, statistics ? 3u : 64u);
    }
}

// independentBlend: two attachments, one of which adds where the other keeps.
TEST_F(FeaturesTest, attachmentsBlendApart) {
    const TestImage images[] = {makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT),
                                makeImage(VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)};
    std::vector<VkAttachmentDescription> attachments(
        2, {0, VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_CLEAR,
            VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_DONT_CARE,
            VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                                {1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = 2;
    subpass.pColorAttachments = references;
    auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = 2;
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    Pass pass;
    pass.extent = {4, 4};
    pass.clears.resize(2);
    for (VkClearValue& clear : pass.clears) clear.color = {.float32 = {0.2f, 0.2f, 0.2f, 0.2f}};
    ASSERT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
    makeFramebuffer(pass, {images[0].view, images[1].view});
    PipelineDesc desc;
    desc.vertex = fullScreen();
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
        layout(location = 0) out vec4 first;
        layout(location = 1) out vec4 second;
        void main() { first = second = vec4(0.4); })");
    desc.colorCount = 2;
    desc.extent = pass.extent;
    desc.change = [](const PipelineStates& states) {
        VkPipelineColorBlendAttachmentState& adds = states.blends[0];
        adds.blendEnable = VK_TRUE;
        adds.srcColorBlendFactor = adds.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
        adds.srcAlphaBlendFactor = adds.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        states.blends[1].colorWriteMask = VK_COLOR_COMPONENT_G_BIT;
    };
    drawTriangle(pass, makePipeline(pass.pass, desc));
    EXPECT_EQ(pixelAt(readImage(images[0], VK_IMAGE_ASPECT_COLOR_BIT, 4), images[0], 1, 1), 0x99999999u);
    EXPECT_EQ(pixelAt(readImage(images[1], VK_IMAGE_ASPECT_COLOR_BIT, 4), images[1], 1, 1), 0x33336633u);
}

// image2DViewOf3D: one slice of a volume as a storage image.
TEST_F(FeaturesTest, slicesAreStorageImages) {
    auto info = flatImage(VK_FORMAT_R32_UINT, {4, 4}, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    info.flags = VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
    info.imageType = VK_IMAGE_TYPE_3D;
    info.extent.depth = 4;
    TestImage image = makeImage(info);
    image.view = makeView(image.image, VK_IMAGE_VIEW_TYPE_2D, info.format, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 2, 1});
    const TestBuffer out = makeBuffer(4 * 4 * 4 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const Compute compute = makeCompute(R"(#version 450
        layout(set = 0, binding = 0, r32ui) uniform uimage2D slice;
        void main() { imageStore(slice, ivec2(3, 1), uvec4(42)); })",
                                        {storageImage(image)});
    const VkCommandBuffer commands = begin();
    toGeneral(commands, image);
    dispatch(commands, compute, 1);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {4, 4, 4};
    vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, out.buffer, 1, &region);
    makeVisible(commands);
    submit(commands);
    EXPECT_EQ(words(out)[2 * 16 + 1 * 4 + 3], 42u);
    EXPECT_EQ(words(out)[1 * 16 + 1 * 4 + 3], 0u);
}

}  // namespace
}  // namespace vernier::test
