// Conversions of vectors of components; the same bits as convert.h. Included once per target (see
// base/simd.h).
#if defined(VERNIER_FORMAT_CONVERT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_FORMAT_CONVERT_INL_H
#undef VERNIER_FORMAT_CONVERT_INL_H
#else
#define VERNIER_FORMAT_CONVERT_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "runtime/format/convert.h"
#include "runtime/format/format.h"
#include "runtime/format/srgb.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Full vectors of 32-bit lanes.
using F32 = hn::ScalableTag<float>;
using U32 = hn::ScalableTag<uint32_t>;
using I32 = hn::ScalableTag<int32_t>;
using VF = hn::Vec<F32>;
using VU = hn::Vec<U32>;
using VI = hn::Vec<I32>;

HWY_INLINE VU bitsOf(VF x) {
    return hn::BitCast(U32(), x);
}
HWY_INLINE VF floatOf(VU x) {
    return hn::BitCast(F32(), x);
}
HWY_INLINE VU splatBits(uint32_t x) {
    return hn::Set(U32(), x);
}
HWY_INLINE VF splatFloat(float x) {
    return hn::Set(F32(), x);
}

/// n / d correctly rounded, for d = 2^k - 1 (k <= 24) with the correctly rounded `reciprocal`, and n zero or
/// far from overflow and underflow. The first quotient is within 2 units in the last place, so its remainder
/// is exact (a multiple of the quotient's last place, below 2^26 of them), and the corrected quotient is off
/// by less than 2^-22 of a unit before it is rounded. n / d comes no closer than that to the middle of two
/// floats when k <= 16, and for k = 24 and integers n the tests run through all n.
HWY_INLINE VF divideExact(VF n, VF d, VF reciprocal) {
#if HWY_TARGET == HWY_SSE4
    (void)reciprocal;
    return hn::Div(n, d);
#else
    const VF quotient = hn::Mul(n, reciprocal);
    return hn::MulAdd(hn::NegMulAdd(quotient, d, n), reciprocal, quotient);
#endif
}

/// NaN gives `low`, and so does what equals it, such as a zero of the other sign.
HWY_INLINE VF clampOrLowV(VF x, VF low, VF high) {
    return minOrSecond(maxOrSecond(x, low), high);
}
HWY_INLINE VF zeroIfNaN(VF x) {
    return hn::IfThenElseZero(hn::Eq(x, x), x);
}

HWY_INLINE VF toFloatV(VU code) {
    return hn::ConvertTo(F32(), hn::BitCast(I32(), code));
}
HWY_INLINE VI signExtendV(VU code, int bits) {
    return hn::ShiftRightSame(hn::BitCast(I32(), hn::ShiftLeftSame(code, 32 - bits)), 32 - bits);
}

HWY_INLINE VF decodeUnormV(VU code, int bits) {
    const auto max = static_cast<float>(lowBits(static_cast<uint32_t>(bits)));
    return divideExact(toFloatV(code), splatFloat(max), splatFloat(1.0f / max));
}

/// x * scale rounded to the nearest integer, ties to even, for |x * scale| <= 2^22: a fused multiply-add to a
/// number whose last bit is worth 1 rounds the exact product once.
HWY_INLINE VI roundProduct(VF x, float scale) {
    constexpr float kMagic = 0x1.8p23f;
    const VF sum = fusedMulAdd(F32(), x, splatFloat(scale), splatFloat(kMagic));
    return hn::Sub(hn::BitCast(I32(), sum), hn::Set(I32(), std::bit_cast<int32_t>(kMagic)));
}

HWY_INLINE VU encodeUnormV(VF x, int bits) {
    const VF clamped = clampOrLowV(x, hn::Zero(F32()), splatFloat(1.0f));
    const auto max = static_cast<float>(lowBits(static_cast<uint32_t>(bits)));
    if (bits < 23) return hn::BitCast(U32(), roundProduct(clamped, max));
    // 24 bits. Products of 2^23 and above are rounded to integers by the multiplication itself, smaller ones
    // by adding 2^23.
    const VF magic = splatFloat(0x1p23f);
    const VI small =
        hn::Sub(hn::BitCast(I32(), fusedMulAdd(F32(), clamped, splatFloat(max), magic)), hn::BitCast(I32(), magic));
    const VI large = hn::ConvertTo(I32(), hn::Mul(clamped, splatFloat(max)));
    const auto isLarge = hn::RebindMask(I32(), hn::Gt(clamped, splatFloat(0.5f)));
    return hn::BitCast(U32(), hn::IfThenElse(isLarge, large, small));
}

HWY_INLINE VF decodeSnormV(VU code, int bits) {
    const auto max = static_cast<float>(lowBits(static_cast<uint32_t>(bits - 1)));
    const VF value = hn::ConvertTo(F32(), signExtendV(code, bits));
    return maxOrSecond(divideExact(value, splatFloat(max), splatFloat(1.0f / max)), splatFloat(-1.0f));
}

