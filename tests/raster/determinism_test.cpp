// The same bits for any number of threads and any instruction set.
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kWidth = 300, kHeight = 210;

struct Outcome {
    uint64_t color, depth;
    PassStatistics statistics;
};

constexpr int kDraws = 14;

/// The pipelines of a scene with some of everything: transparency, depth, stencil, discards, derivatives.
std::vector<std::shared_ptr<const GraphicsPipeline>> makePipelines(Isa isa, const Accuracy& accuracy,
                                                                   uint32_t samples) {
    std::vector<std::shared_ptr<const GraphicsPipeline>> pipelines;
    for (int d = 0; d < kDraws; ++d) {
        PipelineOptions options;
        options.isa = isa;
        options.accuracy = accuracy;
        options.fragment =
            std::array{"color_frag", "discard_frag", "derivative_frag", "fragdepth_frag"}[static_cast<size_t>(d % 4)];
        options.state = plainState(VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D24_UNORM_S8_UINT);
        options.state.samples = samples;
        options.state.depthTest = d % 3 != 0;
        options.state.depthWrite = d % 2 == 0;
        options.state.depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
        options.state.stencilTest = d % 5 == 4;
        options.state.stencilFront = {
            VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_LESS, 0, 0, 0};
        options.state.stencilBack = {
            VK_STENCIL_OP_ZERO, VK_STENCIL_OP_DECREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0, 0, 0};
        if (d % 2 == 1) {
            auto& b = options.state.blend[0];
            b.blendEnable = VK_TRUE;
            b.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
            b.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        }
        pipelines.push_back(makePipeline(options));
    }
    return pipelines;
}

/// Meshes of small triangles and large ones through all clip planes, clears between draws.
Outcome render(const std::vector<std::shared_ptr<const GraphicsPipeline>>& pipelines, uint32_t threads,
               uint32_t samples, bool flushes) {
    std::mt19937 random(17);
    const auto value = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 100000) / 100000;
    };
    ThreadPool pool(threads);
    Surface color(VK_FORMAT_R8G8B8A8_UNORM, kWidth, kHeight, samples),
        depth(VK_FORMAT_D24_UNORM_S8_UINT, kWidth, kHeight, samples);
    VkClearValue clearColor{}, clearDepth{};
    clearColor.color.float32[2] = 0.3f;
    clearDepth.depthStencil = {1, 7};
    Pass pass(pool, {color.cleared(clearColor)}, depth.cleared(clearDepth), kWidth, kHeight, samples);
    pass.begin();
    for (int d = 0; d < kDraws; ++d) {
        DynamicState dynamic = dynamicFor(kWidth, kHeight);
        dynamic.stencilFront.reference = dynamic.stencilBack.reference = 9;
        std::vector<Vertex> v;
        const int triangles = d % 3 == 0 ? 800 : 25;
        for (int t = 0; t < triangles; ++t) {
            const double x = value(-20, kWidth + 20), y = value(-20, kHeight + 20), size = d % 3 == 0 ? 6 : 160;
            for (int k = 0; k < 3; ++k) {
                Vertex vertex = at(x + value(-size, size), y + value(-size, size), kWidth, kHeight,
                                   {static_cast<float>(value(0, 1)), static_cast<float>(value(0, 1)),
                                    static_cast<float>(value(0, 1)), static_cast<float>(value(0, 1))},
                                   static_cast<float>(value(-0.1, 1.1)));
                const auto w = static_cast<float>(value(0.2, 5));
                for (float& c : vertex.position) c *= w;
                v.push_back(vertex);
            }
        }
        pass.draw(pipelines[static_cast<size_t>(d)], dynamic, v);
        if (d == 6) {
            VkClearValue clear{};
            clear.color.float32[1] = 1;
            pass.pass().clear(VK_IMAGE_ASPECT_COLOR_BIT, 0, clear, {{{50, 40}, {77, 91}}, 0, 1});
        }
        if (flushes && d % 4 == 3) pass.pass().flush();
    }
    pass.end();
    return {color.hash(), depth.hash(), pass.pass().statistics()};
}

