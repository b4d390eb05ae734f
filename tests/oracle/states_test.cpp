// The whole-scene oracle's rules beyond filled triangles of one sample: answers known by hand, and renderings with one
// deliberate fault each, which must leave the permitted ranges.
#include "conformance/scenes/shapes.h"
#include "tests/oracle/small_scene.h"

#include <gtest/gtest.h>

#include <bit>

namespace vernier::conformance {
namespace {

using namespace small_scene;

std::vector<Vertex> everywhere(std::array<float, 4> color, float z = 0.5f) {
    return {vertex(-16, -16, color, z), vertex(64, -16, color, z), vertex(-16, 64, color, z)};
}

/// Several samples, resolved into image 0.
void takeSamples(Scene& s, VkSampleCountFlagBits samples) {
    SceneImage multisampled = s.images[0];
    multisampled.samples = samples;
    s.images.push_back(multisampled);
    s.pipelines[0].samples = samples;
    passOf(s).colors[0].image = 1;
    passOf(s).colors[0].resolveImage = 0;
}

void addDepth(Scene& s, float clear) {
    SceneImage depth = s.images[0];
    depth.format = VK_FORMAT_D32_SFLOAT;
    s.images.push_back(depth);
    passOf(s).depthStencil.image = static_cast<uint32_t>(s.images.size() - 1);
    passOf(s).depthStencil.clear.depthStencil = {clear, 0};
}

size_t countOf(const OracleImage& image, size_t channel) {
    size_t count = 0;
    for (const OraclePixel& p : image.pixels) count += p.value[channel] > 0.5;
    return count;
}

// Vulkan, Rasterization Order, says nothing of the edges of one polygon.
TEST(Outlines, TheirEdgesComeInAnyOrder) {
    const std::vector<Vertex> corners{vertex(2.5f, 2.5f, kRed), vertex(13.5f, 2.5f, kGreen),
                                      vertex(2.5f, 13.5f, kBlue)};
    const auto outline = [&](std::array<size_t, 3> order, bool smooth) {
        std::vector<Vertex> vertices;
        for (const size_t i : order) vertices.push_back(corners[i]);
        return drawScene(vertices, smooth ? kSmooth : kFlat, [](Scene& s) {
            s.pipelines[0].polygonMode = VK_POLYGON_MODE_LINE;
            s.pipelines[0].lineMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
            s.pipelines[0].lineWidth = 3;
        });
    };
    const Scene scene = outline({0, 1, 2}, true);
    const OracleImage image = render(scene);
    EXPECT_NE(at(image, 3, 3).flags & kOracleSequence, 0) << "two edges cover it";
    EXPECT_LT(at(image, 3, 3).low[0], at(image, 3, 3).high[0]);
    EXPECT_EQ(at(image, 7, 2).flags & kOracleSequence, 0) << "one edge covers it";
    EXPECT_EQ(judge(scene, outline({1, 2, 0}, true)).outside, 0u);
    EXPECT_GT(judge(scene, outline({0, 1, 2}, false)).outside, 20u);
}

// An edge on a column of centres: which stencil it leaves there is open, and so is what a later pass makes of it.
TEST(Stencils, StayOpenFromPassToPass) {
    const auto scene = [](float right) {
        return drawScene({vertex(-8, -8, kRed), vertex(right, -8, kRed), vertex(right, 40, kRed), vertex(-8, -8, kRed),
                          vertex(right, 40, kRed), vertex(-8, 40, kRed)},
                         kFlat, [&](Scene& s) {
                             SceneImage depth = s.images[0];
                             depth.format = VK_FORMAT_D32_SFLOAT_S8_UINT;
                             s.images.push_back(depth);
                             passOf(s).depthStencil.image = 1;
                             ScenePipeline second = s.pipelines[0];
                             VkStencilOpState replace{};
                             replace.compareOp = VK_COMPARE_OP_ALWAYS;
                             replace.passOp = VK_STENCIL_OP_REPLACE;
                             replace.compareMask = replace.writeMask = 0xff;
                             replace.reference = 3;
                             s.pipelines[0].stencilTest = second.stencilTest = true;
                             s.pipelines[0].front = s.pipelines[0].back = replace;
                             replace.passOp = VK_STENCIL_OP_KEEP;
                             replace.compareOp = VK_COMPARE_OP_EQUAL;
                             second.front = second.back = replace;
                             s.pipelines.push_back(second);
                             ScenePass after = passOf(s);
                             after.depthStencil.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
                             after.draws[0].pipeline = 1;
                             s.steps.emplace_back(after);
                         });
    };
    const OracleImage image = render(scene(8.501f));
    EXPECT_EQ(at(image, 7, 5).low[0], 1);
    EXPECT_EQ(at(image, 8, 5).low[0], 0) << "it may be snapped to the centre, or short of it";
    EXPECT_EQ(at(image, 8, 5).high[0], 1);
    EXPECT_EQ(at(image, 9, 5).high[0], 0);
    EXPECT_EQ(judge(scene(8.501f), scene(8.495f)).outside, 0u);
    EXPECT_EQ(judge(scene(8.501f), scene(9.4f)).outside, 0u) << "no centre between";
    EXPECT_EQ(judge(scene(8.501f), scene(7.4f)).outside, 16u);
}

// A texel that may be a little above or below 0: its size may be 0.
TEST(Ranges, ReachZeroWhereAShaderTurnsThem) {
    SceneRecorder record("size", "");
    // End points 10 and -12 of 127, all texels three sevenths of the way.
    Bytes block;
    for (const int byte : {0x0a, 0xf4, 0x24, 0x49, 0x92, 0x24, 0x49, 0x92})
        block.push_back(static_cast<std::byte>(byte));
    const uint32_t texture = record.texture("block", VK_FORMAT_BC4_SNORM_BLOCK, {4, 4}, {block});
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D block;
layout(location = 0) out vec4 color;
void main() { color = abs(texelFetch(block, ivec2(0), 0)); }
)"));
    record.pass(kExtent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 3).texture(0, texture, record.sampler(VK_FILTER_NEAREST));
    record.output(target);
    const auto scene = record.finish();
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const OraclePixel pixel = at(render(*scene), 3, 3);
    EXPECT_NEAR(pixel.value[0], (10 - 22 * 3.0 / 7) / 127, 1e-9);
    EXPECT_LE(pixel.low[0], 0);
    EXPECT_GT(pixel.high[0], 1.0 / 127);
}

TEST(LogicOperations, OnStoredCodes) {
    const auto scene = [](VkLogicOp op) {
        return drawScene(everywhere({240.0f / 255, 15.0f / 255, 1, 0}), kFlat, [&](Scene& s) {
            s.pipelines[0].logicOpEnable = true;
            s.pipelines[0].logicOp = op;
            passOf(s).colors[0].clear.color = {{204.0f / 255, 204.0f / 255, 0, 1}};
        });
    };
    const OracleImage image = render(scene(VK_LOGIC_OP_XOR));
    EXPECT_EQ(at(image, 3, 3).value[0] * 255, 240 ^ 204);
    EXPECT_EQ(at(image, 3, 3).value[1] * 255, 15 ^ 204);
    EXPECT_EQ(at(image, 3, 3).low[0], at(image, 3, 3).high[0]);
    EXPECT_EQ(at(render(scene(VK_LOGIC_OP_AND_REVERSE)), 3, 3).value[0] * 255, 240 & ~204);
    EXPECT_EQ(at(render(scene(VK_LOGIC_OP_NOR)), 3, 3).value[0] * 255, 255 & ~(240 | 204));
    // Faults: reverse for inverted, or for xor.
    EXPECT_EQ(judge(scene(VK_LOGIC_OP_AND_REVERSE), scene(VK_LOGIC_OP_AND_INVERTED)).outside, 256u);
    EXPECT_EQ(judge(scene(VK_LOGIC_OP_XOR), scene(VK_LOGIC_OP_OR)).outside, 256u);
}

TEST(DepthBounds, TestWhatIsStored) {
    const auto scene = [](float low, float high) {
        return drawScene(everywhere(kRed, 0.9f), kFlat, [&](Scene& s) {
            addDepth(s, 0.25f);
            s.pipelines[0].depthBoundsTest = true;
            s.pipelines[0].minDepthBounds = low;
            s.pipelines[0].maxDepthBounds = high;
        });
    };
    EXPECT_EQ(at(render(scene(0.2f, 0.3f)), 3, 3).value[0], 1);
    EXPECT_EQ(at(render(scene(0.25f, 0.25f)), 3, 3).value[0], 1) << "bounds are inside";
    EXPECT_EQ(at(render(scene(0.3f, 1)), 3, 3).value[0], 0) << "the fragment's own depth does not count";
    EXPECT_EQ(judge(scene(0.2f, 0.3f), scene(0.3f, 1)).outside, 256u);
}

TEST(Samples, PositionsOfOnesOwn) {
    const auto scene = [](std::vector<std::array<uint8_t, 2>> locations) {
        return drawScene({vertex(-8, -8, kRed), vertex(4.25f, -8, kRed), vertex(4.25f, 40, kRed), vertex(-8, -8, kRed),
                          vertex(4.25f, 40, kRed), vertex(-8, 40, kRed)},
                         kFlat, [&](Scene& s) {
                             takeSamples(s, VK_SAMPLE_COUNT_4_BIT);
                             s.pipelines[0].sampleLocations = std::move(locations);
                         });
    };
    const Scene threeLeft = scene({{0, 0}, {1, 8}, {2, 15}, {15, 8}});
    EXPECT_EQ(at(render(threeLeft), 4, 8).value[0], 191.0 / 255);
    EXPECT_EQ(at(render(scene({})), 4, 8).value[0], 64.0 / 255) << "one standard position is left of a quarter";
    EXPECT_EQ(judge(threeLeft, scene({})).outside, 16u);
}

TEST(Samples, AlphaToOne) {
    const auto scene = [](bool toOne) {
        return drawScene(everywhere({1, 0, 0, 0.25f}), kFlat, [&](Scene& s) {
            takeSamples(s, VK_SAMPLE_COUNT_4_BIT);
            s.pipelines[0].alphaToOne = toOne;
        });
    };
    EXPECT_EQ(at(render(scene(true)), 3, 3).value[3], 1);
    EXPECT_EQ(judge(scene(true), scene(false)).outside, 256u);
}

TEST(Samples, ShadedOneByOne) {
    const char* const kSampleNumber = R"(#version 450
layout(location = 0) in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_SampleID == 1 ? 1.0 : 0.0, fract(gl_FragCoord.x) < 0.3 ? 1.0 : 0.0, 0.0, 1.0); }
)";
    const OracleImage image =
        render(drawScene(everywhere(kRed), kSampleNumber, [](Scene& s) { takeSamples(s, VK_SAMPLE_COUNT_4_BIT); }));
    EXPECT_EQ(at(image, 3, 3).value[0], 64.0 / 255);
    EXPECT_EQ(at(image, 3, 3).value[1], 64.0 / 255) << "of x = 6, 14, 2, 10 sixteenths one is left of 0.3";
}

