// VK_EXT_depth_range_unrestricted: depths outside 0..1, which float formats keep and fixed-point ones take into it.
#include <algorithm>
#include <array>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 32};

class DepthRangeTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_DEPTH_RANGE_UNRESTRICTED_EXTENSION_NAME}; }

    struct Target {
        TestImage color, depth;
        Pass pass;
    };
    Target makeTarget(VkFormat format, float clear) {
        Target target;
        target.color = makeImage(VK_FORMAT_R32_SFLOAT, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        target.depth = makeImage(format, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        target.pass = makePass(target.color, &target.depth);
        target.pass.clears[0].color = {{-9, 0, 0, 0}};
        target.pass.clears[1].depthStencil.depth = clear;
        return target;
    }
    /// Depths of the viewport from -1 to 3.
    PipelineDesc draw(const std::string& z, VkCompareOp compare) {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.depthTest = true;
        desc.vertex = fullScreen(z);
        desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out float o;
void main() { o = gl_FragCoord.z; })");
        desc.change = [this, compare](const PipelineStates& states) {
            states.depth.depthCompareOp = compare;
            states.viewport.pViewports = &viewport_;
            if (more_) more_(states);
        };
        return desc;
    }
    void run(const Target& target, VkPipeline pipeline) { drawTriangle(target.pass, pipeline); }

    std::vector<float> colors(const Target& target) { return floats(target.color, VK_IMAGE_ASPECT_COLOR_BIT); }
    std::vector<float> depths(const Target& target) {
        if (target.depth.format != VK_FORMAT_D16_UNORM) return floats(target.depth, VK_IMAGE_ASPECT_DEPTH_BIT);
        const auto bytes = readImage(target.depth, VK_IMAGE_ASPECT_DEPTH_BIT, 2);
        std::vector<uint16_t> codes(bytes.size() / 2);
        std::memcpy(codes.data(), bytes.data(), bytes.size());
        std::vector<float> values;
        for (const uint16_t code : codes) values.push_back(static_cast<float>(code) / 65535);
        return values;
    }
    std::vector<float> floats(const TestImage& image, VkImageAspectFlags aspect) {
        const auto bytes = readImage(image, aspect, 4);
        std::vector<float> values(bytes.size() / 4);
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

    VkViewport viewport_{0, 0, kExtent.width, kExtent.height, -1, 3};
    std::function<void(const PipelineStates&)> more_;
};

/// Of fullScreen("p.x / 2 + 0.5"): from -1 at the left edge of the picture to 3 at the right one.
float slopeAt(uint32_t x) {
    return (static_cast<float>(x) + 0.5f) / 16 - 1;
}

TEST_F(DepthRangeTest, viewportsAndClearsOfFloatFormats) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        const Target target = makeTarget(format, 2);
        run(target, makePipeline(target.pass.pass, draw("p.x / 2 + 0.5", VK_COMPARE_OP_LESS)));
        const auto color = colors(target), depth = depths(target);
        for (uint32_t n = 0; n < color.size(); ++n) {
            const float z = slopeAt(n % kExtent.width);
            EXPECT_EQ(color[n], z < 2 ? z : -9) << n;
            EXPECT_EQ(depth[n], std::min(z, 2.0f)) << n;
        }
    }
}

// What is cleared to 2.5 is 1, and lies neither before nor behind what is drawn beyond the range.
TEST_F(DepthRangeTest, fixedPointFormatsTakeDepthsIntoTheirRange) {
    const Target target = makeTarget(VK_FORMAT_D16_UNORM, 2.5f);
    run(target, makePipeline(target.pass.pass, draw("p.x / 2 + 0.5", VK_COMPARE_OP_LESS)));
    auto color = colors(target), depth = depths(target);
    for (uint32_t n = 0; n < color.size(); ++n) {
        const float z = std::clamp(slopeAt(n % kExtent.width), 0.0f, 1.0f);
        EXPECT_EQ(color[n], z < 1 ? z : -9) << n;
        EXPECT_NEAR(depth[n], z, 0.5f / 65535) << n;
    }
    run(target, makePipeline(target.pass.pass, draw("1", VK_COMPARE_OP_EQUAL)));
    for (const float value : colors(target)) EXPECT_EQ(value, 1);
    run(target, makePipeline(target.pass.pass, draw("1", VK_COMPARE_OP_LESS)));
    for (const float value : colors(target)) EXPECT_EQ(value, -9);
    const Target low = makeTarget(VK_FORMAT_D16_UNORM, -4);
    run(low, makePipeline(low.pass.pass, draw("0", VK_COMPARE_OP_GREATER)));
    for (const float value : colors(low)) EXPECT_EQ(value, -9);
}

