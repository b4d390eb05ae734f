// What the interpreter needs to know about a number type besides its operators: the type that functions are
// computed in, and the conversions to and from bits and integers.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "spirv_interp/reference/number.h"

namespace vernier::reference {

/// The type in which GLSL.std.450 functions are evaluated before the result is rounded to Number, once.
template <class Number>
struct WideOf;
template <>
struct WideOf<float> {
    using Type = double;
};
template <>
struct WideOf<double> {
    using Type = long double;
};
template <>
struct WideOf<Real> {
    using Type = Real;
};

template <class Number>
using Wide = typename WideOf<Number>::Type;

template <class Number>
float toFloat32(const Number& x) {
    return static_cast<float>(x);
}

template <class Number>
uint32_t float32Bits(const Number& x) {
    return std::bit_cast<uint32_t>(toFloat32(x));
}

template <class Number>
Number fromFloat32Bits(uint64_t bits) {
    return Number(std::bit_cast<float>(static_cast<uint32_t>(bits)));
}

template <class Number>
uint64_t float64Bits(const Number& x) {
    return std::bit_cast<uint64_t>(static_cast<double>(x));
}

template <class Number>
Number fromFloat64Bits(uint64_t bits) {
    return static_cast<Number>(std::bit_cast<double>(bits));
}

/// IEEE 754 binary16 from binary32, to nearest even (Vulkan spec, "16-Bit Floating-Point Numbers").
uint32_t float32ToHalf(float value);
float halfToFloat32(uint32_t half);
/// OpQuantizeToF16: what is too small for a normalised half becomes a zero of the same sign (SPIR-V specification).
float quantizeToHalf(float value);
/// From binary64 with one rounding: to nearest even, or towards zero.
uint32_t doubleToHalf(double value, bool towardsZero = false);

/// Truncates, saturates to `width` bits; NaN gives 0. Returns the two's complement bits.
template <class Number>
uint64_t toInteger(const Number& x, uint32_t width, bool isSigned) {
    using std::fabs;
    using std::isnan;
    using std::ldexp;
    using std::trunc;
    if (isnan(x)) return 0;
    const uint64_t mask = width == 64 ? ~uint64_t{0} : (uint64_t{1} << width) - 1;
    const uint64_t top = uint64_t{1} << (width - 1);
    const bool negative = x < Number(0);
    if (negative && !isSigned) return 0;
    // Magnitudes from here on; both bounds are powers of two and so exact in every number type.
    const uint64_t largest = isSigned ? (negative ? top : top - 1) : mask;
    Number magnitude = trunc(fabs(x));
    const Number bound = ldexp(Number(1), static_cast<int>(isSigned ? width - 1 : width));
    if (magnitude >= bound) return negative ? (uint64_t{0} - largest) & mask : largest;
    // Below 2^64: taken apart in 32-bit halves, each of which converts exactly.
    const Number unit = ldexp(Number(1), 32);
    const Number high = trunc(magnitude / unit);
    const Number low = magnitude - high * unit;
    const uint64_t bits =
        (static_cast<uint64_t>(static_cast<double>(high)) << 32) + static_cast<uint64_t>(static_cast<double>(low));
    return negative ? (uint64_t{0} - bits) & mask : bits;
}

template <class Number>
Number fromInteger(uint64_t bits, uint32_t width, bool isSigned) {
    if (!isSigned) return static_cast<Number>(bits);
    const uint32_t unused = 64 - width;
    return static_cast<Number>(static_cast<int64_t>(bits << unused) >> unused);
}

}  // namespace vernier::reference
