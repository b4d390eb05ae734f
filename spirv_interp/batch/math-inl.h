// Transcendental functions on vectors, written once for every tier and included once per SIMD target. Only +
// - * / sqrt, rounding and bit operations, never fused, so that every instruction set gives the same bits.
// What a lane gets depends on that lane alone.
//
// A Tier names the lanes it computes in and its polynomials (math_coefficients.h):
//   Fast      float lanes, short polynomials: about 2^-12 relative
//   Standard  float lanes: well inside the precision table of the Vulkan specification ("Precision and
//   Operation of SPIR-V
//             Instructions")
//   Fine      double lanes, rounded to float at the end
#if defined(VERNIER_BATCH_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BATCH_MATH_INL_H
#undef VERNIER_BATCH_MATH_INL_H
#else
#define VERNIER_BATCH_MATH_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>
#include <limits>

#include "spirv_interp/batch/math_coefficients.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE::math {

namespace hn = hwy::HWY_NAMESPACE;

struct Fast : coefficients::Fast {
    using T = float;
};
struct Standard : coefficients::Standard {
    using T = float;
};
struct Fine : coefficients::Fine {
    using T = double;
};

/// Constants of a lane type. The parts of pi/2 and ln 2 have so few bits that their products with the
/// multiples that occur are exact (Cody and Waite, "Software Manual for the Elementary Functions", 1980).
template <class T>
struct Lane;
template <>
struct Lane<float> {
    using Bits = uint32_t;
    static constexpr int kMantissa = 23, kBias = 127;
    static constexpr float kHalfPi[4] = {0x1.92p+0f, 0x1.fb4p-12f, 0x1.444p-24f, 0x1.68c234p-39f};
    static constexpr float kReducible = 8192;  // up to here kHalfPi serves
    static constexpr float kLn2[2] = {0x1.62e4p-1f, 0x1.7f7d1cp-20f};
    static constexpr float kExp2Low = -160, kExp2High = 160, kExpLow = -111, kExpHigh = 111;
    static constexpr float kLargest = 0x1p126f, kSmallest = 0x1p-126f;
};
template <>
struct Lane<double> {
    using Bits = uint64_t;
    static constexpr int kMantissa = 52, kBias = 1023;
    static constexpr double kHalfPi[4] = {0x1.921fbp+0, 0x1.5110bp-22, 0x1.18469898cc517p-44, 0.0};
    static constexpr double kReducible = 0x1p31;
    static constexpr double kLn2[2] = {0x1.62e42fee0p-1, 0x1.a39ef35793c76p-33};
    static constexpr double kExp2Low = -1000, kExp2High = 1000, kExpLow = -700, kExpHigh = 700;
    static constexpr double kLargest = 0x1p1022, kSmallest = 0x1p-1022;
};

template <class Tier>
struct Functions {
    using T = typename Tier::T;
    using L = Lane<T>;
    using DT = hn::ScalableTag<T>;
    using DU = hn::RebindToUnsigned<DT>;
    using V = hn::Vec<DT>;
    using M = hn::Mask<DT>;
    using VBits = hn::Vec<DU>;

    static HWY_INLINE V set(T value) { return hn::Set(DT(), value); }
    static HWY_INLINE VBits bits(V v) { return hn::BitCast(DU(), v); }
    static HWY_INLINE V number(VBits v) { return hn::BitCast(DT(), v); }
    static HWY_INLINE VBits setBits(typename L::Bits value) { return hn::Set(DU(), value); }
    static HWY_INLINE V choose(M mask, V yes, V no) { return hn::IfThenElse(mask, yes, no); }
    static HWY_INLINE V signOf(V v) { return hn::And(v, set(T{-0.0})); }

    template <size_t kCount>
    static HWY_INLINE V polynomial(const T (&c)[kCount], V x) {
        V sum = set(c[kCount - 1]);
        for (size_t k = kCount - 1; k-- > 0;) sum = hn::Add(hn::Mul(sum, x), set(c[k]));
        return sum;
    }
    /// x + x^3 p(x^2)
    template <size_t kCount>
    static HWY_INLINE V oddPolynomial(const T (&c)[kCount], V x) {
        const V z = hn::Mul(x, x);
        return hn::Add(x, hn::Mul(hn::Mul(x, z), polynomial(c, z)));
    }