HWY_INLINE VU encodeSnormV(VF x, int bits) {
    const VF clamped = clampOrLowV(zeroIfNaN(x), splatFloat(-1.0f), splatFloat(1.0f));
    return hn::BitCast(U32(), roundProduct(clamped, static_cast<float>(lowBits(static_cast<uint32_t>(bits - 1)))));
}

/// Floats with 5 exponent bits over kMantissa bits, no sign.
template <int kMantissa>
HWY_INLINE VF decodeSmallFloatV(VU code) {
    // Read with the wrong bias and corrected by a power of two, which denormals survive; infinity and NaN get
    // their exponent.
    const VF scaled = hn::Mul(floatOf(hn::ShiftLeft<23 - kMantissa>(code)), splatFloat(0x1p112f));
    const auto special = hn::Gt(hn::BitCast(I32(), code), hn::Set(I32(), (31 << kMantissa) - 1));
    const VU exponent = hn::IfThenElseZero(hn::RebindMask(U32(), special), splatBits(0x7f800000u));
    return floatOf(hn::Or(bitsOf(scaled), exponent));
}

template <int kMantissa, bool kOverflowToInfinity>
HWY_INLINE VU encodeSmallFloatV(VU bits) {  // of a positive float
    constexpr int kShift = 23 - kMantissa;
    constexpr uint32_t kInfinity = 31u << kMantissa;
    const I32 di;
    const VI ordered = hn::BitCast(di, bits);
    constexpr uint32_t kMagic = (127u + 9u - kMantissa) << 23;
    const VU denormal = hn::Sub(bitsOf(hn::Add(floatOf(bits), floatOf(splatBits(kMagic)))), splatBits(kMagic));
    const VU odd = hn::And(hn::ShiftRight<kShift>(bits), splatBits(1));
    const VU biased = hn::Add(hn::Sub(bits, splatBits((112u << 23) - lowBits(kShift - 1))), odd);
    const VU rounded =
        hn::Min(hn::ShiftRight<kShift>(biased), splatBits(kOverflowToInfinity ? kInfinity : kInfinity - 1));
    VU result = hn::IfThenElse(hn::RebindMask(U32(), hn::Lt(ordered, hn::Set(di, 113 << 23))), denormal, rounded);
    const VU fraction = hn::And(hn::ShiftRight<kShift>(bits), splatBits(lowBits(kMantissa)));
    const VU nan = hn::Or(fraction, splatBits(kInfinity | 1u << (kMantissa - 1)));
    result = hn::IfThenElse(hn::RebindMask(U32(), hn::Gt(ordered, hn::Set(di, 0x7f800000))), nan, result);
    const auto isInfinite = hn::Eq(bits, splatBits(0x7f800000u));
    return hn::IfThenElse(isInfinite, splatBits(kInfinity), result);
}

/// `code` < 2^16 in every lane. The instruction differs in signalling NaNs alone, which it makes quiet.
HWY_INLINE VF decodeHalfV(VU code) {
#if HWY_TARGET != HWY_SSE4
    const auto halves = hn::DemoteTo(hn::Rebind<uint16_t, I32>(), hn::BitCast(I32(), code));
#if HWY_TARGET == HWY_AVX3
    const VF value{_mm512_cvtph_ps(halves.raw)};
#elif HWY_TARGET == HWY_AVX2
    const VF value{_mm256_cvtph_ps(halves.raw)};
#else
    const VF value{vcvt_f32_f16(vreinterpret_f16_u16(halves.raw))};
#endif
    if (HWY_LIKELY(hn::AllTrue(F32(), hn::Eq(value, value)))) return value;
#endif
    const VU sign = hn::ShiftLeft<16>(hn::And(code, splatBits(0x8000u)));
    return floatOf(hn::Or(bitsOf(decodeSmallFloatV<10>(hn::And(code, splatBits(0x7fffu)))), sign));
}

