// What lines and points cover, by mode, against the rules of the specification evaluated directly.
#include <cmath>
#include <random>
#include <set>

#include "runtime/geometry/chunk.h"
#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

constexpr uint32_t kSize = 96;  // more than one tile
constexpr VkFormat kWide = VK_FORMAT_R32G32B32A32_SFLOAT;
using Pixels = std::set<std::pair<int32_t, int32_t>>;

struct Place {
    double x, y;
};

class Lines : public testing::Test {
  protected:
    struct Options {
        VkLineRasterizationModeEXT mode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
        float width = 1;
        bool stippled = false;
        uint32_t factor = 1;
        uint16_t pattern = 0xFFFF;
        VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        uint32_t samples = 1;
        std::string fragment = "color_frag", vertex = "color_vert";
        std::function<void(GraphicsState&, DynamicState&)> change;
    };
    /// Draws on zeros, adding up.
    std::unique_ptr<Surface> draw(const Options& o, const std::vector<Vertex>& vertices) {
        PipelineOptions options;
        options.vertex = o.vertex;
        options.fragment = o.fragment;
        options.state = plainState(kWide);
        setAdditive(options.state);
        options.state.topology = o.topology;
        options.state.samples = o.samples;
        options.state.lineMode = o.mode;
        options.state.stippledLine = o.stippled;
        DynamicState dynamic = dynamicFor(kSize, kSize);
        dynamic.lineWidth = o.width;
        dynamic.lineStippleFactor = o.factor;
        dynamic.lineStipplePattern = o.pattern;
        if (o.change) o.change(options.state, dynamic);
        auto surface = std::make_unique<Surface>(kWide, kSize, kSize, o.samples);
        Pass pass(pool_, {surface->cleared({})}, {}, kSize, kSize, o.samples);
        pass.begin();
        pass.draw(makePipeline(options), dynamic, vertices);
        pass.end();
        return surface;
    }
    static Vertex vertexAt(Place p, std::array<float, 4> color = {1, 1, 1, 1}) {
        return at(p.x, p.y, kSize, kSize, color);
    }
    static Pixels covered(Surface& surface) {
        Pixels result;
        for (int32_t y = 0; y < static_cast<int32_t>(kSize); ++y)
            for (int32_t x = 0; x < static_cast<int32_t>(kSize); ++x)
                if (surface.red(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) != 0) result.insert({x, y});
        return result;
    }
    Place randomPlace(uint32_t grid) {
        const auto one = [&] { return static_cast<double>(random_() % (kSize * grid)) / grid; };
        return {one(), one()};
    }
    ThreadPool pool_{3};
    std::mt19937 random_{2024};
};

/// The diamond-exit rule, with the ends moved by (e, e^2) as the specification says.
Pixels diamondExit(Place a, Place b) {
    constexpr long double e = 0x1p-20L;
    const long double ax = a.x - e, ay = a.y - e * e, bx = b.x - e, by = b.y - e * e;
    Pixels result;
    for (int32_t y = 0; y < static_cast<int32_t>(kSize); ++y) {
        for (int32_t x = 0; x < static_cast<int32_t>(kSize); ++x) {
            const long double fx = x + 0.5L, fy = y + 0.5L;
            if (fx < std::min(ax, bx) - 1 || fx > std::max(ax, bx) + 1) continue;
            if (fy < std::min(ay, by) - 1 || fy > std::max(ay, by) + 1) continue;
            // The distance is convex along the segment and linear between these places.
            long double least = 10;
            const auto look = [&](long double t) {
                if (!(t >= 0 && t <= 1)) return;
                least = std::min(least, std::fabs(ax + t * (bx - ax) - fx) + std::fabs(ay + t * (by - ay) - fy));
            };
            look(0);
            look(1);
            if (bx != ax) look((fx - ax) / (bx - ax));
            if (by != ay) look((fy - ay) / (by - ay));
            const bool endsInside = std::fabs(bx - fx) + std::fabs(by - fy) < 0.5L;
            if (least < 0.5L && !endsInside) result.insert({x, y});
        }
    }
    return result;
}

