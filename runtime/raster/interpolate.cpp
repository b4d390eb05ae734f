#include "runtime/raster/interpolate.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/interpolate.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/raster/planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
constexpr uint32_t kLanes = hn::MaxLanes(F());

/// Pixels of a rectangle of lanes, from its first one.
struct LaneTables {
    alignas(64) int32_t column[2][64], row[2][64];  // by LaneOrder::rows, quads
};

constexpr LaneTables laneTables() {
    LaneTables tables{};
    for (uint32_t lane = 0; lane < 64; ++lane) {
        for (const LaneOrder order : {LaneOrder::rows, LaneOrder::quads}) {
            const int k = order == LaneOrder::quads ? 1 : 0;
            tables.column[k][lane] = static_cast<int32_t>(columnOf(order, lane));
            tables.row[k][lane] = static_cast<int32_t>(rowOf(order, lane));
        }
    }
    return tables;
}

constexpr LaneTables kLaneTables = laneTables();

/// The pixels of a batch: x and y plus an offset.
struct PixelSource {
    explicit PixelSource(const FragmentBatch& batch) {
        const bool rectangle = batch.order != LaneOrder::spans;
        const int k = batch.order == LaneOrder::quads ? 1 : 0;
        x = rectangle ? kLaneTables.column[k] : batch.x.data();
        y = rectangle ? kLaneTables.row[k] : batch.y.data();
        offsetX = rectangle ? batch.originX : 0;
        offsetY = rectangle ? batch.originY : 0;
    }

    const int32_t *x, *y;
    int32_t offsetX, offsetY;
};

/// Weights of the second and third vertex.
struct Weights {
    VF perspective1, perspective2, linear1, linear2;
};

/// What is the same for all lanes of a segment.
struct SegmentPlanes {
    SegmentPlanes(const InterpolationInput& in, const PixelSource& source, const TrianglePlanes& p)
        : planes(p),
          pixels(source),
          divide(!p.affine && (in.perspective || in.fragInverseW != nullptr)),
          anchorX(hn::Set(I(), p.anchorX - source.offsetX)),
          anchorY(hn::Set(I(), p.anchorY - source.offsetY)),
          centreX(hn::Set(F(), 0.5f - p.fractionX)),
          centreY(hn::Set(F(), 0.5f - p.fractionY)) {}

    const TrianglePlanes& planes;
    const PixelSource& pixels;
    bool divide;
    hn::Vec<I> anchorX, anchorY;
    VF centreX, centreY;
};

struct Perspective {
    VF weight1, weight2, inverseW;
};

/// lambda_i / w_i, normalised by their sum, which is 1/w at this place: none is negative inside.
HWY_INLINE Perspective perspectiveAt(const TrianglePlanes& p, VF linear1, VF linear2) {
    const F f;
    const VF one = hn::Set(f, 1.0f);
    const VF q1 = hn::Mul(linear1, hn::Set(f, p.w1)), q2 = hn::Mul(linear2, hn::Set(f, p.w2));
    const VF q0 = hn::Mul(hn::Sub(hn::Sub(one, linear1), linear2), hn::Set(f, p.w0));
    const VF inverseW = hn::Add(hn::Add(q0, q1), q2);
    const VF reciprocal = hn::Div(one, inverseW);
    return {hn::Mul(q1, reciprocal), hn::Mul(q2, reciprocal), inverseW};
}

HWY_INLINE Weights weightsAt(const InterpolationInput& in, const SegmentPlanes& segment, uint32_t n) {
    const F f;
    const I i;
    const TrianglePlanes& p = segment.planes;
    const VF x = hn::ConvertTo(f, hn::Sub(hn::LoadU(i, segment.pixels.x + n), segment.anchorX));
    const VF y = hn::ConvertTo(f, hn::Sub(hn::LoadU(i, segment.pixels.y + n), segment.anchorY));
    VF ox = segment.centreX, oy = segment.centreY;
    if (HWY_UNLIKELY(in.offsetX != nullptr)) {
        ox = hn::Sub(hn::LoadU(f, in.offsetX + n), hn::Set(f, p.fractionX));
        oy = hn::Sub(hn::LoadU(f, in.offsetY + n), hn::Set(f, p.fractionY));
    }
    Weights w;
    if (HWY_UNLIKELY(p.precise)) {
        w.linear1 = planeInDouble(f, x, y, ox, oy, 0, p.d.l1x, p.d.l1y);
        w.linear2 = planeInDouble(f, x, y, ox, oy, 0, p.d.l2x, p.d.l2y);
    } else {
        const VF dx = hn::Add(x, ox), dy = hn::Add(y, oy);
        w.linear1 = hn::Add(hn::Mul(hn::Set(f, p.l1x), dx), hn::Mul(hn::Set(f, p.l1y), dy));
        w.linear2 = hn::Add(hn::Mul(hn::Set(f, p.l2x), dx), hn::Mul(hn::Set(f, p.l2y), dy));
    }
    if (in.fragZ != nullptr) hn::StoreU(depthOf(f, p, x, y, ox, oy), f, in.fragZ + n);
    VF inverseW = hn::Set(f, p.w0);
    w.perspective1 = w.linear1;
    w.perspective2 = w.linear2;
    if (segment.divide) {
        const Perspective at = perspectiveAt(p, w.linear1, w.linear2);
        inverseW = at.inverseW;
        w.perspective1 = at.weight1;
        w.perspective2 = at.weight2;
    }
    if (in.fragInverseW != nullptr) hn::StoreU(hn::Mul(inverseW, hn::Set(f, p.wScale)), f, in.fragInverseW + n);
    return w;
}

