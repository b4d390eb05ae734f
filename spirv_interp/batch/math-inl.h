// Transcendental functions on vectors, written once for every tier and included once per SIMD target. Only
// correctly rounded operations (+ - * / sqrt, fused multiply-add, rounding) and bit operations: every
// instruction set gives the same bits. What a lane gets depends on that lane alone; where a whole vector needs
// no special care a shorter way is taken that gives its lanes the same bits.
//
// A Tier names the lanes it computes in and its polynomials (math_coefficients.h); docs/precision.md has the
// errors measured.
//   Fast       float lanes, short polynomials: about 2^-12 relative
//   Standard   float lanes: well inside the precision table of the Vulkan specification ("Precision and
//              Operation of SPIR-V Instructions")
//   Fine       double lanes, polynomials good to 2^-28, rounded to float once: within 1 ULP
//   Reference  double lanes, polynomials as good as doubles are: correctly rounded but for results within
//              about 2^-25 ULP of the middle between two floats
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

#include "base/simd-inl.h"
#include "spirv_interp/batch/far_angle.h"
#include "spirv_interp/batch/math_coefficients.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE::math {

namespace hn = hwy::HWY_NAMESPACE;
using ::vernier::HWY_NAMESPACE::maxOrSecond;
using ::vernier::HWY_NAMESPACE::minOrSecond;

struct Fast : coefficients::Fast {
    using T = float;
    static constexpr int kNewtonSteps = 1;  // of the inverse square root, before the last
};
struct Standard : coefficients::Standard {
    using T = float;
    static constexpr int kNewtonSteps = 2;
};
struct Fine : coefficients::Fine {
    using T = double;
};
struct Reference : coefficients::Reference {
    using T = double;
};

/// Constants of a lane type. pi and ln 2 are in parts: multiples of the first parts are exact, in double
/// because the parts have few bits (Cody and Waite, "Software Manual for the Elementary Functions", 1980), in
/// float because the multiplication is fused with a subtraction whose result fits.
template <class T>
struct Lane;
template <>
struct Lane<float> {
    using Bits = uint32_t;
    static constexpr int kMantissa = 23, kBias = 127;
    static constexpr float kPi[3] = {0x1.921fb6p+1f, -0x1.777a5cp-24f, -0x1.ee59dap-49f};
    static constexpr float kLn2[2] = {0x1.62e43p-1f, -0x1.05c61p-29f};
    static constexpr float kExp2Low = -160, kExp2High = 160, kExpLow = -111, kExpHigh = 111;
    static constexpr float kLargest = 0x1p126f;
    static constexpr float kLogOnly = 0x1p14f;  // above, asinh and acosh are log(2 x) to the last bit
};
template <>
struct Lane<double> {
    using Bits = uint64_t;
    static constexpr int kMantissa = 52, kBias = 1023;
    static constexpr double kPi[3] = {0x1.921fb544p+1, 0x1.0b4611a8p-33, -0x1.d9cceba3f91f2p-65};
    static constexpr double kLn2[2] = {0x1.62e42ffp-1, -0x1.718432a1b0e26p-35};
    static constexpr double kExp2Low = -1000, kExp2High = 1000, kExpLow = -690, kExpHigh = 690;
    static constexpr double kLargest = 0x1p1022;
    static constexpr double kLogOnly = 0x1p28;
};
/// Up to here the multiples of pi and pi / 2 have so few bits.
inline constexpr float kNearAngle = 0x1p19f;

template <class Tier>
struct Functions {
    using T = typename Tier::T;
    using L = Lane<T>;
    using DT = hn::ScalableTag<T>;
    using DU = hn::RebindToUnsigned<DT>;
    using V = hn::Vec<DT>;
    using M = hn::Mask<DT>;
    using VBits = hn::Vec<DU>;
    static constexpr bool kSingle = sizeof(T) == sizeof(float);
    static constexpr typename L::Bits kInfinity = (typename L::Bits{2} * L::kBias + 1) << L::kMantissa;
    static constexpr typename L::Bits kNaN = kInfinity | typename L::Bits{1} << (L::kMantissa - 1);

