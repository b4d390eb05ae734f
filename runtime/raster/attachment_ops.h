// Clears and resolves of parts of attachments.
#pragma once

#include "base/simd.h"
#include "runtime/geometry/prepared_draw.h"
#include "runtime/raster/pass_targets.h"

namespace vernier {

/// Sets the given aspects of all samples of the pixels in `rect` of a layer.
void clearPixels(const RenderTarget& target, VkImageAspectFlags aspects, const VkClearValue& value,
                 const PixelRect& rect, uint32_t layer);

/// Average of the samples; sample 0 for integer formats. sRGB is averaged linearly.
void resolvePixels(const RenderTarget& source, const RenderTarget& destination, const PixelRect& rect, uint32_t layer,
                   Isa isa);

}  // namespace vernier