TEST(Samples, CentroidsStayInside) {
    const char* const kCentroidVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) centroid out vec4 smoothColor;
void main() {
    gl_Position = position;
    smoothColor = color;
}
)";
    const auto scene = [&](bool centroid) {
        // Green rises to 1 at the right border, which cuts pixel 4 left of its centre; beyond it would exceed 1, and
        // red, which is 1 minus four times the excess, fall.
        SceneRecorder record("centroid", "");
        const uint32_t samples =
            record.colorTarget("samples", VK_FORMAT_R8G8B8A8_UNORM, kExtent, VK_SAMPLE_COUNT_4_BIT);
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
        const std::array<float, 4> left{0, 0, 0, 1}, right{1, 0, 0, 1};
        const std::vector<Vertex> vertices{vertex(0, -8, left), vertex(4.25f, -8, right), vertex(4.25f, 40, right),
                                           vertex(0, -8, left), vertex(4.25f, 40, right), vertex(0, 40, left)};
        const char* const kCentroid = R"(#version 450
layout(location = 0) centroid in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0 - max(smoothColor.r - 1.0, 0.0) * 20.0, 0.0, 0.0, 1.0); }
)";
        const char* const kCentre = R"(#version 450
layout(location = 0) in vec4 smoothColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0 - max(smoothColor.r - 1.0, 0.0) * 20.0, 0.0, 0.0, 1.0); }
)";
        const uint32_t pipeline = record
                                      .pipeline(record.vertex(centroid ? kCentroidVertex : kVertex),
                                                record.fragment(centroid ? kCentroid : kCentre))
                                      .binding(sizeof(Vertex))
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                      .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 16)
                                      .samples(VK_SAMPLE_COUNT_4_BIT);
        record.pass(kExtent).color(samples, {0, 0, 0, 1}, target);
        record.draw(pipeline, 6).vertices(record.vertexBuffer("vertices", vertices));
        record.output(target);
        auto finished = record.finish();
        EXPECT_TRUE(finished.ok());
        return *finished;
    };
    const OracleImage image = render(scene(true));
    // One of four samples is covered, in full colour.
    EXPECT_EQ(at(image, 4, 8).value[0], 64.0 / 255);
    EXPECT_EQ(judge(scene(true), scene(false)).outside, 16u) << "inputs at the centre of pixels cut off left of it";
}

