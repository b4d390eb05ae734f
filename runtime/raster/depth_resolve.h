// Resolves of multisampled depth and stencil (specification, VkSubpassDescriptionDepthStencilResolve).
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

#include "runtime/geometry/prepared_draw.h"
#include "runtime/raster/pass_targets.h"

namespace vernier {

/// What both aspects can do; stencil has no average.
inline constexpr VkResolveModeFlags kStencilResolveModes =
    VK_RESOLVE_MODE_SAMPLE_ZERO_BIT | VK_RESOLVE_MODE_MIN_BIT | VK_RESOLVE_MODE_MAX_BIT;
inline constexpr VkResolveModeFlags kDepthResolveModes = kStencilResolveModes | VK_RESOLVE_MODE_AVERAGE_BIT;

/// Whether the aspects that both formats have are stored in the same way.
bool canResolveDepthStencil(VkFormat source, VkFormat destination);

/// One texel of the samples of each pixel of `rect` in a layer, each aspect by its own mode; VK_RESOLVE_MODE_NONE
/// leaves the destination's as it is. Nothing is done for formats that canResolveDepthStencil() refuses.
void resolveDepthStencil(const RenderTarget& source, const RenderTarget& destination, VkResolveModeFlagBits depthMode,
                         VkResolveModeFlagBits stencilMode, const PixelRect& rect, uint32_t layer);

}  // namespace vernier
