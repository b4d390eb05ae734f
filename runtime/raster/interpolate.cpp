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
using VF = hn::Vec<F>;

/// Weights of one segment in double, one lane at a time.
void preciseWeights(const WeightsInput& in, const FragmentSegment& segment, LaneWeights& out) {
    const TrianglePlanes& planes = in.batch->planes[segment.planes];
    for (uint32_t lane = segment.first; lane < segment.first + segment.count; ++lane) {
        const float ox = in.offsetX != nullptr ? in.offsetX[lane] : 0.5f;
        const float oy = in.offsetY != nullptr ? in.offsetY[lane] : 0.5f;
        const Barycentrics at = barycentricsAt(planes, in.batch->x[lane], in.batch->y[lane], ox, oy);
        out.precise1[lane] = at.b1;
        out.precise2[lane] = at.b2;
        out.preciseLinear1[lane] = at.l1;
        out.preciseLinear2[lane] = at.l2;
    }
}

uint32_t weights(const WeightsInput& in, LaneWeights& out, const FragCoordOutput& fragCoord) {
    const F f;
    const hn::RebindToSigned<F> i;
    const FragmentBatch& batch = *in.batch;
    const VF one = hn::Set(f, 1.0f);
    uint32_t divides = 0;
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment segment = batch.segments[s];
        const TrianglePlanes& p = batch.planes[segment.planes];
        if (in.inDouble) preciseWeights(in, segment, out);
        const bool divide = !p.affine && (in.perspective || fragCoord.inverseW != nullptr);
        if (divide && in.perspective) divides += segment.count;
        const VF w0 = hn::Set(f, p.w0), w1 = hn::Set(f, p.w1), w2 = hn::Set(f, p.w2);
        const VF centreX = hn::Set(f, 0.5f - p.fractionX), centreY = hn::Set(f, 0.5f - p.fractionY);
        for (uint32_t n = segment.first; n < segment.first + segment.count; n += hn::Lanes(f)) {
            const VF x = hn::ConvertTo(f, hn::Sub(hn::LoadU(i, batch.x.data() + n), hn::Set(i, p.anchorX)));
            const VF y = hn::ConvertTo(f, hn::Sub(hn::LoadU(i, batch.y.data() + n), hn::Set(i, p.anchorY)));
            VF ox = centreX, oy = centreY;
            if (in.offsetX != nullptr) {
                ox = hn::Sub(hn::LoadU(f, in.offsetX + n), hn::Set(f, p.fractionX));
                oy = hn::Sub(hn::LoadU(f, in.offsetY + n), hn::Set(f, p.fractionY));
            }
            VF l1, l2;
            if (HWY_UNLIKELY(p.precise)) {
                l1 = planeInDouble(f, x, y, ox, oy, 0, p.d.l1x, p.d.l1y);
                l2 = planeInDouble(f, x, y, ox, oy, 0, p.d.l2x, p.d.l2y);
            } else {
                const VF dx = hn::Add(x, ox), dy = hn::Add(y, oy);
                l1 = hn::Add(hn::Mul(hn::Set(f, p.l1x), dx), hn::Mul(hn::Set(f, p.l1y), dy));
                l2 = hn::Add(hn::Mul(hn::Set(f, p.l2x), dx), hn::Mul(hn::Set(f, p.l2y), dy));
            }
            hn::StoreU(l1, f, out.linear1.data() + n);
            hn::StoreU(l2, f, out.linear2.data() + n);
            if (fragCoord.z != nullptr) hn::StoreU(depthOf(f, p, x, y, ox, oy), f, fragCoord.z + n);
            VF inverseW = w0;
            if (divide) {
                // lambda_i / w_i, normalised by their sum, which is 1/w at this place: none is negative
                // inside.
                const VF q1 = hn::Mul(l1, w1), q2 = hn::Mul(l2, w2);
                const VF q0 = hn::Mul(hn::Sub(hn::Sub(one, l1), l2), w0);
                inverseW = hn::Add(hn::Add(q0, q1), q2);
                const VF reciprocal = hn::Div(one, inverseW);
                l1 = hn::Mul(q1, reciprocal);
                l2 = hn::Mul(q2, reciprocal);
            }
            hn::StoreU(l1, f, out.perspective1.data() + n);
            hn::StoreU(l2, f, out.perspective2.data() + n);
            if (fragCoord.inverseW != nullptr)
                hn::StoreU(hn::Mul(inverseW, hn::Set(f, p.wScale)), f, fragCoord.inverseW + n);
        }
    }
    return divides;
}

void attribute(const AttributeInput& in) {
    const F f;
    constexpr uint32_t kLanes = hn::MaxLanes(F());
    const FragmentBatch& batch = *in.batch;
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment segment = batch.segments[s];
        const TrianglePlanes& p = batch.planes[segment.planes];
        const float base = p.attributes[0][in.attribute];
        const VF a = hn::Set(f, base);
        const VF d1 = hn::Set(f, p.attributes[1][in.attribute] - base);
        const VF d2 = hn::Set(f, p.attributes[2][in.attribute] - base);
        for (uint32_t n = segment.first; n < segment.first + segment.count; n += kLanes) {
            const VF w1 = hn::LoadU(f, in.weight1 + n), w2 = hn::LoadU(f, in.weight2 + n);
            const VF value = hn::Add(a, hn::Add(hn::Mul(w1, d1), hn::Mul(w2, d2)));
            // Lanes past the segment are overwritten by the next one.
            if (HWY_LIKELY(n + kLanes <= in.capacity)) {
                hn::StoreU(value, f, in.result + n);
            } else {
                alignas(64) float last[kLanes];
                hn::Store(value, f, last);
                std::memcpy(in.result + n, last, (in.capacity - n) * sizeof(float));
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {
namespace {

using WeightsFn = uint32_t (*)(const WeightsInput&, LaneWeights&, const FragCoordOutput&);
using AttributeFn = void (*)(const AttributeInput&);

WeightsFn weightsFunction(Isa isa){VERNIER_SELECT_ISA(isa, weights)} AttributeFn attributeFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, attribute)
}

}  // namespace

Interpolation interpolationFunctions(Isa isa) {
    return {weightsFunction(isa), attributeFunction(isa)};
}

void interpolatePrecise(const FragmentBatch& batch, const double* weight1, const double* weight2, uint32_t attribute,
                        float* result) {
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& segment = batch.segments[s];
        const TrianglePlanes& p = batch.planes[segment.planes];
        const double a = double{p.attributes[0][attribute]};
        const double d1 = double{p.attributes[1][attribute]} - a, d2 = double{p.attributes[2][attribute]} - a;
        for (uint32_t n = segment.first; n < segment.first + segment.count; ++n)
            result[n] = static_cast<float>(a + (weight1[n] * d1 + weight2[n] * d2));
    }
}

void copyFlat(const FragmentBatch& batch, uint32_t attribute, float* result) {
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& segment = batch.segments[s];
        uint32_t bits;  // a float move could quieten a NaN that is really an integer
        std::memcpy(&bits, batch.planes[segment.planes].flat + attribute, 4);
        for (uint32_t n = segment.first; n < segment.first + segment.count; ++n) std::memcpy(result + n, &bits, 4);
    }
}

}  // namespace vernier
#endif