    /// An integral number's low bits, in the low bits of the lane: adding 1.5 * 2^mantissa puts them there.
    static HWY_INLINE VBits lowBits(V integral) {
        return bits(hn::Add(integral, set(static_cast<T>(typename L::Bits{3} << (L::kMantissa - 1)))));
    }
    /// 2^n for integral n of a normal number.
    static HWY_INLINE V powerOfTwo(V n) {
        return number(hn::ShiftLeft<L::kMantissa>(lowBits(hn::Add(n, set(L::kBias)))));
    }
    /// v * 2^n: in two steps, so that denormals are rounded once and n may leave the range of normal numbers.
    static HWY_INLINE V scale(V v, V n) {
        const V half = hn::Floor(hn::Mul(n, set(T{0.5})));
        return hn::Mul(hn::Mul(v, powerOfTwo(half)), powerOfTwo(hn::Sub(n, half)));
    }
    /// x86 minimum and maximum return their second operand when either is NaN: NaN comes through.
    static HWY_INLINE V between(V x, T low, T high) { return hn::Max(set(low), hn::Min(set(high), x)); }

    static HWY_INLINE V exp2(V x) {
        const V inside = between(x, L::kExp2Low, L::kExp2High);
        const V n = hn::Round(inside);
        const V f = hn::Sub(inside, n);
        return scale(hn::Add(set(1), hn::Mul(f, polynomial(Tier::exp2, f))), n);
    }

    /// e^x * 2^shift
    static HWY_INLINE V expScaled(V x, T shift) {
        const V inside = between(x, L::kExpLow, L::kExpHigh);
        const V n = hn::Round(hn::Mul(inside, set(T{0x1.71547652b82fep+0})));
        const V r = hn::Sub(hn::Sub(inside, hn::Mul(n, set(L::kLn2[0]))), hn::Mul(n, set(L::kLn2[1])));
        const V tail = hn::Mul(hn::Mul(r, r), polynomial(Tier::exp, r));
        return scale(hn::Add(set(1), hn::Add(r, tail)), hn::Add(n, set(shift)));
    }
    static HWY_INLINE V exp(V x) { return expScaled(x, 0); }

    /// x = 2^exponent * mantissa with the mantissa in [sqrt(1/2), sqrt(2)); s = (mantissa - 1) / (mantissa +
    /// 1), and log(mantissa) = 2 atanh(s) = 2 s + 2 s^3 logarithm(s^2).
    struct Logarithm {
        V exponent, s;
        HWY_INLINE V ofMantissa() const {
            const V twice = hn::Add(s, s), z = hn::Mul(s, s);
            return hn::Add(twice, hn::Mul(hn::Mul(twice, z), polynomial(Tier::logarithm, z)));
        }
    };
    static HWY_INLINE Logarithm split(V x) {
        const M denormal = hn::Lt(x, set(L::kSmallest));
        const T up = static_cast<T>(typename L::Bits{1} << (L::kMantissa + 1));
        const V normal = choose(denormal, hn::Mul(x, set(up)), x);
        constexpr auto kRootHalf = std::bit_cast<typename L::Bits>(static_cast<T>(0x1.6a09e667f3bcdp-1));
        constexpr auto kOne = std::bit_cast<typename L::Bits>(T{1});
        constexpr auto kMantissaBits = (typename L::Bits{1} << L::kMantissa) - 1;
        const VBits moved = hn::Add(bits(normal), setBits(kOne - kRootHalf));
        const V mantissa = number(hn::Add(hn::And(moved, setBits(kMantissaBits)), setBits(kRootHalf)));
        // The biased exponent becomes a number by standing in the low mantissa bits of 2^mantissa.
        const T base = static_cast<T>(typename L::Bits{1} << L::kMantissa);
        const V biased = hn::Sub(number(hn::Or(hn::ShiftRight<L::kMantissa>(moved), bits(set(base)))), set(base));
        const V bias = choose(denormal, set(T{L::kBias + L::kMantissa + 1}), set(T{L::kBias}));
        return {hn::Sub(biased, bias), hn::Div(hn::Sub(mantissa, set(1)), hn::Add(mantissa, set(1)))};
    }
    /// The logarithm's value outside (0, inf).
    static HWY_INLINE V logLimits(V x, V inside) {
        const V inf = set(std::numeric_limits<T>::infinity());
        const V upper = choose(hn::Lt(x, inf), inside, x);  // inf and NaN
        const V below = choose(hn::Lt(x, set(0)), number(setBits(kNaN)), upper);
        return choose(hn::Eq(x, set(0)), hn::Neg(inf), below);
    }
    static HWY_INLINE V log2(V x) {
        const Logarithm l = split(x);
        return logLimits(x, hn::Add(l.exponent, hn::Mul(l.ofMantissa(), set(T{0x1.71547652b82fep+0}))));
    }
    static HWY_INLINE V log(V x) {
        const Logarithm l = split(x);
        const V low = hn::Add(l.ofMantissa(), hn::Mul(l.exponent, set(L::kLn2[1])));
        return logLimits(x, hn::Add(hn::Mul(l.exponent, set(L::kLn2[0])), low));
    }

