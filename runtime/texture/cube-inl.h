// Cubes: the footprint of a linear filter across the edges and corners of faces. Included once per target (see
// base/simd.h).
#if defined(VERNIER_TEXTURE_CUBE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_CUBE_INL_H
#undef VERNIER_TEXTURE_CUBE_INL_H
#else
#define VERNIER_TEXTURE_CUBE_INL_H
#endif

#include "runtime/texture/cube.h"
#include "runtime/texture/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

inline Axis faceAxis(const TextureLevel& level) {
    return {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, static_cast<int32_t>(level.width), 0, true};
}

/// Moves the positions of the lanes where `fold` is set, which lie beyond one edge, to the neighbouring face.
HWY_NOINLINE static void foldLanes(VI x, VI y, VI fold, int32_t size, TexelPosition& position) {
    alignas(64) int32_t xs[kVectorLanes], ys[kVectorLanes], folds[kVectorLanes];
    alignas(64) int32_t inX[kVectorLanes], inY[kVectorLanes], slices[kVectorLanes];
    hn::Store(x, I32(), xs);
    hn::Store(y, I32(), ys);
    hn::Store(fold, I32(), folds);
    hn::Store(position.x, I32(), inX);
    hn::Store(position.y, I32(), inY);
    hn::Store(position.slice, I32(), slices);
    for (uint32_t i = 0; i < kVectorLanes; ++i) {
        if (folds[i] == 0) continue;
        const int32_t face = slices[i] % 6;
        const CubeTexel texel = foldOverEdge({face, xs[i], ys[i]}, size);
        inX[i] = texel.x;
        inY[i] = texel.y;
        slices[i] += texel.face - face;
    }
    position = {hn::Load(I32(), inX), hn::Load(I32(), inY), hn::Load(I32(), slices)};
}

/// The 2x2 texels around (s, t) on the face `slice`; tap 2j + i is (i, j). As the positions of a flat image, but texels
/// beyond an edge are those of the neighbouring face. corner[t]: all ones where tap t lies beyond two edges and has no
/// texel.
HWY_NOINLINE static void cubeTaps(const TextureLevel& level, VF s, VF t, VI slice, TexelPosition (&position)[4],
                                  VI (&corner)[4], VF& wx, VF& wy) {
    const auto size = static_cast<int32_t>(level.width);
    const auto tap = [&](VF at, VF& weight) HWY_ATTR {
        const VF zero = hn::Zero(F32()), extent = splatFloat(static_cast<float>(size));
        const VF u = hn::Sub(clampOrLowV(hn::Mul(at, extent), zero, extent), splatFloat(0.5f));
        const VF whole = hn::Floor(u);
        weight = hn::Sub(u, whole);
        return hn::ConvertTo(I32(), whole);  // -1 .. size - 1
    };
    const VI x0 = tap(s, wx), y0 = tap(t, wy), one = splatInt(1);
    const auto outside = [&](VI i)
                             HWY_ATTR { return hn::Or(hn::Lt(i, hn::Zero(I32())), hn::Gt(i, splatInt(size - 1))); };
    for (int k = 0; k < 4; ++k) {
        const VI x = (k & 1) != 0 ? hn::Add(x0, one) : x0, y = (k & 2) != 0 ? hn::Add(y0, one) : y0;
        const auto outX = outside(x), outY = outside(y);
        corner[k] = hn::VecFromMask(I32(), hn::And(outX, outY));
        position[k] = {clampIndex(x, size), clampIndex(y, size), slice};
        const auto fold = hn::Xor(outX, outY);
        if (!hn::AllFalse(I32(), fold)) foldLanes(x, y, hn::VecFromMask(I32(), fold), size, position[k]);
    }
}

/// Where `corner` is set, the mean of the other three texels; exactly that value where they are equal.
template <int kPlanes>
HWY_NOINLINE void fillCorner(VI corner, Texel& texel, const Texel& a, const Texel& b, const Texel& c) {
    const auto isCorner = hn::MaskFromVec(hn::BitCast(U32(), corner));
    if (hn::AllFalse(U32(), isCorner)) return;
    for (int p = 0; p < kPlanes; ++p) {
        const VF fa = floatOf(a[p]), fb = floatOf(b[p]), fc = floatOf(c[p]);
        const VF third = splatFloat(3.0f);
        const VF mean = hn::Add(hn::Add(hn::Div(fa, third), hn::Div(fb, third)), hn::Div(fc, third));
        const auto equal = hn::And(hn::Eq(fa, fb), hn::Eq(fb, fc));
        texel[p] = hn::IfThenElse(isCorner, bitsOf(hn::IfThenElse(equal, fa, mean)), texel[p]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
