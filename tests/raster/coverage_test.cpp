// tileEdges() and coverTile() against a direct evaluation of exact edge functions, one sample at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "runtime/plan/sample_positions.h"
#include "runtime/raster/coverage.h"

namespace vernier {
namespace {

__extension__ using Wide = __int128;

struct Point {
    int64_t x, y;
};

Wide edge(Point a, Point b, Point p) {
    return static_cast<Wide>(b.x - a.x) * (p.y - a.y) - static_cast<Wide>(b.y - a.y) * (p.x - a.x);
}

/// Exact test in any vertex order: strictly inside, or on a top or left edge of the clockwise triangle.
bool covers(Point a, Point b, Point c, Point p) {
    const Wide area = edge(a, b, c);
    if (area == 0) return false;
    if (area < 0) std::swap(b, c);
    const Point v[4] = {a, b, c, a};
    for (int e = 0; e < 3; ++e) {
        const Wide value = edge(v[e], v[e + 1], p);
        const bool topLeft = v[e + 1].y < v[e].y || (v[e + 1].y == v[e].y && v[e + 1].x > v[e].x);
        if (value < 0 || (value == 0 && !topLeft)) return false;
    }
    return true;
}

/// A clockwise primitive as setup would make it, with bounds over the whole tile.
Primitive primitiveOf(Point a, Point b, Point c, int32_t tileX, int32_t tileY) {
    if (edge(a, b, c) < 0) std::swap(b, c);
    Primitive p{};
    const Point v[3] = {a, b, c};
    int64_t extent = 0;
    for (int n = 0; n < 3; ++n) {
        p.x[n] = static_cast<int32_t>(v[n].x);
        p.y[n] = static_cast<int32_t>(v[n].y);
        extent = std::max({extent, std::abs(v[n].x - v[(n + 1) % 3].x), std::abs(v[n].y - v[(n + 1) % 3].y)});
    }
    p.bounds = {static_cast<int16_t>(tileX), static_cast<int16_t>(tileY), static_cast<int16_t>(tileX + kTileSize - 1),
                static_cast<int16_t>(tileY + kTileSize - 1)};
    p.smallEdges = extent <= int64_t{1} << kSmallEdgeBits;
    p.tiny = extent <= int64_t{1} << kTinyEdgeBits;
    return p;
}

void expectExact(Isa isa, Point a, Point b, Point c, int32_t tileX, int32_t tileY, uint32_t bits, uint32_t samples) {
    const Primitive primitive = primitiveOf(a, b, c, tileX, tileY);
    BlockCoverage blocks[kBlocksPerTile];
    const TileEdges edges = tileEdges(primitive, tileX, tileY, bits, samples, samplePositions(samples));
    const uint32_t count = coverTileFunction(isa)(edges, blocks);
    std::set<std::array<int32_t, 3>> covered;
    for (uint32_t n = 0; n < count; ++n)
        for (uint32_t s = 0; s < samples; ++s)
            for (int bit = 0; bit < 64; ++bit)
                if ((blocks[n].masks[s] >> bit & 1) != 0)
                    covered.insert({blocks[n].x + (bit & 7), blocks[n].y + (bit >> 3), static_cast<int32_t>(s)});
    for (int32_t y = 0; y < kTileSize; ++y) {
        for (int32_t x = 0; x < kTileSize; ++x) {
            for (uint32_t s = 0; s < samples; ++s) {
                const SamplePosition position = samplePositions(samples)[s];
                const Point p{(int64_t{tileX + x} << bits) + (int64_t{position.x16} << (bits - 4)),
                              (int64_t{tileY + y} << bits) + (int64_t{position.y16} << (bits - 4))};
                ASSERT_EQ(covered.count({x, y, static_cast<int32_t>(s)}) == 1, covers(a, b, c, p))
                    << isaName(isa) << " bits " << bits << " samples " << samples << " pixel " << tileX + x << ","
                    << tileY + y << " sample " << s;
            }
        }
    }
}

/// What is found of a tiny primitive is what the general routine finds.
void expectSameWhenTiny(Isa isa, const Primitive& primitive, int32_t tileX, int32_t tileY, uint32_t bits,
                        SamplePosition position) {
    BlockCoverage general[kBlocksPerTile], tiny[kBlocksPerTile];
    const TileEdges edges = tileEdges(primitive, tileX, tileY, bits, 1, &position);
    const uint32_t count = coverTileFunction(isa)(edges, general);
    ASSERT_EQ(coverTinyFunction(isa)({&primitive, tileX, tileY, bits, position}, tiny), count);
    for (uint32_t n = 0; n < count; ++n) {
        EXPECT_EQ(tiny[n].x, general[n].x);
        EXPECT_EQ(tiny[n].y, general[n].y);
        EXPECT_EQ(tiny[n].masks[0], general[n].masks[0]);
    }
}

class CoverageTest : public testing::TestWithParam<Isa> {};

TEST_P(CoverageTest, RandomTrianglesOfAllSizes) {
    std::mt19937 random(1);
    for (const uint32_t bits : {4u, 8u, 12u, 16u}) {
        for (int n = 0; n < 120; ++n) {
            const int32_t tileX = static_cast<int32_t>(random() % 256) * kTileSize;
            const int32_t tileY = static_cast<int32_t>(random() % 256) * kTileSize;
            // From sub-pixel triangles to ones as large as the guard band.
            const int shift = static_cast<int>(random() % (bits + 14));
            const auto coordinate = [&](int32_t tile) {
                const int64_t range = int64_t{1} << (shift + 1);
                const int64_t centre = (int64_t{tile} + static_cast<int64_t>(random() % 64)) << bits;
                const int64_t value = centre + static_cast<int64_t>(random() % range) - range / 2;
                return std::clamp(value, int64_t{kGuardBandMin} << bits, int64_t{kGuardBandMax} << bits);
            };
            Point v[3];
            for (Point& p : v) p = {coordinate(tileX), coordinate(tileY)};
            if (edge(v[0], v[1], v[2]) == 0) continue;
            expectExact(GetParam(), v[0], v[1], v[2], tileX, tileY, bits, n % 3 == 0 ? 4 : n % 3);
            if (HasFatalFailure()) return;
        }
    }
}

TEST_P(CoverageTest, TinyPrimitives) {
    std::mt19937 random(5);
    for (int n = 0; n < 20000; ++n) {
        const uint32_t bits = n % 2 == 0 ? 8 : 4 + random() % 5;
        const int32_t tileX = static_cast<int32_t>(random() % 256) * kTileSize;
        const int32_t tileY = static_cast<int32_t>(random() % 256) * kTileSize;
        // Around the tile and its edges, up to the largest extent; on whole pixels, half pixels, and anywhere.
        const int64_t grid = int64_t{1} << (n % 3 == 0 ? bits : n % 3 == 1 ? bits - 1 : 0);
        const int64_t range = int64_t{1} << (1 + random() % kTinyEdgeBits);
        const auto origin = [&](int32_t tile) {
            return ((int64_t{tile} - 17 + static_cast<int64_t>(random() % 98)) << bits);
        };
        const int64_t x = origin(tileX), y = origin(tileY);
        const auto coordinate = [&](int64_t from) {
            return (from + static_cast<int64_t>(random()) % (range + 1)) / grid * grid;
        };
        Point v[3];
        for (Point& p : v) p = {coordinate(x), coordinate(y)};
        if (edge(v[0], v[1], v[2]) == 0) continue;
        Primitive primitive = primitiveOf(v[0], v[1], v[2], tileX, tileY);
        if (!primitive.tiny) continue;
        // As setup bounds them, and cut by a scissor.
        for (int axis = 0; axis < 2; ++axis) {
            const auto& c = axis == 0 ? primitive.x : primitive.y;
            const auto pixel = [&](int32_t sub) { return static_cast<int16_t>(sub >> bits); };
            primitive.bounds[static_cast<size_t>(axis)] = pixel(std::min({c[0], c[1], c[2]}));
            primitive.bounds[static_cast<size_t>(axis) + 2] =
                static_cast<int16_t>(pixel(std::max({c[0], c[1], c[2]})) - (n % 5 == 0 ? 2 : 0));
        }
        const auto outside = [&](size_t axis, int32_t tile) {
            return primitive.bounds[axis] > tile + kTileSize - 1 || primitive.bounds[axis + 2] < tile ||
                   primitive.bounds[axis] > primitive.bounds[axis + 2];
        };
        if (outside(0, tileX) || outside(1, tileY)) continue;
        const SamplePosition position =
            n % 4 == 0 ? SamplePosition{static_cast<uint8_t>(random() % 16), static_cast<uint8_t>(random() % 16)}
                       : samplePositions(1)[0];
        expectSameWhenTiny(GetParam(), primitive, tileX, tileY, bits, position);
        if (HasFailure()) return;
    }
}

TEST_P(CoverageTest, EdgesThroughCentresAndTileCorners) {
    // Half-pixel grid: ties everywhere.
    std::mt19937 random(2);
    for (int n = 0; n < 400; ++n) {
        Point v[3];
        for (Point& p : v)
            p = {static_cast<int64_t>(random() % 129) * 128 + 64 * 256, static_cast<int64_t>(random() % 129) * 128};
        if (edge(v[0], v[1], v[2]) == 0) continue;
        expectExact(GetParam(), v[0], v[1], v[2], 64, 0, 8, 1);
        if (HasFatalFailure()) return;
    }
}

TEST_P(CoverageTest, SliverWhoseFloatAreaIsZero) {
    // True area 0.777 square pixels, 24 centres inside; a float evaluation of the area gives 0.
    const Point v[3] = {{965334 + 128, 9134 + 128}, {1857265 + 128, 1515506 + 128}, {1515249 + 128, 937879 + 128}};
    uint32_t total = 0;
    for (int32_t tileY = 0; tileY < 6000; tileY += kTileSize) {
        for (int32_t tileX = 3712; tileX < 7296; tileX += kTileSize) {
            BlockCoverage blocks[kBlocksPerTile];
            const TileEdges edges =
                tileEdges(primitiveOf(v[0], v[1], v[2], tileX, tileY), tileX, tileY, 8, 1, samplePositions(1));
            const uint32_t count = coverTileFunction(GetParam())(edges, blocks);
            for (uint32_t n = 0; n < count; ++n)
                total += static_cast<uint32_t>(__builtin_popcountll(blocks[n].masks[0]));
        }
    }
    EXPECT_EQ(total, 24u);
}

TEST_P(CoverageTest, LargestTriangleOnTheFinestGrid) {
    for (const uint32_t bits : {8u, 16u}) {
        const int64_t low = int64_t{kGuardBandMin} << bits, high = int64_t{kGuardBandMax} << bits;
        for (const auto& [x, y] : {std::pair{0, 0}, {16320, 0}, {8128, 8192}, {16320, 16320}})
            expectExact(GetParam(), {low, low}, {high, low + 1}, {low + 1, high}, x, y, bits, 1);
    }
}

INSTANTIATE_TEST_SUITE_P(AllIsas, CoverageTest, testing::ValuesIn(availableIsas()),
                         [](const auto& isa) { return std::string(isaName(isa.param)); });

}  // namespace
}  // namespace vernier
