// VK_EXT_multisampled_render_to_single_sampled: subpasses of several sample counts, input attachments, parts of images,
// what is reported and refused.
#include <algorithm>
#include <array>

#include "tests/vulkan/test_multisampled.h"

namespace vernier::test {
namespace {

constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;
constexpr auto kOne = VK_SAMPLE_COUNT_1_BIT, kFour = VK_SAMPLE_COUNT_4_BIT;

class MultisampledSubpassTest : public MultisampledTest {
  protected:
    struct Attachment {
        VkImageView view;
        VkFormat format;
        VkSampleCountFlagBits samples;
        bool clears = false;
    };
    /// Of a color attachment, and more where they are not VK_ATTACHMENT_UNUSED.
    struct Subpass {
        VkSampleCountFlagBits samples;  // of the rasterisation
        uint32_t color = 0, colorTo = VK_ATTACHMENT_UNUSED;
        uint32_t depth = VK_ATTACHMENT_UNUSED, depthTo = VK_ATTACHMENT_UNUSED;
        std::vector<VkAttachmentReference2> inputs = {};
        uint32_t viewMask = 0;
    };

    /// Every subpass waits for the one before, and may wait for itself. All attachments are loaded and stored.
    Pass makePass(const std::vector<Attachment>& from, const std::vector<Subpass>& subpasses,
                  VkExtent2D extent = kExtent) {
        Pass pass;
        pass.extent = extent;
        pass.clears.resize(from.size());
        std::vector<VkAttachmentDescription2> attachments;
        std::vector<VkImageView> views;
        for (const Attachment& one : from) {
            attachments.push_back(describe(one.format, one.samples,
                                           one.clears ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD));
            views.push_back(one.view);
        }
        struct Chain {
            VkAttachmentReference2 color, colorTo, depth, depthTo;
            VkMultisampledRenderToSingleSampledInfoEXT single;
            VkSubpassDescriptionDepthStencilResolve resolve;
        };
        std::vector<Chain> chains(subpasses.size());
        std::vector<VkSubpassDescription2> infos;
        std::vector<VkSubpassDependency2> dependencies;
        for (uint32_t n = 0; n < subpasses.size(); ++n) {
            const Subpass& one = subpasses[n];
            Chain& chain = chains[n];
            chain.color = refer(one.color, VK_IMAGE_ASPECT_COLOR_BIT);
            chain.colorTo = refer(one.colorTo, VK_IMAGE_ASPECT_COLOR_BIT);
            chain.depth = refer(one.depth, kBoth);
            chain.depthTo = refer(one.depthTo, kBoth);
            chain.single = toSingle(one.samples != kOne && from[one.color].samples == kOne, one.samples);
            chain.resolve = make<VkSubpassDescriptionDepthStencilResolve>(
                VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE, &chain.single);
            chain.resolve.depthResolveMode = chain.resolve.stencilResolveMode = VK_RESOLVE_MODE_MAX_BIT;
            if (one.depthTo != VK_ATTACHMENT_UNUSED) chain.resolve.pDepthStencilResolveAttachment = &chain.depthTo;
            auto& info = infos.emplace_back(make<VkSubpassDescription2>(VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2));
            info.pNext = one.depth != VK_ATTACHMENT_UNUSED ? static_cast<const void*>(&chain.resolve) : &chain.single;
            info.viewMask = one.viewMask;
            info.colorAttachmentCount = 1;
            info.pColorAttachments = &chain.color;
            if (one.colorTo != VK_ATTACHMENT_UNUSED) info.pResolveAttachments = &chain.colorTo;
            info.pDepthStencilAttachment = &chain.depth;
            info.inputAttachmentCount = static_cast<uint32_t>(one.inputs.size());
            info.pInputAttachments = one.inputs.data();
            for (const uint32_t before : {n - 1, n}) {
                if (before == ~0u) continue;
                auto& wait =
                    dependencies.emplace_back(make<VkSubpassDependency2>(VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2));
                wait.srcSubpass = before;
                wait.dstSubpass = n;
                wait.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                    VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
                wait.dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
                wait.srcAccessMask =
                    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
                wait.dstAccessMask = VK_ACCESS_INPUT_ATTACHMENT_READ_BIT;
                wait.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT;
                if (one.viewMask != 0) wait.dependencyFlags |= VK_DEPENDENCY_VIEW_LOCAL_BIT;
            }
        }
        auto info = make<VkRenderPassCreateInfo2>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2);
        info.attachmentCount = static_cast<uint32_t>(attachments.size());
        info.pAttachments = attachments.data();
        info.subpassCount = static_cast<uint32_t>(infos.size());
        info.pSubpasses = infos.data();
        info.dependencyCount = static_cast<uint32_t>(dependencies.size());
        info.pDependencies = dependencies.data();
        EXPECT_EQ(vkCreateRenderPass2(device, &info, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, views);
        return pass;
    }

