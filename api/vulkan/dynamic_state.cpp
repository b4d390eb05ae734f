// Commands of VK_EXT_extended_dynamic_state, 2 and 3 and VK_EXT_vertex_input_dynamic_state: state that plans are made
// for. A pipeline that takes it from commands has its plan looked up at the next draw (plan_cache.h).
#include <algorithm>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {
namespace {

template <class Change>
void setState(VkCommandBuffer handle, Change&& change) {
    recording(handle, [&](CommandBuffer& buffer) { change(buffer.changePlanState().state); });
}

/// Calls set(attachment, values[i]) for the attachments from `first`, as many as there are.
template <class Value, class Set>
void setBlend(VkCommandBuffer handle, uint32_t first, uint32_t count, const Value* values, Set&& set) {
    setState(handle, [&](GraphicsState& state) {
        for (uint32_t i = 0; i < count && first + i < state.blend.size(); ++i) set(state.blend[first + i], values[i]);
    });
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdSetCullMode(VkCommandBuffer commandBuffer, VkCullModeFlags cullMode) {
    setState(commandBuffer, [&](GraphicsState& state) { state.cullMode = cullMode; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetFrontFace(VkCommandBuffer commandBuffer, VkFrontFace frontFace) {
    setState(commandBuffer, [&](GraphicsState& state) { state.frontFace = frontFace; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetPrimitiveTopology(VkCommandBuffer commandBuffer,
                                                   VkPrimitiveTopology primitiveTopology) {
    setState(commandBuffer, [&](GraphicsState& state) { state.topology = primitiveTopology; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetViewportWithCount(VkCommandBuffer commandBuffer, uint32_t viewportCount,
                                                   const VkViewport* pViewports) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        buffer.changePlanState().viewportCount = std::clamp(viewportCount, 1u, kMaxViewports);
        buffer.stream.record(command::SetViewports{0, copyArray(buffer, viewportCount, pViewports)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetScissorWithCount(VkCommandBuffer commandBuffer, uint32_t scissorCount,
                                                  const VkRect2D* pScissors) {
    CmdSetScissor(commandBuffer, 0, scissorCount, pScissors);
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthTestEnable(VkCommandBuffer commandBuffer, VkBool32 depthTestEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthTest = depthTestEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthWriteEnable(VkCommandBuffer commandBuffer, VkBool32 depthWriteEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthWrite = depthWriteEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthCompareOp(VkCommandBuffer commandBuffer, VkCompareOp depthCompareOp) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthCompare = depthCompareOp; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBoundsTestEnable(VkCommandBuffer commandBuffer, VkBool32 depthBoundsTestEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthBoundsTest = depthBoundsTestEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilTestEnable(VkCommandBuffer commandBuffer, VkBool32 stencilTestEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.stencilTest = stencilTestEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilOp(VkCommandBuffer commandBuffer, VkStencilFaceFlags faceMask,
                                           VkStencilOp failOp, VkStencilOp passOp, VkStencilOp depthFailOp,
                                           VkCompareOp compareOp) {
    setState(commandBuffer, [&](GraphicsState& state) {
        const auto set = [&](VkStencilOpState& face) {
            face.failOp = failOp;
            face.passOp = passOp;
            face.depthFailOp = depthFailOp;
            face.compareOp = compareOp;
        };
        if ((faceMask & VK_STENCIL_FACE_FRONT_BIT) != 0) set(state.stencilFront);
        if ((faceMask & VK_STENCIL_FACE_BACK_BIT) != 0) set(state.stencilBack);
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetRasterizerDiscardEnable(VkCommandBuffer commandBuffer,
                                                         VkBool32 rasterizerDiscardEnable) {
    setState(commandBuffer,
             [&](GraphicsState& state) { state.rasterizerDiscard = rasterizerDiscardEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBiasEnable(VkCommandBuffer commandBuffer, VkBool32 depthBiasEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthBiasEnable = depthBiasEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetPrimitiveRestartEnable(VkCommandBuffer commandBuffer,
                                                        VkBool32 primitiveRestartEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.primitiveRestart = primitiveRestartEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetPatchControlPointsEXT(VkCommandBuffer commandBuffer, uint32_t patchControlPoints) {
    setState(commandBuffer, [&](GraphicsState& state) { state.patchControlPoints = patchControlPoints; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetTessellationDomainOriginEXT(VkCommandBuffer commandBuffer,
                                                             VkTessellationDomainOrigin domainOrigin) {
    setState(commandBuffer, [&](GraphicsState& state) {
        state.domainLowerLeft = domainOrigin == VK_TESSELLATION_DOMAIN_ORIGIN_LOWER_LEFT;
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetLogicOpEXT(VkCommandBuffer commandBuffer, VkLogicOp logicOp) {
    setState(commandBuffer, [&](GraphicsState& state) { state.logicOp = logicOp; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthClampEnableEXT(VkCommandBuffer commandBuffer, VkBool32 depthClampEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthClampEnable = depthClampEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetPolygonModeEXT(VkCommandBuffer commandBuffer, VkPolygonMode polygonMode) {
    setState(commandBuffer, [&](GraphicsState& state) { state.polygonMode = polygonMode; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetRasterizationSamplesEXT(VkCommandBuffer commandBuffer,
                                                         VkSampleCountFlagBits rasterizationSamples) {
    setState(commandBuffer, [&](GraphicsState& state) { state.samples = static_cast<uint32_t>(rasterizationSamples); });
}

VKAPI_ATTR void VKAPI_CALL CmdSetSampleMaskEXT(VkCommandBuffer commandBuffer, VkSampleCountFlagBits,
                                               const VkSampleMask* pSampleMask) {
    setState(commandBuffer, [&](GraphicsState& state) { state.sampleMask = pSampleMask ? pSampleMask[0] : ~0u; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetAlphaToCoverageEnableEXT(VkCommandBuffer commandBuffer,
                                                          VkBool32 alphaToCoverageEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.alphaToCoverage = alphaToCoverageEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetAlphaToOneEnableEXT(VkCommandBuffer commandBuffer, VkBool32 alphaToOneEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.alphaToOne = alphaToOneEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetLogicOpEnableEXT(VkCommandBuffer commandBuffer, VkBool32 logicOpEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.logicOpEnable = logicOpEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorBlendEnableEXT(VkCommandBuffer commandBuffer, uint32_t firstAttachment,
                                                     uint32_t attachmentCount, const VkBool32* pColorBlendEnables) {
    setBlend(commandBuffer, firstAttachment, attachmentCount, pColorBlendEnables,
             [](VkPipelineColorBlendAttachmentState& blend, VkBool32 enable) { blend.blendEnable = enable != 0; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorBlendEquationEXT(VkCommandBuffer commandBuffer, uint32_t firstAttachment,
                                                       uint32_t attachmentCount,
                                                       const VkColorBlendEquationEXT* pColorBlendEquations) {
    setBlend(commandBuffer, firstAttachment, attachmentCount, pColorBlendEquations,
             [](VkPipelineColorBlendAttachmentState& blend, const VkColorBlendEquationEXT& equation) {
                 blend.srcColorBlendFactor = equation.srcColorBlendFactor;
                 blend.dstColorBlendFactor = equation.dstColorBlendFactor;
                 blend.colorBlendOp = equation.colorBlendOp;
                 blend.srcAlphaBlendFactor = equation.srcAlphaBlendFactor;
                 blend.dstAlphaBlendFactor = equation.dstAlphaBlendFactor;
                 blend.alphaBlendOp = equation.alphaBlendOp;
             });
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorWriteMaskEXT(VkCommandBuffer commandBuffer, uint32_t firstAttachment,
                                                   uint32_t attachmentCount,
                                                   const VkColorComponentFlags* pColorWriteMasks) {
    setBlend(commandBuffer, firstAttachment, attachmentCount, pColorWriteMasks,
             [](VkPipelineColorBlendAttachmentState& blend, VkColorComponentFlags mask) {
                 blend.colorWriteMask = mask & 0xF;
             });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthClipEnableEXT(VkCommandBuffer commandBuffer, VkBool32 depthClipEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.depthClipEnable = depthClipEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetSampleLocationsEnableEXT(VkCommandBuffer commandBuffer,
                                                          VkBool32 sampleLocationsEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.sampleLocations = sampleLocationsEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetProvokingVertexModeEXT(VkCommandBuffer commandBuffer,
                                                        VkProvokingVertexModeEXT provokingVertexMode) {
    setState(commandBuffer, [&](GraphicsState& state) {
        state.provokingVertexLast = provokingVertexMode == VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT;
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineRasterizationModeEXT(VkCommandBuffer commandBuffer,
                                                          VkLineRasterizationModeEXT lineRasterizationMode) {
    setState(commandBuffer, [&](GraphicsState& state) { state.lineMode = lineRasterizationMode; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineStippleEnableEXT(VkCommandBuffer commandBuffer, VkBool32 stippledLineEnable) {
    setState(commandBuffer, [&](GraphicsState& state) { state.stippledLine = stippledLineEnable != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthClipNegativeOneToOneEXT(VkCommandBuffer commandBuffer,
                                                              VkBool32 negativeOneToOne) {
    setState(commandBuffer, [&](GraphicsState& state) { state.negativeOneToOne = negativeOneToOne != VK_FALSE; });
}

VKAPI_ATTR void VKAPI_CALL CmdSetVertexInputEXT(
    VkCommandBuffer commandBuffer, uint32_t vertexBindingDescriptionCount,
    const VkVertexInputBindingDescription2EXT* pVertexBindingDescriptions, uint32_t vertexAttributeDescriptionCount,
    const VkVertexInputAttributeDescription2EXT* pVertexAttributeDescriptions) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const auto fail = [&](const char* text) { buffer.fail("vkCmdSetVertexInputEXT", text); };
        if (vertexBindingDescriptionCount > kMaxVertexBindings ||
            vertexAttributeDescriptionCount > kMaxVertexAttributes)
            return fail("more bindings or attributes than there can be");
        SetState& set = buffer.changePlanState();
        set.state.vertexBindings.clear();
        set.state.vertexAttributes.clear();
        for (uint32_t i = 0; i < vertexBindingDescriptionCount; ++i) {
            const VkVertexInputBindingDescription2EXT& from = pVertexBindingDescriptions[i];
            if (from.binding >= kMaxVertexBindings) return fail("a binding is above maxVertexInputBindings");
            if (from.stride > kMaxVertexBindingStride) return fail("a stride is above maxVertexInputBindingStride");
            set.state.vertexBindings.push_back({from.binding, from.stride, from.inputRate});
            set.state.instanceDivisors[from.binding] = from.divisor;
            set.strides[from.binding] = from.stride;
        }
        for (uint32_t i = 0; i < vertexAttributeDescriptionCount; ++i) {
            const VkVertexInputAttributeDescription2EXT& from = pVertexAttributeDescriptions[i];
            if (from.location >= kMaxVertexAttributes) return fail("a location is above maxVertexInputAttributes");
            if (from.offset > kMaxVertexAttributeOffset)
                return fail("an offset is above maxVertexInputAttributeOffset");
            set.state.vertexAttributes.push_back({from.location, from.binding, from.format, from.offset});
        }
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBindVertexBuffers2(VkCommandBuffer commandBuffer, uint32_t firstBinding,
                                                 uint32_t bindingCount, const VkBuffer* pBuffers,
                                                 const VkDeviceSize* pOffsets, const VkDeviceSize* pSizes,
                                                 const VkDeviceSize* pStrides) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        buffer.stream.record(
            command::BindVertexBuffers{firstBinding, copyRanges(buffer, bindingCount, pBuffers, pOffsets, pSizes)});
        if (pStrides == nullptr) return;
        SetState& set = buffer.changePlanState();
        for (uint32_t i = 0; i < bindingCount && firstBinding + i < kMaxVertexBindings; ++i) {
            if (pStrides[i] > kMaxVertexBindingStride)
                return buffer.fail("vkCmdBindVertexBuffers2", "a stride is above maxVertexInputBindingStride");
            set.strides[firstBinding + i] = static_cast<uint32_t>(pStrides[i]);
        }
    });
}

// Commands that belong to the extensions, for features that are not there.
#define VERNIER_REFUSED(name, ...)                                                     \
    VKAPI_ATTR void VKAPI_CALL name(VkCommandBuffer commandBuffer, __VA_ARGS__) {      \
        recording(commandBuffer, [](CommandBuffer& buffer) {                           \
            buffer.fail("vk" #name, "this dynamic state is no feature of the device"); \
        });                                                                            \
    }
VERNIER_REFUSED(CmdSetRasterizationStreamEXT, uint32_t)
VERNIER_REFUSED(CmdSetConservativeRasterizationModeEXT, VkConservativeRasterizationModeEXT)
VERNIER_REFUSED(CmdSetExtraPrimitiveOverestimationSizeEXT, float)
VERNIER_REFUSED(CmdSetColorBlendAdvancedEXT, uint32_t, uint32_t, const VkColorBlendAdvancedEXT*)
VERNIER_REFUSED(CmdSetViewportWScalingEnableNV, VkBool32)
VERNIER_REFUSED(CmdSetViewportSwizzleNV, uint32_t, uint32_t, const VkViewportSwizzleNV*)
VERNIER_REFUSED(CmdSetCoverageToColorEnableNV, VkBool32)
VERNIER_REFUSED(CmdSetCoverageToColorLocationNV, uint32_t)
VERNIER_REFUSED(CmdSetCoverageModulationModeNV, VkCoverageModulationModeNV)
VERNIER_REFUSED(CmdSetCoverageModulationTableEnableNV, VkBool32)
VERNIER_REFUSED(CmdSetCoverageModulationTableNV, uint32_t, const float*)
VERNIER_REFUSED(CmdSetShadingRateImageEnableNV, VkBool32)
VERNIER_REFUSED(CmdSetRepresentativeFragmentTestEnableNV, VkBool32)
VERNIER_REFUSED(CmdSetCoverageReductionModeNV, VkCoverageReductionModeNV)
#undef VERNIER_REFUSED

}  // namespace vernier::vulkan
