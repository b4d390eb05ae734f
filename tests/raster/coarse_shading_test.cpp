// Fragments of 2x2 pixels: coverage, tests and blending stay those of pixels; values are those of the point where the
// four pixels meet.
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kWidth = 203, kHeight = 150;

PipelineOptions coarseOptions(ShadingRate rate, const std::string& fragment = "color_frag",
                              VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT) {
    PipelineOptions options;
    options.fragment = fragment;
    options.accuracy.shading = rate;
    options.state = plainState(format);
    return options;
}

/// Two triangles over the whole target; red and green are x and y of the window.
std::vector<Vertex> wholeTarget() {
    const auto corner = [](double x, double y) {
        return at(x, y, kWidth, kHeight, {static_cast<float>(x), static_cast<float>(y), 0, 1});
    };
    return {corner(0, 0),      corner(kWidth, 0),       corner(0, kHeight),
            corner(kWidth, 0), corner(kWidth, kHeight), corner(0, kHeight)};
}

/// Where the fragment of a pixel is shaded.
float centreOf(uint32_t pixel) {
    return static_cast<float>(pixel / 2 * 2 + 1);
}

TEST(CoarseShading, ValuesAreThoseOfTheMiddleOfFourPixels) {
    ThreadPool pool(2);
    for (const InterpolationArithmetic arithmetic :
         {InterpolationArithmetic::singleFloat, InterpolationArithmetic::doubleFloat}) {
        Surface surface(VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight);
        PipelineOptions options = coarseOptions(ShadingRate::twoByTwo);
        options.accuracy.interpolation = arithmetic;
        Pass pass(pool, {surface.cleared({})}, {}, kWidth, kHeight);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kWidth, kHeight), wholeTarget());
        pass.end();
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const VkClearColorValue color = surface.color(x, y);
                ASSERT_NEAR(color.float32[0], centreOf(x), 1e-3) << x << ", " << y;
                ASSERT_NEAR(color.float32[1], centreOf(y), 1e-3) << x << ", " << y;
            }
        const PassStatistics& statistics = pass.pass().statistics();
        EXPECT_EQ(statistics.samplesPassed, uint64_t{kWidth} * kHeight);
        // Fragments on the diagonal belong to both triangles.
        const uint64_t fragments = uint64_t{(kWidth + 1) / 2} * ((kHeight + 1) / 2);
        EXPECT_GE(statistics.fragmentInvocations, fragments);
        EXPECT_LE(statistics.fragmentInvocations, fragments + kWidth + kHeight);
    }
}

TEST(CoarseShading, FragCoordIsTheMiddle) {
    ThreadPool pool(1);
    Surface surface(VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight);
    Pass pass(pool, {surface.cleared({})}, {}, kWidth, kHeight);
    pass.begin();
    pass.draw(makePipeline(coarseOptions(ShadingRate::twoByTwo, "fragcoord_frag")), dynamicFor(kWidth, kHeight),
              wholeTarget());
    pass.end();
    for (uint32_t y = 0; y < kHeight; y += 7)
        for (uint32_t x = 0; x < kWidth; ++x) {
            ASSERT_EQ(surface.color(x, y).float32[0], centreOf(x)) << x << ", " << y;
            ASSERT_EQ(surface.color(x, y).float32[1], centreOf(y)) << x << ", " << y;
        }
}

TEST(CoarseShading, DerivativesSpanTwoPixels) {
    ThreadPool pool(1);
    Surface surface(VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight);
    Pass pass(pool, {surface.cleared({})}, {}, kWidth, kHeight);
    pass.begin();
    pass.draw(makePipeline(coarseOptions(ShadingRate::twoByTwo, "derivative_frag")), dynamicFor(kWidth, kHeight),
              wholeTarget());
    pass.end();
    for (uint32_t y = 0; y < kHeight; y += 5)
        for (uint32_t x = 0; x < kWidth; ++x) {
            ASSERT_NEAR(surface.color(x, y).float32[0], 2, 1e-3) << x << ", " << y;
            ASSERT_NEAR(surface.color(x, y).float32[1], 0, 1e-3) << x << ", " << y;
        }
}

struct Drawn {
    uint64_t color, depth;
};

