// Triangles that share edges cover every sample once; coverage does not depend on how triangles are written
// down.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/raster/harness.h"

namespace vernier::raster_test {
namespace {

/// Draws triangles (pixel coordinates) additively and counts.
class Counter {
  public:
    Counter(uint32_t width, uint32_t height, uint32_t subPixelBits = 8) : width_(width), height_(height) {
        PipelineOptions options;
        options.fragment = "one_frag";
        options.state = plainState(VK_FORMAT_R32_SFLOAT);
        options.accuracy.subPixelBits = subPixelBits;
        setAdditive(options.state);
        pipeline_ = makePipeline(options);
    }
    std::vector<float> count(const std::vector<std::array<double, 2>>& points) {
        std::vector<Vertex> vertices;
        for (const auto& p : points) vertices.push_back(at(p[0], p[1], width_, height_));
        return draw(vertices, dynamicFor(width_, height_));
    }
    std::vector<float> draw(const std::vector<Vertex>& vertices, const DynamicState& dynamic) {
        Surface surface(VK_FORMAT_R32_SFLOAT, width_, height_);
        Pass pass(pool_, {surface.cleared({})}, {}, width_, height_);
        pass.begin();
        pass.draw(pipeline_, dynamic, vertices);
        pass.end();
        std::vector<float> counts;
        for (uint32_t y = 0; y < height_; ++y)
            for (uint32_t x = 0; x < width_; ++x) counts.push_back(surface.red(x, y));
        return counts;
    }

  private:
    ThreadPool pool_{2};
    uint32_t width_, height_;
    std::shared_ptr<const GraphicsPipeline> pipeline_;
};

float sum(const std::vector<float>& counts) {
    return std::accumulate(counts.begin(), counts.end(), 0.0f);
}

TEST(Partition, QuadSplitThroughCentres) {
    // Diagonal through every centre between (1, 1) and (7, 7).
    Counter counter(8, 8);
    const auto counts = counter.count({{1, 1}, {1, 7}, {7, 1}, {7, 1}, {1, 7}, {7, 7}});
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x)
            EXPECT_EQ(counts[y * 8 + x], x >= 1 && x < 7 && y >= 1 && y < 7 ? 1.0f : 0.0f) << x << "," << y;
}

TEST(Partition, AllRotationsAndWindings) {
    Counter counter(8, 8);
    std::array<std::array<double, 2>, 3> first{{{1, 1}, {1, 7}, {7, 1}}}, second{{{7, 1}, {1, 7}, {7, 7}}};
    const auto expected = counter.count({first[0], first[1], first[2], second[0], second[1], second[2]});
    std::array<int, 3> order{0, 1, 2};
    int variants = 0;
    do {
        for (int rotation = 0; rotation < 3; ++rotation, ++variants) {
            const auto counts = counter.count({first[order[0]], first[order[1]], first[order[2]], second[rotation],
                                               second[(rotation + 1) % 3], second[(rotation + 2) % 3]});
            EXPECT_EQ(counts, expected);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(variants, 18);
}

TEST(Partition, TopAndLeftEdgesOwnTheirCentres) {
    Counter counter(8, 8);
    const auto counts = counter.count({{1.5, 1.5}, {5.5, 1.5}, {1.5, 5.5}, {5.5, 1.5}, {5.5, 5.5}, {1.5, 5.5}});
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x)
            EXPECT_EQ(counts[y * 8 + x], x >= 1 && x < 5 && y >= 1 && y < 5 ? 1.0f : 0.0f) << x << "," << y;
}

TEST(Partition, FanAroundACentre) {
    for (int n = 3; n <= 64; ++n) {
        Counter counter(32, 32);
        std::vector<std::array<double, 2>> points;
        for (int k = 0; k < n; ++k) {
            const auto rim = [&](int i) -> std::array<double, 2> {
                const double angle = 6.283185307179586 * i / n;
                return {16.5 + 14 * std::cos(angle), 16.5 + 14 * std::sin(angle)};
            };
            points.insert(points.end(), {{16.5, 16.5}, rim(k), rim((k + 1) % n)});
        }
        const auto counts = counter.count(points);
        EXPECT_EQ(counts[16 * 32 + 16], 1.0f) << n;
        EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 1.0f) << n;
    }
}

/// A triangulation of a rectangle: a jittered grid with diagonals either way. `grid`: vertices on the
/// sub-pixel grid.
std::vector<std::array<double, 2>> triangulation(std::mt19937& random, double x0, double y0, double x1, double y1,
                                                 int cells, double jitter, bool grid) {
    std::vector<std::array<double, 2>> nodes;
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            const auto offset = [&](int k) {
                if (k == 0 || k == cells) return 0.0;
                return (static_cast<double>(random() % 65536) / 32768 - 1) * jitter;
            };
            double x = x0 + (x1 - x0) * i / cells + offset(i), y = y0 + (y1 - y0) * j / cells + offset(j);
            if (grid) {
                x = std::round(x * 256) / 256;
                y = std::round(y * 256) / 256;
            }
            nodes.push_back({x, y});
        }
    }
    std::vector<std::array<std::array<double, 2>, 3>> triangles;
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const auto& a = nodes[j * (cells + 1) + i];
            const auto& b = nodes[j * (cells + 1) + i + 1];
            const auto& c = nodes[(j + 1) * (cells + 1) + i];
            const auto& d = nodes[(j + 1) * (cells + 1) + i + 1];
            if (random() % 2 == 0) {
                triangles.push_back({a, b, c});
                triangles.push_back({b, d, c});
            } else {
                triangles.push_back({a, b, d});
                triangles.push_back({a, d, c});
            }
        }
    }
    std::shuffle(triangles.begin(), triangles.end(), random);
    std::vector<std::array<double, 2>> points;
    for (const auto& triangle : triangles) {
        const int rotation = static_cast<int>(random() % 3);
        for (int k = 0; k < 3; ++k) points.push_back(triangle[(k + rotation) % 3]);
    }
    return points;
}