HWY_INLINE VU encodeHalfV(VF x) {
#if HWY_TARGET == HWY_SSE4
    const VU bits = bitsOf(x);
    const VU sign = hn::And(hn::ShiftRight<16>(bits), splatBits(0x8000u));
    return hn::Or(sign, encodeSmallFloatV<10, true>(hn::And(bits, splatBits(0x7fffffffu))));
#else
    // Rounds to the nearest, ties to even (on x86 whatever the control word says); NaNs keep the upper bits of their
    // payload.
    const hn::Rebind<uint16_t, U32> half;
#if HWY_TARGET == HWY_AVX3
    const hn::Vec<decltype(half)> codes{_mm512_cvtps_ph(x.raw, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
#elif HWY_TARGET == HWY_AVX2
    const hn::Vec<decltype(half)> codes{_mm256_cvtps_ph(x.raw, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
#else
    const hn::Vec<decltype(half)> codes{vreinterpret_u16_f16(vcvt_f16_f32(x.raw))};
#endif
    return hn::PromoteTo(U32(), codes);
#endif
}

HWY_INLINE VF decodeUfloatV(VU code, int bits) {
    return bits == 11 ? decodeSmallFloatV<6>(code) : decodeSmallFloatV<5>(code);
}

HWY_INLINE VU encodeUfloatV(VF x, int bits) {
    const VF positive = hn::IfThenZeroElse(hn::Le(x, hn::Zero(F32())), x);
    const VU magnitude = hn::And(bitsOf(positive), splatBits(0x7fffffffu));
    return bits == 11 ? encodeSmallFloatV<6, false>(magnitude) : encodeSmallFloatV<5, false>(magnitude);
}

/// `code` < 256 in every lane.
HWY_INLINE VF decodeSrgbV(VU code) {
    return hn::GatherIndex(F32(), kSrgbToLinear.data(), hn::BitCast(I32(), code));
}

HWY_INLINE VU encodeSrgbV(VF x) {
    const VF clamped = clampOrLowV(x, floatOf(splatBits(kSrgbFirstBits)), splatFloat(1.0f));
    const VU bits = bitsOf(clamped);
    const VU bucket = hn::Sub(hn::ShiftRight<16>(bits), splatBits(kSrgbFirstBucket));
    const VU entry = hn::GatherIndex(U32(), kSrgbFromLinear.data(), hn::BitCast(I32(), bucket));
    const VI within = hn::BitCast(I32(), hn::And(bits, splatBits(0xffffu)));
    const VI threshold = hn::BitCast(I32(), hn::And(entry, splatBits(0x1ffffu)));
    const VI below = hn::VecFromMask(I32(), hn::Gt(threshold, within));  // -1 below the threshold
    return hn::Add(hn::Add(hn::ShiftRight<17>(entry), splatBits(1)), hn::BitCast(U32(), below));
}

/// The value of a component of kind kKind, as the bits of a plane's lane.
template <ComponentKind kKind>
HWY_INLINE VU decodeV(VU code, int bits) {
    if constexpr (kKind == ComponentKind::unorm) return bitsOf(decodeUnormV(code, bits));
    if constexpr (kKind == ComponentKind::snorm) return bitsOf(decodeSnormV(code, bits));
    if constexpr (kKind == ComponentKind::uscaled) return bitsOf(toFloatV(code));
    if constexpr (kKind == ComponentKind::sscaled) return bitsOf(hn::ConvertTo(F32(), signExtendV(code, bits)));
    if constexpr (kKind == ComponentKind::uint) return code;
    if constexpr (kKind == ComponentKind::sint) return hn::BitCast(U32(), signExtendV(code, bits));
    if constexpr (kKind == ComponentKind::ufloat) return bitsOf(decodeUfloatV(code, bits));
    if constexpr (kKind == ComponentKind::sfloat) return bits == 32 ? code : bitsOf(decodeHalfV(code));
    if constexpr (kKind == ComponentKind::srgb) return bitsOf(decodeSrgbV(code));
}

/// The code of a component; bits above it may be set.
template <ComponentKind kKind>
HWY_INLINE VU encodeV(VU value, int bits) {
    const uint32_t max = lowBits(static_cast<uint32_t>(bits));
    if constexpr (kKind == ComponentKind::unorm) return encodeUnormV(floatOf(value), bits);
    if constexpr (kKind == ComponentKind::snorm) return encodeSnormV(floatOf(value), bits);
    if constexpr (kKind == ComponentKind::uscaled) {
        const VF clamped = clampOrLowV(floatOf(value), hn::Zero(F32()), splatFloat(static_cast<float>(max)));
        return hn::BitCast(U32(), roundProduct(clamped, 1.0f));
    }
    if constexpr (kKind == ComponentKind::sscaled) {
        const auto high = static_cast<float>(max >> 1);
        const VF clamped = clampOrLowV(zeroIfNaN(floatOf(value)), splatFloat(-high - 1), splatFloat(high));
        return hn::BitCast(U32(), roundProduct(clamped, 1.0f));
    }
    if constexpr (kKind == ComponentKind::uint) return hn::Min(value, splatBits(max));
    if constexpr (kKind == ComponentKind::sint) {
        const auto high = static_cast<int32_t>(max >> 1);
        const VI clamped = hn::Min(hn::Max(hn::BitCast(I32(), value), hn::Set(I32(), -high - 1)), hn::Set(I32(), high));
        return hn::BitCast(U32(), clamped);
    }
    if constexpr (kKind == ComponentKind::ufloat) return encodeUfloatV(floatOf(value), bits);
    if constexpr (kKind == ComponentKind::sfloat) return bits == 32 ? value : encodeHalfV(floatOf(value));
    if constexpr (kKind == ComponentKind::srgb) return encodeSrgbV(floatOf(value));
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
