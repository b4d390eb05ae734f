// Clipping, and positions near the limits of what floats can say.
#include <cmath>
#include <limits>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 64;

class Clip : public testing::Test {
  protected:
    std::vector<float> draw(const std::vector<Vertex>& vertices, const std::string& shader = "color_vert",
                            const std::function<void(GraphicsState&)>& change = {}) {
        PipelineOptions options;
        options.vertex = shader;
        options.fragment = "one_frag";
        options.state = plainState(VK_FORMAT_R32_SFLOAT);
        setAdditive(options.state);
        if (change) change(options.state);
        Surface surface(VK_FORMAT_R32_SFLOAT, kSize, kSize);
        Pass pass(pool_, {surface.cleared({})}, {}, kSize, kSize);
        pass.begin();
        pass.draw(makePipeline(options), dynamicFor(kSize, kSize), vertices);
        EXPECT_TRUE(pass.pass().end());
        statistics_ = pass.pass().statistics();
        std::vector<float> result;
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) result.push_back(surface.red(x, y));
        return result;
    }
    static float total(const std::vector<float>& counts) {
        float sum = 0;
        for (const float c : counts) sum += c;
        return sum;
    }
    static void expectAll(const std::vector<float>& counts, float value) {
        for (size_t n = 0; n < counts.size(); ++n) ASSERT_EQ(counts[n], value) << n % kSize << "," << n / kSize;
    }

    ThreadPool pool_{2};
    PassStatistics statistics_;
};

Vertex vertex(float x, float y, float z, float w, float user = 1) {
    return {{x, y, z, w}, {user, 1, 1, 1}};
}

/// A ground plane that goes through the near plane and behind the eye, as two triangles.
std::vector<Vertex> ground(float scale) {
    const auto v = [&](float x, float depth) {
        // eye space: y = 1 below the eye, depth along the view; w = depth.
        return vertex(x * scale, 0.7f * scale, (depth - 0.1f) * scale, depth * scale);
    };
    const Vertex a = v(-9, -4), b = v(9, -4), c = v(-9, 40), d = v(9, 40);
    return {a, b, c, b, d, c};
}

TEST_F(Clip, SharedEdgeThroughTheNearPlane) {
    const auto counts = draw(ground(1));
    for (const float count : counts) ASSERT_LE(count, 1);
    EXPECT_GT(total(counts), 500);
    EXPECT_GT(statistics_.clippedPrimitives, 0u);
    // Rows below the horizon, between the ends of the plane, have no hole.
    for (uint32_t y = 40; y < kSize; ++y) {
        float previous = 0;
        int changes = 0;
        for (uint32_t x = 0; x < kSize; ++x) {
            changes += counts[y * kSize + x] != previous;
            previous = counts[y * kSize + x];
        }
        EXPECT_LE(changes, 2) << "row " << y;
    }
}

TEST_F(Clip, PowersOfTwoChangeNothing) {
    const auto expected = draw(ground(1));
    for (const int exponent : {1, -7, 60, -60, 100, -100, 120})
        EXPECT_EQ(draw(ground(std::ldexp(1.0f, exponent))), expected) << exponent;
}

TEST_F(Clip, HugeCoordinatesOfOrdinaryRatio) {
    const float big = std::numeric_limits<float>::max();
    expectAll(draw({vertex(-big, -big, 0, big), vertex(big, -big, 0, big), vertex(-big, big, 0, big),
                    vertex(big, -big, 0, big), vertex(big, big, 0, big), vertex(-big, big, 0, big)}),
              1);
}

TEST_F(Clip, DenormalPositions) {
    const float d = std::ldexp(1.0f, -140);
    expectAll(draw({vertex(-d, -d, 0, d), vertex(d, -d, 0, d), vertex(-d, d, 0, d), vertex(d, -d, 0, d),
                    vertex(d, d, 0, d), vertex(-d, d, 0, d)}),
              1);
}

