#include "spirv_interp/reference/number.h"

#include <mpfr.h>

#include <algorithm>
#include <limits>

namespace vernier::reference {

/// A Real seen as an MPFR variable that lives on the stack: its significand is a copy, store() brings it
/// back.
struct MpfrView {
    static_assert(sizeof(mp_limb_t) == sizeof(uint64_t) && GMP_NUMB_BITS == 64);

    MpfrView() { mpfr_custom_init_set(value, MPFR_ZERO_KIND, 0, Real::kPrecision, limbs.data()); }
    explicit MpfrView(const Real& x) : limbs(x.limbs_) {
        mpfr_custom_init_set(value, x.kind_, x.exponent_, Real::kPrecision, limbs.data());
    }
    MpfrView(const MpfrView&) = delete;
    MpfrView& operator=(const MpfrView&) = delete;

    Real store() const {
        Real result;
        result.limbs_ = limbs;
        result.kind_ = mpfr_custom_get_kind(value);
        if (mpfr_regular_p(value)) {
            result.exponent_ = mpfr_custom_get_exp(value);
            const int32_t sign = result.kind_ < 0 ? -1 : 1;
            if (result.exponent_ > kMaxExponent) result.kind_ = sign * MPFR_INF_KIND;
            if (result.exponent_ < -kMaxExponent) result.kind_ = sign * MPFR_ZERO_KIND;
        }
        return result;
    }

    /// Reducing the argument of a trigonometric function takes as many bits as its exponent: it has to stay
    /// small.
    static constexpr int64_t kMaxExponent = 20000;

    std::array<uint64_t, Real::kPrecision / 64> limbs{};
    mpfr_t value;
};

namespace {

using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using Binary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

Real unary(Unary function, const Real& x) {
    const MpfrView operand(x);
    MpfrView result;
    function(result.value, operand.value, MPFR_RNDN);
    return result.store();
}

Real binary(Binary function, const Real& a, const Real& b) {
    const MpfrView left(a), right(b);
    MpfrView result;
    function(result.value, left.value, right.value, MPFR_RNDN);
    return result.store();
}

}  // namespace

Real::Real(double value) {
    MpfrView result;
    mpfr_set_d(result.value, value, MPFR_RNDN);
    *this = result.store();
}

Real::Real(int64_t value) {
    MpfrView result;
    mpfr_set_sj(result.value, value, MPFR_RNDN);
    *this = result.store();
}

Real::Real(uint64_t value) {
    MpfrView result;
    mpfr_set_uj(result.value, value, MPFR_RNDN);
    *this = result.store();
}

Real::operator float() const {
    return mpfr_get_flt(MpfrView(*this).value, MPFR_RNDN);
}
Real::operator double() const {
    return mpfr_get_d(MpfrView(*this).value, MPFR_RNDN);
}

Real Real::operator-() const {
    const MpfrView operand(*this);
    MpfrView result;
    mpfr_neg(result.value, operand.value, MPFR_RNDN);
    return result.store();
}

Real operator+(const Real& a, const Real& b) {
    return binary(mpfr_add, a, b);
}
Real operator-(const Real& a, const Real& b) {
    return binary(mpfr_sub, a, b);
}
Real operator*(const Real& a, const Real& b) {
    return binary(mpfr_mul, a, b);
}
Real operator/(const Real& a, const Real& b) {
    return binary(mpfr_div, a, b);
}

bool operator==(const Real& a, const Real& b) {
    return (a <=> b) == 0;
}

std::partial_ordering operator<=>(const Real& a, const Real& b) {
    const MpfrView left(a), right(b);
    if (mpfr_unordered_p(left.value, right.value)) return std::partial_ordering::unordered;
    const int order = mpfr_cmp(left.value, right.value);
    return order < 0   ? std::partial_ordering::less
           : order > 0 ? std::partial_ordering::greater
                       : std::partial_ordering::equivalent;
}

bool isnan(const Real& x) {
    return mpfr_nan_p(MpfrView(x).value) != 0;
}
bool isinf(const Real& x) {
    return mpfr_inf_p(MpfrView(x).value) != 0;
}
bool signbit(const Real& x) {
    return mpfr_signbit(MpfrView(x).value) != 0;
}

Real floor(const Real& x) {
    return unary(mpfr_rint_floor, x);
}
Real ceil(const Real& x) {
    return unary(mpfr_rint_ceil, x);
}
Real trunc(const Real& x) {
    return unary(mpfr_rint_trunc, x);
}
Real rint(const Real& x) {
    return unary(mpfr_rint, x);
}
Real fabs(const Real& x) {
    return signbit(x) ? -x : x;
}
Real sqrt(const Real& x) {
    return unary(mpfr_sqrt, x);
}
Real exp(const Real& x) {
    return unary(mpfr_exp, x);
}
Real exp2(const Real& x) {
    return unary(mpfr_exp2, x);
}
Real log(const Real& x) {
    return unary(mpfr_log, x);
}
Real log2(const Real& x) {
    return unary(mpfr_log2, x);
}
Real sin(const Real& x) {
    return unary(mpfr_sin, x);
}
Real cos(const Real& x) {
    return unary(mpfr_cos, x);
}
Real tan(const Real& x) {
    return unary(mpfr_tan, x);
}
Real asin(const Real& x) {
    return unary(mpfr_asin, x);
}
Real acos(const Real& x) {
    return unary(mpfr_acos, x);
}
Real atan(const Real& x) {
    return unary(mpfr_atan, x);
}
Real sinh(const Real& x) {
    return unary(mpfr_sinh, x);
}
Real cosh(const Real& x) {
    return unary(mpfr_cosh, x);
}
Real tanh(const Real& x) {
    return unary(mpfr_tanh, x);
}
Real asinh(const Real& x) {
    return unary(mpfr_asinh, x);
}
Real acosh(const Real& x) {
    return unary(mpfr_acosh, x);
}
Real atanh(const Real& x) {
    return unary(mpfr_atanh, x);
}
Real pow(const Real& x, const Real& y) {
    return binary(mpfr_pow, x, y);
}
Real atan2(const Real& y, const Real& x) {
    return binary(mpfr_atan2, y, x);
}
Real fmod(const Real& x, const Real& y) {
    return binary(mpfr_fmod, x, y);
}

Real fma(const Real& a, const Real& b, const Real& c) {
    const MpfrView x(a), y(b), z(c);
    MpfrView result;
    mpfr_fma(result.value, x.value, y.value, z.value, MPFR_RNDN);
    return result.store();
}

Real ldexp(const Real& x, int exponent) {
    const MpfrView operand(x);
    MpfrView result;
    mpfr_mul_2si(result.value, operand.value, exponent, MPFR_RNDN);
    return result.store();
}

Real frexp(const Real& x, int* exponent) {
    const MpfrView operand(x);
    MpfrView result;
    mpfr_exp_t power = 0;
    *exponent = 0;
    if (!mpfr_regular_p(operand.value)) return x;
    mpfr_frexp(&power, result.value, operand.value, MPFR_RNDN);
    *exponent = static_cast<int>(power);
    return result.store();
}

}  // namespace vernier::reference