    static HWY_INLINE V set(T value) { return hn::Set(DT(), value); }
    static HWY_INLINE VBits bits(V v) { return hn::BitCast(DU(), v); }
    static HWY_INLINE V number(VBits v) { return hn::BitCast(DT(), v); }
    static HWY_INLINE VBits setBits(typename L::Bits value) { return hn::Set(DU(), value); }
    static HWY_INLINE V choose(M mask, V yes, V no) { return hn::IfThenElse(mask, yes, no); }
    static HWY_INLINE V signOf(V v) { return hn::And(v, set(T{-0.0})); }

    /// a * b + c: fused in float, in double (which has bits to spare) rounded twice.
    static HWY_INLINE V mulAdd(V a, V b, V c) {
        if constexpr (kSingle) {
            return ::vernier::HWY_NAMESPACE::fusedMulAdd(DT(), a, b, c);
        } else {
            return hn::Add(hn::Mul(a, b), c);
        }
    }
    template <size_t kCount>
    static HWY_INLINE V polynomial(const T (&c)[kCount], V x) {
        V sum = set(c[kCount - 1]);
        for (size_t k = kCount - 1; k-- > 0;) sum = mulAdd(sum, x, set(c[k]));
        return sum;
    }
    /// x + x^3 p(x^2)
    template <size_t kCount>
    static HWY_INLINE V oddPolynomial(const T (&c)[kCount], V x) {
        const V z = hn::Mul(x, x);
        return mulAdd(hn::Mul(x, z), polynomial(c, z), x);
    }

    /// Adding this to a number rounds it to an integer n and leaves n in the low bits of the lane.
    static constexpr T kRounder = static_cast<T>(typename L::Bits{3} << (L::kMantissa - 1));

    /// v * 2^n for v in [1/2, 2] and the integer n of a rounder sum, where the result is a normal number.
    static HWY_INLINE V scaleNormal(V v, V rounded) {
        return number(hn::Add(bits(v), hn::ShiftLeft<L::kMantissa>(bits(rounded))));
    }
    /// v * 2^n for any float result: in two steps, of which only the second can round.
    static HWY_INLINE V scale(V v, V rounded) {
        if constexpr (kSingle) {
            const hn::RebindToSigned<DT> di;
            const auto n = hn::Sub(hn::BitCast(di, rounded), hn::Set(di, std::bit_cast<int32_t>(kRounder)));
            const auto half = hn::ShiftRight<1>(n);
            const auto rest = hn::Add(hn::Sub(n, half), hn::Set(di, L::kBias));
            const V first = hn::BitCast(DT(), hn::Add(hn::BitCast(di, v), hn::ShiftLeft<L::kMantissa>(half)));
            return hn::Mul(first, hn::BitCast(DT(), hn::ShiftLeft<L::kMantissa>(rest)));
        } else {
            return scaleNormal(v, rounded);  // floats are never denormal as doubles
        }
    }
    /// NaN comes through.
    static HWY_INLINE V between(V x, T low, T high) { return maxOrSecond(set(low), minOrSecond(set(high), x)); }

    /// `value`, which bit operations made, or x where that is NaN.
    static HWY_INLINE V orNaN(V x, V value) { return choose(hn::IsNaN(x), x, value); }

