// Render passes: several subpasses, depth, multisampling and resolve, load and store operations, partial
// render areas.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr uint32_t kRed = 0xFF0000FFu, kGreen = 0xFF00FF00u, kBlue = 0xFFFF0000u;
constexpr VkExtent2D kExtent{20, 20};

class PassTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME}; }
    VkPipeline colorPipeline(VkRenderPass pass, const std::string& rgba, const std::string& z, uint32_t subpass,
                             VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = fullScreen(z);
        desc.fragment = constantColor(rgba);
        desc.depthTest = true;
        desc.subpass = subpass;
        desc.samples = samples;
        return makePipeline(pass, desc);
    }
    static void draw(VkCommandBuffer commands, VkPipeline pipeline) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, 0);
    }
    /// The samples that a draw covers in a pass without attachments, and with one layer.
    uint64_t samplesWithoutAttachments(VkShaderModule vertex, uint32_t instances, VkSampleCountFlagBits perPixel) {
        auto subpass = VkSubpassDescription{};
        auto passInfo = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        passInfo.subpassCount = 1;
        passInfo.pSubpasses = &subpass;
        Pass pass;
        pass.extent = kExtent;
        EXPECT_EQ(vkCreateRenderPass(device, &passInfo, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, {});
        const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_OCCLUSION);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = vertex;
        desc.fragment = constantColor("1, 0, 0, 1");
        desc.colorCount = 0;
        desc.samples = perPixel;
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        vkCmdResetQueryPool(commands, queries, 0, 1);
        beginPass(commands, pass);
        vkCmdBeginQuery(commands, queries, 0, VK_QUERY_CONTROL_PRECISE_BIT);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, instances, 0, 0);
        vkCmdEndQuery(commands, queries, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        uint64_t samples = 0;
        EXPECT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, sizeof samples, &samples, sizeof samples,
                                        VK_QUERY_RESULT_64_BIT),
                  VK_SUCCESS);
        return samples;
    }
};

TEST_F(PassTest, depthDecidesAndIsStored) {
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage depth = makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const Pass pass = makePass(color, &depth);
    const VkPipeline near = colorPipeline(pass.pass, "1, 0, 0, 1", "0.25", 0);
    const VkPipeline far = colorPipeline(pass.pass, "0, 1, 0, 1", "0.75", 0);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    draw(commands, near);
    draw(commands, far);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    const auto depths = readImage(depth, VK_IMAGE_ASPECT_DEPTH_BIT, 4);
    for (const uint32_t at : {0u, 19u}) {
        EXPECT_EQ(pixelAt(texels, color, at, 19 - at), kRed);
        float value = 0;
        std::memcpy(&value, depths.data() + 4 * (at * 20 + at), 4);
        EXPECT_EQ(value, 0.25f);
    }
}

TEST_F(PassTest, multisampleResolves) {
    const TestImage color =
        makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
    const TestImage resolved = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color, nullptr, &resolved);
    const VkPipeline pipeline = colorPipeline(pass.pass, "0, 1, 0, 1", "0.5", 0, VK_SAMPLE_COUNT_4_BIT);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    draw(commands, pipeline);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(resolved, VK_IMAGE_ASPECT_COLOR_BIT, 4), resolved, 10, 10), kGreen);
}

TEST_F(PassTest, withoutAttachmentsSamplesAreThoseOfThePipeline) {
    EXPECT_EQ(samplesWithoutAttachments(fullScreen(), 1, VK_SAMPLE_COUNT_4_BIT), 4u * kExtent.width * kExtent.height);
}

// Programs draw to storage alone then, and may say nothing of layers to the framebuffer.
TEST_F(PassTest, withoutAttachmentsEveryLayerIsDrawn) {
    const VkShaderModule vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0.5, 1);
    gl_Layer = 3 * gl_InstanceIndex;
})");
    EXPECT_EQ(samplesWithoutAttachments(vertex, 5, VK_SAMPLE_COUNT_1_BIT), 5u * kExtent.width * kExtent.height);
}

