// Scalar conversions against exact arithmetic: MPFR for the sRGB curve, integers for the rest.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/format/convert.h"
#include "runtime/format/format.h"

namespace vernier {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float nextUp(float x) {
    return std::nextafter(x, kInf);
}
float nextDown(float x) {
    return std::nextafter(x, -kInf);
}

/// The sRGB decoding curve at numerator / denominator, to 200 bits.
class Curve {
  public:
    Curve(unsigned long numerator, unsigned long denominator) {
        mpfr_init2(value_, 200);
        mpfr_set_ui(value_, numerator, MPFR_RNDN);
        mpfr_div_ui(value_, value_, denominator, MPFR_RNDN);
        if (numerator * 100000 <= denominator * 4045) {
            mpfr_mul_ui(value_, value_, 100, MPFR_RNDN);
            mpfr_div_ui(value_, value_, 1292, MPFR_RNDN);
            return;
        }
        mpfr_t exponent;
        mpfr_init2(exponent, 200);
        mpfr_set_ui(exponent, 12, MPFR_RNDN);
        mpfr_div_ui(exponent, exponent, 5, MPFR_RNDN);
        mpfr_mul_ui(value_, value_, 1000, MPFR_RNDN);
        mpfr_add_ui(value_, value_, 55, MPFR_RNDN);
        mpfr_div_ui(value_, value_, 1055, MPFR_RNDN);
        mpfr_pow(value_, value_, exponent, MPFR_RNDN);
        mpfr_clear(exponent);
    }
    ~Curve() { mpfr_clear(value_); }
    Curve(const Curve&) = delete;
    Curve& operator=(const Curve&) = delete;

    float nearest() const { return mpfr_get_flt(value_, MPFR_RNDN); }
    float above() const { return mpfr_get_flt(value_, MPFR_RNDU); }