/// Lanes past the segment are overwritten by the next one; lanes past the plane must not be.
HWY_INLINE void storeLanes(VF value, float* plane, uint32_t n, uint32_t capacity) {
    if (HWY_LIKELY(n + kLanes <= capacity)) {
        hn::StoreU(value, F(), plane + n);
    } else {
        alignas(64) float last[kLanes];
        hn::Store(value, F(), last);
        std::memcpy(plane + n, last, (capacity - n) * sizeof(float));
    }
}

/// An attribute as a function of the weights: its value at the first vertex, and the differences of the others.
struct AttributePlane {
    AttributePlane(const TrianglePlanes& p, uint32_t varying) {
        const float first = p.attributes[0][varying];
        base = hn::Set(F(), first);
        d1 = hn::Set(F(), p.attributes[1][varying] - first);
        d2 = hn::Set(F(), p.attributes[2][varying] - first);
    }
    HWY_INLINE VF at(VF w1, VF w2) const { return hn::Add(base, hn::Add(hn::Mul(w1, d1), hn::Mul(w2, d2))); }

    VF base, d1, d2;
};

/// One vector of lanes.
HWY_INLINE void evaluate(const InterpolationInput& in, const SegmentPlanes& planes, uint32_t n) {
    const Weights w = weightsAt(in, planes, n);
    for (const VaryingTarget& target : in.smooth)
        storeLanes(AttributePlane(planes.planes, target.varying).at(w.perspective1, w.perspective2), target.plane, n,
                   in.capacity);
    for (const VaryingTarget& target : in.linear)
        storeLanes(AttributePlane(planes.planes, target.varying).at(w.linear1, w.linear2), target.plane, n,
                   in.capacity);
}

/// Vectors side by side: their weights stay in registers, and none waits for another.
constexpr uint32_t kSide = 4, kSideLanes = kSide * kLanes;

/// Stores a vector, or those of its lanes that `only` names.
template <bool kMasked>
HWY_INLINE void storeVector(VF value, float* lanes, const uint32_t* only) {
    if constexpr (kMasked) {
        const hn::RebindToUnsigned<F> u;
        hn::BlendedStore(value, hn::MaskFromVec(hn::BitCast(F(), hn::LoadU(u, only))), F(), lanes);
    } else {
        (void)only;
        hn::StoreU(value, F(), lanes);
    }
}

/// Stores the targets for kCount vectors with the weights w1, w2. `only`: by lane of the batch, if kMasked.
template <uint32_t kCount, bool kMasked = false>
HWY_INLINE void storeSide(const TrianglePlanes& planes, std::span<const VaryingTarget> targets, const VF* w1,
                          const VF* w2, uint32_t n, const uint32_t* only = nullptr) {
    for (const VaryingTarget& target : targets) {
        const AttributePlane plane(planes, target.varying);
        for (uint32_t v = 0; v < kCount; ++v) {
            const uint32_t lane = n + v * kLanes;
            storeVector<kMasked>(plane.at(w1[v], w2[v]), target.plane + lane, kMasked ? only + lane : nullptr);
        }
    }
}

/// In either order, the columns of a rectangle repeat every 16 lanes.
constexpr uint32_t kColumns = 16 / kLanes;

/// What the columns add to the weights.
struct ColumnWeights {
    VF w1[kColumns], w2[kColumns];
};

