// The sampling routine: coordinates to level of detail, to texels, to filtered values, for one vector of
// lanes after the other. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_SAMPLER_INL_H
#undef VERNIER_TEXTURE_SAMPLER_INL_H
#else
#define VERNIER_TEXTURE_SAMPLER_INL_H
#endif

#include "runtime/texture/cube.h"
#include "runtime/texture/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

enum class Shape { flat, volume, cube };  // 1D and 2D, 3D, cube; with or without layers

/// The coordinates of one vector of lanes, free of the level of detail.
struct Coordinates {
    VF s, t, r;  // of a cube: s and t on the face
    VI slice;    // array layer or face; z of a volume comes from r
    VF dref;
};

/// Everything of one call that does not change from vector to vector. kExtended: anisotropy, reduction modes other than
/// the average, cubes with seams; all others have no trace of them.
template <class Source, Shape kShape, Wrap kWrap, bool kExtended = false>
class Sampler {
  public:
    Sampler(const TextureView& view, const SamplerState& sampler, const SampleRequest& request)
        : view_(view), sampler_(sampler), request_(request), source_(view), compare_(sampler.compareEnable) {
        source_.borderPlanes(sampler.borderColor, border_);
        neededComponents_ = compare_ ? 1 : 0;
        for (uint32_t c = 0; c < 4; ++c) {
            const Route route = compare_ ? Route::r : routeOf(view.swizzle, c);
            if (request.out[c] == nullptr || (compare_ && c != 0)) continue;
            Output& output = outputs_[outputCount_++];
            output.target = request.out[c];
            output.plane = route <= Route::a ? source_.planeOf[static_cast<uint32_t>(route)] : kConstantPlane;
            output.constant = constantBits(view.ops.layout, route == Route::one || route == Route::a);
            if (output.plane != kConstantPlane) neededComponents_ |= 1u << static_cast<uint32_t>(route);
        }
        fixedPointDepth_ = view.ops.layout.rgba[0].kind == ComponentKind::unorm;
    }

