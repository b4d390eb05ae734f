// What the speed scenes share: the size of their targets, and a quad over all of it.
#pragma once

#include "base/result.h"
#include "conformance/scenes/recorder.h"

namespace vernier::bench {

inline constexpr VkExtent2D kSpeedExtent{1024, 768};
inline constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

/// A strip of two triangles over the whole target; `uv` (location 0) runs from 0 to 1.
extern const char* const kQuadVertex;
/// `uv` as a colour.
extern const char* const kGradientFragment;

/// Colour over what is there by its alpha; alphas add up likewise.
VkPipelineColorBlendAttachmentState alphaBlending();

/// A scene of one quad over the target, drawn `times` times.
Result<conformance::Scene> fullScreen(const char* name, const char* description, const char* fragment, uint32_t times,
                                      bool blend = false, VkExtent2D extent = kSpeedExtent);

}  // namespace vernier::bench
