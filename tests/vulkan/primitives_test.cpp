// Lines, points, cull distances and depth bias at the driver's boundary.
#include <cmath>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

constexpr VkExtent2D kExtent{64, 64};
using Texels = std::vector<uint8_t>;

class PrimitivesTest : public DrawTest {
  protected:
    std::vector<const char*> moreExtensions() override { return {VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME}; }
    void* moreFeatures() override {
        lines_.rectangularLines = lines_.bresenhamLines = lines_.smoothLines = VK_TRUE;
        lines_.stippledRectangularLines = lines_.stippledBresenhamLines = lines_.stippledSmoothLines = VK_TRUE;
        return &lines_;
    }
    void SetUp() override {
        DrawTest::SetUp();
        color = makeImage(VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        pass = makePass(color);
    }
    PipelineDesc defaults(const std::string& vertex, const std::string& rgba = "1") {
        PipelineDesc desc;
        desc.extent = kExtent;
        desc.vertex = makeShader(VK_SHADER_STAGE_VERTEX_BIT, "#version 450\n" + vertex);
        desc.fragment = constantColor(rgba);
        return desc;
    }
    Texels render(const Pass& into, VkPipeline pipeline, uint32_t vertices, uint32_t instances = 1,
                  const std::function<void(VkCommandBuffer)>& before = {}) {
        const VkCommandBuffer commands = begin();
        beginPass(commands, into);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        if (before) before(commands);
        vkCmdDraw(commands, vertices, instances, 0, 0);
        vkCmdEndRenderPass(commands);
        submit(commands);
        return readImage(color, VK_IMAGE_ASPECT_COLOR_BIT, 4);
    }
    uint32_t channel(const Texels& texels, uint32_t x, uint32_t y, uint32_t shift = 0) const {
        return pixelAt(texels, color, x, y) >> shift & 0xFF;
    }

    TestImage color;
    Pass pass;

  private:
    VkPhysicalDeviceLineRasterizationFeaturesEXT lines_ = make<VkPhysicalDeviceLineRasterizationFeaturesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT);
};

/// A horizontal line from x = 2.25 to 60.25 pixels.
std::string lineAt(const std::string& y) {
    return "void main() { gl_Position = vec4(gl_VertexIndex == 0 ? -0.9296875 : 0.8828125, " + y +
           " / 32.0 - 1, 0.5, 1); }";
}

TEST_F(PrimitivesTest, lineModesAndWidths) {
    struct Case {
        VkLineRasterizationModeEXT mode;
        float width;
        const char* y;
        uint32_t first, last;  // rows
    };
    for (const Case& c : {Case{VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, 1, "10.75", 10, 10},
                          {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, 4, "10.75", 9, 12},
                          {VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT, 5, "10.5", 8, 12},
                          {VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT, 2, "10.0", 9, 10}}) {
        auto line = make<VkPipelineRasterizationLineStateCreateInfoEXT>(
            VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT);
        line.lineRasterizationMode = c.mode;
        PipelineDesc desc = defaults(lineAt(c.y));
        desc.change = [&](const PipelineStates& states) {
            states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
            states.raster.lineWidth = c.width;
            states.raster.pNext = &line;
        };
        const Texels texels = render(pass, makePipeline(pass.pass, desc), 2);
        for (uint32_t y = 0; y < 32; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const bool inside = y >= c.first && y <= c.last && x >= 2 && x < 60;
                ASSERT_EQ(channel(texels, x, y), inside ? 255u : 0u) << c.mode << " " << x << "," << y;
            }
        }
    }
}

TEST_F(PrimitivesTest, smoothLinesMultiplyAlpha) {
    auto line = make<VkPipelineRasterizationLineStateCreateInfoEXT>(
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT);
    line.lineRasterizationMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
    PipelineDesc desc = defaults(lineAt("10.75"));
    desc.change = [&](const PipelineStates& states) {
        states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        states.raster.pNext = &line;
    };
    const Texels texels = render(pass, makePipeline(pass.pass, desc), 2);
    EXPECT_EQ(channel(texels, 30, 10, 24), 191u);  // from 10.25 to 11: 3/4
    EXPECT_EQ(channel(texels, 30, 11, 24), 64u);
    EXPECT_EQ(channel(texels, 30, 9, 24), 0u);
    EXPECT_EQ(channel(texels, 30, 11), 255u);     // the colour itself stays
    EXPECT_EQ(channel(texels, 60, 10, 24), 48u);  // the end: 1/4 of it
}

TEST_F(PrimitivesTest, stippleIsFixedOrDynamic) {
    for (const bool dynamic : {false, true}) {
        for (const auto mode : {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT}) {
            auto line = make<VkPipelineRasterizationLineStateCreateInfoEXT>(
                VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_LINE_STATE_CREATE_INFO_EXT);
            line.lineRasterizationMode = mode;
            line.stippledLineEnable = VK_TRUE;
            line.lineStippleFactor = dynamic ? 1 : 3;
            line.lineStipplePattern = dynamic ? 0 : 0x2C5;
            PipelineDesc desc = defaults(lineAt("10.5"));
            if (dynamic) desc.dynamic = {VK_DYNAMIC_STATE_LINE_STIPPLE_EXT};
            desc.change = [&](const PipelineStates& states) {
                states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
                states.raster.pNext = &line;
            };
            const Texels texels = render(pass, makePipeline(pass.pass, desc), 2, 1, [&](VkCommandBuffer commands) {
                if (dynamic) command<PFN_vkCmdSetLineStippleEXT>("vkCmdSetLineStippleEXT")(commands, 3, 0x2C5);
            });
            for (uint32_t x = 2; x < 60; ++x)
                ASSERT_EQ(channel(texels, x, 10), (0x2C5u >> (x - 2) / 3 % 16 & 1) != 0 ? 255u : 0u)
                    << mode << " " << x;
        }
    }
}

