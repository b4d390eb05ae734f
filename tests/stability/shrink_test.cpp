// Shrinking, shown on failures that are planted: what is left is as small as it can be, and can be read.
#include "tests/stability/shrink.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/stability/canvas.h"
#include "tests/stability/generate.h"

namespace vernier::stability {
namespace {

TEST(Shrink, OneTriangleOfSimpleNumbersIsLeft) {
    // Planted: a renderer that loses one pixel of whatever is drawn there.
    Canvas canvas(VN_PROFILE_STANDARD, 2);
    const auto fails = [&canvas](const Soup& soup) { return canvas.count(soup)[20 * kSize + 41] != 0; };
    const Soup soup = triangulation(7);
    ASSERT_TRUE(fails(soup));
    ASSERT_GT(soup.size(), 3u);
    const Soup small = shrink(soup, fails);
    ASSERT_EQ(canvas.error(), "");
    EXPECT_TRUE(fails(small));
    ASSERT_EQ(small.size(), 1u);
    for (const Position& p : small[0]) {
        for (const float c : p) EXPECT_EQ(c * 4, static_cast<float>(static_cast<int>(c * 4))) << literal(small);
    }
}

TEST(Shrink, APairIsLeftWhereItTakesTwo) {
    // Planted: a law that overlapping triangles break.
    Canvas canvas(VN_PROFILE_STANDARD, 2);
    const auto fails = [&canvas](const Soup& soup) {
        return std::ranges::any_of(canvas.count(soup), [](float n) { return n > 1; });
    };
    const Soup soup = heap(3);
    ASSERT_TRUE(fails(soup));
    const Soup small = shrink(soup, fails);
    EXPECT_TRUE(fails(small));
    EXPECT_EQ(small.size(), 2u) << literal(small);
}

TEST(Shrink, WhatMattersStays) {
    // Planted: fails for a small w, whatever else there is.
    const auto fails = [](const Soup& soup) {
        return std::ranges::any_of(soup, [](const Triangle& t) { return t[1][3] > 0 && t[1][3] < 0.01f; });
    };
    Soup soup = heap(11);
    soup.push_back({{{0.3f, 0.7f, 0.1f, 1.7f}, {0.123f, 5.5f, 0.25f, 0.00987f}, {3, 4, 5, 6}}});
    const Soup small = shrink(soup, fails);
    EXPECT_EQ(literal(small), "Soup{{{{0, 0, 0, 0}, {0, 0, 0, 0x1p-7f}, {0, 0, 0, 0}}}}");
}

TEST(Shrink, SharedVerticesMoveTogether) {
    // Planted: fails while two triangles share an edge.
    const auto fails = [](const Soup& soup) {
        return soup.size() == 2 && soup[0][1] == soup[1][1] && soup[0][2] == soup[1][2] && soup[0][1] != soup[0][2];
    };
    const Position a{0.3f, 0.7f, 0.5f, 1}, b{0.9f, 0.11f, 0.5f, 1}, c{0.2f, 0.4f, 0.5f, 1}, d{0.6f, 0.8f, 0.5f, 1};
    const Soup small = shrink({{{a, b, c}}, {{d, b, c}}}, fails);
    ASSERT_TRUE(fails(small));
    EXPECT_EQ(small[0][0], (Position{0, 0, 0, 0}));
}

TEST(Shrink, TheBudgetIsKept) {
    size_t asked = 0;
    const Soup soup = heap(5);
    const Soup small = shrink(
        soup,
        [&asked](const Soup&) {
            ++asked;
            return true;
        },
        10);
    EXPECT_LE(asked, 10u);
    EXPECT_LE(small.size(), soup.size());
}

TEST(Shrink, LiteralsReadBack) {
    EXPECT_EQ(literal(Soup{{{{0.5f, -1, 0, 1}, {-0.0f, 3, 0.1f, 2}, {1e9f, 0, 0, 1}}}}),
              "Soup{{{{0x1p-1f, -1, 0, 1}, {-0x0p+0f, 3, 0x1.99999ap-4f, 2}, {0x1.dcd65p+29f, 0, 0, 1}}}}");
}

}  // namespace
}  // namespace vernier::stability