Scene line(float x0, float y0, float x1, float y1, VkLineRasterizationModeEXT mode, float width = 1) {
    return drawScene({vertex(x0, y0, kRed), vertex(x1, y1, kRed)}, kFlat, [&](Scene& s) {
        s.pipelines[0].topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        s.pipelines[0].lineMode = mode;
        s.pipelines[0].lineWidth = width;
    });
}

TEST(Lines, RectanglesByHand) {
    constexpr auto kMode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
    const Scene three = line(2, 5.5f, 12, 5.5f, kMode, 3);
    const OracleImage image = render(three);
    EXPECT_EQ(countOf(image, 0), 30u);
    EXPECT_EQ(at(image, 2, 4).value[0], 1);
    EXPECT_EQ(at(image, 12, 4).high[0], 0);
    EXPECT_EQ(at(image, 5, 5).flags, 0);
    EXPECT_EQ(judge(three, line(2, 5.5f, 12, 5.5f, kMode, 5)).outside, 20u);
    EXPECT_EQ(judge(three, line(2, 5.5f, 13, 5.5f, kMode, 3)).outside, 3u);
}

TEST(Lines, BresenhamMayBeAPixelOff) {
    constexpr auto kMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    const Scene right = line(2.5f, 5.5f, 12.5f, 5.5f, kMode);
    EXPECT_EQ(countOf(render(right), 0), 10u) << "the last pixel is not left";
    EXPECT_EQ(judge(right, line(2.5f, 6.5f, 12.5f, 6.5f, kMode)).outside, 0u);
    EXPECT_EQ(judge(right, line(2.5f, 7.5f, 12.5f, 7.5f, kMode)).outside, 10u);
}

