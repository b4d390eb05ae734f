// Whole scenes with answers known by hand, and renderings with one deliberate fault each, which must leave
// the oracle's permitted ranges.
#include "conformance/oracle/filtering.h"
#include "tests/oracle/small_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vernier::conformance {
namespace {

using namespace small_scene;

std::vector<Vertex> diagonalQuad() {
    return {vertex(2.5f, 2.5f, kRed),     vertex(2.5f, 12.5f, kRed),   vertex(12.5f, 2.5f, kRed),
            vertex(12.5f, 12.5f, kGreen), vertex(12.5f, 2.5f, kGreen), vertex(2.5f, 12.5f, kGreen)};
}

TEST(Scene, DiagonalQuadIsAmbiguousOnItsEdgesOnly) {
    const OracleImage image = render(drawScene(diagonalQuad(), kFlat));
    EXPECT_EQ(at(image, 5, 5).value[0], 1);
    EXPECT_EQ(at(image, 5, 5).flags, 0);
    EXPECT_EQ(at(image, 0, 0).value[0], 0);
    // On the diagonal: red or green, never black.
    const OraclePixel& diagonal = at(image, 5, 9);
    EXPECT_TRUE(diagonal.flags & kOracleEdge);
    EXPECT_EQ(diagonal.value[1], 1) << "declared: the triangle to the right owns its left edge";
    EXPECT_EQ(diagonal.low[0], 0);
    EXPECT_EQ(diagonal.high[0], 1);
    EXPECT_EQ(diagonal.high[2], 0);
    // Top edge on centres: declared in, legally out.
    EXPECT_EQ(at(image, 5, 2).value[0], 1);
    EXPECT_EQ(at(image, 5, 2).low[0], 0);
    EXPECT_EQ(at(image, 5, 12).value[1], 0);
    EXPECT_EQ(at(image, 5, 12).high[1], 1);
    size_t edges = 0;
    for (const OraclePixel& p : image.pixels) edges += (p.flags & kOracleEdge) != 0;
    // Four sides of eleven centres share four corners; nine more on the diagonal.
    EXPECT_EQ(edges, 40u + 9u);
}

TEST(Scene, SmoothColoursFollowThePlane) {
    const OracleImage image = render(
        drawScene({vertex(0, 0, {0, 0, 0, 1}), vertex(16, 0, {1, 0, 0, 1}), vertex(0, 16, {0, 1, 0, 1})}, kSmooth));
    for (uint32_t y = 0; y < 15; ++y) {
        for (uint32_t x = 0; x + y < 15; ++x) {
            const OraclePixel& p = at(image, x, y);
            EXPECT_EQ(p.value[0], std::nearbyint((x + 0.5) / 16 * 255) / 255);
            EXPECT_LE(p.low[1], (y + 0.5) / 16);
            EXPECT_GE(p.high[1], (y + 0.5) / 16);
            EXPECT_LE(p.high[1] - p.low[1], 2.1 / 255);
        }
    }
}

TEST(Scene, PerspectiveByHand) {
    // w = 1 on the left, 3 on the right: half-way on the screen the attribute is 1/4.
    const std::vector<Vertex> v{{{-1, -1, 0, 1}, {0, 0, 0, 1}}, {{3, -3, 0, 3}, {1, 0, 0, 1}},
                                {{-1, 1, 0, 1}, {0, 0, 0, 1}},  {{3, 3, 0, 3}, {1, 0, 0, 1}},
                                {{-1, 1, 0, 1}, {0, 0, 0, 1}},  {{3, -3, 0, 3}, {1, 0, 0, 1}}};
    const OracleImage image = render(drawScene(v, kSmooth));
    const double t = 8.5 / 16, expected = t / 3 / (1 - t + t / 3);
    for (const uint32_t y : {2u, 13u}) {
        EXPECT_NEAR(at(image, 8, y).value[0], expected, 0.5 / 255);
        EXPECT_LE(at(image, 8, y).low[0], expected);
        EXPECT_GE(at(image, 8, y).high[0], expected);
    }
}

TEST(Scene, FourSamplesAtTheStandardPlaces) {
    Scene scene = drawScene({vertex(-8, -8, kRed), vertex(4.5f, -8, kRed), vertex(4.5f, 40, kRed), vertex(-8, -8, kRed),
                             vertex(4.5f, 40, kRed), vertex(-8, 40, kRed)},
                            kFlat, [](Scene& s) {
                                SceneImage samples = s.images[0];
                                samples.samples = VK_SAMPLE_COUNT_4_BIT;
                                s.images.push_back(samples);
                                s.pipelines[0].samples = VK_SAMPLE_COUNT_4_BIT;
                                passOf(s).colors[0].image = 1;
                                passOf(s).colors[0].resolveImage = 0;
                            });
    const OracleImage image = render(scene);
    EXPECT_EQ(at(image, 3, 8).value[0], 1);
    EXPECT_EQ(at(image, 5, 8).value[0], 0);
    // Two of the four samples are left of the middle of pixel 4.
    EXPECT_EQ(at(image, 4, 8).value[0], 128.0 / 255);
    EXPECT_EQ(at(image, 4, 8).low[0], 127.0 / 255);
    EXPECT_EQ(at(image, 4, 8).flags, 0);
}

TEST(Scene, DepthDecidesAndTiesAreOpen) {
    const auto three = [](std::array<float, 4> color, float z0, float z1) {
        return std::vector<Vertex>{vertex(0, 0, color, z0), vertex(32, 0, color, z1), vertex(0, 32, color, z0)};
    };
    std::vector<Vertex> v = three(kRed, 0.25f, 0.75f);
    const auto second = three(kGreen, 0.75f, 0.25f);
    v.insert(v.end(), second.begin(), second.end());
    const OracleImage image = render(drawScene(v, kFlat, [](Scene& s) {
        SceneImage depth = s.images[0];
        depth.format = VK_FORMAT_D16_UNORM;
        s.images.push_back(depth);
        passOf(s).depthStencil.image = 1;
        passOf(s).depthStencil.clear.depthStencil = {1, 0};
        s.pipelines[0].depthTest = s.pipelines[0].depthWrite = true;
        s.outputs.push_back(1);
    }));
    // They cross at x = 16, the border of the target: red is nearer everywhere inside.
    EXPECT_EQ(at(image, 3, 3).value[0], 1);
    EXPECT_EQ(at(image, 3, 3).flags, 0);
    EXPECT_EQ(at(image, 15, 0).value[0], 1);
}

TEST(Scene, MipsAndBlitsAverage) {
    SceneRecorder record("mips", "");
    Bytes texels;
    for (int i = 0; i < 16; ++i) {
        for (int c = 0; c < 4; ++c) texels.push_back(static_cast<std::byte>(i * 16 % 256));
    }
    const uint32_t texture = record.mipmappedTexture("texture", VK_FORMAT_R8G8B8A8_UNORM, {4, 4}, texels);
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R8G8B8A8_UNORM, {2, 2});
    SceneBlitImage blit{texture, target, {}, VK_FILTER_NEAREST};
    blit.region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 1, 0, 1};
    blit.region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.region.srcOffsets[1] = blit.region.dstOffsets[1] = {2, 2, 1};
    record.blit(blit);
    record.output(target);
    const auto scene = record.finish();
    ASSERT_TRUE(scene.ok());
    const OracleImage image = render(*scene);
    // (0 + 16 + 64 + 80) / 4.
    EXPECT_EQ(at(image, 0, 0).value[0] * 255, 40);
    EXPECT_EQ(at(image, 1, 1).value[0] * 255, 200);
    EXPECT_LE(at(image, 0, 0).low[0] * 255, 40);
}

