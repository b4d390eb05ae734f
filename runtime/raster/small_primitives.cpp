#include "runtime/raster/small_primitives.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/small_primitives.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/raster/depth_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

using F = hn::CappedTag<float, kSmallGroup>;
using I = hn::RebindToSigned<F>;
using VFloat = hn::Vec<F>;
using VInt = hn::Vec<I>;
constexpr uint32_t kLanes = hn::MaxLanes(F());

/// Window coordinates and bounds of a group, by primitive.
struct Corners {
    alignas(64) std::array<int32_t, kSmallGroup> x[3], y[3], left, top;  // left, top: pixels
    alignas(64) std::array<float, kSmallGroup> z[3], depthBias;
    std::array<uint64_t, kSmallGroup> rectangle;  // bit 8 y + x: in the bounds
    uint32_t points = 0;                          // bit per primitive: it covers its bounds
    int32_t width = 0, height = 0;                // of the greatest bounds
};

/// Primitives to one array for each of their parts.
void collect(const SmallInput& in, Corners& corners, SmallGroup& group) {
    group.count = in.count;
    group.affine = 0;
    const int32_t fractionMask = (1 << in.subPixelBits) - 1;
    const auto inverse = static_cast<float>(1 / static_cast<double>(1u << in.subPixelBits));
    for (uint32_t lane = 0; lane < in.count; ++lane) {
        const Primitive& p = *in.primitives[lane];
        const float* const attributes = in.attributes[lane];
        for (size_t v = 0; v < 3; ++v) {
            corners.x[v][lane] = p.x[v];
            corners.y[v][lane] = p.y[v];
            corners.z[v][lane] = p.z[v];
            group.attributes[v][lane] = attributes + p.attributes[v];
        }
        corners.depthBias[lane] = p.depthBias;
        group.flat[lane] = attributes + p.flat;
        group.w0[lane] = p.w[0];
        group.w1[lane] = p.w[1];
        group.w2[lane] = p.w[2];
        group.affine |= static_cast<uint32_t>(p.affine) << lane;
        corners.points |= static_cast<uint32_t>(p.isPoint) << lane;
        const int32_t left = std::max<int32_t>(p.bounds[0], in.tileX), top = std::max<int32_t>(p.bounds[1], in.tileY);
        const int32_t width = std::min<int32_t>(p.bounds[2] + 1, in.tileX + kTileSize) - left;
        const int32_t height = std::min<int32_t>(p.bounds[3] + 1, in.tileY + kTileSize) - top;
        corners.left[lane] = left;
        corners.top[lane] = top;
        corners.width = std::max(corners.width, width);
        corners.height = std::max(corners.height, height);
        corners.rectangle[lane] = (0xFFu >> (8 - width)) * (0x0101010101010101u >> (8 * (8 - height)));
        group.left[lane] = static_cast<uint32_t>(left - in.tileX);
        group.top[lane] = static_cast<uint32_t>(top - in.tileY);
        group.originX[lane] = in.tileX - (p.x[0] >> in.subPixelBits);
        group.originY[lane] = in.tileY - (p.y[0] >> in.subPixelBits);
        group.centreX[lane] = 0.5f - static_cast<float>(p.x[0] & fractionMask) * inverse;
        group.centreY[lane] = 0.5f - static_cast<float>(p.y[0] & fractionMask) * inverse;
    }
    for (uint32_t lane = in.count; lane % kLanes != 0; ++lane) {
        for (size_t v = 0; v < 3; ++v) corners.x[v][lane] = corners.y[v][lane] = 0;
        corners.left[lane] = corners.top[lane] = 0;
    }
}