TEST(Lines, StipplesCountFragments) {
    const auto scene = [](uint16_t pattern, uint32_t factor) {
        Scene s = line(0.5f, 5.5f, 15.5f, 5.5f, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT);
        s.pipelines[0].stippleFactor = factor;
        s.pipelines[0].stipplePattern = pattern;
        return s;
    };
    const OracleImage image = render(scene(0x00ff, 1));
    EXPECT_EQ(countOf(image, 0), 8u);
    EXPECT_EQ(at(image, 4, 5).value[0], 1);
    EXPECT_EQ(at(image, 12, 5).high[0], 0);
    EXPECT_GT(judge(scene(0x00ff, 1), scene(0xff00, 1)).outside, 3u);
    EXPECT_EQ(countOf(render(scene(0x0f, 2)), 0), 8u);
}

TEST(Points, SquaresAndTheirCoordinates) {
    const auto scene = [](const char* size) {
        SceneRecorder record("points", "");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
        const uint32_t pipeline =
            record
                .pipeline(record.vertex("#version 450\nvoid main() { gl_Position = vec4(0.0, 0.0, 0.5, "
                                        "1.0); gl_PointSize = " +
                                        std::string(size) + "; }"),
                          record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PointCoord, 1.0, 1.0); }
)"))
                .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
        record.pass(kExtent).color(target, {0, 0, 0, 1});
        record.draw(pipeline, 1);
        record.output(target);
        auto finished = record.finish();
        EXPECT_TRUE(finished.ok());
        return *finished;
    };
    const OracleImage image = render(scene("4.0"));
    EXPECT_EQ(countOf(image, 2), 16u);
    EXPECT_NEAR(at(image, 6, 9).value[0], 0.125, 0.5 / 255);
    EXPECT_NEAR(at(image, 6, 9).value[1], 0.875, 0.5 / 255);
    EXPECT_EQ(judge(scene("4.0"), scene("6.0")).outside, 36u);
}

TEST(Primitives, LastProvokingVertex) {
    const auto scene = [](bool last) {
        return drawScene({vertex(-16, -16, kRed), vertex(64, -16, kGreen), vertex(-16, 64, kBlue)}, kFlat,
                         [&](Scene& s) { s.pipelines[0].provokingVertexLast = last; });
    };
    EXPECT_EQ(at(render(scene(true)), 3, 3).value[2], 1);
    EXPECT_EQ(at(render(scene(false)), 3, 3).value[0], 1);
    EXPECT_EQ(judge(scene(true), scene(false)).outside, 256u);
}

