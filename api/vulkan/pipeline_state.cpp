// From VkGraphicsPipelineCreateInfo to the runtime's state. Parts that the specification says are ignored
// (without rasterisation, without attachments) are not looked at: their pointers may be anything.
#include <algorithm>
#include <string>

#include "api/vulkan/chain.h"
#include "api/vulkan/pipeline.h"
#include "api/vulkan/render_pass.h"
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

Status readDynamicStates(const VkPipelineDynamicStateCreateInfo* info, PipelineState& result) {
    for (uint32_t i = 0; info != nullptr && i < info->dynamicStateCount; ++i) {
        const VkDynamicState state = info->pDynamicStates[i];
        if (dynamicStateBit(state) == 0) {
            return unsupported("dynamic state " + std::to_string(state) + " is not supported");
        }
        result.dynamicMask |= dynamicStateBit(state);
    }
    return {};
}

Status readVertexInput(const VkGraphicsPipelineCreateInfo& info, GraphicsState& state) {
    const VkPipelineVertexInputStateCreateInfo* input = info.pVertexInputState;
    const VkPipelineInputAssemblyStateCreateInfo* assembly = info.pInputAssemblyState;
    if (input == nullptr || assembly == nullptr) {
        return invalidArgument("pVertexInputState and pInputAssemblyState must be given");
    }
    for (uint32_t i = 0; i < input->vertexBindingDescriptionCount; ++i) {
        const VkVertexInputBindingDescription& binding = input->pVertexBindingDescriptions[i];
        if (binding.binding >= kMaxVertexBindings)
            return aboveLimit("vertex binding", binding.binding, kMaxVertexBindings - 1);
        if (binding.stride > kMaxVertexBindingStride) {
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
    state.topology = assembly->topology;
    state.primitiveRestart = assembly->primitiveRestartEnable != VK_FALSE;
    return {};
}

void readRasterization(const VkPipelineRasterizationStateCreateInfo& info, PipelineState& result) {
    GraphicsState& state = result.state;
    state.depthClampEnable = info.depthClampEnable != VK_FALSE;
    state.depthClipEnable = !state.depthClampEnable;
    if (const auto* clip = findInChain<VkPipelineRasterizationDepthClipStateCreateInfoEXT>(info.pNext)) {
        state.depthClipEnable = clip->depthClipEnable != VK_FALSE;
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
    if (info == nullptr) return invalidArgument("pViewportState must be given");
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
    if (info == nullptr) return invalidArgument("pMultisampleState must be given");
    GraphicsState& state = result.state;
    state.samples = static_cast<uint32_t>(info->rasterizationSamples);
    if (const auto* locations = findInChain<VkPipelineSampleLocationsStateCreateInfoEXT>(info->pNext)) {
        state.sampleLocations = locations->sampleLocationsEnable != VK_FALSE;
        if (state.sampleLocations) result.fixed.sampleLocations = sampleLocationsOf(locations->sampleLocationsInfo);
    }
    state.sampleMask = info->pSampleMask != nullptr ? info->pSampleMask[0] : ~0u;
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
    if (info == nullptr) return invalidArgument("pDepthStencilState must be given: the subpass has such an attachment");
    GraphicsState& state = result.state;
    state.depthTest = info->depthTestEnable != VK_FALSE;
    state.depthWrite = info->depthWriteEnable != VK_FALSE;
    state.depthCompare = info->depthCompareOp;
    // Depths lie in 0..1: without VK_EXT_depth_range_unrestricted nothing else may get into an attachment.
    const bool cutsDepths =
        isDynamic(result, VK_DYNAMIC_STATE_DEPTH_BOUNDS) || info->minDepthBounds > 0 || info->maxDepthBounds < 1;
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

Status readBlend(const VkPipelineColorBlendStateCreateInfo* info, const SubpassFormats& formats,
                 PipelineState& result) {
    if (info == nullptr) return invalidArgument("pColorBlendState must be given: the subpass has colour attachments");
    if (info->attachmentCount != formats.colorCount) {
        return invalidArgument("pColorBlendState->attachmentCount is " + std::to_string(info->attachmentCount) +
                               "; the subpass has " + std::to_string(formats.colorCount));
    }
    result.state.logicOpEnable = info->logicOpEnable != VK_FALSE;
    result.state.logicOp = info->logicOp;
    std::copy_n(info->pAttachments, info->attachmentCount, result.state.blend.begin());
    const auto* writes = findInChain<VkPipelineColorWriteCreateInfoEXT>(info->pNext);
    if (writes != nullptr && !isDynamic(result, VK_DYNAMIC_STATE_COLOR_WRITE_ENABLE_EXT)) {
        const uint32_t count = std::min(writes->attachmentCount, info->attachmentCount);
        for (uint32_t i = 0; i < count; ++i) {
            if (writes->pColorWriteEnables[i] == VK_FALSE) result.state.blend[i].colorWriteMask = 0;
        }
    }
    std::copy_n(info->blendConstants, result.fixed.blendConstants.size(), result.fixed.blendConstants.begin());
    return {};
}

void setFormats(const SubpassFormats& formats, GraphicsState& state) {
    state.colorCount = formats.colorCount;
    std::copy_n(formats.colors, formats.colorCount, state.colorFormats.begin());
    state.depthStencilFormat = formats.depthStencil;
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

Result<PipelineState> pipelineState(const VkGraphicsPipelineCreateInfo& info) {
    PipelineState result;
    if (info.renderPass == VK_NULL_HANDLE || info.subpass >= object(info.renderPass)->subpasses.size()) {
        return invalidArgument("renderPass and subpass must name a subpass");
    }
    if (info.pRasterizationState == nullptr) return invalidArgument("pRasterizationState must be given");
    const SubpassFormats formats = object(info.renderPass)->formats(info.subpass);
    setFormats(formats, result.state);
    if (Status s = readDynamicStates(info.pDynamicState, result); !s) return s.error();
    if (Status s = readVertexInput(info, result.state); !s) return s.error();
    readRasterization(*info.pRasterizationState, result);
    if (result.state.rasterizerDiscard) {
        if (formats.samples != 0) result.state.samples = formats.samples;
        return result;
    }
    if (Status s = readViewports(info.pViewportState, result); !s) return s.error();
    if (Status s = readMultisample(info.pMultisampleState, result); !s) return s.error();
    if (formats.samples != 0 && formats.samples != result.state.samples) {
        return invalidArgument("rasterizationSamples is " + std::to_string(result.state.samples) +
                               "; the attachments have " + std::to_string(formats.samples));
    }
    if (formats.depthStencil != VK_FORMAT_UNDEFINED) {
        if (Status s = readDepthStencil(info.pDepthStencilState, result); !s) return s.error();
    }
    const bool anyColor = std::any_of(formats.colors, formats.colors + formats.colorCount,
                                      [](VkFormat format) { return format != VK_FORMAT_UNDEFINED; });
    if (anyColor) {
        if (Status s = readBlend(info.pColorBlendState, formats, result); !s) return s.error();
    }
    return result;
}

}  // namespace vernier::vulkan
