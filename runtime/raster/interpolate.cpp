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
        // lambda_i / w_i, normalised by their sum, which is 1/w at this place: none is negative inside.
        const VF one = hn::Set(f, 1.0f);
        const VF q1 = hn::Mul(w.linear1, hn::Set(f, p.w1)), q2 = hn::Mul(w.linear2, hn::Set(f, p.w2));
        const VF q0 = hn::Mul(hn::Sub(hn::Sub(one, w.linear1), w.linear2), inverseW);
        inverseW = hn::Add(hn::Add(q0, q1), q2);
        const VF reciprocal = hn::Div(one, inverseW);
        w.perspective1 = hn::Mul(q1, reciprocal);
        w.perspective2 = hn::Mul(q2, reciprocal);
    }
    if (in.fragInverseW != nullptr) hn::StoreU(hn::Mul(inverseW, hn::Set(f, p.wScale)), f, in.fragInverseW + n);
    return w;
}

/// An attribute as a function of the weights: its value at the first vertex, and the differences of the others.
struct AttributePlane {
    float base, d1, d2;
};

HWY_INLINE VF valueAt(const AttributePlane& plane, VF w1, VF w2) {
    const F f;
    const VF change = hn::Add(hn::Mul(w1, hn::Set(f, plane.d1)), hn::Mul(w2, hn::Set(f, plane.d2)));
    return hn::Add(hn::Set(f, plane.base), change);
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

uint32_t interpolate(const InterpolationInput& in) {
    uint32_t divides = 0;
    const PixelSource pixels(*in.batch);
    const size_t targets = in.targets.size();
    std::array<AttributePlane, kMaxInterfaceComponents> attributes;
    for (uint32_t s = 0; s < in.batch->segmentCount; ++s) {
        const FragmentSegment& segment = in.batch->segments[s];
        const TrianglePlanes& p = *segment.planes;
        const SegmentPlanes planes(in, pixels, p);
        if (planes.divide && in.perspective) divides += segment.count;
        for (size_t k = 0; k < targets; ++k) {
            const uint32_t varying = in.targets[k].varying;
            const float base = p.attributes[0][varying];
            attributes[k] = {base, p.attributes[1][varying] - base, p.attributes[2][varying] - base};
        }
        for (uint32_t n = segment.first; n < segment.first + segment.count; n += kLanes) {
            const Weights w = weightsAt(in, planes, n);
            for (size_t k = 0; k < targets; ++k) {
                const VaryingTarget& target = in.targets[k];
                const VF w1 = target.linear ? w.linear1 : w.perspective1;
                const VF w2 = target.linear ? w.linear2 : w.perspective2;
                storeLanes(valueAt(attributes[k], w1, w2), target.plane, n, in.capacity);
            }
        }
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

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

InterpolateFn interpolateFunction(Isa isa){VERNIER_SELECT_ISA(isa, interpolate)}

PlaceLanesFn placeLanesFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, placeLanes)
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
            for (const VaryingTarget& target : in.targets) {
                const double a = double{p.attributes[0][target.varying]};
                const double d1 = double{p.attributes[1][target.varying]} - a;
                const double d2 = double{p.attributes[2][target.varying]} - a;
                const double w1 = target.linear ? at.l1 : at.b1, w2 = target.linear ? at.l2 : at.b2;
                target.plane[n] = static_cast<float>(a + (w1 * d1 + w2 * d2));
            }
        }
    }
}

void copyFlat(const FragmentBatch& batch, const VaryingTarget& target) {
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& segment = batch.segments[s];
        uint32_t bits;  // a float move could quieten a NaN that is really an integer
        std::memcpy(&bits, segment.planes->flat + target.varying, 4);
        for (uint32_t n = segment.first; n < segment.first + segment.count; ++n)
            std::memcpy(target.plane + n, &bits, 4);
    }
}

}  // namespace vernier
#endif