    /// exp2(y log2 x), with 1 for y = 0 and for x = 1; NaN for x < 0.
    static HWY_INLINE V pow(V x, V y) {
        const V power = exp2(hn::Mul(y, log2(x)));
        const M one = hn::Or(hn::Eq(y, set(0)), hn::Eq(x, set(1)));
        return choose(one, set(1), power);
    }

    /// An angle less its nearest multiple of pi/2, and the multiple's low bits.
    struct Angle {
        V rest;
        VBits quadrant;
    };
    static HWY_INLINE V lessHalfPis(V x, V n) {
        V rest = hn::Sub(x, hn::Mul(n, set(L::kHalfPi[0])));
        rest = hn::Sub(rest, hn::Mul(n, set(L::kHalfPi[1])));
        rest = hn::Sub(rest, hn::Mul(n, set(L::kHalfPi[2])));
        if constexpr (L::kHalfPi[3] != 0) rest = hn::Sub(rest, hn::Mul(n, set(L::kHalfPi[3])));
        return rest;
    }
    static HWY_INLINE Angle reduce(V x) {
        const M far = hn::Gt(hn::Abs(x), set(L::kReducible));
        const V near = hn::IfThenZeroElse(far, x);
        V n = hn::Round(hn::Mul(near, set(T{0x1.45f306dc9c883p-1})));
        V rest = lessHalfPis(near, n);
        if (!hn::AllFalse(DT(), far)) {
            if constexpr (sizeof(T) == 4) {
                // Lanes of their own in double: which lanes share a vector does not matter.
                using Wide = Functions<Fine>;
                const hn::Half<DT> half;
                const auto lower = Wide::reduceFar(hn::PromoteTo(typename Wide::DT(), hn::LowerHalf(half, x)));
                const auto upper = Wide::reduceFar(hn::PromoteTo(typename Wide::DT(), hn::UpperHalf(half, x)));
                rest = choose(far, hn::Combine(DT(), hn::DemoteTo(half, upper.rest), hn::DemoteTo(half, lower.rest)),
                              rest);
                n = choose(far, hn::Combine(DT(), hn::DemoteTo(half, upper.turns), hn::DemoteTo(half, lower.turns)), n);
            } else {
                rest = choose(far, hn::Mul(x, set(0)), rest);
            }
        }
        return {rest, lowBits(n)};
    }
    struct FarAngle {
        V rest, turns;  // turns: multiples of pi/2, in [0, 4)
    };
    /// Angles up to 2^31; beyond, where neighbouring floats are many turns apart, every angle counts as 0
    /// (and an infinite one as NaN).
    static HWY_INLINE FarAngle reduceFar(V x) {
        const V known = choose(hn::Gt(hn::Abs(x), set(L::kReducible)), hn::Mul(x, set(0)), x);
        const V n = hn::Round(hn::Mul(known, set(T{0x1.45f306dc9c883p-1})));
        const V turns = hn::Sub(n, hn::Mul(hn::Floor(hn::Mul(n, set(T{0.25}))), set(T{4})));
        return {lessHalfPis(known, n), turns};
    }
    struct SineCosine {
        V sine, cosine;
    };
    static HWY_INLINE SineCosine kernels(V r) {
        const V z = hn::Mul(r, r);
        const V cosine =
            hn::Add(hn::Sub(set(1), hn::Mul(z, set(T{0.5}))), hn::Mul(hn::Mul(z, z), polynomial(Tier::cosine, z)));
        return {oddPolynomial(Tier::sine, r), cosine};
    }
    static HWY_INLINE M isOdd(VBits quadrant) {
        return hn::RebindMask(DT(), hn::Ne(hn::And(quadrant, setBits(1)), setBits(0)));
    }
    /// The sine `quarters` quarter turns on.
    static HWY_INLINE V turned(V x, typename L::Bits quarters) {
        const Angle angle = reduce(x);
        const SineCosine k = kernels(angle.rest);
        const VBits quadrant = hn::Add(angle.quadrant, setBits(quarters));
        const V value = choose(isOdd(quadrant), k.cosine, k.sine);
        const VBits sign = hn::ShiftLeft < L::kMantissa == 23 ? 30 : 62 > (hn::And(quadrant, setBits(2)));
        return hn::Xor(value, number(sign));
    }
    static HWY_INLINE V sin(V x) { return turned(x, 0); }
    static HWY_INLINE V cos(V x) { return turned(x, 1); }
    static HWY_INLINE V tan(V x) {
        const Angle angle = reduce(x);
        const SineCosine k = kernels(angle.rest);
        const M odd = isOdd(angle.quadrant);
        const V quotient = hn::Div(choose(odd, k.cosine, k.sine), choose(odd, k.sine, k.cosine));
        return hn::Xor(quotient, hn::IfThenElseZero(odd, set(T{-0.0})));
    }