TEST(Primitives, OutlinesOfPolygons) {
    const auto scene = [](VkPolygonMode mode) {
        return drawScene({vertex(1.5f, 1.5f, kRed), vertex(13.5f, 1.5f, kRed), vertex(1.5f, 13.5f, kRed)}, kFlat,
                         [&](Scene& s) { s.pipelines[0].polygonMode = mode; });
    };
    const OracleImage lines = render(scene(VK_POLYGON_MODE_LINE));
    EXPECT_EQ(at(lines, 6, 1).value[0], 1);
    EXPECT_EQ(at(lines, 4, 4).high[0], 0);
    EXPECT_EQ(countOf(render(scene(VK_POLYGON_MODE_POINT)), 0), 3u);
    EXPECT_GT(judge(scene(VK_POLYGON_MODE_LINE), scene(VK_POLYGON_MODE_FILL)).outside, 20u);
}

TEST(Anisotropy, StaysAmongTheTexelsOfTheFootprint) {
    // The left half of the texture is black, the right half white; the quad sees it squeezed eight to one across.
    const auto scene = [](float anisotropy, float shift) {
        SceneRecorder record("anisotropy", "");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
        Bytes texels;
        for (int i = 0; i < 256 * 16; ++i) texels.insert(texels.end(), 4, std::byte(i % 256 < 128 ? 0 : 255));
        const uint32_t texture = record.mipmappedTexture("halves", VK_FORMAT_R8G8B8A8_UNORM, {256, 16}, texels);
        SceneSampler sampler;
        sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
        sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        sampler.addressModeU = sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        sampler.maxAnisotropy = anisotropy;
        const uint32_t vertexShader = record.vertex(R"(#version 450
layout(constant_id = 0) const float shift = 0.0;
layout(location = 0) out vec2 uv;
void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
    uv = corner * vec2(0.5, 1.0) + vec2(0.25 + shift, 0.0);
}
)");
        record.specialize(vertexShader, 0, std::bit_cast<uint32_t>(shift));
        const uint32_t pipeline = record.pipeline(vertexShader, record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D halves;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(halves, uv); }
)"));
        record.pass(kExtent).color(target, {0, 0, 0, 1});
        record.draw(pipeline, 3).texture(0, texture, record.sampler(sampler));
        record.output(target);
        auto finished = record.finish();
        EXPECT_TRUE(finished.ok());
        return *finished;
    };
    const OracleImage image = render(scene(16, 0));
    EXPECT_EQ(at(image, 4, 8).high[0], 0) << "all texels within reach are black";
    EXPECT_EQ(at(image, 11, 8).low[0], 1);
    EXPECT_LT(at(image, 7, 8).low[0], at(image, 7, 8).high[0]);
    EXPECT_EQ(judge(scene(16, 0), scene(16, 0)).outside, 0u);
    EXPECT_EQ(judge(scene(16, 0), scene(16, 0.125f)).outside, 32u) << "a footprint four pixels off";
}

TEST(Views, EachPrimitiveChoosesItsViewport) {
    const auto scene = [](uint32_t index) {
        SceneRecorder record("views", "");
        const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, kExtent);
        const uint32_t vertexShader = record.vertex(R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : enable
layout(constant_id = 0) const int view = 0;
void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
    gl_ViewportIndex = view;
}
)");
        record.specialize(vertexShader, 0, index);
        const uint32_t pipeline = record.pipeline(
            vertexShader,
            record.fragment("#version 450\nlayout(location = 0) out vec4 c; void main() { c = vec4(1.0); }"));
        record.pass(kExtent).color(target, {0, 0, 0, 1});
        record.draw(pipeline, 3).viewport(0, 0, 4, 16).view({{8, 0, 8, 8, 0, 1}, {{8, 0}, {8, 6}}});
        record.output(target);
        auto finished = record.finish();
        EXPECT_TRUE(finished.ok());
        return *finished;
    };
    EXPECT_EQ(countOf(render(scene(0)), 0), 64u);
    EXPECT_EQ(countOf(render(scene(1)), 0), 48u);
    EXPECT_EQ(judge(scene(0), scene(1)).outside, 112u);
}

TEST(Views, MultiviewDrawsToTheLayersOfItsMask) {
    Scene scene = drawScene(everywhere(kRed), kFlat, [](Scene& s) {
        s.images[0].arrayLayers = 2;
        passOf(s).colors[0].layerCount = 2;
        passOf(s).viewMask = 0b10;
        passOf(s).colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    });
    EXPECT_TRUE(at(render(scene), 3, 3).flags & kOracleUnknown) << "layer 0 is not a view: it keeps what it had";
    passOf(scene).viewMask = 0b11;
    EXPECT_EQ(at(render(scene), 3, 3).value[0], 1);
}

}  // namespace
}  // namespace vernier::conformance
