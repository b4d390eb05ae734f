// The resolve of multisampled texels.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/format/format.h"

namespace vernier {

/// Makes one texel of each of `n` neighbouring ones with `samples` samples (a power of two), whose samples lie
/// `samplePitch` bytes apart: the average for values that are floating point in shaders (sRGB is averaged linearly),
/// sample 0 for integers (vkCmdResolveImage in the Vulkan specification). `result` must not overlap the source.
void resolveTexels(const FormatOps& ops, const std::byte* texels, uint64_t samplePitch, uint32_t samples, size_t n,
                   std::byte* result);

}  // namespace vernier