/// kCount vectors of a rectangle, from lane n on.
template <uint32_t kCount, bool kMasked>
HWY_INLINE void evaluateRows(const InterpolationInput& in, const SegmentPlanes& segment, const ColumnWeights& columns,
                             uint32_t n) {
    const uint32_t* only = in.batch->second.data();
    const F f;
    const I i;
    const TrianglePlanes& p = segment.planes;
    VF w1[kCount], w2[kCount];
    for (uint32_t v = 0; v < kCount; ++v) {
        const auto y = hn::Sub(hn::LoadU(i, segment.pixels.y + n + v * kLanes), segment.anchorY);
        const VF dy = hn::Add(hn::ConvertTo(f, y), segment.centreY);
        w1[v] = hn::Add(columns.w1[v % kColumns], hn::Mul(hn::Set(f, p.l1y), dy));
        w2[v] = hn::Add(columns.w2[v % kColumns], hn::Mul(hn::Set(f, p.l2y), dy));
    }
    storeSide<kCount, kMasked>(p, in.linear, w1, w2, n, only);
    if (segment.divide)
        for (uint32_t v = 0; v < kCount; ++v) {
            const Perspective at = perspectiveAt(p, w1[v], w2[v]);
            w1[v] = at.weight1;
            w2[v] = at.weight2;
        }
    storeSide<kCount, kMasked>(p, in.smooth, w1, w2, n, only);
}

/// A rectangle at pixel centres, in float: the operations of weightsAt(), those that all rows have in common done once.
template <bool kMasked>
HWY_INLINE void evaluateRectangle(const InterpolationInput& in, const SegmentPlanes& segment) {
    const F f;
    const I i;
    const TrianglePlanes& p = segment.planes;
    ColumnWeights columns;
    for (uint32_t part = 0; part < kColumns; ++part) {
        const auto x = hn::Sub(hn::LoadU(i, segment.pixels.x + part * kLanes), segment.anchorX);
        const VF dx = hn::Add(hn::ConvertTo(f, x), segment.centreX);
        columns.w1[part] = hn::Mul(hn::Set(f, p.l1x), dx);
        columns.w2[part] = hn::Mul(hn::Set(f, p.l2x), dx);
    }
    const uint32_t count = in.batch->count;  // a multiple of 16
    uint32_t n = 0;
    for (; n + kSideLanes <= count; n += kSideLanes) evaluateRows<kSide, kMasked>(in, segment, columns, n);
    for (; n < count; n += 16) evaluateRows<kColumns, kMasked>(in, segment, columns, n);
}

/// kSide vectors.
HWY_INLINE void evaluateSide(const InterpolationInput& in, const SegmentPlanes& segment, uint32_t n) {
    VF linear1[kSide], linear2[kSide], perspective1[kSide], perspective2[kSide];
    for (uint32_t v = 0; v < kSide; ++v) {
        const Weights w = weightsAt(in, segment, n + v * kLanes);
        linear1[v] = w.linear1;
        linear2[v] = w.linear2;
        perspective1[v] = w.perspective1;
        perspective2[v] = w.perspective2;
    }
    storeSide<kSide>(segment.planes, in.smooth, perspective1, perspective2, n);
    storeSide<kSide>(segment.planes, in.linear, linear1, linear2, n);
}

/// The bits of the provoking vertex: an integer, perhaps, which no float operation may touch.
template <bool kMasked>
HWY_INLINE void copyFlat(const InterpolationInput& in, const FragmentSegment& segment) {
    for (const VaryingTarget& target : in.flat) {
        uint32_t bits;
        std::memcpy(&bits, segment.planes->flat + target.varying, 4);
        const VF value = hn::BitCast(F(), hn::Set(hn::RebindToUnsigned<F>(), bits));
        for (uint32_t n = segment.first; n < segment.first + segment.count; n += kLanes) {
            if constexpr (kMasked)
                storeVector<true>(value, target.plane + n, in.batch->second.data() + n);
            else
                storeLanes(value, target.plane, n, in.capacity);
        }
    }
}

uint32_t interpolate(const InterpolationInput& in) {
    uint32_t divides = 0;
    const PixelSource pixels(*in.batch);
    const bool plain = in.batch->order != LaneOrder::spans && in.offsetX == nullptr && in.fragZ == nullptr &&
                       in.fragInverseW == nullptr;
    const bool weighted = !in.smooth.empty() || !in.linear.empty() || in.fragZ != nullptr;
    for (uint32_t s = 0; s < in.batch->segmentCount; ++s) {
        const FragmentSegment& segment = in.batch->segments[s];
        if (segment.planes == nullptr) continue;
        const bool second = s != 0 && in.batch->order != LaneOrder::spans;
        if (second)
            copyFlat<true>(in, segment);
        else
            copyFlat<false>(in, segment);
        if (!weighted && !in.perspective) continue;
        const SegmentPlanes planes(in, pixels, *segment.planes);
        if (planes.divide && in.perspective) divides += segment.count;
        if (!weighted) continue;
        if (plain && !segment.planes->precise) {
            if (second)
                evaluateRectangle<true>(in, planes);
            else
                evaluateRectangle<false>(in, planes);
            continue;
        }
        const uint32_t end = segment.first + segment.count;
        uint32_t n = segment.first;
        for (; n + kSideLanes <= end; n += kSideLanes) evaluateSide(in, planes, n);
        for (; n < end; n += kLanes) evaluate(in, planes, n);
    }
    return divides;
}

