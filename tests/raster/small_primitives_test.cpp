// Primitives of a few pixels, drawn a group at a time: the same bits as one by one.
#include <cmath>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kWidth = 150, kHeight = 100;

struct Outcome {
    uint64_t color = 0, depth = 0;
    PassStatistics statistics;
};

struct Case {
    PipelineOptions options;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    std::vector<Vertex> vertices;
    VkRect2D scissor{{0, 0}, {kWidth, kHeight}};
};

/// `apart`: every triangle is a draw of its own, and so is drawn alone; a depth bias, of nothing, has it set up alone.
Outcome render(const Case& test, bool apart) {
    ThreadPool pool(1);
    const VkFormat format = test.options.state.colorFormats[0];
    Surface color(format == VK_FORMAT_UNDEFINED ? VK_FORMAT_R8G8B8A8_UNORM : format, kWidth, kHeight);
    Surface depth(test.depthFormat == VK_FORMAT_UNDEFINED ? VK_FORMAT_D16_UNORM : test.depthFormat, kWidth, kHeight);
    VkClearValue clearDepth{};
    clearDepth.depthStencil.depth = 0.6f;
    std::vector<RenderTarget> colors;
    if (format != VK_FORMAT_UNDEFINED) colors.push_back(color.cleared({}));
    Pass pass(pool, colors, test.depthFormat == VK_FORMAT_UNDEFINED ? RenderTarget{} : depth.cleared(clearDepth),
              kWidth, kHeight);
    PipelineOptions options = test.options;
    if (apart) options.state.depthBiasEnable = true;
    const auto pipeline = makePipeline(options);
    EXPECT_TRUE(pipeline->plan().packsSmall);
    DynamicState dynamic = dynamicFor(kWidth, kHeight);
    dynamic.scissors[0] = test.scissor;
    pass.begin();
    const size_t step = apart ? 3 : test.vertices.size();
    for (size_t n = 0; n < test.vertices.size(); n += step)
        pass.draw(pipeline, dynamic,
                  std::vector<Vertex>(test.vertices.begin() + static_cast<std::ptrdiff_t>(n),
                                      test.vertices.begin() + static_cast<std::ptrdiff_t>(n + step)));
    pass.end();
    return {format == VK_FORMAT_UNDEFINED ? 0 : color.hash(),
            test.depthFormat == VK_FORMAT_UNDEFINED ? 0 : depth.hash(), pass.pass().statistics()};
}

void expectSame(const Case& test) {
    const Outcome together = render(test, false), alone = render(test, true);
    EXPECT_EQ(together.color, alone.color);
    EXPECT_EQ(together.depth, alone.depth);
    EXPECT_EQ(together.statistics.clippingPrimitives, alone.statistics.clippingPrimitives);
    EXPECT_EQ(together.statistics.rasterPrimitives, alone.statistics.rasterPrimitives);
    EXPECT_EQ(together.statistics.fragmentInvocations, alone.statistics.fragmentInvocations);
    EXPECT_EQ(together.statistics.samplesPassed, alone.statistics.samplesPassed);
    EXPECT_EQ(together.statistics.perspectiveDivides, alone.statistics.perspectiveDivides);
    EXPECT_NE(together.statistics.samplesPassed, 0u);
}

