// Hand-computed texel selection, filtering and level of detail.
#include "conformance/oracle/filtering.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vernier::conformance::exact {
namespace {

constexpr auto kRepeat = VK_SAMPLER_ADDRESS_MODE_REPEAT;
constexpr auto kMirror = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
constexpr auto kMirrorOnce = VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE;
constexpr auto kClamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
constexpr auto kBorder = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;

// T01, T02, T05, T06.
TEST(Texels, Wrapping) {
    EXPECT_EQ(nearestTexel(rational(3)), 3);
    EXPECT_EQ(nearestTexel(-powerOfTwo(-30) * 8), -1);
    EXPECT_EQ(wrapTexel(kRepeat, -1, 8), 7);
    EXPECT_EQ(wrapTexel(kRepeat, 8, 8), 0);
    EXPECT_EQ(wrapTexel(kRepeat, -17, 8), 7);
    EXPECT_EQ(wrapTexel(kMirror, -1, 4), 0);
    EXPECT_EQ(wrapTexel(kMirror, 4, 4), 3);
    EXPECT_EQ(wrapTexel(kMirror, 7, 4), 0);
    EXPECT_EQ(wrapTexel(kMirror, 8, 4), 0);
    EXPECT_EQ(wrapTexel(kMirror, -5, 4), 3);
    EXPECT_EQ(wrapTexel(kMirrorOnce, -1, 4), 0);
    EXPECT_EQ(wrapTexel(kMirrorOnce, -9, 4), 3);
    EXPECT_EQ(wrapTexel(kClamp, -9, 4), 0);
    EXPECT_EQ(wrapTexel(kClamp, 9, 4), 3);
    EXPECT_EQ(wrapTexel(kBorder, 4, 4), std::nullopt);
    EXPECT_EQ(wrapTexel(kBorder, 3, 4), 3);
}

// T07: weights on a grid of 2^-8.
TEST(Filter, Bilinear) {
    const auto texel = [](int64_t x, int64_t y) { return Rational((x == 1 ? 1 : 0) + (y == 1 ? 2 : 0)); };
    EXPECT_EQ(bilinear(texel, fraction(3, 2), fraction(1, 2)), 1);
    EXPECT_EQ(bilinear(texel, rational(1), rational(1)), fraction(3, 2));
    EXPECT_EQ(bilinear(texel, fraction(1, 2) + fraction(1, 3), fraction(1, 2)), fraction(1, 3));
    EXPECT_EQ(bilinear(texel, fraction(1, 2) + fraction(1, 3), fraction(1, 2), 8), fraction(85, 256));
    const FilterRange range = bilinearRange(texel, fraction(1, 2) + fraction(1, 3), fraction(1, 2), 8, 0);
    EXPECT_EQ(range.low, fraction(1, 3) - fraction(1, 256));
    EXPECT_EQ(range.high, fraction(1, 3) + fraction(1, 256) + fraction(2, 256));
}

// T08: a constant texture has one answer.
TEST(Filter, ConstantTextureIsConstant) {
    const auto texel = [](int64_t, int64_t) { return fraction(77, 255); };
    const FilterRange range = bilinearRange(texel, fraction(17, 7), fraction(5, 3), 8, fraction(1, 100));
    EXPECT_EQ(range.low, fraction(77, 255));
    EXPECT_EQ(range.high, fraction(77, 255));
}

// L04: lambda at half-integers; L07: no derivative.
TEST(Lod, NearestLevel) {
    EXPECT_EQ(nearestLevel(2).preferred, 0);
    EXPECT_EQ(nearestLevel(2).alternative, 1);
    EXPECT_EQ(nearestLevel(8).preferred, 1);
    EXPECT_EQ(nearestLevel(8).alternative, 2);
    EXPECT_EQ(nearestLevel(1).preferred, 0);
    EXPECT_EQ(nearestLevel(fraction(201, 100)).preferred, 1);
    EXPECT_EQ(nearestLevel(fraction(199, 100)).alternative, 0);
    EXPECT_EQ(nearestLevel(fraction(1, 2)).preferred, -1);
    EXPECT_EQ(nearestLevel(fraction(1, 2)).alternative, 0);
    EXPECT_FALSE(levelOfDetail(0));
}

TEST(Lod, LogarithmIsEnclosed) {
    const auto lambda = levelOfDetail(8);
    ASSERT_TRUE(lambda);
    EXPECT_LE(lambda->low, 1.5);
    EXPECT_GE(lambda->high, 1.5);
    EXPECT_LT(lambda->high - lambda->low, 1e-14);
    const Enclosure third = log2Enclosure(3);
    EXPECT_LT(third.low, third.high);
    EXPECT_NEAR(third.low, std::log2(3.0), 1e-15);
}

// L06: a rotation by 45 degrees at scale 1: ideal 1, legal between 1/sqrt 2 and sqrt 2.
TEST(Lod, RotationLeavesRoomForApproximations) {
    const Rational h = fraction(5, 7);  // near enough to the root of one half for a hand check
    const TexelDerivatives d{h, h, -h, h};
    EXPECT_EQ(squaredScale(d), fraction(50, 49));
    EXPECT_EQ(squaredScaleRange(d).low, fraction(25, 49));
    EXPECT_EQ(squaredScaleRange(d).high, fraction(100, 49));
}

}  // namespace
}  // namespace vernier::conformance::exact
