// Planes of a primitive evaluated on lanes of pixels; the same operations as depthAt(), so the same bits.
#if defined(VERNIER_RUNTIME_RASTER_PLANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_RUNTIME_RASTER_PLANES_INL_H
#undef VERNIER_RUNTIME_RASTER_PLANES_INL_H
#else
#define VERNIER_RUNTIME_RASTER_PLANES_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "runtime/raster/triangle_planes.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// constant + (gx * dx + gy * dy) in double. `x`, `y` are whole pixels from the anchor, `ox`, `oy` the rest.
template <class DF, class V>
HWY_INLINE V planeInDouble(DF f, V x, V y, V ox, V oy, double constant, double gx, double gy) {
    const hn::RepartitionToWide<DF> d;
    const hn::Half<DF> half;
    const auto evaluate = [&](auto px, auto py, auto fx, auto fy) HWY_ATTR {
        const auto dx = hn::Add(hn::PromoteTo(d, px), hn::PromoteTo(d, fx));
        const auto dy = hn::Add(hn::PromoteTo(d, py), hn::PromoteTo(d, fy));
        return hn::DemoteTo(
            half, hn::Add(hn::Set(d, constant), hn::Add(hn::Mul(hn::Set(d, gx), dx), hn::Mul(hn::Set(d, gy), dy))));
    };
    const auto low =
        evaluate(hn::LowerHalf(half, x), hn::LowerHalf(half, y), hn::LowerHalf(half, ox), hn::LowerHalf(half, oy));
    const auto high =
        evaluate(hn::UpperHalf(half, x), hn::UpperHalf(half, y), hn::UpperHalf(half, ox), hn::UpperHalf(half, oy));
    return hn::Combine(f, high, low);
}

template <class DF, class V>
HWY_INLINE V clampDepth(DF f, const TrianglePlanes& p, V z) {
    return maxOrSecond(minOrSecond(z, hn::Set(f, p.zHigh)), hn::Set(f, p.zLow));
}

/// Depth at pixels (x, y) from the anchor, at the place (ox, oy) = offset - fraction inside them.
template <class DF, class V>
HWY_INLINE V depthOf(DF f, const TrianglePlanes& p, V x, V y, V ox, V oy) {
    V z;
    if (HWY_UNLIKELY(p.precise)) {
        z = planeInDouble(f, x, y, ox, oy, p.d.z0, p.d.zx, p.d.zy);
    } else {
        const V dx = hn::Add(x, ox), dy = hn::Add(y, oy);
        z = hn::Add(hn::Set(f, p.z0), hn::Add(hn::Mul(hn::Set(f, p.zx), dx), hn::Mul(hn::Set(f, p.zy), dy)));
    }
    return clampDepth(f, p, z);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
