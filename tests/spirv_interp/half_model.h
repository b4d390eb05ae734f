// Floats of 16 bits by exact arithmetic, for tests to compare with.
#pragma once

#include <cmath>
#include <cstdint>

namespace vernier::test {

inline double valueOf(uint16_t half) {
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    double value = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(mantissa + 1024, exponent - 25);
    if (exponent == 31) value = mantissa == 0 ? HUGE_VAL : std::nan("");
    return (half & 0x8000) != 0 ? -value : value;
}

inline bool isNan(uint16_t half) {
    return (half & 0x7FFF) > 0x7C00;
}

/// The half next to an exact value, by trying the neighbours; ties to even, or towards zero.
inline uint16_t halfOf(long double x, bool towardsZero = false) {
    if (std::isnan(x)) return 0x7E00;
    const uint16_t sign = std::signbit(x) ? 0x8000 : 0;
    const long double magnitude = std::fabs(x);
    if (std::isinf(x)) return sign | 0x7C00;
    // The largest half not above: halves are ordered like their bits.
    uint16_t below = 0;
    for (int bit = 14; bit >= 0; --bit) {
        const auto next = static_cast<uint16_t>(below | 1 << bit);
        if (next < 0x7C00 && valueOf(next) <= static_cast<double>(magnitude) && valueOf(next) <= magnitude)
            below = next;
    }
    if (towardsZero) return sign | below;
    const long double low = valueOf(below), high = below == 0x7BFF ? 65536.0L : valueOf(below + 1);
    const bool up = magnitude - low > high - magnitude || (magnitude - low == high - magnitude && (below & 1) != 0);
    return static_cast<uint16_t>(sign | (below + (up ? 1 : 0)));
}

}  // namespace vernier::test
