#include "runtime/geometry/small_triangles.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/geometry/small_triangles.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/project.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using I = hn::CappedTag<int32_t, kTriangleGroup>;
using V = hn::Vec<I>;
using M = hn::Mask<I>;
constexpr uint32_t kLanes = hn::MaxLanes(I());

struct Corner {
    V x, y, number;
};

HWY_INLINE Corner choose(M mask, const Corner& yes, const Corner& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.number, no.number)};
}

/// Higher on the screen, or on the left at the same height.
HWY_INLINE M before(const Corner& a, const Corner& b) {
    return hn::Or(hn::Lt(a.y, b.y), hn::And(hn::Eq(a.y, b.y), hn::Lt(a.x, b.x)));
}

HWY_INLINE V least(V a, V b, V c) {
    return hn::Min(hn::Min(a, b), c);
}
HWY_INLINE V greatest(V a, V b, V c) {
    return hn::Max(hn::Max(a, b), c);
}

HWY_INLINE uint32_t bitsOf(M mask, uint32_t first) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(I(), mask, bytes);
    return (bytes[0] | uint32_t{bytes[1]} << 8) << first;
}

/// What the vertices of triangles are, by triangle.
struct Gathered {
    alignas(64) std::array<int32_t, kTriangleGroup> x[3], y[3], any, all;
};