  private:
    mpfr_t value_;
};

TEST(Srgb, DecodesAllCodesToTheNearestFloat) {
    for (unsigned code = 0; code < 256; ++code) {
        EXPECT_EQ(kSrgbToLinear[code], Curve(code, 255).nearest()) << code;
    }
}

TEST(Srgb, EncodesToTheNearestCodeAroundAllThresholds) {
    for (unsigned code = 0; code < 255; ++code) {
        const float first = Curve(2 * code + 1, 510).above();  // where code + 1 becomes nearest
        float below = first, above = first;
        for (int step = 0; step < 1000; ++step) {
            EXPECT_EQ(encodeSrgb8(above), code + 1) << above;
            above = nextUp(above);
            below = nextDown(below);
            EXPECT_EQ(encodeSrgb8(below), code) << below;
        }
        EXPECT_EQ(encodeSrgb8(kSrgbToLinear[code]), code);
    }
    EXPECT_EQ(encodeSrgb8(kSrgbToLinear[255]), 255u);
}

TEST(Srgb, EncodeIsMonotoneAndClamps) {
    uint32_t last = 0;
    for (uint32_t bits = 0; bits <= 0x3f800000u; bits += 61) {
        const uint32_t code = encodeSrgb8(std::bit_cast<float>(bits));
        ASSERT_TRUE(code == last || code == last + 1) << std::hex << bits;
        last = code;
    }
    EXPECT_EQ(encodeSrgb8(1.0f), 255u);
    EXPECT_EQ(encodeSrgb8(kInf), 255u);
    EXPECT_EQ(encodeSrgb8(-kInf), 0u);
    EXPECT_EQ(encodeSrgb8(-0.5f), 0u);
    EXPECT_EQ(encodeSrgb8(kNaN), 0u);
    EXPECT_EQ(encodeSrgb8(std::numeric_limits<float>::denorm_min()), 0u);
}

/// x = mantissa * 2^exponent exactly.
struct Exact {
    int64_t mantissa;
    int exponent;
    explicit Exact(float x) {
        const float scaled = std::frexp(x, &exponent);
        mantissa = static_cast<int64_t>(std::ldexp(scaled, 24));
        exponent -= 24;
    }
};

/// round-half-even(x * scale) in integers, for 0 <= x <= 1.
int64_t roundExact(float x, int64_t scale) {
    const Exact e(x);
    const __int128 product = static_cast<__int128>(e.mantissa) * scale;
    const int shift = -e.exponent;
    if (shift > 100) return 0;
    const __int128 one = static_cast<__int128>(1) << shift, whole = product / one, rest = product % one;
    const bool up = rest * 2 > one || (rest * 2 == one && whole % 2 != 0);
    return static_cast<int64_t>(whole) + (up ? 1 : 0);
}

TEST(Unorm, DecodesToTheNearestFloat) {
    for (const uint32_t bits : {1u, 2u, 4u, 5u, 6u, 8u, 10u, 16u, 24u}) {
        const uint32_t max = lowBits(bits);
        for (uint32_t code = 0; code <= max; code += bits == 24 ? 37 : 1) {
            mpfr_t quotient;
            mpfr_init2(quotient, 24);
            mpfr_set_ui(quotient, code, MPFR_RNDN);
            mpfr_div_ui(quotient, quotient, max, MPFR_RNDN);
            ASSERT_EQ(decodeUnorm(code, bits), mpfr_get_flt(quotient, MPFR_RNDN)) << code << "/" << max;
            mpfr_clear(quotient);
            ASSERT_EQ(encodeUnorm(decodeUnorm(code, bits), bits), code);
        }
    }
}

TEST(Unorm, EncodesTheExactProductToNearestEven) {
    for (const uint32_t bits : {1u, 2u, 4u, 5u, 6u, 8u, 10u, 16u, 24u}) {
        const uint32_t max = lowBits(bits);
        for (uint32_t code = 0; code < max; code += bits == 24 ? 997 : 1) {
            float x = static_cast<float>((code + 0.5) / max);  // the floats around each rounding boundary
            x = nextDown(nextDown(nextDown(x)));
            for (int i = 0; i < 7; ++i, x = nextUp(x)) {
                if (x < 0) continue;
                ASSERT_EQ(encodeUnorm(x, bits), roundExact(x, max)) << x << " at " << bits << " bits";
            }
        }
        EXPECT_EQ(encodeUnorm(kNaN, bits), 0u);
        EXPECT_EQ(encodeUnorm(kInf, bits), max);
        EXPECT_EQ(encodeUnorm(-kInf, bits), 0u);
        EXPECT_EQ(encodeUnorm(nextUp(1.0f), bits), max);
        EXPECT_EQ(encodeUnorm(-0.0f, bits), 0u);
    }
}

TEST(Snorm, DecodesAndEncodesSymmetrically) {
    for (const uint32_t bits : {2u, 8u, 10u, 16u}) {
        const auto max = static_cast<int32_t>(lowBits(bits - 1));
        EXPECT_EQ(decodeSnorm(static_cast<uint32_t>(-max - 1), bits), -1.0f);
        for (int32_t code = -max; code <= max; ++code) {
            const uint32_t stored = static_cast<uint32_t>(code) & lowBits(bits);
            const float value = decodeSnorm(stored, bits);
            ASSERT_EQ(value, static_cast<float>(static_cast<double>(code) / max));
            ASSERT_EQ(encodeSnorm(value, bits), stored);
            const auto middle = static_cast<float>((code + 0.5) / max);
            for (const float x : {nextDown(middle), middle, nextUp(middle)}) {
                if (std::abs(x) > 1.0f) continue;
                const int64_t expected = x < 0 ? -roundExact(-x, max) : roundExact(x, max);
                ASSERT_EQ(signExtend(encodeSnorm(x, bits), bits), expected) << x;
            }
        }
        EXPECT_EQ(encodeSnorm(kNaN, bits), 0u);
        EXPECT_EQ(signExtend(encodeSnorm(-kInf, bits), bits), -max);
        EXPECT_EQ(signExtend(encodeSnorm(kInf, bits), bits), max);
    }
}

/// The value of a small float from its definition.
double smallFloatValue(uint32_t code, int mantissa) {
    const uint32_t exponent = code >> mantissa, fraction = code & lowBits(static_cast<uint32_t>(mantissa));
    if (exponent == 0) return std::ldexp(fraction, -14 - mantissa);
    return std::ldexp(fraction + (1u << mantissa), static_cast<int>(exponent) - 15 - mantissa);
}

TEST(Half, DecodesAllCodes) {
    for (uint32_t code = 0; code < 0x10000; ++code) {
        const float value = decodeHalf(code);
        const uint32_t magnitude = code & 0x7fff;
        EXPECT_EQ(std::signbit(value), code >= 0x8000);
        if (magnitude > 0x7c00) {
            EXPECT_TRUE(std::isnan(value));
        } else if (magnitude == 0x7c00) {
            EXPECT_TRUE(std::isinf(value));
        } else {
            EXPECT_EQ(std::abs(value), smallFloatValue(magnitude, 10));
            EXPECT_EQ(encodeHalf(value), code);
        }
    }
}

template <class Encode>
void checkMiddles(int mantissa, Encode encode) {
    const uint32_t infinity = 31u << mantissa;
    for (uint32_t code = 0; code + 1 < infinity; ++code) {
        const double low = smallFloatValue(code, mantissa), high = smallFloatValue(code + 1, mantissa);
        const auto middle = static_cast<float>((low + high) / 2);  // exact
        ASSERT_EQ(encode(middle), code + (code & 1)) << code;
        ASSERT_EQ(encode(nextDown(middle)), code);
        ASSERT_EQ(encode(nextUp(middle)), code + 1);
        ASSERT_EQ(encode(static_cast<float>(low)), code);
    }
}

TEST(Half, EncodesMiddlesToEvenAndOverflowsToInfinity) {
    checkMiddles(10, [](float x) { return encodeHalf(x); });
    checkMiddles(10, [](float x) { return encodeHalf(-x) & 0x7fffu; });
    EXPECT_EQ(encodeHalf(65504.0f), 0x7bffu);
    EXPECT_EQ(encodeHalf(nextDown(65520.0f)), 0x7bffu);
    EXPECT_EQ(encodeHalf(65520.0f), 0x7c00u);
    EXPECT_EQ(encodeHalf(3e38f), 0x7c00u);
    EXPECT_EQ(encodeHalf(-kInf), 0xfc00u);
    EXPECT_EQ(encodeHalf(-0.0f), 0x8000u);
    EXPECT_GT(encodeHalf(kNaN) & 0x7fffu, 0x7c00u);
    EXPECT_GT(encodeHalf(std::bit_cast<float>(0x7f800001u)) & 0x7fffu, 0x7c00u);
}

TEST(Ufloat, AllCodesMiddlesAndLimits) {
    for (const uint32_t bits : {10u, 11u}) {
        const uint32_t mantissa = bits - 5, infinity = 31u << mantissa;
        checkMiddles(static_cast<int>(mantissa), [bits](float x) { return encodeUfloat(x, bits); });
        for (uint32_t code = 0; code < infinity; ++code) {
            EXPECT_EQ(decodeUfloat(code, bits), smallFloatValue(code, static_cast<int>(mantissa)));
        }
        EXPECT_EQ(encodeUfloat(kInf, bits), infinity);
        EXPECT_EQ(encodeUfloat(3e38f, bits), infinity - 1);
        EXPECT_EQ(encodeUfloat(-1.0f, bits), 0u);
        EXPECT_EQ(encodeUfloat(-0.0f, bits), 0u);
        EXPECT_EQ(encodeUfloat(-kInf, bits), 0u);
        EXPECT_GT(encodeUfloat(kNaN, bits), infinity);
        EXPECT_GT(encodeUfloat(-kNaN, bits), infinity);
        EXPECT_TRUE(std::isnan(decodeUfloat(infinity + 1, bits)));
    }
    EXPECT_EQ(decodeUfloat((31u << 6) - 1, 11), 65024.0f);
    EXPECT_EQ(decodeUfloat((31u << 5) - 1, 10), 64512.0f);
}

TEST(SharedExponent, FollowsTheSpecification) {
    const TexelLayout& layout = findFormat(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32)->color;
    const auto pack = [&](float r, float g, float b) {
        uint32_t texel = 0;
        packTexel(layout, {.float32 = {r, g, b, 1}}, &texel);
        return texel;
    };
    EXPECT_EQ(pack(0, 0, 0), 0u);
    EXPECT_EQ(pack(1, 0, 0), 16u << 27 | 256u);
    EXPECT_EQ(pack(65408, 0, 0), 31u << 27 | 511u);
    EXPECT_EQ(pack(kInf, -kInf, kNaN), 31u << 27 | 511u);
    // 511.5 / 512 rounds up to 512: the exponent moves.
    EXPECT_EQ(pack(511.5f / 512, 0, 0), 16u << 27 | 256u);
    EXPECT_EQ(pack(nextDown(511.5f / 512), 0, 0), 15u << 27 | 511u);
    for (uint32_t texel = 0, step = 0x9e3779b9u, i = 0; i < 200000; ++i, texel += step) {
        const VkClearColorValue value = unpackTexel(layout, &texel);
        const double unit = std::ldexp(1.0, static_cast<int>(texel >> 27) - 24);
        ASSERT_EQ(value.float32[0], (texel & 511) * unit);
        ASSERT_EQ(value.float32[2], (texel >> 18 & 511) * unit);
        ASSERT_EQ(value.float32[3], 1.0f);
        uint32_t again = 0;
        packTexel(layout, value, &again);
        const VkClearColorValue back = unpackTexel(layout, &again);  // another exponent may express the same values
        for (int c = 0; c < 3; ++c) ASSERT_EQ(back.float32[c], value.float32[c]);
    }
}

TEST(Integers, Clamp) {
    EXPECT_EQ(encodeUint(300, 8), 255u);
    EXPECT_EQ(encodeUint(~0u, 32), ~0u);
    EXPECT_EQ(encodeSint(-200, 8), 0x80u);
    EXPECT_EQ(encodeSint(200, 8), 0x7fu);
    EXPECT_EQ(encodeSint(std::numeric_limits<int32_t>::min(), 32), 0x80000000u);
    EXPECT_EQ(encodeUscaled(2.5f, 8), 2u);
    EXPECT_EQ(encodeSscaled(-3.5f, 8), 0xfcu);
    EXPECT_EQ(encodeSscaled(kNaN, 8), 0u);
}

}  // namespace
}  // namespace vernier