/// Triangles around random places, mostly of a few pixels: slivers, some too large to be packed, some on top of the one
/// before, some cut by the edges of the screen; with w of `perspective` to 1. `scale`: times as large.
std::vector<Vertex> randomTriangles(uint32_t seed, uint32_t count, double perspective, double scale = 1) {
    std::mt19937 random(seed);
    const auto value = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 65536) / 65536;
    };
    std::vector<Vertex> vertices;
    double x = 0, y = 0;
    for (uint32_t n = 0; n < count; ++n) {
        if (n % 3 != 1) {
            x = value(-2, kWidth + 2);
            y = value(-2, kHeight + 2);
        }
        const double size = scale * std::array{1.5, 3.0, 5.0, 7.0, 14.0}[random() % 5], thin = n % 7 == 0 ? 0.02 : 1;
        // Some lie at the depth to which the attachment was cleared.
        const bool level = n % 5 == 0;
        const float z = level ? 0.6f : static_cast<float>(value(0, 1));
        for (int corner = 0; corner < 3; ++corner) {
            Vertex v = at(x + value(-0.5, 0.5) * size, y + value(-0.5, 0.5) * size * thin, kWidth, kHeight,
                          {static_cast<float>(value(-0.1, 1.1)), static_cast<float>(value(0, 1)),
                           static_cast<float>(value(0, 1)), static_cast<float>(value(0, 1))},
                          z + (level ? 0 : static_cast<float>(value(-0.02, 0.02))));
            // Every other triangle in perspective; some so far away that 1/w needs an exponent of its own.
            const double w = n % 2 == 0 ? 1 : value(perspective, 1) * (n % 31 == 1 ? 0x1p70 : 1);
            for (float& part : v.position) part *= static_cast<float>(w);
            vertices.push_back(v);
        }
    }
    return vertices;
}

Case caseOf(Isa isa, VkFormat color, VkFormat depth, VkCompareOp compare) {
    Case test;
    test.options.isa = isa;
    test.options.state = plainState(color, depth);
    test.depthFormat = depth;
    test.options.state.depthTest = test.options.state.depthWrite = depth != VK_FORMAT_UNDEFINED;
    test.options.state.depthCompare = compare;
    return test;
}

TEST(SmallPrimitives, DepthFormatsAndComparisons) {
    for (const Isa isa : availableIsas())
        for (const VkFormat format : {VK_FORMAT_UNDEFINED, VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT,
                                      VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT})
            for (uint32_t op = VK_COMPARE_OP_LESS; op <= VK_COMPARE_OP_ALWAYS; ++op) {
                SCOPED_TRACE(std::string(isaName(isa)) + ", format " + std::to_string(format) + ", compare " +
                             std::to_string(op));
                Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_UNORM, format, static_cast<VkCompareOp>(op));
                test.options.state.depthWrite = test.options.state.depthTest && op % 2 == 1;
                test.vertices = randomTriangles(op, 400, 0.25);
                expectSame(test);
            }
}

/// Rectangles of two triangles, with corners between pixels, some of them in perspective; every third over the last.
std::vector<Vertex> tiles(double width, double height) {
    std::mt19937 random(5);
    const auto jitter = [&] { return static_cast<double>(random() % 1024) / 300 - 1.7; };
    std::vector<Vertex> vertices;
    size_t count = 0;
    for (double y = 0; y < kHeight; y += height)
        for (double x = 0; x < kWidth; x += width, ++count) {
            const double grown = count % 3 == 0 ? 5 : 0;
            std::array<Vertex, 4> corners;
            for (size_t k = 0; k < 4; ++k) {
                const auto part = static_cast<float>(k) / 4;
                corners[k] =
                    at(x + (k % 2 == 1 ? width + grown : 0) + jitter(), y + (k > 1 ? height + grown : 0) + jitter(),
                       kWidth, kHeight, {part, 1 - part, 0.5f * part, 0.25f + part / 2});
                const float w = count % 2 == 0 ? 1 : 0.5f + part;
                for (float& value : corners[k].position) value *= w;
            }
            for (const size_t k : {0, 1, 2, 1, 3, 2}) vertices.push_back(corners[k]);
        }
    return vertices;
}

TEST(SmallPrimitives, LargerOnesShareBlocks) {
    for (const Isa isa : availableIsas())
        for (const bool blends : {false, true})
            for (const VkFormat depth : {VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT}) {
                SCOPED_TRACE(std::string(isaName(isa)) + (blends ? ", blended" : "") + ", depth " +
                             std::to_string(depth));
                Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_UNORM, depth, VK_COMPARE_OP_LESS_OR_EQUAL);
                if (blends) setAdditive(test.options.state);
                test.vertices = tiles(21.3, 17.9);
                expectSame(test);
                const uint64_t apart = render(test, true).statistics.batches;
                EXPECT_LT(render(test, false).statistics.batches, apart * 9 / 10);
            }
}

