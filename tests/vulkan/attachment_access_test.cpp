// Fragments that read the attachments they draw to, in rasterisation order
// (VK_EXT_rasterization_order_attachment_access) and as textures (VK_EXT_attachment_feedback_loop_layout).
#include "tests/vulkan/test_inputs.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{80, 48};  // more than one tile of the rasteriser
constexpr uint32_t kPixels = kExtent.width * kExtent.height, kInstances = 20;
constexpr VkFormat kDepthStencil = VK_FORMAT_D32_SFLOAT_S8_UINT;

/// Squares of 2x2 pixels over the whole picture, two triangles each, at a depth that falls with the instance.
constexpr const char* kSquares = R"(#version 450
layout(location = 0) flat out uint instance;
void main() {
    int square = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
    vec2 at = vec2(square % 40, square / 40) + vec2(corner == 1 || corner > 3 ? 1 : 0, corner > 1 && corner != 4 ? 1 : 0);
    instance = uint(gl_InstanceIndex);
    gl_Position = vec4(at * 4 / vec2(80, 48) - 1, float(32 - gl_InstanceIndex) / 64, 1);
})";
constexpr uint32_t kSquareVertices = kPixels / 4 * 6;

/// Two triangles as large as the picture.
constexpr const char* kRectangle = R"(#version 450
layout(location = 0) flat out uint instance;
void main() {
    vec2 at = vec2(gl_VertexIndex == 1 || gl_VertexIndex > 3 ? 1 : -1, gl_VertexIndex > 1 && gl_VertexIndex != 4 ? 1 : -1);
    instance = uint(gl_InstanceIndex);
    gl_Position = vec4(at, float(32 - gl_InstanceIndex) / 64, 1);
})";

std::vector<uint32_t> asWords(const std::vector<uint8_t>& bytes) {
    std::vector<uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
}

class AttachmentAccessTest : public InputsTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME,
                VK_ARM_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXTENSION_NAME};
    }
    void* moreFeatures() override { return &access_; }

    /// A subpass that draws to `color` and `depth` and has as inputs them both.
    Pass makeAccessPass(const TestImage& color, const TestImage& depth) {
        VkAttachmentDescription attachments[2] = {};
        for (uint32_t i = 0; i < 2; ++i) {
            attachments[i].format = i == 0 ? color.format : depth.format;
            attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
            attachments[i].loadOp = attachments[i].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            attachments[i].storeOp = attachments[i].stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
            attachments[i].finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        }
        const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
        VkSubpassDescription subpass{};
        subpass.flags = VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_BIT_EXT |
                        VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
                        VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = references;
        subpass.pDepthStencilAttachment = references + 1;
        subpass.inputAttachmentCount = 2;
        subpass.pInputAttachments = references;
        auto info = make<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = 2;
        info.pAttachments = attachments;
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        Pass pass;
        pass.extent = kExtent;
        pass.clears.resize(2);
        pass.clears[1].depthStencil = {1, 3};
        EXPECT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
        makeFramebuffer(pass, {color.view, depth.view});
        return pass;
    }

    /// The words of the colour after kInstances of `vertices` vertices in one draw, each fragment of which runs `glsl`;
    /// `change` is done to the pipeline, which says that it reads colour, depth and stencil.
    std::vector<uint32_t> draw(VkFormat format, const char* vertex, uint32_t vertices, const std::string& glsl,
                               const std::function<void(const PipelineStates&)>& change) {
        const VkImageUsageFlags input = VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
        const TestImage color = makeImage(format, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | input);
        const TestImage depth = makeImage(kDepthStencil, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | input);
        const Pass pass = makeAccessPass(color, depth);
        const auto aspect = [&](VkImageAspectFlags bits) {
            return makeView(depth.image, VK_IMAGE_VIEW_TYPE_2D, kDepthStencil, {bits, 0, 1, 0, 1});
        };
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const VkDescriptorSet set = makeInputs({{color.view, VK_IMAGE_LAYOUT_GENERAL},
                                                {aspect(VK_IMAGE_ASPECT_DEPTH_BIT), VK_IMAGE_LAYOUT_GENERAL},
                                                {aspect(VK_IMAGE_ASPECT_STENCIL_BIT), VK_IMAGE_LAYOUT_GENERAL}},
                                               &setLayout);
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, vertex);
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        desc.layout = makeLayout({setLayout}, 0);
        desc.change = [&](const PipelineStates& states) {
            states.colors.flags = VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
            states.depth.flags =
                VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
                VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
            change(states);
        };
        const VkPipeline pipeline = makePipeline(pass.pass, desc);
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, desc.layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, vertices, kInstances, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return asWords(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4));
    }

    VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT access_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT, nullptr, VK_TRUE, VK_TRUE,
        VK_TRUE};
};

