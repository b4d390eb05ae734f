#include "runtime/texture/sample_extended.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/texture/sample_extended.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/texture/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

template <class Source, Shape kShape>
void runExtended(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    Sampler<Source, kShape, Wrap::any, true>(view, sampler, request).sample();
}

template <class Source>
SampleFn byShape(VkImageViewType type) {
    if (type == VK_IMAGE_VIEW_TYPE_3D) return runExtended<Source, Shape::volume>;
    const bool cube = type == VK_IMAGE_VIEW_TYPE_CUBE || type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    return cube ? runExtended<Source, Shape::cube> : runExtended<Source, Shape::flat>;
}

SampleFn selectExtendedRoutine(const TextureView& view, const SamplerState& sampler) {
    if (view.block != nullptr) return byShape<BlockSource<4>>(view.type);
    const bool wide = !offsetsFitInt32(view);
    switch (rgba8Kind(view, sampler)) {
        case Rgba8Kind::unorm:
            return wide ? byShape<AnySource<4>>(view.type) : byShape<Rgba8Source<false, false>>(view.type);
        case Rgba8Kind::srgb:
            return wide ? byShape<AnySource<4>>(view.type) : byShape<Rgba8Source<true, false>>(view.type);
        case Rgba8Kind::none:
            break;
    }
    return byShape<AnySource<4>>(view.type);
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
