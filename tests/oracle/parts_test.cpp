// The parts of the whole-scene oracle: storing ranges, sampling with ranges, triangles, and the states of a
// sample.
#include "conformance/oracle/encode.h"
#include "conformance/oracle/filtering.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/sample_states.h"
#include "conformance/oracle/texture_unit.h"
#include "conformance/oracle/triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace vernier::conformance::exact {
namespace {

std::vector<Component> components() {
    return {{0, 0, 8, Encoding::unorm},   {0, 0, 8, Encoding::snorm},   {0, 0, 8, Encoding::srgb},
            {0, 0, 16, Encoding::unorm},  {0, 0, 2, Encoding::unorm},   {0, 0, 5, Encoding::unorm},
            {0, 0, 24, Encoding::unorm},  {0, 0, 16, Encoding::sfloat}, {0, 0, 32, Encoding::sfloat},
            {0, 0, 11, Encoding::ufloat}, {0, 0, 10, Encoding::ufloat}};
}

TEST(Quantise, AgreesWithExactEncoding) {
    std::mt19937 random(1);
    for (const Component& c : components()) {
        for (int i = 0; i < 400; ++i) {
            const double x = std::ldexp(static_cast<double>(random()) - 2147483648.0, -31) * (i % 3 ? 1.25 : 200);
            const CodeSet codes = encode(c, rational(x));
            const Interval q = quantise(c, x);
            const auto number = [&c](uint64_t code) { return decodeNumber(c, code); };
            ASSERT_EQ(q.value, number(codes.nearest)) << x << " in " << int{c.bits} << " bits";
            // A value within the tolerance of a code counts as that code; then the range is that code alone.
            ASSERT_GE(q.low, number(codes.below)) << x << " in " << int{c.bits} << " bits";
            ASSERT_LE(q.high, number(codes.above)) << x;
            ASSERT_LE(q.low, q.value);
            ASSERT_GE(q.high, q.value);
        }
    }
}

TEST(Quantise, DecodingAgrees) {
    for (const Component& c : components()) {
        const uint64_t step = c.bits > 11 ? 9973 : 1;
        for (uint64_t code = 0; code<uint64_t{1} << c.bits; code += c.bits> 24 ? 9973000 : step) {
            const auto exactly = decode(c, code);
            if (!exactly) {
                EXPECT_FALSE(std::isfinite(decodeNumber(c, code)));
            } else {
                EXPECT_NEAR(decodeNumber(c, code), exactly->get_d(), std::abs(exactly->get_d()) * 1e-15);
            }
        }
    }
}

TEST(Quantise, RangesWidenToNeighbours) {
    const Component unorm8{0, 0, 8, Encoding::unorm};
    const Interval q = quantise(unorm8, {0.25, 0.249, 0.251});
    EXPECT_EQ(q.value * 255, 64);
    EXPECT_EQ(q.low * 255, 63);
    EXPECT_EQ(q.high * 255, 65);
    EXPECT_EQ(quantise(unorm8, 1.0), Interval(1.0));
    EXPECT_TRUE(quantise(unorm8, 64.0 / 255).isExact());
    const Component half{0, 0, 16, Encoding::sfloat};
    const Interval over = quantise(half, 70000.0);
    EXPECT_EQ(over.low, 65504);
    EXPECT_TRUE(std::isinf(over.high));
}

ImageStore rampTexture(VkExtent2D extent, uint32_t mips = 1) {
    SceneImage image;
    image.name = "ramp";
    image.format = VK_FORMAT_R32_SFLOAT;
    image.extent = extent;
    image.mipLevels = mips;
    for (uint32_t mip = 0; mip < mips; ++mip) {
        const uint32_t w = std::max(1u, extent.width >> mip), h = std::max(1u, extent.height >> mip);
        Bytes bytes(size_t{w} * h * 4);
        for (uint32_t i = 0; i < w * h; ++i) {
            const float v = mip * 100.0f + static_cast<float>(i % w) + 10.0f * static_cast<float>(i / w);
            std::memcpy(bytes.data() + i * 4, &v, 4);
        }
        image.data.push_back(bytes);
    }
    return std::move(*ImageStore::create(image));
}

SceneSampler linearSampler() {
    SceneSampler s;
    s.magFilter = s.minFilter = VK_FILTER_LINEAR;
    s.addressModeU = s.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    return s;
}

TEST(Texture, BoxHoldsTheExactFilter) {
    const ImageStore image = rampTexture({8, 4});
    const auto texel = [](int64_t x, int64_t y) {
        return Rational(static_cast<long>(std::clamp<int64_t>(x, 0, 7) + 10 * std::clamp<int64_t>(y, 0, 3)));
    };
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) {
        SampleQuery q;
        q.s = static_cast<double>(random() % 4096) / 4096 * 1.2 - 0.1;
        q.t = static_cast<double>(random() % 4096) / 4096;
        const Interval v = sampleImage(image, linearSampler(), q).color[0];
        const Rational u = rational(q.s) * 8, w = rational(q.t) * 4;
        EXPECT_NEAR(v.value, bilinear(texel, u, w).get_d(), 1e-12);
        for (const int bits : {8, 12}) {
            const double quantised = bilinear(texel, u, w, bits).get_d();
            EXPECT_GE(quantised, v.low - 1e-12);
            EXPECT_LE(quantised, v.high + 1e-12);
        }
        EXPECT_LT(v.high - v.low, 22.0 / 128 + 0.01);
    }
}