TEST_F(Lines, BresenhamIsDiamondExit) {
    Options options;
    options.mode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    for (int n = 0; n < 300; ++n) {
        // Ends on centres, corners, sixteenths and anywhere; short ones, and slopes of one.
        const uint32_t grid = n % 4 == 0 ? 2 : n % 4 == 1 ? 1 : 16;
        const Place a = randomPlace(grid);
        Place b = randomPlace(grid);
        if (n % 3 == 1)
            b = {a.x + static_cast<double>(random_() % 64) / 16 - 2,
                 a.y + static_cast<double>(random_() % 64) / 16 - 2};
        if (n % 7 == 0) b.y = a.y + (random_() % 2 == 0 ? b.x - a.x : a.x - b.x);
        if (n % 11 == 0) b.y = a.y;
        if (n % 13 == 0) b.x = a.x;
        if (b.x < 0 || b.y < 0 || b.x > kSize || b.y > kSize) continue;
        auto surface = draw(options, {vertexAt(a), vertexAt(b)});
        ASSERT_EQ(covered(*surface), diamondExit(a, b)) << a.x << "," << a.y << " to " << b.x << "," << b.y;
    }
}

TEST_F(Lines, BresenhamCoversAllSamplesAndIsHalfOpen) {
    Options options;
    options.mode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
    options.samples = 4;
    auto surface =
        draw(options, {vertexAt({2.5, 3.5}), vertexAt({20.5, 8.5}), vertexAt({60.5, 8.5}), vertexAt({90.5, 30.5})});
    for (uint32_t s = 0; s < 4; ++s) {
        float sum = 0;
        for (uint32_t x = 0; x < kSize; ++x) {
            float column = 0;
            for (uint32_t y = 0; y < kSize; ++y) column += surface->red(x, y, s);
            ASSERT_EQ(column, x >= 2 && x < 90 ? 1 : 0) << x;
            sum += column;
        }
        EXPECT_EQ(sum, 88);
    }
}

TEST_F(Lines, WideBresenhamRepeatsAcross) {
    Options options;
    options.mode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    for (const float width : {2.0f, 3.0f, 6.6f}) {
        const int32_t pixels = static_cast<int32_t>(std::nearbyint(width));
        const double shift = (pixels - 1) / 2.0;
        const Place a{10.25, 20.75}, b{80.5, 41.125};
        Pixels expected;
        for (const auto& [x, y] : diamondExit({a.x, a.y - shift}, {b.x, b.y - shift}))
            for (int32_t n = 0; n < pixels; ++n) expected.insert({x, y + n});
        options.width = width;
        EXPECT_EQ(covered(*draw(options, {vertexAt(a), vertexAt(b)})), expected) << width;
        Pixels turned;
        for (const auto& [x, y] : diamondExit({a.y - shift, a.x}, {b.y - shift, b.x}))
            for (int32_t n = 0; n < pixels; ++n) turned.insert({x + n, y});
        EXPECT_EQ(covered(*draw(options, {vertexAt({a.y, a.x}), vertexAt({b.y, b.x})})), turned) << width;
    }
}

TEST_F(Lines, RectanglesAreExact) {
    Options options;
    for (int n = 0; n < 60; ++n) {
        options.width = 1 + static_cast<float>(random_() % 64) / 8;
        options.samples = n % 3 == 0 ? 4 : 1;
        const Place a = randomPlace(16), b = randomPlace(16);
        const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
        if (length == 0) continue;
        auto surface = draw(options, {vertexAt(a), vertexAt(b)});
        for (uint32_t s = 0; s < options.samples; ++s) {
            const SamplePosition place = samplePositions(options.samples)[s];
            for (uint32_t y = 0; y < kSize; ++y) {
                for (uint32_t x = 0; x < kSize; ++x) {
                    const double px = x + double{place.x()} - a.x, py = y + double{place.y()} - a.y;
                    const double along = (px * dx + py * dy) / length, across = std::abs(px * dy - py * dx) / length;
                    const double inside = std::min({along, length - along, 0.5 * double{options.width} - across});
                    if (std::abs(inside) < 1e-9) continue;
                    ASSERT_EQ(surface->red(x, y, s), inside > 0 ? 1 : 0) << x << "," << y << " width " << options.width;
                }
            }
        }
    }
}

TEST_F(Lines, CollinearRectanglesMeetExactly) {
    Options options;
    options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
    options.width = 5;
    for (const Place step : {Place{3, 0}, Place{0, 3}, Place{2, 2}, Place{3, -1}, Place{-1, -2}, Place{-4, 0}}) {
        std::vector<Vertex> v;
        for (int n = 0; n < 12; ++n) v.push_back(vertexAt({48.5 + step.x * (n - 6), 48.5 + step.y * (n - 6)}));
        auto whole = draw(options, {v.front(), v.back()});
        auto parts = draw(options, v);
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) ASSERT_EQ(whole->red(x, y), parts->red(x, y)) << x << "," << y;
    }
}