TEST_F(DepthRangeTest, depthsOfFragmentShaders) {
    const Target target = makeTarget(VK_FORMAT_D32_SFLOAT, -100);
    PipelineDesc desc = draw("0.5", VK_COMPARE_OP_GREATER);
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out float o;
void main() { o = 5; gl_FragDepth = floor(gl_FragCoord.x) * 8 - 200; })");
    run(target, makePipeline(target.pass.pass, desc));
    const auto depth = depths(target);
    for (uint32_t n = 0; n < depth.size(); ++n)
        EXPECT_EQ(depth[n], std::max(-100.0f, static_cast<float>(n % kExtent.width) * 8 - 200)) << n;
}

// Clamping is to the viewport's range.
TEST_F(DepthRangeTest, clampingToTheViewport) {
    const Target target = makeTarget(VK_FORMAT_D32_SFLOAT, 50);
    more_ = [](const PipelineStates& states) { states.raster.depthClampEnable = VK_TRUE; };
    run(target, makePipeline(target.pass.pass, draw("p.x + 0.5", VK_COMPARE_OP_LESS)));
    const auto depth = depths(target);
    for (uint32_t n = 0; n < depth.size(); ++n) {
        const float z = slopeAt(n % kExtent.width) * 2 - 1;  // from -3 to 5
        EXPECT_EQ(depth[n], std::clamp(z, -1.0f, 3.0f)) << n;
    }
}

// The bounds 0 and 1 cut what lies outside, and others leave it.
TEST_F(DepthRangeTest, depthBounds) {
    for (const auto& [low, high] : {std::array{0.0f, 1.0f}, std::array{-0.5f, 2.25f}}) {
        const Target target = makeTarget(VK_FORMAT_D32_SFLOAT, 10);
        const VkPipeline slope = makePipeline(target.pass.pass, draw("p.x / 2 + 0.5", VK_COMPARE_OP_LESS));
        more_ = [low = low, high = high](const PipelineStates& states) {
            states.depth.depthBoundsTestEnable = VK_TRUE;
            states.depth.minDepthBounds = low;
            states.depth.maxDepthBounds = high;
            states.depth.depthTestEnable = VK_FALSE;
        };
        PipelineDesc bounded = draw("1", VK_COMPARE_OP_ALWAYS);
        const VkPipeline cut = makePipeline(target.pass.pass, bounded);
        more_ = {};
        const VkCommandBuffer commands = begin();
        beginPass(commands, target.pass);
        for (const VkPipeline pipeline : {slope, cut}) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
        vkCmdEndRenderPass(commands);
        submit(commands);
        const auto color = colors(target);
        for (uint32_t n = 0; n < color.size(); ++n) {
            const float z = slopeAt(n % kExtent.width);
            EXPECT_EQ(color[n], z >= low && z <= high ? 3 : z) << n;
        }
    }
}

// Many triangles of a few pixels, which are drawn together.
TEST_F(DepthRangeTest, smallTriangles) {
    const Target target = makeTarget(VK_FORMAT_D32_SFLOAT, 2);
    PipelineDesc desc = draw("0", VK_COMPARE_OP_LESS);
    desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, R"(#version 450
void main() {
    int quad = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
    vec2 at = vec2(quad % 32, quad / 32) + vec2(corner == 1 || corner > 3 ? 1 : 0, corner > 1 && corner != 4 ? 1 : 0);
    vec2 p = at * 2 / vec2(64, 32) * 2 - 1;
    gl_Position = vec4(p, p.x / 2 + 0.5, 1);
})");
    const VkPipeline pipeline = makePipeline(target.pass.pass, desc);
    const VkCommandBuffer commands = begin();
    beginPass(commands, target.pass);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 32 * 16 * 6, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    submit(commands);
    const auto depth = depths(target);
    for (uint32_t n = 0; n < depth.size(); ++n) EXPECT_EQ(depth[n], std::min(slopeAt(n % kExtent.width), 2.0f)) << n;
}

}  // namespace
}  // namespace vernier::test
