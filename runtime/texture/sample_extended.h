// Sampling routines for what few samplers ask for: anisotropy, cubic filters, reduction modes, cubes with seams.
#pragma once

#include "runtime/texture/texture.h"

namespace vernier {

inline bool isCubic(const SamplerState& sampler) {
    return sampler.magFilter == VK_FILTER_CUBIC_EXT || sampler.minFilter == VK_FILTER_CUBIC_EXT;
}

/// Whether a sampler asks for one of them, and the view lets it matter.
inline bool isExtended(const TextureView& view, const SamplerState& sampler) {
    const bool anisotropic = sampler.maxAnisotropy > 1.0f && view.ops.layout.type == ValueType::floating;
    const bool seams =
        sampler.nonSeamlessCube && (view.type == VK_IMAGE_VIEW_TYPE_CUBE || view.type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY);
    return anisotropic || isCubic(sampler) || seams || sampler.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
}

SampleFn selectExtendedSampler(const TextureView& view, const SamplerState& sampler, Isa isa);

}  // namespace vernier
