// Anisotropic filtering: many samples along the longer axis of a pixel's footprint. Included once per target (see
// base/simd.h).
#if defined(VERNIER_TEXTURE_ANISOTROPIC_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_ANISOTROPIC_INL_H
#undef VERNIER_TEXTURE_ANISOTROPIC_INL_H
#else
#define VERNIER_TEXTURE_ANISOTROPIC_INL_H
#endif

#include "runtime/texture/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

template <class Source, Shape kShape>
class AnisotropicSampler : public Sampler<Source, kShape, true> {
  public:
    using Sampler<Source, kShape, true>::Sampler;

    void sample() const {
        alignas(64) float lambdas[kLambdaLanes];
        lambdaPrimes<kShape>(this->call_, lambdas);
        this->call_.forEachVector([&](uint32_t first, uint32_t count)
                                      HWY_ATTR { sampleVector(first, count, hn::Load(F32(), lambdas + first)); });
    }

  private:
    using Mask = hn::Mask<F32>;

    /// "Texel Anisotropic Filtering": the mean of N samples along the longer axis of the footprint. N = ceil(eta), but
    /// no more than the footprint is texels of the base level long: between its texels there is nothing to miss.
    HWY_NOINLINE void sampleVector(uint32_t first, uint32_t count, VF lambdaPrime) const {
        const Footprint print = footprintOf<kShape>(this->call_, first, count);
        const Scale scale = scaleOf(this->sampler_, print);
        const VF zero = hn::Zero(F32()), one = splatFloat(1.0f), half = splatFloat(0.5f);
        const LevelChoice choice = chooseLevels(this->view_, this->sampler_,
                                                lowestLod(this->sampler_, this->request_, first, count), lambdaPrime);
        const VF needed2 = minOrSecond(scale.eta2, maxOrSecond(scale.major2, one));
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
            this->sampleChoice(choice, this->coordinates(first, count, shift), texel);
            const auto take = hn::RebindMask(U32(), active);
            unrolled<Source::kPlanes>([&](auto p) VERNIER_INLINE_LAMBDA {
                if (i == 1) {
                    reference[p] = texel[p];
                    sum[p] = hn::Zero(U32());
                } else if (this->sampler_.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) {
                    reference[p] = hn::IfThenElse(take, this->extreme(reference[p], texel[p]), reference[p]);
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
        this->write(sum, first, count);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
