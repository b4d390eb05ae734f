// The 128-bit number type of the reference interpreter. Its arithmetic is MPFR's: every operation, the
// transcendental ones included, is correctly rounded to nearest even. MPFR itself is not seen through this
// header.
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace vernier::reference {

/// A binary floating-point number with a 128-bit significand and exponents up to +-20000 (beyond: infinity or
/// zero, so that argument reduction stays affordable); NaN, signed infinities and signed zeros as in IEEE
/// 754. A plain value: copies are bitwise. Thread-safe like an int.
class Real {
  public:
    static constexpr int kPrecision = 128;

    Real() = default;  // +0
    Real(double value);
    Real(float value) : Real(static_cast<double>(value)) {}
    Real(int32_t value) : Real(static_cast<int64_t>(value)) {}
    Real(uint32_t value) : Real(static_cast<uint64_t>(value)) {}
    Real(int64_t value);
    Real(uint64_t value);

    /// Rounded to nearest even, subnormal results included; out of range gives an infinity.
    explicit operator float() const;
    explicit operator double() const;

    Real operator-() const;
    friend Real operator+(const Real& a, const Real& b);
    friend Real operator-(const Real& a, const Real& b);
    friend Real operator*(const Real& a, const Real& b);
    friend Real operator/(const Real& a, const Real& b);
    Real& operator+=(const Real& other) { return *this = *this + other; }
    Real& operator-=(const Real& other) { return *this = *this - other; }
    Real& operator*=(const Real& other) { return *this = *this * other; }
    Real& operator/=(const Real& other) { return *this = *this / other; }

    /// IEEE comparisons: NaN is unordered, -0 equals +0.
    friend bool operator==(const Real& a, const Real& b);
    friend std::partial_ordering operator<=>(const Real& a, const Real& b);

  private:
    friend struct MpfrView;

    std::array<uint64_t, kPrecision / 64> limbs_{};
    int64_t exponent_ = 0;
    int32_t kind_ = 2;  // MPFR_ZERO_KIND; negative for a negative number
};

bool isnan(const Real& x);
bool isinf(const Real& x);
bool signbit(const Real& x);
Real fabs(const Real& x);
Real floor(const Real& x);
Real ceil(const Real& x);
Real trunc(const Real& x);
Real rint(const Real& x);  // ties to even
Real sqrt(const Real& x);
Real exp(const Real& x);
Real exp2(const Real& x);
Real log(const Real& x);
Real log2(const Real& x);
Real sin(const Real& x);
Real cos(const Real& x);
Real tan(const Real& x);
Real asin(const Real& x);
Real acos(const Real& x);
Real atan(const Real& x);
Real sinh(const Real& x);
Real cosh(const Real& x);
Real tanh(const Real& x);
Real asinh(const Real& x);
Real acosh(const Real& x);
Real atanh(const Real& x);
Real pow(const Real& x, const Real& y);
Real atan2(const Real& y, const Real& x);
Real fmod(const Real& x, const Real& y);
Real fma(const Real& a, const Real& b, const Real& c);
Real ldexp(const Real& x, int exponent);
/// x = result * 2^exponent with 0.5 <= |result| < 1; exponent 0 for zero, infinity and NaN.
Real frexp(const Real& x, int* exponent);

}  // namespace vernier::reference
