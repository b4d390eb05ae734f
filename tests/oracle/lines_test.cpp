// Lines and points, by hand.
#include "conformance/oracle/lines.h"

#include <gtest/gtest.h>

namespace vernier::conformance::exact {
namespace {

using Pixels = std::vector<PixelIndex>;

std::array<Rational, 2> at(double x, double y) {
    return {rational(x), rational(y)};
}

TEST(Bresenham, HorizontalLineLeavesOutItsEnd) {
    EXPECT_EQ(bresenhamPixels(at(1.5, 2.5), at(5.5, 2.5)), (Pixels{{1, 2}, {2, 2}, {3, 2}, {4, 2}}));
    EXPECT_EQ(bresenhamPixels(at(5.5, 2.5), at(1.5, 2.5)), (Pixels{{5, 2}, {4, 2}, {3, 2}, {2, 2}}));
}

TEST(Bresenham, ContinuedLinesCoverEveryPixelOnce) {
    for (const auto& [dx, dy] : {std::pair{7, 3}, {-7, 3}, {3, 7}, {3, -7}, {7, 7}, {-7, 7}, {0, 5}, {5, 0}}) {
        const auto a = at(20.5, 20.5), b = at(20.5 + dx, 20.5 + dy), c = at(20.5 + 2 * dx, 20.5 + 2 * dy);
        Pixels twoParts = bresenhamPixels(a, b);
        for (const PixelIndex& p : bresenhamPixels(b, c)) twoParts.push_back(p);
        EXPECT_EQ(twoParts, bresenhamPixels(a, c)) << dx << ", " << dy;
    }
}

TEST(Bresenham, DiagonalHasOnePixelPerColumn) {
    const Pixels pixels = bresenhamPixels(at(1.5, 1.5), at(6.5, 6.5));
    EXPECT_EQ(pixels, (Pixels{{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}}));
}

TEST(Bresenham, NoLengthNoPixels) {
    EXPECT_TRUE(bresenhamPixels(at(3.25, 4), at(3.25, 4)).empty());
    // Inside one diamond: it is never left.
    EXPECT_TRUE(bresenhamPixels(at(3.4, 4.5), at(3.6, 4.5)).empty());
}

TEST(RectangularLine, ExactOnAThreeFourFiveTriangle) {
    // Length 5 pixels, direction (3, 4) / 5: across is (-4, 3) / 5.
    const GridLine line{{0, 0}, {3 * 256, 4 * 256}, fraction(2 * 256, 1)};
    EXPECT_TRUE(lineCovers(line, {-4 * 256 / 5 + 1, 3 * 256 / 5 + 1})) << "just inside the corner, one pixel across";
    EXPECT_FALSE(lineCovers(line, {-4 * 256 / 5 - 3, 3 * 256 / 5}));
    EXPECT_TRUE(lineCovers(line, {384, 512}));
    EXPECT_FALSE(lineCovers(line, {-3, -4})) << "before the start";
    EXPECT_EQ(classifyLine(line, {384, 512}, 3), Coverage::must);
    EXPECT_EQ(classifyLine(line, {0, 0}, 3), Coverage::may) << "on the end";
    EXPECT_EQ(classifyLine(line, {-30, -40}, 3), Coverage::mustNot);
    EXPECT_FALSE(lineCovers({{5, 5}, {5, 5}, fraction(256, 1)}, {5, 5})) << "no length";
}

TEST(RectangularLine, LeftAndTopBordersAreIn) {
    // From (2, 3) to (6, 3) pixels, one pixel wide, in both directions; then upright.
    const GridPoint a{512, 768}, b{1536, 768};
    for (const GridLine& line : {GridLine{a, b, fraction(256, 1)}, GridLine{b, a, fraction(256, 1)}}) {
        EXPECT_TRUE(lineCovers(line, {512, 768})) << "left";
        EXPECT_FALSE(lineCovers(line, {1536, 768})) << "right";
        EXPECT_TRUE(lineCovers(line, {1000, 640})) << "top";
        EXPECT_FALSE(lineCovers(line, {1000, 896})) << "bottom";
        EXPECT_TRUE(lineCovers(line, {512, 640})) << "top left";
        EXPECT_FALSE(lineCovers(line, {512, 896})) << "bottom left";
    }
    for (const GridLine& line :
         {GridLine{{768, 512}, {768, 1536}, fraction(256, 1)}, {{768, 1536}, {768, 512}, fraction(256, 1)}}) {
        EXPECT_TRUE(lineCovers(line, {640, 1000})) << "left";
        EXPECT_FALSE(lineCovers(line, {896, 1000})) << "right";
        EXPECT_TRUE(lineCovers(line, {768, 512})) << "top";
        EXPECT_FALSE(lineCovers(line, {768, 1536})) << "bottom";
    }
    // The sides of a 3-4-5 line, whose corners are on the grid.
    const GridLine aslant{{0, 0}, {3 * 320, 4 * 320}, fraction(640, 1)};
    EXPECT_TRUE(lineCovers(aslant, {480 - 256, 640 + 192})) << "the left one";
    EXPECT_FALSE(lineCovers(aslant, {480 + 256, 640 - 192})) << "the right one";
}

TEST(RectangularLine, ShiftedByFourSubUnitsIsCaught) {
    const GridLine line{{0, 128}, {2560, 128}, fraction(256, 1)}, shifted{{0, 132}, {2560, 132}, fraction(256, 1)};
    const GridPoint above{1280, 2}, below{1280, 258};
    EXPECT_EQ(classifyLine(line, above, 1), Coverage::must);
    EXPECT_FALSE(lineCovers(shifted, above));
    EXPECT_EQ(classifyLine(line, below, 1), Coverage::mustNot);
    EXPECT_TRUE(lineCovers(shifted, below));
}

TEST(Square, OnePixelAtACentre) {
    const GridSquare square{fraction(640, 1), fraction(640, 1), fraction(256, 1)};
    int covered = 0;
    for (int64_t y = 0; y < 5; ++y) {
        for (int64_t x = 0; x < 5; ++x) covered += squareCovers(square, {x * 256 + 128, y * 256 + 128});
    }
    EXPECT_EQ(covered, 1);
    EXPECT_EQ(classifySquare(square, {640, 640}, 1), Coverage::must);
    EXPECT_EQ(classifySquare(square, {512, 640}, 1), Coverage::may);
    EXPECT_EQ(classifySquare(square, {384, 640}, 1), Coverage::mustNot);
}

TEST(Square, WholeSizesAtWholePlacesCoverTheirArea) {
    for (const int64_t size : {1, 2, 5}) {
        const GridSquare square{fraction(2048, 1), fraction(2048, 1), fraction(size * 256, 1)};
        int64_t covered = 0;
        for (int64_t y = 0; y < 16; ++y) {
            for (int64_t x = 0; x < 16; ++x) covered += squareCovers(square, {x * 256 + 128, y * 256 + 128});
        }
        EXPECT_EQ(covered, size * size);
    }
}

}  // namespace
}  // namespace vernier::conformance::exact