    void sample() const {
        if constexpr (kExtended) {
            const bool derivatives = request_.lodMode == LodMode::implicitLod || request_.lodMode == LodMode::gradients;
            if (sampler_.maxAnisotropy > 1.0f && derivatives) {
                forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR { anisotropicVector(first, count); });
                return;
            }
        }
        const bool usesLambda = view_.levelCount > 1 || sampler_.magFilter != sampler_.minFilter;
        if (!usesLambda || request_.lodMode != LodMode::implicitLod || sampler_.unnormalizedCoordinates) {
            forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
                sampleVector(first, count, usesLambda ? lambda(first, count) : hn::Zero(F32()));
            });
            return;
        }
        alignas(64) float implicit[kMaxSampleLanes + 4 * kVectorLanes];
        for (uint32_t first = 0; first < request_.lanes; first += 4 * kVectorLanes)
            quadLambdas(first, implicit + first);
        forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
            sampleVector(first, count, biasedLambda(sampler_, request_, first, count, [&]() HWY_ATTR {
                             return hn::Load(F32(), implicit + first);
                         }));
        });
    }

    void gather() {
        // The four outputs are texels of one component, whichever of them are wanted.
        const Route route = compare_ ? Route::r : routeOf(view_.swizzle, request_.component);
        neededComponents_ = route <= Route::a ? 1u << static_cast<uint32_t>(route) : 0;
        forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR { gatherVector(first, count); });
    }

    void queryLod() const {
        forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
            const VF lambdaPrime = lambda(first, count);
            const LevelChoice choice =
                chooseLevels(view_, sampler_, lowestLod(sampler_, request_, first, count), lambdaPrime);
            const VF level = hn::Add(hn::ConvertTo(F32(), choice.high), choice.weight);
            if (request_.out[0] != nullptr) storeLanes(bitsOf(level), request_.out[0], first, count);
            if (request_.out[1] != nullptr) storeLanes(bitsOf(lambdaPrime), request_.out[1], first, count);
        });
    }

  private:
    using Mask = hn::Mask<F32>;

    template <class Step>
    HWY_INLINE void forEachVector(Step step) const {
        for (uint32_t first = 0; first < request_.lanes; first += kVectorLanes) {
            const uint32_t count = request_.lanes - first;
            if (request_.mask != nullptr) {
                const VU active = loadLanes(request_.mask, first, count);
                if (hn::AllTrue(U32(), hn::Eq(active, hn::Zero(U32())))) continue;
            }
            step(first, count);
        }
    }

    HWY_INLINE VF coordinate(int axis, uint32_t first, uint32_t count) const {
        return loadLanes(request_.coord[axis], first, count);
    }

    bool isOneDimensional() const {
        return view_.type == VK_IMAGE_VIEW_TYPE_1D || view_.type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    }

    /// `shift`: added to s, t, r; nullptr: nothing is.
    HWY_INLINE Coordinates coordinates(uint32_t first, uint32_t count, const VF* shift = nullptr) const {
        Coordinates at;
        at.s = coordinate(0, first, count);
        // A 1D image is one row, met in the middle.
        at.t = isOneDimensional() ? splatFloat(0.5f) : coordinate(1, first, count);
        at.r = kShape == Shape::flat ? hn::Zero(F32()) : coordinate(2, first, count);
        if (shift != nullptr) {
            at.s = hn::Add(at.s, shift[0]);
            if (!isOneDimensional()) at.t = hn::Add(at.t, shift[1]);
            if constexpr (kShape != Shape::flat) at.r = hn::Add(at.r, shift[2]);
        }
        at.slice = hn::Zero(I32());
        at.dref = hn::Zero(F32());
        if (view_.layerCount > 1 && kShape != Shape::volume) {
            const uint32_t layers = kShape == Shape::cube ? view_.layerCount / 6 : view_.layerCount;
            const VF layer =
                clampOrLowV(coordinate(3, first, count), hn::Zero(F32()), splatFloat(static_cast<float>(layers - 1)));
            at.slice = hn::NearestInt(layer);
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

    // --- Level of detail

    /// Squared length of a gradient in texels of the base level.
    HWY_INLINE VF gradientLength2(VF ds, VF dt, VF dr) const {
        const TextureLevel& base = view_.levels[0];
        const VF u = hn::Mul(ds, splatFloat(static_cast<float>(base.width)));
        const VF v = hn::Mul(dt, splatFloat(static_cast<float>(base.height)));
        VF sum = hn::Add(hn::Mul(u, u), hn::Mul(v, v));
        if constexpr (kShape == Shape::volume) {
            const VF w = hn::Mul(dr, splatFloat(static_cast<float>(base.depth)));
            sum = hn::Add(sum, hn::Mul(w, w));
        }
        return sum;
    }

    /// A pixel seen in the texture: the derivatives of s, t, r along the framebuffer's axes, and the squared lengths of
    /// both in texels of the base level.
    struct Footprint {
        VF dx[3], dy[3];
        VF x2, y2;
    };

    HWY_INLINE Footprint footprint(uint32_t first, uint32_t count) const {
        Footprint print;
        VF at[3], dx[3], dy[3];
        for (int i = 0; i < 3; ++i) {
            const bool gradients = request_.lodMode == LodMode::gradients;
            at[i] = coordinate(i, first, count);
            dx[i] = gradients ? loadLanes(request_.gradX[i], first, count) : quadDx(at[i]);
            dy[i] = gradients ? loadLanes(request_.gradY[i], first, count) : quadDy(at[i]);
        }
        if (isOneDimensional()) dx[1] = dy[1] = hn::Zero(F32());
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
        print.x2 = gradientLength2(dx[0], dx[1], dx[2]);
        print.y2 = gradientLength2(dy[0], dy[1], dy[2]);
        return print;
    }

    /// "Scale Factor Operation": the squares of rho max, of the ratio of anisotropy eta, and of rho max / eta.
    struct Scale {
        VF major2, eta2, rho2;
    };

    HWY_INLINE Scale scaleOf(const Footprint& print) const {
        const VF major2 = hn::IfThenElse(hn::Gt(print.x2, print.y2), print.x2, print.y2);
        if (!(sampler_.maxAnisotropy > 1.0f)) return {major2, splatFloat(1.0f), major2};
        const VF minor2 = hn::IfThenElse(hn::Gt(print.x2, print.y2), print.y2, print.x2);
        const VF limit2 = splatFloat(sampler_.maxAnisotropy * sampler_.maxAnisotropy);
        const Mask limited = hn::Gt(major2, hn::Mul(minor2, limit2));
        const VF ratio2 = hn::Div(major2, minor2);
        const VF eta2 = hn::IfThenElse(limited, limit2, clampOrLowV(ratio2, splatFloat(1.0f), limit2));
        return {major2, eta2, hn::IfThenElse(limited, hn::Div(major2, limit2), minor2)};
    }

    HWY_NOINLINE VF derivativeLambda(uint32_t first, uint32_t count) const {
        return hn::Mul(log2V(scaleOf(footprint(first, count)).rho2), splatFloat(0.5f));
    }

    /// The same for four vectors of lanes at once, with derivatives over quads: these are equal in all lanes of a quad,
    /// so that one vector holds the quads of all four.
    HWY_NOINLINE void quadLambdas(uint32_t first, float* lambdas) const {
        const F32 df;
        const VI place = hn::And(hn::Iota(I32(), 0), splatInt(3));
        VF squares = hn::Zero(df);
        unrolled<4>([&](auto k) VERNIER_INLINE_LAMBDA {
            const uint32_t lane = first + k * kVectorLanes;
            if (lane >= request_.lanes) return;
            const VF square = scaleOf(footprint(lane, request_.lanes - lane)).rho2;
            squares = hn::IfThenElse(hn::RebindMask(df, hn::Eq(place, splatInt(k))), square, squares);
        });
        const VF result = hn::Mul(log2V(squares), splatFloat(0.5f));
        unrolled<4>([&](auto k)
                        VERNIER_INLINE_LAMBDA { hn::Store(hn::Broadcast<k>(result), df, lambdas + k * kVectorLanes); });
    }

    HWY_INLINE VF lambda(uint32_t first, uint32_t count) const {
        if (sampler_.unnormalizedCoordinates) return hn::Zero(F32());
        return biasedLambda(sampler_, request_, first, count,
                            [&]() HWY_ATTR { return derivativeLambda(first, count); });
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
        if constexpr (kWrap == Wrap::any && (kShape != Shape::cube || kExtended)) {
            unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
                const auto isInside = hn::MaskFromVec(hn::BitCast(U32(), inside[t]));
                unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                    texels[t][p] = hn::IfThenElse(isInside, texels[t][p], splatBits(border_[p]));
                });
            });
        }
        if constexpr (!Source::kFinite) {
            if (!compare_) return;
            unrolled<kTaps>([&](auto t)
                                VERNIER_INLINE_LAMBDA { texels[t][0] = compareTexel(dref, floatOf(texels[t][0])); });
        }
    }

    HWY_INLINE VU compareTexel(VF dref, VF texel) const {
        Mask pass;
        switch (sampler_.compareOp) {
            case VK_COMPARE_OP_LESS:
                pass = hn::Lt(dref, texel);
                break;
            case VK_COMPARE_OP_EQUAL:
                pass = hn::Eq(dref, texel);
                break;
            case VK_COMPARE_OP_LESS_OR_EQUAL:
                pass = hn::Le(dref, texel);
                break;
            case VK_COMPARE_OP_GREATER:
                pass = hn::Gt(dref, texel);
                break;
            case VK_COMPARE_OP_NOT_EQUAL:
                pass = hn::Ne(dref, texel);
                break;
            case VK_COMPARE_OP_GREATER_OR_EQUAL:
                pass = hn::Ge(dref, texel);
                break;
            case VK_COMPARE_OP_ALWAYS:
                return bitsOf(splatFloat(1.0f));
            default:
                return hn::Zero(U32());
        }
        return bitsOf(hn::IfThenElseZero(pass, splatFloat(1.0f)));
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
            nearestTap<Wrap::any>(at.s, faceAxis(level), x);
            nearestTap<Wrap::any>(at.t, faceAxis(level), y);
        } else {
            nearestTap<kWrap>(at.s, axis(0, level.width), x);
            nearestTap<kWrap>(at.t, axis(1, level.height), y);
        }
        position[0] = {x.index[0], y.index[0], at.slice};
        if constexpr (kWrap == Wrap::any && (kShape != Shape::cube || kExtended)) {
            inside[0] = hn::And(x.inside[0], y.inside[0]);
        }
        if constexpr (kShape == Shape::volume) {
            nearestTap<kWrap>(at.r, axis(2, level.depth), z);
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
            cubeTaps(level, at, position, corner, wx, wy);
            load(level, position, inside, at.dref, texels);
            for (int t = 0; t < 4; ++t) fillCorner(corner[t], texels[t], texels[t ^ 1], texels[t ^ 2], texels[t ^ 3]);
            return;
        }
        if constexpr (kShape != Shape::cube || kExtended) {
            AxisTaps x, y;
            linearTaps<kWrap>(at.s, axis(0, level.width), x);
            linearTaps<kWrap>(at.t, axis(1, level.height), y);
            wx = x.weight;
            wy = y.weight;
            if constexpr (kWrap != Wrap::any) {
                source_.loadSquare(level, x, y, at.slice, texels);
                return;
            }
            unrolled<4>([&](auto t) VERNIER_INLINE_LAMBDA {
                position[t] = {x.index[t & 1], y.index[t >> 1], at.slice};
                if constexpr (kWrap == Wrap::any) inside[t] = hn::And(x.inside[t & 1], y.inside[t >> 1]);
            });
            load(level, position, inside, at.dref, texels);
        }
    }

    HWY_INLINE void linear(const TextureLevel& level, const Coordinates& at, Texel& result) const {
        if constexpr (kShape == Shape::volume) {
            AxisTaps x, y, z;
            linearTaps<kWrap>(at.s, axis(0, level.width), x);
            linearTaps<kWrap>(at.t, axis(1, level.height), y);
            linearTaps<kWrap>(at.r, axis(2, level.depth), z);
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
        return hn::IfThenElse(hn::RebindMask(U32(), hn::Or(better, hn::Ne(fa, fa))), b, a);
    }

    // --- Cubes

    static Axis faceAxis(const TextureLevel& level) {
        return {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, static_cast<int32_t>(level.width), 0, true};
    }

    /// As the positions of a flat image, but texels beyond an edge are those of the neighbouring face.
    /// corner[t]: all ones where tap t lies beyond two edges and has no texel.
    HWY_INLINE void cubeTaps(const TextureLevel& level, const Coordinates& at, TexelPosition (&position)[4],
                             VI (&corner)[4], VF& wx, VF& wy) const {
        const auto size = static_cast<int32_t>(level.width);
        const auto tap = [&](VF s, VF& weight) HWY_ATTR {
            const VF zero = hn::Zero(F32()), extent = splatFloat(static_cast<float>(size));
            const VF u = hn::Sub(clampOrLowV(hn::Mul(s, extent), zero, extent), splatFloat(0.5f));
            const VF whole = hn::Floor(u);
            weight = hn::Sub(u, whole);
            return hn::ConvertTo(I32(), whole);  // -1 .. size - 1
        };
        const VI x0 = tap(at.s, wx), y0 = tap(at.t, wy), one = splatInt(1);
        const auto outside = [&](VI i)
                                 HWY_ATTR { return hn::Or(hn::Lt(i, hn::Zero(I32())), hn::Gt(i, splatInt(size - 1))); };
        for (int t = 0; t < 4; ++t) {
            const VI x = (t & 1) != 0 ? hn::Add(x0, one) : x0, y = (t & 2) != 0 ? hn::Add(y0, one) : y0;
            const auto outX = outside(x), outY = outside(y);
            corner[t] = hn::VecFromMask(I32(), hn::And(outX, outY));
            position[t] = {clampIndex(x, size), clampIndex(y, size), at.slice};
            const auto fold = hn::Xor(outX, outY);
            if (!hn::AllFalse(I32(), fold)) foldLanes(x, y, hn::VecFromMask(I32(), fold), size, position[t]);
        }
    }

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

    /// Where `corner` is set, the mean of the other three texels; exactly that value where they are equal.
    HWY_INLINE void fillCorner(VI corner, Texel& texel, const Texel& a, const Texel& b, const Texel& c) const {
        const auto isCorner = hn::MaskFromVec(hn::BitCast(U32(), corner));
        if (hn::AllFalse(U32(), isCorner)) return;
        for (int p = 0; p < Source::kPlanes; ++p) {
            const VF fa = floatOf(a[p]), fb = floatOf(b[p]), fc = floatOf(c[p]);
            const VF third = splatFloat(3.0f);
            const VF mean = hn::Add(hn::Add(hn::Div(fa, third), hn::Div(fb, third)), hn::Div(fc, third));
            const auto equal = hn::And(hn::Eq(fa, fb), hn::Eq(fb, fc));
            texel[p] = hn::IfThenElse(isCorner, bitsOf(hn::IfThenElse(equal, fa, mean)), texel[p]);
        }
    }

    // --- Filters and levels

    // Not inlined: the levels of one vector share the code.
    HWY_NOINLINE void sampleLevel(const TextureLevel& level, const Coordinates& at, Mask magnified,
                                  Texel& result) const {
        const bool magLinear = sampler_.magFilter == VK_FILTER_LINEAR,
                   minLinear = sampler_.minFilter == VK_FILTER_LINEAR;
        const bool mixed = magLinear != minLinear;  // otherwise `magnified` says nothing
        const Mask isLinear = magLinear ? magnified : hn::Not(magnified);
        const bool anyLinear = mixed ? !hn::AllFalse(F32(), isLinear) : magLinear;
        const bool anyNearest = mixed ? !hn::AllTrue(F32(), isLinear) : !magLinear;
        if (anyLinear) linear(level, at, result);
        if (!anyNearest) return;
        Texel sharp;
        nearest(level, at, sharp);
        const auto choose = hn::RebindMask(U32(), isLinear);
        unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
            result[p] = anyLinear ? hn::IfThenElse(choose, result[p], sharp[p]) : sharp[p];
        });
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

    /// "Texel Anisotropic Filtering": the mean of N samples along the longer axis of the footprint. N = ceil(eta), but
    /// no more than the footprint is texels of the base level long: between its texels there is nothing to miss.
    HWY_NOINLINE void anisotropicVector(uint32_t first, uint32_t count) const {
        const Footprint print = footprint(first, count);
        const Scale scale = scaleOf(print);
        const VF zero = hn::Zero(F32()), one = splatFloat(1.0f), half = splatFloat(0.5f);
        const LevelChoice choice =
            chooseLevels(view_, sampler_, lowestLod(sampler_, request_, first, count), lambda(first, count));
        const VF needed2 = hn::Min(scale.eta2, hn::Max(scale.major2, one));
        const VF samples = clampOrLowV(hn::Ceil(hn::Sqrt(needed2)), one, splatFloat(kMaxSamplerAnisotropy));
        const Mask alongX = hn::Gt(print.x2, print.y2);
        VF major[3];
        for (int i = 0; i < 3; ++i) major[i] = hn::IfThenElse(alongX, print.dx[i], print.dy[i]);
        // The mean as the first sample plus the mean of the differences from it: equal samples stay what they are.
        Texel reference, sum;
        const float most = hn::GetLane(hn::MaxOfLanes(F32(), samples));
        for (float i = 1; i <= most; ++i) {
            const VF place = hn::Sub(hn::Div(splatFloat(i), hn::Add(samples, one)), half);
            const Mask active = hn::Le(splatFloat(i), samples);
            VF shift[3];
            for (int k = 0; k < 3; ++k) shift[k] = hn::IfThenElse(active, hn::Mul(place, major[k]), zero);
            Texel texel;
            sampleChoice(choice, coordinates(first, count, shift), texel);
            const auto take = hn::RebindMask(U32(), active);
            unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                if (i == 1) {
                    reference[p] = texel[p];
                    sum[p] = hn::Zero(U32());
                } else if (sampler_.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
                    reference[p] = hn::IfThenElse(take, extreme(reference[p], texel[p]), reference[p]);
                } else {
                    const VF a = floatOf(reference[p]), b = floatOf(texel[p]);
                    Mask none = hn::Eq(a, b);
                    if constexpr (!Source::kFinite) none = hn::Or(none, hn::And(hn::IsInf(a), hn::IsFinite(b)));
                    const VF difference = hn::IfThenElse(none, zero, hn::Sub(b, a));
                    sum[p] = hn::IfThenElse(take, bitsOf(hn::Add(floatOf(sum[p]), difference)), sum[p]);
                }
            });
        }
        unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
            sum[p] = bitsOf(hn::Add(floatOf(reference[p]), hn::Div(floatOf(sum[p]), samples)));
        });
        write(sum, first, count);
    }

    HWY_INLINE void write(const Texel& texel, uint32_t first, uint32_t count) const {
        for (uint32_t i = 0; i < outputCount_; ++i) {
            const Output& output = outputs_[i];
            const VU value =
                output.plane == kConstantPlane ? splatBits(output.constant) : source_.finish(texel[output.plane]);
            storeLanes(value, output.target, first, count);
        }
    }

    HWY_INLINE void gatherVector(uint32_t first, uint32_t count) const {
        if constexpr (kShape != Shape::volume && !Source::kFinite) {
            const Route route = compare_ ? Route::r : routeOf(view_.swizzle, request_.component);
            const Coordinates at = coordinates(first, count);
            const LevelChoice choice =
                chooseLevels(view_, sampler_, lowestLod(sampler_, request_, first, count), lambda(first, count));
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