/// Coverage of a vector of primitives from `first` on: the edge functions of TileEdges, pixel by pixel of the bounds.
/// Edges are at most 2^kTinyEdgeBits long, and so are the distances from their ends, so that 32 bits hold everything.
HWY_INLINE void cover(const SmallInput& in, const Corners& corners, uint32_t first, uint32_t* low, uint32_t* high) {
    const I i;
    const auto bits = static_cast<int>(in.subPixelBits);
    const VInt zero = hn::Zero(i), half = hn::Set(i, 1 << (bits - 1));
    const VInt centreX = hn::Add(hn::ShiftLeftSame(hn::Load(i, corners.left.data() + first), bits), half);
    const VInt centreY = hn::Add(hn::ShiftLeftSame(hn::Load(i, corners.top.data() + first), bits), half);
    VInt a[3], b[3], c[3];
    for (size_t e = 0; e < 3; ++e) {
        const size_t next = e == 2 ? 0 : e + 1;
        const VInt x = hn::Load(i, corners.x[e].data() + first), y = hn::Load(i, corners.y[e].data() + first);
        const VInt dx = hn::Sub(hn::Load(i, corners.x[next].data() + first), x);
        const VInt dy = hn::Sub(hn::Load(i, corners.y[next].data() + first), y);
        const auto topLeft = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
        const VInt tie = hn::IfThenZeroElse(topLeft, hn::Set(i, 1));
        const VInt value = hn::Sub(hn::Sub(hn::Mul(dx, hn::Sub(centreY, y)), hn::Mul(dy, hn::Sub(centreX, x))), tie);
        a[e] = hn::Neg(dy);
        b[e] = dx;
        c[e] = hn::ShiftRightSame(value, bits);
    }
    VInt covered[2] = {zero, zero};  // rows 0 to 3, and 4 to 7
    for (int32_t y = 0; y < corners.height; ++y) {
        VInt edge[3] = {c[0], c[1], c[2]};
        VInt row = zero;
        for (int32_t x = 0; x < corners.width; ++x) {
            const VInt outside = hn::BroadcastSignBit(hn::Or(hn::Or(edge[0], edge[1]), edge[2]));
            row = hn::Or(row, hn::AndNot(outside, hn::Set(i, static_cast<int32_t>(1u << (8 * (y % 4) + x)))));
            for (size_t e = 0; e < 3; ++e) edge[e] = hn::Add(edge[e], a[e]);
        }
        covered[y / 4] = hn::Or(covered[y / 4], row);
        for (size_t e = 0; e < 3; ++e) c[e] = hn::Add(c[e], b[e]);
    }
    const hn::RebindToUnsigned<I> u;
    hn::Store(hn::BitCast(u, covered[0]), u, low + first);
    hn::Store(hn::BitCast(u, covered[1]), u, high + first);
}

/// makePlanes() for a vector of primitives; of a point, makeShapePlanes(). Returns which are too thin for float.
HWY_INLINE uint64_t makePlanesOf(const SmallInput& in, const Corners& corners, uint32_t first, SmallGroup& group) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const hn::Rebind<int32_t, decltype(d)> i;
    const auto difference = [&](const auto& values, size_t v) HWY_ATTR {
        return hn::PromoteTo(d,
                             hn::Sub(hn::LoadU(i, values[v].data() + first), hn::LoadU(i, values[0].data() + first)));
    };
    const auto depth = [&](const auto& values)
                           HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, values.data() + first)); };
    const auto store = [&](auto value, auto& to) HWY_ATTR { hn::StoreU(hn::DemoteTo(f, value), f, to.data() + first); };
    const auto x1 = difference(corners.x, 1), y1 = difference(corners.y, 1);
    const auto x2 = difference(corners.x, 2), y2 = difference(corners.y, 2);
    const auto area = hn::Sub(hn::Mul(x1, y2), hn::Mul(y1, x2));
    const auto subUnits = hn::Set(d, static_cast<double>(1u << in.subPixelBits));
    const auto perPixel = hn::Div(subUnits, area);
    const auto isTriangle = hn::Ne(area, hn::Zero(d));
    const auto slope = [&](auto value) HWY_ATTR { return hn::IfThenElseZero(isTriangle, hn::Mul(value, perPixel)); };
    const auto l1x = slope(y2), l1y = slope(hn::Neg(x2)), l2x = slope(hn::Neg(y1)), l2y = slope(x1);
    const auto reach = [&](auto u, auto v) HWY_ATTR {
        return maxOrSecond(maxOrSecond(hn::Abs(u), hn::Abs(v)), hn::Abs(hn::Sub(u, v)));
    };
    const auto extent = hn::Div(hn::Add(reach(x1, x2), reach(y1, y2)), subUnits);
    const auto z0 = depth(corners.z[0]);
    const auto dz1 = hn::Sub(depth(corners.z[1]), z0), dz2 = hn::Sub(depth(corners.z[2]), z0);
    store(l1x, group.l1x);
    store(l1y, group.l1y);
    store(l2x, group.l2x);
    store(l2y, group.l2y);
    store(hn::Add(z0, depth(corners.depthBias)), group.z0);
    store(hn::Add(hn::Mul(dz1, l1x), hn::Mul(dz2, l2x)), group.zx);
    store(hn::Add(hn::Mul(dz1, l1y), hn::Mul(dz2, l2y)), group.zy);
    const auto steepest = maxOrSecond(maxOrSecond(hn::Abs(l1x), hn::Abs(l1y)), maxOrSecond(hn::Abs(l2x), hn::Abs(l2y)));
    uint8_t thin[8] = {};
    hn::StoreMaskBits(d, hn::Gt(hn::Mul(steepest, extent), hn::Set(d, kThinTriangle)), thin);
    return uint64_t{thin[0]} << first;
}