TEST(SmallPrimitives, Blending) {
    for (const Isa isa : availableIsas())
        for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})
            for (const bool depth : {false, true}) {
                SCOPED_TRACE(std::string(isaName(isa)) + ", format " + std::to_string(format));
                Case test = caseOf(isa, format, depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED,
                                   VK_COMPARE_OP_LESS_OR_EQUAL);
                auto& blend = test.options.state.blend[0];
                blend.blendEnable = VK_TRUE;
                blend.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
                blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
                test.vertices = randomTriangles(5, 3000, 1);
                expectSame(test);
            }
}

TEST(SmallPrimitives, EveryInterpolation) {
    for (const Isa isa : availableIsas())
        for (const char* fragment : {"varyings_frag", "flatbits_frag"}) {
            SCOPED_TRACE(std::string(isaName(isa)) + ", " + fragment);
            const bool bits = std::string(fragment) == "flatbits_frag";
            Case test = caseOf(isa, bits ? VK_FORMAT_R32G32B32A32_SINT : VK_FORMAT_R32G32B32A32_SFLOAT,
                               VK_FORMAT_UNDEFINED, VK_COMPARE_OP_ALWAYS);
            test.options.vertex = "varyings_vert";
            test.options.fragment = fragment;
            test.options.state.provokingVertexLast = bits;
            test.vertices = randomTriangles(9, 1500, 0.1);
            expectSame(test);
        }
}

/// 4 sub-pixel bits: edges of the same length in sub-units reach over many tiles, of which a scissor leaves a few
/// pixels.
TEST(SmallPrimitives, CoarserGrid) {
    for (const Isa isa : availableIsas()) {
        Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D32_SFLOAT, VK_COMPARE_OP_LESS);
        test.options.accuracy.subPixelBits = 4;
        test.vertices = randomTriangles(13, 2000, 0.5);
        expectSame(test);
        test.vertices = randomTriangles(13, 2000, 1, 12);
        test.scissor = {{60, 61}, {7, 8}};
        expectSame(test);
    }
}

/// Slivers are drawn alone: as many as a batch has lanes, a pixel each, or some more or less, and packed ones behind
/// them.
TEST(SmallPrimitives, BehindABatchOfSlivers) {
    for (const Isa isa : availableIsas())
        for (uint32_t slivers = 60; slivers <= 132; ++slivers) {
            if (slivers == 68) slivers = 124;
            SCOPED_TRACE(std::string(isaName(isa)) + ", " + std::to_string(slivers) + " slivers");
            Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_UNDEFINED, VK_COMPARE_OP_ALWAYS);
            const auto add = [&](double x, double y, double left, double right) {
                const std::array<float, 4> shade{static_cast<float>(x) / 64, static_cast<float>(y) / 64, 0.5f, 1};
                test.vertices.push_back(at(x + left, y, kWidth, kHeight, shade));
                test.vertices.push_back(at(x + right, y, kWidth, kHeight, shade));
                test.vertices.push_back(at(x + 0.5, y + 1, kWidth, kHeight, shade));
            };
            for (uint32_t n = 0; n < slivers; ++n) add(n % 16 * 4, n / 16 * 4, 0.48, 0.52);
            for (uint32_t n = 0; n < 200; ++n) add(n % 16 * 4, n / 16 * 4, 0, 1);
            expectSame(test);
        }
}

TEST(SmallPrimitives, DepthAlone) {
    for (const Isa isa : availableIsas()) {
        Case test = caseOf(isa, VK_FORMAT_UNDEFINED, VK_FORMAT_D32_SFLOAT, VK_COMPARE_OP_LESS);
        test.options.fragment = "";
        test.vertices = randomTriangles(3, 1500, 0.5);
        expectSame(test);
    }
}

