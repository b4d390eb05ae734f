// Several samples per pixel.
#include <cmath>
#include <random>

#include "runtime/plan/sample_positions.h"
#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

using Color = std::array<float, 4>;
constexpr uint32_t kSize = 40;

class Multisample : public testing::Test {
  protected:
    struct Result {
        std::unique_ptr<Surface> color, resolved;
        PassStatistics statistics;
    };
    Result draw(VkFormat format, uint32_t samples, const std::vector<Vertex>& vertices,
                const std::function<void(GraphicsState&)>& change = {}, const std::string& fragment = "one_frag",
                const std::string& vertex = "color_vert") {
        PipelineOptions options;
        options.vertex = vertex;
        options.fragment = fragment;
        options.state = plainState(format);
        options.state.samples = samples;
        options.skips = skips_;
        if (change) change(options.state);
        Result result{std::make_unique<Surface>(format, kSize, kSize, samples),
                      std::make_unique<Surface>(format, kSize, kSize),
                      {}};
        Pass pass(pool_, {result.color->cleared({})}, {}, kSize, kSize, samples);
        pass.targets().resolves[0] = result.resolved->target();
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kSize, kSize), vertices);
        pass.end();
        result.statistics = pass.pass().statistics();
        return result;
    }
    ThreadPool pool_{2};
    Skips skips_;
};

const std::vector<Vertex> kWhole{at(-5, -5, kSize, kSize), at(200, -5, kSize, kSize), at(-5, 200, kSize, kSize)};

TEST_F(Multisample, PartitionPerSample) {
    for (const uint32_t samples : {2u, 4u, 8u, 16u}) {
        // A fan whose hub and edges go through standard sample positions.
        std::vector<Vertex> v;
        const double cx = 16 + 6.0 / 16, cy = 16 + 2.0 / 16;
        for (int k = 0; k < 16; ++k) {
            const auto rim = [&](int n) {
                const double angle = 6.283185307179586 * (n % 16) / 16;
                return at(cx + std::round(14 * 16 * std::cos(angle)) / 16,
                          cy + std::round(14 * 16 * std::sin(angle)) / 16, kSize, kSize);
            };
            v.push_back(at(cx, cy, kSize, kSize));
            v.push_back(rim(k));
            v.push_back(rim(k + 1));
        }
        const Result result = draw(VK_FORMAT_R32_SFLOAT, samples, v, setAdditive);
        float total = 0;
        for (uint32_t s = 0; s < samples; ++s) {
            for (uint32_t y = 0; y < kSize; ++y) {
                for (uint32_t x = 0; x < kSize; ++x) {
                    ASSERT_LE(result.color->red(x, y, s), 1);
                    total += result.color->red(x, y, s);
                    const SamplePosition p = samplePositions(samples)[s];
                    if (std::hypot(x + p.x() - cx, y + p.y() - cy) < 13) {
                        ASSERT_EQ(result.color->red(x, y, s), 1) << x << "," << y;
                    }
                }
            }
        }
        EXPECT_GT(total, 500 * samples);
    }
}

TEST_F(Multisample, SamplesEqualSupersampling) {
    // Sample s of a pixel is the centre of a pixel in an image 16 times as large that is moved by half of its pixels.
    std::mt19937 random(16);
    constexpr uint32_t kScale = 16;
    for (uint32_t n = 0; n < 12; ++n) {
        const uint32_t samples = 2u << n % 4;
        std::vector<Vertex> v, big;
        for (int k = 0; k < 3; ++k) {
            const double x = static_cast<double>(random() % (kSize * 16)) / 16,
                         y = static_cast<double>(random() % (kSize * 16)) / 16;
            v.push_back(at(x, y, kSize, kSize));
            big.push_back(at(x * kScale + 0.5, y * kScale + 0.5, kSize * kScale, kSize * kScale));
        }
        const Result result = draw(VK_FORMAT_R32_SFLOAT, samples, v);
        PipelineOptions options;
        options.fragment = "one_frag";
        options.state = plainState(VK_FORMAT_R32_SFLOAT);
        Surface surface(VK_FORMAT_R32_SFLOAT, kSize * kScale, kSize * kScale);
        Pass pass(pool_, {surface.cleared({})}, {}, kSize * kScale, kSize * kScale);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kSize * kScale, kSize * kScale), big);
        pass.end();
        for (uint32_t s = 0; s < samples; ++s) {
            const SamplePosition p = samplePositions(samples)[s];
            for (uint32_t y = 0; y < kSize; ++y)
                for (uint32_t x = 0; x < kSize; ++x)
                    ASSERT_EQ(result.color->red(x, y, s), surface.red(x * kScale + p.x16, y * kScale + p.y16))
                        << x << "," << y << " sample " << s << " of " << samples;
        }
    }
}

