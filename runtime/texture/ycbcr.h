// Sampling views of multi-planar formats with conversion from Y'CbCr ("Sampler Y'CbCr Conversion" in the chapters
// "Samplers" and "Image Operations" of the Vulkan specification).
//
// Choices where the specification leaves one:
//   reconstruction   always explicit: chroma at every texel of luma first, then the filter of the sampler
//   arithmetic       in doubles from the codes on, rounded once at the end; the range expansion does not clamp
#pragma once

#include "base/result.h"
#include "runtime/texture/texture.h"

namespace vernier {

/// Whether the pair of view and sampler converts: samples of it are sampleYcbcr()'s.
inline bool convertsYcbcr(const TextureView& view, const SamplerState& sampler) {
    return view.planar != nullptr && sampler.ycbcr.format != VK_FORMAT_UNDEFINED;
}

/// What of the pair cannot be sampled, in words.
Status checkYcbcr(const TextureView& view, const SamplerState& sampler);

/// A SampleFn for pairs that convert and have passed the check.
void sampleYcbcr(const TextureView& view, const SamplerState& sampler, const SampleRequest& request);

}  // namespace vernier