TEST_F(Lines, SmoothLinesHaveTheirAreaAsAlpha) {
    Options options;
    options.mode = VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
    for (int n = 0; n < 20; ++n) {
        options.width = 1 + static_cast<float>(random_() % 32) / 8;
        const auto middle = [&] { return 12 + static_cast<double>(random_() % (70 * 16)) / 16; };
        const Place a{middle(), middle()}, b{middle(), middle()};
        auto surface = draw(options, {vertexAt(a), vertexAt(b)});
        double sum = 0;
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) sum += double{surface->color(x, y).float32[3]};
        EXPECT_NEAR(sum, std::hypot(b.x - a.x, b.y - a.y) * double{options.width}, 2e-3);
    }
}

TEST_F(Lines, StippleFollowsThePattern) {
    Options options;
    options.stippled = true;
    options.factor = 2;
    options.pattern = 0b0001'0110'0010'0101;
    for (const auto mode : {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT,
                            VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT}) {
        options.mode = mode;
        auto surface = draw(options, {vertexAt({3.25, 10.5}), vertexAt({90.25, 10.5}), vertexAt({90.25, 20.5}),
                                      vertexAt({3.25, 20.5})});
        // Backwards, the first pixel is the one whose diamond the segment starts in, not the first whose centre it
        // passes.
        const int last = mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ? 90 : 89;
        for (int x = 4; x < 90; ++x) {
            const auto drawn = [&](int counter) { return options.pattern >> (counter / 2 % 16) & 1; };
            EXPECT_EQ(surface->red(static_cast<uint32_t>(x), 10), drawn(x - 3)) << mode << " " << x;
            EXPECT_EQ(surface->red(static_cast<uint32_t>(x), 20), drawn(last - x)) << mode << " " << x;
        }
    }
}

TEST_F(Lines, StippleGoesOnThroughStripsAndChunks) {
    Options options;
    options.stippled = true;
    options.factor = 3;
    options.pattern = 0xA5F1;
    for (const auto mode : {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT}) {
        options.mode = mode;
        // A snake of some 4000 segments one pixel long: the counter is the number of pixels so far.
        options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
        std::vector<Place> places;
        for (int row = 0; row < 46; ++row)
            for (int n = 0; n <= 90; ++n) places.push_back({(row % 2 == 0 ? n : 90 - n) + 2.5, row * 2 + 1.5});
        std::vector<Vertex> v;
        for (const Place& place : places) v.push_back(vertexAt(place));
        ASSERT_GT(v.size(), 3 * kChunkPrimitives);
        auto surface = draw(options, v);
        double counter = 0;
        for (size_t n = 0; n + 1 < places.size(); ++n) {
            const Place &a = places[n], &b = places[n + 1];
            if (a.y == b.y) {
                // The pixel whose centre lies at the end of the segment that belongs to it.
                const double x = mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT ? a.x : std::min(a.x, b.x);
                const double at = mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT || a.x < b.x ? counter : counter + 1;
                const bool drawn = (options.pattern >> (static_cast<uint32_t>(at) / 3 % 16) & 1) != 0;
                ASSERT_EQ(surface->red(static_cast<uint32_t>(x), static_cast<uint32_t>(a.y)) != 0, drawn)
                    << mode << " segment " << n;
            }
            counter += std::abs(b.x - a.x) + std::abs(b.y - a.y);
        }
        // Lists start anew with every segment.
        options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
        auto list =
            draw(options, {vertexAt({2.5, 1.5}), vertexAt({9.5, 1.5}), vertexAt({2.5, 5.5}), vertexAt({9.5, 5.5})});
        for (uint32_t x = 2; x < 9; ++x) EXPECT_EQ(list->red(x, 1), list->red(x, 5));
    }
}

TEST_F(Lines, AttributesFollowTheSegment) {
    Options options;
    options.width = 7;
    for (const auto mode : {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT}) {
        options.mode = mode;
        const Place a{10.25, 12.5}, b{80.75, 44.125};
        auto surface = draw(options, {vertexAt(a, {1, 0, 0, 1}), vertexAt(b, {2, 1, 0, 1})});
        const double dx = b.x - a.x, dy = b.y - a.y;
        int count = 0;
        for (uint32_t y = 0; y < kSize; ++y) {
            for (uint32_t x = 0; x < kSize; ++x) {
                const VkClearColorValue c = surface->color(x, y);
                if (c.float32[0] == 0) continue;
                ++count;
                const double t = ((x + 0.5 - a.x) * dx + (y + 0.5 - a.y) * dy) / (dx * dx + dy * dy);
                ASSERT_NEAR(c.float32[1], t, 1e-5);
                ASSERT_NEAR(c.float32[0], 1 + t, 1e-5);
            }
        }
        EXPECT_GT(count, 400);
    }
}

