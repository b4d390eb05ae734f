// The 128-bit number type, and conversions between number formats.
#include <cmath>

#include "spirv_interp/reference/number_ops.h"
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

TEST(Real, HasMoreBitsThanDouble) {
    const Real third = Real(1) / Real(3);
    const Real error = third - Real(1.0 / 3.0);
    EXPECT_NE(static_cast<double>(error), 0);
    EXPECT_LT(std::fabs(static_cast<double>(third * Real(3) - Real(1))), 0x1p-127);
    EXPECT_EQ(static_cast<double>((Real(1) + ldexp(Real(1), -120)) - Real(1)), 0x1p-120);
}

TEST(Real, SpecialValues) {
    const Real inf = Real(1) / Real(0), nan = inf - inf, negativeZero = -Real(0);
    EXPECT_TRUE(isinf(inf) && !isinf(nan) && isnan(nan));
    EXPECT_FALSE(nan == nan);
    EXPECT_FALSE(nan < Real(1) || nan > Real(1));
    EXPECT_TRUE(signbit(negativeZero) && negativeZero == Real(0));
    EXPECT_TRUE(isinf(Real(1) / negativeZero) && Real(1) / negativeZero < Real(0));
    EXPECT_TRUE(isinf(ldexp(Real(1), 30000)));
    EXPECT_TRUE(ldexp(Real(1), -30000) == Real(0));
}

TEST(Real, RoundsToFloatOnceIncludingSubnormals) {
    const Real justAboveHalf = Real(1) + ldexp(Real(1), -24) + ldexp(Real(1), -100);
    EXPECT_EQ(static_cast<float>(justAboveHalf), 1.0f + 0x1p-23f);
    EXPECT_EQ(static_cast<float>(ldexp(Real(3), -150)), 0x1p-148f);
    EXPECT_EQ(static_cast<float>(ldexp(Real(1), 128)), std::numeric_limits<float>::infinity());
}

TEST(Real, Functions) {
    int exponent = 0;
    EXPECT_EQ(static_cast<double>(frexp(Real(-10), &exponent)), -0.625);
    EXPECT_EQ(exponent, 4);
    EXPECT_EQ(static_cast<double>(fmod(Real(-7.5), Real(2))), -1.5);
    EXPECT_EQ(static_cast<double>(rint(Real(2.5))), 2);
    EXPECT_DOUBLE_EQ(static_cast<double>(atan2(Real(1), Real(-1))), std::atan2(1.0, -1.0));
    EXPECT_DOUBLE_EQ(static_cast<double>(sin(ldexp(Real(1), 100))), std::sin(0x1p100));
    EXPECT_EQ(static_cast<double>(fma(Real(3), Real(5), Real(-15))), 0);
}

TEST(Half, EveryHalfSurvivesTheRoundTrip) {
    for (uint32_t half = 0; half < 0x10000; ++half) {
        const float value = halfToFloat32(half);
        if (std::isnan(value)) continue;
        EXPECT_EQ(float32ToHalf(value), half);
    }
}

TEST(Half, RoundsToNearestEven) {
    EXPECT_EQ(float32ToHalf(1.0f + 0x1p-11f), 0x3C00u);
    EXPECT_EQ(float32ToHalf(1.0f + 3 * 0x1p-11f), 0x3C02u);
    EXPECT_EQ(float32ToHalf(65519.996f), 0x7BFFu);
    EXPECT_EQ(float32ToHalf(65520.0f), 0x7C00u);
    EXPECT_EQ(float32ToHalf(0x1p-25f), 0u);
    EXPECT_EQ(float32ToHalf(0x1.8p-25f), 1u);
    EXPECT_EQ(float32ToHalf(-0.0f), 0x8000u);
}

template <class Number>
class Conversions : public testing::Test {};
using Numbers = testing::Types<float, double, Real>;
TYPED_TEST_SUITE(Conversions, Numbers);

TYPED_TEST(Conversions, ToInteger) {
    using N = TypeParam;
    EXPECT_EQ(toInteger(N(-1.75), 32, true), 0xFFFFFFFFu);
    EXPECT_EQ(toInteger(N(-1.75), 32, false), 0u);
    EXPECT_EQ(toInteger(N(2147483648.0), 32, true), 0x7FFFFFFFu);
    EXPECT_EQ(toInteger(N(-2147483648.0), 32, true), 0x80000000u);
    EXPECT_EQ(toInteger(N(4294967296.0), 32, false), 0xFFFFFFFFu);
    EXPECT_EQ(toInteger(N(0x1p63), 64, true), 0x7FFFFFFFFFFFFFFFull);
    EXPECT_EQ(toInteger(N(0x1.8p63), 64, false), 0xC000000000000000ull);
    EXPECT_EQ(toInteger(N(-0x1.8p40), 64, true), 0xFFFFFE8000000000ull);
    EXPECT_EQ(toInteger(N(std::numeric_limits<float>::quiet_NaN()), 32, true), 0u);
    EXPECT_EQ(toInteger(N(std::numeric_limits<float>::infinity()), 64, false), ~0ull);
}

}  // namespace
}  // namespace vernier::reference::test