void setUpSmall(const SmallInput& in, SmallGroup& group) {
    Corners corners;
    collect(in, corners, group);
    alignas(64) std::array<uint32_t, kSmallGroup> low, high;
    for (uint32_t n = 0; n < in.count; n += kLanes) cover(in, corners, n, low.data(), high.data());
    for (uint32_t lane = 0; lane < in.count; ++lane) {
        const uint64_t square = 0 - uint64_t{corners.points >> lane & 1};
        group.pixels[lane] = (low[lane] | uint64_t{high[lane]} << 32 | square) & corners.rectangle[lane];
    }
    uint64_t precise = 0;
    for (uint32_t n = 0; n < in.count; n += hn::MaxLanes(hn::CappedTag<double, 8>()))
        precise |= makePlanesOf(in, corners, n, group);
    group.precise = static_cast<uint32_t>(precise & ((1u << in.count) - 1));
    group.zLow = in.zLow;
    group.zHigh = in.zHigh;
}

// --- From here on a lane is a fragment

/// The parts of a vector of fragments.
struct Places {
    explicit HWY_INLINE Places(const SmallFragment* fragments) {
        const I i;
        const hn::Rebind<uint16_t, I> u16;
        const VInt all = hn::PromoteTo(i, hn::LoadU(u16, fragments));
        const VInt six = hn::Set(i, kTileSize - 1);
        x = hn::And(all, six);
        y = hn::And(hn::ShiftRight<6>(all), six);
        primitive = hn::ShiftRight<12>(all);
    }
    VInt x, y, primitive;
};

/// table[index], by lane.
template <class T>
HWY_INLINE auto lookUp(const std::array<T, kSmallGroup>& table, VInt index) {
    const hn::Rebind<T, I> d;
    if constexpr (kLanes == kSmallGroup)
        return hn::TableLookupLanes(hn::Load(d, table.data()), hn::IndicesFromVec(d, index));
    else
        return hn::GatherIndex(d, table.data(), index);
}

/// Distances of the pixels' centres from the anchor.
struct Distances {
    HWY_INLINE Distances(const SmallGroup& group, const Places& at) {
        const F f;
        dx = hn::Add(hn::ConvertTo(f, hn::Add(at.x, lookUp(group.originX, at.primitive))),
                     lookUp(group.centreX, at.primitive));
        dy = hn::Add(hn::ConvertTo(f, hn::Add(at.y, lookUp(group.originY, at.primitive))),
                     lookUp(group.centreY, at.primitive));
    }
    VFloat dx, dy;
};

/// depthOf() of a vector of fragments.
HWY_INLINE VFloat depthsOf(const SmallGroup& group, const Places& at) {
    const F f;
    const Distances from(group, at);
    const VFloat slope =
        hn::Add(hn::Mul(lookUp(group.zx, at.primitive), from.dx), hn::Mul(lookUp(group.zy, at.primitive), from.dy));
    const VFloat z = hn::Add(lookUp(group.z0, at.primitive), slope);
    return maxOrSecond(minOrSecond(z, hn::Set(f, group.zHigh)), hn::Set(f, group.zLow));
}