/// A vector of triangles, from `first` on.
HWY_INLINE void setUp(const TriangleGroupInput& in, const Gathered& from, uint32_t first, TriangleGroup& out) {
    const I i;
    const V zero = hn::Zero(i);
    const auto isSet = [&](const auto& flags, uint32_t bits) HWY_ATTR {
        return hn::Ne(hn::And(hn::Load(i, flags.data() + first), hn::Set(i, static_cast<int32_t>(bits))), zero);
    };
    const M rejected = hn::Or(isSet(from.any, kNotFinite), isSet(from.all, kOutsideVolume | kOutsideUserAll));
    const M clipped = isSet(from.any, kOutsideGuard | kOutsideNear | kOutsideFar | kOutsideUserAll | kUnusualW);
    Corner v[3];
    for (size_t n = 0; n < 3; ++n)
        v[n] = {hn::Load(i, from.x[n].data() + first), hn::Load(i, from.y[n].data() + first),
                hn::Set(i, static_cast<int32_t>(n))};

    const V minX = least(v[0].x, v[1].x, v[2].x), maxX = greatest(v[0].x, v[1].x, v[2].x);
    const V minY = least(v[0].y, v[1].y, v[2].y), maxY = greatest(v[0].y, v[1].y, v[2].y);
    const V limit = hn::Set(i, 1 << kTinyEdgeBits);
    const M tiny = hn::Not(hn::Or(hn::Gt(hn::Sub(maxX, minX), limit), hn::Gt(hn::Sub(maxY, minY), limit)));
    // Of tiny triangles, twice the area has 2 * kTinyEdgeBits bits and one more.
    const V area = hn::Sub(hn::Mul(hn::Sub(v[1].x, v[0].x), hn::Sub(v[2].y, v[0].y)),
                           hn::Mul(hn::Sub(v[1].y, v[0].y), hn::Sub(v[2].x, v[0].x)));
    const M clockwise = hn::Gt(area, zero);
    const M front = in.clockwiseIsFront ? clockwise : hn::Lt(area, zero);
    const M back = in.clockwiseIsFront ? hn::Lt(area, zero) : clockwise;
    M dead = hn::Eq(area, zero);
    if (in.cullFront) dead = hn::Or(dead, front);
    if (in.cullBack) dead = hn::Or(dead, back);

    // Pixels whose centres lie in the bounds.
    const auto bits = static_cast<int>(in.subPixelBits);
    const V half = hn::Set(i, 1 << (bits - 1)), belowHalf = hn::Set(i, (1 << (bits - 1)) - 1);
    const V x0 = hn::Max(hn::ShiftRightSame(hn::Add(minX, belowHalf), bits), hn::Set(i, in.area.x0));
    const V y0 = hn::Max(hn::ShiftRightSame(hn::Add(minY, belowHalf), bits), hn::Set(i, in.area.y0));
    const V x1 = hn::Min(hn::ShiftRightSame(hn::Sub(maxX, half), bits), hn::Set(i, in.area.x1 - 1));
    const V y1 = hn::Min(hn::ShiftRightSame(hn::Sub(maxY, half), bits), hn::Set(i, in.area.y1 - 1));
    dead = hn::Or(dead, hn::Or(hn::Gt(x0, x1), hn::Gt(y0, y1)));
    const V extent = hn::Set(i, kSmallExtent);
    const M fits = hn::And(hn::Lt(hn::Sub(x1, x0), extent), hn::Lt(hn::Sub(y1, y0), extent));
    const M simple = hn::AndNot(clipped, tiny);
    const M small = hn::AndNot(rejected, hn::AndNot(dead, hn::And(simple, fits)));
    const M over = hn::Or(rejected, hn::Or(small, hn::And(simple, dead)));
    out.counted |= bitsOf(hn::Not(rejected), first);
    out.ordinary |= bitsOf(hn::Not(over), first);
    out.small |= bitsOf(small, first);
    out.front |= bitsOf(front, first);

    // Clockwise, and from the first corner on.
    const M turns = hn::Not(clockwise);
    const Corner second = choose(turns, v[2], v[1]), third = choose(turns, v[1], v[2]);
    const M secondFirst = before(second, v[0]);
    const M startsThird =
        hn::Or(hn::And(secondFirst, before(third, second)), hn::AndNot(secondFirst, before(third, v[0])));
    const M startsSecond = hn::AndNot(startsThird, secondFirst);
    const Corner corners[3] = {choose(startsThird, third, choose(startsSecond, second, v[0])),
                               choose(startsThird, v[0], choose(startsSecond, third, second)),
                               choose(startsThird, second, choose(startsSecond, v[0], third))};
    for (size_t n = 0; n < 3; ++n) {
        hn::Store(corners[n].x, i, out.x[n].data() + first);
        hn::Store(corners[n].y, i, out.y[n].data() + first);
        hn::Store(corners[n].number, i, out.corner[n].data() + first);
    }
    const V lowHalf = hn::Set(i, 0xFFFF);
    hn::Store(hn::Or(hn::And(x0, lowHalf), hn::ShiftLeft<16>(y0)), i, out.low.data() + first);
    hn::Store(hn::Or(hn::And(x1, lowHalf), hn::ShiftLeft<16>(y1)), i, out.high.data() + first);
    const auto tileOf = [&](V pixel, int32_t origin)
                            HWY_ATTR { return hn::ShiftRight<kTileBits>(hn::Sub(pixel, hn::Set(i, origin))); };
    const V tx = tileOf(x0, in.gridX), ty = tileOf(y0, in.gridY);
    const M spread = hn::Or(hn::Ne(tx, tileOf(x1, in.gridX)), hn::Ne(ty, tileOf(y1, in.gridY)));
    out.spread |= bitsOf(spread, first);
    hn::Store(hn::Add(hn::Mul(ty, hn::Set(i, static_cast<int32_t>(in.columns))), tx), i, out.tile.data() + first);
}

void setUpTriangles(const TriangleGroupInput& in, TriangleGroup& out) {
    Gathered from;
    for (uint32_t n = 0; n < in.count; ++n) {
        uint32_t any = 0, all = ~0u;
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = in.triangles[n][corner];
            from.x[corner][n] = in.x[vertex];
            from.y[corner][n] = in.y[vertex];
            any |= in.flags[vertex];
            all &= in.flags[vertex];
        }
        from.any[n] = static_cast<int32_t>(any);
        from.all[n] = static_cast<int32_t>(all);
    }
    for (uint32_t n = in.count; n % kLanes != 0; ++n) {
        for (size_t corner = 0; corner < 3; ++corner) from.x[corner][n] = from.y[corner][n] = 0;
        from.any[n] = from.all[n] = 0;
    }
    out.counted = out.ordinary = out.small = out.front = out.spread = 0;
    for (uint32_t n = 0; n < in.count; n += kLanes) setUp(in, from, n, out);
    const uint32_t all = (1u << in.count) - 1;
    out.counted &= all;
    out.ordinary &= all;
    out.small &= all;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

SetUpTrianglesFn setUpTrianglesFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, setUpTriangles)
}

}  // namespace vernier
#endif
