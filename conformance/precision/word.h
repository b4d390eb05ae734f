// The formats of operands and results.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "conformance/precision/bounded.h"

namespace vernier::precision {

/// What the 32 bits of an operand or of a result are.
enum class Word : uint8_t {
    float32,
    float16,  // operands: a code in the low half; results: a float that is a half's value
    int32,
    uint32,
};

inline double halfValue(uint32_t code) {
    const double sign = (code & 0x8000) != 0 ? -1 : 1;
    const auto exponent = static_cast<int>(code >> 10 & 31), fraction = static_cast<int>(code & 1023);
    if (exponent == 31) return fraction != 0 ? std::numeric_limits<double>::quiet_NaN() : sign * kUnknown;
    return exponent == 0 ? sign * std::ldexp(fraction, -24) : sign * std::ldexp(1024 + fraction, exponent - 25);
}

/// The number that an operand's bits stand for, and that a result's do.
inline double operandValue(Word word, uint32_t bits) {
    switch (word) {
        case Word::float32:
            return std::bit_cast<float>(bits);
        case Word::float16:
            return halfValue(bits);
        case Word::int32:
            return static_cast<int32_t>(bits);
        case Word::uint32:
            return bits;
    }
    return 0;
}
inline double resultValue(Word word, uint32_t bits) {
    return operandValue(word == Word::float16 ? Word::float32 : word, bits);
}

/// The distance of the two numbers of that format around x.
inline double ulpOf(Word word, double x) {
    return word == Word::float32 ? floatUlp(x) : word == Word::float16 ? halfUlp(x) : 1;
}

/// The first power of two that the format lacks.
inline double overflowOf(Word word) {
    switch (word) {
        case Word::float32:
            return 0x1p128;
        case Word::float16:
            return 0x1p16;
        case Word::int32:
            return 0x1p31;
        case Word::uint32:
            return 0x1p32;
    }
    return 0;
}

}  // namespace vernier::precision