template <class Format, class Compare>
uint32_t testBy(const Compare& compare, const SmallTestInput& in, SmallFragment* fragments, uint32_t count) {
    constexpr uint32_t kPart = hn::MaxLanes(F8()), kBytes = Format::kTexelBytes;
    const I i;
    const hn::DFromV<typename Format::Value> dv;
    // Copied: texels are bytes, whose stores could change anything that is read through a pointer.
    std::byte* const origin = in.texels;
    const bool writes = in.plan->write;
    uint32_t kept = 0;
    for (uint32_t n = 0; n < count; n += kLanes) {
        const Places at(fragments + n);
        alignas(64) float depths[kLanes];
        alignas(64) int32_t offsets[kLanes];
        hn::Store(depthsOf(*in.group, at), F(), depths);
        hn::Store(hn::Add(hn::Mul(at.y, hn::Set(i, static_cast<int32_t>(in.rowPitch))),
                          hn::Mul(at.x, hn::Set(i, static_cast<int32_t>(kBytes)))),
                  i, offsets);
        const uint32_t lanes = std::min(kLanes, count - n);
        for (uint32_t part = 0; part < lanes; part += kPart) {
            const uint32_t some = std::min(kPart, lanes - part);
            alignas(64) std::byte texels[kPart * kBytes];
            for (uint32_t lane = 0; lane < some; ++lane)
                std::memcpy(texels + lane * kBytes, origin + offsets[part + lane], kBytes);
            const auto z = Format::encode(hn::Load(F8(), depths + part));
            const auto stored = Format::load(texels);
            const auto pass = compare(z, stored);
            uint8_t passBits[8] = {};
            hn::StoreMaskBits(dv, pass, passBits);
            const uint32_t passed = passBits[0] & ((1u << some) - 1);
            if (passed == 0) continue;
            if (writes) Format::store(z, texels);
            if (passed == (1u << kPart) - 1) {  // as when nothing hides anything
                for (uint32_t lane = 0; writes && lane < kPart; ++lane)
                    std::memcpy(origin + offsets[part + lane], texels + lane * kBytes, kBytes);
                std::memmove(fragments + kept, fragments + n + part, kPart * sizeof(SmallFragment));
                kept += kPart;
                continue;
            }
            for (uint32_t rest = passed; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
                if (writes) std::memcpy(origin + offsets[part + lane], texels + lane * kBytes, kBytes);
                fragments[kept++] = fragments[n + part + lane];
            }
        }
    }
    return kept;
}

template <class Format>
uint32_t testFormat(const SmallTestInput& in, SmallFragment* fragments, uint32_t count) {
    using V = typename Format::Value;
    if (in.plan->compare == VK_COMPARE_OP_LESS)
        return testBy<Format>([](V a, V b) HWY_ATTR { return hn::Lt(a, b); }, in, fragments, count);
    return testBy<Format>(Comparison<hn::DFromV<V>>(in.plan->compare), in, fragments, count);
}

uint32_t testSmall(const SmallTestInput& in, SmallFragment* fragments, uint32_t count) {
    switch (in.plan->storage) {
        case DepthStorage::d16:
            return testFormat<Unorm16>(in, fragments, count);
        case DepthStorage::d24:
            return testFormat<Unorm24>(in, fragments, count);
        case DepthStorage::d32f:
            return testFormat<Float32>(in, fragments, count);
        case DepthStorage::d32fs8:
            return testFormat<Float32Stencil8>(in, fragments, count);
        case DepthStorage::none:
            return count;
    }
    return count;
}

using Quad = hn::CappedTag<float, 4>;
using VQuad = hn::Vec<Quad>;

/// Four attributes of four primitives from `lane` on, to rows of primitives.
HWY_INLINE void storeTransposed(const VQuad* v, SmallAttribute* to,
                                std::array<float, kSmallGroup> SmallAttribute::*part, uint32_t lane) {
    const Quad q;
    const VQuad low01 = hn::InterleaveLower(q, v[0], v[1]), low23 = hn::InterleaveLower(q, v[2], v[3]);
    const VQuad high01 = hn::InterleaveUpper(q, v[0], v[1]), high23 = hn::InterleaveUpper(q, v[2], v[3]);
    hn::StoreU(hn::ConcatLowerLower(q, low23, low01), q, (to[0].*part).data() + lane);
    hn::StoreU(hn::ConcatUpperUpper(q, low23, low01), q, (to[1].*part).data() + lane);
    hn::StoreU(hn::ConcatLowerLower(q, high23, high01), q, (to[2].*part).data() + lane);
    hn::StoreU(hn::ConcatUpperUpper(q, high23, high01), q, (to[3].*part).data() + lane);
}

/// Attributes `varying` and the three after it.
HWY_INLINE void gatherFour(const SmallGroup& group, uint32_t varying, SmallAttribute* to) {
    const Quad q;
    for (uint32_t lane = 0; lane < group.count; lane += 4) {
        VQuad first[4], difference1[4], difference2[4];
        for (uint32_t n = 0; n < 4; ++n) {
            const uint32_t primitive = std::min(lane + n, group.count - 1);
            first[n] = hn::LoadU(q, group.attributes[0][primitive] + varying);
            difference1[n] = hn::Sub(hn::LoadU(q, group.attributes[1][primitive] + varying), first[n]);
            difference2[n] = hn::Sub(hn::LoadU(q, group.attributes[2][primitive] + varying), first[n]);
        }
        storeTransposed(first, to, &SmallAttribute::first, lane);
        storeTransposed(difference1, to, &SmallAttribute::difference1, lane);
        storeTransposed(difference2, to, &SmallAttribute::difference2, lane);
    }
}

