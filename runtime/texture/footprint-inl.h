// A pixel seen in the texture: derivatives, scale factors and the level of detail that follows from them, whatever the
// format. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_FOOTPRINT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_FOOTPRINT_INL_H
#undef VERNIER_TEXTURE_FOOTPRINT_INL_H
#else
#define VERNIER_TEXTURE_FOOTPRINT_INL_H
#endif

#include "runtime/texture/lod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

constexpr uint32_t kVectorLanes = hn::MaxLanes(F32());

enum class Shape { flat, volume, cube };  // 1D and 2D, 3D, cube; with or without layers

inline Shape shapeOf(VkImageViewType type) {
    if (type == VK_IMAGE_VIEW_TYPE_3D) return Shape::volume;
    return type == VK_IMAGE_VIEW_TYPE_CUBE || type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY ? Shape::cube : Shape::flat;
}

/// The arguments of a sampling routine.
struct SampleCall {
    const TextureView& view;
    const SamplerState& sampler;
    const SampleRequest& request;

    bool isOneDimensional() const {
        return view.type == VK_IMAGE_VIEW_TYPE_1D || view.type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    }
    HWY_INLINE VF coordinate(int axis, uint32_t first, uint32_t count) const {
        return loadLanes(request.coord[axis], first, count);
    }
    /// The array layer of each lane, of `layers` in all.
    HWY_INLINE VI layer(uint32_t layers, uint32_t first, uint32_t count) const {
        if (layers == 1) return hn::Zero(I32());
        return hn::NearestInt(
            clampOrLowV(coordinate(3, first, count), hn::Zero(F32()), splatFloat(static_cast<float>(layers - 1))));
    }
    /// The first lane of the vector from `first` on that has an active lane; request.lanes or more if there is none.
    HWY_INLINE uint32_t activeVector(uint32_t first) const {
        if (HWY_LIKELY(request.mask == nullptr)) return first;
        for (; first < request.lanes; first += kVectorLanes) {
            const VU active = loadLanes(request.mask, first, request.lanes - first);
            if (!hn::AllTrue(U32(), hn::Eq(active, hn::Zero(U32())))) break;
        }
        return first;
    }
    /// step(first, lanes left) for every vector that has an active lane.
    template <class Step>
    HWY_INLINE void forEachVector(Step step) const {
        for (uint32_t first = activeVector(0); first < request.lanes; first = activeVector(first + kVectorLanes))
            step(first, request.lanes - first);
    }
};

/// The derivatives of s, t, r along the framebuffer's axes, and the squared lengths of both in texels of the base
/// level.
struct Footprint {
    VF dx[3], dy[3];
    VF x2, y2;
};

/// Squared length of a gradient in texels of the base level.
template <Shape kShape>
HWY_INLINE VF gradientLength2(const TextureLevel& base, VF ds, VF dt, VF dr) {
    const VF u = hn::Mul(ds, splatFloat(static_cast<float>(base.width)));
    const VF v = hn::Mul(dt, splatFloat(static_cast<float>(base.height)));
    VF sum = hn::Add(hn::Mul(u, u), hn::Mul(v, v));
    if constexpr (kShape == Shape::volume) {
        const VF w = hn::Mul(dr, splatFloat(static_cast<float>(base.depth)));
        sum = hn::Add(sum, hn::Mul(w, w));
    }
    return sum;
}

template <Shape kShape>
HWY_INLINE Footprint footprintOf(const SampleCall& call, uint32_t first, uint32_t count) {
    const SampleRequest& request = call.request;
    Footprint print;
    VF at[3], dx[3], dy[3];
    for (int i = 0; i < 3; ++i) {
        const bool gradients = request.lodMode == LodMode::gradients;
        at[i] = call.coordinate(i, first, count);
        dx[i] = gradients ? loadLanes(request.gradX[i], first, count) : quadDx(at[i]);
        dy[i] = gradients ? loadLanes(request.gradY[i], first, count) : quadDy(at[i]);
    }
    if (call.isOneDimensional()) dx[1] = dy[1] = hn::Zero(F32());
    for (int i = 0; i < 3; ++i) {
        print.dx[i] = dx[i];
        print.dy[i] = dy[i];
    }
    if constexpr (kShape == Shape::cube) {
        const FaceChoice choice = chooseFace(at[0], at[1], at[2]);
        const FaceVector v = onFace(choice, at[0], at[1], at[2]);
        projectDerivative(v, onFace(choice, dx[0], dx[1], dx[2]), dx[0], dx[1]);
        projectDerivative(v, onFace(choice, dy[0], dy[1], dy[2]), dy[0], dy[1]);
    }
    print.x2 = gradientLength2<kShape>(call.view.levels[0], dx[0], dx[1], dx[2]);
    print.y2 = gradientLength2<kShape>(call.view.levels[0], dy[0], dy[1], dy[2]);
    return print;
}