    /// asin of |x| <= 1/2, or of sqrt((1 - |x|) / 2) above: asin(x) = pi/2 - 2 asin(sqrt((1 - x) / 2)).
    struct Arcsine {
        V value;
        M upper;
    };
    static HWY_INLINE Arcsine arcsine(V magnitude) {
        const M upper = hn::Gt(magnitude, set(T{0.5}));
        const V root = hn::Sqrt(hn::Mul(hn::Sub(set(1), magnitude), set(T{0.5})));
        return {oddPolynomial(Tier::arcsine, choose(upper, root, magnitude)), upper};
    }
    static constexpr T kPi = static_cast<T>(0x1.921fb54442d18p+1);
    /// What is left of pi/2 and pi after rounding to T.
    static constexpr T kHalfPiLow =
        sizeof(T) == 4 ? static_cast<T>(-0x1.777a5cp-25) : static_cast<T>(0x1.1a62633145c07p-54);
    static HWY_INLINE V asin(V x) {
        const V magnitude = hn::Abs(x);
        const Arcsine a = arcsine(magnitude);
        const V reflected = hn::Sub(set(kPi / 2), hn::Sub(hn::Add(a.value, a.value), set(kHalfPiLow)));
        return hn::Or(choose(a.upper, reflected, a.value), signOf(x));
    }
    static HWY_INLINE V acos(V x) {
        const Arcsine a = arcsine(hn::Abs(x));
        const V twice = hn::Add(a.value, a.value);
        const M negative = hn::Lt(x, set(0));
        const V far = choose(negative, hn::Sub(set(kPi), hn::Sub(twice, set(2 * kHalfPiLow))), twice);
        const V signedValue = hn::Xor(a.value, signOf(x));
        const V near = hn::Sub(set(kPi / 2), hn::Sub(signedValue, set(kHalfPiLow)));
        return choose(a.upper, far, near);
    }

    /// atan(low / high) for 0 <= low <= high: below tan(pi/8) directly, above as pi/4 + atan((low - high) /
    /// (low + high)).
    static HWY_INLINE V arctangent(V low, V high) {
        const M upper = hn::Gt(low, hn::Mul(high, set(T{0x1.a8279ap-2})));
        const V numerator = choose(upper, hn::Sub(low, high), low);
        const V denominator = choose(upper, hn::Add(low, high), high);
        const V t = hn::IfThenZeroElse(hn::Eq(low, set(0)), hn::Div(numerator, denominator));
        return hn::Add(hn::IfThenElseZero(upper, set(kPi / 4)), oddPolynomial(Tier::arctangent, t));
    }
    static HWY_INLINE V atan2(V y, V x) {
        const V inf = set(std::numeric_limits<T>::infinity());
        const V a = hn::Abs(y), b = hn::Abs(x);
        const V largest = hn::Max(a, b), least = hn::Min(a, b);
        const M infinite = hn::Eq(largest, inf), huge = hn::Gt(largest, set(L::kLargest));
        const V shrink = choose(huge, set(T{0.25}), set(1));
        // inf / inf is taken as 1, anything else / inf as 0.
        const V low = choose(infinite, hn::IfThenElseZero(hn::Eq(least, inf), set(1)), hn::Mul(least, shrink));
        const V high = choose(infinite, set(1), hn::Mul(largest, shrink));
        V angle = arctangent(low, high);
        angle = choose(hn::Gt(a, b), hn::Sub(set(kPi / 2), hn::Sub(angle, set(kHalfPiLow))), angle);
        const M left = hn::RebindMask(DT(), hn::Ne(hn::And(bits(x), bits(set(T{-0.0}))), setBits(0)));
        angle = choose(left, hn::Sub(set(kPi), hn::Sub(angle, set(2 * kHalfPiLow))), angle);
        angle = hn::Or(hn::Abs(angle), signOf(y));
        // A NaN operand may have been lost in the minimum and maximum.
        return choose(hn::Or(hn::IsNaN(x), hn::IsNaN(y)), hn::Add(x, y), angle);
    }
    static HWY_INLINE V atan(V x) {
        const V a = hn::Abs(x);
        const M inverse = hn::Gt(a, set(1));
        const V direct = arctangent(choose(inverse, set(1), a), choose(inverse, a, set(1)));
        const V angle = choose(inverse, hn::Sub(set(kPi / 2), hn::Sub(direct, set(kHalfPiLow))), direct);
        return choose(hn::IsNaN(x), x, hn::Or(hn::Abs(angle), signOf(x)));
    }