TEST(SmallPrimitives, FacesAndScissor) {
    for (const Isa isa : availableIsas()) {
        Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_D24_UNORM_S8_UINT, VK_COMPARE_OP_GREATER);
        test.scissor = {{9, 13}, {70, 66}};
        test.vertices = randomTriangles(11, 2000, 1);
        for (const VkFrontFace face : {VK_FRONT_FACE_CLOCKWISE, VK_FRONT_FACE_COUNTER_CLOCKWISE})
            for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT, VK_CULL_MODE_FRONT_BIT}) {
                test.options.state.frontFace = face;
                test.options.state.cullMode = cull;
                expectSame(test);
            }
    }
}

/// The greatest that is packed, at every place relative to blocks and tiles: the rectangle of two triangles.
TEST(SmallPrimitives, EveryPlaceInBlocks) {
    for (const Isa isa : availableIsas()) {
        Case test = caseOf(isa, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_UNDEFINED, VK_COMPARE_OP_ALWAYS);
        for (uint32_t place = 0; place < 64; ++place) {
            const double x = 50 + place % 8 + 9 * (place / 8 % 4), y = 52 + place / 8;
            const std::array<float, 4> shade{static_cast<float>(place) / 64, 1, 0.5f, 1};
            for (const auto& [u, v] : {std::pair{0, 0}, {0, 8}, {8, 0}, {8, 0}, {0, 8}, {8, 8}})
                test.vertices.push_back(at(x + u, y + v, kWidth, kHeight, shade));
        }
        expectSame(test);
    }
}

/// A point covers the pixels whose centres lie in [x - size / 2, x + size / 2) x [y - size / 2, y + size / 2).
TEST(SmallPrimitives, PointsCoverTheirSquares) {
    std::mt19937 random(21);
    for (const Isa isa : availableIsas()) {
        PipelineOptions options;
        options.isa = isa;
        options.vertex = "point_vert";
        options.fragment = "one_frag";
        options.state = plainState(VK_FORMAT_R32_SFLOAT);
        options.state.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        setAdditive(options.state);
        const auto pipeline = makePipeline(options);
        ASSERT_TRUE(pipeline->plan().packsSmall);
        constexpr uint32_t kSide = 128;  // a power of two: places on the sub-pixel grid stay exact
        std::vector<float> expected(kSide * kSide);
        std::vector<Vertex> vertices;
        for (int n = 0; n < 600; ++n) {
            const double x = 1 + random() % (126 * 256) / 256.0, y = 1 + random() % (126 * 256) / 256.0;
            const double size = n % 5 == 0 ? 8 + n % 3 : 1 + random() % (7 * 256) / 256.0;
            vertices.push_back(at(x, y, kSide, kSide, {0, 0, 0, static_cast<float>(size)}));
            // On ties of half a sub-unit the sides are rounded to even.
            const auto snap = [](double side) { return std::nearbyint(side * 256) / 256; };
            for (uint32_t row = 0; row < kSide; ++row)
                for (uint32_t column = 0; column < kSide; ++column)
                    expected[row * kSide + column] += column + 0.5 >= snap(x - size / 2) &&
                                                      column + 0.5 < snap(x + size / 2) &&
                                                      row + 0.5 >= snap(y - size / 2) && row + 0.5 < snap(y + size / 2);
        }
        ThreadPool pool(1);
        Surface color(VK_FORMAT_R32_SFLOAT, kSide, kSide);
        Pass pass(pool, {color.cleared({})}, {}, kSide, kSide);
        pass.begin();
        pass.draw(pipeline, dynamicFor(kSide, kSide), vertices);
        pass.end();
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x)
                ASSERT_EQ(color.red(x, y), expected[y * kSide + x]) << isaName(isa) << " " << x << ", " << y;
    }
}

}  // namespace
}  // namespace vernier::raster_test
