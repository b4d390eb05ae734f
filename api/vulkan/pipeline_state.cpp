// From VkGraphicsPipelineCreateInfo to the runtime's state. Parts that the specification says are ignored
// (without rasterisation, without attachments) are not looked at: their pointers may be anything.
#include "api/vulkan/pipeline_state.h"

#include <algorithm>
#include <string>

#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/limits.h"

namespace vernier::vulkan {
namespace {

Error aboveLimit(const char* field, uint32_t value, uint32_t limit) {
    return invalidArgument(std::string(field) + " is " + std::to_string(value) + "; the limit is " +
                           std::to_string(limit));
}

bool isDynamic(const PipelineState& result, VkDynamicState state) {
    return (result.dynamicMask & dynamicStateBit(state)) != 0;
}

/// Whether all of some states are dynamic: what they are read from may then be missing.
bool areDynamic(const PipelineState& result, std::initializer_list<PlanState> states) {
    return std::ranges::all_of(states, [&](PlanState state) { return result.isDynamic(state); });
}

/// Those of other parts are ignored.
Status readDynamicStates(const VkPipelineDynamicStateCreateInfo* info, PipelineState& result) {
    for (uint32_t i = 0; info != nullptr && i < info->dynamicStateCount; ++i) {
        VkDynamicState state = info->pDynamicStates[i];
        const PipelineParts part = partOf(state);
        if (part == 0) return unsupported("dynamic state " + std::to_string(state) + " is not supported");
        if ((part & result.parts) == 0) continue;
        if (state == VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT) {
            state = VK_DYNAMIC_STATE_VIEWPORT;
            result.viewportCountDynamic = true;
        }
        if (state == VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT) state = VK_DYNAMIC_STATE_SCISSOR;
        result.dynamicMask |= dynamicStateBit(state);
        result.planStates |= planStateBit(state);
    }
    return {};
}

Status readVertexInput(const VkPipelineVertexInputStateCreateInfo* input, PipelineState& result) {
    GraphicsState& state = result.state;
    if (result.isDynamic(PlanState::VERTEX_INPUT_EXT)) return {};
    if (input == nullptr) return invalidArgument("pVertexInputState must be given");
    for (uint32_t i = 0; i < input->vertexBindingDescriptionCount; ++i) {
        const VkVertexInputBindingDescription& binding = input->pVertexBindingDescriptions[i];
        if (binding.binding >= kMaxVertexBindings)
            return aboveLimit("vertex binding", binding.binding, kMaxVertexBindings - 1);
        if (binding.stride > kMaxVertexBindingStride && !result.isDynamic(PlanState::VERTEX_INPUT_BINDING_STRIDE)) {
            return aboveLimit("vertex binding stride", binding.stride, kMaxVertexBindingStride);
        }
        state.vertexBindings.push_back(binding);
    }
    if (const auto* divisors = findInChain<VkPipelineVertexInputDivisorStateCreateInfoEXT>(input->pNext)) {
        for (uint32_t i = 0; i < divisors->vertexBindingDivisorCount; ++i) {
            const VkVertexInputBindingDivisorDescriptionEXT& divisor = divisors->pVertexBindingDivisors[i];
            if (divisor.binding >= kMaxVertexBindings)
                return aboveLimit("vertex binding with a divisor", divisor.binding, kMaxVertexBindings - 1);
            state.instanceDivisors[divisor.binding] = divisor.divisor;
        }
    }
    for (uint32_t i = 0; i < input->vertexAttributeDescriptionCount; ++i) {
        const VkVertexInputAttributeDescription& attribute = input->pVertexAttributeDescriptions[i];
        if (attribute.location >= kMaxVertexAttributes) {
            return aboveLimit("vertex attribute location", attribute.location, kMaxVertexAttributes - 1);
        }
        if (attribute.offset > kMaxVertexAttributeOffset) {
            return aboveLimit("vertex attribute offset", attribute.offset, kMaxVertexAttributeOffset);
        }
        state.vertexAttributes.push_back(attribute);
    }
    return {};
}

Status readAssembly(const VkPipelineInputAssemblyStateCreateInfo* assembly, PipelineState& result) {
    if (assembly == nullptr) {
        if (areDynamic(result, {PlanState::PRIMITIVE_TOPOLOGY, PlanState::PRIMITIVE_RESTART_ENABLE})) return {};
        return invalidArgument("pInputAssemblyState must be given");
    }
    result.state.topology = assembly->topology;
    result.state.primitiveRestart = assembly->primitiveRestartEnable != VK_FALSE;
    return {};
}

/// Without tessellation stages it is ignored.
Status readTessellation(const VkGraphicsPipelineCreateInfo& info, PipelineState& result) {
    constexpr VkShaderStageFlags kStages =
        VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT | VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
    const bool tessellates =
        std::any_of(info.pStages, info.pStages + info.stageCount,
                    [](const VkPipelineShaderStageCreateInfo& stage) { return (stage.stage & kStages) != 0; });
    if (!tessellates) return {};
    if (info.pTessellationState == nullptr) {
        if (areDynamic(result, {PlanState::PATCH_CONTROL_POINTS_EXT, PlanState::TESSELLATION_DOMAIN_ORIGIN_EXT}))
            return {};
        return invalidArgument("pTessellationState must be given");
    }
    result.state.patchControlPoints = info.pTessellationState->patchControlPoints;
    const auto* origin = findInChain<VkPipelineTessellationDomainOriginStateCreateInfo>(info.pTessellationState->pNext);
    result.state.domainLowerLeft =
        origin != nullptr && origin->domainOrigin == VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
    return {};
}

void readRasterization(const VkPipelineRasterizationStateCreateInfo& info, PipelineState& result) {
    GraphicsState& state = result.state;
    state.depthClampEnable = info.depthClampEnable != VK_FALSE;
    state.depthClipEnable = !state.depthClampEnable;
    if (const auto* clip = findInChain<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(info.pNext)) {
        state.depthClipEnable = clip->depthClipEnable != VK_FALSE;
        result.clipsUnlessClamped = false;
    }
    state.rasterizerDiscard = info.rasterizerDiscardEnable != VK_FALSE;
    state.polygonMode = info.polygonMode;
    state.cullMode = info.cullMode;
    state.frontFace = info.frontFace;
    state.depthBiasEnable = info.depthBiasEnable != VK_FALSE;
    if (const auto* vertex = findInChain<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(info.pNext)) {
        state.provokingVertexLast = vertex->provokingVertexMode == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
    }
    result.fixed.lineWidth = info.lineWidth;
    if (const auto* line = findInChain<VkPipelineRasterizationLineStateCreateInfoEXT>(info.pNext)) {
        state.lineMode = line->lineRasterizationMode;
        state.stippledLine = line->stippledLineEnable != VK_FALSE;
        result.fixed.lineStippleFactor = line->lineStippleFactor;
        result.fixed.lineStipplePattern = line->lineStipplePattern;
    }
    result.fixed.depthBiasConstant = info.depthBiasConstantFactor;
    result.fixed.depthBiasClamp = info.depthBiasClamp;
    result.fixed.depthBiasSlope = info.depthBiasSlopeFactor;
}

Status readViewports(const VkPipelineViewportStateCreateInfo* info, PipelineState& result) {
    if (info == nullptr) {
        if (result.viewportCountDynamic && isDynamic(result, VK_DYNAMIC_STATE_SCISSOR)) return {};
        return invalidArgument("pViewportState must be given");
    }
    if (info->viewportCount > kMaxViewports) return aboveLimit("viewportCount", info->viewportCount, kMaxViewports);
    if (info->scissorCount > kMaxViewports) return aboveLimit("scissorCount", info->scissorCount, kMaxViewports);
    result.fixed.viewportCount = std::max(1u, info->viewportCount);
    if (const auto* control = findInChain<VkPipelineViewportDepthClipControlCreateInfoEXT>(info->pNext)) {
        result.state.negativeOneToOne = control->negativeOneToOne != VK_FALSE;
    }
    if (!isDynamic(result, VK_DYNAMIC_STATE_VIEWPORT) && info->pViewports != nullptr) {
        std::copy_n(info->pViewports, info->viewportCount, result.fixed.viewports.begin());
    }
    if (!isDynamic(result, VK_DYNAMIC_STATE_SCISSOR) && info->pScissors != nullptr) {
        std::copy_n(info->pScissors, info->scissorCount, result.fixed.scissors.begin());
    }
    return {};
}

Status readMultisample(const VkPipelineMultisampleStateCreateInfo* info, PipelineState& result) {
    GraphicsState& state = result.state;
    const bool samplesFollow = result.isDynamic(PlanState::RASTERIZATION_SAMPLES_EXT);
    if (samplesFollow) state.samples = std::max(1u, result.formats.samples);
    if (info == nullptr) {
        if (samplesFollow && areDynamic(result, {PlanState::SAMPLE_MASK_EXT, PlanState::ALPHA_TO_COVERAGE_ENABLE_EXT}))
            return {};
        return invalidArgument("pMultisampleState must be given");
    }
    if (!samplesFollow) state.samples = static_cast<uint32_t>(info->rasterizationSamples);
    if (const auto* locations = findInChain<VkPipelineSampleLocationsStateCreateInfoEXT>(info->pNext)) {
        state.sampleLocations = locations->sampleLocationsEnable != VK_FALSE;
        if (state.sampleLocations) result.fixed.sampleLocations = sampleLocationsOf(locations->sampleLocationsInfo);
    }
    const bool hasMask = info->pSampleMask != nullptr && !result.isDynamic(PlanState::SAMPLE_MASK_EXT);
    state.sampleMask = hasMask ? info->pSampleMask[0] : ~0u;
    state.sampleShading = info->sampleShadingEnable != VK_FALSE;
    state.minSampleShading = info->minSampleShading;
    state.alphaToCoverage = info->alphaToCoverageEnable != VK_FALSE;
    state.alphaToOne = info->alphaToOneEnable != VK_FALSE;
    return {};
}

DynamicState::StencilFace stencilFace(const VkStencilOpState& from) {
    return {from.compareMask, from.writeMask, from.reference};
}

Status readDepthStencil(const VkPipelineDepthStencilStateCreateInfo* info, PipelineState& result) {
    if (info == nullptr) {
        if (areDynamic(result,
                       {PlanState::DEPTH_TEST_ENABLE, PlanState::DEPTH_WRITE_ENABLE, PlanState::DEPTH_COMPARE_OP,
                        PlanState::DEPTH_BOUNDS_TEST_ENABLE, PlanState::STENCIL_TEST_ENABLE, PlanState::STENCIL_OP}))
            return {};
        return invalidArgument("pDepthStencilState must be given: there is such an attachment");
    }
    constexpr VkPipelineDepthStencilStateCreateFlags kOrderedAccess =
        VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT |
        VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
    GraphicsState& state = result.state;
    state.readsDepthStencil.asInputs = (info->flags & kOrderedAccess) != 0;
    state.depthTest = info->depthTestEnable != VK_FALSE;
    state.depthWrite = info->depthWriteEnable != VK_FALSE;
    state.depthCompare = info->depthCompareOp;
    // Without VK_EXT_depth_range_unrestricted nothing but 0..1 may get into an attachment.
    const bool cutsDepths = isDynamic(result, VK_DYNAMIC_STATE_DEPTH_BOUNDS) || state.depthUnrestricted ||
                            info->minDepthBounds > 0 || info->maxDepthBounds < 1;
    state.depthBoundsTest = info->depthBoundsTestEnable != VK_FALSE && cutsDepths;
    state.stencilTest = info->stencilTestEnable != VK_FALSE;
    state.stencilFront = info->front;
    state.stencilBack = info->back;
    result.fixed.stencilFront = stencilFace(info->front);
    result.fixed.stencilBack = stencilFace(info->back);
    result.fixed.minDepthBounds = info->minDepthBounds;
    result.fixed.maxDepthBounds = info->maxDepthBounds;
    return {};
}

Status readBlend(const VkPipelineColorBlendStateCreateInfo* info, PipelineState& result) {
    const bool allDynamic = areDynamic(result, {PlanState::COLOR_BLEND_ENABLE_EXT, PlanState::COLOR_BLEND_EQUATION_EXT,
                                                PlanState::COLOR_WRITE_MASK_EXT});
    if (info == nullptr) {
        if (allDynamic && areDynamic(result, {PlanState::LOGIC_OP_ENABLE_EXT, PlanState::LOGIC_OP_EXT})) return {};
        return invalidArgument("pColorBlendState must be given: there are colour attachments");
    }
    result.state.readsColors.asInputs =
        (info->flags & VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT) != 0;
    result.state.logicOpEnable = info->logicOpEnable != VK_FALSE;
    result.state.logicOp = info->logicOp;
    if (!allDynamic) {
        if (info->attachmentCount != result.formats.colorCount) {
            return invalidArgument("pColorBlendState->attachmentCount is " + std::to_string(info->attachmentCount) +
                                   "; there are " + std::to_string(result.formats.colorCount) + " colour attachments");
        }
        std::copy_n(info->pAttachments, info->attachmentCount, result.state.blend.begin());
    }
    const auto* writes = findInChain<VkPipelineColorWriteCreateInfoEXT>(info->pNext);
    if (writes != nullptr && !isDynamic(result, VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT)) {
        const uint32_t count = std::min({writes->attachmentCount, info->attachmentCount, kMaxColorAttachments});
        for (uint32_t i = 0; i < count; ++i) {
            if (writes->pColorWriteEnables[i] != VK_FALSE) continue;
            result.state.blend[i].colorWriteMask = 0;
            result.fixed.colorWrites &= ~(1u << i);
        }
    }
    std::copy_n(info->blendConstants, result.fixed.blendConstants.size(), result.fixed.blendConstants.begin());
    return {};
}

Status readRendering(const VkPipelineRenderingCreateInfo& info, SubpassFormats& formats) {
    if (info.colorAttachmentCount > kMaxColorAttachments) {
        return aboveLimit("colorAttachmentCount", info.colorAttachmentCount, kMaxColorAttachments);
    }
    formats.colorCount = info.colorAttachmentCount;
    if (info.pColorAttachmentFormats != nullptr)
        std::copy_n(info.pColorAttachmentFormats, info.colorAttachmentCount, formats.colors);
    formats.depth = info.depthAttachmentFormat;
    formats.stencil = info.stencilAttachmentFormat;
    formats.viewMask = info.viewMask;
    const bool both = formats.depth != VK_FORMAT_UNDEFINED && formats.stencil != VK_FORMAT_UNDEFINED;
    if (both && formats.depth != formats.stencil) {
        return invalidArgument(
            "depthAttachmentFormat and stencilAttachmentFormat must be the same or VK_FORMAT_UNDEFINED");
    }
    return {};
}

/// The attachments that the parts are made for: of a subpass, or of dynamic rendering.
Status readFormats(const VkGraphicsPipelineCreateInfo& info, PipelineState& result) {
    if ((result.parts & ~kVertexInput) == 0) return {};
    if (info.renderPass != VK_NULL_HANDLE) {
        if (info.subpass >= object(info.renderPass)->subpasses.size()) {
            return invalidArgument("subpass must name a subpass of renderPass");
        }
        result.formats = object(info.renderPass)->formats(info.subpass);
        result.dynamicRendering = false;
        result.hasFormats = true;
    } else if ((result.parts & kFragmentOutput) != 0) {
        result.hasFormats = true;
        if (const auto* rendering = findInChain<VkPipelineRenderingCreateInfo>(info.pNext))
            return readRendering(*rendering, result.formats);
    }
    return {};
}

Status readPreRasterization(const VkGraphicsPipelineCreateInfo& info, PipelineState& result) {
    if (info.pRasterizationState == nullptr) return invalidArgument("pRasterizationState must be given");
    if (Status s = readTessellation(info, result); !s) return s;
    readRasterization(*info.pRasterizationState, result);
    if (result.isDynamic(PlanState::RASTERIZER_DISCARD_ENABLE)) result.state.rasterizerDiscard = false;
    return result.state.rasterizerDiscard ? Status() : readViewports(info.pViewportState, result);
}

/// Without the part of the outputs it may be that nobody knows whether there is a depth or stencil attachment: then
/// there is a description for the case.
Status readFragmentShader(const VkGraphicsPipelineCreateInfo& info, PipelineState& result) {
    const bool described =
        result.hasFormats ? result.formats.depthStencil() != VK_FORMAT_UNDEFINED : info.pDepthStencilState != nullptr;
    return described ? readDepthStencil(info.pDepthStencilState, result) : Status();
}

Status readFragmentOutput(const VkGraphicsPipelineCreateInfo& info, PipelineState& result) {
    if (Status s = readMultisample(info.pMultisampleState, result); !s) return s;
    const SubpassFormats& formats = result.formats;
    const bool anyColor = std::any_of(formats.colors, formats.colors + formats.colorCount,
                                      [](VkFormat format) { return format != VK_FORMAT_UNDEFINED; });
    return anyColor ? readBlend(info.pColorBlendState, result) : Status();
}

}  // namespace

std::array<SamplePosition, kMaxSamples> sampleLocationsOf(const VkSampleLocationsInfoEXT& info) {
    std::array<SamplePosition, kMaxSamples> locations{};
    constexpr float kUnits = 1u << kSampleLocationBits;
    const auto snap = [](float place) {
        return static_cast<uint8_t>(place > 0 ? std::min(place * kUnits + 0.5f, kUnits - 1) : 0.0f);  // NaN: 0
    };
    const uint32_t count = std::min(info.sampleLocationsCount, kMaxSamples);
    for (uint32_t s = 0; s < count; ++s) {
        const VkSampleLocationEXT& from = info.pSampleLocations[s];
        locations[s] = {snap(from.x), snap(from.y)};
    }
    return locations;
}

Result<PipelineState> readParts(const Device& device, const VkGraphicsPipelineCreateInfo& info, PipelineParts parts,
                                bool discards) {
    PipelineState result;
    result.parts = parts;
    GraphicsState& state = result.state;
    state.depthUnrestricted = device.extensions.intersects(Extension::EXT_depth_range_unrestricted);
    state.readsColors.asTextures = (info.flags & VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT) != 0;
    state.readsDepthStencil.asTextures =
        (info.flags & VK_PIPELINE_CREATE_DEPTH_STENCIL_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT) != 0;
    const auto has = [parts](PipelineParts part) { return (parts & part) != 0; };
    if (Status s = readFormats(info, result); !s) return s.error();
    if (Status s = readDynamicStates(info.pDynamicState, result); !s) return s.error();
    if (has(kVertexInput)) {
        if (Status s = readVertexInput(info.pVertexInputState, result); !s) return s.error();
        if (Status s = readAssembly(info.pInputAssemblyState, result); !s) return s.error();
    }
    if (has(kPreRasterization)) {
        if (Status s = readPreRasterization(info, result); !s) return s.error();
    }
    if (discards || result.state.rasterizerDiscard) return result;
    if (has(kFragmentShader)) {
        if (Status s = readFragmentShader(info, result); !s) return s.error();
    }
    if (has(kFragmentOutput)) {
        if (Status s = readFragmentOutput(info, result); !s) return s.error();
    }
    return result;
}

}  // namespace vernier::vulkan