TEST_F(Clip, VertexAtInfinity) {
    // w = 0: the triangle reaches to infinity; its neighbour continues on the other side of the shared edge.
    const Vertex a = vertex(-1, 0, 0.5f, 1), b = vertex(1, 0, 0.5f, 1), up = vertex(0, -1, 0, 0),
                 down = vertex(0, 1, 0, 0);
    const auto counts = draw({a, b, up, a, b, down}, "color_vert", [](GraphicsState& s) {
        s.depthClipEnable = false;
        s.depthClampEnable = true;
    });
    expectAll(counts, 1);
}

TEST_F(Clip, BehindTheEyeIsNothing) {
    EXPECT_EQ(total(draw({vertex(-1, -1, 0, -1), vertex(1, -1, 0, -1), vertex(0, 1, 0, -1)})), 0);
    EXPECT_EQ(total(draw({vertex(0, 0, 0, 0), vertex(0, 0, 0, 0), vertex(0, 0, 0, 0)})), 0);
}

TEST_F(Clip, NotANumberDropsItsPrimitiveAlone) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<Vertex> whole{vertex(-1, -1, 0, 1), vertex(3, -1, 0, 1), vertex(-1, 3, 0, 1)};
    for (const float bad : {nan, inf, -inf}) {
        for (int c = 0; c < 4; ++c) {
            std::vector<Vertex> vertices = whole;
            vertices.insert(vertices.end(), whole.begin(), whole.end());
            vertices[1].position[static_cast<size_t>(c)] = bad;
            expectAll(draw(vertices), 1);
        }
    }
}

TEST_F(Clip, UserDistanceAndItsOppositeMeet) {
    std::mt19937 random(7);
    for (int n = 0; n < 200; ++n) {
        std::vector<Vertex> both;
        std::vector<Vertex> triangle;
        for (int k = 0; k < 3; ++k) {
            const auto value = [&] { return static_cast<float>(static_cast<int>(random() % 2001) - 1000) / 900; };
            const float w = 0.5f + static_cast<float>(random() % 100) / 50;
            // Some distances exactly 0.
            triangle.push_back(vertex(value() * w, value() * w, 0, w, random() % 4 == 0 ? 0.0f : value()));
        }
        for (const Vertex& v : triangle) both.push_back(v);
        bool onPlane = true;
        for (const Vertex& v : triangle) onPlane &= v.color[0] == 0;
        if (onPlane) continue;
        for (Vertex v : triangle) {
            v.color[0] = -v.color[0];
            both.push_back(v);
        }
        const auto cut = draw(both, "clip_vert"), uncut = draw(triangle);
        // Where the cut introduces a vertex on an outer edge, snapping may move that edge by a sub-unit.
        size_t differences = 0;
        for (size_t p = 0; p < cut.size(); ++p) {
            ASSERT_LE(cut[p], 1) << n;
            differences += cut[p] != uncut[p];
        }
        EXPECT_LE(differences, 2u) << n;
    }
}

TEST_F(Clip, SixPlanesAndEightOfTheUser) {
    // A triangle far larger than everything, tilted through near and far.
    const auto counts =
        draw({vertex(-40, -40, -60, 1, 0.5f), vertex(40, -40, 57, 1, 0.5f), vertex(0, 60, 3, 1, 0.5f)}, "clip8_vert");
    EXPECT_GT(total(counts), 50);
    for (const float count : counts) ASSERT_LE(count, 1);
    const auto octagon = draw(
        {vertex(-90, -90, 0.5f, 1, 0.5f), vertex(90, -90, 0.5f, 1, 0.5f), vertex(0, 150, 0.5f, 1, 0.5f)}, "clip8_vert");
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            const double px = (x + 0.5) / 32 - 1, py = (y + 0.5) / 32 - 1;
            const double inside =
                std::min({0.5 - std::fabs(px), 0.5 - std::fabs(py), 0.75 - std::fabs(px) - std::fabs(py)});
            if (std::fabs(inside) < 0.01) continue;
            EXPECT_EQ(octagon[y * kSize + x], inside > 0 ? 1.0f : 0.0f) << x << "," << y;
        }
    }
}

