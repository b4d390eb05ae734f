// Exact numbers for the oracle: GMP rationals, and MPFR enclosures for the few functions that leave the
// rationals. Float inputs are dyadic rationals, so everything up to the final rounding of a stored code can
// be decided here without an error bound.
#pragma once

#include <gmpxx.h>

#include <cstdint>

namespace vernier::conformance::exact {

using Integer = mpz_class;
using Rational = mpq_class;

/// The exact value of a finite double or float.
inline Rational rational(double value) {
    return Rational(value);
}

/// numerator / denominator in lowest terms.
Rational fraction(int64_t numerator, int64_t denominator);

/// 2^exponent.
Rational powerOfTwo(int exponent);

/// base^exponent for exponent >= 0.
Rational power(const Rational& base, unsigned exponent);

Integer floorOf(const Rational& value);
Integer ceilOf(const Rational& value);
/// Nearest integer, ties to even.
Integer roundHalfEven(const Rational& value);

/// The value as int64_t; the caller has bounded it.
int64_t toInt64(const Integer& value);

/// The largest integer e with 2^e <= value, for value > 0.
int floorLog2(const Rational& value);

/// Two doubles around an irrational value.
struct Enclosure {
    double low, high;
};

/// log2(value) for value > 0, rounded down and up to double from a wide MPFR evaluation.
Enclosure log2Enclosure(const Rational& value);

/// sqrt(value) for value >= 0.
Enclosure sqrtEnclosure(const Rational& value);

}  // namespace vernier::conformance::exact
