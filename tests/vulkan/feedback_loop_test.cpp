// Fragments that read the attachments they draw to as textures (VK_EXT_attachment_feedback_loop_layout), by pipelines
// that are made whole and by those that are linked from libraries.
#include "tests/vulkan/test_library.h"

namespace vernier::test {
namespace {

class FeedbackLoopTest : public PipelineLibraryTest {
  protected:
    static constexpr VkImageLayout kLoop = VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT;

    std::vector<const char*> moreExtensions() override {
        std::vector<const char*> names = PipelineLibraryTest::moreExtensions();
        names.push_back(VK_EXT_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_EXTENSION_NAME);
        return names;
    }
    void* moreFeatures() override {
        loop_.pNext = PipelineLibraryTest::moreFeatures();
        return &loop_;
    }

    /// A set with one texture, read without a filter.
    VkDescriptorSet makeTexture(VkImageView view, VkDescriptorSetLayout* setLayout) {
        const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        VkSampler sampler = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        *setLayout = makeSetLayout({{0, kType, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
        const VkDescriptorSet set = makeEmptySet(*setLayout, {{kType, 1}});
        const VkDescriptorImageInfo image{sampler, view, kLoop};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.descriptorCount = 1;
        write.descriptorType = kType;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        return set;
    }

    PipelineDesc describe(const std::string& glsl, VkDescriptorSetLayout setLayout, VkPipelineCreateFlags flags) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.flags = flags;
        desc.vertex = fullScreen();
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        desc.layout = makeLayout({setLayout}, 0);
        return desc;
    }
    void drawWith(VkCommandBuffer commands, VkPipeline pipeline, const PipelineDesc& desc, VkDescriptorSet set) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, 3, 1, 0, 0);
    }

    /// Between draws of one subpass.
    static void waitForColors(VkCommandBuffer commands) {
        auto between = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
        between.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        between.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        vkCmdPipelineBarrier(
            commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
            VK_DEPENDENCY_BY_REGION_BIT | VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT, 1, &between, 0, nullptr, 0, nullptr);
    }

    /// A subpass that clears both attachments, in the layout of feedback loops.
    Pass makeLoopPass(const TestImage& image, const TestImage& depths) {
        VkAttachmentDescription attachments[2] = {};
        const VkAttachmentReference references[] = {{0, kLoop}, {1, kLoop}};
        for (uint32_t i = 0; i < 2; ++i) {
            attachments[i].format = i == 0 ? image.format : depths.format;
            attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
            attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            attachments[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            attachments[i].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        }
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = references;
        subpass.pDepthStencilAttachment = references + 1;
        VkSubpassDependency dependency{};
        dependency.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                  VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                  VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
        dependency.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
        dependency.dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
        dependency.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        dependency.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT | VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = 2;
        info.pAttachments = attachments;
        info.subpassCount = info.dependencyCount = 1;
        info.pSubpasses = &subpass;
        info.pDependencies = &dependency;
        Pass made;
        made.extent = kExtent;
        made.clears.resize(2);
        made.clears[0].color.uint32[0] = 5;
        made.clears[1].depthStencil.depth = 1;
        EXPECT_EQ(vkCreateRenderPass(device, &info, nullptr, &made.pass), VK_SUCCESS);
        makeFramebuffer(made, {image.view, depths.view});
        return made;
    }

    VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT loop_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_FEATURES_EXT, nullptr, VK_TRUE};
};

constexpr const char* kDoubled = R"(#version 450
layout(set = 0, binding = 0) uniform usampler2D self;
layout(location = 0) out uint o;
void main() { o = texelFetch(self, ivec2(gl_FragCoord.xy), 0).x * 2u + 1u; })";

// In dynamic rendering, a pass after the other doubles each pixel and adds one.
TEST_F(FeedbackLoopTest, colorsAreTextures) {
    constexpr VkFormat kFormat = VK_FORMAT_R32_UINT;
    const TestImage image = makeImage(kFormat, kExtent,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeTexture(image.view, &setLayout);
    PipelineDesc desc = describe(kDoubled, setLayout, VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    formats.colorAttachmentCount = 1;
    formats.pColorAttachmentFormats = &kFormat;
    desc.next = &formats;
    const VkPipeline pipeline = makePipeline(VK_NULL_HANDLE, desc);
    auto attachment = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = image.view;
    attachment.imageLayout = kLoop;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    auto rendering = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea.extent = kExtent;
    rendering.layerCount = rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    const VkCommandBuffer commands = begin();
    constexpr VkImageAspectFlags kAspect = VK_IMAGE_ASPECT_COLOR_BIT;
    changeLayout(commands, image.image, kAspect, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkClearColorValue five{};
    five.uint32[0] = 5;
    const VkImageSubresourceRange range{kAspect, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &five, 1, &range);
    changeLayout(commands, image.image, kAspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kLoop);
    for (uint32_t n = 0; n < 3; ++n) {
        vkCmdBeginRendering(commands, &rendering);
        drawWith(commands, pipeline, desc, set);
        vkCmdEndRendering(commands);
        changeLayout(commands, image.image, kAspect, kLoop, n < 2 ? kLoop : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }
    submit(commands);
    for (const uint32_t word : asWords(readImage(image, kAspect, 4))) ASSERT_EQ(word, 47u);
}

// In a subpass: what the load operation cleared, read by draws of which the last alone would be seen, with barriers
// between them; and the depth that each of them finds before it writes its own. By whole pipelines and linked ones.
TEST_F(FeedbackLoopTest, depthsAndColorsOfASubpass) {
    constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;
    const TestImage image = makeImage(VK_FORMAT_R32_UINT, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | kUsage);
    const TestImage depths =
        makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | kUsage);
    const Pass loop = makeLoopPass(image, depths);
    VkDescriptorSetLayout colorLayout = VK_NULL_HANDLE, depthLayout = VK_NULL_HANDLE;
    const VkDescriptorSet colorSet = makeTexture(image.view, &colorLayout);
    const VkDescriptorSet depthSet = makeTexture(depths.view, &depthLayout);
    const PipelineDesc reader =
        describe(kDoubled, colorLayout, VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    PipelineDesc tester = describe(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D self;
layout(location = 0) out uint o;
void main() { o = uint(texelFetch(self, ivec2(gl_FragCoord.xy), 0).x * 1000.0); })",
                                   depthLayout, VK_PIPELINE_CREATE_DEPTH_STENCIL_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    tester.depthTest = true;  // writes 0.5
    tester.change = [](const PipelineStates& states) { states.depth.depthCompareOp = VK_COMPARE_OP_LESS; };
    const auto drawn = [&](const std::function<void(VkCommandBuffer)>& draws) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, loop);
        draws(commands);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return asWords(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4));
    };
    std::vector<Cut> cuts = allCuts();
    cuts.emplace_back();  // whole
    for (const Cut& each : cuts) {
        SCOPED_TRACE(testing::PrintToString(each));
        cut = each;
        const VkPipeline reads = makePipeline(loop.pass, reader), tests = makePipeline(loop.pass, tester);
        const auto colors = drawn([&](VkCommandBuffer commands) {
            for (uint32_t n = 0; n < 3; ++n) {
                drawWith(commands, reads, reader, colorSet);
                waitForColors(commands);
            }
        });
        for (const uint32_t word : colors) ASSERT_EQ(word, 47u);
        const auto found = drawn([&](VkCommandBuffer commands) { drawWith(commands, tests, tester, depthSet); });
        for (const uint32_t word : found) ASSERT_EQ(word, 1000u);
    }
}

}  // namespace
}  // namespace vernier::test
