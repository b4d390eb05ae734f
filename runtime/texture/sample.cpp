// Which sampling routine a view and a sampler get: one per kind of texel, shape of image and pair of address
// modes.
#include "runtime/texture/sample_extended.h"
#include "runtime/texture/texture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/texture/sample.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/texture/sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

template <class Source, Shape kShape, Wrap kWrap>
void runSample(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    Sampler<Source, kShape, kWrap>(view, sampler, request).sample();
}

template <Shape kShape>
void runGather(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    if (view.block != nullptr) return Sampler<BlockSource<4>, kShape, Wrap::any>(view, sampler, request).gather();
    Sampler<AnySource<4>, kShape, Wrap::any>(view, sampler, request).gather();
}

template <Shape kShape>
void runQueryLod(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    Sampler<AnySource<1>, kShape, Wrap::any>(view, sampler, request).queryLod();
}

Shape shapeOf(VkImageViewType type) {
    if (type == VK_IMAGE_VIEW_TYPE_3D) return Shape::volume;
    return type == VK_IMAGE_VIEW_TYPE_CUBE || type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY ? Shape::cube : Shape::flat;
}

template <bool kSrgb>
SampleFn selectRgba8(const TextureView& view, const SamplerState& sampler) {
    using Narrow = Rgba8Source<kSrgb, false>;
    using Wide = Rgba8Source<kSrgb, true>;
    switch (shapeOf(view.type)) {
        case Shape::volume:
            return runSample<Wide, Shape::volume, Wrap::any>;
        case Shape::cube:
            return runSample<Wide, Shape::cube, Wrap::any>;
        case Shape::flat:
            break;
    }
    if (!offsetsFitInt32(view)) return runSample<Wide, Shape::flat, Wrap::any>;
    const bool oneDimensional = view.type == VK_IMAGE_VIEW_TYPE_1D || view.type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    const VkSamplerAddressMode u = sampler.addressMode[0], v = oneDimensional ? u : sampler.addressMode[1];
    if (u == v && u == VK_SAMPLER_ADDRESS_MODE_REPEAT) return runSample<Narrow, Shape::flat, Wrap::repeat>;
    if (u == v && u == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE) return runSample<Narrow, Shape::flat, Wrap::clampToEdge>;
    return runSample<Narrow, Shape::flat, Wrap::any>;
}

SampleFn selectSampleRoutine(const TextureView& view, const SamplerState& sampler) {
    const TexelLayout& layout = view.ops.layout;
    const Component& first = layout.rgba[0];
    const bool words = layout.bytes == 4 && view.texelPitch == 4;
    if (view.block != nullptr) {
        switch (shapeOf(view.type)) {
            case Shape::volume:
                return runSample<BlockSource<4>, Shape::volume, Wrap::any>;
            case Shape::cube:
                return runSample<BlockSource<4>, Shape::cube, Wrap::any>;
            case Shape::flat:
                return runSample<BlockSource<4>, Shape::flat, Wrap::any>;
        }
    }
    switch (rgba8Kind(view, sampler)) {
        case Rgba8Kind::unorm:
            return selectRgba8<false>(view, sampler);
        case Rgba8Kind::srgb:
            return selectRgba8<true>(view, sampler);
        case Rgba8Kind::none:
            break;
    }
    switch (shapeOf(view.type)) {
        case Shape::volume:
            return runSample<AnySource<4>, Shape::volume, Wrap::any>;
        case Shape::cube:
            return runSample<AnySource<4>, Shape::cube, Wrap::any>;
        case Shape::flat:
            break;
    }
    if (layout.rgba[1].bits != 0) return runSample<AnySource<4>, Shape::flat, Wrap::any>;
    if (words && first.offset == 0 && offsetsFitInt32(view)) {
        if (first.bits == 32) return runSample<R32Source<false>, Shape::flat, Wrap::any>;
        if (first.bits == 24) return runSample<R32Source<true>, Shape::flat, Wrap::any>;
    }
    return runSample<AnySource<1>, Shape::flat, Wrap::any>;
}

SampleFn selectGatherRoutine(const TextureView& view) {
    return shapeOf(view.type) == Shape::cube ? runGather<Shape::cube> : runGather<Shape::flat>;
}

SampleFn selectQueryLodRoutine(const TextureView& view) {
    switch (shapeOf(view.type)) {
        case Shape::volume:
            return runQueryLod<Shape::volume>;
        case Shape::cube:
            return runQueryLod<Shape::cube>;
        case Shape::flat:
            break;
    }
    return runQueryLod<Shape::flat>;
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {
namespace {

auto sampleSelector(Isa isa) {
    VERNIER_SELECT_ISA(isa, selectSampleRoutine)
}
auto gatherSelector(Isa isa) {
    VERNIER_SELECT_ISA(isa, selectGatherRoutine)
}
auto queryLodSelector(Isa isa) {
    VERNIER_SELECT_ISA(isa, selectQueryLodRoutine)
}

}  // namespace

SampleFn selectSampler(const TextureView& view, const SamplerState& sampler, Isa isa) {
    if (isExtended(view, sampler)) return selectExtendedSampler(view, sampler, isa);
    return sampleSelector(isa)(view, sampler);
}

SampleFn selectGather(const TextureView& view, const SamplerState&, Isa isa) {
    return gatherSelector(isa)(view);
}

SampleFn selectQueryLod(const TextureView& view, const SamplerState&, Isa isa) {
    return queryLodSelector(isa)(view);
}

}  // namespace vernier
#endif