TEST(Texture, NearestIsOpenOnlyAtBorders) {
    const ImageStore image = rampTexture({8, 4});
    SceneSampler sampler = linearSampler();
    sampler.magFilter = sampler.minFilter = VK_FILTER_NEAREST;
    SampleQuery q;
    q.s = 3.5 / 8;
    q.t = 0.125;
    EXPECT_EQ(sampleImage(image, sampler, q).color[0], Interval(3.0));
    q.s = 3.0 / 8;
    EXPECT_EQ(sampleImage(image, sampler, q).color[0], Interval(3.0, 2.0, 3.0));
}

// L04, L05, L07.
TEST(Texture, Levels) {
    const ImageStore image = rampTexture({8, 8}, 4);
    SceneSampler sampler;
    sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    SampleQuery q;
    q.s = q.t = 1.0 / 16;
    EXPECT_EQ(sampleImage(image, sampler, q).color[0], Interval(0.0)) << "no derivatives: the base level";
    q.lod = 0.5;
    const Interval half = sampleImage(image, sampler, q).color[0];
    EXPECT_EQ(half.value, 0) << "ceil(0.5 + 0.5) - 1";
    EXPECT_EQ(half.high, 100) << "floor(0.5 + 0.5)";
    q.lod = 2;
    EXPECT_EQ(sampleImage(image, sampler, q).color[0], Interval(200.0));
    q.lod.reset();
    q.ddx = {2.0 / 8, 0};
    q.ddy = {0, 2.0 / 8};
    const Interval lambda = levelOfDetail(q, sampler, {8, 8});
    EXPECT_EQ(lambda.value, 1);
    EXPECT_NEAR(lambda.low, 1, 0.05);
    EXPECT_NEAR(lambda.high, 2, 0.05) << "the sum of both axes is an accepted scale factor";
}

TEST(Texture, DepthComparison) {
    const ImageStore image = rampTexture({8, 4});
    SceneSampler sampler = linearSampler();
    sampler.compareEnable = true;
    sampler.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    SampleQuery q;
    q.s = 4.0 / 8;
    q.t = 0.125;
    q.dref = 3.5;  // between texels 3 and 4, half-way
    const Interval lit = sampleImage(image, sampler, q).color[0];
    EXPECT_NEAR(lit.value, 0.5, 1e-12);
    EXPECT_NEAR(lit.low, 0.5, 0.01);
    q.dref = 4;
    EXPECT_EQ(sampleImage(image, sampler, q).color[0].value, 0.5);
    EXPECT_LT(sampleImage(image, sampler, q).color[0].low, 0.01) << "equality within rounding is open";
}

constexpr VkViewport kViewport{0, 0, 8, 8, 0, 1};

Clip<double> at(double x, double y, double z = 0.5) {
    return {x / 4 - 1, y / 4 - 1, z, 1};
}

Triangle triangle(Clip<double> a, Clip<double> b, Clip<double> c) {
    auto t = Triangle::create({{a, b, c}, kViewport, true, {}, 1});
    EXPECT_TRUE(t);
    return *t;
}

GridPoint centre(int64_t x, int64_t y) {
    return {x * 256 + 128, y * 256 + 128};
}

