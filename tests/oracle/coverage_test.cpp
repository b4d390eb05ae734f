// Hand-computed coverage: ties, slivers, snapping, what legal snapping may change.
#include "conformance/oracle/coverage.h"
#include "conformance/oracle/coverage_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace vernier::conformance::exact {
namespace {

GridPoint pixels(int64_t x, int64_t y) {
    return {x * 256, y * 256};
}
GridPoint centre(int64_t x, int64_t y) {
    return {x * 256 + 128, y * 256 + 128};
}

int countCovered(const GridTriangle& t, int64_t width, int64_t height) {
    int count = 0;
    for (int64_t y = 0; y < height; ++y) {
        for (int64_t x = 0; x < width; ++x) count += covers(t, centre(x, y));
    }
    return count;
}

// E01: six centres lie on the diagonal; it is a left edge of the lower right triangle, which therefore owns
// them.
TEST(Coverage, DiagonalThroughCentresBelongsToTheTriangleOnItsRight) {
    const GridTriangle upperLeft{pixels(1, 1), pixels(1, 7), pixels(7, 1)};
    const GridTriangle lowerRight{pixels(7, 7), pixels(7, 1), pixels(1, 7)};
    EXPECT_EQ(countCovered(upperLeft, 8, 8), 15);
    EXPECT_EQ(countCovered(lowerRight, 8, 8), 21);
    for (int64_t i = 1; i <= 6; ++i) {
        EXPECT_FALSE(covers(upperLeft, centre(i, 7 - i)));
        EXPECT_TRUE(covers(lowerRight, centre(i, 7 - i)));
    }
}

// E02: ownership is a matter of geometry, not of vertex order.
TEST(Coverage, VertexOrderDoesNotMatter) {
    GridTriangle t{pixels(1, 1), pixels(1, 7), pixels(7, 1)};
    std::ranges::sort(t);
    do {
        EXPECT_EQ(countCovered(t, 8, 8), 15);
    } while (std::ranges::next_permutation(t).found);
}

// E03, E04: edges exactly through centres; top and left in, bottom and right out.
TEST(Coverage, HorizontalAndVerticalEdgesThroughCentres) {
    const GridTriangle first{centre(1, 1), centre(4, 1), centre(4, 4)};
    const GridTriangle second{centre(1, 1), centre(4, 4), centre(1, 4)};
    for (int64_t i = 1; i < 4; ++i) {
        EXPECT_TRUE(covers(first, centre(i, 1))) << "top row";
        EXPECT_TRUE(covers(second, centre(1, i)) || covers(first, centre(1, i))) << "left column";
        EXPECT_FALSE(covers(second, centre(i, 4))) << "bottom row";
        EXPECT_FALSE(covers(first, centre(4, i))) << "right column";
    }
    EXPECT_EQ(countCovered(first, 8, 8) + countCovered(second, 8, 8), 9);
}

// E05: the hub of a fan belongs to exactly one triangle.
TEST(Coverage, HubOfAFanIsCoveredOnce) {
    const GridPoint hub = centre(8, 8);
    const std::vector<GridPoint> rim{{300, 200},   {1500, 100},  {3900, 90},  {4100, 2176},
                                     {4000, 4000}, {2176, 4100}, {700, 4096}, {2176 - 2000, 2176}};
    int count = 0;
    for (size_t i = 0; i < rim.size(); ++i) count += covers({hub, rim[i], rim[(i + 1) % rim.size()]}, hub);
    EXPECT_EQ(count, 1);
}

// E10: a sliver of 0.777 square pixels that a float area calls empty; 24 sample points on the integer lattice
// are strictly inside, so the vertices move by half a pixel to bring them onto centres.
TEST(Coverage, SliverOfAlmostNoAreaCoversItsTwentyFourCentres) {
    GridTriangle sliver{GridPoint{965334, 9134}, GridPoint{1857265, 1515506}, GridPoint{1515249, 937879}};
    for (GridPoint& p : sliver) p = {p.x + 128, p.y + 128};
    const Wide area = edgeFunction(sliver[0], sliver[1], sliver[2]);
    EXPECT_EQ(orientation(sliver), area > 0 ? 1 : -1);
    EXPECT_NEAR(std::abs(static_cast<double>(area)) / 2 / 65536, 0.777, 0.0005);
    std::set<std::pair<int64_t, int64_t>> covered;
    for (int64_t y = 9262 / 256; y <= 1515634 / 256; ++y) {
        // The sliver is thinner than a pixel: look around the long edge only.
        const int64_t x0 = (965462 + (1857265 - 965334) * (y * 256 + 128 - 9262) / (1515506 - 9134)) / 256;
        for (int64_t x = x0 - 3; x <= x0 + 3; ++x) {
            if (covers(sliver, centre(x, y))) covered.insert({x, y});
        }
    }
    EXPECT_EQ(covered.size(), 24u);
}

// E11: no area, no fragments.
TEST(Coverage, EmptyTrianglesCoverNothing) {
    const GridPoint p = centre(2, 2);
    EXPECT_FALSE(covers({p, p, p}, p));
    EXPECT_FALSE(covers({centre(0, 0), centre(4, 4), p}, p));
    EXPECT_FALSE(covers({centre(0, 0), centre(0, 0), centre(4, 4)}, p));
}

// V01: the product of the largest differences needs more than 64 bits at 32K x 16 bits; the oracle has 127.
TEST(Coverage, LargestTargetsDoNotOverflow) {
    const int64_t far = int64_t{1} << 32;  // 65536 pixels of 16 bits
    const GridTriangle t{GridPoint{-far, -far}, GridPoint{far, -far}, GridPoint{-far, far}};
    EXPECT_TRUE(covers(t, {-1, 0}));
    EXPECT_FALSE(covers(t, {1, 0}));
    EXPECT_FALSE(covers(t, {0, 0})) << "the hypotenuse is neither top nor left";
}

// E15, E16: ties to even; minus zero and denormals are zero.
TEST(Snapping, NearestEven) {
    EXPECT_EQ(snapNearestEven(fraction(1, 512), 8), 0);
    EXPECT_EQ(snapNearestEven(fraction(3, 512), 8), 2);
    EXPECT_EQ(snapNearestEven(fraction(-1, 512), 8), 0);
    EXPECT_EQ(snapNearestEven(fraction(-3, 512), 8), -2);
    EXPECT_EQ(snapNearestEven(rational(-0.0), 8), 0);
    EXPECT_EQ(snapNearestEven(rational(0x1p-149), 8), 0);
    EXPECT_EQ(snapNearestEven(rational(10.5), 4), 168);
}

TEST(Snapping, LegalBoxIsOneSubUnitEitherWay) {
    const SnapBox onGrid = legalSnapBox(fraction(5, 256), 8);
    EXPECT_EQ(onGrid.low, 4);
    EXPECT_EQ(onGrid.high, 6);
    const SnapBox between = legalSnapBox(fraction(11, 512), 8);
    EXPECT_EQ(between.low, 5);
    EXPECT_EQ(between.high, 6);
}

TEST(Legality, SamplesNearAnEdgeMayGoEitherWay) {
    const GridTriangle t{pixels(0, 0), pixels(16, 0), pixels(0, 16)};
    EXPECT_EQ(classify(t, {256, 256}), Coverage::must);
    EXPECT_EQ(classify(t, {256, 0}), Coverage::may);
    EXPECT_EQ(classify(t, {256, 1}), Coverage::may);
    EXPECT_EQ(classify(t, {256, 2}), Coverage::must);
    EXPECT_EQ(classify(t, {256, -1}), Coverage::may);
    EXPECT_EQ(classify(t, {256, -2}), Coverage::mustNot);
    EXPECT_EQ(classify(t, {2048, 2048}), Coverage::may);
    EXPECT_EQ(classify(t, {2050, 2050}), Coverage::mustNot);
    // |E| = 4096 * 2 is exactly delta (|dx| + |dy|): still open.
    EXPECT_EQ(classify(t, {2049, 2049}), Coverage::may);
    EXPECT_EQ(classify(t, {-2, 100}), Coverage::mustNot);
}

TEST(Legality, AnyCornerOfTheSnapBoxesAgreesWithTheVerdict) {
    const GridTriangle t{GridPoint{10, 20}, GridPoint{900, 140}, GridPoint{333, 700}};
    for (int64_t y = 0; y < 720; y += 7) {
        for (int64_t x = 0; x < 910; x += 5) {
            const Coverage verdict = classify(t, {x, y});
            bool sometimes = false, always = true;
            for (int corner = 0; corner < 64; ++corner) {
                GridTriangle moved = t;
                for (size_t i = 0; i < 3; ++i) {
                    moved[i].x += (corner >> (2 * i)) & 1 ? 1 : -1;
                    moved[i].y += (corner >> (2 * i + 1)) & 1 ? 1 : -1;
                }
                const bool in = covers(moved, {x, y});
                sometimes = sometimes || in;
                always = always && in;
            }
            if (verdict == Coverage::must) {
                EXPECT_TRUE(always) << x << "," << y;
            } else if (verdict == Coverage::mustNot) {
                EXPECT_FALSE(sometimes) << x << "," << y;
            }
        }
    }
}

TEST(Legality, SharedEdgeIsExclusive) {
    const std::vector<GridTriangle> quad{{pixels(1, 1), pixels(1, 7), pixels(7, 1)},
                                         {pixels(7, 7), pixels(7, 1), pixels(1, 7)}};
    const auto shared = findSharedEdges(quad);
    ASSERT_EQ(shared.size(), 1u);
    EXPECT_TRUE(isExclusive(quad, shared[0], centre(3, 4)));
    EXPECT_FALSE(isExclusive(quad, shared[0], centre(3, 3))) << "decided anyway";
    EXPECT_FALSE(isExclusive(quad, shared[0], pixels(1, 7))) << "other edges are open at the corner";
}

}  // namespace
}  // namespace vernier::conformance::exact