    /// A number in [1/2, 2] and the power of two it is to be scaled by, as a rounder sum.
    struct Power {
        V value, rounded;
    };
    static HWY_INLINE Power power2(V x) {
        const V rounded = hn::Add(x, set(kRounder));
        const V f = hn::Sub(x, hn::Sub(rounded, set(kRounder)));
        return {mulAdd(f, polynomial(Tier::exp2, f), set(1)), rounded};
    }
    static HWY_INLINE Power powerE(V x) {
        const V rounded = mulAdd(x, set(static_cast<T>(0x1.71547652b82fep+0)), set(kRounder));
        const V n = hn::Sub(rounded, set(kRounder));
        const V r = mulAdd(n, set(-L::kLn2[1]), mulAdd(n, set(-L::kLn2[0]), x));
        return {mulAdd(r, polynomial(Tier::exp, r), set(1)), rounded};
    }
    static HWY_INLINE bool allWithin(V x, T limit) { return hn::AllTrue(DT(), hn::Lt(hn::Abs(x), set(limit))); }
    static HWY_INLINE V exp2(V x) {
        if (allWithin(x, 125)) {
            const Power p = power2(x);
            return scaleNormal(p.value, p.rounded);
        }
        const Power p = power2(between(x, L::kExp2Low, L::kExp2High));
        return orNaN(x, scale(p.value, p.rounded));
    }
    static HWY_INLINE V exp(V x) {
        if (allWithin(x, 86)) {
            const Power p = powerE(x);
            return scaleNormal(p.value, p.rounded);
        }
        return expScaled(x, 0);
    }
    /// e^x * 2^shift
    static HWY_INLINE V expScaled(V x, T shift) {
        const Power p = powerE(between(x, L::kExpLow, L::kExpHigh));
        return orNaN(x, scale(p.value, hn::Add(p.rounded, set(shift))));
    }

    /// x = 2^exponent * (1 + t) with 1 + t in [sqrt(1/2), sqrt(2)).
    struct Logarithm {
        V exponent, t;
    };
    static HWY_INLINE Logarithm split(V x) {
        const hn::RebindToSigned<DT> di;
        using I = hn::TFromD<decltype(di)>;
        constexpr auto kRootHalf = std::bit_cast<I>(static_cast<T>(0x1.6a09e667f3bcdp-1));
        const auto all = hn::BitCast(di, x);
        // The exponent above that of sqrt(1/2), which is -1.
        const auto above = hn::ShiftRight<L::kMantissa>(hn::Sub(all, hn::Set(di, kRootHalf)));
        const V mantissa = hn::BitCast(DT(), hn::Sub(all, hn::ShiftLeft<L::kMantissa>(above)));
        V exponent;
        if constexpr (kSingle) {
            exponent = hn::ConvertTo(DT(), above);
        } else {
            // Not every instruction set converts 64-bit integers: the rounder's low bits do.
            exponent =
                hn::Sub(hn::BitCast(DT(), hn::Add(above, hn::Set(di, std::bit_cast<I>(kRounder)))), set(kRounder));
        }
        return {exponent, hn::Sub(mantissa, set(1))};
    }
    /// log(1 + t), by the series of 2 atanh(s) with s = t / (2 + t). In double only.
    static HWY_INLINE V logOfMantissa(V t) {
        const V s = hn::Div(t, hn::Add(t, set(2)));
        const V twice = hn::Add(s, s), z = hn::Mul(s, s);
        return mulAdd(hn::Mul(twice, z), polynomial(Tier::logarithm, z), twice);
    }
    static HWY_INLINE V log2Normal(V x) {
        const Logarithm l = split(x);
        if constexpr (kSingle) {
            return mulAdd(l.t, polynomial(Tier::log2, l.t), l.exponent);
        } else {
            return mulAdd(logOfMantissa(l.t), set(0x1.71547652b82fep+0), l.exponent);
        }
    }
    static HWY_INLINE V logNormal(V x) {
        const Logarithm l = split(x);
        V mantissa;
        if constexpr (kSingle) {
            mantissa = mulAdd(hn::Mul(l.t, l.t), polynomial(Tier::log, l.t), l.t);
        } else {
            mantissa = logOfMantissa(l.t);
        }
        return mulAdd(l.exponent, set(L::kLn2[0]), mulAdd(l.exponent, set(L::kLn2[1]), mantissa));
    }
    /// Positive normal numbers.
    static HWY_INLINE M usual(V x) {
        constexpr typename L::Bits kLowest = typename L::Bits{1} << L::kMantissa;
        return hn::And(hn::Ge(x, number(setBits(kLowest))), hn::Lt(x, number(setBits(kInfinity))));
    }
    /// `normal` of positive normal numbers, and the logarithm to the base with the given logarithm of 2^24
    /// elsewhere.
    template <class F>
    static HWY_INLINE V logarithm(V x, T ofUp, F&& normal) {
        const M common = usual(x);
        if (HWY_LIKELY(hn::AllTrue(DT(), common))) return normal(x);
        const M denormal = hn::AndNot(common, hn::Gt(x, set(0)));
        V inside = normal(choose(denormal, hn::Mul(x, set(0x1p24f)), x));
        if constexpr (kSingle) inside = choose(denormal, hn::Sub(inside, set(ofUp)), inside);
        const V inf = number(setBits(kInfinity));
        const V upper = choose(hn::Lt(x, inf), inside, x);  // inf and NaN
        const V below = choose(hn::Lt(x, set(0)), number(setBits(kNaN)), upper);
        return choose(hn::Eq(x, set(0)), hn::Neg(inf), below);
    }
    static HWY_INLINE V log2(V x) {
        return logarithm(x, 24, [](V v) HWY_ATTR { return log2Normal(v); });
    }
    static HWY_INLINE V log(V x) {
        return logarithm(x, static_cast<T>(0x1.0a2b23f3bab73p+4), [](V v) HWY_ATTR { return logNormal(v); });
    }