TEST(TriangleVerdict, DiagonalIsOpenWithOppositeSides) {
    const Triangle a = triangle(at(1, 1), at(1, 7), at(7, 1)), b = triangle(at(7, 7), at(7, 1), at(1, 7));
    const SampleVerdict va = a.classify(centre(3, 4)), vb = b.classify(centre(3, 4));
    ASSERT_TRUE(va.possible && vb.possible);
    ASSERT_EQ(va.edgeCount, 1u);
    ASSERT_EQ(vb.edgeCount, 1u);
    EXPECT_EQ(va.edges[0].key, vb.edges[0].key);
    EXPECT_NE(va.edges[0].insideSide, vb.edges[0].insideSide);
    EXPECT_FALSE(va.edges[0].nominalInside);
    EXPECT_TRUE(vb.edges[0].nominalInside);
    EXPECT_EQ(a.classify(centre(2, 2)).edgeCount, 0u);
    EXPECT_TRUE(a.classify(centre(2, 2)).possible);
    EXPECT_FALSE(b.classify(centre(2, 2)).possible);
}

TEST(TriangleVerdict, NearPlaneAndEyePlane) {
    // z from -0.5 on the left to 0.5 on the right: the cut is at x = 4.
    const Triangle cut = triangle(at(0, 0, -0.5), at(0, 16, -0.5), at(8, 0, 0.5));
    EXPECT_FALSE(cut.classify(centre(2, 1)).possible);
    EXPECT_TRUE(cut.classify(centre(5, 1)).possible);
    EXPECT_FALSE(cut.classify(centre(5, 1)).cutOpen);
    EXPECT_TRUE(cut.classify({1024, 300}).cutOpen);
    // W03: behind the eye.
    EXPECT_FALSE(Triangle::create({{Clip<double>{0, 0, -1, -1}, Clip<double>{1, 0, -1, -1}, Clip<double>{0, 1, -1, -1}},
                                   kViewport,
                                   true,
                                   {},
                                   1}));
    // W04: an external triangle shows its front part only. The third vertex projects below the screen, but lies behind
    // the eye: from the lower border the triangle extends upwards, away from its projection.
    const auto external =
        Triangle::create({{Clip<double>{-1, 1, 0.5, 1}, Clip<double>{1, 1, 0.5, 1}, Clip<double>{0, -5, -0.5, -1}},
                          kViewport,
                          true,
                          {},
                          1});
    ASSERT_TRUE(external);
    EXPECT_TRUE(external->classify(centre(4, 2)).possible);
    EXPECT_FALSE(external->classify(centre(4, 20)).possible);
    // The sides of the view volume: nothing beyond the viewport.
    const Triangle wide = triangle(at(-9, -9), at(20, -9), at(-9, 30));
    EXPECT_TRUE(wide.classify(centre(0, 0)).possible);
    EXPECT_FALSE(wide.classify(centre(-1, 0)).possible);
    EXPECT_FALSE(wide.classify(centre(0, 8)).possible);
    // W09: a NaN drops the primitive.
    EXPECT_FALSE(Triangle::create({{at(0, 0), at(8, 0), {0, 0, 0, std::nan("")}}, kViewport, true, {}, 1}));
}

TEST(TriangleVerdict, EmptyTriangles) {
    EXPECT_FALSE(Triangle::create({{at(1, 1), at(1, 1), at(5, 5)}, kViewport, true, {}, 1}));
    EXPECT_FALSE(Triangle::create({{at(1, 1), at(3, 3), at(5, 5)}, kViewport, true, {}, 1}));
    // Collinear only before snapping: a legal implementation may cover a sample within a sub-unit of it, the
    // declared one not.
    const auto thin = Triangle::create({{at(0.4, 0.4001), at(4.3, 4.3), at(7.7, 7.7001)}, kViewport, true, {}, 1});
    ASSERT_TRUE(thin);
    const SampleVerdict v = thin->classify(centre(5, 5));
    EXPECT_TRUE(v.possible);
    EXPECT_TRUE(v.openAsWhole);
    EXPECT_FALSE(thin->classify(centre(5, 3)).possible);
}

struct StateTest : testing::Test {
    ScenePipeline pipeline;
    OutputState output;
    FragmentResult red, green;
    Sample sample{SampleState{}};

    StateTest() {
        pipeline.blend.resize(1);
        pipeline.blend[0].colorWriteMask = 0xf;
        output.pipeline = &pipeline;
        output.colorCount = 1;
        output.colorFormats[0] = findPixelFormat(VK_FORMAT_R8G8B8A8_UNORM);
        output.depthFormat = findPixelFormat(VK_FORMAT_D32_SFLOAT);

        red.colors[0] = {1.0, 0.0, 0.0, 1.0};
        green.colors[0] = {0.0, 1.0, 0.0, 1.0};
        sample[0].depth = 1.0;
    }

