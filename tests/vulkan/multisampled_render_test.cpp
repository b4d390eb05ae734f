// VK_EXT_multisampled_render_to_single_sampled: the same bits as drawing to multisampled images that are resolved.
#include <array>

#include "tests/vulkan/test_multisampled.h"

namespace vernier::test {
namespace {

constexpr VkRect2D kArea{{5, 3}, {60, 31}}, kWhole{{0, 0}, {70, 40}};

/// What the samples of a pass are: those of its attachments, which are resolved to others; the driver's; there is one.
enum class Samples : uint8_t { ofImages, ofDriver, one };

struct Rendering {
    Samples kind = Samples::ofDriver;
    bool dynamic = false;  // dynamic rendering
    VkSampleCountFlagBits count = VK_SAMPLE_COUNT_4_BIT;
    VkFormat color = VK_FORMAT_R8G8B8A8_UNORM;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkResolveModeFlagBits depthMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
    VkResolveModeFlagBits stencilMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
    VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE;
    VkRect2D area = kWhole;
    uint32_t layers = 1, viewMask = 0;
    bool secondary = false, imageless = false;
    VkSampleCountFlagBits inherited = {};  // of secondary command buffers; 0: samples()
    VkRenderingFlags flags = 0;            // of dynamic rendering
    bool integer() const { return color == VK_FORMAT_R8G8B8A8_UINT; }
    VkSampleCountFlagBits samples() const { return kind == Samples::one ? VK_SAMPLE_COUNT_1_BIT : count; }
};

class MultisampledRenderTest : public MultisampledTest {
  protected:
    struct Targets {
        TestImage color, depth;                // one sample
        TestImage colorSamples, depthSamples;  // of Samples::ofImages
    };
    struct Pixels {
        std::vector<std::vector<uint8_t>> color, depth, stencil;  // by layer
        bool operator==(const Pixels&) const = default;
    };

    Targets makeTargets(const Rendering& setup) {
        const VkImageCreateFlags flags = setup.kind == Samples::ofDriver ? kToSingle : 0;
        Targets targets;
        targets.color = makeTarget(setup.color, VK_SAMPLE_COUNT_1_BIT, flags, setup.layers);
        targets.depth = makeTarget(kDepth, VK_SAMPLE_COUNT_1_BIT, flags, setup.layers);
        if (setup.kind != Samples::ofImages) return targets;
        targets.colorSamples = makeTarget(setup.color, setup.count, 0, setup.layers);
        targets.depthSamples = makeTarget(kDepth, setup.count, 0, setup.layers);
        return targets;
    }
    static void barriers(VkCommandBuffer commands, const Targets& targets, VkImageLayout from, VkImageLayout to) {
        for (const TestImage* image : {&targets.color, &targets.depth, &targets.colorSamples, &targets.depthSamples})
            if (image->image != VK_NULL_HANDLE) barrier(commands, *image, from, to);
    }

