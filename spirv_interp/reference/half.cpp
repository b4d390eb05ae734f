#include <cmath>

#include "spirv_interp/reference/number_ops.h"

namespace vernier::reference {

uint32_t doubleToHalf(double value, bool towardsZero) {
    const auto whole = [=](double x) { return towardsZero ? std::trunc(x) : std::nearbyint(x); };
    const uint32_t sign = std::signbit(value) ? 0x8000u : 0u;
    if (std::isnan(value)) return sign | 0x7E00u;
    const double magnitude = std::fabs(value);
    // 65520 is half-way between the largest half, 65504, and the next power of two.
    if (std::isinf(value) || (magnitude >= 65520.0 && !towardsZero)) return sign | 0x7C00u;
    if (magnitude >= 65504.0) return sign | 0x7BFFu;
    if (magnitude < 0x1p-14) return sign | static_cast<uint32_t>(whole(magnitude * 0x1p24));
    const int exponent = std::ilogb(magnitude);
    const auto significand = static_cast<uint32_t>(whole(std::ldexp(magnitude, 10 - exponent)));
    // A significand rounded up to 2048 carries into the exponent.
    return sign | ((static_cast<uint32_t>(exponent + 15) << 10) + significand - 1024u);
}

uint32_t float32ToHalf(float value) {
    return doubleToHalf(value);
}

float halfToFloat32(uint32_t half) {
    const float sign = (half & 0x8000u) != 0 ? -1.0f : 1.0f;
    const int exponent = static_cast<int>((half >> 10) & 31u);
    const auto fraction = static_cast<float>(half & 1023u);
    if (exponent == 31)
        return fraction != 0 ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
    if (exponent == 0) return sign * std::ldexp(fraction, -24);
    return sign * std::ldexp(1024.0f + fraction, exponent - 25);
}

float quantizeToHalf(float value) {
    const uint32_t half = float32ToHalf(value);
    return halfToFloat32((half & 0x7C00u) == 0 ? half & 0x8000u : half);
}

}  // namespace vernier::reference
