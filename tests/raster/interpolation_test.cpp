// Values between the vertices.
#include <bit>
#include <cmath>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;

class Interpolate : public testing::Test {
  protected:
    std::unique_ptr<Surface> draw(uint32_t width, uint32_t height, const std::vector<Vertex>& vertices,
                                  const std::string& vertexShader = "varyings_vert",
                                  const std::string& fragmentShader = "varyings_frag",
                                  InterpolationArithmetic arithmetic = InterpolationArithmetic::singleFloat,
                                  const std::function<void(GraphicsState&)>& change = {}) {
        PipelineOptions options;
        options.vertex = vertexShader;
        options.fragment = fragmentShader;
        options.state = plainState(kWide);
        options.accuracy.interpolation = arithmetic;
        if (change) change(options.state);
        auto surface = std::make_unique<Surface>(options.state.colorFormats[0], width, height);
        VkClearValue clear{};
        clear.color.float32[0] = std::numeric_limits<float>::quiet_NaN();  // not covered
        Pass pass(pool_, {surface->cleared(clear)}, {}, width, height);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(width, height), vertices);
        EXPECT_TRUE(pass.pass().end());
        statistics_ = pass.pass().statistics();
        return surface;
    }
    ThreadPool pool_{1};
    PassStatistics statistics_;
};

Vertex perspective(double x, double y, float w, uint32_t size, std::array<float, 4> color) {
    Vertex v = at(x, y, size, size, color, 0);
    for (float& c : v.position) c *= w;
    v.position[3] = w;
    v.position[2] = 0.25f * w;
    return v;
}

TEST_F(Interpolate, ConstantsStayConstant) {
    std::mt19937 random(8);
    for (int n = 0; n < 100; ++n) {
        const float value = std::bit_cast<float>(0x3F000000u + static_cast<uint32_t>(random() % 0x1000000));
        std::vector<Vertex> vertices;
        for (int k = 0; k < 3; ++k)
            vertices.push_back(perspective(
                static_cast<double>(random() % 6400) / 50 - 30, static_cast<double>(random() % 6400) / 50 - 30,
                std::ldexp(1.0f + static_cast<float>(random() % 100) / 100, static_cast<int>(random() % 12)), 64,
                {value, value, value, value}));
        const auto surface = draw(64, 64, vertices);
        for (uint32_t y = 0; y < 64; ++y) {
            for (uint32_t x = 0; x < 64; ++x) {
                const VkClearColorValue color = surface->color(x, y);
                if (std::isnan(color.float32[0])) continue;
                for (const float c : color.float32) ASSERT_EQ(c, value);
            }
        }
    }
}

TEST_F(Interpolate, ClippedConstantsStayConstant) {
    const float value = 0.7f;
    const auto v = [&](float x, float y, float w) { return Vertex{{x, y, 0.5f * w, w}, {value, value, value, value}}; };
    const auto surface = draw(64, 64, {v(-3, -1, -0.5f), v(9, -2, 3), v(-2, 8, 2)});
    EXPECT_GT(statistics_.clippedPrimitives, 0u);
    int seen = 0;
    for (uint32_t y = 0; y < 64; ++y) {
        for (uint32_t x = 0; x < 64; ++x) {
            const VkClearColorValue color = surface->color(x, y);
            if (std::isnan(color.float32[0])) continue;
            ++seen;
            for (const float c : color.float32) ASSERT_EQ(c, value);
        }
    }
    EXPECT_GT(seen, 100);
}

TEST_F(Interpolate, ErrorDoesNotGrowWithTheDistanceFromTheOrigin) {
    std::mt19937 random(9);
    double worst = 0;
    for (const uint32_t origin : {0u, 4000u, 8000u, 16000u}) {
        PipelineOptions options;
        options.vertex = "varyings_vert";
        options.fragment = "varyings_frag";
        options.state = plainState(kWide);
        const auto pipeline = makePipeline(options);
        Surface surface(kWide, 16384, 8);
        for (int n = 0; n < 200; ++n) {
            // About a pixel large, on the sub-pixel grid, so that the exact answer is known.
            double x[3], y[3], value[3];
            std::vector<Vertex> vertices;
            for (int k = 0; k < 3; ++k) {
                x[k] = origin + static_cast<double>(random() % 512) / 256;
                y[k] = static_cast<double>(random() % 512) / 256;
                value[k] = static_cast<double>(random() % 1025) / 1024;
                vertices.push_back(
                    at(x[k], y[k], 16384, 8, {static_cast<float>(value[k]), static_cast<float>(value[k]), 0, 0}));
            }
            const double area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
            if (std::fabs(area) < 0.05) continue;
            VkClearValue clear{};
            clear.color.float32[0] = std::numeric_limits<float>::quiet_NaN();
            Pass pass(pool_, {surface.cleared(clear)}, {}, 16384, 8);
            pass.targets().renderArea = {{static_cast<int32_t>(origin), 0}, {3, 3}};
            pass.begin();
            pass.draw(pipeline, dynamicFor(16384, 8), vertices);
            pass.end();
            for (uint32_t py = 0; py < 3; ++py) {
                for (uint32_t px = origin; px < origin + 3; ++px) {
                    const float got = surface.red(px, py);
                    if (std::isnan(got)) continue;
                    const double cx = px + 0.5, cy = py + 0.5;
                    const double l1 = ((cx - x[0]) * (y[2] - y[0]) - (cy - y[0]) * (x[2] - x[0])) / area;
                    const double l2 = ((x[1] - x[0]) * (cy - y[0]) - (y[1] - y[0]) * (cx - x[0])) / area;
                    worst = std::max(
                        worst, std::fabs(got - (value[0] + l1 * (value[1] - value[0]) + l2 * (value[2] - value[0]))));
                }
            }
        }
    }
    EXPECT_LT(worst, 2e-6);
    EXPECT_GT(worst, 0);
}