    static VkMultisampledRenderToSingleSampledInfoEXT toSingle(const Rendering& setup) {
        return MultisampledTest::toSingle(setup.kind == Samples::ofDriver, setup.count);
    }
    /// One subpass with a colour and a depth-stencil attachment. Dynamic rendering needs none.
    Pass makePass(const Rendering& setup, const Targets& targets) {
        Pass pass;
        pass.extent = kExtent;
        if (setup.dynamic) return pass;
        const bool resolves = setup.kind == Samples::ofImages;
        const VkSampleCountFlagBits samples = resolves ? setup.count : VK_SAMPLE_COUNT_1_BIT;
        std::vector<VkAttachmentDescription2> attachments;
        for (const VkFormat format : {setup.color, kDepth})
            attachments.push_back(describe(format, samples, setup.load, setup.store));
        std::vector<VkImageView> views{targets.color.view, targets.depth.view};
        if (resolves) {
            views.insert(views.begin(), {targets.colorSamples.view, targets.depthSamples.view});
            for (const VkFormat format : {setup.color, kDepth})
                attachments.push_back(describe(format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_LOAD));
        }
        const VkAttachmentReference2 color = refer(0, VK_IMAGE_ASPECT_COLOR_BIT), depth = refer(1, kBoth);
        const VkAttachmentReference2 colorTo = refer(2, VK_IMAGE_ASPECT_COLOR_BIT), depthTo = refer(3, kBoth);
        const VkMultisampledRenderToSingleSampledInfoEXT single = toSingle(setup);
        auto resolve = make<VkSubpassDescriptionDepthStencilResolve>(
            VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE, &single);
        resolve.depthResolveMode = setup.depthMode;
        resolve.stencilResolveMode = setup.stencilMode;
        if (resolves) resolve.pDepthStencilResolveAttachment = &depthTo;
        auto subpass = make<VkSubpassDescription2>(VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2);
        if (setup.kind != Samples::one) subpass.pNext = &resolve;
        subpass.viewMask = setup.viewMask;
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        if (resolves) subpass.pResolveAttachments = &colorTo;
        subpass.pDepthStencilAttachment = &depth;
        auto info = make<VkRenderPassCreateInfo2>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2);
        info.attachmentCount = static_cast<uint32_t>(attachments.size());
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        EXPECT_EQ(vkCreateRenderPass2(device, &info, nullptr, &pass.pass), VK_SUCCESS);
        if (setup.imageless) {
            makeImageless(pass, setup);
        } else {
            makeFramebuffer(pass, views, setup.viewMask != 0 ? 1 : setup.layers);
        }
        return pass;
    }
    void makeImageless(Pass& pass, const Rendering& setup) {
        std::array images{make<VkFramebufferAttachmentImageInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO),
                          make<VkFramebufferAttachmentImageInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO)};
        for (VkFramebufferAttachmentImageInfo& image : images) {
            image.flags = setup.kind == Samples::ofDriver ? kToSingle : 0;
            image.width = kExtent.width;
            image.height = kExtent.height;
            image.layerCount = image.viewFormatCount = 1;
        }
        images[0].usage = kColorUsage;
        images[0].pViewFormats = &setup.color;
        images[1].usage = kDepthUsage;
        images[1].pViewFormats = &kDepth;
        auto attachments =
            make<VkFramebufferAttachmentsCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENTS_CREATE_INFO);
        attachments.attachmentImageInfoCount = 2;
        attachments.pAttachmentImageInfos = images.data();
        auto info = make<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO, &attachments);
        info.flags = VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT;
        info.renderPass = pass.pass;
        info.attachmentCount = 2;
        info.layers = 1;
        info.width = kExtent.width;
        info.height = kExtent.height;
        EXPECT_EQ(vkCreateFramebuffer(device, &info, nullptr, &pass.framebuffer), VK_SUCCESS);
        defer([this, pass] {
            vkDestroyFramebuffer(device, pass.framebuffer, nullptr);
            vkDestroyRenderPass(device, pass.pass, nullptr);
        });
    }

    static VkClearColorValue clearColor(const Rendering& setup) {
        VkClearColorValue value{{0.1f, 0.5f, 0.9f, 0.25f}};
        if (setup.integer()) value = {.uint32 = {25, 127, 230, 64}};
        return value;
    }
    void beginOn(VkCommandBuffer commands, const Rendering& setup, const Targets& targets, const Pass& pass) {
        const auto contents =
            setup.secondary ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS : VK_SUBPASS_CONTENTS_INLINE;
        std::array<VkClearValue, 2> clears{};
        clears[0].color = clearColor(setup);
        clears[1].depthStencil = {1, 3};
        if (setup.dynamic) return beginDynamic(commands, setup, targets, clears);
        auto info = make<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
        const std::array<VkImageView, 2> views{targets.color.view, targets.depth.view};
        auto given = make<VkRenderPassAttachmentBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO);
        given.attachmentCount = 2;
        given.pAttachments = views.data();
        if (setup.imageless) info.pNext = &given;
        info.renderPass = pass.pass;
        info.framebuffer = pass.framebuffer;
        info.renderArea = setup.area;
        info.clearValueCount = 2;
        info.pClearValues = clears.data();
        vkCmdBeginRenderPass(commands, &info, contents);
    }
    static void beginDynamic(VkCommandBuffer commands, const Rendering& setup, const Targets& targets,
                             const std::array<VkClearValue, 2>& clears) {
        const bool resolves = setup.kind == Samples::ofImages;
        const auto attach = [&](const TestImage& one, const TestImage& many, VkResolveModeFlagBits mode,
                                const VkClearValue& clear) {
            auto info = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
            info.imageView = resolves ? many.view : one.view;
            info.imageLayout = info.resolveImageLayout = kLayout;
            if (setup.kind != Samples::one) info.resolveMode = mode;
            if (resolves && mode != VK_RESOLVE_MODE_NONE) info.resolveImageView = one.view;
            info.loadOp = setup.load;
            info.storeOp = setup.store;
            info.clearValue = clear;
            return info;
        };
        const auto mode = setup.integer() ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_AVERAGE_BIT;
        const VkRenderingAttachmentInfo color = attach(targets.color, targets.colorSamples, mode, clears[0]);
        const VkRenderingAttachmentInfo depth = attach(targets.depth, targets.depthSamples, setup.depthMode, clears[1]);
        const VkRenderingAttachmentInfo stencil =
            attach(targets.depth, targets.depthSamples, setup.stencilMode, clears[1]);
        const VkMultisampledRenderToSingleSampledInfoEXT single = toSingle(setup);
        auto info = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO, &single);
        info.flags = setup.flags | (setup.secondary ? VK_RENDERING_CONTENTS_SECONDARY_COMMAND_BUFFERS_BIT : 0);
        info.renderArea = setup.area;
        info.layerCount = setup.layers;
        info.viewMask = setup.viewMask;
        info.colorAttachmentCount = 1;
        info.pColorAttachments = &color;
        info.pDepthAttachment = &depth;
        info.pStencilAttachment = &stencil;
        vkCmdBeginRendering(commands, &info);
    }
    static void endOn(VkCommandBuffer commands, const Rendering& setup) {
        setup.dynamic ? vkCmdEndRendering(commands) : vkCmdEndRenderPass(commands);
    }

    VkPipeline makeDrawing(const Rendering& setup, const Pass& pass, PipelineDesc desc) {
        auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
        formats.colorAttachmentCount = 1;
        formats.pColorAttachmentFormats = &setup.color;
        formats.depthAttachmentFormat = formats.stencilAttachmentFormat = kDepth;
        formats.viewMask = setup.viewMask;
        if (setup.dynamic) desc.next = &formats;
        desc.extent = kExtent;
        desc.samples = setup.samples();
        return makePipeline(pass.pass, desc);
    }
    /// Colours and depths that differ from pixel to pixel.
    VkPipeline makeGradient(const Rendering& setup, const Pass& pass) {
        PipelineDesc desc;
        desc.vertex = fullScreen();
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out )" + std::string(setup.integer() ? "u" : "") +
                                                                     R"(vec4 color;