void gatherSmall(const SmallAttributeInput& in) {
    const SmallGroup& group = *in.group;
    for (size_t k = 0; k < in.targets.size(); ++k) {
        const uint32_t varying = in.targets[k].varying;
        // Targets are in the order of the attributes in memory, and none is there twice.
        if (k + 4 <= in.weighted && in.targets[k + 3].varying == varying + 3) {
            gatherFour(group, varying, in.to + k);
            k += 3;
            continue;
        }
        SmallAttribute& to = in.to[k];
        for (uint32_t lane = 0; lane < group.count; ++lane) {
            if (k >= in.weighted) {  // bits, which no float operation may touch
                std::memcpy(&to.first[lane], group.flat[lane] + varying, sizeof(float));
                continue;
            }
            const float first = group.attributes[0][lane][varying];
            to.first[lane] = first;
            to.difference1[lane] = group.attributes[1][lane][varying] - first;
            to.difference2[lane] = group.attributes[2][lane][varying] - first;
        }
    }
}

uint32_t shadeSmall(const SmallShadeInput& in) {
    const F f;
    const I i;
    const SmallGroup& group = *in.group;
    const uint32_t all = (1u << group.count) - 1;
    const bool divide = in.smoothCount != 0 && group.affine != all;
    alignas(64) std::array<int32_t, kSmallGroup> affine;
    if (divide)
        for (uint32_t lane = 0; lane < kSmallGroup; ++lane)
            affine[lane] = 0 - static_cast<int32_t>(group.affine >> lane & 1);
    uint32_t divided = 0;
    for (uint32_t n = 0; n < in.count; n += kLanes) {
        const Places at(in.fragments + n);
        hn::StoreU(hn::Add(at.x, hn::Set(i, in.tileX)), i, in.x + n);
        hn::StoreU(hn::Add(at.y, hn::Set(i, in.tileY)), i, in.y + n);
        const Distances from(group, at);
        const VFloat linear1 = hn::Add(hn::Mul(lookUp(group.l1x, at.primitive), from.dx),
                                       hn::Mul(lookUp(group.l1y, at.primitive), from.dy));
        const VFloat linear2 = hn::Add(hn::Mul(lookUp(group.l2x, at.primitive), from.dx),
                                       hn::Mul(lookUp(group.l2y, at.primitive), from.dy));
        VFloat weight1 = linear1, weight2 = linear2;
        if (divide) {
            const VFloat one = hn::Set(f, 1.0f);
            const VFloat q1 = hn::Mul(linear1, lookUp(group.w1, at.primitive));
            const VFloat q2 = hn::Mul(linear2, lookUp(group.w2, at.primitive));
            const VFloat q0 = hn::Mul(hn::Sub(hn::Sub(one, linear1), linear2), lookUp(group.w0, at.primitive));
            const VFloat reciprocal = hn::Div(one, hn::Add(hn::Add(q0, q1), q2));
            const auto keeps = hn::Ne(lookUp(affine, at.primitive), hn::Zero(i));
            const auto isAffine = hn::RebindMask(f, keeps);
            weight1 = hn::IfThenElse(isAffine, linear1, hn::Mul(q1, reciprocal));
            weight2 = hn::IfThenElse(isAffine, linear2, hn::Mul(q2, reciprocal));
            const auto counted = hn::FirstN(i, in.count - n);
            divided += static_cast<uint32_t>(hn::CountTrue(i, hn::AndNot(keeps, counted)));
        }
        for (size_t k = 0; k < in.attributes.size(); ++k) {
            const SmallAttribute& attribute = in.attributes[k];
            VFloat value = lookUp(attribute.first, at.primitive);
            if (k < in.smoothCount + in.linearCount) {
                const bool smooth = k < in.smoothCount;
                value = hn::Add(
                    value, hn::Add(hn::Mul(smooth ? weight1 : linear1, lookUp(attribute.difference1, at.primitive)),
                                   hn::Mul(smooth ? weight2 : linear2, lookUp(attribute.difference2, at.primitive))));
            }
            hn::StoreU(value, f, in.planes[k] + n);
        }
    }
    return divided;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

SetUpSmallFn setUpSmallFunction(Isa isa){VERNIER_SELECT_ISA(isa, setUpSmall)}

TestSmallFn testSmallFunction(Isa isa){VERNIER_SELECT_ISA(isa, testSmall)}

GatherSmallFn gatherSmallFunction(Isa isa){VERNIER_SELECT_ISA(isa, gatherSmall)}

ShadeSmallFn shadeSmallFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, shadeSmall)
}

}  // namespace vernier
#endif
