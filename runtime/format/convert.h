// Conversions of single components, exact; the definition that the SIMD versions (convert-inl.h) are tested
// against. The rules are stated in format.h. Rounding relies on the default floating-point environment (round
// to nearest even).
#pragma once

#include <bit>
#include <cstdint>

#include "runtime/format/srgb.h"

namespace vernier {

constexpr uint32_t lowBits(uint32_t bits) {
    return bits >= 32 ? ~0u : (1u << bits) - 1;
}

constexpr int32_t signExtend(uint32_t value, uint32_t bits) {
    return static_cast<int32_t>(value << (32 - bits)) >> (32 - bits);
}

/// Nearest integer, ties to even, for |x| < 2^51.
inline double roundToEven(double x) {
    constexpr double kMagic = 0x1.8p52;
    return (x + kMagic) - kMagic;
}

/// NaN gives `low`.
inline float clampOrLow(float x, float low, float high) {
    return x > low ? (x < high ? x : high) : low;
}

inline float decodeUnorm(uint32_t code, uint32_t bits) {
    return static_cast<float>(code) / static_cast<float>(lowBits(bits));
}

/// bits <= 24: the product of two 24-bit numbers is exact in double.
inline uint32_t encodeUnorm(float x, uint32_t bits) {
    return static_cast<uint32_t>(roundToEven(double{clampOrLow(x, 0.0f, 1.0f)} * lowBits(bits)));
}

inline float decodeSnorm(uint32_t code, uint32_t bits) {
    const float x = static_cast<float>(signExtend(code, bits)) / static_cast<float>(lowBits(bits - 1));
    return x > -1.0f ? x : -1.0f;
}

inline uint32_t encodeSnorm(float x, uint32_t bits) {
    if (x != x) return 0;
    const double product = double{clampOrLow(x, -1.0f, 1.0f)} * lowBits(bits - 1);
    return static_cast<uint32_t>(static_cast<int32_t>(roundToEven(product))) & lowBits(bits);
}

inline uint32_t encodeUint(uint32_t value, uint32_t bits) {
    return value < lowBits(bits) ? value : lowBits(bits);
}

inline uint32_t encodeSint(int32_t value, uint32_t bits) {
    const auto high = static_cast<int32_t>(lowBits(bits - 1)), low = -high - 1;
    return static_cast<uint32_t>(value < low ? low : value > high ? high : value) & lowBits(bits);
}

inline uint32_t encodeUscaled(float x, uint32_t bits) {
    return static_cast<uint32_t>(roundToEven(clampOrLow(x, 0.0f, static_cast<float>(lowBits(bits)))));
}

inline uint32_t encodeSscaled(float x, uint32_t bits) {
    if (x != x) return 0;
    const auto high = static_cast<float>(lowBits(bits - 1));
    return static_cast<uint32_t>(static_cast<int32_t>(roundToEven(clampOrLow(x, -high - 1, high)))) & lowBits(bits);
}

// Small floats: 5 bits of exponent (bias 15) over `mantissa` bits; 10 with a sign for half, 6 and 5 without.

/// Exact; the bits of a NaN are kept.
inline float decodeSmallFloat(uint32_t code, uint32_t mantissa) {
    const uint32_t exponent = code >> mantissa, fraction = code & lowBits(mantissa);
    if (exponent == 31) return std::bit_cast<float>(0x7f800000u | fraction << (23 - mantissa));
    if (exponent == 0) {
        return static_cast<float>(fraction) * std::bit_cast<float>((127u - 14u - mantissa) << 23);
    }
    return std::bit_cast<float>((exponent + 127 - 15) << 23 | fraction << (23 - mantissa));
}

/// `x` is positive or NaN, its sign bit clear.
inline uint32_t encodeSmallFloat(float x, uint32_t mantissa, bool overflowToInfinity) {
    const uint32_t bits = std::bit_cast<uint32_t>(x), shift = 23 - mantissa, infinity = 31u << mantissa;
    if (bits > 0x7f800000u) return infinity | 1u << (mantissa - 1) | (bits >> shift & lowBits(mantissa));
    if (bits == 0x7f800000u) return infinity;
    if (bits < 113u << 23) {  // below 2^-14: let the addition round to a multiple of the smallest denormal
        const uint32_t magic = (127u + 9u - mantissa) << 23;
        return std::bit_cast<uint32_t>(x + std::bit_cast<float>(magic)) - magic;
    }
    const uint32_t rounded = (bits - (112u << 23) + lowBits(shift - 1) + (bits >> shift & 1)) >> shift;
    return rounded < infinity ? rounded : infinity - (overflowToInfinity ? 0 : 1);
}

inline float decodeHalf(uint32_t code) {
    const uint32_t sign = (code & 0x8000u) << 16;
    return std::bit_cast<float>(std::bit_cast<uint32_t>(decodeSmallFloat(code & 0x7fffu, 10)) | sign);
}

inline uint32_t encodeHalf(float x) {
    const uint32_t bits = std::bit_cast<uint32_t>(x);
    return (bits >> 16 & 0x8000u) | encodeSmallFloat(std::bit_cast<float>(bits & 0x7fffffffu), 10, true);
}

inline float decodeUfloat(uint32_t code, uint32_t bits) {
    return decodeSmallFloat(code, bits - 5);
}

inline uint32_t encodeUfloat(float x, uint32_t bits) {
    const uint32_t magnitude = std::bit_cast<uint32_t>(x) & 0x7fffffffu;
    if (x <= 0.0f) return 0;
    return encodeSmallFloat(std::bit_cast<float>(magnitude), bits - 5, false);
}

}  // namespace vernier
