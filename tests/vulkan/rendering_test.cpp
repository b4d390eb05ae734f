// Dynamic rendering (VK_KHR_dynamic_rendering): passes without render pass objects.
#include <array>

#include "tests/vulkan/test_rendering.h"

namespace vernier::test {
namespace {

constexpr uint32_t kRed = 0xFF0000FF, kGreen = 0xFF00FF00, kBlue = 0xFFFF0000;

TEST_F(RenderingTest, clearsLoadsAndKeepsWhatLiesOutsideTheArea) {
    const VkPipeline red = pipelineFor(filling("1, 0, 0, 1"));
    const VkCommandBuffer commands = begin();
    toColor(commands, color);
    VkRenderingAttachmentInfo attachment = attachColor(color);
    attachment.clearValue.color.float32[1] = attachment.clearValue.color.float32[3] = 1;
    VkRenderingInfo info = rendering(attachment);
    beginRendering(commands, &info);
    endRendering(commands);
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    info.renderArea = {{16, 8}, {32, 40}};
    beginRendering(commands, &info);
    draw(commands, red);
    endRendering(commands);
    toSource(commands, color);
    submit(commands);
    EXPECT_EQ(colorAt(color, 15, 20), kGreen);
    EXPECT_EQ(colorAt(color, 16, 8), kRed);
    EXPECT_EQ(colorAt(color, 47, 47), kRed);
    EXPECT_EQ(colorAt(color, 48, 20), kGreen);
}

// A pass in two command buffers, of which the first suspends it: the clear happens once, the resolve at the end.
TEST_F(RenderingTest, suspendedPassesGoOn) {
    const TestImage samples = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
    const auto half = [&](const std::string& rgba, int32_t x) {
        PipelineDesc desc = filling(rgba);
        desc.samples = VK_SAMPLE_COUNT_4_BIT;
        VkRect2D scissor{{x, 0}, {kExtent.width / 2, kExtent.height / 2}};
        desc.change = [&](const PipelineStates& states) { states.viewport.pScissors = &scissor; };
        return pipelineFor(desc);
    };
    const VkPipeline left = half("1, 0, 0, 1", 0), right = half("0, 1, 0, 1", kExtent.width / 2);
    VkRenderingAttachmentInfo attachment = attachColor(samples);
    attachment.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    attachment.resolveImageView = color.view;
    attachment.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.clearValue.color.float32[2] = attachment.clearValue.color.float32[3] = 1;
    VkRenderingInfo info = rendering(attachment);
    std::array<VkCommandBuffer, 3> parts{};
    parts[0] = begin();
    toColor(parts[0], samples);
    toColor(parts[0], color);
    info.flags = VK_RENDERING_SUSPENDING_BIT;
    beginRendering(parts[0], &info);
    draw(parts[0], left);
    endRendering(parts[0]);
    EXPECT_EQ(vkEndCommandBuffer(parts[0]), VK_SUCCESS);
    parts[1] = begin();
    info.flags = VK_RENDERING_RESUMING_BIT;
    beginRendering(parts[1], &info);
    draw(parts[1], right);
    endRendering(parts[1]);
    EXPECT_EQ(vkEndCommandBuffer(parts[1]), VK_SUCCESS);
    parts[2] = begin();
    toSource(parts[2], color);
    EXPECT_EQ(vkEndCommandBuffer(parts[2]), VK_SUCCESS);
    auto submission = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submission.commandBufferCount = static_cast<uint32_t>(parts.size());
    submission.pCommandBuffers = parts.data();
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
    EXPECT_EQ(colorAt(color, 10, 10), kRed);
    EXPECT_EQ(colorAt(color, 80, 10), kGreen);
    EXPECT_EQ(colorAt(color, 10, 70), kBlue) << "the clear, once";
}

TEST_F(RenderingTest, secondaryCommandBuffersInheritFormats) {
    const VkPipeline red = pipelineFor(filling("1, 0, 0, 1"));
    const VkCommandBuffer secondary = makeCommands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
    auto formats =
        make<VkCommandBufferInheritanceRenderingInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_RENDERING_INFO);
    formats.colorAttachmentCount = 1;
    formats.pColorAttachmentFormats = &kColor;
    formats.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const auto inheritance =
        make<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO, &formats);
    auto beginInfo = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
    beginInfo.pInheritanceInfo = &inheritance;
    ASSERT_EQ(vkBeginCommandBuffer(secondary, &beginInfo), VK_SUCCESS);
    draw(secondary, red);
    ASSERT_EQ(vkEndCommandBuffer(secondary), VK_SUCCESS);