TEST_F(PrimitivesTest, largePointsHaveCoordinates) {
    PipelineDesc desc = defaults("void main() { gl_Position = vec4(0, 0, 0.5, 1); gl_PointSize = 20; }");
    desc.fragment = makeShader(VK_SHADER_STAGE_FRAGMENT_BIT, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PointCoord, 1, 1); })");
    desc.change = [](const PipelineStates& states) { states.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST; };
    const Texels texels = render(pass, makePipeline(pass.pass, desc), 1);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const bool inside = x >= 22 && x < 42 && y >= 22 && y < 42;
            ASSERT_EQ(channel(texels, x, y, 16), inside ? 255u : 0u) << x << "," << y;
            if (!inside) continue;
            ASSERT_NEAR(channel(texels, x, y), (x + 0.5 - 22) / 20 * 255, 0.51);
            ASSERT_NEAR(channel(texels, x, y, 8), (y + 0.5 - 22) / 20 * 255, 0.51);
        }
    }
}

TEST_F(PrimitivesTest, cullDistancesDropWholePrimitives) {
    // Eight distances in all, some of each kind. Instance 0: cull distance 1 is negative everywhere; instance 1: only
    // at two vertices; instance 2: one is NaN.
    PipelineDesc desc = defaults(R"(
out float gl_ClipDistance[3];
out float gl_CullDistance[5];
void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, 0.5, 1);
    for (int k = 0; k < 3; ++k) gl_ClipDistance[k] = 1 + k;
    for (int k = 0; k < 5; ++k) gl_CullDistance[k] = 1;
    if (gl_InstanceIndex == 0 || (gl_InstanceIndex == 1 && gl_VertexIndex > 0)) gl_CullDistance[1] = -0.5;
    gl_ClipDistance[2] = gl_InstanceIndex == 1 ? -p.x : 1;
})");
    const VkPipeline pipeline = makePipeline(pass.pass, desc);
    EXPECT_EQ(channel(render(pass, pipeline, 3, 1), 20, 20), 0u);
    const Texels both = render(pass, pipeline, 3, 2);
    EXPECT_EQ(channel(both, 31, 20), 255u);  // left of the clip plane of instance 1
    EXPECT_EQ(channel(both, 32, 20), 0u);
}

TEST_F(PrimitivesTest, depthBiasMovesByTheFormatsResolution) {
    struct Case {
        VkFormat format;
        float constant, slope, clamp;
        double expected;  // what is stored, as a depth
    };
    // The plane: depth 0.5 in the middle, rising by 1/256 per pixel to the right.
    for (const Case& c : {Case{VK_FORMAT_D16_UNORM, 100, 0, 0, 0.5 + 100 / 65535.0},
                          {VK_FORMAT_D32_SFLOAT, 64, 0, 0, 0.5 + 64 * 0x1p-24},
                          {VK_FORMAT_D32_SFLOAT, 0, 4, 0, 0.5 + 4 / 256.0},
                          {VK_FORMAT_D32_SFLOAT, 0, 4, 1 / 512.0f, 0.5 + 1 / 512.0},
                          {VK_FORMAT_D32_SFLOAT, 0, -4, -1 / 1024.0f, 0.5 - 1 / 1024.0}}) {
        const TestImage depth = makeImage(c.format, kExtent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        const Pass withDepth = makePass(color, &depth);
        const bool sloped = c.slope != 0;
        PipelineDesc desc = defaults(std::string(R"(void main() {
    vec2 p = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    gl_Position = vec4(p, 0.5 + )") + (sloped ? "p.x / 8" : "0") +
                                     ", 1); }");
        desc.depthTest = true;
        desc.change = [&](const PipelineStates& states) {
            states.raster.depthBiasEnable = VK_TRUE;
            states.raster.depthBiasConstantFactor = c.constant;
            states.raster.depthBiasSlopeFactor = c.slope;
            states.raster.depthBiasClamp = c.clamp;
        };
        render(withDepth, makePipeline(withDepth.pass, desc), 3);
        const bool d16 = c.format == VK_FORMAT_D16_UNORM;
        const Texels stored = readImage(depth, VK_IMAGE_ASPECT_DEPTH_BIT, d16 ? 2 : 4);
        const auto at = [&](uint32_t x) {
            const size_t index = size_t{32} * kExtent.width + x;
            uint16_t code = 0;
            float value = 0;
            if (d16) std::memcpy(&code, stored.data() + 2 * index, 2);
            if (!d16) std::memcpy(&value, stored.data() + 4 * index, 4);
            return d16 ? code / 65535.0 : double{value};
        };
        // Between the pixels 31 and 32 the plane has its middle value.
        EXPECT_NEAR((at(31) + at(32)) / 2, c.expected, d16 ? 0.5 / 65535 + 1e-9 : 0x1p-23)
            << c.format << " " << c.slope;
    }
}

}  // namespace
}  // namespace vernier::test