TEST_F(Lines, AreCutAtTheViewport) {
    for (const auto mode : {VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT, VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT}) {
        Options options;
        options.mode = mode;
        options.change = [](GraphicsState&, DynamicState& dynamic) { dynamic.viewports[0] = {20, 20, 40, 40, 0, 1}; };
        // In the viewport's own clip space.
        const auto clip = [](double x, double y) {
            return Vertex{{static_cast<float>(x), static_cast<float>(y), 0.5f, 1}};
        };
        auto surface = draw(options, {clip(-3, -3.01), clip(3, 2.99), clip(0.5, -9), clip(0.5, 9)});
        const Pixels pixels = covered(*surface);
        EXPECT_GT(pixels.size(), 70u);
        for (const auto& [x, y] : pixels) {
            EXPECT_TRUE(x >= 20 && x < 60 && y >= 20 && y < 60) << x << "," << y;
        }
    }
}

TEST_F(Lines, PolygonModeHidesEdgesOfTheNearPlane) {
    Options options;
    options.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    options.mode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    options.change = [](GraphicsState& state, DynamicState&) { state.polygonMode = VK_POLYGON_MODE_LINE; };
    // The upper corner is in front of the near plane: halfway down, the edge along the plane is none of the triangle's.
    auto surface = draw(options, {at(48.5, 8.5, kSize, kSize, {1, 1, 1, 1}, -0.5f), at(80.5, 72.5, kSize, kSize),
                                  at(16.5, 72.5, kSize, kSize)});
    for (uint32_t y = 0; y < kSize; ++y) {
        int count = 0;
        for (uint32_t x = 0; x < kSize; ++x) count += surface->red(x, y) != 0;
        const bool within = y < 39 ? count == 0 : y <= 41 ? count <= 2 : y >= 72 || count == 2;
        EXPECT_TRUE(within) << y << ": " << count;
    }
}

TEST_F(Lines, PointsAreExactSquares) {
    for (const uint32_t samples : {1u, 8u}) {
        Options options;
        options.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
        options.vertex = "point_vert";
        options.samples = samples;
        for (const auto& [x, y, size] : {std::tuple{30.5, 30.5, 1.0},
                                         {31.0, 29.0, 1.0},
                                         {40.3, 50.7, 13.4},
                                         {64, 64, 50},
                                         {8, 90, 20},
                                         {48, 48, 200}}) {
            auto surface = draw(options, {vertexAt({x, y}, {1, 1, 1, static_cast<float>(size)})});
            for (uint32_t s = 0; s < samples; ++s) {
                const SamplePosition place = samplePositions(samples)[s];
                for (uint32_t py = 0; py < kSize; ++py) {
                    for (uint32_t px = 0; px < kSize; ++px) {
                        const double dx = px + double{place.x()} - x, dy = py + double{place.y()} - y;
                        const double edge = std::min(size / 2 - std::abs(dx), size / 2 - std::abs(dy));
                        if (std::abs(edge) < 1.0 / 512) continue;
                        ASSERT_EQ(surface->red(px, py, s) != 0, edge > 0) << px << "," << py << " size " << size;
                    }
                }
            }
        }
    }
}

TEST_F(Lines, AdjacentVerticesAreReadPast) {
    Options options;
    std::vector<Vertex> v;
    for (int n = 0; n < 12; ++n) v.push_back(vertexAt(randomPlace(16), {1, static_cast<float>(n), 0, 1}));
    const auto check = [&](VkPrimitiveTopology adjacency, VkPrimitiveTopology list, const std::vector<int>& order) {
        std::vector<Vertex> plain;
        for (const int n : order) plain.push_back(v[static_cast<size_t>(n)]);
        options.topology = adjacency;
        const uint64_t a = draw(options, v)->hash();
        options.topology = list;
        EXPECT_EQ(a, draw(options, plain)->hash()) << adjacency;
    };
    check(VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, VK_PRIMITIVE_TOPOLOGY_LINE_LIST, {1, 2, 5, 6, 9, 10});
    check(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP,
          {1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
    check(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, {0, 2, 4, 6, 8, 10});
    check(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP,
          {0, 2, 4, 6, 8, 10});
}

}  // namespace
}  // namespace vernier::raster_test
