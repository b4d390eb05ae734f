// A value with the greatest error that Vulkan permits it to have: the precisions of the Vulkan specification,
// "Precision and Operation of SPIR-V Instructions", as arithmetic: of single precision, of half precision (the table's
// last column), and of double precision, which "is at least that of single precision". An instruction whose precision
// is "inherited from" a formula has the error that the formula has in this type. The conditions are free of branches,
// so that loops over these functions can be vectorised.
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
inline double doubleUlp(double x) {
    const auto exponent = static_cast<int>(std::bit_cast<uint64_t>(x) >> 52 & 0x7FF);
    return std::ldexp(1.0, std::clamp(exponent, 1, 2046) - 1023 - 52);
}

/// The numbers of the table.
struct SinglePrecision {
    static double ulp(double x) { return floatUlp(x); }
    static constexpr double kDivisorLeast = 0x1p-126, kDivisorMost = 0x1p126;
    static constexpr double kExpUlp = 3, kLogAbsolute = 0x1p-21, kSineAbsolute = 0x1p-11, kArctangentUlp = 4096;
};
struct HalfPrecision {
    static double ulp(double x) { return halfUlp(x); }
    static constexpr double kDivisorLeast = 0x1p-14, kDivisorMost = 0x1p14;
    static constexpr double kExpUlp = 1, kLogAbsolute = 0x1p-7, kSineAbsolute = 0x1p-7, kArctangentUlp = 5;
};
/// Significands as of single precision, in the range of doubles.
struct DoublePrecision : SinglePrecision {
    static double ulp(double x) { return doubleUlp(x) * 0x1p29; }
};

inline constexpr double kUnknown = std::numeric_limits<double>::infinity();
inline constexpr double kLn2 = 0.693147180559945309;

template <class Precision>
struct BoundedBy {
    double value = 0, error = 0;

    BoundedBy(double exact) : value(exact) {}
    BoundedBy(double v, double e) : value(v), error(e) {}
};
using Bounded = BoundedBy<SinglePrecision>;
using HalfBounded = BoundedBy<HalfPrecision>;
using DoubleBounded = BoundedBy<DoublePrecision>;