/// "Scale Factor Operation": the squares of rho max, of the ratio of anisotropy eta, and of rho max / eta.
struct Scale {
    VF major2, eta2, rho2;
};

HWY_INLINE Scale scaleOf(const SamplerState& sampler, const Footprint& print) {
    const VF major2 = hn::IfThenElse(hn::Gt(print.x2, print.y2), print.x2, print.y2);
    if (!(sampler.maxAnisotropy > 1.0f)) return {major2, splatFloat(1.0f), major2};
    const VF minor2 = hn::IfThenElse(hn::Gt(print.x2, print.y2), print.y2, print.x2);
    const VF limit2 = splatFloat(sampler.maxAnisotropy * sampler.maxAnisotropy);
    const auto limited = hn::Gt(major2, hn::Mul(minor2, limit2));
    const VF ratio2 = hn::Div(major2, minor2);
    const VF eta2 = hn::IfThenElse(limited, limit2, clampOrLowV(ratio2, splatFloat(1.0f), limit2));
    return {major2, eta2, hn::IfThenElse(limited, hn::Div(major2, limit2), minor2)};
}

/// Room for lambdaPrimes(): whole groups of four vectors.
constexpr uint32_t kLambdaLanes = kMaxSampleLanes + 4 * kVectorLanes;

/// log2 of rho from the derivatives or the gradients.
template <Shape kShape>
HWY_INLINE VF derivativeLambda(const SampleCall& call, uint32_t first, uint32_t count) {
    return hn::Mul(log2V(scaleOf(call.sampler, footprintOf<kShape>(call, first, count)).rho2), splatFloat(0.5f));
}

/// The same for four vectors at once, from derivatives over quads: these are equal in all lanes of a quad, so that one
/// vector holds the quads of all four.
HWY_INLINE void quadLambdas(const SampleCall& call, uint32_t first, float* lambdas) {
    const F32 df;
    const uint32_t lanes = call.request.lanes;
    const VI place = hn::And(hn::Iota(I32(), 0), splatInt(3));
    VF squares = hn::Zero(df);
    unrolled<4>([&](auto k) VERNIER_INLINE_LAMBDA {
        const uint32_t lane = first + k * kVectorLanes;
        if (lane >= lanes) return;
        const VF square = scaleOf(call.sampler, footprintOf<Shape::flat>(call, lane, lanes - lane)).rho2;
        squares = hn::IfThenElse(hn::RebindMask(df, hn::Eq(place, splatInt(k))), square, squares);
    });
    const VF result = hn::Mul(log2V(squares), splatFloat(0.5f));
    unrolled<4>([&](auto k)
                    VERNIER_INLINE_LAMBDA { hn::Store(hn::Broadcast<k>(result), df, lambdas + k * kVectorLanes); });
}

/// lambda' of all lanes: the level of detail of the request, from wherever it takes it, with the biases. `lambdas` has
/// room for kLambdaLanes.
template <Shape kShape>
HWY_NOINLINE void lambdaPrimes(const SampleCall& call, float* lambdas) {
    const F32 df;
    const SampleRequest& request = call.request;
    const bool quads = kShape == Shape::flat && request.lodMode == LodMode::implicitLod;
    if (quads && !call.sampler.unnormalizedCoordinates) {
        for (uint32_t first = 0; first < request.lanes; first += 4 * kVectorLanes)
            quadLambdas(call, first, lambdas + first);
    }
    for (uint32_t first = 0; first < request.lanes; first += kVectorLanes) {
        const uint32_t count = request.lanes - first;
        VF lambda = hn::Zero(df);
        if (!call.sampler.unnormalizedCoordinates) {
            lambda = biasedLambda(call.sampler, request, first, count, [&]() VERNIER_INLINE_LAMBDA {
                return quads ? hn::Load(df, lambdas + first) : derivativeLambda<kShape>(call, first, count);
            });
        }
        hn::Store(lambda, df, lambdas + first);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