TEST(Partition, RandomTriangulations) {
    std::mt19937 random(3);
    for (const uint32_t bits : {4u, 8u, 12u, 16u}) {
        Counter counter(100, 75, bits);
        for (const bool grid : {true, false}) {
            for (const int cells : {2, 7, 40, 150}) {
                const auto counts = counter.count(triangulation(random, 4, 4, 96, 71, cells, 10.0 / cells, grid));
                for (uint32_t y = 0; y < 75; ++y)
                    for (uint32_t x = 0; x < 100; ++x)
                        ASSERT_EQ(counts[y * 100 + x], x >= 4 && x < 96 && y >= 4 && y < 71 ? 1.0f : 0.0f)
                            << bits << " bits, " << cells << " cells, " << x << "," << y;
            }
        }
    }
}

TEST(Partition, SliversAndTheirNeighbours) {
    Counter counter(600, 64);
    std::mt19937 random(4);
    for (int n = 0; n < 60; ++n) {
        // The band between two almost parallel lines, thinner than a sub-pixel unit, cut out of a rectangle.
        const double y0 = 5 + static_cast<double>(random() % 50), y1 = 5 + static_cast<double>(random() % 50);
        const double thin = 1.0 / 512;
        const auto counts = counter.count({{2, 1},
                                           {598, 1},
                                           {2, y0},
                                           {598, 1},
                                           {598, y1},
                                           {2, y0},  // above
                                           {2, y0},
                                           {598, y1},
                                           {2, y0 + thin},
                                           {598, y1},
                                           {598, y1 + thin},
                                           {2, y0 + thin},
                                           {2, y0 + thin},
                                           {598, y1 + thin},
                                           {2, 63},
                                           {598, y1 + thin},
                                           {598, 63},
                                           {2, 63}});
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 600; ++x)
                ASSERT_EQ(counts[y * 600 + x], x >= 2 && x < 598 && y >= 1 && y < 63 ? 1.0f : 0.0f) << x << "," << y;
    }
}

