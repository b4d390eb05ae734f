// Where primitives go: layers, viewports, views, and the depth range of clip space.
#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{96, 80};  // more than one tile of the rasteriser
constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

class LayersTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override {
        return {VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME, VK_KHR_MULTIVIEW_EXTENSION_NAME,
                VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME};
    }
    void* moreFeatures() override {
        multiview_.multiview = VK_TRUE;
        clipControl_.depthClipControl = VK_TRUE;
        multiview_.pNext = &clipControl_;
        return &multiview_;
    }
    PipelineDesc defaults() {
        PipelineDesc desc;
        desc.extent = kExtent;
        return desc;
    }
    TestImage layered(uint32_t layers) {
        return makeImage(kFormat, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_SAMPLE_COUNT_1_BIT, layers);
    }
    /// One draw of a pass.
    void render(const Pass& pass, VkPipeline pipeline, uint32_t vertices, uint32_t instances) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, pass);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, vertices, instances, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
    }
    /// gl_InstanceIndex + 1 in every channel, as a code.
    VkShaderModule instanceColor() {
        return makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) flat in int instance;
layout(location = 0) out vec4 color;
void main() { color = vec4((instance + 1) / 255.0); })");
    }
    uint32_t redAt(const TestImage& image, uint32_t layer, uint32_t x, uint32_t y) {
        return pixelAt(readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4, layer), image, x, y) & 0xFF;
    }

  private:
    VkPhysicalDeviceMultiviewFeatures multiview_ =
        make<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES);
    VkPhysicalDeviceDepthClipControlFeaturesEXT clipControl_ = make<VkPhysicalDeviceDepthClipControlFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_CONTROL_FEATURES_EXT);
};

TEST_F(LayersTest, layersFromTheVertexShader) {
    const TestImage image = layered(4);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 4);
    PipelineDesc desc = defaults();
    // Instance n goes to layer 3 - n; instances 4 and 5 go nowhere. The second layer from the top stays empty.
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) flat out int instance;
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, 0.5, gl_InstanceIndex == 1 ? -1 : 1);
    gl_Layer = gl_VertexIndex == 0 ? 3 - gl_InstanceIndex : 0;
    instance = gl_InstanceIndex;
})");
    desc.fragment = instanceColor();
    render(pass, makePipeline(pass.pass, desc), 3, 6);
    for (uint32_t layer = 0; layer < 4; ++layer) {
        for (const auto& [x, y] : {std::pair{0u, 0u}, {70u, 10u}, {95u, 79u}}) {
            EXPECT_EQ(redAt(image, layer, x, y), layer == 2 ? 0 : 4 - layer) << "layer " << layer;
        }
    }
}

TEST_F(LayersTest, sixteenViewports) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    ASSERT_EQ(properties.limits.maxViewports, 16u);
    const TestImage image = layered(1);
    const Pass pass = makePass(image);
    PipelineDesc desc = defaults();
    std::vector<VkViewport> viewports;
    std::vector<VkRect2D> scissors;
    for (int32_t n = 0; n < 16; ++n) {
        const int32_t x = n % 4 * 24, y = n / 4 * 20;
        // Even ones are upside down.
        viewports.push_back({static_cast<float>(x), static_cast<float>(n % 2 == 0 ? y + 20 : y), 24,
                             n % 2 == 0 ? -20.0f : 20.0f, 0, 1});
        scissors.push_back({{x + 1, y + 1}, {22, 18}});
    }
    desc.change = [&](const PipelineStates& states) {
        states.viewport.viewportCount = states.viewport.scissorCount = 16;
        states.viewport.pViewports = viewports.data();
        states.viewport.pScissors = scissors.data();
    };
    // The upper left half of each viewport. The left corner lies far outside, beyond the guard band of some viewports.
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
layout(location = 0) flat out int instance;
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 1 : -1, gl_VertexIndex == 2 ? 1 : -1);
    gl_Position = vec4(gl_InstanceIndex == 15 && gl_VertexIndex > 0 ? p * 4000 + 3999 : p, 0.5, 1);
    gl_ViewportIndex = gl_InstanceIndex;
    instance = gl_InstanceIndex;
})");
    desc.fragment = instanceColor();
    render(pass, makePipeline(pass.pass, desc), 3, 17);  // there is no viewport 16
    const auto texels = readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (uint32_t n = 0; n < 16; ++n) {
        const uint32_t x = n % 4 * 24, y = n / 4 * 20;
        const auto at = [&](uint32_t dx, uint32_t dy) { return pixelAt(texels, image, x + dx, y + dy) & 0xFF; };
        EXPECT_EQ(at(0, 10), 0u) << n << ": outside the scissor";
        EXPECT_EQ(at(2, n % 2 == 0 ? 16 : 2), n + 1) << n;
        if (n != 15) {
            EXPECT_EQ(at(21, n % 2 == 0 ? 2 : 16), 0u) << n;
        }
    }
}