TEST(Determinism, ThreadsInstructionSetsAndFlushes) {
    for (const uint32_t samples : {1u, 4u}) {
        for (const Profile profile : {Profile::draft, Profile::standard, Profile::reference}) {
            const Accuracy accuracy = accuracyOf(profile);
            const Outcome expected = render(makePipelines(kLowestIsa, accuracy, samples), 1, samples, false);
            for (const Isa isa : availableIsas()) {
                const auto pipelines = makePipelines(isa, accuracy, samples);
                for (const uint32_t threads : {1u, 2u, 5u}) {
                    const bool flushes = threads == 5;
                    const Outcome outcome = render(pipelines, threads, samples, flushes);
                    const std::string where = std::string(isaName(isa)) + ", " + std::to_string(threads) +
                                              " threads, " + std::string(profileName(profile));
                    EXPECT_EQ(outcome.color, expected.color) << where;
                    EXPECT_EQ(outcome.depth, expected.depth) << where;
                    EXPECT_EQ(outcome.statistics.fragmentInvocations, expected.statistics.fragmentInvocations) << where;
                    EXPECT_EQ(outcome.statistics.samplesPassed, expected.statistics.samplesPassed) << where;
                    // Flushing in between cuts chunks differently.
                    if (!flushes) {
                        EXPECT_EQ(outcome.statistics.vertexInvocations, expected.statistics.vertexInvocations) << where;
                    }
                }
            }
        }
    }
}

TEST(Determinism, ReusedPassObject) {
    ThreadPool pool(2);
    PipelineOptions options;
    options.state = plainState(VK_FORMAT_R8G8B8A8_UNORM);
    const auto pipeline = makePipeline(options);
    Surface surface(VK_FORMAT_R8G8B8A8_UNORM, 100, 100);
    Pass pass(pool, {surface.cleared({})}, {}, 100, 100);
    uint64_t first = 0;
    for (int n = 0; n < 4; ++n) {
        pass.begin();
        pass.draw(
            pipeline, dynamicFor(100, 100),
            {at(3, 3, 100, 100, {1, 0, 0, 1}), at(93, 13, 100, 100, {0, 1, 0, 1}), at(33, 83, 100, 100, {0, 0, 1, 1})});
        pass.end();
        if (n == 0) first = surface.hash();
        EXPECT_EQ(surface.hash(), first);
    }
}

TEST(Determinism, ClearsAndLoadOperations) {
    ThreadPool pool(2);
    Surface surface(VK_FORMAT_R8G8B8A8_UNORM, 130, 70);
    VkClearValue red{}, green{};
    red.color.float32[0] = 1;
    green.color.float32[1] = 1;
    {
        Pass pass(pool, {surface.cleared(red)}, {}, 130, 70);
        pass.begin();
        pass.end();
    }
    EXPECT_EQ(surface.red(129, 69), 1);
    {
        Pass pass(pool, {surface.cleared(green)}, {}, 130, 70);
        pass.targets().renderArea = {{60, 10}, {10, 10}};
        pass.begin();
        pass.end();
    }
    for (uint32_t y = 0; y < 70; ++y)
        for (uint32_t x = 0; x < 130; ++x) ASSERT_EQ(surface.red(x, y), x >= 60 && x < 70 && y >= 10 && y < 20 ? 0 : 1);
    {
        Pass pass(pool, {surface.target()}, {}, 130, 70);
        pass.begin();
        pass.pass().clear(VK_IMAGE_ASPECT_COLOR_BIT, 0, green, {{{0, 0}, {1, 1}}, 0, 1});
        pass.end();
    }
    EXPECT_EQ(surface.red(0, 0), 0);
    EXPECT_EQ(surface.red(1, 0), 1);
}

}  // namespace
}  // namespace vernier::raster_test
