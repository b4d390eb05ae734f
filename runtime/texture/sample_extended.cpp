#include "runtime/texture/sample_extended.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/texture/sample_extended.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/texture/anisotropic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

template <class Source, Shape kShape>
void runExtended(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    const SampleCall call{view, sampler, request};
    const bool derivatives = request.lodMode == LodMode::implicitLod || request.lodMode == LodMode::gradients;
    if (sampler.maxAnisotropy > 1.0f && derivatives) return AnisotropicSampler<Source, kShape>(call).sample();
    Sampler<Source, kShape, true>(call).sample();
}

template <class Source>
SampleFn extendedByShape(VkImageViewType type) {
    switch (shapeOf(type)) {
        case Shape::volume:
            return runExtended<Source, Shape::volume>;
        case Shape::cube:
            return runExtended<Source, Shape::cube>;
        case Shape::flat:
            break;
    }
    return runExtended<Source, Shape::flat>;
}

SampleFn selectExtendedRoutine(const TextureView& view, const SamplerState& sampler) {
    const bool rgba8 = rgba8Kind(view, sampler) != Rgba8Kind::none && !isCubic(sampler);
    return rgba8 ? extendedByShape<Rgba8Source>(view.type) : extendedByShape<AnySource<4>>(view.type);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {
namespace {

auto extendedSelector(Isa isa) {
    VERNIER_SELECT_ISA(isa, selectExtendedRoutine)
}

}  // namespace

SampleFn selectExtendedSampler(const TextureView& view, const SamplerState& sampler, Isa isa) {
    return extendedSelector(isa)(view, sampler);
}

}  // namespace vernier
#endif