void placeLanes(FragmentBatch& batch) {
    const I i;
    const PixelSource pixels(batch);
    const auto x = hn::Set(i, pixels.offsetX), y = hn::Set(i, pixels.offsetY);
    for (uint32_t n = 0; n < batch.count; n += kLanes) {
        hn::StoreU(hn::Add(hn::LoadU(i, pixels.x + n), x), i, batch.x.data() + n);
        hn::StoreU(hn::Add(hn::LoadU(i, pixels.y + n), y), i, batch.y.data() + n);
    }
}

/// The bit of a lane's pixel among those of its 16 lanes, which are two rows of 8 pixels in either order.
struct LaneBits {
    alignas(64) uint32_t bit[2][16];
};

constexpr LaneBits laneBits() {
    LaneBits bits{};
    for (uint32_t lane = 0; lane < 16; ++lane) {
        bits.bit[0][lane] = 1u << lane;
        bits.bit[1][lane] = 1u << (rowOf(LaneOrder::quads, lane) * 8 + columnOf(LaneOrder::quads, lane));
    }
    return bits;
}

static constexpr LaneBits kLaneBits = laneBits();

void spreadPixels(uint64_t pixels, LaneOrder order, uint32_t count, uint32_t* lanes) {
    const hn::RebindToUnsigned<F> u;
    const auto* bits = kLaneBits.bit[order == LaneOrder::quads ? 1 : 0];
    for (uint32_t n = 0; n < count; n += kLanes) {
        const auto part = hn::Set(u, static_cast<uint32_t>(pixels >> (n & ~15u) & 0xFFFF));
        const auto set = hn::Ne(hn::And(part, hn::Load(u, bits + n % 16)), hn::Zero(u));
        hn::StoreU(hn::VecFromMask(u, set), u, lanes + n);
    }
}

uint64_t collectPixels(const uint32_t* lanes, uint32_t bits, LaneOrder order, uint32_t count) {
    const hn::RebindToUnsigned<F> u;
    const auto* laneBits = kLaneBits.bit[order == LaneOrder::quads ? 1 : 0];
    uint64_t pixels = 0;
    for (uint32_t n = 0; n < count; n += kLanes) {
        const auto set = hn::Ne(hn::And(hn::LoadU(u, lanes + n), hn::Set(u, bits)), hn::Zero(u));
        const auto sum = hn::SumOfLanes(u, hn::IfThenElseZero(set, hn::Load(u, laneBits + n % 16)));
        pixels |= uint64_t{hn::GetLane(sum)} << (n & ~15u);
    }
    return pixels;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

InterpolateFn interpolateFunction(Isa isa){VERNIER_SELECT_ISA(isa, interpolate)}

PlaceLanesFn placeLanesFunction(Isa isa){VERNIER_SELECT_ISA(isa, placeLanes)}

SpreadPixelsFn spreadPixelsFunction(Isa isa){VERNIER_SELECT_ISA(isa, spreadPixels)}

CollectPixelsFn collectPixelsFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, collectPixels)
}

void interpolatePrecise(const InterpolationInput& in) {
    const FragmentBatch& batch = *in.batch;
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& segment = batch.segments[s];
        const TrianglePlanes& p = *segment.planes;
        for (uint32_t n = segment.first; n < segment.first + segment.count; ++n) {
            const float ox = in.offsetX != nullptr ? in.offsetX[n] : 0.5f;
            const float oy = in.offsetY != nullptr ? in.offsetY[n] : 0.5f;
            const Barycentrics at = barycentricsAt(p, batch.x[n], batch.y[n], ox, oy);
            const auto evaluate = [&](const VaryingTarget& target, double w1, double w2) {
                const double a = double{p.attributes[0][target.varying]};
                const double d1 = double{p.attributes[1][target.varying]} - a;
                const double d2 = double{p.attributes[2][target.varying]} - a;
                target.plane[n] = static_cast<float>(a + (w1 * d1 + w2 * d2));
            };
            for (const VaryingTarget& target : in.smooth) evaluate(target, at.b1, at.b2);
            for (const VaryingTarget& target : in.linear) evaluate(target, at.l1, at.l2);
        }
    }
}

}  // namespace vernier
#endif
