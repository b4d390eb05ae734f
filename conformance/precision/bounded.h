// A value with the greatest error that Vulkan permits it to have: the precisions of the Vulkan specification,
// "Precision and Operation of SPIR-V Instructions" (single precision), as arithmetic. An instruction whose precision is
// "inherited from" a formula has the error that the formula has in this type.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vernier::precision {

/// The distance of the two floats around x ("ULP" in the specification).
inline double floatUlp(double x) {
    // By the exponent's bits, kept within float's normal range.
    const uint64_t exponent = std::clamp<uint64_t>(std::bit_cast<uint64_t>(x) >> 52 & 0x7FF, 1023 - 126, 1023 + 127);
    return std::bit_cast<double>((exponent - 23) << 52);
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
    if (!(least >= 0x1p-126 && std::fabs(b.value) + b.error <= 0x1p126)) return {quotient, kUnknown};
    const double error = (a.error + std::fabs(quotient) * b.error) / least;
    return {quotient, error + 2.5 * floatUlp(std::fabs(quotient) + error)};
}
inline Bounded inversesqrt(const Bounded& x) {
    const double value = 1 / std::sqrt(x.value);
    if (!(x.value - x.error > 0)) return {value, kUnknown};
    const double error = 1 / std::sqrt(x.value - x.error) - value;
    return {value, error + 2 * floatUlp(value + error)};
}
inline Bounded sqrt(const Bounded& x) {
    Bounded root = Bounded(1) / inversesqrt(x);
    if (x.value == 0 && x.error == 0) root = {0, 0};
    return root;
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
    return x >= 0.5 && x <= 2 ? 0x1p-21 : 3 * floatUlp(value);
}
inline Bounded log(const Bounded& x) {
    const double value = std::log(x.value);
    if (!(x.value - x.error > 0)) return {value, kUnknown};
    return {value, value - std::log(x.value - x.error) + logPrecision(x.value, value)};
}
inline Bounded log2(const Bounded& x) {
    const double value = std::log2(x.value);
    if (!(x.value - x.error > 0)) return {value, kUnknown};
    return {value, value - std::log2(x.value - x.error) + logPrecision(x.value, value)};
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
    double error = 0;
    if (x.error + y.error > 0) error = (std::fabs(x.value) * y.error + std::fabs(y.value) * x.error) / square;
    if (!(error < M_PI)) return {value, kUnknown};
    return {value, error + 4096 * floatUlp(value)};
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