    /// A triangle with slanted edges and depth, moved to the right by its first instance.
    PipelineDesc triangle(VkSampleCountFlagBits samples, uint32_t subpass = 0) {
        PipelineDesc desc;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    vec3 p[3] = vec3[](vec3(-0.93, -0.81, 0.1), vec3(0.71, -0.34, 0.9), vec3(-0.22, 0.97, 0.4));
    gl_Position = vec4(p[gl_VertexIndex] + vec3(0.17 * gl_InstanceIndex, 0, 0), 1);
})");
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(fract(floor(gl_FragCoord.xy) / 9), 0.3, 0.6); })");
        desc.extent = kExtent;
        desc.samples = samples;
        desc.subpass = subpass;
        return desc;
    }
    static void draw(VkCommandBuffer commands, VkPipeline pipeline, uint32_t instance) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, 3, 1, 0, instance);
    }

    /// The layers of an attachment that is cleared and drawn to by the subpasses of one render pass, or by as many
    /// render passes.
    std::vector<std::vector<uint8_t>> drawBy(const std::vector<Subpass>& subpasses, uint32_t layers, bool together);
    /// The same as as many render passes; and where the first subpass alone has drawn, or the last, as with one sample.
    void expectSame(std::vector<Subpass> subpasses, uint32_t layers);
    /// What a subpass made of what it has drawn and of another attachment, sample by sample.
    std::vector<uint8_t> readSamples(bool ofDriver);
};

std::vector<std::vector<uint8_t>> MultisampledSubpassTest::drawBy(const std::vector<Subpass>& subpasses,
                                                                  uint32_t layers, bool together) {
    const TestImage image = makeTarget(kColor, kOne, kToSingle, layers);
    const Attachment cleared{image.view, kColor, kOne, true}, loaded{image.view, kColor, kOne, false};
    const VkCommandBuffer commands = begin();
    barrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
    if (together) {
        const Pass pass = makePass({cleared}, subpasses);
        beginPass(commands, pass);
        for (uint32_t n = 0; n < subpasses.size(); ++n) {
            if (n != 0) vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
            draw(commands, makePipeline(pass.pass, triangle(subpasses[n].samples, n)), n);
        }
        vkCmdEndRenderPass(commands);
    } else {
        const Subpass all{.samples = kOne, .viewMask = subpasses.back().viewMask};
        beginPass(commands, makePass({cleared}, {all}));
        vkCmdEndRenderPass(commands);
        for (uint32_t n = 0; n < subpasses.size(); ++n) {
            barrier(commands, image, kLayout, kLayout);
            const Pass pass = makePass({loaded}, {subpasses[n]});
            beginPass(commands, pass);
            draw(commands, makePipeline(pass.pass, triangle(subpasses[n].samples)), n);
            vkCmdEndRenderPass(commands);
        }
    }
    barrier(commands, image, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    submit(commands);
    std::vector<std::vector<uint8_t>> result;
    for (uint32_t layer = 0; layer < layers; ++layer)
        result.push_back(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer));
    return result;
}

void MultisampledSubpassTest::expectSame(std::vector<Subpass> subpasses, uint32_t layers) {
    const auto drawn = drawBy(subpasses, layers, true);
    EXPECT_EQ(drawn, drawBy(subpasses, layers, false));
    for (Subpass& subpass : subpasses) subpass.samples = kOne;
    const auto ofOne = drawBy(subpasses, layers, true);
    const auto last = static_cast<uint32_t>(subpasses.size() - 1);
    for (const uint32_t x : {16u, 48 + 6 * last}) {
        const size_t at = 4 * (20 * kExtent.width + x);
        EXPECT_NE(ofOne[0][at + 2], 0) << x;
        EXPECT_TRUE(std::equal(&drawn[0][at], &drawn[0][at] + 4, &ofOne[0][at])) << x;
    }
}

