// The sampling routine: coordinates to level of detail, to texels, to filtered values, for one vector of
// lanes after the other. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_SAMPLER_INL_H
#undef VERNIER_TEXTURE_SAMPLER_INL_H
#else
#define VERNIER_TEXTURE_SAMPLER_INL_H
#endif

#include "runtime/texture/cube-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// The coordinates of one vector of lanes, free of the level of detail.
struct Coordinates {
    VF s, t, r;  // of a cube: s and t on the face
    VI slice;    // array layer or face; z of a volume comes from r
    VF dref;
};

/// Everything of one call that does not change from vector to vector. kExtended: reduction modes other than the
/// average, cubes with seams, and what anisotropic-inl.h adds; all others have no trace of them.
template <class Source, Shape kShape, bool kExtended = false>
class Sampler {
  public:
    explicit Sampler(const SampleCall& call)
        : call_(call),
          view_(call.view),
          sampler_(call.sampler),
          request_(call.request),
          source_(call.view),
          compare_(call.sampler.compareEnable) {
        source_.borderPlanes(sampler_.borderColor, border_);
        neededComponents_ = compare_ ? 1 : 0;
        for (uint32_t c = 0; c < 4; ++c) {
            const Route route = compare_ ? Route::r : routeOf(view_.swizzle, c);
            if (request_.out[c] == nullptr || (compare_ && c != 0)) continue;
            Output& output = outputs_[outputCount_++];
            output.target = request_.out[c];
            output.plane = route <= Route::a ? source_.planeOf[static_cast<uint32_t>(route)] : kConstantPlane;
            output.constant = constantBits(view_.ops.layout, route == Route::one || route == Route::a);
            if (output.plane != kConstantPlane) neededComponents_ |= 1u << static_cast<uint32_t>(route);
        }
        fixedPointDepth_ = view_.ops.layout.rgba[0].kind == ComponentKind::unorm;
    }

