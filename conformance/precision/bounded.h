// A value with the greatest error that Vulkan permits it to have: the precisions of the Vulkan specification,
// "Precision and Operation of SPIR-V Instructions" (single precision), as arithmetic. An instruction whose precision is
// "inherited from" a formula has the error that the formula has in this type.
// The conditions are free of branches, so that loops over these functions can be vectorised.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vernier::precision {

/// The distance of the two numbers around x ("ULP" in the specification) of a format with so many fraction bits and
/// normal numbers from 2^(1 - bias) to 2^(bias + 1).
template <uint32_t kFraction, uint32_t kBias>
double ulpOfFormat(double x) {
    // By the exponent's bits, kept within the normal range.
    const uint64_t exponent =
        std::clamp<uint64_t>(std::bit_cast<uint64_t>(x) >> 52 & 0x7FF, 1023 + 1 - kBias, 1023 + kBias);
    return std::bit_cast<double>((exponent - kFraction) << 52);
}
inline double floatUlp(double x) {
    return ulpOfFormat<23, 127>(x);
}
inline double halfUlp(double x) {
    return ulpOfFormat<10, 15>(x);
}

struct Bounded {
    double value = 0, error = 0;

    Bounded(double exact) : value(exact) {}
    Bounded(double v, double e) : value(v), error(e) {}
};

inline constexpr double kUnknown = std::numeric_limits<double>::infinity();
inline constexpr double kLn2 = 0.693147180559945309;

// "Correctly rounded" leaves the direction open: an error below one ULP.
inline Bounded rounded(double value, double error) {
    return {value, error + floatUlp(std::fabs(value) + error)};
}
inline Bounded operator-(const Bounded& a) {
    return {-a.value, a.error};
}
inline Bounded operator+(const Bounded& a, const Bounded& b) {
    return rounded(a.value + b.value, a.error + b.error);
}
inline Bounded operator-(const Bounded& a, const Bounded& b) {
    return a + -b;
}
inline Bounded operator*(const Bounded& a, const Bounded& b) {
    return rounded(a.value * b.value, std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error);
}
/// 2.5 ULP for divisors in [2^-126, 2^126].
inline Bounded operator/(const Bounded& a, const Bounded& b) {
    const double quotient = a.value / b.value, least = std::fabs(b.value) - b.error;
    const bool stated = (least >= 0x1p-126) & (std::fabs(b.value) + b.error <= 0x1p126);
    const double error = (a.error + std::fabs(quotient) * b.error) / least;
    return {quotient, stated ? error + 2.5 * floatUlp(std::fabs(quotient) + error) : kUnknown};
}
inline Bounded inversesqrt(const Bounded& x) {
    const double value = 1 / std::sqrt(x.value);
    const double error = 1 / std::sqrt(x.value - x.error) - value;
    return {value, x.value - x.error > 0 ? error + 2 * floatUlp(value + error) : kUnknown};
}
inline Bounded sqrt(const Bounded& x) {
    const Bounded root = Bounded(1) / inversesqrt(x);
    const bool zero = (x.value == 0) & (x.error == 0);
    return {zero ? 0 : root.value, zero ? 0 : root.error};
}
inline Bounded exp2(const Bounded& x) {
    const double value = std::exp2(x.value), error = value * std::expm1(kLn2 * x.error);
    return {value, error + (3 + 2 * std::fabs(x.value)) * floatUlp(value + error)};
}
inline Bounded exp(const Bounded& x) {
    const double value = std::exp(x.value), error = value * std::expm1(x.error);
    return {value, error + (3 + 2 * std::fabs(x.value)) * floatUlp(value + error)};
}
/// 2^-21 in [1/2, 2], else 3 ULP.
inline double logPrecision(double x, double value) {
    return ((x >= 0.5) & (x <= 2)) ? 0x1p-21 : 3 * floatUlp(value);
}
inline Bounded log(const Bounded& x) {
    const double value = std::log(x.value);
    const double error = value - std::log(x.value - x.error) + logPrecision(x.value, value);
    return {value, x.value - x.error > 0 ? error : kUnknown};
}
inline Bounded log2(const Bounded& x) {
    const double value = std::log2(x.value);
    const double error = value - std::log2(x.value - x.error) + logPrecision(x.value, value);
    return {value, x.value - x.error > 0 ? error : kUnknown};
}
/// 2^-11 in [-pi, pi].
inline Bounded sin(const Bounded& x) {
    return {std::sin(x.value), std::fabs(x.value) <= M_PI ? 0x1p-11 + x.error : kUnknown};
}
inline Bounded cos(const Bounded& x) {
    return {std::cos(x.value), std::fabs(x.value) <= M_PI ? 0x1p-11 + x.error : kUnknown};
}
/// 4096 ULP.
inline Bounded atan2(const Bounded& y, const Bounded& x) {
    const double value = std::atan2(y.value, x.value), square = x.value * x.value + y.value * y.value;
    const double slope = (std::fabs(x.value) * y.error + std::fabs(y.value) * x.error) / square;
    const double error = x.error + y.error > 0 ? slope : 0;
    return {value, error < M_PI ? error + 4096 * floatUlp(value) : kUnknown};
}
inline Bounded atan(const Bounded& x) {
    return atan2(x, Bounded(1));
}
inline Bounded pow(const Bounded& x, const Bounded& y) {
    return exp2(y * log2(x));
}
inline Bounded unitClamp(const Bounded& x) {
    return {std::clamp(x.value, 0.0, 1.0), x.error};
}

}  // namespace vernier::precision
