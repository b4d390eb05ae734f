// Pipeline libraries (VK_KHR_pipeline_library, VK_EXT_graphics_pipeline_library): parts of graphics pipelines, read and
// compiled as far as they go. Pipelines and libraries that are made of them take copies and share the shaders: none
// outlives its use.
#pragma once

#include <vulkan/vulkan_core.h>

#include "api/vulkan/pipeline_stages.h"
#include "api/vulkan/pipeline_state.h"

namespace vernier::vulkan {

struct PipelineLibrary {
    PipelineState state;
    PipelineShaders shaders;
};

/// Whether a description has a part with shaders itself, not in libraries.
bool bringsShaders(const VkGraphicsPipelineCreateInfo& info);
/// All parts of a description: those of the libraries that it names, and its own.
Result<PipelineLibrary> gatherParts(const Device& device, const VkGraphicsPipelineCreateInfo& info);

}  // namespace vernier::vulkan
