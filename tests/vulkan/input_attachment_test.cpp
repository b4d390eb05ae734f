// Input attachments: a subpass reads, at its own pixel, what an earlier one drew.
#include "tests/vulkan/test_inputs.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{70, 20};  // more than one tile of the rasteriser

class InputAttachmentTest : public InputsTest {
  protected:
    /// Two subpasses: the first draws to `first` and `depth`; the second reads both and draws to `second`.
    Pass makeTwoPasses(const TestImage& first, const TestImage& second, const TestImage& depth,
                       VkSampleCountFlagBits samples) {
        std::vector<VkAttachmentDescription> attachments;
        std::vector<VkImageView> views;
        for (const TestImage* image : {&first, &second, &depth}) {
            attachments.push_back({0, image->format, image == &second ? VK_SAMPLE_COUNT_1_BIT : samples,
                                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE,
                                   VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                   VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
            views.push_back(image->view);
        }
        const VkAttachmentReference colors[] = {{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                                {1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
        const VkAttachmentReference depthReference{2, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference inputs[] = {{0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                                                {2, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}};
        VkSubpassDescription subpasses[2] = {};
        for (int i = 0; i < 2; ++i) {
            subpasses[i].colorAttachmentCount = 1;
            subpasses[i].pColorAttachments = &colors[i];
        }
        subpasses[0].pDepthStencilAttachment = &depthReference;
        subpasses[1].inputAttachmentCount = 2;
        subpasses[1].pInputAttachments = inputs;
        VkSubpassDependency dependency{};
        dependency.srcSubpass = 0;
        dependency.dstSubpass = 1;
        dependency.srcStageMask =
            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
        dependency.dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
        dependency.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
        dependency.dstAccessMask = VK_ACCESS_INPUT_ATTACHMENT_READ_BIT;
        dependency.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT;
        Pass pass;
        pass.extent = kExtent;
        pass.clears.resize(3);
        pass.clears[2].depthStencil.depth = 1;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = 3;
        info.pAttachments = attachments.data();
        info.subpassCount = 2;
        info.pSubpasses = subpasses;
        info.dependencyCount = 1;
        info.pDependencies = &dependency;
        EXPECT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, views);
        return pass;
    }

    /// Draws a position-dependent colour, reads it back as an input and returns what the second subpass made of it.
    std::vector<uint8_t> run(const std::string& glsl, VkSampleCountFlagBits samples, TestImage* second) {
        const VkImageUsageFlags input = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
        const TestImage first =
            makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | input, samples);
        *second = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        const TestImage depth =
            makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | input, samples);
        const Pass pass = makeTwoPasses(first, *second, depth, samples);
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const VkDescriptorSet set = makeInputs({{first.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                                                {depth.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}},
                                               &setLayout);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.samples = samples;
        desc.depthTest = true;
        desc.vertex = fullScreen("0.25");
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(floor(gl_FragCoord.xy) / 255.0, 0.0, 1.0); })");
        const VkPipeline writer = makePipeline(pass.pass, desc);
        desc.samples = VK_SAMPLE_COUNT_1_BIT;
        desc.depthTest = false;
        desc.subpass = 1;
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        desc.layout = makeLayout({setLayout}, 0);
        const VkPipeline reader = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, writer);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, reader);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, 3, 1, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return readImage(*second, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    }
};

TEST_F(InputAttachmentTest, readsColorAndDepthAtItsOwnPixel) {
    TestImage second;
    const auto texels = run(R"(#version 450
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput color;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput depth;
layout(location = 0) out vec4 result;
void main() { result = vec4(subpassLoad(color).yx, subpassLoad(depth).r * 4.0, 1.0); })",
                            VK_SAMPLE_COUNT_1_BIT, &second);
    for (uint32_t y = 0; y < kExtent.height; ++y)
        for (uint32_t x = 0; x < kExtent.width; ++x)
            ASSERT_EQ(pixelAt(texels, second, x, y), 0xFFFF0000u | x << 8 | y) << x << ", " << y;
}

TEST_F(InputAttachmentTest, readsSamples) {
    TestImage second;
    const auto texels = run(R"(#version 450
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInputMS color;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInputMS depth;
layout(location = 0) out vec4 result;
void main() { result = vec4(subpassLoad(color, 3).yx, subpassLoad(depth, 1).r * 4.0, 1.0); })",
                            VK_SAMPLE_COUNT_4_BIT, &second);
    for (uint32_t x = 0; x < kExtent.width; ++x)
        ASSERT_EQ(pixelAt(texels, second, x, 11), 0xFFFF0000u | x << 8 | 11u) << x;
}

}  // namespace
}  // namespace vernier::test