TEST(Partition, TrianglesWithoutAreaDrawNothing) {
    Counter counter(16, 16);
    EXPECT_EQ(sum(counter.count({{2, 2}, {2, 2}, {9, 9}})), 0);
    EXPECT_EQ(sum(counter.count({{2, 2}, {5, 5}, {9, 9}})), 0);
    EXPECT_EQ(sum(counter.count({{3, 3}, {3, 3}, {3, 3}})), 0);
    // Zero area only after snapping.
    EXPECT_EQ(sum(counter.count({{2, 2}, {9, 9}, {5, 5.001}})), 0);
}

TEST(Partition, HugeTrianglesCoverTheTargetOnce) {
    for (const auto& [width, height] : {std::pair{256u, 192u}, {2000u, 31u}}) {
        Counter counter(width, height);
        // Far outside: clipped against the guard band.
        const double far = 1e7;
        const auto counts =
            counter.count({{-far, -far}, {far, -far}, {-far, far}, {far, -far}, {far, far}, {-far, far}});
        EXPECT_EQ(sum(counts), static_cast<float>(width * height));
        EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 1.0f);
    }
}

TEST(Partition, ScissorOnlyCutsAway) {
    std::mt19937 random(5);
    Counter counter(80, 72);
    std::vector<Vertex> vertices;
    for (const auto& p : triangulation(random, 1, 1, 79, 71, 9, 2.5, false)) vertices.push_back(at(p[0], p[1], 80, 72));
    vertices.resize(vertices.size() - 60);  // with some holes
    const auto full = counter.draw(vertices, dynamicFor(80, 72));
    for (int step = 0; step < 70; ++step) {
        DynamicState dynamic = dynamicFor(80, 72);
        dynamic.scissors[0] = {{step, step / 2},
                               {static_cast<uint32_t>(1 + step % 23), static_cast<uint32_t>(72 - step)}};
        const auto counts = counter.draw(vertices, dynamic);
        const VkRect2D& s = dynamic.scissors[0];
        for (int y = 0; y < 72; ++y) {
            for (int x = 0; x < 80; ++x) {
                const bool inside = x >= s.offset.x && y >= s.offset.y &&
                                    x < s.offset.x + static_cast<int>(s.extent.width) &&
                                    y < s.offset.y + static_cast<int>(s.extent.height);
                ASSERT_EQ(counts[static_cast<size_t>(y * 80 + x)],
                          inside ? full[static_cast<size_t>(y * 80 + x)] : 0.0f)
                    << step << ": " << x << "," << y;
            }
        }
    }
}

TEST(Partition, OddAttachmentSizes) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 5u}, {8191u, 1u}, {1u, 300u}}) {
        Counter counter(width, height);
        const double w = width, h = height;
        EXPECT_EQ(sum(counter.count({{0, 0}, {w, 0}, {0, h}, {w, 0}, {w, h}, {0, h}})),
                  static_cast<float>(width * height));
    }
}

TEST(Partition, TranslationByWholePixelsChangesNothing) {
    std::mt19937 random(6);
    Counter counter(200, 200);
    for (int n = 0; n < 20; ++n) {
        std::array<std::array<double, 2>, 3> triangle;
        for (auto& p : triangle)
            p = {static_cast<double>(random() % 4096) / 64, static_cast<double>(random() % 4096) / 64};
        const auto moved = [&](double dx, double dy) {
            std::vector<std::array<double, 2>> points;
            for (const auto& p : triangle) points.push_back({p[0] + dx, p[1] + dy});
            return counter.count(points);
        };
        const auto a = moved(0, 0), b = moved(101, 67);
        for (uint32_t y = 0; y < 65; ++y)
            for (uint32_t x = 0; x < 65; ++x) ASSERT_EQ(a[y * 200 + x], b[(y + 67) * 200 + x + 101]);
    }
}

}  // namespace
}  // namespace vernier::raster_test