/// Triangles of one colour each, large, small and without a pixel, over and through each other: where in a fragment the
/// colour is taken makes no difference.
Drawn drawHeap(ShadingRate rate, const std::string& fragment, VkFormat format, bool blend, uint32_t threads,
               Isa isa = bestIsa()) {
    std::mt19937 random(5);
    const auto value = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 100000) / 100000;
    };
    PipelineOptions options = coarseOptions(rate, fragment, format);
    options.isa = isa;
    options.state.depthStencilFormat = VK_FORMAT_D32_SFLOAT;
    options.state.depthTest = options.state.depthWrite = !blend;
    options.state.depthCompare = VK_COMPARE_OP_LESS;
    if (blend) {
        VkPipelineColorBlendAttachmentState& state = options.state.blend[0];
        state.blendEnable = VK_TRUE;
        state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    }
    ThreadPool pool(threads);
    Surface color(format, kWidth, kHeight), depth(VK_FORMAT_D32_SFLOAT, kWidth, kHeight);
    VkClearValue far{};
    far.depthStencil.depth = 1;
    Pass pass(pool, {color.cleared({})}, depth.cleared(far), kWidth, kHeight);
    pass.begin();
    std::vector<Vertex> vertices;
    for (int t = 0; t < 600; ++t) {
        const double x = value(-10, kWidth + 10), y = value(-10, kHeight + 10), size = t % 4 == 0 ? 90 : 5;
        std::array<float, 4> shade;
        for (float& c : shade) c = static_cast<float>(value(0, 1));
        for (int corner = 0; corner < 3; ++corner)
            vertices.push_back(at(x + value(-size, size), y + value(-size, size), kWidth, kHeight, shade,
                                  static_cast<float>(value(0, 1))));
    }
    pass.draw(makePipeline(options), dynamicFor(kWidth, kHeight), vertices);
    pass.end();
    return {color.hash(), depth.hash()};
}

TEST(CoarseShading, CoverageDepthAndOrderStayThoseOfPixels) {
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16_SFLOAT})
        for (const bool blend : {false, true}) {
            const Drawn pixels = drawHeap(ShadingRate::pixel, "color_frag", format, blend, 2);
            const Drawn coarse = drawHeap(ShadingRate::twoByTwo, "color_frag", format, blend, 2);
            EXPECT_EQ(coarse.color, pixels.color) << "format " << format << ", blending " << blend;
            EXPECT_EQ(coarse.depth, pixels.depth) << "format " << format << ", blending " << blend;
        }
}

TEST(CoarseShading, ProgramsThatDecideAboutPixelsRunForEach) {
    for (const char* fragment : {"discard_frag", "samplemask_frag", "fragdepth_frag"}) {
        const Drawn pixels = drawHeap(ShadingRate::pixel, fragment, VK_FORMAT_R8G8B8A8_UNORM, false, 2);
        const Drawn coarse = drawHeap(ShadingRate::twoByTwo, fragment, VK_FORMAT_R8G8B8A8_UNORM, false, 2);
        EXPECT_EQ(coarse.color, pixels.color) << fragment;
        EXPECT_EQ(coarse.depth, pixels.depth) << fragment;
    }
}

TEST(CoarseShading, SameBitsForThreadsAndInstructionSets) {
    const Drawn first =
        drawHeap(ShadingRate::twoByTwo, "fragcoord_frag", VK_FORMAT_R8G8B8A8_UNORM, true, 1, kLowestIsa);
    for (const Isa isa : availableIsas()) {
        for (const uint32_t threads : {1u, 2u, 5u}) {
            const Drawn again =
                drawHeap(ShadingRate::twoByTwo, "fragcoord_frag", VK_FORMAT_R8G8B8A8_UNORM, true, threads, isa);
            EXPECT_EQ(again.color, first.color) << isaName(isa) << ", " << threads << " threads";
        }
    }
}

TEST(CoarseShading, SamplesAreShadedPerPixel) {
    PipelineOptions options = coarseOptions(ShadingRate::twoByTwo);
    options.state.samples = 4;
    EXPECT_FALSE(makePipeline(options)->plan().coarse);
    options.state.samples = 1;
    EXPECT_TRUE(makePipeline(options)->plan().coarse);
}

}  // namespace
}  // namespace vernier::raster_test