TEST(Scene, UnsupportedIsRefusedInWords) {
    const auto images = renderOracle(drawScene(diagonalQuad(), kFlat, [](Scene& s) {
        s.pipelines[0].polygonMode = VK_POLYGON_MODE_LINE;
        s.pipelines[0].depthBias = true;
    }));
    ASSERT_FALSE(images.ok());
    EXPECT_EQ(images.error().code, ErrorCode::unsupported);
    EXPECT_NE(images.error().message.find("depth bias"), std::string::npos);
    const auto broken =
        renderOracle(drawScene(diagonalQuad(), kFlat, [](Scene& s) { passOf(s).colors[0].image = 77; }));
    ASSERT_FALSE(broken.ok());
    EXPECT_NE(broken.error().message.find("77"), std::string::npos);
}

TEST(Scene, UndefinedContentsAreUnknown) {
    const OracleImage image = render(drawScene(
        diagonalQuad(), kFlat, [](Scene& s) { passOf(s).colors[0].loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE; }));
    EXPECT_TRUE(at(image, 0, 0).flags & kOracleUnknown);
    EXPECT_FALSE(at(image, 5, 5).flags & kOracleUnknown);
}

TEST(Mutation, RightRenderingIsInside) {
    const Scene scene = drawScene(diagonalQuad(), kSmooth);
    EXPECT_EQ(judge(scene, scene).outside, 0u);
    EXPECT_EQ(judge(scene, scene).unknown, 0u);
}

