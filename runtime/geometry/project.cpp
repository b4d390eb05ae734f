#include "runtime/geometry/project.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/geometry/project.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Window coordinates, in double: products of powers of two and of float extremes neither overflow nor lose
/// bits, so scaling a position by a power of two changes nothing.
void windowCoordinates(const ProjectionInput& in, const ProjectionOutput& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const hn::Rebind<int32_t, decltype(d)> i;
    const auto subUnits = hn::Set(d, static_cast<double>(1u << in.subPixelBits));
    // One pixel of slack: a clamped coordinate is still recognised as outside the guard band.
    const auto low = hn::Set(d, kGuardBandMin - 1.0), high = hn::Set(d, kGuardBandMax + 2.0);
    const auto axis = [&](auto value, int c) HWY_ATTR {
        return hn::Add(hn::Mul(value, hn::Set(d, in.viewport.scale[c])), hn::Set(d, in.viewport.offset[c]));
    };
    const auto snap = [&](auto window) HWY_ATTR {
        const auto bounded = minOrSecond(maxOrSecond(window, low), high);
        return hn::DemoteTo(i, hn::Round(hn::Mul(bounded, subUnits)));
    };
    for (uint32_t n = 0; n < in.count; n += hn::Lanes(d)) {
        const auto load = [&](int c) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, in.clip[c] + n)); };
        const auto w = load(3);
        hn::StoreU(snap(axis(hn::Div(load(0), w), 0)), i, out.x + n);
        hn::StoreU(snap(axis(hn::Div(load(1), w), 1)), i, out.y + n);
        hn::StoreU(hn::DemoteTo(f, axis(hn::Div(load(2), w), 2)), f, out.z + n);
        hn::StoreU(hn::Div(hn::Set(d, 1.0), w), d, out.inverseW + n);
    }
}

void vertexFlags(const ProjectionInput& in, const ProjectionOutput& out) {
    const hn::CappedTag<float, 16> f;
    const hn::RebindToSigned<decltype(f)> i;
    const int32_t guardLow = kGuardBandMin * (1 << in.subPixelBits), guardHigh = kGuardBandMax * (1 << in.subPixelBits);
    const auto zero = hn::Zero(f);
    const auto flag = [&](auto mask, uint32_t bit) HWY_ATTR {
        return hn::IfThenElseZero(hn::RebindMask(i, mask), hn::Set(i, static_cast<int32_t>(bit)));
    };
    const auto flagInt = [&](auto mask, uint32_t bit)
                             HWY_ATTR { return hn::IfThenElseZero(mask, hn::Set(i, static_cast<int32_t>(bit))); };
    const uint32_t nearBit = in.depthClip ? uint32_t{kOutsideNear} : 0,
                   farBit = in.depthClip ? uint32_t{kOutsideFar} : 0;
    for (uint32_t n = 0; n < in.count; n += hn::Lanes(f)) {
        const auto x = hn::LoadU(f, in.clip[0] + n), y = hn::LoadU(f, in.clip[1] + n);
        const auto z = hn::LoadU(f, in.clip[2] + n), w = hn::LoadU(f, in.clip[3] + n);
        const auto minusW = hn::Neg(w);
        auto flags = flag(hn::Lt(x, minusW), kOutsideLeft);
        flags = hn::Or(flags, flag(hn::Gt(x, w), kOutsideRight));
        flags = hn::Or(flags, flag(hn::Lt(y, minusW), kOutsideTop));
        flags = hn::Or(flags, flag(hn::Gt(y, w), kOutsideBottom));
        flags = hn::Or(flags, flag(hn::Lt(z, in.negativeOneToOne ? minusW : zero), nearBit));
        flags = hn::Or(flags, flag(hn::Gt(z, w), farBit));
        flags = hn::Or(flags, flag(hn::Le(w, zero), kOutsideGuard));
        flags = hn::Or(flags, flag(hn::Or(hn::Lt(w, hn::Set(f, 0x1p-50f)), hn::Gt(w, hn::Set(f, 0x1p50f))), kUnusualW));
        const auto wx = hn::LoadU(i, out.x + n), wy = hn::LoadU(i, out.y + n);
        const auto low = hn::Set(i, guardLow), high = hn::Set(i, guardHigh);
        const auto beyond =
            hn::Or(hn::Or(hn::Lt(wx, low), hn::Gt(wx, high)), hn::Or(hn::Lt(wy, low), hn::Gt(wy, high)));
        flags = hn::Or(flags, flagInt(beyond, kOutsideGuard));
        // v - v is 0 for finite v and NaN for the others.
        const auto sum = hn::Add(hn::Add(hn::Sub(x, x), hn::Sub(y, y)), hn::Add(hn::Sub(z, z), hn::Sub(w, w)));
        flags = hn::Or(flags, flag(hn::Not(hn::Eq(sum, zero)), kNotFinite));
        hn::StoreU(hn::BitCast(hn::RebindToUnsigned<decltype(f)>(), flags), hn::RebindToUnsigned<decltype(f)>(),
                   out.flags + n);
    }
}

void project(const ProjectionInput& in, const ProjectionOutput& out) {
    windowCoordinates(in, out);
    vertexFlags(in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

ProjectFn projectFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, project)
}

}  // namespace vernier
#endif
