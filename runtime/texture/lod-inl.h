// Level of detail ("Level of Detail Operation" and "Image Level(s) Selection" of the Vulkan specification)
// and the choice of cube faces. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_LOD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_LOD_INL_H
#undef VERNIER_TEXTURE_LOD_INL_H
#else
#define VERNIER_TEXTURE_LOD_INL_H
#endif

#include <cstring>

#include "runtime/texture/address-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// log2 of a number that is not negative, within 2^-18 + 2^-24 |log2 x|; exact for powers of two. Zero and
/// denormals give -127 or a little more, infinity and NaN finite values of at least 128: every result is a
/// usable level of detail.
HWY_INLINE VF log2V(VF x) {
    const I32 di;
    const F32 df;
    // x = 2^e m with m from sqrt(1/2) to sqrt(2); then log2 m = 2/ln 2 (s + s^3/3 + s^5/5 + ...), s = (m - 1)
    // / (m + 1).
    constexpr int32_t kSqrtHalf = 0x3f3504f3;
    const VI bits = hn::And(hn::BitCast(di, x), splatInt(0x7fffffff));
    const VI e = hn::ShiftRight<23>(hn::Sub(bits, splatInt(kSqrtHalf)));
    const VF m = hn::BitCast(df, hn::Sub(bits, hn::ShiftLeft<23>(e)));
    const VF one = splatFloat(1.0f);
    const VF s = hn::Div(hn::Sub(m, one), hn::Add(m, one));
    const VF s2 = hn::Mul(s, s);
    constexpr float kTwoOverLn2 = 2.88539008f;
    VF series = hn::Add(hn::Mul(s2, splatFloat(kTwoOverLn2 / 5)), splatFloat(kTwoOverLn2 / 3));
    series = hn::Add(hn::Mul(series, s2), splatFloat(kTwoOverLn2));
    return hn::Add(hn::ConvertTo(df, e), hn::Mul(series, s));
}

template <class T, class D = hn::ScalableTag<T>>
HWY_NOINLINE hn::Vec<D> loadSomeLanes(const T* plane, uint32_t count) {
    alignas(64) T part[hn::MaxLanes(D())] = {};
    std::memcpy(part, plane, count * sizeof(T));
    return hn::Load(D(), part);
}

/// Lanes of a plane; zero where there is none and beyond the end. `count` is the number of lanes left.
template <class T, class D = hn::ScalableTag<T>>
HWY_INLINE hn::Vec<D> loadLanes(const T* plane, uint32_t first, uint32_t count) {
    const D d;
    if (plane == nullptr) return hn::Zero(d);
    if (HWY_LIKELY(count >= hn::Lanes(d))) return hn::LoadU(d, plane + first);
    return loadSomeLanes(plane + first, count);
}

HWY_NOINLINE static void storeSomeLanes(VU value, float* plane, uint32_t count) {
    alignas(64) float part[hn::MaxLanes(F32())];
    hn::Store(floatOf(value), F32(), part);
    std::memcpy(plane, part, count * sizeof(float));
}

HWY_INLINE void storeLanes(VU value, float* plane, uint32_t first, uint32_t count) {
    if (HWY_LIKELY(count >= hn::Lanes(U32()))) {
        hn::StoreU(floatOf(value), F32(), plane + first);
    } else {
        storeSomeLanes(value, plane + first, count);
    }
}

/// The horizontal and vertical difference over each quad, in all its lanes. A vector holds whole quads, one
/// per block of 128 bits.
HWY_INLINE VF quadDx(VF x) {
    return hn::Sub(hn::Broadcast<1>(x), hn::Broadcast<0>(x));
}
HWY_INLINE VF quadDy(VF x) {
    return hn::Sub(hn::Broadcast<2>(x), hn::Broadcast<0>(x));
}

/// A direction seen from its cube face.
struct FaceVector {
    VF s, t, major;
};

struct FaceChoice {
    hn::Mask<F32> z, y;  // major axis; neither: x
    hn::Mask<F32> negative;
    VI face;
};

HWY_INLINE FaceChoice chooseFace(VF x, VF y, VF z) {
    FaceChoice choice;
    const VF ax = hn::Abs(x), ay = hn::Abs(y), az = hn::Abs(z);
    choice.z = hn::And(hn::Ge(az, ax), hn::Ge(az, ay));
    choice.y = hn::AndNot(choice.z, hn::Ge(ay, ax));
    const VF major = hn::IfThenElse(choice.z, z, hn::IfThenElse(choice.y, y, x));
    choice.negative = hn::Lt(major, hn::Zero(F32()));
    const auto whole = [](hn::Mask<F32> m) { return hn::RebindMask(I32(), m); };
    const VI axis = hn::IfThenElse(whole(choice.z), splatInt(4), hn::IfThenElseZero(whole(choice.y), splatInt(2)));
    choice.face = hn::Add(axis, hn::IfThenElseZero(whole(choice.negative), splatInt(1)));
    return choice;
}