TEST_F(MultisampledSubpassTest, countsOfSubpassesDiffer) {
    expectSame(
        {{.samples = kFour}, {.samples = VK_SAMPLE_COUNT_2_BIT}, {.samples = kOne}, {.samples = VK_SAMPLE_COUNT_8_BIT}},
        1);
}

// The second subpass clears a view of the attachment and goes on with the other one.
TEST_F(MultisampledSubpassTest, viewsOfSubpassesDiffer) {
    expectSame({{.samples = kFour, .viewMask = 1}, {.samples = kFour, .viewMask = 3}}, 2);
}

std::vector<uint8_t> MultisampledSubpassTest::readSamples(bool ofDriver) {
    const VkSampleCountFlagBits samples = ofDriver ? kOne : kFour;
    const VkImageCreateFlags flags = ofDriver ? kToSingle : 0;
    const TestImage color = makeTarget(kColor, samples, flags), other = makeTarget(kColor, samples, flags),
                    depth = makeTarget(kDepth, samples, flags), result = makeTarget(kColor, kOne, 0);
    const VkImageView depths =
        makeView(depth.image, VK_IMAGE_VIEW_TYPE_2D, kDepth, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1});
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set =
        makeInputs({{color.view, kLayout}, {depths, kLayout}, {other.view, kLayout}}, &setLayout);
    const Pass before = makePass({{other.view, kColor, samples, true}}, {{.samples = samples}});
    Subpass subpass{.samples = kFour, .color = 0, .depth = 1};
    subpass.inputs = {refer(0, VK_IMAGE_ASPECT_COLOR_BIT), refer(1, VK_IMAGE_ASPECT_DEPTH_BIT),
                      refer(2, VK_IMAGE_ASPECT_COLOR_BIT)};
    std::vector<Attachment> attachments{
        {color.view, kColor, samples, true}, {depth.view, kDepth, samples, true}, {other.view, kColor, samples}};
    if (!ofDriver) {
        subpass.colorTo = 3;
        attachments.push_back({result.view, kColor, kOne});
    }
    Pass pass = makePass(attachments, {subpass});
    pass.clears[1].depthStencil.depth = 1;

    PipelineDesc filling = triangle(samples);
    filling.vertex = fullScreen();
    PipelineDesc first = triangle(kFour);
    first.depthTest = true;
    PipelineDesc second = triangle(kFour);
    second.vertex = filling.vertex;
    second.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInputMS drawn;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInputMS depth;
layout(input_attachment_index = 2, set = 0, binding = 2) uniform subpassInputMS other;
layout(location = 0) out vec4 color;
void main() {
    float one = subpassLoad(drawn, gl_SampleID).b, two = subpassLoad(other, gl_SampleID).r;
    color = vec4(one * (gl_SampleID + 1) / 4.0, subpassLoad(depth, gl_SampleID).r, two, 1);
})");
    second.layout = makeLayout({setLayout}, 0);
    const VkPipeline fill = makePipeline(before.pass, filling), one = makePipeline(pass.pass, first),
                     two = makePipeline(pass.pass, second);
    const VkCommandBuffer commands = begin();
    for (const TestImage* image : {&color, &other, &depth, &result})
        barrier(commands, *image, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
    beginPass(commands, before);
    draw(commands, fill, 0);
    vkCmdEndRenderPass(commands);
    barrier(commands, other, kLayout, kLayout);
    beginPass(commands, pass);
    draw(commands, one, 0);
    auto drawn = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    drawn.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    drawn.dstAccessMask = VK_ACCESS_INPUT_ATTACHMENT_READ_BIT;
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_DEPENDENCY_BY_REGION_BIT, 1, &drawn, 0, nullptr, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, second.layout, 0, 1, &set, 0, nullptr);
    draw(commands, two, 0);
    vkCmdEndRenderPass(commands);
    const TestImage& last = ofDriver ? color : result;
    barrier(commands, last, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    submit(commands);
    return readImage(last, VK_IMAGE_ASPECT_COLOR_BIT, 4);
}

// Attachments that are drawn to, seen by a view of one aspect, and one that is not.
TEST_F(MultisampledSubpassTest, inputsHaveTheSamplesOfTheSubpass) {
    if (validated()) GTEST_SKIP() << "the layer takes the samples of the image for those of the input";
    const std::vector<uint8_t> drawn = readSamples(true);
    EXPECT_EQ(drawn, readSamples(false));
    EXPECT_NE(std::count(drawn.begin(), drawn.end(), drawn[0]), static_cast<ptrdiff_t>(drawn.size()));
}