TEST_F(PassTest, renderAreaLimitsTheClear) {
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    Pass pass = makePass(color);
    pass.clears[0].color = {{1, 0, 0, 1}};
    VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdEndRenderPass(commands);
    submit(commands);
    pass.clears[0].color = {{0, 0, 1, 1}};
    commands = begin();
    auto info = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass = pass.pass;
    info.framebuffer = pass.framebuffer;
    info.renderArea = {{3, 5}, {7, 2}};
    info.clearValueCount = 1;
    info.pClearValues = pass.clears.data();
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdEndRenderPass(commands);
    submit(commands);
    // Outside the render area the second pass may keep what was there only with LOAD-like attachments; with
    // UNDEFINED as the initial layout contents outside stay as they are in this driver.
    const auto texels = readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t y = 0; y < 20; ++y) {
        for (uint32_t x = 0; x < 20; ++x) {
            const bool inside = x >= 3 && x < 10 && y >= 5 && y < 7;
            ASSERT_EQ(pixelAt(texels, color, x, y), inside ? kBlue : kRed) << x << ", " << y;
        }
    }
}

TEST_F(PassTest, secondSubpassKeepsDepthAndDrawsToAnotherImage) {
    const TestImage first = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage second = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const TestImage depth = makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    std::vector<VkAttachmentDescription> attachments;
    for (const TestImage* image : {&first, &second, &depth}) {
        attachments.push_back({0, image->format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_CLEAR,
                               VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                               VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_UNDEFINED,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    }
    const VkAttachmentReference colors[] = {{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                            {1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
    const VkAttachmentReference depthReference{2, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpasses[2] = {};
    for (int i = 0; i < 2; ++i) {
        subpasses[i].colorAttachmentCount = 1;
        subpasses[i].pColorAttachments = &colors[i];
        subpasses[i].pDepthStencilAttachment = &depthReference;
    }
    VkSubpassDependency dependency{};
    dependency.srcSubpass = 0;
    dependency.dstSubpass = 1;
    dependency.srcStageMask = VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    dependency.dstStageMask = VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT;
    dependency.srcAccessMask = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    dependency.dstAccessMask =
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount = 3;
    info.pAttachments = attachments.data();
    info.subpassCount = 2;
    info.pSubpasses = subpasses;
    info.dependencyCount = 1;
    info.pDependencies = &dependency;
    Pass pass;
    pass.extent = kExtent;
    pass.clears.resize(3);
    pass.clears[1].color = {{0, 0, 1, 1}};
    pass.clears[2].depthStencil.depth = 1;
    ASSERT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
    makeFramebuffer(pass, {first.view, second.view, depth.view});
    const VkPipeline near = colorPipeline(pass.pass, "1, 0, 0, 1", "0.25", 0);
    const VkPipeline hidden = colorPipeline(pass.pass, "0, 1, 0, 1", "0.5", 1);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    draw(commands, near);
    vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
    draw(commands, hidden);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(pixelAt(readImage(first, VK_IMAGE_ASPECT_COLOR_BIT, 4), first, 3, 17), kRed);
    // The depth of the first subpass hides what the second draws: its clear colour stays.
    EXPECT_EQ(pixelAt(readImage(second, VK_IMAGE_ASPECT_COLOR_BIT, 4), second, 3, 17), kBlue);
}

/// VK_KHR_maintenance1: a slice of a 3D image as the layer of a 2D view.
TEST_F(PassTest, slicesOfVolumesCanBeDrawnTo) {
    auto info = flatImage(VK_FORMAT_R8G8B8A8_UNORM, {8, 4},
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    info.flags = VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT;
    info.imageType = VK_IMAGE_TYPE_3D;
    info.extent.depth = 3;
    TestImage slice = makeImage(info);
    slice.view = makeView(slice.image, VK_IMAGE_VIEW_TYPE_2D, slice.format, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 1, 1});
    Pass pass = makePass(slice);
    pass.clears[0].color = {{0, 1, 0, 1}};
    const TestBuffer all = makeBuffer(8 * 4 * 3 * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdEndRenderPass(commands);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {8, 4, 3};
    vkCmdCopyImageToBuffer(commands, slice.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, all.buffer, 1, &region);
    submit(commands);
    const auto* texels = static_cast<const uint32_t*>(all.data);
    for (uint32_t i = 0; i < 96; ++i) ASSERT_EQ(texels[i], i / 32 == 1 ? kGreen : 0u) << i;
}

TEST_F(PassTest, framebufferThatDoesNotFitIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const Pass pass = makePass(color);
    auto info = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass = pass.pass;
    info.attachmentCount = 1;
    info.pAttachments = &color.view;
    info.width = 21;
    info.height = 20;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    EXPECT_NE(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), VK_SUCCESS);
    info.width = 20;
    info.layers = 2;
    EXPECT_NE(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