    void draw(const Triangle& t, const FragmentResult& fragment, const GridPoint& p, uint64_t identity = 0) {
        SampleInput input;
        input.verdict = t.classify(p);
        if (!input.verdict.possible) return;
        input.viewport = kViewport;
        input.fragment = &fragment;
        input.depth = t.depth(p);
        input.depthOrigin = identity ? identity : t.identity();
        applyTriangle(output, input, sample);
    }
};

TEST_F(StateTest, SharedEdgeLeavesNoCrackAndNoDouble) {
    draw(triangle(at(1, 1), at(1, 7), at(7, 1)), red, centre(3, 4));
    ASSERT_EQ(sample.size(), 2u);
    EXPECT_EQ(sample[0].colors[0][0], Interval(0.0)) << "declared: the diagonal belongs to the other triangle";
    draw(triangle(at(7, 7), at(7, 1), at(1, 7)), green, centre(3, 4));
    ASSERT_EQ(sample.size(), 2u);
    EXPECT_EQ(sample[0].colors[0][1], Interval(1.0));
    EXPECT_EQ(sample[1].colors[0][0], Interval(1.0)) << "red kept, green not drawn";
    EXPECT_EQ(sample[1].colors[0][1], Interval(0.0));
}

TEST_F(StateTest, WithoutSharedVerticesBothAnswersAreFree) {
    draw(triangle(at(1, 1), at(1, 7), at(7, 1)), red, centre(3, 4));
    draw(triangle(at(7, 7), at(8, 0), at(0, 8)), green, centre(3, 4));
    EXPECT_EQ(sample.size(), 3u) << "background, red, green";
}

TEST_F(StateTest, OpaqueOverdrawSettlesEverything) {
    draw(triangle(at(1, 1), at(1, 7), at(7, 1)), red, centre(3, 4));
    draw(triangle(at(-9, -9), at(20, -9), at(-9, 30)), green, centre(3, 4));
    EXPECT_EQ(sample.size(), 1u);
    EXPECT_EQ(sample[0].colors[0][1], Interval(1.0));
}

TEST_F(StateTest, DepthTiesAreOpenUnlessItIsTheSameTriangle) {
    pipeline.depthTest = pipeline.depthWrite = true;
    pipeline.depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    const Triangle first = triangle(at(-9, -9, 0.2), at(20, -9, 0.7), at(-9, 30, 0.4));
    const Triangle coplanar = triangle(at(20, -9, 0.7), at(-9, 30, 0.4), at(-9, -9, 0.2));
    draw(first, red, centre(3, 4));
    ASSERT_EQ(sample.size(), 1u);
    draw(first, green, centre(3, 4));
    ASSERT_EQ(sample.size(), 1u) << "the same vertices in the same order have the same depth";
    EXPECT_EQ(sample[0].colors[0][1], Interval(1.0));
    draw(coplanar, red, centre(3, 4));
    EXPECT_EQ(sample.size(), 2u);
}

TEST_F(StateTest, StencilStatesStayExact) {
    output.depthFormat = findPixelFormat(VK_FORMAT_D32_SFLOAT_S8_UINT);
    pipeline.stencilTest = true;
    pipeline.front = {
        VK_STENCIL_OP_KEEP, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 0};
    pipeline.back = pipeline.front;
    draw(triangle(at(1, 1), at(1, 7), at(7, 1)), red, centre(3, 4));
    draw(triangle(at(7, 7), at(7, 1), at(1, 7)), red, centre(3, 4));
    ASSERT_EQ(sample.size(), 1u) << "S04: counted once either way, and then the states are equal";
    EXPECT_EQ(sample[0].stencil, 1);
}

TEST_F(StateTest, BlendingPropagatesRanges) {
    auto& b = pipeline.blend[0];
    b.blendEnable = VK_TRUE;
    b.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    b.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    b.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    FragmentResult half;
    half.colors[0] = {1.0, 0.0, 0.0, 0.5};
    const Triangle cover = triangle(at(-9, -9), at(20, -9), at(-9, 30));
    draw(cover, half, centre(3, 4));
    // 127.5: 127 or 128; again: from 127 191, from 128 191.5. Of the source's
    // term the factor and the product may be rounded, a code together, of the destination's a quarter and a half.
    EXPECT_EQ(sample[0].colors[0][0].low * 255, 127);
    EXPECT_EQ(sample[0].colors[0][0].high * 255, 128);
    draw(cover, half, centre(3, 4));
    EXPECT_NEAR(sample[0].colors[0][0].low * 255, 190, 1e-9);
    EXPECT_NEAR(sample[0].colors[0][0].high * 255, 193, 1e-9);
}

}  // namespace
}  // namespace vernier::conformance::exact
