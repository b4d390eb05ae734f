// Which sampling routine a view and a sampler get: a fast one (word_sampler-inl.h) where they fit one, else one by the
// kind of texel and the shape of the image.
#include "runtime/texture/sample_extended.h"
#include "runtime/texture/texture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/texture/sample.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "runtime/texture/half_sampler-inl.h"
#include "runtime/texture/sampler-inl.h"
#include "runtime/texture/word_sampler-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

template <class Source, Shape kShape>
void runSample(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    Sampler<Source, kShape>({view, sampler, request}).sample();
}

template <Shape kShape>
void runGather(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    Sampler<AnySource<4>, kShape>({view, sampler, request}).gather();
}

template <Shape kShape>
void runQueryLod(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    const SampleCall call{view, sampler, request};
    alignas(64) float lambdas[kLambdaLanes];
    lambdaPrimes<kShape>(call, lambdas);
    call.forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
        const VF lambdaPrime = hn::Load(F32(), lambdas + first);
        const LevelChoice choice = chooseLevels(view, sampler, lowestLod(sampler, request, first, count), lambdaPrime);
        const VF level = hn::Add(hn::ConvertTo(F32(), choice.high), choice.weight);
        if (request.out[0] != nullptr) storeLanes(bitsOf(level), request.out[0], first, count);
        if (request.out[1] != nullptr) storeLanes(bitsOf(lambdaPrime), request.out[1], first, count);
    });
}

/// `kAny`: the routine for requests with a texel offset.
template <SampleFn kAny, class Words, WordWrap kWrap, bool kLinear, bool kLevels>
void runWords(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    if ((request.offset[0] | request.offset[1]) != 0) return kAny(view, sampler, request);
    WordSampler<Words, kWrap, kLinear, kLevels>({view, sampler, request}).sample();
}

template <SampleFn kAny, class Words, WordWrap kWrap>
SampleFn selectFilter(const TextureView& view, const SamplerState& sampler) {
    const bool linear = sampler.magFilter == VK_FILTER_LINEAR;
    if (onlyLevel(view, sampler)) {
        return linear ? runWords<kAny, Words, kWrap, true, false> : runWords<kAny, Words, kWrap, false, false>;
    }
    if constexpr (Words::kLevels) {
        return linear ? runWords<kAny, Words, kWrap, true, true> : runWords<kAny, Words, kWrap, false, true>;
    }
    return kAny;
}

/// The address mode of all axes, if a fast routine may fit at all.
std::optional<VkSamplerAddressMode> commonMode(const TextureView& view, const SamplerState& sampler) {
    const bool oneDimensional = view.type == VK_IMAGE_VIEW_TYPE_1D || view.type == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    const VkSamplerAddressMode u = sampler.addressMode[0], v = oneDimensional ? u : sampler.addressMode[1];
    if (u != v || sampler.magFilter != sampler.minFilter || sampler.unnormalizedCoordinates || !offsetsFitInt32(view))
        return std::nullopt;
    return u;
}

/// kAny if no fast routine fits.
template <SampleFn kAny, class Words>
SampleFn selectWords(const TextureView& view, const SamplerState& sampler) {
    const std::optional<VkSamplerAddressMode> u = commonMode(view, sampler);
    if (!u) return kAny;
    if (u == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)
        return selectFilter<kAny, Words, WordWrap::clampToEdge>(view, sampler);
    if constexpr (Words::kBorder) {
        if (u == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER)
            return selectFilter<kAny, Words, WordWrap::clampToBorder>(view, sampler);
    } else {
        if (u == VK_SAMPLER_ADDRESS_MODE_REPEAT) return selectFilter<kAny, Words, WordWrap::repeat>(view, sampler);
    }
    return kAny;
}

template <SampleFn kAny, WordWrap kWrap>
void runHalves(const TextureView& view, const SamplerState& sampler, const SampleRequest& request) {
    if ((request.offset[0] | request.offset[1]) != 0) return kAny(view, sampler, request);
    HalfSampler<kWrap>({view, sampler, request}).sample();
}

/// Likewise.
template <SampleFn kAny>
SampleFn selectHalves(const TextureView& view, const SamplerState& sampler) {
    if constexpr (kConvertsHalves) {
        const std::optional<VkSamplerAddressMode> mode = commonMode(view, sampler);
        if (!mode || sampler.magFilter != VK_FILTER_LINEAR || sampler.compareEnable || view.layerCount != 1 ||
            !onlyLevel(view, sampler))
            return kAny;
        if (mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE) return runHalves<kAny, WordWrap::clampToEdge>;
        if (mode == VK_SAMPLER_ADDRESS_MODE_REPEAT) return runHalves<kAny, WordWrap::repeat>;
    }
    return kAny;
}

template <class Source>
SampleFn byShape(VkImageViewType type) {
    switch (shapeOf(type)) {
        case Shape::volume:
            return runSample<Source, Shape::volume>;
        case Shape::cube:
            return runSample<Source, Shape::cube>;
        case Shape::flat:
            break;
    }
    return runSample<Source, Shape::flat>;
}

SampleFn selectSampleRoutine(const TextureView& view, const SamplerState& sampler) {
    const Shape shape = shapeOf(view.type);
    const Rgba8Kind rgba8 = rgba8Kind(view, sampler);
    if (rgba8 != Rgba8Kind::none) {
        if (shape != Shape::flat) return byShape<Rgba8Source>(view.type);
        constexpr SampleFn kAny = runSample<Rgba8Source, Shape::flat>;
        return rgba8 == Rgba8Kind::unorm ? selectWords<kAny, Unorm8Words>(view, sampler)
                                         : selectWords<kAny, Srgb8Words>(view, sampler);
    }
    const TexelLayout& layout = view.ops.layout;
    if (shape == Shape::flat && isFourHalves(view))
        return selectHalves<runSample<AnySource<4>, Shape::flat>>(view, sampler);
    if (shape != Shape::flat || layout.rgba[1].bits != 0) return byShape<AnySource<4>>(view.type);
    if (!isOneWord(view)) return runSample<AnySource<1>, Shape::flat>;
    constexpr SampleFn kAny = runSample<R32Source, Shape::flat>;
    const bool isDepth = layout.rgba[0].kind == ComponentKind::sfloat && sampler.compareEnable;
    return isDepth ? selectWords<kAny, DepthWords>(view, sampler) : kAny;
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
