// Rounding to the numbers of binary16, one value at a time.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vernier::batch {

/// The binary16 value next to a double, as a float. A double has 42 bits more than a half; multiples of 2^-24, as
/// denormal halves are, are what the adder leaves of a sum with 2^28.
inline float halfOfMagnitude(double x, uint64_t rounded, double denormal, float tooLarge) {
    const double magnitude = std::fabs(x);
    const double value = magnitude < 0x1p-14 ? denormal : std::bit_cast<double>(rounded & ~uint64_t{0x3FFFFFFFFFF});
    const float half = value >= 0x1p16 ? tooLarge : static_cast<float>(value);
    return std::signbit(x) ? -half : half;
}
inline float nearestHalf(double x) {
    if (x - x != 0) return static_cast<float>(x);
    const double magnitude = std::fabs(x);
    const auto bits = std::bit_cast<uint64_t>(magnitude);
    return halfOfMagnitude(x, bits + 0x1FFFFFFFFFF + (bits >> 42 & 1), (magnitude + 0x1p28) - 0x1p28,
                           std::numeric_limits<float>::infinity());
}
inline float halfTowardsZero(double x) {
    if (x - x != 0) return static_cast<float>(x);
    const double magnitude = std::fabs(x);
    const double denormal = std::trunc(magnitude < 1 ? magnitude * 0x1p24 : 0.0) * 0x1p-24;
    return halfOfMagnitude(x, std::bit_cast<uint64_t>(magnitude), denormal, 65504.0f);
}

}  // namespace vernier::batch