    void sample() const {
        const bool usesLambda = view_.levelCount > 1 || sampler_.magFilter != sampler_.minFilter;
        alignas(64) float lambdas[kLambdaLanes];
        if (usesLambda) lambdaPrimes<kShape>(call_, lambdas);
        call_.forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
            sampleVector(first, count, usesLambda ? hn::Load(F32(), lambdas + first) : hn::Zero(F32()));
        });
    }

    void gather() {
        // The four outputs are texels of one component, whichever of them are wanted.
        const Route route = compare_ ? Route::r : routeOf(view_.swizzle, request_.component);
        neededComponents_ = route <= Route::a ? 1u << static_cast<uint32_t>(route) : 0;
        alignas(64) float lambdas[kLambdaLanes];
        lambdaPrimes<kShape>(call_, lambdas);
        call_.forEachVector([&](uint32_t first, uint32_t count)
                                HWY_ATTR { gatherVector(first, count, hn::Load(F32(), lambdas + first)); });
    }

  protected:
    using Mask = hn::Mask<F32>;
    // Cubic filters are of flat images, and by the source that reads every format.
    static constexpr bool kHasCubic = kExtended && kShape == Shape::flat && !Source::kFinite;

    /// `shift`: added to s, t, r; nullptr: nothing is.
    HWY_INLINE Coordinates coordinates(uint32_t first, uint32_t count, const VF* shift = nullptr) const {
        Coordinates at;
        at.s = call_.coordinate(0, first, count);
        // A 1D image is one row, met in the middle.
        at.t = call_.isOneDimensional() ? splatFloat(0.5f) : call_.coordinate(1, first, count);
        at.r = kShape == Shape::flat ? hn::Zero(F32()) : call_.coordinate(2, first, count);
        if (shift != nullptr) {
            at.s = hn::Add(at.s, shift[0]);
            if (!call_.isOneDimensional()) at.t = hn::Add(at.t, shift[1]);
            if constexpr (kShape != Shape::flat) at.r = hn::Add(at.r, shift[2]);
        }
        at.slice = hn::Zero(I32());
        at.dref = hn::Zero(F32());
        if constexpr (kShape != Shape::volume) {
            at.slice = call_.layer(kShape == Shape::cube ? view_.layerCount / 6 : view_.layerCount, first, count);
        }
        if constexpr (kShape == Shape::cube) {
            const FaceChoice choice = chooseFace(at.s, at.t, at.r);
            const FaceVector v = onFace(choice, at.s, at.t, at.r);
            const VF half = splatFloat(0.5f);
            at.s = hn::Add(hn::Mul(half, hn::Div(v.s, v.major)), half);
            at.t = hn::Add(hn::Mul(half, hn::Div(v.t, v.major)), half);
            at.slice = hn::Add(hn::Mul(at.slice, splatInt(6)), choice.face);
        }
        if (compare_) {
            at.dref = loadLanes(request_.dref, first, count);
            if (fixedPointDepth_) at.dref = clampOrLowV(at.dref, hn::Zero(F32()), splatFloat(1.0f));
        }
        return at;
    }

    // --- Texels

    Axis axis(int index, uint32_t size) const {
        return {sampler_.addressMode[index], static_cast<int32_t>(size), request_.offset[index],
                !sampler_.unnormalizedCoordinates};
    }

    template <int kTaps>
    HWY_INLINE void load(const TextureLevel& level, const TexelPosition (&at)[kTaps], const VI (&inside)[kTaps],
                         VF dref, Texel (&texels)[kTaps]) const {
        source_.load(view_, level, at, neededComponents_, texels);
        if constexpr (kShape != Shape::cube || kExtended) {
            unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
                const auto isInside = hn::MaskFromVec(hn::BitCast(U32(), inside[t]));
                unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                    texels[t][p] = hn::IfThenElse(isInside, texels[t][p], splatBits(border_[p]));
                });
            });
        }
        if constexpr (!Source::kFinite) {
            if (!compare_) return;
            unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
                texels[t][0] = compareTexel(sampler_.compareOp, dref, floatOf(texels[t][0]));
            });
        }
    }

    static HWY_INLINE void nearestAt(VF s, const Axis& axis, AxisTaps& taps) {
        kShape == Shape::flat ? nearestTap<Wrap::any>(s, axis, taps) : sharedNearestTap(s, axis, taps);
    }
    static HWY_INLINE void linearAt(VF s, const Axis& axis, AxisTaps& taps) {
        kShape == Shape::flat ? linearTaps(s, axis, taps) : sharedLinearTaps(s, axis, taps);
    }

    HWY_INLINE void nearest(const TextureLevel& level, const Coordinates& at, Texel& result) const {
        AxisTaps x, y, z;
        TexelPosition position[1];
        VI inside[1];
        Texel texel[1];
        if constexpr (kShape == Shape::cube && !kExtended) {
            nearestTap<Wrap::clampToEdge>(at.s, faceAxis(level), x);
            nearestTap<Wrap::clampToEdge>(at.t, faceAxis(level), y);
        } else if (kShape == Shape::cube && !sampler_.nonSeamlessCube) {
            nearestAt(at.s, faceAxis(level), x);
            nearestAt(at.t, faceAxis(level), y);
        } else {
            nearestAt(at.s, axis(0, level.width), x);
            nearestAt(at.t, axis(1, level.height), y);
        }
        position[0] = {x.index[0], y.index[0], at.slice};
        if constexpr (kShape != Shape::cube || kExtended) {
            inside[0] = hn::And(x.inside[0], y.inside[0]);
        }
        if constexpr (kShape == Shape::volume) {
            nearestAt(at.r, axis(2, level.depth), z);
            position[0].slice = z.index[0];
            inside[0] = hn::And(inside[0], z.inside[0]);
        }
        load(level, position, inside, at.dref, texel);
        unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA { result[p] = texel[0][p]; });
    }

    /// The 2x2 texels around a point; tap 2j + i is (i, j). wx and wy are the weights of i = 1 and j = 1.
    HWY_INLINE void squareTaps(const TextureLevel& level, const Coordinates& at, Texel (&texels)[4], VF& wx,
                               VF& wy) const {
        TexelPosition position[4];
        VI inside[4];
        if (kShape == Shape::cube && !(kExtended && sampler_.nonSeamlessCube)) {
            VI corner[4];
            unrolled<4>([&](auto t) VERNIER_INLINE_LAMBDA { inside[t] = hn::Set(I32(), -1); });
            cubeTaps(level, at.s, at.t, at.slice, position, corner, wx, wy);
            load(level, position, inside, at.dref, texels);
            for (int t = 0; t < 4; ++t)
                fillCorner<Source::kPlanes>(corner[t], texels[t], texels[t ^ 1], texels[t ^ 2], texels[t ^ 3]);
            return;
        }
        if constexpr (kShape != Shape::cube || kExtended) {
            AxisTaps x, y;
            linearAt(at.s, axis(0, level.width), x);
            linearAt(at.t, axis(1, level.height), y);
            wx = x.weight;
            wy = y.weight;
            unrolled<4>([&](auto t) VERNIER_INLINE_LAMBDA {
                position[t] = {x.index[t & 1], y.index[t >> 1], at.slice};
                inside[t] = hn::And(x.inside[t & 1], y.inside[t >> 1]);
            });
            load(level, position, inside, at.dref, texels);
        }
    }

    HWY_INLINE void linear(const TextureLevel& level, const Coordinates& at, Texel& result) const {
        if constexpr (kShape == Shape::volume) {
            AxisTaps x, y, z;
            linearAt(at.s, axis(0, level.width), x);
            linearAt(at.t, axis(1, level.height), y);
            linearAt(at.r, axis(2, level.depth), z);
            Texel slices[2];
            for (int k = 0; k < 2; ++k) {
                TexelPosition position[4];
                VI inside[4];
                Texel texels[4];
                for (int t = 0; t < 4; ++t) {
                    position[t] = {x.index[t & 1], y.index[t >> 1], z.index[k]};
                    inside[t] = hn::And(hn::And(x.inside[t & 1], y.inside[t >> 1]), z.inside[k]);
                }
                load(level, position, inside, at.dref, texels);
                blendSquare(texels, x.weight, y.weight, slices[k]);
            }
            unrolled<Source::kPlanes>(
                [&](auto p) VERNIER_INLINE_LAMBDA { result[p] = combine(slices[0][p], slices[1][p], z.weight); });
        } else {
            Texel texels[4];
            VF wx, wy;
            squareTaps(level, at, texels, wx, wy);
            blendSquare(texels, wx, wy, result);
        }
    }

    /// Sixteen texels, a row of four after the other; of flat images only.
    HWY_NOINLINE void cubic(const TextureLevel& level, const Coordinates& at, Texel& result) const {
        CubicAxis x, y;
        cubicTaps(at.s, axis(0, level.width), x);
        cubicTaps(at.t, axis(1, level.height), y);
        const CubicWeights across = cubicWeights(x.fraction), down = cubicWeights(y.fraction);
        Texel rows[4];
#pragma GCC unroll 1
        for (int j = 0; j < 4; ++j) {
            TexelPosition position[4];
            VI inside[4];
            Texel texels[4];
            for (int i = 0; i < 4; ++i) {
                position[i] = {x.index[i], y.index[j], at.slice};
                inside[i] = hn::And(x.inside[i], y.inside[j]);
            }
            load(level, position, inside, at.dref, texels);
            for (size_t p = 0; p < Source::kPlanes; ++p) {
                const VF row[4] = {floatOf(texels[0][p]), floatOf(texels[1][p]), floatOf(texels[2][p]),
                                   floatOf(texels[3][p])};
                rows[j][p] = bitsOf(mixCubic(row, across));
            }
        }
        for (size_t p = 0; p < Source::kPlanes; ++p) {
            const VF column[4] = {floatOf(rows[0][p]), floatOf(rows[1][p]), floatOf(rows[2][p]), floatOf(rows[3][p])};
            result[p] = bitsOf(mixCubic(column, down));
        }
    }

    HWY_INLINE void blendSquare(const Texel (&texels)[4], VF wx, VF wy, Texel& result) const {
        unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
            const VU top = combine(texels[0][p], texels[1][p], wx);
            const VU bottom = combine(texels[2][p], texels[3][p], wx);
            result[p] = combine(top, bottom, wy);
        });
    }

    /// Two texels by the reduction mode; `weight`: of b, less than 1.
    HWY_INLINE VU combine(VU a, VU b, VF weight) const {
        if constexpr (kExtended) {
            if (sampler_.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
                return hn::IfThenElse(hn::RebindMask(U32(), hn::Eq(weight, hn::Zero(F32()))), a, extreme(a, b));
            }
        }
        return lerpPlane<Source>(a, b, weight);
    }

    /// The lesser or the greater of two texels; not a NaN if one of them is a number.
    HWY_INLINE VU extreme(VU a, VU b) const {
        const VF fa = floatOf(a), fb = floatOf(b);
        const Mask better = sampler_.reduction == VK_SAMPLER_REDUCTION_MODE_MIN ? hn::Lt(fb, fa) : hn::Gt(fb, fa);
        return hn::IfThenElse(hn::RebindMask(U32(), hn::Or(better, hn::IsNaN(fa))), b, a);
    }

    // --- Filters and levels

    // Not inlined: the levels of one vector share the code.
    HWY_NOINLINE void sampleLevel(const TextureLevel& level, const Coordinates& at, Mask magnified,
                                  Texel& result) const {
        bool magLinear = sampler_.magFilter == VK_FILTER_LINEAR, minLinear = sampler_.minFilter == VK_FILTER_LINEAR;
        bool magCubic = false, minCubic = false;
        if constexpr (kHasCubic) {
            magCubic = sampler_.magFilter == VK_FILTER_CUBIC_EXT;
            minCubic = sampler_.minFilter == VK_FILTER_CUBIC_EXT;
            if (magCubic && minCubic) return cubic(level, at, result);
            // All lanes by the other filter, then those that are cubic.
            if (magCubic) magLinear = minLinear;
            if (minCubic) minLinear = magLinear;
        }
        const bool mixed = magLinear != minLinear;  // otherwise `magnified` says nothing
        const Mask isLinear = magLinear ? magnified : hn::Not(magnified);
        const bool anyLinear = mixed ? !hn::AllFalse(F32(), isLinear) : magLinear;
        const bool anyNearest = mixed ? !hn::AllTrue(F32(), isLinear) : !magLinear;
        if (anyLinear) linear(level, at, result);
        if (anyNearest) {
            Texel sharp;
            nearest(level, at, sharp);
            const auto choose = hn::RebindMask(U32(), isLinear);
            unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                result[p] = anyLinear ? hn::IfThenElse(choose, result[p], sharp[p]) : sharp[p];
            });
        }
        if constexpr (kHasCubic) {
            if (!magCubic && !minCubic) return;
            Texel smooth;
            cubic(level, at, smooth);
            const auto choose = hn::RebindMask(U32(), magCubic ? magnified : hn::Not(magnified));
            for (size_t p = 0; p < Source::kPlanes; ++p) result[p] = hn::IfThenElse(choose, smooth[p], result[p]);
        }
    }

    /// Each lane from its own level: one pass per level that occurs, nearly always one or two.
    HWY_NOINLINE void sampleLevels(VI levels, const Coordinates& at, Mask magnified, Texel& result) const {
        if (view_.levelCount == 1) {
            sampleLevel(view_.levels[0], at, magnified, result);
            return;
        }
        const auto only = static_cast<uint32_t>(hn::GetLane(levels));
        if (hn::AllTrue(I32(), hn::Eq(levels, splatInt(static_cast<int32_t>(only))))) {
            sampleLevel(view_.levels[only], at, magnified, result);
            return;
        }
        alignas(64) int32_t index[kVectorLanes];
        hn::Store(levels, I32(), index);
        unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA { result[p] = hn::Zero(U32()); });
        auto done = hn::MaskFromVec(hn::Zero(I32()));
        while (!hn::AllTrue(I32(), done)) {
            const int32_t next = index[hn::FindFirstTrue(I32(), hn::Not(done))];
            Texel other;
            sampleLevel(view_.levels[static_cast<uint32_t>(next)], at, magnified, other);
            const auto here = hn::Eq(levels, splatInt(next));
            unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                result[p] = hn::IfThenElse(hn::RebindMask(U32(), here), other[p], result[p]);
            });
            done = hn::Or(done, here);
        }
    }

    /// Isotropic. `lambdaPrime`: read where there are levels or filters to choose from.
    HWY_INLINE void sampleVector(uint32_t first, uint32_t count, VF lambdaPrime) const {
        Texel texel;
        const Coordinates at = coordinates(first, count);
        if (view_.levelCount == 1 && sampler_.magFilter == sampler_.minFilter) {
            sampleLevel(view_.levels[0], at, hn::MaskFromVec(hn::Zero(F32())), texel);
        } else {
            sampleChoice(chooseLevels(view_, sampler_, lowestLod(sampler_, request_, first, count), lambdaPrime), at,
                         texel);
        }
        write(texel, first, count);
    }

    HWY_INLINE void sampleChoice(const LevelChoice& choice, const Coordinates& at, Texel& texel) const {
        const Mask magnified = hn::Not(hn::Gt(choice.lambda, hn::Zero(F32())));
        sampleLevels(choice.high, at, magnified, texel);
        if (hn::AllTrue(F32(), hn::Eq(choice.weight, hn::Zero(F32())))) return;
        Texel less;
        sampleLevels(choice.low, at, magnified, less);
        unrolled<Source::kPlanes>([&](auto p)
                                      VERNIER_INLINE_LAMBDA { texel[p] = combine(texel[p], less[p], choice.weight); });
    }

    HWY_INLINE void write(const Texel& texel, uint32_t first, uint32_t count) const {
        for (uint32_t i = 0; i < outputCount_; ++i) {
            const Output& output = outputs_[i];
            const VU value =
                output.plane == kConstantPlane ? splatBits(output.constant) : source_.finish(texel[output.plane]);
            storeLanes(value, output.target, first, count);
        }
    }

    HWY_INLINE void gatherVector(uint32_t first, uint32_t count, VF lambdaPrime) const {
        if constexpr (kShape != Shape::volume && !Source::kFinite) {
            const Route route = compare_ ? Route::r : routeOf(view_.swizzle, request_.component);
            const Coordinates at = coordinates(first, count);
            const LevelChoice choice =
                chooseLevels(view_, sampler_, lowestLod(sampler_, request_, first, count), lambdaPrime);
            alignas(64) int32_t index[kVectorLanes];
            hn::Store(choice.high, I32(), index);
            constexpr int kOrder[4] = {2, 3, 1, 0};  // (0,1), (1,1), (1,0), (0,0)
            VU result[4];
            auto done = hn::MaskFromVec(hn::Zero(I32()));
            for (int c = 0; c < 4; ++c) result[c] = splatBits(constantBits(view_.ops.layout, route == Route::one));
            while (route <= Route::a && !hn::AllTrue(I32(), done)) {
                const int32_t level = index[hn::FindFirstTrue(I32(), hn::Not(done))];
                const auto here = hn::Eq(choice.high, splatInt(level));
                Texel texels[4];
                VF wx, wy;
                squareTaps(view_.levels[static_cast<uint32_t>(level)], at, texels, wx, wy);
                for (int c = 0; c < 4; ++c) {
                    const VU value = texels[kOrder[c]][static_cast<uint32_t>(route)];
                    result[c] = hn::IfThenElse(hn::RebindMask(U32(), here), value, result[c]);
                }
                done = hn::Or(done, here);
            }
            for (int c = 0; c < 4; ++c) {
                if (request_.out[c] != nullptr) storeLanes(result[c], request_.out[c], first, count);
            }
        }
    }

    /// An output that somebody wants: a plane of the filtered texel or a constant.
    struct Output {
        float* target;
        uint32_t constant;
        uint8_t plane;
    };

    const SampleCall& call_;
    const TextureView& view_;
    const SamplerState& sampler_;
    const SampleRequest& request_;
    Output outputs_[4];
    uint32_t outputCount_ = 0;
    Source source_;
    uint32_t border_[4];
    uint32_t neededComponents_ = 0;
    bool compare_;
    bool fixedPointDepth_;
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
