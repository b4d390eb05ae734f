// The tessellator, against what the specification promises: counts, areas covered once, edges that do not depend on
// what lies beside them.
#include "runtime/geometry/tessellator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

namespace vernier {
namespace {

using Domain = TessellationDomain;
using Order = TessellationOrder;
using Spacing = TessellationSpacing;

constexpr Spacing kSpacings[] = {Spacing::equal, Spacing::fractionalEven, Spacing::fractionalOdd};
constexpr int64_t kOne = 1 << 24;

struct Place {
    int64_t u, v, w;
    auto operator<=>(const Place&) const = default;
};

/// In units of 2^-24; fails where a coordinate is none of them.
Place placeOf(const TessellationPoint& point) {
    const auto whole = [](float x) {
        const float units = x * static_cast<float>(kOne);
        EXPECT_EQ(units, std::floor(units));
        EXPECT_GE(x, 0.0f);
        EXPECT_LE(x, 1.0f);
        return static_cast<int64_t>(units);
    };
    return {whole(point.u), whole(point.v), whole(point.w)};
}

int64_t doubleArea(const Place& a, const Place& b, const Place& c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// The specification's words about levels, once more.
uint32_t segments(float level, Spacing spacing) {
    if (!(level > 1)) level = 1;
    if (spacing == Spacing::fractionalOdd) {
        uint32_t n = 1;
        while (static_cast<float>(n) < level && n < 63) n += 2;
        return n;
    }
    uint32_t n = spacing == Spacing::equal ? 1 : 2;
    while (static_cast<float>(n) < level && n < 64) n += spacing == Spacing::equal ? 1 : 2;
    return n;
}

uint32_t splitSegments(float level, Spacing spacing) {
    const uint32_t n = segments(level, spacing);
    return n > 1 ? n : spacing == Spacing::equal ? 2 : 3;
}

struct Counts {
    uint32_t points = 0, border = 0;
};

Counts trianglePoints(const TessellationLevels& levels, Spacing spacing) {
    Counts counts;
    for (uint32_t s = 0; s < 3; ++s) counts.border += segments(levels.outer[s], spacing);
    counts.points = counts.border;
    uint32_t inner = segments(levels.inner[0], spacing);
    if (inner == 1 && counts.border == 3) return counts;
    inner = splitSegments(levels.inner[0], spacing);
    for (; inner > 2; inner -= 2) counts.points += 3 * (inner - 2);
    if (inner == 2) ++counts.points;
    return counts;
}

Counts quadPoints(const TessellationLevels& levels, Spacing spacing) {
    Counts counts;
    for (const float level : levels.outer) counts.border += segments(level, spacing);
    counts.points = counts.border;
    if (counts.border == 4 && segments(levels.inner[0], spacing) == 1 && segments(levels.inner[1], spacing) == 1)
        return counts;
    counts.points += (splitSegments(levels.inner[0], spacing) - 1) * (splitSegments(levels.inner[1], spacing) - 1);
    return counts;
}

/// That the triangles of a patch cover its domain once: all turn the same way, their areas add up to the domain's, and
/// each side is the side of one other triangle, the other way round, or lies on the border.
void expectTiling(const SubdividedPatch& patch, Domain domain, Order order, const Counts& counts) {
    ASSERT_EQ(patch.verticesPerPrimitive, 3u);
    ASSERT_EQ(patch.points.size(), counts.points);
    // Euler's formula for a triangulated disk.
    ASSERT_EQ(patch.indices.size(), 3 * (2 * counts.points - counts.border - 2));
    std::vector<Place> places;
    for (const TessellationPoint& point : patch.points) {
        places.push_back(placeOf(point));
        const Place& p = places.back();
        ASSERT_EQ(p.w, domain == Domain::triangles ? kOne - p.u - p.v : 0);
    }
    int64_t area = 0;
    std::set<std::pair<uint32_t, uint32_t>> sides;
    for (size_t n = 0; n < patch.indices.size(); n += 3) {
        const uint32_t* i = patch.indices.data() + n;
        const int64_t part = doubleArea(places[i[0]], places[i[1]], places[i[2]]);
        ASSERT_TRUE(order == Order::clockwise ? part <= 0 : part >= 0);
        area += part;
        for (uint32_t k = 0; k < 3; ++k) ASSERT_TRUE(sides.insert({i[k], i[(k + 1) % 3]}).second);
    }
    const int64_t whole = (domain == Domain::triangles ? 1 : 2) * kOne * kOne;
    ASSERT_EQ(std::abs(area), whole);
    uint32_t border = 0;
    for (const auto& [from, to] : sides) border += sides.count({to, from}) == 0 ? 1 : 0;
    ASSERT_EQ(border, counts.border);
}

float randomLevel(std::mt19937& random) {
    switch (random() % 8) {
        case 0:
            return static_cast<float>(random() % 4);
        case 1:
            return static_cast<float>(random() % 70);
        case 2:
            return std::nextafter(static_cast<float>(1 + random() % 64), random() % 2 == 0 ? 0.0f : 100.0f);
        case 3:
            return 1e30f;
        default:
            return std::uniform_real_distribution<float>(0.01f, 12.0f)(random);
    }
}

TessellationLevels randomLevels(std::mt19937& random) {
    TessellationLevels levels;
    for (float& level : levels.outer) level = randomLevel(random);
    for (float& level : levels.inner) level = randomLevel(random);
    for (float& level : levels.outer)
        if (level == 0) level = 1;
    return levels;
}

/// How far along a side of the border, from either end: the side where u, v, w = 0, or 1 - u, 1 - v of a quad.
std::vector<int64_t> alongSide(const SubdividedPatch& patch, Domain domain, uint32_t side, uint32_t borderPoints) {
    std::vector<int64_t> result;
    for (uint32_t n = 0; n < borderPoints; ++n) {
        const Place p = placeOf(patch.points[n]);
        if (domain == Domain::triangles) {
            if (side == 0 && p.u == 0) result.push_back(p.v);
            if (side == 1 && p.v == 0) result.push_back(p.u);
            if (side == 2 && p.w == 0) result.push_back(p.u);
        } else {
            if (side == 0 && p.u == 0) result.push_back(p.v);
            if (side == 1 && p.v == 0) result.push_back(p.u);
            if (side == 2 && p.u == kOne) result.push_back(p.v);
            if (side == 3 && p.v == kOne) result.push_back(p.u);
        }
    }
    std::sort(result.begin(), result.end());
    return result;
}

TEST(Tessellator, TrianglesCoverTheDomainOnce) {
    std::mt19937 random(1);
    for (const Spacing spacing : kSpacings) {
        for (const Order order : {Order::clockwise, Order::counterClockwise}) {
            Tessellator tessellator({Domain::triangles, spacing, order, false});
            for (uint32_t n = 0; n < 150; ++n) {
                const TessellationLevels levels = randomLevels(random);
                expectTiling(tessellator.subdivide(levels), Domain::triangles, order, trianglePoints(levels, spacing));
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(Tessellator, QuadsCoverTheDomainOnce) {
    std::mt19937 random(2);
    for (const Spacing spacing : kSpacings) {
        for (const Order order : {Order::clockwise, Order::counterClockwise}) {
            Tessellator tessellator({Domain::quads, spacing, order, false});
            for (uint32_t n = 0; n < 150; ++n) {
                const TessellationLevels levels = randomLevels(random);
                expectTiling(tessellator.subdivide(levels), Domain::quads, order, quadPoints(levels, spacing));
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(Tessellator, EveryPairOfWholeLevels) {
    for (const Domain domain : {Domain::triangles, Domain::quads}) {
        Tessellator tessellator({domain, Spacing::equal, Order::counterClockwise, false});
        for (uint32_t outer = 1; outer <= 64; outer += outer < 4 ? 1 : 12) {
            for (uint32_t inner = 1; inner <= 64; ++inner) {
                const auto a = static_cast<float>(outer), b = static_cast<float>(inner);
                const TessellationLevels levels{{a, a, a, a}, {b, b}};
                expectTiling(tessellator.subdivide(levels), domain, Order::counterClockwise,
                             domain == Domain::triangles ? trianglePoints(levels, Spacing::equal)
                                                         : quadPoints(levels, Spacing::equal));
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(Tessellator, WholeLevelsDivideEvenly) {
    Tessellator tessellator({Domain::quads, Spacing::equal, Order::counterClockwise, false});
    for (uint32_t n = 2; n <= 64; ++n) {
        const auto level = static_cast<float>(n);
        const SubdividedPatch& patch = tessellator.subdivide({{level, level, level, level}, {level, level}});
        std::set<float> us;
        for (const TessellationPoint& point : patch.points) us.insert(point.u);
        ASSERT_EQ(us.size(), n + 1);
        uint32_t k = 0;
        for (const float u : us) EXPECT_NEAR(u, static_cast<double>(k++) / n, 0.5 / kOne);
    }
}

// "Tessellation Invariance", rules 2 to 4, and 8 (placeOf).
TEST(Tessellator, SidesDependOnTheirLevelAlone) {
    std::mt19937 random(3);
    for (const Spacing spacing : kSpacings) {
        for (uint32_t n = 0; n < 200; ++n) {
            const float level = randomLevels(random).outer[0];
            std::set<std::vector<int64_t>> seen;
            for (const Domain domain : {Domain::triangles, Domain::quads}) {
                Tessellator tessellator(
                    {domain, spacing, random() % 2 == 0 ? Order::clockwise : Order::counterClockwise, false});
                for (uint32_t side = 0; side < (domain == Domain::triangles ? 3u : 4u); ++side) {
                    TessellationLevels levels = randomLevels(random);
                    levels.outer[side] = level;
                    const Counts counts =
                        domain == Domain::triangles ? trianglePoints(levels, spacing) : quadPoints(levels, spacing);
                    const SubdividedPatch& patch = tessellator.subdivide(levels);
                    const std::vector<int64_t> places = alongSide(patch, domain, side, counts.border);
                    ASSERT_EQ(places.size(), segments(level, spacing) + 1);
                    for (size_t k = 0; k < places.size(); ++k)
                        ASSERT_EQ(places[k] + places[places.size() - 1 - k], kOne);
                    seen.insert(places);
                }
            }
            ASSERT_EQ(seen.size(), 1u) << level;
        }
    }
}

TEST(Tessellator, FractionalSegmentsGrowSteadily) {
    for (const Spacing spacing : {Spacing::fractionalEven, Spacing::fractionalOdd}) {
        Tessellator tessellator({Domain::isolines, spacing, Order::none, false});
        double before = 1;
        uint32_t segmentsBefore = 0;
        for (float level = 3.05f; level < 40; level += 0.05f) {
            const SubdividedPatch& patch = tessellator.subdivide({{1, level, 1, 1}, {1, 1}});
            const auto n = static_cast<uint32_t>(patch.points.size() - 1);
            ASSERT_EQ(n, segments(level, spacing));
            const double first = patch.points[1].u, second = static_cast<double>(patch.points[2].u) - first;
            const double ratio = first / second;
            EXPECT_GE(ratio, 0);
            EXPECT_LE(ratio, 1.00001);
            if (n == segmentsBefore) {
                EXPECT_GT(ratio, before);
            }
            if (n > segmentsBefore && segmentsBefore != 0) {
                EXPECT_LT(ratio, 0.05);
            }
            for (uint32_t k = 2; k < n; ++k)
                EXPECT_NEAR(patch.points[k].u - patch.points[k - 1].u, second, 2.0 / kOne) << level;
            before = ratio;
            segmentsBefore = n;
        }
    }
}

TEST(Tessellator, InteriorsDoNotDependOnOuterLevels) {
    std::mt19937 random(4);
    for (const Domain domain : {Domain::triangles, Domain::quads}) {
        for (const Spacing spacing : kSpacings) {
            Tessellator tessellator({domain, spacing, Order::counterClockwise, false});
            for (uint32_t n = 0; n < 50; ++n) {
                TessellationLevels levels = randomLevels(random);
                for (float& level : levels.inner) level = std::max(level, 3.5f);
                const auto inside = [&] {
                    const Counts counts =
                        domain == Domain::triangles ? trianglePoints(levels, spacing) : quadPoints(levels, spacing);
                    const SubdividedPatch& patch = tessellator.subdivide(levels);
                    std::set<std::array<Place, 3>> triangles;
                    for (size_t k = 0; k < patch.indices.size(); k += 3) {
                        const uint32_t* i = patch.indices.data() + k;
                        if (std::min({i[0], i[1], i[2]}) < counts.border) continue;
                        triangles.insert(
                            {placeOf(patch.points[i[0]]), placeOf(patch.points[i[1]]), placeOf(patch.points[i[2]])});
                    }
                    return triangles;
                };
                const auto before = inside();
                levels.outer = randomLevels(random).outer;
                ASSERT_EQ(before, inside());
                ASSERT_FALSE(before.empty());
            }
        }
    }
}

TEST(Tessellator, Isolines) {
    std::mt19937 random(5);
    for (const Spacing spacing : kSpacings) {
        Tessellator tessellator({Domain::isolines, spacing, Order::none, false});
        for (uint32_t n = 0; n < 200; ++n) {
            const TessellationLevels levels = randomLevels(random);
            const SubdividedPatch& patch = tessellator.subdivide(levels);
            const uint32_t lines = segments(levels.outer[0], Spacing::equal);
            const uint32_t parts = segments(levels.outer[1], spacing);
            ASSERT_EQ(patch.verticesPerPrimitive, 2u);
            ASSERT_EQ(patch.points.size(), lines * (parts + 1));
            ASSERT_EQ(patch.indices.size(), lines * parts * 2);
            for (uint32_t line = 0; line < lines; ++line) {
                for (uint32_t k = 0; k < parts; ++k) {
                    const uint32_t* i = patch.indices.data() + 2 * (line * parts + k);
                    const TessellationPoint &a = patch.points[i[0]], &b = patch.points[i[1]];
                    EXPECT_EQ(a.v, b.v);
                    EXPECT_NEAR(a.v, static_cast<double>(line) / lines, 1.0 / kOne);
                    EXPECT_LE(a.u, b.u);
                    if (k == 0) {
                        EXPECT_EQ(a.u, 0.0f);
                    }
                    if (k + 1 == parts) {
                        EXPECT_EQ(b.u, 1.0f);
                    }
                }
            }
        }
    }
}

TEST(Tessellator, PointModeGivesEveryPointOnce) {
    std::mt19937 random(6);
    for (const Domain domain : {Domain::triangles, Domain::quads, Domain::isolines}) {
        Tessellator whole({domain, Spacing::fractionalOdd, Order::clockwise, false});
        Tessellator points({domain, Spacing::fractionalOdd, Order::clockwise, true});
        for (uint32_t n = 0; n < 100; ++n) {
            const TessellationLevels levels = randomLevels(random);
            const SubdividedPatch& patch = points.subdivide(levels);
            EXPECT_EQ(patch.verticesPerPrimitive, 1u);
            EXPECT_EQ(patch.points, whole.subdivide(levels).points);
            ASSERT_EQ(patch.indices.size(), patch.points.size());
            for (uint32_t k = 0; k < patch.indices.size(); ++k) EXPECT_EQ(patch.indices[k], k);
        }
    }
}

TEST(Tessellator, CulledPatchesAndLevelsThatAreNoNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const uint32_t relevant[] = {3, 4, 2};
    const Domain domains[] = {Domain::triangles, Domain::quads, Domain::isolines};
    for (uint32_t d = 0; d < 3; ++d) {
        Tessellator tessellator({domains[d], Spacing::equal, Order::clockwise, false});
        for (uint32_t side = 0; side < 4; ++side) {
            for (const float level : {0.0f, -0.0f, -1.0f, -infinity, nan}) {
                TessellationLevels levels{{2, 2, 2, 2}, {2, 2}};
                levels.outer[side] = level;
                EXPECT_EQ(tessellator.subdivide(levels).indices.empty(), side < relevant[d]);
            }
        }
        for (const float level : {0.0f, -1.0f, nan, -infinity}) {
            const SubdividedPatch one = tessellator.subdivide({{1, 1, 1, 1}, {1, 1}});
            EXPECT_EQ(tessellator.subdivide({{1, 1, 1, 1}, {level, level}}).points, one.points);
            EXPECT_FALSE(one.points.empty());
        }
        const SubdividedPatch most = tessellator.subdivide({{64, 64, 64, 64}, {64, 64}});
        EXPECT_EQ(tessellator.subdivide({{infinity, 1e9f, 65, 64.5f}, {infinity, 70}}).points, most.points);
    }
}

}  // namespace
}  // namespace vernier
