#include "conformance/oracle/encode.h"

#include <mpfr.h>

#include <algorithm>

namespace vernier::conformance::exact {

namespace {

Rational clamp(const Rational& value, const Rational& low, const Rational& high) {
    return value < low ? low : value > high ? high : value;
}

uint64_t maskOf(unsigned bits) {
    return bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
}

// A number on the scale of codes: the codes around it, in two's complement of the component's width.
CodeSet around(const Rational& scaled, unsigned bits) {
    const auto code = [bits](const Integer& value) { return static_cast<uint64_t>(toInt64(value)) & maskOf(bits); };
    return {code(floorOf(scaled)), code(ceilOf(scaled)), code(roundHalfEven(scaled))};
}

CodeSet encodeSrgb(const Rational& value, unsigned bits) {
    const Rational x = clamp(value, 0, 1);
    const Integer top(static_cast<unsigned long>(maskOf(bits)));
    Integer low = 0, high = top;  // the largest code whose value does not exceed x
    while (low < high) {
        const Integer middle = (low + high + 1) / 2;
        if (srgbReaches(x, Rational(middle) / Rational(top))) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    const auto code = [](const Integer& v) { return static_cast<uint64_t>(toInt64(v)); };
    if (low == top) return {code(low), code(low), code(low)};
    // Codes 0 and max are met by 0 and 1 alone; any other hit on a code needs the linear segment.
    const Rational atLow = Rational(low) / Rational(top);
    if (x <= fraction(31308, 10000000) && x * fraction(1292, 100) == atLow) return {code(low), code(low), code(low)};
    const Rational half = (Rational(low) + fraction(1, 2)) / Rational(top);
    return {code(low), code(low + 1), srgbReaches(x, half) ? code(low + 1) : code(low)};
}

CodeSet encodeFloat(const Rational& value, const FloatLayout& layout, bool hasSign) {
    if (value < 0 && !hasSign) return {0, 0, 0};
    const Rational magnitude = abs(value);
    const uint64_t infinity = maskOf(static_cast<unsigned>(layout.exponentBits)) << layout.mantissaBits;
    uint64_t below = 0, above = 0, nearest = 0;
    if (magnitude != 0) {
        const int exponent = std::max(floorLog2(magnitude), layout.minExponent());
        if (exponent > layout.maxExponent()) {
            below = infinity - 1;
            above = nearest = infinity;
        } else {
            // Codes of one sign are consecutive integers in the order of their values, across exponents as
            // well.
            const Rational quanta = magnitude / powerOfTwo(exponent - layout.mantissaBits);
            const uint64_t base = static_cast<uint64_t>(exponent - layout.minExponent()) << layout.mantissaBits;
            below = base + static_cast<uint64_t>(toInt64(floorOf(quanta)));
            above = base + static_cast<uint64_t>(toInt64(ceilOf(quanta)));
            nearest = base + static_cast<uint64_t>(toInt64(roundHalfEven(quanta)));
        }
    }
    if (value >= 0) return {below, above, nearest};
    const uint64_t sign = uint64_t{1} << (layout.exponentBits + layout.mantissaBits);
    return {sign | above, sign | below, sign | nearest};
}

Rational decodeSrgb(const Rational& encoded) {
    if (encoded <= fraction(4045, 100000)) return encoded / fraction(1292, 100);
    mpfr_t base, exponent;
    mpfr_init2(base, 256);
    mpfr_init2(exponent, 256);
    const Rational shifted = (encoded + fraction(55, 1000)) / fraction(1055, 1000);
    mpfr_set_q(base, shifted.get_mpq_t(), MPFR_RNDN);
    mpfr_set_ui(exponent, 12, MPFR_RNDN);
    mpfr_div_ui(exponent, exponent, 5, MPFR_RNDN);
    mpfr_pow(base, base, exponent, MPFR_RNDN);
    const double result = mpfr_get_d(base, MPFR_RNDN);
    mpfr_clear(base);
    mpfr_clear(exponent);
    return rational(result);
}

constexpr int kSharedMantissa = 9, kSharedBias = 15;

}  // namespace

bool srgbReaches(const Rational& linear, const Rational& encoded) {
    if (linear <= fraction(31308, 10000000)) return linear * fraction(1292, 100) >= encoded;
    return power(linear, 5) >= power((encoded + fraction(55, 1000)) / fraction(1055, 1000), 12);
}

CodeSet encode(const Component& component, const Rational& value) {
    const unsigned bits = component.bits;
    switch (component.encoding) {
        case Encoding::unorm:
            return around(clamp(value, 0, 1) * Rational(Integer(static_cast<unsigned long>(maskOf(bits)))), bits);
        case Encoding::snorm:
            return around(clamp(value, -1, 1) * Rational(Integer(static_cast<unsigned long>(maskOf(bits - 1)))), bits);
        case Encoding::srgb:
            return encodeSrgb(value, bits);
        case Encoding::uint:
        case Encoding::sint:
            return around(value, bits);
        case Encoding::sfloat:
            return encodeFloat(value, floatLayout(static_cast<int>(bits)), true);
        default:
            return encodeFloat(value, floatLayout(static_cast<int>(bits)), false);
    }
}

std::optional<Rational> decode(const Component& component, uint64_t code) {
    const unsigned bits = component.bits;
    const auto integer = [](uint64_t v) { return Rational(Integer(static_cast<unsigned long>(v))); };
    const auto signedCode = [&] {
        const bool negative = (code >> (bits - 1)) & 1;
        return Rational(Integer(
            static_cast<long>(negative ? static_cast<int64_t>(code | ~maskOf(bits)) : static_cast<int64_t>(code))));
    };
    switch (component.encoding) {
        case Encoding::unorm:
            return Rational(integer(code) / integer(maskOf(bits)));
        case Encoding::snorm:
            return std::max(Rational(-1), Rational(signedCode() / integer(maskOf(bits - 1))));
        case Encoding::srgb:
            return decodeSrgb(Rational(integer(code) / integer(maskOf(bits))));
        case Encoding::uint:
            return integer(code);
        case Encoding::sint:
            return signedCode();
        default:
            break;
    }
    const FloatLayout layout = floatLayout(static_cast<int>(bits));
    const uint64_t mantissa = code & maskOf(static_cast<unsigned>(layout.mantissaBits));
    const int field =
        static_cast<int>((code >> layout.mantissaBits) & maskOf(static_cast<unsigned>(layout.exponentBits)));
    if (field == (1 << layout.exponentBits) - 1) return std::nullopt;
    const bool negative =
        component.encoding == Encoding::sfloat && ((code >> (layout.exponentBits + layout.mantissaBits)) & 1);
    const uint64_t significand = field == 0 ? mantissa : mantissa | (uint64_t{1} << layout.mantissaBits);
    const int exponent = layout.minExponent() + std::max(field, 1) - 1 - layout.mantissaBits;
    const Rational value = integer(significand) * powerOfTwo(exponent);
    return negative ? Rational(-value) : value;
}

uint32_t encodeSharedExponent(const std::array<Rational, 3>& rgb) {
    const Rational largest = fraction(511, 512) * powerOfTwo(31 - kSharedBias);
    std::array<Rational, 3> c;
    for (size_t i = 0; i < 3; ++i) c[i] = clamp(rgb[i], 0, largest);
    const Rational top = std::max({c[0], c[1], c[2]});
    int exponent = top == 0 ? 0 : std::max(-kSharedBias - 1, floorLog2(top)) + 1 + kSharedBias;
    const auto mantissa = [&exponent](const Rational& v) {
        return toInt64(floorOf(v * powerOfTwo(kSharedBias + kSharedMantissa - exponent) + fraction(1, 2)));
    };
    if (mantissa(top) == (1 << kSharedMantissa)) ++exponent;
    uint32_t code = static_cast<uint32_t>(exponent) << 27;
    for (size_t i = 0; i < 3; ++i) code |= static_cast<uint32_t>(mantissa(c[i])) << (9 * i);
    return code;
}

std::array<Rational, 3> decodeSharedExponent(uint32_t code) {
    const int exponent = static_cast<int>(code >> 27) - kSharedBias - kSharedMantissa;
    std::array<Rational, 3> rgb;
    for (size_t i = 0; i < 3; ++i) {
        rgb[i] = Rational(static_cast<unsigned>((code >> (9 * i)) & 511)) * powerOfTwo(exponent);
    }
    return rgb;
}

}  // namespace vernier::conformance::exact