TEST_F(LayersTest, multiview) {
    const TestImage image = layered(3);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 1, 0b101);
    PipelineDesc desc = defaults();
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
#extension GL_EXT_multiview : require
layout(location = 0) flat out int instance;
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, 0.5, 1);
    instance = 10 * gl_ViewIndex;
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
#extension GL_EXT_multiview : require
layout(location = 0) flat in int instance;
layout(location = 0) out vec4 color;
void main() { color = vec4((instance + gl_ViewIndex + 1) / 255.0); })");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_OCCLUSION, 2);

    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, queries, 0, 2);
    const VkClearColorValue before{{50 / 255.0f, 0, 0, 0}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 3};
    vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &before, 1, &all);
    beginPass(commands, pass);
    vkCmdBeginQuery(commands, queries, 0, VK_QUERY_CONTROL_PRECISE_BIT);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndQuery(commands, queries, 0);
    const VkClearAttachment clear{VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{200 / 255.0f, 0, 0, 0}}}};
    const VkClearRect corner{{{0, 0}, {8, 8}}, 0, 1};
    vkCmdClearAttachments(commands, 1, &clear, 1, &corner);
    vkCmdEndRenderPass(commands);
    submit(commands);
    EXPECT_EQ(redAt(image, 0, 90, 70), 1u);
    EXPECT_EQ(redAt(image, 1, 90, 70), 50u);  // not a view: neither cleared nor drawn to
    EXPECT_EQ(redAt(image, 2, 90, 70), 23u);
    EXPECT_EQ(redAt(image, 0, 7, 7), 200u);
    EXPECT_EQ(redAt(image, 1, 7, 7), 50u);
    EXPECT_EQ(redAt(image, 2, 7, 7), 200u);
    uint64_t counts[2] = {};
    ASSERT_EQ(vkGetQueryPoolResults(device, queries, 0, 2, sizeof counts, counts, 8, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    EXPECT_EQ(counts[0] + counts[1], 2 * kExtent.width * kExtent.height);
}

TEST_F(LayersTest, clipSpaceDepthFromMinusOneToOne) {
    const TestImage color = layered(1);
    const TestImage depth = makeImage(VK_FORMAT_D32_SFLOAT, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const Pass pass = makePass(color, &depth);
    auto control = make<VkPipelineViewportDepthClipControlCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT);
    control.negativeOneToOne = VK_TRUE;
    PipelineDesc desc = defaults();
    desc.depthTest = true;
    desc.fragment = constantColor("1");
    const VkViewport viewport{0,     0,    static_cast<float>(kExtent.width), static_cast<float>(kExtent.height),
                              0.25f, 0.75f};
    desc.change = [&](const PipelineStates& states) {
        states.viewport.pNext = &control;
        states.viewport.pViewports = &viewport;
    };
    // From depth -2 at the left edge to 1 at the right one: the left third is clipped.
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, (p.x + 1) * 1.5 - 2, 1);
})");
    render(pass, makePipeline(pass.pass, desc), 3, 1);
    const auto texels = readImage(depth, VK_IMAGE_ASPECT_DEPTH_BIT, 4);
    for (uint32_t x = 0; x < kExtent.width; ++x) {
        float stored = 0;
        std::memcpy(&stored, texels.data() + 4 * (size_t{40} * kExtent.width + x), 4);
        const float clip = (static_cast<float>(x) + 0.5f) / static_cast<float>(kExtent.width) * 3 - 2;
        if (clip < -1) {
            EXPECT_EQ(stored, 1.0f) << x;
        } else {
            EXPECT_NEAR(stored, 0.25f + (clip + 1) * 0.25f, 1e-6f) << x;
        }
    }
}

TEST_F(LayersTest, fragmentsKnowTheirLayerAndViewport) {
    VERNIER_SKIP_WHEN_VALIDATED();  // SPIR-V 1.0 wants the Geometry capability for gl_Layer in fragment shaders
    const TestImage image = layered(2);
    const Pass pass = makePass(image, nullptr, nullptr, VK_SAMPLE_COUNT_1_BIT, 2);
    PipelineDesc desc = defaults();
    const VkViewport viewport{0, 0, static_cast<float>(kExtent.width), static_cast<float>(kExtent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, kExtent};
    const std::vector<VkViewport> viewports(3, viewport);
    const std::vector<VkRect2D> scissors(3, scissor);
    desc.change = [&](const PipelineStates& states) {
        states.viewport.viewportCount = states.viewport.scissorCount = 3;
        states.viewport.pViewports = viewports.data();
        states.viewport.pScissors = scissors.data();
    };
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : require
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, 0.5, 1);
    gl_Layer = gl_InstanceIndex;
    gl_ViewportIndex = 2 - gl_InstanceIndex;
})");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4((16 * gl_Layer + gl_ViewportIndex) / 255.0); })");
    render(pass, makePipeline(pass.pass, desc), 3, 2);
    EXPECT_EQ(redAt(image, 0, 80, 70), 2u);
    EXPECT_EQ(redAt(image, 1, 80, 70), 17u);
}

}  // namespace
}  // namespace vernier::test