struct Mesh {
    const char* vertex;
    uint32_t vertices;
};
constexpr Mesh kMeshes[] = {{kRectangle, 6}, {kSquares, kSquareVertices}};

constexpr const char* kInstance = "#version 450\nlayout(location = 0) flat in uint instance;\n";

// Three times what is there, and the instance: any other order, or a fragment left out, gives another number.
TEST_F(AttachmentAccessTest, colorsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + instance + 1u; })";
    uint32_t expected = 0;
    for (uint32_t i = 0; i < kInstances; ++i) expected = expected * 3 + i + 1;
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates&) {});
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

// The depths that fragments find, added up: that of the instance before.
TEST_F(AttachmentAccessTest, depthsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput depth;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + uint(subpassLoad(depth).x * 64.0); })";
    uint32_t expected = 0, depth = 64;
    for (uint32_t i = 0; i < kInstances; ++i) {
        expected = expected * 3 + depth;
        depth = 32 - i;
    }
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates& states) {
            states.depth.depthTestEnable = states.depth.depthWriteEnable = VK_TRUE;
        });
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

TEST_F(AttachmentAccessTest, stencilsInOrder) {
    const std::string glsl = std::string(kInstance) + R"(
layout(input_attachment_index = 0, set = 0, binding = 0) uniform usubpassInput color;
layout(input_attachment_index = 1, set = 0, binding = 2) uniform usubpassInput stencil;
layout(location = 0) out uint o;
void main() { o = subpassLoad(color).x * 3u + subpassLoad(stencil).x; })";
    uint32_t expected = 0;
    for (uint32_t i = 0; i < kInstances; ++i) expected = expected * 3 + 3 + i;
    for (const Mesh& mesh : kMeshes) {
        const auto words = draw(VK_FORMAT_R32_UINT, mesh.vertex, mesh.vertices, glsl, [](const PipelineStates& states) {
            states.depth.stencilTestEnable = VK_TRUE;
            states.depth.front = {VK_STENCIL_OP_KEEP,
                                  VK_STENCIL_OP_INCREMENT_AND_CLAMP,
                                  VK_STENCIL_OP_KEEP,
                                  VK_COMPARE_OP_ALWAYS,
                                  0xFF,
                                  0xFF,
                                  0};
            states.depth.back = states.depth.front;
        });
        for (uint32_t n = 0; n < kPixels; ++n) ASSERT_EQ(words[n], expected) << n;
    }
}

class FeedbackLoopTest : public DrawTest {
  protected:
    static constexpr VkImageLayout kLoop = VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT;

    uint32_t apiVersion() override { return VK_API_VERSION_1_3; }
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        loop_.pNext = &core_;
        core_.dynamicRendering = VK_TRUE;
        return &loop_;
    }

    /// A set with one texture, read without a filter.
    VkDescriptorSet makeTexture(VkImageView view, VkDescriptorSetLayout* layout) {
        const auto samplerInfo = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
        VkSampler sampler = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSampler(device, &samplerInfo, nullptr, &sampler), VK_SUCCESS);
        defer([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
        constexpr VkDescriptorType kType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        *layout = makeSetLayout({{0, kType, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
        const VkDescriptorSet set = makeEmptySet(*layout, {{kType, 1}});
        const VkDescriptorImageInfo image{sampler, view, kLoop};
        auto write = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet = set;
        write.descriptorCount = 1;
        write.descriptorType = kType;
        write.pImageInfo = &image;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        return set;
    }

    void barrier(VkCommandBuffer commands, const TestImage& image, VkImageAspectFlags aspects, VkImageLayout from,
                 VkImageLayout to) {
        auto move = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        move.srcAccessMask = move.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        move.oldLayout = from;
        move.newLayout = to;
        move.srcQueueFamilyIndex = move.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        move.image = image.image;
        move.subresourceRange = {aspects, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                             nullptr, 0, nullptr, 1, &move);
    }

    PipelineDesc describe(const std::string& glsl, VkDescriptorSetLayout layout, VkPipelineCreateFlags flags) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.flags = flags;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, kRectangle);
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, glsl);
        desc.layout = makeLayout({layout}, 0);
        return desc;
    }
    void drawWith(VkCommandBuffer commands, VkPipeline pipeline, VkPipelineLayout layout, VkDescriptorSet set) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
        vkCmdDraw(commands, 6, 1, 0, 0);
    }

    VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT loop_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_FEATURES_EXT, nullptr, VK_TRUE};
    VkPhysicalDeviceVulkan13Features core_ =
        make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
};

