// VK_EXT_multisampled_render_to_single_sampled: passes with more samples than their attachments.
#pragma once

#include <span>

#include "api/vulkan/command_buffer.h"

namespace vernier::vulkan {

/// What the chain of a subpass or a rendering says: the samples that attachments with one are drawn to with; 0: theirs.
uint32_t samplesForSingle(const void* chain);

/// The samples that an attachment with `samples` is drawn to with.
inline uint32_t drawnSamples(uint32_t samples, uint32_t forSingle) {
    return samples == 1 && forSingle != 0 ? forSingle : samples;
}

/// Where attachments of the rendering have one sample and it has more, memory of that many takes their place: commands
/// that fill it with what is to be loaded are recorded, and what is to be stored is resolved to the attachment at the
/// end. `flags`: whether the rendering resumes or is suspended; in between the samples stay in their memory. `inputs`:
/// the views of input attachments that are seen with the samples of the rendering. Throws when memory runs out.
Status drawToSamples(CommandBuffer& buffer, command::BeginRendering& rendering, VkRenderingFlags flags,
                     std::span<const ImageView* const> inputs);

}  // namespace vernier::vulkan