TEST_F(Clip, InfiniteUserDistances) {
    const float inf = std::numeric_limits<float>::infinity();
    const auto triangle = [&](float d) {
        return std::vector<Vertex>{vertex(-1, -1, 0, 1, d), vertex(3, -1, 0, 1, d), vertex(-1, 3, 0, 1, d)};
    };
    expectAll(draw(triangle(inf), "clip_vert"), 1);
    expectAll(draw(triangle(-inf), "clip_vert"), 0);
    expectAll(draw(triangle(std::numeric_limits<float>::quiet_NaN()), "clip_vert"), 0);
}

TEST_F(Clip, CullDistance) {
    std::vector<Vertex> triangle{vertex(-1, -1, 0, 1, -1), vertex(3, -1, 0, 1, -2), vertex(-1, 3, 0, 1, -0.5f)};
    expectAll(draw(triangle, "cull_vert"), 0);
    triangle[1].color[0] = 0;
    expectAll(draw(triangle, "cull_vert"), 1);
}

TEST_F(Clip, NearAndFarPlanesAreInside) {
    for (const float z : {0.0f, 1.0f})
        expectAll(draw({vertex(-1, -1, z, 1), vertex(3, -1, z, 1), vertex(-1, 3, z, 1)}), 1);
    for (const float z : {-1e-30f, 1.0000001f})
        expectAll(draw({vertex(-1, -1, z, 1), vertex(3, -1, z, 1), vertex(-1, 3, z, 1)}), 0);
    for (const float z : {-5.0f, 5.0f})
        expectAll(draw({vertex(-1, -1, z, 1), vertex(3, -1, z, 1), vertex(-1, 3, z, 1)}, "color_vert",
                       [](GraphicsState& s) { s.depthClipEnable = false; }),
                  1);
}

TEST_F(Clip, AroundTheGuardBand) {
    // Slightly inside and outside of it: no visible difference.
    for (const double far : {24575.0, 24575.9, 24576.1, 30000.0, -8191.9, -8192.1, -9000.0}) {
        const auto p = [&](double x, double y) { return at(x, y, kSize, kSize); };
        const double near = far > 0 ? -10 : 74;
        const auto counts = draw({p(near, -10), p(far, -10), p(near, 74), p(far, -10), p(far, 74), p(near, 74)});
        expectAll(counts, 1);
    }
}

TEST_F(Clip, DegenerateViewports) {
    PipelineOptions options;
    options.state = plainState(VK_FORMAT_R32_SFLOAT);
    const auto pipeline = makePipeline(options);
    for (const VkViewport viewport : {VkViewport{0, 0, 0, 64, 0, 1}, VkViewport{0, 0, 64, 0, 0, 1}}) {
        Surface surface(VK_FORMAT_R32_SFLOAT, kSize, kSize);
        Pass pass(pool_, {surface.cleared({})}, {}, kSize, kSize);
        DynamicState dynamic = dynamicFor(kSize, kSize);
        dynamic.viewports[0] = viewport;
        pass.begin();
        pass.draw(pipeline, dynamic, {vertex(-1, -1, 0, 1), vertex(3, -1, 0, 1), vertex(-1, 3, 0, 1)});
        pass.end();
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(surface.red(x, y), 0);
    }
}

TEST_F(Clip, NegativeViewportHeightFlips) {
    PipelineOptions options;
    options.state = plainState(VK_FORMAT_R32_SFLOAT);
    options.state.cullMode = VK_CULL_MODE_BACK_BIT;
    options.state.frontFace = VK_FRONT_FACE_CLOCKWISE;
    const auto pipeline = makePipeline(options);
    Surface surface(VK_FORMAT_R32_SFLOAT, kSize, kSize);
    Pass pass(pool_, {surface.cleared({})}, {}, kSize, kSize);
    DynamicState dynamic = dynamicFor(kSize, kSize);
    dynamic.viewports[0] = {0, 64, 64, -64, 0, 1};
    pass.begin();
    // Counter-clockwise as written, clockwise after the flip: drawn in the lower left half.
    pass.draw(pipeline, dynamic, {vertex(-1, -1, 0, 1), vertex(-1, 1, 0, 1), vertex(1, -1, 0, 1)});
    pass.end();
    EXPECT_EQ(surface.red(2, 60), 1);
    EXPECT_EQ(surface.red(60, 2), 0);
}

}  // namespace
}  // namespace vernier::raster_test