void main() {
    vec4 at = floor(gl_FragCoord);
    color = )" + (setup.integer() ? "uvec4(at.xyyx)" : "vec4(at.xy / 80, fract(at.x / 7), 1)") +
                                                                     R"(;
    gl_FragDepth = fract((at.x + 3 * at.y) / 31);
})");
        desc.change = [](const PipelineStates& states) {
            states.depth.depthTestEnable = states.depth.depthWriteEnable = VK_TRUE;
            states.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
        };
        return makeDrawing(setup, pass, desc);
    }
    /// A blended triangle with slanted edges and depth, moved to the right by its first instance.
    VkPipeline makeTriangle(const Rendering& setup, const Pass& pass) {
        PipelineDesc desc;
        const bool views = setup.viewMask != 0, layers = !views && setup.layers > 1;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT,
                                 std::string("#version 450\n#extension GL_EXT_multiview : enable\n"
                                             "#extension GL_ARB_shader_viewport_layer_array : enable\n") +
                                     R"(void main() {
    vec3 p[3] = vec3[](vec3(-0.93, -0.81, 0.1), vec3(0.71, -0.34, 0.9), vec3(-0.22, 0.97, 0.4));
    gl_Position = vec4(p[gl_VertexIndex] + vec3(0.17 * gl_InstanceIndex, 0, 0), 1);
    )" +
                                     (views    ? "gl_Position.x += 0.23 * gl_ViewIndex;"
                                      : layers ? "gl_Layer = gl_InstanceIndex % " + std::to_string(setup.layers) + ";"
                                               : std::string()) +
                                     "}");
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out )" + std::string(setup.integer()
                                              ? "uvec4 color;\nvoid main() { color = uvec4(200, 100, 50, 9); }"
                                              : "vec4 color;\nvoid main() { color = vec4(1, 0.3, 0.1, 0.6); }"));
        desc.change = [&](const PipelineStates& states) {
            states.depth.depthTestEnable = states.depth.depthWriteEnable = states.depth.stencilTestEnable = VK_TRUE;
            states.depth.depthCompareOp = VK_COMPARE_OP_LESS;
            states.depth.front = states.depth.back = {
                VK_STENCIL_OP_KEEP, VK_STENCIL_OP_REPLACE, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xFF, 0xFF, 9};
            if (setup.integer()) return;
            states.blends[0].blendEnable = VK_TRUE;
            states.blends[0].srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
            states.blends[0].dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        };
        return makeDrawing(setup, pass, desc);
    }

    /// The gradient in all layers, whatever the samples.
    void prepare(VkCommandBuffer commands, const Rendering& setup, const Targets& targets) {
        Rendering before = setup;
        before.kind = setup.kind == Samples::ofDriver ? Samples::one : setup.kind;
        before.load = VK_ATTACHMENT_LOAD_OP_CLEAR;
        before.store = VK_ATTACHMENT_STORE_OP_STORE;
        before.depthMode = before.stencilMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
        before.area = kWhole;
        before.secondary = before.imageless = false;
        before.flags = 0;
        before.viewMask = setup.layers > 1 ? (1u << setup.layers) - 1 : 0;
        const Pass pass = makePass(before, targets);
        const VkPipeline gradient = makeGradient(before, pass);
        beginOn(commands, before, targets, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, gradient);
        vkCmdDraw(commands, 3, 1, 0, 0);
        endOn(commands, before);
        barriers(commands, targets, kLayout, kLayout);
    }
    static void clearPart(VkCommandBuffer commands, const Rendering& setup) {
        std::array<VkClearAttachment, 2> what{};
        what[0].aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
        what[0].clearValue.color = clearColor(setup);
        what[1].aspectMask = kBoth;
        what[1].clearValue.depthStencil = {0.6f, 77};
        const VkClearRect where{{{20, 10}, {21, 13}}, 0, setup.viewMask != 0 ? 1 : setup.layers};
        vkCmdClearAttachments(commands, 2, what.data(), 1, &where);
    }
    /// A triangle, a clear, and the triangle again beside.
    static void drawAll(VkCommandBuffer commands, const Rendering& setup, VkPipeline pipeline) {
        const uint32_t instances = setup.viewMask != 0 ? 1 : setup.layers;
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, instances, 0, 0);
        clearPart(commands, setup);
        vkCmdDraw(commands, 3, instances, 0, 1);
    }
    VkCommandBuffer beginSecondary(const Rendering& setup, const Pass& pass) {
        const VkCommandBuffer commands = makeCommands(VK_COMMAND_BUFFER_LEVEL_SECONDARY);
        auto formats =
            make<VkCommandBufferInheritanceRenderingInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_RENDERING_INFO);
        formats.colorAttachmentCount = 1;
        formats.pColorAttachmentFormats = &setup.color;
        formats.depthAttachmentFormat = formats.stencilAttachmentFormat = kDepth;
        formats.rasterizationSamples = setup.inherited != 0 ? setup.inherited : setup.samples();
        auto inheritance = make<VkCommandBufferInheritanceInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO,
                                                                setup.dynamic ? &formats : nullptr);
        inheritance.renderPass = pass.pass;
        auto info = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
        info.pInheritanceInfo = &inheritance;
        EXPECT_EQ(vkBeginCommandBuffer(commands, &info), VK_SUCCESS);
        return commands;
    }
    Pixels read(const Rendering& setup, const Targets& targets) {
        Pixels pixels;
        for (uint32_t layer = 0; layer < setup.layers; ++layer) {
            pixels.color.push_back(readImage(targets.color, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer));
            pixels.depth.push_back(readImage(targets.depth, VK_IMAGE_ASPECT_DEPTH_BIT, 4, layer));
            pixels.stencil.push_back(readImage(targets.depth, VK_IMAGE_ASPECT_STENCIL_BIT, 1, layer));
        }
        return pixels;
    }
    /// What all is after it was drawn over the gradient.
    Pixels draw(Rendering setup, Samples kind) {
        setup.kind = kind;
        if (kind == Samples::ofImages) setup.imageless = false;
        const Targets targets = makeTargets(setup);
        const Pass pass = makePass(setup, targets);
        const VkPipeline triangle = makeTriangle(setup, pass);
        const VkCommandBuffer commands = begin();
        barriers(commands, targets, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
        prepare(commands, setup, targets);
        beginOn(commands, setup, targets, pass);
        if (setup.secondary) {
            const VkCommandBuffer part = beginSecondary(setup, pass);
            drawAll(part, setup, triangle);
            EXPECT_EQ(vkEndCommandBuffer(part), VK_SUCCESS);
            vkCmdExecuteCommands(commands, 1, &part);
        } else {
            drawAll(commands, setup, triangle);
        }
        endOn(commands, setup);
        barriers(commands, targets, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        submit(commands);
        return read(setup, targets);
    }
    /// The driver's samples give what images of samples give, and something else than one sample.
    void expectSame(const Rendering& setup) {
        const Pixels expected = draw(setup, Samples::ofImages), drawn = draw(setup, Samples::ofDriver);
        EXPECT_EQ(drawn.color, expected.color) << setup.dynamic;
        EXPECT_EQ(drawn.depth, expected.depth) << setup.dynamic << ", mode " << setup.depthMode;
        EXPECT_EQ(drawn.stencil, expected.stencil) << setup.dynamic << ", mode " << setup.stencilMode;
        EXPECT_NE(drawn.color, draw(setup, Samples::one).color);
    }
    void expectSameInBoth(Rendering setup) {
        for (const bool dynamic : {false, true}) {
            setup.dynamic = dynamic;
            expectSame(setup);
        }
    }
};

TEST_F(MultisampledRenderTest, clears) {
    expectSameInBoth({.load = VK_ATTACHMENT_LOAD_OP_CLEAR});
    expectSameInBoth({.count = VK_SAMPLE_COUNT_16_BIT, .load = VK_ATTACHMENT_LOAD_OP_CLEAR, .area = kArea});
}

TEST_F(MultisampledRenderTest, loadsWhatOneSampleHolds) {
    for (const auto count : {VK_SAMPLE_COUNT_2_BIT, VK_SAMPLE_COUNT_4_BIT, VK_SAMPLE_COUNT_8_BIT})
        expectSameInBoth({.count = count});
    expectSameInBoth({.color = VK_FORMAT_R8G8B8A8_SRGB, .area = kArea});
}

TEST_F(MultisampledRenderTest, integersAreThoseOfSampleZero) {
    expectSameInBoth({.color = VK_FORMAT_R8G8B8A8_UINT});
}

// An aspect without a mode stays as it is.
TEST_F(MultisampledRenderTest, depthAndStencilByTheirModes) {
    for (const auto depth : {VK_RESOLVE_MODE_NONE, VK_RESOLVE_MODE_AVERAGE_BIT, VK_RESOLVE_MODE_MAX_BIT})
        expectSameInBoth({.depthMode = depth, .stencilMode = VK_RESOLVE_MODE_MAX_BIT, .area = kArea});
    expectSameInBoth({.depthMode = VK_RESOLVE_MODE_MIN_BIT, .stencilMode = VK_RESOLVE_MODE_NONE});
}

TEST_F(MultisampledRenderTest, layersAndViews) {
    expectSameInBoth({.load = VK_ATTACHMENT_LOAD_OP_CLEAR, .layers = 3});
    expectSameInBoth({.area = kArea, .layers = 3});
    expectSameInBoth({.area = kArea, .layers = 3, .viewMask = 5});
}

// The layer wants to hear of the samples of the images in dynamic rendering.
TEST_F(MultisampledRenderTest, secondaryCommandBuffers) {
    expectSame({.secondary = true});
    const Rendering setup{.dynamic = true, .secondary = true, .inherited = VK_SAMPLE_COUNT_1_BIT};
    const Pixels expected = draw({.dynamic = true}, Samples::ofImages);
    EXPECT_EQ(draw(setup, Samples::ofDriver), expected);
    if (validated()) return;
    EXPECT_EQ(draw({.dynamic = true, .secondary = true}, Samples::ofDriver), expected);
}

TEST_F(MultisampledRenderTest, secondaryCommandBuffersThatDrawWithOtherSamplesAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    Rendering setup{.dynamic = true, .secondary = true, .inherited = VK_SAMPLE_COUNT_1_BIT};
    const Targets targets = makeTargets(setup);
    for (const bool draws : {false, true}) {
        const VkCommandBuffer part = beginSecondary(setup, {}), commands = begin();
        if (draws) drawAll(part, setup, makeTriangle(setup, {}));
        EXPECT_EQ(vkEndCommandBuffer(part), VK_SUCCESS);
        Rendering one = setup;
        one.kind = Samples::one;
        beginOn(commands, one, targets, {});
        vkCmdExecuteCommands(commands, 1, &part);
        endOn(commands, one);
        EXPECT_EQ(vkEndCommandBuffer(commands) == VK_SUCCESS, !draws);
    }
}

TEST_F(MultisampledRenderTest, imagelessFramebuffers) {
    expectSame({.imageless = true});
}

// The lowest code of a normalised format with signs is -1, as is the one above it, which a resolve would leave.
TEST_F(MultisampledRenderTest, whatIsNotStoredIsKept) {
    for (const bool dynamic : {false, true}) {
        const Rendering setup{
            .dynamic = dynamic, .color = VK_FORMAT_R8G8B8A8_SNORM, .store = VK_ATTACHMENT_STORE_OP_NONE};
        const Targets targets = makeTargets(setup);
        const Pass pass = makePass(setup, targets);
        const TestBuffer codes =
            makeBuffer(VkDeviceSize{4} * kExtent.width * kExtent.height, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        std::memset(codes.data, 0x80, codes.size);
        const VkCommandBuffer commands = begin();
        barriers(commands, targets, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kExtent.width, kExtent.height, 1};
        vkCmdCopyBufferToImage(commands, codes.buffer, targets.color.image, kLayout, 1, &region);
        barriers(commands, targets, kLayout, kLayout);
        beginOn(commands, setup, targets, pass);
        endOn(commands, setup);
        barriers(commands, targets, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        submit(commands);
        EXPECT_EQ(readImage(targets.color, VK_IMAGE_ASPECT_COLOR_BIT, 4), std::vector<uint8_t>(codes.size, 0x80))
            << dynamic;
    }
}

// Edges of both triangles cross the same pixels: samples that were resolved between would be others.
TEST_F(MultisampledRenderTest, suspendedPassesKeepTheirSamples) {
    const auto drawn = [&](Samples kind, bool suspends) {
        const Rendering whole{.kind = kind, .dynamic = true};
        const Targets targets = makeTargets(whole);
        const VkPipeline triangle = makeTriangle(whole, {});
        std::vector<VkCommandBuffer> parts;
        const auto part = [&](VkRenderingFlags flags, const std::function<void(VkCommandBuffer)>& record) {
            Rendering setup = whole;
            setup.flags = flags;
            parts.push_back(begin());
            if (flags != VK_RENDERING_RESUMING_BIT) {
                barriers(parts.back(), targets, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
                prepare(parts.back(), setup, targets);
            }
            beginOn(parts.back(), setup, targets, {});
            vkCmdBindPipeline(parts.back(), VK_PIPELINE_BIND_POINT_GRAPHICS, triangle);
            record(parts.back());
            endOn(parts.back(), setup);
        };
        if (suspends) {
            part(VK_RENDERING_SUSPENDING_BIT, [](VkCommandBuffer commands) { vkCmdDraw(commands, 3, 1, 0, 0); });
            part(VK_RENDERING_RESUMING_BIT, [](VkCommandBuffer commands) { vkCmdDraw(commands, 3, 1, 0, 1); });
        } else {
            part(0, [](VkCommandBuffer commands) {
                vkCmdDraw(commands, 3, 1, 0, 0);
                vkCmdDraw(commands, 3, 1, 0, 1);
            });
        }
        barriers(parts.back(), targets, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        for (const VkCommandBuffer commands : parts) EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
        auto submission = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        submission.commandBufferCount = static_cast<uint32_t>(parts.size());
        submission.pCommandBuffers = parts.data();
        EXPECT_EQ(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE), VK_SUCCESS);
        EXPECT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
        return read(whole, targets);
    };
    EXPECT_EQ(drawn(Samples::ofDriver, true), drawn(Samples::ofImages, false));
}

}  // namespace
}  // namespace vernier::test