/// The vector in the chosen face's axes ("Cube Map Face Selection": s, t, and the major axis made positive).
/// Linear, so that it maps derivatives too.
HWY_INLINE FaceVector onFace(const FaceChoice& choice, VF x, VF y, VF z) {
    const VF nx = hn::Neg(x), ny = hn::Neg(y), nz = hn::Neg(z);
    const auto negative = choice.negative;
    FaceVector v;
    const VF sOfX = hn::IfThenElse(negative, z, nz), sOfZ = hn::IfThenElse(negative, nx, x);
    v.s = hn::IfThenElse(choice.z, sOfZ, hn::IfThenElse(choice.y, x, sOfX));
    const VF tOfY = hn::IfThenElse(negative, nz, z);
    v.t = hn::IfThenElse(hn::AndNot(choice.z, choice.y), tOfY, ny);
    const VF major = hn::IfThenElse(choice.z, z, hn::IfThenElse(choice.y, y, x));
    v.major = hn::IfThenElse(negative, hn::Neg(major), major);
    return v;
}

/// Derivative of 0.5 * s / major + 0.5 and likewise t ("Cube Map Derivative Transformation").
HWY_INLINE void projectDerivative(const FaceVector& at, const FaceVector& d, VF& ds, VF& dt) {
    const VF scale = hn::Div(splatFloat(0.5f), hn::Mul(at.major, at.major));
    ds = hn::Mul(hn::Sub(hn::Mul(d.s, at.major), hn::Mul(at.s, d.major)), scale);
    dt = hn::Mul(hn::Sub(hn::Mul(d.t, at.major), hn::Mul(at.t, d.major)), scale);
}

/// The levels a footprint takes its texels from.
struct LevelChoice {
    VI high, low;  // low is the less detailed one; read with VK_SAMPLER_MIPMAP_MODE_LINEAR only
    VF weight;     // of low
    VF lambda;     // after the clamp: decides between magnification and minification
};

/// lambda prime: lambda from `request` (through `implicitLambda` where derivatives are asked for) plus the
/// biases.
template <class Lambda>
HWY_INLINE VF biasedLambda(const SamplerState& sampler, const SampleRequest& request, uint32_t first, uint32_t count,
                           Lambda implicitLambda) {
    VF lambda = hn::Zero(F32()), bias = splatFloat(sampler.mipLodBias);
    switch (request.lodMode) {
        case LodMode::implicitLod:
            lambda = implicitLambda();
            bias = hn::Add(bias, loadLanes(request.lod, first, count));
            break;
        case LodMode::gradients:
            lambda = implicitLambda();
            break;
        case LodMode::explicitLod:
            lambda = loadLanes(request.lod, first, count);
            break;
        case LodMode::base:
            break;
    }
    return hn::Add(lambda, clampOrLowV(bias, splatFloat(-kMaxSamplerLodBias), splatFloat(kMaxSamplerLodBias)));
}

/// The lower bound of the level of detail: the sampler's, or the instruction's if that is higher.
HWY_INLINE VF lowestLod(const SamplerState& sampler, const SampleRequest& request, uint32_t first, uint32_t count) {
    const VF lowest = splatFloat(sampler.minLod);
    return request.minLod == nullptr ? lowest : maxOrSecond(lowest, loadLanes(request.minLod, first, count));
}

HWY_INLINE LevelChoice chooseLevels(const TextureView& view, const SamplerState& sampler, VF lowest, VF lambdaPrime) {
    const F32 df;
    const I32 di;
    LevelChoice choice;
    choice.lambda = clampOrLowV(lambdaPrime, lowest, splatFloat(sampler.maxLod));
    const auto last = static_cast<int32_t>(view.levelCount) - 1;
    const bool linear = sampler.mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const float first = linear ? view.minLod : static_cast<float>(static_cast<int32_t>(view.minLod));
    const VF d = clampOrLowV(choice.lambda, splatFloat(first), splatFloat(static_cast<float>(last)));
    if (linear) {
        const VF whole = hn::Floor(d);
        choice.high = hn::ConvertTo(di, whole);
        choice.low = hn::Min(hn::Add(choice.high, splatInt(1)), splatInt(last));
        choice.weight = hn::Sub(d, whole);
    } else {
        const VF nearest = hn::Sub(hn::Ceil(hn::Add(d, splatFloat(0.5f))), splatFloat(1.0f));
        choice.high = hn::ConvertTo(di, nearest);
        choice.low = choice.high;
        choice.weight = hn::Zero(df);
    }
    return choice;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