    const VkCommandBuffer commands = begin();
    toColor(commands, color);
    const VkRenderingAttachmentInfo attachment = attachColor(color);
    VkRenderingInfo info = rendering(attachment);
    info.flags = VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT;
    beginRendering(commands, &info);
    vkCmdExecuteCommands(commands, 1, &secondary);
    endRendering(commands);
    toSource(commands, color);
    submit(commands);
    EXPECT_EQ(colorAt(color, 50, 50), kRed);
}

// Layers 0 and 2, told apart by gl_ViewIndex; layer 1 keeps what it had.
TEST_F(RenderingTest, viewsGoToTheirLayers) {
    const TestImage layers = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, 3);
    PipelineDesc desc = filling("0, 0, 0, 1");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_EXT_multiview : require
layout(location = 0) out vec4 color;
void main() { color = gl_ViewIndex == 0 ? vec4(1, 0, 0, 1) : vec4(0, 1, 0, 1); })");
    constexpr uint32_t kViews = 5;
    const VkPipeline pipeline = pipelineFor(desc, VK_FORMAT_UNDEFINED, VK_FORMAT_UNDEFINED, kViews);
    const VkCommandBuffer commands = begin();
    toColor(commands, layers);
    VkRenderingAttachmentInfo attachment = attachColor(layers);
    attachment.clearValue.color.float32[2] = attachment.clearValue.color.float32[3] = 1;
    VkRenderingInfo info = rendering(attachment);
    info.viewMask = 7;
    beginRendering(commands, &info);
    endRendering(commands);
    info.viewMask = kViews;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    beginRendering(commands, &info);
    draw(commands, pipeline);
    endRendering(commands);
    toSource(commands, layers);
    submit(commands);
    EXPECT_EQ(colorAt(layers, 50, 50, 0), kRed);
    EXPECT_EQ(colorAt(layers, 50, 50, 1), kBlue);
    EXPECT_EQ(colorAt(layers, 50, 50, 2), kGreen);
}

// Of the samples of a pixel, sample 0 alone is written: the modes tell it from the others.
TEST_F(RenderingTest, depthAndStencilResolveByTheirModes) {
    constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    const TestImage samples = makeImage(kDepth, kExtent, kUsage, VK_SAMPLE_COUNT_4_BIT);
    const TestImage one = makeImage(kDepth, kExtent, kUsage);
    PipelineDesc desc = filling("1, 1, 1, 1", "0.25");
    desc.fragment = VK_NULL_HANDLE;
    desc.colorCount = 0;
    desc.samples = VK_SAMPLE_COUNT_4_BIT;
    desc.depthTest = true;
    const VkSampleMask first = 1;
    desc.change = [&](const PipelineStates& states) {
        states.multisample.pSampleMask = &first;
        states.depth.stencilTestEnable = VK_TRUE;
        states.depth.front = states.depth.back = {
            VK_STENCIL_OP_KEEP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xFF, 0xFF, 9};
    };
    const VkPipeline pipeline = pipelineFor(desc, kDepth, kDepth);
    struct Case {
        VkResolveModeFlagBits depth, stencil;
        float expectedDepth;
        uint8_t expectedStencil;
    };
    for (const Case& with : {Case{VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, 0.25f, 9},
                             Case{VK_RESOLVE_MODE_MAX_BIT, VK_RESOLVE_MODE_MIN_BIT, 1.0f, 3},
                             Case{VK_RESOLVE_MODE_AVERAGE_BIT, VK_RESOLVE_MODE_MAX_BIT, 0.8125f, 9},
                             Case{VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_MAX_BIT, 0.0f, 9}}) {
        const VkCommandBuffer commands = begin();
        constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        moveTo(commands, samples, VK_IMAGE_LAYOUT_UNDEFINED, kLayout, kBoth);
        moveTo(commands, one, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kBoth);
        const VkClearDepthStencilValue zero{};
        const VkImageSubresourceRange all{kBoth, 0, 1, 0, 1};
        vkCmdClearDepthStencilImage(commands, one.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &all);
        moveTo(commands, one, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kLayout, kBoth);
        VkClearValue clear{};
        clear.depthStencil = {1, 3};
        VkRenderingAttachmentInfo depth = attach(samples.view, kLayout, VK_ATTACHMENT_LOAD_OP_CLEAR, clear);
        VkRenderingAttachmentInfo stencil = depth;
        depth.resolveMode = with.depth;
        stencil.resolveMode = with.stencil;
        depth.resolveImageView = stencil.resolveImageView = one.view;
        depth.resolveImageLayout = stencil.resolveImageLayout = kLayout;
        auto info = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
        info.renderArea.extent = kExtent;
        info.layerCount = 1;
        info.pDepthAttachment = &depth;
        info.pStencilAttachment = &stencil;
        beginRendering(commands, &info);
        draw(commands, pipeline);
        endRendering(commands);
        moveTo(commands, one, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kBoth);
        submit(commands);
        const std::vector<uint8_t> depths = readImage(one, VK_IMAGE_ASPECT_DEPTH_BIT, 4);
        float value = 0;
        std::memcpy(&value, depths.data() + 4 * (40 * kExtent.width + 30), 4);
        EXPECT_EQ(value, with.expectedDepth);
        EXPECT_EQ(readImage(one, VK_IMAGE_ASPECT_STENCIL_BIT, 1)[40 * kExtent.width + 30], with.expectedStencil);
    }
}

