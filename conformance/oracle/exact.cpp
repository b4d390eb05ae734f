#include "conformance/oracle/exact.h"

#include <mpfr.h>

namespace vernier::conformance::exact {

namespace {

// Wide enough that rounding the result to double encloses the exact value after one further directed
// rounding.
constexpr mpfr_prec_t kWorkingBits = 256;

using MpfrFunction = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

// For an increasing function: the lower end from an argument and a result rounded down, the upper from both
// rounded up.
Enclosure increasing(MpfrFunction function, const Rational& value) {
    mpfr_t argument, result;
    mpfr_init2(argument, kWorkingBits);
    mpfr_init2(result, kWorkingBits);
    Enclosure enclosure{};
    mpfr_set_q(argument, value.get_mpq_t(), MPFR_RNDD);
    function(result, argument, MPFR_RNDD);
    enclosure.low = mpfr_get_d(result, MPFR_RNDD);
    mpfr_set_q(argument, value.get_mpq_t(), MPFR_RNDU);
    function(result, argument, MPFR_RNDU);
    enclosure.high = mpfr_get_d(result, MPFR_RNDU);
    mpfr_clear(argument);
    mpfr_clear(result);
    return enclosure;
}

}  // namespace

Rational fraction(int64_t numerator, int64_t denominator) {
    Rational value{Integer(static_cast<long>(numerator)), Integer(static_cast<long>(denominator))};
    value.canonicalize();
    return value;
}

Rational powerOfTwo(int exponent) {
    Rational value(1);
    if (exponent >= 0) {
        mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
    } else {
        mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
    }
    return value;
}

Rational power(const Rational& base, unsigned exponent) {
    Rational result;
    mpz_pow_ui(result.get_num_mpz_t(), base.get_num_mpz_t(), exponent);
    mpz_pow_ui(result.get_den_mpz_t(), base.get_den_mpz_t(), exponent);
    return result;
}

Integer floorOf(const Rational& value) {
    Integer result;
    mpz_fdiv_q(result.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
    return result;
}

Integer ceilOf(const Rational& value) {
    Integer result;
    mpz_cdiv_q(result.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
    return result;
}

Integer roundHalfEven(const Rational& value) {
    const Integer low = floorOf(value);
    const Rational rest = value - Rational(low);
    const int side = cmp(rest, fraction(1, 2));
    if (side < 0) return low;
    if (side > 0) return low + 1;
    return mpz_even_p(low.get_mpz_t()) ? low : Integer(low + 1);
}

int64_t toInt64(const Integer& value) {
    return value.get_si();
}

int floorLog2(const Rational& value) {
    int exponent = static_cast<int>(mpz_sizeinbase(value.get_num_mpz_t(), 2)) -
                   static_cast<int>(mpz_sizeinbase(value.get_den_mpz_t(), 2));
    while (powerOfTwo(exponent) > value) --exponent;
    while (powerOfTwo(exponent + 1) <= value) ++exponent;
    return exponent;
}

Enclosure log2Enclosure(const Rational& value) {
    return increasing(mpfr_log2, value);
}

Enclosure sqrtEnclosure(const Rational& value) {
    return increasing(mpfr_sqrt, value);
}

}  // namespace vernier::conformance::exact