TEST_F(Multisample, FractionalViewportsCutSamples) {
    for (const uint32_t samples : {1u, 4u, 16u}) {
        PipelineOptions options;
        options.fragment = "one_frag";
        options.state = plainState(VK_FORMAT_R32_SFLOAT);
        options.state.samples = samples;
        Surface surface(VK_FORMAT_R32_SFLOAT, kSize, kSize, samples);
        DynamicState dynamic = dynamicFor(kSize, kSize);
        dynamic.viewports[0] = {3.3f, 30.2f, 10.4f, -20.7f, 0, 1};
        Pass pass(pool_, {surface.cleared({})}, {}, kSize, kSize, samples);
        pass.begin();
        pass.draw(makePipeline(options), dynamic, kWhole);
        pass.end();
        const auto inside = [](double place, float low, float size) {
            return place >= double{low} && place < double{low} + double{size};
        };
        for (uint32_t s = 0; s < samples; ++s) {
            const SamplePosition p = samplePositions(samples)[s];
            for (uint32_t y = 0; y < kSize; ++y)
                for (uint32_t x = 0; x < kSize; ++x)
                    ASSERT_EQ(surface.red(x, y, s),
                              inside(x + p.x(), 3.3f, 10.4f) && inside(y + p.y(), 30.2f - 20.7f, 20.7f) ? 1 : 0)
                        << x << "," << y << " sample " << s << " of " << samples;
        }
    }
}

TEST_F(Multisample, ProgrammedPositions) {
    std::mt19937 random(5);
    PipelineOptions options;
    options.fragment = "one_frag";
    options.state = plainState(VK_FORMAT_R32_SFLOAT);
    options.state.sampleLocations = true;
    DynamicState dynamic = dynamicFor(kSize, kSize);
    for (const uint32_t samples : {1u, 2u, 8u}) {
        options.state.samples = samples;
        for (auto& place : dynamic.sampleLocations)
            place = {static_cast<uint8_t>(random() % 16), static_cast<uint8_t>(random() % 16)};
        Surface surface(VK_FORMAT_R32_SFLOAT, kSize, kSize, samples);
        Pass pass(pool_, {surface.cleared({})}, {}, kSize, kSize, samples);
        pass.begin();
        // The half plane x + y < 31.
        pass.draw(makePipeline(options), dynamic,
                  {at(-50, -50, kSize, kSize), at(81, -50, kSize, kSize), at(-50, 81, kSize, kSize)});
        pass.end();
        for (uint32_t s = 0; s < samples; ++s) {
            const SamplePosition p = dynamic.sampleLocations[s];
            for (uint32_t y = 0; y < kSize; ++y)
                for (uint32_t x = 0; x < kSize; ++x)
                    ASSERT_EQ(surface.red(x, y, s), x + y + p.x() + p.y() < 31 ? 1 : 0)
                        << x << "," << y << " sample " << s << " of " << samples;
        }
    }
}

TEST_F(Multisample, OneRunPerPixel) {
    const Result result = draw(VK_FORMAT_R8G8B8A8_UNORM, 4, kWhole);
    EXPECT_EQ(result.statistics.fragmentInvocations, kSize * kSize);
    EXPECT_EQ(result.statistics.samplesPassed, kSize * kSize * 4);
}

TEST_F(Multisample, PerSampleRuns) {
    const Result result = draw(VK_FORMAT_R32G32B32A32_SFLOAT, 4, kWhole, {}, "sampleid_frag");
    EXPECT_EQ(result.statistics.fragmentInvocations, kSize * kSize * 4);
    for (uint32_t s = 0; s < 4; ++s) {
        const VkClearColorValue c = result.color->color(7, 9, s);
        EXPECT_EQ(c.float32[0], static_cast<float>(s));
        EXPECT_EQ(c.float32[1], 7 + kSamplePositions4[s].x());
        EXPECT_EQ(c.float32[2], 9 + kSamplePositions4[s].y());
    }
}

