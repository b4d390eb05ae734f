// From coordinates to texel indices, one axis at a time ("Wrapping Operation" and "Texel Filtering" of the
// Vulkan specification). Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_ADDRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_ADDRESS_INL_H
#undef VERNIER_TEXTURE_ADDRESS_INL_H
#else
#define VERNIER_TEXTURE_ADDRESS_INL_H
#endif

#include <type_traits>

#include "runtime/format/convert-inl.h"
#include "runtime/texture/texture.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

#ifndef VERNIER_INLINE_LAMBDA
#define VERNIER_INLINE_LAMBDA HWY_ATTR __attribute__((always_inline))
#endif

/// step(0), ..., step(kCount - 1), the arguments compile-time constants: arrays of vectors indexed by them
/// stay in registers, which they do not in loops (GCC copies vectors in memory piecemeal, and reloading them
/// whole stalls).
template <int kCount, int kFirst = 0, class Step>
HWY_INLINE void unrolled(const Step& step) {
    if constexpr (kFirst < kCount) {
        step(std::integral_constant<int, kFirst>());
        unrolled<kCount, kFirst + 1>(step);
    }
}

/// What is known about an address mode when a routine is compiled.
enum class Wrap { clampToEdge, any };

/// The texels of a footprint along one axis: always indices of texels that exist.
struct AxisTaps {
    VI index[2];
    VF weight;     // of index[1]
    VI inside[2];  // all ones, or zero where the border colour replaces the texel; Wrap::any only
};

/// One axis of a level, and how to address it.
struct Axis {
    VkSamplerAddressMode mode;
    int32_t size;
    int32_t offset;
    bool normalized;
};

// Coordinates are cut to this range (in texels) where the address mode keeps more distant ones at the edge or
// outside: wide enough for every size and offset, far inside int32.
constexpr float kFarTexel = 65536.0f;
constexpr float kBelowOne = 0x1.fffffep-1f;

HWY_INLINE VI splatInt(int32_t x) {
    return hn::Set(I32(), x);
}

/// i mod n, at least 0. |i| < 2^18: the quotient of floats is never wrong by a whole number.
HWY_INLINE VI moduloV(VI i, int32_t n) {
    const F32 df;
    const VF quotient = hn::Floor(hn::Div(hn::ConvertTo(df, i), splatFloat(static_cast<float>(n))));
    return hn::Sub(i, hn::Mul(hn::ConvertTo(I32(), quotient), splatInt(n)));
}

HWY_INLINE VI clampIndex(VI i, int32_t size) {
    return hn::Min(hn::Max(i, hn::Zero(I32())), splatInt(size - 1));
}

/// The coordinate in texels, in a range that converts to int safely; NaN becomes some coordinate in it.
template <Wrap kWrap>
HWY_INLINE VF texelCoordinate(VF s, const Axis& axis) {
    const auto size = static_cast<float>(axis.size);
    const VF zero = hn::Zero(F32());
    const auto repeat = [&] {
        // Exact for s >= 0. Just below a whole number the difference may round up to 1: stay inside the last
        // texel.
        const VF fraction = hn::Sub(s, hn::Floor(s));
        return hn::Mul(clampOrLowV(fraction, zero, splatFloat(kBelowOne)), splatFloat(size));
    };
    const auto keep = [&] {
        const VF u = axis.normalized ? hn::Mul(s, splatFloat(size)) : s;
        return clampOrLowV(u, splatFloat(-kFarTexel), splatFloat(kFarTexel));
    };
    if constexpr (kWrap == Wrap::clampToEdge) return keep();
    switch (axis.mode) {
        case VK_SAMPLER_ADDRESS_MODE_REPEAT:
            return repeat();
        case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: {
            const VF fraction =
                hn::NegMulAdd(splatFloat(2.0f), hn::Floor(hn::Mul(s, splatFloat(0.5f))), s);  // exact product
            return hn::Mul(clampOrLowV(fraction, zero, splatFloat(2.0f)), splatFloat(size));
        }
        default:
            return keep();
    }
}

