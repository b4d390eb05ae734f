// The checks are checked: renderers with one deliberate fault each must be caught, and the cause named.
#include "conformance/oracle/coverage_checks.h"
#include "conformance/oracle/filtering.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace vernier::conformance::exact {
namespace {

using CoverageFunction = std::function<bool(const GridTriangle&, const GridPoint&)>;

constexpr SampleGrid kGrid{{16, 16}, 8, {128, 128}};
constexpr VkRect2D kEverything{{0, 0}, {16, 16}};

std::vector<uint32_t> draw(const std::vector<GridTriangle>& triangles, const CoverageFunction& covered,
                           const VkRect2D& scissor = kEverything) {
    std::vector<uint32_t> counts(16 * 16);
    for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 0; x < 16; ++x) {
            const bool in = static_cast<int>(x) >= scissor.offset.x && static_cast<int>(y) >= scissor.offset.y &&
                            x < scissor.offset.x + scissor.extent.width && y < scissor.offset.y + scissor.extent.height;
            for (const GridTriangle& t : triangles) counts[y * 16 + x] += in && covered(t, kGrid.sample(x, y));
        }
    }
    return counts;
}

// The edge test with a choice of what happens on the edge itself.
CoverageFunction withTies(const std::function<bool(const GridPoint&, const GridPoint&)>& owned, GridPoint shift = {}) {
    return [owned, shift](const GridTriangle& triangle, const GridPoint& sample) {
        const GridPoint p{sample.x + shift.x, sample.y + shift.y};
        GridTriangle t = triangle;
        if (orientation(t) == 0) return false;
        if (orientation(t) < 0) std::swap(t[1], t[2]);
        for (size_t i = 0; i < 3; ++i) {
            const GridPoint &a = t[i], &b = t[(i + 1) % 3];
            const Wide e = edgeFunction(a, b, p);
            if (e < 0 || (e == 0 && !owned(a, b))) return false;
        }
        return true;
    };
}

// E01 scaled to 16 pixels: the diagonal and the right and bottom borders run through centres.
std::vector<GridTriangle> diagonalQuad() {
    const GridPoint a{640, 640}, b{640, 3200}, c{3200, 640}, d{3200, 3200};  // centres of pixels 2 and 12
    return {{a, b, c}, {d, c, b}};
}

TEST(Mutation, TheRightRulePasses) {
    const auto counts = draw(diagonalQuad(), covers);
    EXPECT_EQ(checkDeclaredCoverage(diagonalQuad(), kGrid, kEverything, counts), "");
    EXPECT_EQ(checkLegalCoverage(diagonalQuad(), kGrid, kEverything, counts), "");
    EXPECT_EQ(checkPartition(diagonalQuad(), kGrid, kEverything, counts), "");
}

TEST(Mutation, ShiftedTieRuleIsCaughtInDeclaredModeOnly) {
    const auto bottomRight = withTies([](const GridPoint& a, const GridPoint& b) { return !isTopLeft(a, b); });
    const auto counts = draw(diagonalQuad(), bottomRight);
    const std::string wrong = checkDeclaredCoverage(diagonalQuad(), kGrid, kEverything, counts);
    EXPECT_NE(wrong.find("tie"), std::string::npos) << wrong;
    EXPECT_EQ(checkLegalCoverage(diagonalQuad(), kGrid, kEverything, counts), "") << "another tie rule is legal";
    EXPECT_EQ(checkPartition(diagonalQuad(), kGrid, kEverything, counts), "");
}

TEST(Mutation, MissingTopLeftDecrementDoublesTheDiagonal) {
    const auto inclusive = withTies([](const GridPoint&, const GridPoint&) { return true; });
    const auto counts = draw(diagonalQuad(), inclusive);
    for (const std::string& wrong : {checkDeclaredCoverage(diagonalQuad(), kGrid, kEverything, counts),
                                     checkLegalCoverage(diagonalQuad(), kGrid, kEverything, counts),
                                     checkPartition(diagonalQuad(), kGrid, kEverything, counts)}) {
        EXPECT_NE(wrong.find("covered"), std::string::npos);
        EXPECT_NE(wrong.find("tie"), std::string::npos) << wrong;
    }
}

TEST(Mutation, ExclusiveTestLeavesHoles) {
    const auto exclusive = withTies([](const GridPoint&, const GridPoint&) { return false; });
    const auto counts = draw(diagonalQuad(), exclusive);
    EXPECT_NE(checkLegalCoverage(diagonalQuad(), kGrid, kEverything, counts), "");
    EXPECT_NE(checkPartition(diagonalQuad(), kGrid, kEverything, counts).find("covered 0 times"), std::string::npos);
}