// In dynamic rendering, a pass after the other doubles each pixel and adds one.
TEST_F(FeedbackLoopTest, colorsAreTextures) {
    constexpr VkFormat kFormat = VK_FORMAT_R32_UINT;
    const TestImage color = makeImage(kFormat, kExtent,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    const VkDescriptorSet set = makeTexture(color.view, &setLayout);
    PipelineDesc desc = describe(R"(#version 450
layout(set = 0, binding = 0) uniform usampler2D self;
layout(location = 0) out uint o;
void main() { o = texelFetch(self, ivec2(gl_FragCoord.xy), 0).x * 2u + 1u; })",
                                 setLayout, VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
    auto formats = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    formats.colorAttachmentCount = 1;
    formats.pColorAttachmentFormats = &kFormat;
    desc.next = &formats;
    const VkPipeline pipeline = makePipeline(VK_NULL_HANDLE, desc);
    auto attachment = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    attachment.imageView = color.view;
    attachment.imageLayout = kLoop;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    auto rendering = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea.extent = kExtent;
    rendering.layerCount = rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    const VkCommandBuffer commands = begin();
    constexpr VkImageAspectFlags kColor = VK_IMAGE_ASPECT_COLOR_BIT;
    barrier(commands, color, kColor, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkClearColorValue five{};
    five.uint32[0] = 5;
    const VkImageSubresourceRange range{kColor, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, color.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &five, 1, &range);
    barrier(commands, color, kColor, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kLoop);
    for (uint32_t n = 0; n < 3; ++n) {
        vkCmdBeginRendering(commands, &rendering);
        drawWith(commands, pipeline, desc.layout, set);
        vkCmdEndRendering(commands);
        barrier(commands, color, kColor, kLoop, n < 2 ? kLoop : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    }
    submit(commands);
    for (const uint32_t word : asWords(readImage(color, kColor, 4))) ASSERT_EQ(word, 47u);
}

// In a subpass: what the load operation cleared, read by draws of which the last alone would be seen, with barriers
// between them; and the depth that each of them finds before it writes its own.
TEST_F(FeedbackLoopTest, depthsAndColorsOfASubpass) {
    constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;
    const TestImage color = makeImage(VK_FORMAT_R32_UINT, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | kUsage);
    const TestImage depth =
        makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | kUsage);
    VkAttachmentDescription attachments[2] = {};
    const VkAttachmentReference references[] = {{0, kLoop}, {1, kLoop}};
    for (uint32_t i = 0; i < 2; ++i) {
        attachments[i].format = i == 0 ? color.format : depth.format;
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
                              VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
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
    Pass pass;
    pass.extent = kExtent;
    pass.clears.resize(2);
    pass.clears[0].color.uint32[0] = 5;
    pass.clears[1].depthStencil.depth = 1;
    ASSERT_EQ(vkCreateRenderPass(device, &info, nullptr, &pass.pass), VK_SUCCESS);
    makeFramebuffer(pass, {color.view, depth.view});

    constexpr VkPipelineCreateFlags kFlags = VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT |
                                             VK_PIPELINE_CREATE_DEPTH_STENCIL_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;
    VkDescriptorSetLayout colorLayout = VK_NULL_HANDLE, depthLayout = VK_NULL_HANDLE;
    const VkDescriptorSet colorSet = makeTexture(color.view, &colorLayout);
    const VkDescriptorSet depthSet = makeTexture(depth.view, &depthLayout);
    PipelineDesc reader = describe(R"(#version 450
layout(set = 0, binding = 0) uniform usampler2D self;
layout(location = 0) out uint o;
void main() { o = texelFetch(self, ivec2(gl_FragCoord.xy), 0).x * 2u + 1u; })",
                                   colorLayout, kFlags);
    PipelineDesc tester = describe(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D self;
layout(location = 0) out uint o;
void main() { o = uint(texelFetch(self, ivec2(gl_FragCoord.xy), 0).x * 1000.0); })",
                                   depthLayout, kFlags);
    tester.depthTest = true;  // writes 0.5
    tester.change = [](const PipelineStates& states) { states.depth.depthCompareOp = VK_COMPARE_OP_LESS; };
    const VkPipeline reads = makePipeline(pass.pass, reader), tests = makePipeline(pass.pass, tester);
    for (const bool ofDepth : {false, true}) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        if (ofDepth) {
            drawWith(commands, tests, tester.layout, depthSet);
        } else {
            for (uint32_t n = 0; n < 3; ++n) {
                drawWith(commands, reads, reader.layout, colorSet);
                auto between = make<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
                between.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
                between.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
                vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_DEPENDENCY_BY_REGION_BIT | VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT, 1, &between, 0,
                                     nullptr, 0, nullptr);
            }
        }
        vkCmdEndRenderPass(commands);
        submit(commands);
        for (const uint32_t word : asWords(readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4)))
            ASSERT_EQ(word, ofDepth ? 1000u : 47u);
    }
}

}  // namespace
}  // namespace vernier::test
