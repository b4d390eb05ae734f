// The state of VkGraphicsPipelineCreateInfo in the runtime's terms: of a whole pipeline, or of the parts of one that a
// library holds (VK_EXT_graphics_pipeline_library).
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>

#include "api/vulkan/plan_cache.h"
#include "api/vulkan/render_pass.h"
#include "base/result.h"
#include "runtime/plan/graphics_state.h"

namespace vernier::vulkan {

struct Device;

/// A set of the parts of a graphics pipeline.
using PipelineParts = VkGraphicsPipelineLibraryFlagsEXT;
inline constexpr PipelineParts kVertexInput = VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT,
                               kPreRasterization = VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT,
                               kFragmentShader = VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT,
                               kFragmentOutput = VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT;
inline constexpr PipelineParts kRasterizedParts = kFragmentShader | kFragmentOutput;
inline constexpr PipelineParts kAllParts = kVertexInput | kPreRasterization | kRasterizedParts;

/// The part that a dynamic state belongs to; 0 for states that are not supported.
PipelineParts partOf(VkDynamicState state);

struct PipelineState {
    PipelineParts parts = 0;  // that are here; the members of the others are as they stand here
    GraphicsState state;
    DynamicState fixed;
    uint32_t dynamicMask = 0;   // of dynamicStateBit()
    PlanStates planStates = 0;  // that are dynamic
    bool viewportCountDynamic = false;
    bool clipsUnlessClamped = true;  // see PlanCache::Desc
    bool dynamicRendering = true;
    bool hasFormats = false;  // a part says for which attachments it is: `formats`
    SubpassFormats formats;

    bool isDynamic(PlanState one) const { return (planStates & planStateBit(one)) != 0; }
};

/// The sample locations of a pixel in the runtime's terms; outside sampleLocationCoordinateRange they are clamped.
std::array<SamplePosition, kMaxSamples> sampleLocationsOf(const VkSampleLocationsInfoEXT& info);

/// These parts of a description. Nothing behind the rasteriser is looked at where it is known that nothing gets there:
/// because the part before says so, or, of parts that have been read elsewhere, `discards`.
Result<PipelineState> readParts(const Device& device, const VkGraphicsPipelineCreateInfo& info, PipelineParts parts,
                                bool discards);
/// Adds the parts of `from`.
void takeParts(PipelineState& to, const PipelineState& from);
/// Checks that nothing is missing of a pipeline, and what the parts say together.
Status complete(PipelineState& pipeline);

}  // namespace vernier::vulkan