TEST(Mutation, SwappedProvokingVertex) {
    const std::vector<Vertex> right{vertex(1, 1, kRed), vertex(14, 2, kGreen), vertex(3, 13, kBlue)};
    const std::vector<Vertex> last{right[2], right[0], right[1]};
    EXPECT_GT(judge(drawScene(right, kFlat), drawScene(last, kFlat)).outside, 50u);
}

TEST(Mutation, ScissorOffByOne) {
    const auto withScissor = [](uint32_t width) {
        return drawScene(diagonalQuad(), kFlat, [width](Scene& s) {
            passOf(s).draws[0].scissor = {{4, 6}, {width, 5}};
        });
    };
    EXPECT_EQ(judge(withScissor(6), withScissor(6)).outside, 0u);
    EXPECT_EQ(judge(withScissor(6), withScissor(7)).outside, 5u);
    EXPECT_EQ(judge(withScissor(6), withScissor(5)).outside, 5u);
}

TEST(Mutation, ViewportShifted) {
    const auto moved = [](float x) {
        return drawScene({vertex(0, 0, {0, 0, 0, 1}), vertex(16, 0, {1, 0, 0, 1}), vertex(0, 16, {0, 1, 0, 1})},
                         kSmooth, [x](Scene& s) { passOf(s).draws[0].viewport.x = x; });
    };
    EXPECT_GT(judge(moved(0), moved(1)).outside, 100u);
    EXPECT_GT(judge(moved(0), moved(0.25f)).outside, 100u) << "four codes";
}

TEST(Mutation, MissingTopLeftDecrementDoublesTheDiagonal) {
    const auto additive = [] {
        std::vector<Vertex> v = diagonalQuad();
        for (Vertex& x : v) x.color = {0.25f, 0, 0, 0.25f};
        return drawScene(v, kFlat, [](Scene& s) {
            auto& b = s.pipelines[0].blend[0];
            b.blendEnable = VK_TRUE;
            b.srcColorBlendFactor = b.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
        });
    };
    const OracleImage oracle = render(additive());
    RenderedImage image = renderedFrom(oracle);
    EXPECT_EQ(compareWithOracle(oracle, image).outside, 0u);
    for (uint32_t i = 3; i <= 11; ++i) image.texels[(size_t{15 - i - 1} * 16 + i) * 4] = std::byte{128};
    EXPECT_EQ(compareWithOracle(oracle, image).outside, 9u);
    for (uint32_t i = 3; i <= 11; ++i) image.texels[(size_t{15 - i - 1} * 16 + i) * 4] = std::byte{0};
    EXPECT_EQ(compareWithOracle(oracle, image).outside, 9u);
}

TEST(Mutation, TruncatedSevenBitWeights) {
    SceneRecorder record("weights", "");
    const VkExtent2D wide{1024, 1};
    const Bytes texels{std::byte{0},   std::byte{0},   std::byte{0},   std::byte{255},
                       std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
    const uint32_t texture = record.texture("ramp", VK_FORMAT_R8G8B8A8_UNORM, {2, 1}, {texels});
    const uint32_t target = record.colorTarget("color", VK_FORMAT_R16G16B16A16_SFLOAT, wide);
    const uint32_t pipeline = record.pipeline(record.vertex(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    vec2 p = vec2(float((gl_VertexIndex & 1) * 4 - 1), float((gl_VertexIndex >> 1) * 4 - 1));
    uv = p * 0.5 + 0.5;
    gl_Position = vec4(p, 0.0, 1.0);
}
)"),
                                              record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D ramp;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(ramp, uv); }
)"));
    record.pass(wide).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 3).texture(0, texture, record.sampler(VK_FILTER_LINEAR));
    record.output(target);
    const auto scene = record.finish();
    ASSERT_TRUE(scene.ok());
    const OracleImage oracle = render(*scene);
    const auto filtered = [&oracle](int bits) {
        OracleImage image = oracle;
        for (uint32_t x = 0; x < image.extent.width; ++x) {
            const double u = std::clamp((x + 0.5) / image.extent.width * 2 - 0.5, 0.0, 1.0);
            const double weight = std::floor(std::ldexp(u, bits)) / std::ldexp(1.0, bits);
            for (size_t c = 0; c < 3; ++c) image.pixels[x].value[c] = weight;
        }
        return renderedFrom(image);
    };
    EXPECT_EQ(compareWithOracle(oracle, renderedFrom(oracle)).outside, 0u);
    EXPECT_EQ(compareWithOracle(oracle, filtered(8)).outside, 0u);
    EXPECT_GT(compareWithOracle(oracle, filtered(6)).outside, 100u);
    EXPECT_GT(compareWithOracle(oracle, filtered(7)).outside, 0u);
}

}  // namespace
}  // namespace vernier::conformance