TEST(Mutation, SamplesShiftedByThreeSubUnitsAreIllegal) {
    const auto shifted = withTies(isTopLeft, {-3, 0});
    const auto counts = draw(diagonalQuad(), shifted);
    EXPECT_NE(checkDeclaredCoverage(diagonalQuad(), kGrid, kEverything, counts), "");
    // Every pixel of the border columns is within reach of a legal snapping only for shifts of one sub-unit.
    const std::vector<GridTriangle> offGrid{{GridPoint{640 - 2, 600}, GridPoint{3000, 600}, GridPoint{640 - 2, 3000}}};
    EXPECT_EQ(checkLegalCoverage(offGrid, kGrid, kEverything, draw(offGrid, covers)), "");
    EXPECT_NE(checkLegalCoverage(offGrid, kGrid, kEverything, draw(offGrid, withTies(isTopLeft, {-5, 0}))), "");
}

TEST(Mutation, ScissorOffByOne) {
    const VkRect2D scissor{{3, 3}, {6, 6}}, wide{{3, 3}, {7, 6}}, narrow{{3, 3}, {5, 6}};
    EXPECT_EQ(checkDeclaredCoverage(diagonalQuad(), kGrid, scissor, draw(diagonalQuad(), covers, scissor)), "");
    const std::string outside =
        checkDeclaredCoverage(diagonalQuad(), kGrid, scissor, draw(diagonalQuad(), covers, wide));
    EXPECT_NE(outside.find("outside the scissor"), std::string::npos) << outside;
    const std::string inside =
        checkDeclaredCoverage(diagonalQuad(), kGrid, scissor, draw(diagonalQuad(), covers, narrow));
    EXPECT_NE(inside.find("strictly inside"), std::string::npos) << inside;
}

// E06: a random tiling on the grid; a per-triangle rounding of one vertex opens cracks (E07's classic fault).
TEST(Mutation, PerTriangleSnappingBreaksTheTiling) {
    std::mt19937 random(7);
    constexpr int kCells = 5;
    std::vector<GridPoint> points;
    for (int y = 0; y <= kCells; ++y) {
        for (int x = 0; x <= kCells; ++x) {
            const auto jitter = [&] { return static_cast<int64_t>(random() % 400) - 200; };
            points.push_back({128 + x * 768 + jitter(), 128 + y * 768 + jitter()});
        }
    }
    std::vector<GridTriangle> tiling;
    for (size_t y = 0; y < kCells; ++y) {
        for (size_t x = 0; x < kCells; ++x) {
            const size_t i = y * (kCells + 1) + x;
            tiling.push_back({points[i], points[i + 1], points[i + kCells + 1]});
            tiling.push_back({points[i + 1], points[i + kCells + 2], points[i + kCells + 1]});
        }
    }
    EXPECT_EQ(checkPartition(tiling, kGrid, kEverything, draw(tiling, covers)), "");
    EXPECT_EQ(checkLegalCoverage(tiling, kGrid, kEverything, draw(tiling, covers)), "");
    std::vector<GridTriangle> cracked = tiling;
    for (size_t i = 0; i < cracked.size(); i += 2) {
        for (GridPoint& p : cracked[i]) p = {p.x / 64 * 64, p.y / 64 * 64};
    }
    EXPECT_NE(checkPartition(tiling, kGrid, kEverything, draw(cracked, covers)), "");
}

TEST(Mutation, SevenBitWeights) {
    const auto ramp = [](int64_t x, int64_t) { return Rational(x <= 0 ? 0 : 1); };
    const auto truncated = [&](const Rational& u, int bits) {
        const AxisTaps taps = linearTaps(u);
        const Rational weight = Rational(floorOf(taps.weight * powerOfTwo(bits))) / powerOfTwo(bits);
        return Rational(ramp(taps.first, 0) + weight * (ramp(taps.first + 1, 0) - ramp(taps.first, 0)));
    };
    bool caughtBySet = false, caughtByDeclared = false;
    for (int i = 0; i < 1000; ++i) {
        const Rational u = fraction(1, 2) + fraction(i, 1000), v = fraction(1, 2);
        const FilterRange range = bilinearRange(ramp, u, v, 8, 0);
        EXPECT_GE(truncated(u, 8), range.low);
        caughtBySet = caughtBySet || truncated(u, 7) < range.low;
        caughtByDeclared = caughtByDeclared || bilinear(ramp, u, v, 7) != bilinear(ramp, u, v, 8);
    }
    EXPECT_TRUE(caughtBySet);
    EXPECT_TRUE(caughtByDeclared);
}

}  // namespace
}  // namespace vernier::conformance::exact
