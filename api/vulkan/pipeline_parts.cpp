// The parts of graphics pipelines: which state is whose, and pipelines put together of them.
#include <algorithm>
#include <string>

#include "api/vulkan/pipeline_state.h"

namespace vernier::vulkan {
namespace {

void takeVertexInput(PipelineState& to, const PipelineState& from) {
    to.state.vertexBindings = from.state.vertexBindings;
    to.state.instanceDivisors = from.state.instanceDivisors;
    to.state.vertexAttributes = from.state.vertexAttributes;
}

void takePreRasterization(PipelineState& to, const PipelineState& from) {
    to.viewportCountDynamic = from.viewportCountDynamic;
    to.clipsUnlessClamped = from.clipsUnlessClamped;
    to.fixed.viewports = from.fixed.viewports;
    to.fixed.scissors = from.fixed.scissors;
    to.fixed.viewportCount = from.fixed.viewportCount;
    to.fixed.lineWidth = from.fixed.lineWidth;
    to.fixed.lineStippleFactor = from.fixed.lineStippleFactor;
    to.fixed.lineStipplePattern = from.fixed.lineStipplePattern;
    to.fixed.depthBiasConstant = from.fixed.depthBiasConstant;
    to.fixed.depthBiasClamp = from.fixed.depthBiasClamp;
    to.fixed.depthBiasSlope = from.fixed.depthBiasSlope;
}

void takeFragmentShader(PipelineState& to, const PipelineState& from) {
    to.state.stencilFront = from.state.stencilFront;
    to.state.stencilBack = from.state.stencilBack;
    to.state.readsDepthStencil.asInputs = from.state.readsDepthStencil.asInputs;
    to.fixed.stencilFront = from.fixed.stencilFront;
    to.fixed.stencilBack = from.fixed.stencilBack;
    to.fixed.minDepthBounds = from.fixed.minDepthBounds;
    to.fixed.maxDepthBounds = from.fixed.maxDepthBounds;
}

void takeFragmentOutput(PipelineState& to, const PipelineState& from) {
    to.state.sampleShading = from.state.sampleShading;
    to.state.minSampleShading = from.state.minSampleShading;
    to.state.blend = from.state.blend;
    to.state.readsColors.asInputs = from.state.readsColors.asInputs;
    to.fixed.blendConstants = from.fixed.blendConstants;
    to.fixed.colorWrites = from.fixed.colorWrites;
    to.fixed.sampleLocations = from.fixed.sampleLocations;
}

/// The values of these parts alone.
void takeValues(PipelineState& to, const PipelineState& from, PipelineParts parts) {
#define VERNIER_PLAN_STATE(name, member, part) \
    if ((parts & VK_GRAPHICS_PIPELINE_LIBRARY_##part##_BIT_EXT) != 0) to.state.member = from.state.member;
#include "api/vulkan/plan_states.def"
#undef VERNIER_PLAN_STATE
    if ((parts & kVertexInput) != 0) takeVertexInput(to, from);
    if ((parts & kPreRasterization) != 0) takePreRasterization(to, from);
    if ((parts & kFragmentShader) != 0) takeFragmentShader(to, from);
    if ((parts & kFragmentOutput) != 0) takeFragmentOutput(to, from);
}

}  // namespace

PipelineParts partOf(VkDynamicState state) {
    switch (state) {
#define VERNIER_PLAN_STATE(name, member, part) \
    case VK_DYNAMIC_STATE_##name:              \
        return VK_GRAPHICS_PIPELINE_LIBRARY_##part##_BIT_EXT;
#include "api/vulkan/plan_states.def"
#undef VERNIER_PLAN_STATE
        case VK_DYNAMIC_STATE_VERTEX_INPUT_EXT:
        case VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE:
            return kVertexInput;
        case VK_DYNAMIC_STATE_VIEWPORT:
        case VK_DYNAMIC_STATE_SCISSOR:
        case VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT:
        case VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT:
        case VK_DYNAMIC_STATE_LINE_WIDTH:
        case VK_DYNAMIC_STATE_LINE_STIPPLE_EXT:
        case VK_DYNAMIC_STATE_DEPTH_BIAS:
            return kPreRasterization;
        case VK_DYNAMIC_STATE_DEPTH_BOUNDS:
        case VK_DYNAMIC_STATE_STENCIL_COMPARE_MASK:
        case VK_DYNAMIC_STATE_STENCIL_WRITE_MASK:
        case VK_DYNAMIC_STATE_STENCIL_REFERENCE:
        case VK_DYNAMIC_STATE_STENCIL_OP:
            return kFragmentShader;
        case VK_DYNAMIC_STATE_BLEND_CONSTANTS:
        case VK_DYNAMIC_STATE_SAMPLE_LOCATIONS_EXT:
        case VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT:
        case VK_DYNAMIC_STATE_COLOR_BLEND_ENABLE_EXT:
        case VK_DYNAMIC_STATE_COLOR_BLEND_EQUATION_EXT:
        case VK_DYNAMIC_STATE_COLOR_WRITE_MASK_EXT:
            return kFragmentOutput;
        default:
            return 0;
    }
}

void takeParts(PipelineState& to, const PipelineState& from) {
    takeValues(to, from, from.parts);
    to.parts |= from.parts;
    // What the device and the flags of the pipeline say, whatever the part.
    to.state.depthUnrestricted |= from.state.depthUnrestricted;
    to.state.readsColors.asTextures |= from.state.readsColors.asTextures;
    to.state.readsDepthStencil.asTextures |= from.state.readsDepthStencil.asTextures;
    to.dynamicMask |= from.dynamicMask;
    to.planStates |= from.planStates;
    // In dynamic rendering the part of the outputs alone knows the attachments; all that have a render pass agree.
    if (!from.hasFormats || (to.hasFormats && (from.parts & kFragmentOutput) == 0)) return;
    to.dynamicRendering = from.dynamicRendering;
    to.hasFormats = true;
    to.formats = from.formats;
}

Status complete(PipelineState& pipeline) {
    GraphicsState& state = pipeline.state;
    const bool discards = state.rasterizerDiscard;
    const PipelineParts needed = discards ? kVertexInput | kPreRasterization : kAllParts;
    if ((pipeline.parts & needed) != needed)
        return invalidArgument("parts " + std::to_string(needed & ~pipeline.parts) +
                               " (VkGraphicsPipelineLibraryFlagsEXT) of the pipeline are missing");
    const SubpassFormats& formats = pipeline.formats;
    if (discards) takeValues(pipeline, {}, kRasterizedParts);
    state.colorCount = formats.colorCount;
    std::copy_n(formats.colors, state.colorCount, state.colorFormats.begin());
    state.depthStencilFormat = formats.depthStencil();
    if (discards) {
        if (formats.samples != 0) state.samples = formats.samples;
        return {};
    }
    if (formats.samples != 0 && formats.samples != state.samples) {
        return invalidArgument("rasterizationSamples is " + std::to_string(state.samples) + "; the attachments have " +
                               std::to_string(formats.samples));
    }
    // "If there is no depth attachment, then the depth test is skipped"; the image may have the aspect all the same.
    if (formats.depth == VK_FORMAT_UNDEFINED) state.depthTest = state.depthWrite = state.depthBoundsTest = false;
    if (formats.stencil == VK_FORMAT_UNDEFINED) state.stencilTest = false;
    return {};
}

}  // namespace vernier::vulkan