    /// exp2(y log2 x), with 1 for y = 0 and for x = 1; NaN for x < 0.
    static HWY_INLINE V pow(V x, V y) {
        const V power = exp2(hn::Mul(y, log2(x)));
        const M one = hn::Or(hn::Eq(y, set(0)), hn::Eq(x, set(1)));
        return choose(one, set(1), power);
    }

    /// 1 / sqrt(x). In float from an estimate made of the exponent and mantissa bits, and Newton's iteration; the
    /// last step has a fused residual, which leaves an error of about 1 ULP.
    static HWY_INLINE V inverseSqrt(V x) {
        if constexpr (kSingle) {
            V y = number(hn::Sub(setBits(0x5F375A86), hn::ShiftRight<1>(bits(x))));
            const V half = hn::Mul(x, set(0.5f));
            for (int k = 0; k < Tier::kNewtonSteps; ++k) {
                y = hn::Mul(y, hn::Sub(set(1.5f), hn::Mul(hn::Mul(half, y), y)));
            }
            y = mulAdd(hn::Mul(y, set(0.5f)), mulAdd(hn::Neg(hn::Mul(x, y)), y, set(1)), y);
            const M common = usual(x);
            if (HWY_LIKELY(hn::AllTrue(DT(), common))) return y;
            return choose(common, y, hn::Div(set(1), hn::Sqrt(x)));
        } else {
            return hn::Div(set(1), hn::Sqrt(x));
        }
    }

