// The formats of operands and results.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "conformance/precision/bounded.h"

namespace vernier::precision {

/// What the 32 or 64 bits of an operand or of a result are.
enum class Word : uint8_t {
    float32,
    float16,  // operands: a code in the low half; results: a float that is a half's value
    int32,
    uint32,
    float64,
    int64,
    uint64,
};

/// 32-bit words that hold one.
constexpr uint32_t wordsOf(Word word) {
    return word >= Word::float64 ? 2 : 1;
}

inline double halfValue(uint32_t code) {
    const double sign = (code & 0x8000) != 0 ? -1 : 1;
    const auto exponent = static_cast<int>(code >> 10 & 31), fraction = static_cast<int>(code & 1023);
    if (exponent == 31) return fraction != 0 ? std::numeric_limits<double>::quiet_NaN() : sign * kUnknown;
    return exponent == 0 ? sign * std::ldexp(fraction, -24) : sign * std::ldexp(1024 + fraction, exponent - 25);
}

/// The number that an operand's bits stand for, and that a result's do. Integers of 64 bits are rounded.
inline double operandValue(Word word, uint64_t bits) {
    const auto low = static_cast<uint32_t>(bits);
    switch (word) {
        case Word::float32:
            return std::bit_cast<float>(low);
        case Word::float16:
            return halfValue(low);
        case Word::int32:
            return static_cast<int32_t>(low);
        case Word::uint32:
            return low;
        case Word::float64:
            return std::bit_cast<double>(bits);
        case Word::int64:
            return static_cast<double>(static_cast<int64_t>(bits));
        case Word::uint64:
            return static_cast<double>(bits);
    }
    return 0;
}
/// The format that the bits of a result are in.
constexpr Word resultFormat(Word word) {
    return word == Word::float16 ? Word::float32 : word;
}
inline double resultValue(Word word, uint64_t bits) {
    return operandValue(resultFormat(word), bits);
}

/// The distance of the two numbers of that format around x.
inline double ulpOf(Word word, double x) {
    switch (word) {
        case Word::float32:
            return floatUlp(x);
        case Word::float16:
            return halfUlp(x);
        case Word::float64:
            return doubleUlp(x);
        default:
            return 1;
    }
}

/// The exponent of the first power of two that the format lacks.
constexpr int overflowExponentOf(Word word) {
    switch (word) {
        case Word::float32:
            return 128;
        case Word::float16:
            return 16;
        case Word::int32:
            return 31;
        case Word::uint32:
            return 32;
        case Word::float64:
            return 1024;
        case Word::int64:
            return 63;
        case Word::uint64:
            return 64;
    }
    return 0;
}
/// That power; infinity for doubles.
inline double overflowOf(Word word) {
    return std::ldexp(1.0, overflowExponentOf(word));
}

/// The least normal number of a format of floats.
constexpr double leastNormalOf(Word word) {
    return word == Word::float64 ? 0x1p-1022 : word == Word::float16 ? 0x1p-14 : 0x1p-126;
}

}  // namespace vernier::precision