// "Correctly rounded" leaves the direction open: an error below one ULP.
template <class P>
BoundedBy<P> roundedBy(double value, double error) {
    return {value, error + P::ulp(std::fabs(value) + error)};
}
inline Bounded rounded(double value, double error) {
    return roundedBy<SinglePrecision>(value, error);
}
template <class P>
BoundedBy<P> operator-(const BoundedBy<P>& a) {
    return {-a.value, a.error};
}
template <class P>
BoundedBy<P> operator+(const BoundedBy<P>& a, const BoundedBy<P>& b) {
    return roundedBy<P>(a.value + b.value, a.error + b.error);
}
template <class P>
BoundedBy<P> operator-(const BoundedBy<P>& a, const BoundedBy<P>& b) {
    return a + -b;
}
template <class P>
BoundedBy<P> operator*(const BoundedBy<P>& a, const BoundedBy<P>& b) {
    return roundedBy<P>(a.value * b.value,
                        std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error);
}
/// 2.5 ULP for divisors in the stated range.
template <class P>
BoundedBy<P> operator/(const BoundedBy<P>& a, const BoundedBy<P>& b) {
    const double quotient = a.value / b.value, least = std::fabs(b.value) - b.error;
    const bool stated = (least >= P::kDivisorLeast) & (std::fabs(b.value) + b.error <= P::kDivisorMost);
    const double error = (a.error + std::fabs(quotient) * b.error) / least;
    return {quotient, stated ? error + 2.5 * P::ulp(std::fabs(quotient) + error) : kUnknown};
}
template <class P>
BoundedBy<P> floor(const BoundedBy<P>& x) {
    return {std::floor(x.value), std::floor(x.value - x.error) != std::floor(x.value + x.error) ? 1.0 : 0.0};
}
template <class P>
BoundedBy<P> inversesqrt(const BoundedBy<P>& x) {
    const double value = 1 / std::sqrt(x.value);
    const double error = 1 / std::sqrt(x.value - x.error) - value;
    return {value, x.value - x.error > 0 ? error + 2 * P::ulp(value + error) : kUnknown};
}
template <class P>
BoundedBy<P> sqrt(const BoundedBy<P>& x) {
    const BoundedBy<P> root = BoundedBy<P>(1) / inversesqrt(x);
    const bool zero = (x.value == 0) & (x.error == 0);
    return {zero ? 0 : root.value, zero ? 0 : root.error};
}
template <class P>
BoundedBy<P> exp2(const BoundedBy<P>& x) {
    const double value = std::exp2(x.value), error = value * std::expm1(kLn2 * x.error);
    return {value, error + (P::kExpUlp + 2 * std::fabs(x.value)) * P::ulp(value + error)};
}
template <class P>
BoundedBy<P> exp(const BoundedBy<P>& x) {
    const double value = std::exp(x.value), error = value * std::expm1(x.error);
    return {value, error + (P::kExpUlp + 2 * std::fabs(x.value)) * P::ulp(value + error)};
}
/// An absolute error in [1/2, 2], else 3 ULP.
template <class P>
double logPrecision(double x, double value) {
    return ((x >= 0.5) & (x <= 2)) ? P::kLogAbsolute : 3 * P::ulp(value);
}
template <class P>
BoundedBy<P> log(const BoundedBy<P>& x) {
    const double value = std::log(x.value);
    const double error = value - std::log(x.value - x.error) + logPrecision<P>(x.value, value);
    return {value, x.value - x.error > 0 ? error : kUnknown};
}
template <class P>
BoundedBy<P> log2(const BoundedBy<P>& x) {
    const double value = std::log2(x.value);
    const double error = value - std::log2(x.value - x.error) + logPrecision<P>(x.value, value);
    return {value, x.value - x.error > 0 ? error : kUnknown};
}
/// An absolute error in [-pi, pi].
template <class P>
BoundedBy<P> sin(const BoundedBy<P>& x) {
    return {std::sin(x.value), std::fabs(x.value) <= M_PI ? P::kSineAbsolute + x.error : kUnknown};
}
template <class P>
BoundedBy<P> cos(const BoundedBy<P>& x) {
    return {std::cos(x.value), std::fabs(x.value) <= M_PI ? P::kSineAbsolute + x.error : kUnknown};
}
template <class P>
BoundedBy<P> tan(const BoundedBy<P>& x) {
    return sin(x) / cos(x);
}
template <class P>
BoundedBy<P> atan2(const BoundedBy<P>& y, const BoundedBy<P>& x) {
    const double value = std::atan2(y.value, x.value), square = x.value * x.value + y.value * y.value;
    const double slope = (std::fabs(x.value) * y.error + std::fabs(y.value) * x.error) / square;
    const double error = x.error + y.error > 0 ? slope : 0;
    return {value, error < M_PI ? error + P::kArctangentUlp * P::ulp(value) : kUnknown};
}
template <class P>
BoundedBy<P> atan(const BoundedBy<P>& x) {
    return atan2(x, BoundedBy<P>(1));
}
template <class P>
BoundedBy<P> asin(const BoundedBy<P>& x) {
    return atan2(x, sqrt(BoundedBy<P>(1) - x * x));
}
template <class P>
BoundedBy<P> acos(const BoundedBy<P>& x) {
    return atan2(sqrt(BoundedBy<P>(1) - x * x), x);
}
template <class P>
BoundedBy<P> pow(const BoundedBy<P>& x, const BoundedBy<P>& y) {
    return exp2(y * log2(x));
}
template <class P>
BoundedBy<P> unitClamp(const BoundedBy<P>& x) {
    return {std::clamp(x.value, 0.0, 1.0), x.error};
}

}  // namespace vernier::precision