    /// From half of e^|x|, which stays finite as long as the results do; near zero, where that cancels, by a
    /// polynomial.
    static HWY_INLINE V sinh(V x) {
        const V a = hn::Abs(x);
        const V half = expScaled(a, -1);
        const V large = hn::Sub(half, hn::Div(set(T{0.25}), half));
        const V small = oddPolynomial(Tier::hyperbolicSine, hn::Min(a, set(1)));
        return hn::Or(choose(hn::Lt(a, set(1)), small, large), signOf(x));
    }
    static HWY_INLINE V cosh(V x) {
        const V half = expScaled(hn::Abs(x), -1);
        return hn::Add(half, hn::Div(set(T{0.25}), half));
    }
    /// 1 - 2 / (e^2|x| + 1); below 1/2 from sinh alone: tanh = s / sqrt(1 + s^2).
    static HWY_INLINE V tanh(V x) {
        const V a = hn::Abs(x);
        const V large = hn::Sub(set(1), hn::Div(set(T{2}), hn::Add(expScaled(hn::Add(a, a), 0), set(1))));
        const V s = oddPolynomial(Tier::hyperbolicSine, hn::Min(a, set(1)));
        const V small = hn::Div(s, hn::Sqrt(hn::Add(set(1), hn::Mul(s, s))));
        return hn::Or(choose(hn::Lt(a, set(T{0.5})), small, large), signOf(x));
    }

    /// log(1 + u) for u >= 0: the rounding error of 1 + u is put back to first order.
    static HWY_INLINE V log1p(V u) {
        const V w = hn::Add(set(1), u);
        const V lost = hn::Sub(u, hn::Sub(w, set(1)));
        const V correction = hn::Div(lost, w);
        return choose(hn::Lt(u, set(L::kLargest)), hn::Add(log(w), correction), log(u));
    }
    /// sign(x) log(|x| + sqrt(x^2 + 1)); written with log1p to keep the accuracy of small x, as log(2 |x|)
    /// for large.
    static HWY_INLINE V asinh(V x) {
        const V a = hn::Abs(x);
        const V square = hn::Mul(a, a);
        const V root = hn::Sqrt(hn::Add(set(1), square));
        const V near = log1p(hn::Add(a, hn::Div(square, hn::Add(set(1), root))));
        const V far = hn::Add(log(a), set(static_cast<T>(0x1.62e42fefa39efp-1)));
        return hn::Or(hn::Abs(choose(hn::Gt(a, set(T{16384})), far, near)), signOf(x));
    }
    /// log(x + sqrt(x^2 - 1)) with t = x - 1; NaN below 1.
    static HWY_INLINE V acosh(V x) {
        const V t = hn::Sub(x, set(1));
        const V near = log1p(hn::Add(t, hn::Sqrt(hn::Mul(t, hn::Add(t, set(2))))));
        const V far = hn::Add(log(x), set(static_cast<T>(0x1.62e42fefa39efp-1)));
        return choose(hn::Gt(x, set(T{16384})), far, near);
    }
    /// log((1 + x) / (1 - x)) / 2; NaN outside [-1, 1].
    static HWY_INLINE V atanh(V x) {
        const V a = hn::Abs(x);
        const V ratio = hn::Div(hn::Add(a, a), hn::Sub(set(1), a));
        const V value = hn::Mul(log1p(ratio), set(T{0.5}));
        return hn::Or(choose(hn::Gt(a, set(1)), number(setBits(kNaN)), value), signOf(x));
    }

  private:
    static constexpr typename L::Bits kNaN =
        ((typename L::Bits{2} * L::kBias + 1) << L::kMantissa) | typename L::Bits{1} << (L::kMantissa - 1);
};

}  // namespace vernier::batch::HWY_NAMESPACE::math
HWY_AFTER_NAMESPACE();

#endif  // include guard