    /// An angle less its nearest multiple of a step, and the multiple's lowest bit as a sign.
    struct Angle {
        V rest, sign;
    };
    static HWY_INLINE V lessMultiple(V x, V n, T scale) {
        V rest = mulAdd(n, set(-L::kPi[0] * scale), x);
        rest = mulAdd(n, set(-L::kPi[1] * scale), rest);
        return mulAdd(n, set(-L::kPi[2] * scale), rest);
    }
    static HWY_INLINE V oddSign(V rounded) { return number(hn::ShiftLeft<sizeof(T) * 8 - 1>(bits(rounded))); }
    /// Puts lanes beyond kNearAngle right, which are rare, with `reduceFar(float)`; infinite ones become NaN.
    template <class F>
    static HWY_INLINE Angle withFar(V x, Angle near, F&& reduceFar) {
        const M far = hn::Gt(hn::Abs(x), set(kNearAngle));
        if (HWY_LIKELY(hn::AllFalse(DT(), far))) return near;
        constexpr size_t kCapacity = 64 / sizeof(T);
        alignas(64) T angle[kCapacity], rest[kCapacity], sign[kCapacity];
        hn::Store(x, DT(), angle);
        for (size_t lane = 0; lane < hn::Lanes(DT()); ++lane) {
            const auto single = static_cast<float>(angle[lane]);
            const bool isFar = single - single == 0 && (single > kNearAngle || single < -kNearAngle);
            const FarAngle reduced = isFar ? reduceFar(single) : FarAngle{};
            rest[lane] = isFar ? static_cast<T>(reduced.rest) : std::numeric_limits<T>::quiet_NaN();
            sign[lane] = reduced.odd ? T{-0.0} : T{0};
        }
        return {choose(far, hn::Load(DT(), rest), near.rest), choose(far, hn::Load(DT(), sign), near.sign)};
    }
    static HWY_INLINE V sineOf(Angle angle) {
        const V z = hn::Mul(angle.rest, angle.rest);
        const V sine = hn::Mul(angle.rest, mulAdd(z, polynomial(Tier::sine, z), set(1)));
        return hn::Xor(between(sine, -1, 1), signOf(angle.sign));
    }
    static HWY_INLINE V sin(V x) {
        const V rounded = mulAdd(x, set(static_cast<T>(0x1.45f306dc9c883p-2)), set(kRounder));
        const V n = hn::Sub(rounded, set(kRounder));
        return sineOf(
            withFar(x, {lessMultiple(x, n, 1), oddSign(rounded)}, [](float far) { return lessHalfTurns(far, false); }));
    }
    /// The sine a quarter turn on: x = (n - 1/2) pi + rest.
    static HWY_INLINE V cos(V x) {
        const V turns = mulAdd(x, set(static_cast<T>(0x1.45f306dc9c883p-2)), set(T{0.5}));
        const V rounded = hn::Add(turns, set(kRounder));
        const V n = hn::Sub(hn::Sub(rounded, set(kRounder)), set(T{0.5}));
        return sineOf(
            withFar(x, {lessMultiple(x, n, 1), oddSign(rounded)}, [](float far) { return lessHalfTurns(far, true); }));
    }
    static HWY_INLINE V tan(V x) {
        const V rounded = mulAdd(x, set(static_cast<T>(0x1.45f306dc9c883p-1)), set(kRounder));
        const V n = hn::Sub(rounded, set(kRounder));
        const Angle angle =
            withFar(x, {lessMultiple(x, n, T{0.5}), oddSign(rounded)}, [](float far) { return lessQuarterTurns(far); });
        const V direct = oddPolynomial(Tier::tangent, angle.rest);
        const M odd = hn::RebindMask(DT(), hn::Ne(bits(signOf(angle.sign)), setBits(0)));
        return choose(odd, hn::Div(set(-1), direct), direct);
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
        const V largest = maxOrSecond(a, b), least = minOrSecond(a, b);
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
        const V small = oddPolynomial(Tier::hyperbolicSine, minOrSecond(a, set(1)));
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
        const V s = oddPolynomial(Tier::hyperbolicSine, minOrSecond(a, set(1)));
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
        return hn::Or(hn::Abs(choose(hn::Gt(a, set(L::kLogOnly)), far, near)), signOf(x));
    }
    /// log(x + sqrt(x^2 - 1)) with t = x - 1; NaN below 1.
    static HWY_INLINE V acosh(V x) {
        const V t = hn::Sub(x, set(1));
        const V near = log1p(hn::Add(t, hn::Sqrt(hn::Mul(t, hn::Add(t, set(2))))));
        const V far = hn::Add(log(x), set(static_cast<T>(0x1.62e42fefa39efp-1)));
        // Below -1 the product is positive again.
        const V value = choose(hn::Gt(x, set(L::kLogOnly)), far, near);
        return choose(hn::Lt(t, set(0)), number(setBits(kNaN)), value);
    }
    /// log((1 + x) / (1 - x)) / 2; NaN outside [-1, 1].
    static HWY_INLINE V atanh(V x) {
        const V a = hn::Abs(x);
        const V ratio = hn::Div(hn::Add(a, a), hn::Sub(set(1), a));
        const V value = hn::Mul(log1p(ratio), set(T{0.5}));
        return hn::Or(choose(hn::Gt(a, set(1)), number(setBits(kNaN)), value), signOf(x));
    }
};

}  // namespace vernier::batch::HWY_NAMESPACE::math
HWY_AFTER_NAMESPACE();

#endif  // include guard
