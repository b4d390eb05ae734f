// Operations common to all SIMD targets; included once per target (see base/simd.h).
#if defined(VERNIER_BASE_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BASE_SIMD_INL_H
#undef VERNIER_BASE_SIMD_INL_H
#else
#define VERNIER_BASE_SIMD_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SSE4
/// x + y, rounded to odd: rounding that to float is correct (Boldo and Melquiond, "Emulation of FMA and correctly
/// rounded sums: proved algorithms using rounding to odd", IEEE TC 57(4), 2008).
template <class DD, class VD = hn::Vec<DD>>
HWY_NOINLINE VD addRoundToOdd(DD dd, VD x, VD y) {
    const hn::RebindToSigned<DD> di;
    const VD sum = hn::Add(x, y);
    // TwoSum (Knuth): the exact rounding error of the sum.
    const VD yy = hn::Sub(sum, x);
    const VD error = hn::Add(hn::Sub(x, hn::Sub(sum, yy)), hn::Sub(y, yy));
    const auto bits = hn::BitCast(di, sum);
    const auto one = hn::Set(di, 1);
    const auto even = hn::Eq(hn::And(bits, one), hn::Zero(di));
    // error != error (NaN) happens only when the sum is not finite: leave that alone.
    const auto inexact = hn::RebindMask(di, hn::Or(hn::Lt(error, hn::Zero(dd)), hn::Gt(error, hn::Zero(dd))));
    // Towards the error when the sum is even: one step up in magnitude when both signs agree, else one step down.
    const auto opposite = hn::Lt(hn::BitCast(di, hn::Xor(sum, error)), hn::Zero(di));
    const auto step = hn::IfThenElse(opposite, hn::Set(di, -1), one);
    const auto moved = hn::Add(bits, step);
    return hn::BitCast(dd, hn::IfThenElse(hn::And(even, inexact), moved, bits));
}

/// One half of the fused multiply-add below. The product of two floats is exact in double (24 + 24 <= 53 bits).
/// Rounding the sum to double and then to float goes wrong only from the middle between two floats, which for normal
/// floats is a pattern of the 29 bits that float lacks: only then, and for denormal floats, is the sum rounded to odd.
template <class DD, class VD = hn::Vec<DD>>
HWY_INLINE VD fusedHalf(DD dd, VD a, VD b, VD c) {
    const hn::RebindToSigned<DD> di;
    const VD product = hn::Mul(a, b);
    const VD sum = hn::Add(product, c);
    const auto lacking = hn::And(hn::BitCast(di, sum), hn::Set(di, 0x1FFFFFFF));
    const auto middle = hn::RebindMask(dd, hn::Eq(lacking, hn::Set(di, 0x10000000)));
    const auto small = hn::Lt(hn::Abs(sum), hn::Set(dd, 0x1p-126));
    if (HWY_LIKELY(hn::AllFalse(dd, hn::Or(middle, small)))) return sum;
    return addRoundToOdd(dd, product, c);
}
#endif

/// a * b + c with one rounding, the same bits on every target. Float lanes only. On SSE4 (no FMA instruction) it is
/// emulated exactly, at several times the cost.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V fusedMulAdd(D d, V a, V b, V c) {
#if HWY_TARGET == HWY_SSE4
    static_assert(sizeof(hn::TFromD<D>) == 4, "float lanes");
    const hn::Half<D> dh;
    const hn::RepartitionToWide<D> dd;
    const auto half = [&](auto va, auto vb, auto vc) {
        return hn::DemoteTo(dh, fusedHalf(dd, hn::PromoteTo(dd, va), hn::PromoteTo(dd, vb), hn::PromoteTo(dd, vc)));
    };
    const auto lower = half(hn::LowerHalf(dh, a), hn::LowerHalf(dh, b), hn::LowerHalf(dh, c));
    const auto upper = half(hn::UpperHalf(dh, a), hn::UpperHalf(dh, b), hn::UpperHalf(dh, c));
    return hn::Combine(d, upper, lower);
#else
    (void)d;
    return hn::MulAdd(a, b, c);
#endif
}

/// The lesser and the greater of two floats: b if one of them is NaN, or both are zero. So mean minimum and maximum
/// instructions of x86; those of NEON prefer numbers to NaN, and -0 to 0. Highway's Min and Max are for integers only.
template <class V>
HWY_INLINE V minOrSecond(V a, V b) {
#if HWY_TARGET == HWY_NEON
    return hn::IfThenElse(hn::Lt(a, b), a, b);
#else
    return hn::Min(a, b);
#endif
}
template <class V>
HWY_INLINE V maxOrSecond(V a, V b) {
#if HWY_TARGET == HWY_NEON
    return hn::IfThenElse(hn::Gt(a, b), a, b);
#else
    return hn::Max(a, b);
#endif
}

/// Towards zero. Values that do not fit, and NaN, become INT32_MIN: without the corrections that ConvertTo makes.
HWY_INLINE hn::Vec<hn::ScalableTag<int32_t>> truncateInRange(hn::Vec<hn::ScalableTag<float>> x) {
    using V = hn::Vec<hn::ScalableTag<int32_t>>;
#if HWY_TARGET == HWY_AVX3
    return V{_mm512_cvttps_epi32(x.raw)};
#elif HWY_TARGET == HWY_AVX2
    return V{_mm256_cvttps_epi32(x.raw)};
#elif HWY_TARGET == HWY_SSE4
    return V{_mm_cvttps_epi32(x.raw)};
#else
    const hn::ScalableTag<float> d;
    const hn::ScalableTag<int32_t> di;
    const V whole = hn::ConvertTo(di, x);
    return hn::IfThenElse(hn::RebindMask(di, hn::Lt(x, hn::Set(d, 0x1p31f))), whole, hn::Set(di, INT32_MIN));
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