// What all samples of a pixel share is computed once: the image has the same bits.
TEST_F(Multisample, PartsThatRunPerPixelChangeNoBit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-8, kSize + 8);
    std::uniform_real_distribution<float> shade(0, 1);
    std::vector<Vertex> v;
    for (int k = 0; k < 120; ++k)
        v.push_back(at(place(random), place(random), kSize, kSize, {shade(random), shade(random), shade(random), 1}));
    for (const std::string fragment : {"splitsample_frag", "splitquad_frag"}) {
        for (const uint32_t samples : {2u, 4u, 8u, 16u}) {
            for (const bool blending : {false, true}) {
                const auto change = [&](GraphicsState& state) {
                    if (blending) setAdditive(state);
                };
                skips_.set(Skip::sharedSamples, false);
                const Result whole = draw(VK_FORMAT_R32G32B32A32_SFLOAT, samples, v, change, fragment);
                skips_ = {};
                const Result parts = draw(VK_FORMAT_R32G32B32A32_SFLOAT, samples, v, change, fragment);
                EXPECT_EQ(parts.statistics.fragmentInvocations, whole.statistics.fragmentInvocations);
                EXPECT_EQ(parts.statistics.samplesPassed, whole.statistics.samplesPassed);
                for (uint32_t y = 0; y < kSize; ++y)
                    for (uint32_t x = 0; x < kSize; ++x)
                        for (uint32_t s = 0; s < samples; ++s) {
                            const VkClearColorValue a = whole.color->color(x, y, s), b = parts.color->color(x, y, s);
                            for (int c = 0; c < 4; ++c)
                                ASSERT_EQ(a.uint32[c], b.uint32[c])
                                    << fragment << " " << x << " " << y << " sample " << s << " of " << samples;
                        }
            }
        }
    }
    PipelineOptions options;
    options.vertex = "color_vert";
    options.fragment = "splitquad_frag";
    options.state = plainState(VK_FORMAT_R32G32B32A32_SFLOAT);
    options.state.samples = 4;
    EXPECT_TRUE(makePipeline(options)->plan().splitSamples);
    // What the pipeline wants at samples is at samples as a whole.
    options.state.sampleShading = true;
    options.state.minSampleShading = 1;
    EXPECT_FALSE(makePipeline(options)->plan().splitSamples);
    options.state.samples = 1;
    EXPECT_FALSE(makePipeline(options)->plan().perSample);
}

TEST_F(Multisample, ResolveAverages) {
    std::vector<Vertex> half{at(0, 0, kSize, kSize),    at(20.5, 0, kSize, kSize),     at(0, kSize, kSize, kSize),
                             at(20.5, 0, kSize, kSize), at(20.5, kSize, kSize, kSize), at(0, kSize, kSize, kSize)};
    const Result result = draw(VK_FORMAT_R8G8B8A8_UNORM, 4, half);
    // Samples at x = 2/16 and 6/16 are left of the edge.
    EXPECT_EQ(result.resolved->red(20, 5), 128.0f / 255);
    EXPECT_EQ(result.resolved->red(19, 5), 1);
    EXPECT_EQ(result.resolved->red(21, 5), 0);
}

TEST_F(Multisample, ResolveOfTheLargestFloatIsFinite) {
    const float big = 3.4e38f;
    const std::vector<Vertex> v{at(-5, -5, kSize, kSize, {big, 0, 0, 0}), at(200, -5, kSize, kSize, {big, 0, 0, 0}),
                                at(-5, 200, kSize, kSize, {big, 0, 0, 0})};
    EXPECT_EQ(draw(VK_FORMAT_R32G32B32A32_SFLOAT, 4, v, {}, "color_frag").resolved->red(3, 3), big);
}