// An image of both aspects of which one is an attachment: the other is neither cleared nor tested nor written.
TEST_F(RenderingTest, oneAspectAlone) {
    constexpr VkImageAspectFlags kBoth = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    const TestImage image = makeImage(kDepth, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    for (const bool depthAlone : {true, false}) {
        PipelineDesc desc = filling("1, 0, 0, 1", "0.25");
        desc.depthTest = true;
        desc.change = [&](const PipelineStates& states) {
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.depthCompareOp = depthAlone ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_NEVER;
            const VkCompareOp compare = depthAlone ? VK_COMPARE_OP_NEVER : VK_COMPARE_OP_ALWAYS;
            states.depth.front = states.depth.back = {
                VK_STENCIL_OP_INCREMENT_AND_CLAMP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, compare, 0xFF, 0xFF, 9};
        };
        const VkPipeline pipeline =
            pipelineFor(desc, depthAlone ? kDepth : VK_FORMAT_UNDEFINED, depthAlone ? VK_FORMAT_UNDEFINED : kDepth);
        const VkCommandBuffer commands = begin();
        constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        toColor(commands, color);
        moveTo(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kBoth);
        const VkClearDepthStencilValue before{0.75f, 5};
        const VkImageSubresourceRange all{kBoth, 0, 1, 0, 1};
        vkCmdClearDepthStencilImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &before, 1, &all);
        moveTo(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kLayout, kBoth);
        VkClearValue clear{};
        clear.depthStencil = {1, 1};
        const VkRenderingAttachmentInfo aspect = attach(image.view, kLayout, VK_ATTACHMENT_LOAD_OP_CLEAR, clear);
        const VkRenderingAttachmentInfo attachment = attachColor(color);
        VkRenderingInfo info = rendering(attachment);
        (depthAlone ? info.pDepthAttachment : info.pStencilAttachment) = &aspect;
        beginRendering(commands, &info);
        draw(commands, pipeline);
        endRendering(commands);
        toSource(commands, color);
        moveTo(commands, image, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kBoth);
        submit(commands);
        EXPECT_EQ(colorAt(color, 50, 50), kRed);
        const std::vector<uint8_t> depths = readImage(image, VK_IMAGE_ASPECT_DEPTH_BIT, 4);
        float value = 0;
        std::memcpy(&value, depths.data(), 4);
        EXPECT_EQ(value, depthAlone ? 0.25f : 0.75f);
        EXPECT_EQ(readImage(image, VK_IMAGE_ASPECT_STENCIL_BIT, 1)[0], depthAlone ? 5 : 9);
    }
}