template <Wrap kWrap>
HWY_INLINE VI wrapIndex(VI i, const Axis& axis, VI& inside) {
    const VI zero = hn::Zero(I32()), size = splatInt(axis.size);
    const auto repeat = [&] {
        if (axis.offset != 0) return moduloV(i, axis.size);
        // One step outside at most.
        const VI up = hn::IfThenElseZero(hn::Lt(i, zero), size);
        const VI down = hn::IfThenElseZero(hn::Gt(i, splatInt(axis.size - 1)), size);
        return hn::Sub(hn::Add(i, up), down);
    };
    if constexpr (kWrap == Wrap::clampToEdge) return clampIndex(i, axis.size);
    inside = hn::Set(I32(), -1);
    switch (axis.mode) {
        case VK_SAMPLER_ADDRESS_MODE_REPEAT:
            return repeat();
        case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: {
            const VI n = moduloV(i, 2 * axis.size);
            return hn::Min(n, hn::Sub(splatInt(2 * axis.size - 1), n));
        }
        case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
            return hn::Min(hn::Max(i, hn::Sub(splatInt(-1), i)), splatInt(axis.size - 1));
        case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER:
            inside = hn::VecFromMask(I32(), hn::And(hn::Gt(i, splatInt(-1)), hn::Lt(i, size)));
            break;
        default:
            break;
    }
    return clampIndex(i, axis.size);
}

template <Wrap kWrap>
HWY_INLINE void nearestTap(VF s, const Axis& axis, AxisTaps& taps) {
    const VI i = hn::ConvertTo(I32(), hn::Floor(texelCoordinate<kWrap>(s, axis)));
    taps.index[0] = wrapIndex<kWrap>(hn::Add(i, splatInt(axis.offset)), axis, taps.inside[0]);
}

HWY_INLINE void linearTaps(VF s, const Axis& axis, AxisTaps& taps) {
    const VF u = hn::Sub(texelCoordinate<Wrap::any>(s, axis), splatFloat(0.5f));
    const VF whole = hn::Floor(u);
    taps.weight = hn::Sub(u, whole);
    const VI i = hn::Add(hn::ConvertTo(I32(), whole), splatInt(axis.offset));
    taps.index[0] = wrapIndex<Wrap::any>(i, axis, taps.inside[0]);
    taps.index[1] = wrapIndex<Wrap::any>(hn::Add(i, splatInt(1)), axis, taps.inside[1]);
}

/// The four texels of a cubic filter ("Texel Cubic Filtering"), and by how far the coordinate is beyond the second.
struct CubicAxis {
    VI index[4];
    VI inside[4];
    VF fraction;
};

HWY_NOINLINE inline void cubicTaps(VF s, const Axis& axis, CubicAxis& taps) {
    const VF u = hn::Sub(texelCoordinate<Wrap::any>(s, axis), splatFloat(0.5f));
    const VF whole = hn::Floor(u);
    taps.fraction = hn::Sub(u, whole);
    // Two steps outside: addresses are wrapped as those of offset texels are.
    Axis reaching = axis;
    reaching.offset = 1;
    const VI first = hn::Add(hn::ConvertTo(I32(), whole), splatInt(axis.offset - 1));
#pragma GCC unroll 1
    for (int k = 0; k < 4; ++k)
        taps.index[k] = wrapIndex<Wrap::any>(hn::Add(first, splatInt(k)), reaching, taps.inside[k]);
}

/// Weights of the first, third and fourth texel; the second has what is left of 1 (Catmull-Rom).
struct CubicWeights {
    VF before, next, after;
};

HWY_INLINE CubicWeights cubicWeights(VF fraction) {
    const VF half = splatFloat(0.5f), a = fraction, a2 = hn::Mul(a, a), a3 = hn::Mul(a2, a);
    CubicWeights weights;
    weights.before = hn::Sub(hn::Sub(a2, hn::Mul(half, a)), hn::Mul(half, a3));
    weights.next = hn::Sub(hn::Add(hn::Mul(half, a), hn::Add(a2, a2)), hn::Mul(splatFloat(1.5f), a3));
    weights.after = hn::Mul(half, hn::Sub(a3, a2));
    return weights;
}

/// Equal texels stay what they are, and one without weight counts for nothing, whatever it holds.
HWY_INLINE VF mixCubic(const VF (&texels)[4], const CubicWeights& weights) {
    const VF base = texels[1];
    const auto term = [&](VF texel, VF weight) VERNIER_INLINE_LAMBDA {
        const auto none = hn::Or(hn::Eq(weight, hn::Zero(F32())), hn::Eq(texel, base));
        return hn::IfThenZeroElse(none, hn::Mul(weight, hn::Sub(texel, base)));
    };
    return hn::Add(base, hn::Add(hn::Add(term(texels[0], weights.before), term(texels[2], weights.next)),
                                 term(texels[3], weights.after)));
}

// Out of line, for routines that are large anyway.
[[maybe_unused]] HWY_NOINLINE static void sharedNearestTap(VF s, const Axis& axis, AxisTaps& taps) {
    nearestTap<Wrap::any>(s, axis, taps);
}
[[maybe_unused]] HWY_NOINLINE static void sharedLinearTaps(VF s, const Axis& axis, AxisTaps& taps) {
    linearTaps(s, axis, taps);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