TEST_F(Interpolate, RotationAndWindingChangeNothing) {
    std::mt19937 random(10);
    for (int n = 0; n < 20; ++n) {
        std::vector<Vertex> v;
        for (int k = 0; k < 3; ++k)
            v.push_back(
                perspective(static_cast<double>(random() % 6400) / 100, static_cast<double>(random() % 6400) / 100,
                            1 + static_cast<float>(random() % 1000) / 50, 64,
                            {static_cast<float>(random() % 1000) / 7, static_cast<float>(random() % 1000) / 7, 0, 0}));
        const uint64_t expected = draw(64, 64, v)->hash();
        for (const auto& order : {std::array{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}) {
            std::vector<Vertex> turned;
            for (const int k : order) turned.push_back(v[static_cast<size_t>(k)]);
            EXPECT_EQ(draw(64, 64, turned)->hash(), expected);
        }
    }
}

/// Perspective and linear interpolation against the formulas in double, vertices on the sub-pixel grid.
void expectAccuracy(Surface& surface, const std::vector<Vertex>& v, double tolerance) {
    double x[3], y[3], w[3];
    for (size_t k = 0; k < 3; ++k) {
        w[k] = v[k].position[3];
        x[k] = std::nearbyint((v[k].position[0] / w[k] + 1) * 32 * 256) / 256;
        y[k] = std::nearbyint((v[k].position[1] / w[k] + 1) * 32 * 256) / 256;
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    int seen = 0;
    for (uint32_t py = 0; py < 64; ++py) {
        for (uint32_t px = 0; px < 64; ++px) {
            const VkClearColorValue got = surface.color(px, py);
            if (std::isnan(got.float32[0])) continue;
            ++seen;
            const double cx = px + 0.5, cy = py + 0.5;
            const double l1 = ((cx - x[0]) * (y[2] - y[0]) - (cy - y[0]) * (x[2] - x[0])) / area;
            const double l2 = ((x[1] - x[0]) * (cy - y[0]) - (y[1] - y[0]) * (cx - x[0])) / area;
            const double l0 = 1 - l1 - l2;
            const double s = l0 / w[0] + l1 / w[1] + l2 / w[2];
            const double smooth =
                (l0 / w[0] * v[0].color[0] + l1 / w[1] * v[1].color[0] + l2 / w[2] * v[2].color[0]) / s;
            const double linear = l0 * v[0].color[1] + l1 * v[1].color[1] + l2 * v[2].color[1];
            ASSERT_NEAR(got.float32[0], smooth, tolerance);
            ASSERT_NEAR(got.float32[1], linear, tolerance);
            ASSERT_EQ(got.float32[2], v[0].color[2]);
        }
    }
    EXPECT_GT(seen, 200);
}

TEST_F(Interpolate, PerspectiveAndLinearFollowTheFormulas) {
    const std::vector<Vertex> v{perspective(2, 3, 1, 64, {0.1f, 0.9f, 5, 6}),
                                perspective(60, 9, 8, 64, {0.7f, 0.2f, 7, 8}),
                                perspective(20, 62, 3, 64, {0.4f, 0.3f, 9, 1})};
    expectAccuracy(*draw(64, 64, v), v, 4e-7);
    expectAccuracy(*draw(64, 64, v, "varyings_vert", "varyings_frag", InterpolationArithmetic::doubleFloat), v, 4e-8);
    EXPECT_GT(statistics_.perspectiveDivides, 0u);
}

TEST_F(Interpolate, PerspectiveRatioOfAMillion) {
    const std::vector<Vertex> v{perspective(2, 3, 1, 64, {0, 0, 0, 0}), perspective(60, 9, 1e6f, 64, {1, 1, 0, 0}),
                                perspective(20, 62, 3e5f, 64, {0.5f, 0.5f, 0, 0})};
    expectAccuracy(*draw(64, 64, v), v, 4e-6);
}

TEST_F(Interpolate, EqualWNeedsNoDivision) {
    draw(64, 64,
         {perspective(2, 3, 4, 64, {0, 0, 0, 0}), perspective(60, 9, 4, 64, {1, 0, 0, 0}),
          perspective(20, 62, 4, 64, {0, 1, 0, 0})});
    EXPECT_EQ(statistics_.perspectiveDivides, 0u);
}

TEST_F(Interpolate, LargeOffsetSmallRange) {
    const auto surface = draw(64, 64,
                              {at(0, 0, 64, 64, {1e6f, 1e6f, 0, 0}), at(128, 0, 64, 64, {1e6f + 1, 1e6f + 1, 0, 0}),
                               at(0, 128, 64, 64, {1e6f, 1e6f, 0, 0})});
    for (uint32_t x = 0; x < 64; ++x) EXPECT_NEAR(surface->red(x, 5), 1e6 + (x + 0.5) / 128, 0.0626);
}

TEST_F(Interpolate, FlatBitsOfTheProvokingVertex) {
    for (const bool last : {false, true}) {
        for (const uint32_t bits : {0x7FC00001u, 0x7F800001u, 0x80000000u, 1u, 0xFFFFFFFFu}) {
            const float value = std::bit_cast<float>(bits);
            std::vector<Vertex> v{at(0, 0, 8, 8, {0, 0, 0, 1}), at(20, 0, 8, 8, {0, 0, 0, 2}),
                                  at(0, 20, 8, 8, {0, 0, 0, 3})};
            std::memcpy(&v[last ? 2 : 0].color[3], &bits, 4);
            (void)value;
            const auto surface = draw(8, 8, v, "varyings_vert", "flatbits_frag", InterpolationArithmetic::singleFloat,
                                      [&](GraphicsState& s) {
                                          s.colorFormats[0] = VK_FORMAT_R32G32B32A32_SINT;
                                          s.provokingVertexLast = last;
                                      });
            EXPECT_EQ(surface->color(3, 3).uint32[0], bits);
        }
    }
}

TEST_F(Interpolate, FragCoord) {
    const std::vector<Vertex> v{perspective(-10, -10, 2, 64, {}), perspective(150, -10, 2, 64, {}),
                                perspective(-10, 150, 2, 64, {})};
    const auto surface = draw(64, 64, v, "color_vert", "fragcoord_frag");
    for (uint32_t y = 0; y < 64; y += 7) {
        for (uint32_t x = 0; x < 64; x += 5) {
            const VkClearColorValue c = surface->color(x, y);
            EXPECT_EQ(c.float32[0], static_cast<float>(x) + 0.5f);
            EXPECT_EQ(c.float32[1], static_cast<float>(y) + 0.5f);
            EXPECT_EQ(c.float32[2], 0.25f);
            EXPECT_EQ(c.float32[3], 0.5f);
        }
    }
}

TEST_F(Interpolate, DerivativesOfAnAffineValue) {
    // Slope 2 in x and -3 in y, exact in float; partly covered quads included.
    const auto value = [](double x, double y) { return static_cast<float>(2 * x - 3 * y); };
    std::vector<Vertex> v;
    for (const auto& [x, y] : {std::pair{3.0, 5.0}, {61.0, 9.0}, {17.0, 60.0}})
        v.push_back(at(x, y, 64, 64, {value(x, y), 0, 0, 0}));
    const auto surface = draw(64, 64, v, "color_vert", "derivative_frag");
    int seen = 0;
    for (uint32_t y = 0; y < 64; ++y) {
        for (uint32_t x = 0; x < 64; ++x) {
            const VkClearColorValue c = surface->color(x, y);
            if (std::isnan(c.float32[0])) continue;
            ++seen;
            ASSERT_NEAR(c.float32[0], 2, 1e-4) << x << "," << y;
            ASSERT_NEAR(c.float32[1], -3, 1e-4) << x << "," << y;
            ASSERT_EQ(c.float32[2], 0) << "helpers write nothing";
        }
    }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(statistics_.helperInvocations, 0u);
}

TEST_F(Interpolate, NoHelpersWithoutDerivatives) {
    draw(64, 64, {at(3, 5, 64, 64), at(61, 9, 64, 64), at(17, 60, 64, 64)}, "color_vert", "color_frag");
    EXPECT_EQ(statistics_.helperInvocations, 0u);
}

TEST(Interpolation, DoublesOnlyWhereSomethingIsInterpolated) {
    PipelineOptions options;
    options.accuracy.interpolation = InterpolationArithmetic::doubleFloat;
    options.state = plainState(VK_FORMAT_R8G8B8A8_UNORM);
    EXPECT_TRUE(makePipeline(options)->plan().preciseInterpolation);
    options.fragment = "one_frag";
    EXPECT_FALSE(makePipeline(options)->plan().preciseInterpolation);
    options.state = plainState(VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D32_SFLOAT);
    options.state.depthTest = options.state.depthWrite = true;
    EXPECT_TRUE(makePipeline(options)->plan().preciseInterpolation) << "depth is";
}

}  // namespace
}  // namespace vernier::raster_test