// Attachments that the pass does not have are left alone by pipelines that would draw to them.
TEST_F(RenderingTest, missingAttachments) {
    VERNIER_SKIP_WHEN_VALIDATED();
    PipelineDesc desc = filling("1, 0, 0, 1");
    desc.depthTest = true;
    desc.colorCount = 2;
    auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    const std::array<VkFormat, 2> both{kColor, kColor};
    formats.colorAttachmentCount = 2;
    formats.pColorAttachmentFormats = both.data();
    formats.depthAttachmentFormat = kDepth;
    desc.next = &formats;
    desc.extent = kExtent;
    const VkPipeline pipeline = makePipeline(VK_NULL_HANDLE, desc);
    const VkCommandBuffer commands = begin();
    const std::array<VkRenderingAttachmentInfo, 2> attachments{
        attach(VK_NULL_HANDLE, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR),
        attachColor(color)};
    VkRenderingInfo info = rendering(attachments[0]);
    info.colorAttachmentCount = 1;
    beginRendering(commands, &info);
    draw(commands, pipeline);
    endRendering(commands);
    info.colorAttachmentCount = 2;
    beginRendering(commands, &info);
    draw(commands, pipeline);
    endRendering(commands);
    submit(commands);
    EXPECT_EQ(colorAt(color, 50, 50), 0u) << "nothing is written to location 1";
}

TEST_F(RenderingTest, pipelinesThatDiscardFitMultisampledAttachments) {
    // The layer (1.3.239) takes such pipelines for ones of one sample.
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage samples = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
    PipelineDesc discards = filling("1, 0, 0, 1"), draws = filling("1, 0, 0, 1");
    discards.change = [](const PipelineStates& states) { states.raster.rasterizerDiscardEnable = VK_TRUE; };
    discards.samples = draws.samples = VK_SAMPLE_COUNT_4_BIT;
    const VkPipeline discarding = pipelineFor(discards), drawing = pipelineFor(draws);
    const VkQueryPool queries =
        makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT);
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, queries, 0, 1);
    toColor(commands, color);
    toColor(commands, samples);
    VkRenderingAttachmentInfo attachment = attachColor(samples);
    attachment.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    attachment.resolveImageView = color.view;
    attachment.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkRenderingInfo info = rendering(attachment);
    beginRendering(commands, &info);
    vkCmdBeginQuery(commands, queries, 0, 0);
    draw(commands, discarding);
    draw(commands, drawing);
    draw(commands, discarding);
    vkCmdEndQuery(commands, queries, 0);
    endRendering(commands);
    toSource(commands, color);
    submit(commands);
    uint64_t vertices = 0;
    EXPECT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, sizeof vertices, &vertices, sizeof vertices,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    EXPECT_EQ(vertices, 9u);
    EXPECT_EQ(colorAt(color, 50, 50), kRed);
}

TEST_F(RenderingTest, whatDoesNotFitIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage samples = makeImage(kColor, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_4_BIT);
    const TestImage other = makeImage(VK_FORMAT_R16G16_SFLOAT, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const VkPipeline pipeline = pipelineFor(filling("1, 0, 0, 1"));
    const auto ends = [&](const std::function<void(VkCommandBuffer)>& record) {
        const VkCommandBuffer commands = begin();
        record(commands);
        return vkEndCommandBuffer(commands);
    };
    const std::array<VkRenderingAttachmentInfo, 2> unequal{attachColor(color), attachColor(samples)};
    VkRenderingInfo info = rendering(unequal[0]);
    EXPECT_EQ(ends([&](VkCommandBuffer commands) {
                  beginRendering(commands, &info);
                  draw(commands, pipeline);
                  endRendering(commands);
              }),
              VK_SUCCESS);
    info.colorAttachmentCount = 2;
    EXPECT_NE(ends([&](VkCommandBuffer commands) { beginRendering(commands, &info); }), VK_SUCCESS);
    for (const TestImage* image : {&samples, &other}) {
        const VkRenderingAttachmentInfo attachment = attachColor(*image);
        const VkRenderingInfo with = rendering(attachment);
        EXPECT_NE(ends([&](VkCommandBuffer commands) {
                      beginRendering(commands, &with);
                      draw(commands, pipeline);
                      endRendering(commands);
                  }),
                  VK_SUCCESS)
            << image->format;
    }
    EXPECT_NE(ends([&](VkCommandBuffer commands) { endRendering(commands); }), VK_SUCCESS);
    info.colorAttachmentCount = 1;
    info.layerCount = 2;
    EXPECT_NE(ends([&](VkCommandBuffer commands) { beginRendering(commands, &info); }), VK_SUCCESS);
    // An area behind the image is cut.
    info.layerCount = 1;
    info.renderArea = {{-5, 3}, {1000, 1u << 31}};
    EXPECT_EQ(ends([&](VkCommandBuffer commands) {
                  beginRendering(commands, &info);
                  draw(commands, pipeline);
                  endRendering(commands);
              }),
              VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