// A layer of a level, which is loaded and drawn to; all else stays.
TEST_F(MultisampledSubpassTest, partsOfImages) {
    constexpr VkExtent2D kHalf{kExtent.width / 2, kExtent.height / 2};
    const auto drawn = [&](bool ofDriver) {
        auto info = flatImage(kColor, kExtent, kColorUsage);
        info.arrayLayers = 3;
        info.mipLevels = 2;
        info.flags = ofDriver ? kToSingle : 0;
        const TestImage image = makeImage(info);
        const VkImageView part =
            makeView(image.image, VK_IMAGE_VIEW_TYPE_2D, kColor, {VK_IMAGE_ASPECT_COLOR_BIT, 1, 1, 2, 1});
        const TestImage many = makeTarget(kColor, kFour, 0);
        Pass pass = ofDriver ? makePass({{part, kColor, kOne}}, {{.samples = kFour}}, kHalf)
                             : makePass({{many.view, kColor, kFour, true}, {part, kColor, kOne}},
                                        {{.samples = kFour, .colorTo = 1}}, kHalf);
        pass.clears[0].color = {{0.2f, 0.4f, 0.6f, 1}};  // of the other images: as what is loaded
        PipelineDesc desc = triangle(kFour);
        desc.extent = kHalf;
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        barrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        barrier(commands, many, VK_IMAGE_LAYOUT_UNDEFINED, kLayout);
        const auto clear = [&](const VkClearColorValue& value, const VkImageSubresourceRange& range) {
            vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
            barrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        };
        clear({}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 2, 0, 3});
        clear(pass.clears[0].color, {VK_IMAGE_ASPECT_COLOR_BIT, 1, 1, 2, 1});
        barrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kLayout);
        beginPass(commands, pass);
        draw(commands, pipeline, 0);
        vkCmdEndRenderPass(commands);
        barrier(commands, image, kLayout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkDeviceSize bytes = VkDeviceSize{4} * kHalf.width * kHalf.height;
        const TestBuffer buffer = makeBuffer(3 * bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 1, 0, 3};
        region.imageExtent = {kHalf.width, kHalf.height, 1};
        vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.buffer, 1, &region);
        submit(commands);
        const auto* data = static_cast<const uint8_t*>(buffer.data);
        return std::vector<uint8_t>(data, data + buffer.size);
    };
    EXPECT_EQ(drawn(true), drawn(false));
}

TEST_F(MultisampledSubpassTest, whatFormatsSay) {
    auto query = make<VkSubpassResolvePerformanceQueryEXT>(VK_STRUCTURE_TYPE_SUBPASS_RESOLVE_PERFORMANCE_QUERY_EXT);
    query.optimal = 7;
    auto format = make<VkFormatProperties2>(VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2, &query);
    vkGetPhysicalDeviceFormatProperties2(physicalDevice, VK_FORMAT_R8G8B8A8_UNORM, &format);
    EXPECT_EQ(query.optimal, VK_FALSE);
    VkImageFormatProperties properties{};
    EXPECT_EQ(
        vkGetPhysicalDeviceImageFormatProperties(physicalDevice, kDepth, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                                                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, kToSingle, &properties),
        VK_SUCCESS);
    EXPECT_EQ(properties.sampleCounts, 31u);
}

TEST_F(MultisampledSubpassTest, whatDoesNotFitIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const TestImage plain = makeTarget(kColor, kOne, 0);
    const Pass pass = makePass({{plain.view, kColor, kOne}}, {{.samples = kFour}});
    const VkCommandBuffer commands = begin();
    beginPass(commands, pass);
    vkCmdEndRenderPass(commands);
    EXPECT_NE(vkEndCommandBuffer(commands), VK_SUCCESS) << "the image was not created for it";
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages.back().find("MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED"), std::string::npos) << messages.back();
    EXPECT_EQ(makePipeline(pass.pass, triangle(VK_SAMPLE_COUNT_2_BIT), VK_ERROR_UNKNOWN), nullptr)
        << "other samples than the subpass";
}

}  // namespace
}  // namespace vernier::test