TEST_F(Multisample, Masks) {
    const auto coverage = [&](uint32_t pipelineMask, float shaderMask, const std::string& fragment) {
        std::vector<Vertex> v = kWhole;
        for (Vertex& vertex : v) vertex.color[0] = shaderMask;
        const Result result = draw(
            VK_FORMAT_R8G8B8A8_UNORM, 4, v, [&](GraphicsState& s) { s.sampleMask = pipelineMask; }, fragment);
        uint32_t mask = 0;
        for (uint32_t s = 0; s < 4; ++s) mask |= (result.color->red(11, 11, s) > 0 ? 1u : 0u) << s;
        return mask;
    };
    for (uint32_t mask = 0; mask < 16; ++mask) EXPECT_EQ(coverage(mask, 0, "one_frag"), mask);
    for (uint32_t mask = 0; mask < 16; ++mask)
        EXPECT_EQ(coverage(0xB, static_cast<float>(mask), "samplemask_frag"), mask & 0xB);
}

TEST_F(Multisample, AlphaToCoverage) {
    uint32_t previous = 0;
    for (const float alpha : {0.0f, 0.1f, 0.25f, 0.4f, 0.5f, 0.75f, 0.9f, 1.0f}) {
        std::vector<Vertex> v = kWhole;
        for (Vertex& vertex : v) vertex.color = {1, 1, 1, alpha};
        const Result result = draw(
            VK_FORMAT_R8G8B8A8_UNORM, 4, v, [](GraphicsState& s) { s.alphaToCoverage = true; }, "color_frag");
        uint32_t count = 0;
        for (uint32_t s = 0; s < 4; ++s) count += result.color->red(11, 11, s) > 0;
        EXPECT_GE(count, previous);
        EXPECT_NEAR(static_cast<float>(count) / 4, alpha, 0.13f);
        previous = count;
    }
    EXPECT_EQ(previous, 4u);
}

TEST_F(Multisample, CentroidStaysInside) {
    // A sliver of a shape: values at covered samples lie between those of the vertices.
    std::vector<Vertex> v{at(3, 3, kSize, kSize, {0, 0, 0, 0}), at(37, 4, kSize, kSize, {1, 1, 1, 1}),
                          at(5, 36, kSize, kSize, {1, 1, 1, 1})};
    const Result result = draw(VK_FORMAT_R32_SFLOAT, 4, v, {}, "centroid_frag", "centroid_vert");
    int seen = 0;
    for (uint32_t s = 0; s < 4; ++s) {
        for (uint32_t y = 0; y < kSize; ++y) {
            for (uint32_t x = 0; x < kSize; ++x) {
                const float value = result.color->red(x, y, s);
                ASSERT_GE(value, 0);
                ASSERT_LE(value, 1.000001f);
                seen += value != 0;
            }
        }
    }
    EXPECT_GT(seen, 500);
}

TEST_F(Multisample, DepthPerSample) {
    // Two planes that cross inside pixels: per sample, the nearer one wins.
    PipelineOptions options;
    options.state = plainState(VK_FORMAT_R32_SFLOAT, VK_FORMAT_D32_SFLOAT);
    options.state.samples = 4;
    options.state.depthTest = options.state.depthWrite = true;
    options.state.depthCompare = VK_COMPARE_OP_LESS;
    const auto pipeline = makePipeline(options);
    Surface color(VK_FORMAT_R32_SFLOAT, kSize, kSize, 4), depth(VK_FORMAT_D32_SFLOAT, kSize, kSize, 4);
    VkClearValue clear{};
    clear.depthStencil.depth = 1;
    Pass pass(pool_, {color.cleared({})}, depth.cleared(clear), kSize, kSize, 4);
    pass.begin();
    const auto plane = [&](float value, float left, float right) {
        const Color c{value, value, value, value};
        pass.draw(pipeline, dynamicFor(kSize, kSize),
                  {at(0, 0, kSize, kSize, c, left), at(kSize, 0, kSize, kSize, c, right),
                   at(0, kSize, kSize, kSize, c, left), at(kSize, 0, kSize, kSize, c, right),
                   at(kSize, kSize, kSize, kSize, c, right), at(0, kSize, kSize, kSize, c, left)});
    };
    plane(1, 0.1f, 0.9f);
    plane(2, 0.9f, 0.1f);
    pass.end();
    for (uint32_t s = 0; s < 4; ++s)
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) {
                const float position = static_cast<float>(x) + kSamplePositions4[s].x();
                if (std::fabs(position - 20) > 0.01f) {
                    ASSERT_EQ(color.red(x, y, s), position < 20 ? 1 : 2) << x << "," << y << "," << s;
                }
            }
}

}  // namespace
}  // namespace vernier::raster_test
