// The oracle's tessellator against hand-computed subdivisions, against what the specification promises of all of them,
// and beside Vernier's.
#include "conformance/oracle/tessellator.h"
#include "runtime/geometry/tessellator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace vernier::conformance::exact {
namespace {

std::vector<Rational> fractions(std::initializer_list<std::pair<int, int>> list) {
    std::vector<Rational> result;
    for (const auto& [over, under] : list) result.push_back(fraction(over, under));
    return result;
}

std::vector<DomainPoint> sorted(std::vector<DomainPoint> points) {
    std::ranges::sort(points, [](const DomainPoint& a, const DomainPoint& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    return points;
}

/// Twice the sum of the areas, by the specification's formula; `least` becomes the smallest, `most` the largest.
Rational areas(const Subdivision& parts, Rational& least, Rational& most) {
    Rational sum = 0;
    for (const auto& t : parts.primitives) {
        const DomainPoint &a = parts.points[t[0]], &b = parts.points[t[1]], &c = parts.points[t[2]];
        const Rational area = a[0] * b[1] - b[0] * a[1] + b[0] * c[1] - c[0] * b[1] + c[0] * a[1] - a[0] * c[1];
        if (sum == 0) least = most = area;
        least = std::min(least, area);
        most = std::max(most, area);
        sum += area;
    }
    return sum;
}

constexpr PatchSpacing kEqual = PatchSpacing::equal, kOdd = PatchSpacing::fractionalOdd,
                       kEven = PatchSpacing::fractionalEven;

TEST(Edge, LevelsAreClampedAndRoundedUp) {
    const auto segments = [](double level, PatchSpacing spacing) { return edgeEnds(level, spacing).size() - 1; };
    EXPECT_EQ(segments(-3, kEqual), 1u);
    EXPECT_EQ(segments(1, kEqual), 1u);
    EXPECT_EQ(segments(1.001, kEqual), 2u);
    EXPECT_EQ(segments(3.2, kEqual), 4u);
    EXPECT_EQ(segments(1e9, kEqual), 64u);
    EXPECT_EQ(segments(0.1, kEven), 2u);
    EXPECT_EQ(segments(2.001, kEven), 4u);
    EXPECT_EQ(segments(5, kEven), 6u);
    EXPECT_EQ(segments(70, kEven), 64u);
    EXPECT_EQ(segments(1, kOdd), 1u);
    EXPECT_EQ(segments(2, kOdd), 3u);
    EXPECT_EQ(segments(3.5, kOdd), 5u);
    EXPECT_EQ(segments(63.5, kOdd), 63u);
}

TEST(Edge, Places) {
    EXPECT_EQ(edgeEnds(3.2, kEqual), fractions({{0, 1}, {1, 4}, {1, 2}, {3, 4}, {1, 1}}));
    // Five segments for 3.5: two of a quarter of the length of the others, which are 1 / 3.5.
    EXPECT_EQ(edgeEnds(3.5, kOdd), fractions({{0, 1}, {1, 14}, {5, 14}, {9, 14}, {13, 14}, {1, 1}}));
    EXPECT_EQ(edgeEnds(2.5, kEven), fractions({{0, 1}, {1, 10}, {1, 2}, {9, 10}, {1, 1}}));
    EXPECT_EQ(edgeEnds(5, kOdd), fractions({{0, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}, {1, 1}}));
    // One that counts as a little more than 1.
    EXPECT_EQ(edgeEnds(1, kEqual, true), fractions({{0, 1}, {1, 2}, {1, 1}}));
    EXPECT_EQ(edgeEnds(1, kOdd, true), fractions({{0, 1}, {0, 1}, {1, 1}, {1, 1}}));
    EXPECT_EQ(edgeEnds(3, kOdd, true), edgeEnds(3, kOdd));
    // 2 of 4 segments with a sixteenth of the length of the others.
    TessellationChoices inside;
    inside.shortInside = true;
    EXPECT_EQ(edgeEnds(2.5, kEven, false, inside), fractions({{0, 1}, {8, 17}, {1, 2}, {9, 17}, {1, 1}}));
}

TEST(Triangles, OneAlone) {
    const Subdivision parts = subdivide({}, {{1, 0.5, 1}, {-2, 9}});
    EXPECT_EQ(sorted(parts.points), sorted({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(parts.primitives.size(), 1u);
}

TEST(Triangles, AroundTheCenter) {
    const Rational third = fraction(1, 3), half = fraction(1, 2);
    // u = 0 in one segment, v = 0 in two, w = 0 in three; an inner level of 1 counts as 2.
    for (const double inner : {1.0, 2.0}) {
        const Subdivision parts = subdivide({}, {{1, 2, 3, 7}, {inner, 7}});
        EXPECT_EQ(sorted(parts.points), sorted({{1, 0, 0},
                                                {0, 1, 0},
                                                {0, 0, 1},
                                                {half, 0, half},
                                                {third, 1 - third, 0},
                                                {1 - third, third, 0},
                                                {third, third, third}}));
        EXPECT_EQ(parts.primitives.size(), 6u);
        for (const auto& triangle : parts.primitives)
            EXPECT_TRUE(std::ranges::count(triangle, parts.points.size() - 1)) << "one of the center";
    }
}

TEST(Triangles, InnerTriangles) {
    // Perpendiculars through the thirds of the edges meet a third of the way to the third corner of the small triangle
    // that they cut off: 1/3 along an edge, 2/9 above it.
    const Subdivision three = subdivide({}, {{1, 1, 1}, {3}});
    const Rational low = fraction(2, 9), high = fraction(5, 9);
    EXPECT_EQ(sorted(three.points),
              sorted({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {high, low, low}, {low, high, low}, {low, low, high}}));
    EXPECT_EQ(three.primitives.size(), 7u);
    // Level 5: rings of 15, 9 and 3 segments; 4: of 12 and 6, and a point.
    const Subdivision five = subdivide({}, {{5, 5, 5}, {5}}), four = subdivide({}, {{4, 4, 4}, {4}});
    EXPECT_EQ(five.points.size(), 15u + 9 + 3);
    EXPECT_EQ(five.primitives.size(), 24u + 12 + 1);
    EXPECT_EQ(four.points.size(), 12u + 6 + 1);
    EXPECT_EQ(four.primitives.size(), 18u + 6);
    const std::vector<DomainPoint> middle{{fraction(1, 6), fraction(5, 12), fraction(5, 12)}};
    EXPECT_EQ(std::ranges::count(four.points, middle[0]), 1) << "the first inner triangle's edges have two segments";
}

TEST(Quads, Meshes) {
    const Rational half = fraction(1, 2), third = fraction(1, 3);
    const Subdivision whole = subdivide({PatchDomain::quads}, {{1, 1, 1, 1}, {1, 1}});
    EXPECT_EQ(sorted(whole.points), sorted({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(whole.primitives.size(), 2u);
    // u = 0, v = 0, u = 1, v = 1 in 1, 2, 1, 1 segments; three columns, two rows.
    const Subdivision parts = subdivide({PatchDomain::quads}, {{1, 2, 1, 1}, {3, 2}});
    EXPECT_EQ(
        sorted(parts.points),
        sorted({{0, 0, 0}, {half, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {third, half, 0}, {1 - third, half, 0}}));
    EXPECT_EQ(parts.primitives.size(), 5u + 2) << "one for each segment";
    EXPECT_EQ(subdivide({PatchDomain::quads}, {{1, 1, 1, 1}, {7, 4}}).primitives.size(), 2u * 10 + 4 + 14)
        << "10 inside";
    EXPECT_EQ(subdivide({PatchDomain::quads}, {{1, 1, 1, 2}, {1, 1}}).points.size(), 6u) << "a center";
}

TEST(Isolines, Lines) {
    const Subdivision parts = subdivide({PatchDomain::isolines, kOdd}, {{1.5, 3}, {}});
    const Rational third = fraction(1, 3), half = fraction(1, 2);
    EXPECT_EQ(parts.points, (std::vector<DomainPoint>{{0, 0, 0},
                                                      {third, 0, 0},
                                                      {1 - third, 0, 0},
                                                      {1, 0, 0},
                                                      {0, half, 0},
                                                      {third, half, 0},
                                                      {1 - third, half, 0},
                                                      {1, half, 0}}));
    EXPECT_EQ(parts.primitives, (std::vector<std::vector<uint32_t>>{{0, 1}, {1, 2}, {2, 3}, {4, 5}, {5, 6}, {6, 7}}));
}

TEST(Patches, AreDiscardedByRelevantLevels) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::array<std::pair<PatchDomain, size_t>, 3> relevant{
        {{PatchDomain::triangles, 3}, {PatchDomain::quads, 4}, {PatchDomain::isolines, 2}}};
    for (const auto& [domain, count] : relevant) {
        for (size_t side = 0; side < 4; ++side) {
            for (const double level : {0.0, -1.0, nan}) {
                PatchLevels levels{{2, 2, 2, 2}, {-1, 0}};
                levels.outer[side] = level;
                EXPECT_EQ(subdivide({domain}, levels).primitives.empty(), side < count);
            }
        }
    }
}

/// Levels from below 1 to 13, one of them whole as often as not.
PatchLevels randomLevels(std::mt19937& random) {
    const auto level = [&] {
        const double any = 0.5 + (random() % 1024) / 80.0;
        return random() % 2 == 0 ? std::floor(any) + 1 : static_cast<double>(static_cast<float>(any));
    };
    PatchLevels levels;
    for (double& each : levels.outer) each = level();
    for (double& each : levels.inner) each = level();
    return levels;
}

constexpr std::array<TessellationChoices, 5> kChoices{{{},
                                                       {true, false, false, false},
                                                       {false, true, false, false},
                                                       {false, false, true, false},
                                                       {false, false, false, true}}};

TEST(Patches, TrianglesCoverTheDomainOnceInTheirOrder) {
    std::mt19937 random(1);
    for (int n = 0; n < 120; ++n) {
        PatchModes modes;
        modes.domain = n % 2 == 0 ? PatchDomain::triangles : PatchDomain::quads;
        modes.spacing = std::array{kEqual, kOdd, kEven}[random() % 3];
        modes.clockwise = random() % 2 == 0;
        modes.lowerLeft = random() % 2 == 0;
        const PatchLevels levels = randomLevels(random);
        // Positive areas: counter-clockwise with a lower-left origin.
        const int sign = modes.clockwise == modes.lowerLeft ? -1 : 1;
        size_t count = 0;
        for (const TessellationChoices& choices : kChoices) {
            const Subdivision parts = subdivide(modes, levels, choices);
            Rational least, most;
            // The sum is the domain's area and no part is turned around: none overlap.
            EXPECT_EQ(areas(parts, least, most), sign * (modes.domain == PatchDomain::quads ? 2 : 1));
            EXPECT_GE(sign > 0 ? least : Rational(-most), 0);
            if (count == 0) count = parts.primitives.size();
            EXPECT_EQ(parts.primitives.size(), count) << "choices change no count";
        }
        modes.points = true;
        const Subdivision points = subdivide(modes, levels);
        EXPECT_EQ(points.primitives.size(), points.points.size());
    }
}

/// Each point of one list beside one of the other, and no other point of either.
bool agree(std::vector<TessellationPoint> ours, const std::vector<DomainPoint>& theirs, double tolerance) {
    if (ours.size() != theirs.size()) return false;
    for (const DomainPoint& point : theirs) {
        const auto near = std::ranges::find_if(ours, [&](const TessellationPoint& p) {
            return std::abs(double{p.u} - point[0].get_d()) <= tolerance &&
                   std::abs(double{p.v} - point[1].get_d()) <= tolerance &&
                   std::abs(double{p.w} - point[2].get_d()) <= tolerance;
        });
        if (near == ours.end()) return false;
        ours.erase(near);
    }
    return true;
}

SubdividedPatch vernier(const PatchModes& modes, const PatchLevels& levels) {
    using Domains = std::map<PatchDomain, TessellationDomain>;
    const Domains domains{{PatchDomain::triangles, TessellationDomain::triangles},
                          {PatchDomain::quads, TessellationDomain::quads},
                          {PatchDomain::isolines, TessellationDomain::isolines}};
    const std::map<PatchSpacing, TessellationSpacing> spacings{{kEqual, TessellationSpacing::equal},
                                                               {kOdd, TessellationSpacing::fractionalOdd},
                                                               {kEven, TessellationSpacing::fractionalEven}};
    // Vernier's tessellator sees v upwards; a plan turns the order where the origin is at the upper left.
    const bool clockwise = modes.clockwise == modes.lowerLeft;
    Tessellator tessellator({domains.at(modes.domain), spacings.at(modes.spacing),
                             clockwise ? TessellationOrder::clockwise : TessellationOrder::counterClockwise,
                             modes.points});
    TessellationLevels given;
    for (size_t i = 0; i < 4; ++i) given.outer[i] = static_cast<float>(levels.outer[i]);
    for (size_t i = 0; i < 2; ++i) given.inner[i] = static_cast<float>(levels.inner[i]);
    return tessellator.subdivide(given);
}

// A coordinate is rounded to a multiple of 2^-24; inner ones of triangles are up to two of them further off, for the
// ends of their edges are multiples of three.
constexpr double kRounding = 4.0 / (1 << 24);

TEST(Vernier, HasTheSamePointsAndAsManyPrimitives) {
    std::mt19937 random(2);
    for (int n = 0; n < 240; ++n) {
        PatchModes modes;
        modes.domain = std::array{PatchDomain::triangles, PatchDomain::quads, PatchDomain::isolines}[random() % 3];
        modes.spacing = std::array{kEqual, kOdd, kEven}[random() % 3];
        modes.points = random() % 4 == 0;
        modes.clockwise = random() % 2 == 0;
        modes.lowerLeft = random() % 2 == 0;
        const PatchLevels levels = randomLevels(random);
        const Subdivision parts = subdivide(modes, levels);
        const SubdividedPatch patch = vernier(modes, levels);
        EXPECT_TRUE(agree(patch.points, parts.points, kRounding));
        EXPECT_EQ(patch.indices.size(), parts.primitives.size() * patch.verticesPerPrimitive);
        if (patch.verticesPerPrimitive != 3) continue;
        double area = 0;
        for (size_t i = 0; i < patch.indices.size(); i += 3) {
            const TessellationPoint &a = patch.points[patch.indices[i]], &b = patch.points[patch.indices[i + 1]],
                                    &c = patch.points[patch.indices[i + 2]];
            area += double{b.u - a.u} * double{c.v - a.v} - double{b.v - a.v} * double{c.u - a.u};
        }
        Rational least, most;
        EXPECT_NEAR(area, areas(parts, least, most).get_d(), 1e-5) << "the order";
    }
}

TEST(Vernier, FaultsWouldShow) {
    const PatchModes modes{PatchDomain::quads, kOdd};
    const PatchLevels levels{{1.5, 3, 5, 7.25}, {3, 5.5}};
    const Subdivision right = subdivide(modes, levels);
    const auto caught = [&](const PatchModes& m, const PatchLevels& l) {
        return !agree(vernier(m, l).points, right.points, kRounding);
    };
    EXPECT_FALSE(caught(modes, levels));
    EXPECT_TRUE(caught(modes, {{1.5, 3, 5, 7.25}, {5.5, 3}})) << "inner levels swapped";
    EXPECT_TRUE(caught(modes, {{3, 1.5, 5, 7.25}, {3, 5.5}})) << "outer levels swapped";
    EXPECT_TRUE(caught(modes, {{5, 3, 1.5, 7.25}, {3, 5.5}})) << "opposite sides swapped";
    EXPECT_TRUE(caught(modes, {{3, 5.5, 5, 7.25}, {1.5, 3}})) << "inner and outer levels swapped";
    EXPECT_TRUE(caught({PatchDomain::quads, kEven}, levels)) << "another spacing";
    EXPECT_TRUE(caught({PatchDomain::quads, kEqual}, levels));
    EXPECT_TRUE(caught(modes, {{1.5, 3, 5, 7.2501}, {3, 5.5}})) << "a level a little off";
}

}  // namespace
}  // namespace vernier::conformance::exact
