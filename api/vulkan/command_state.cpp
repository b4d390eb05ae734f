// Commands that set state: pipelines, descriptors, push constants, vertex and index buffers, dynamic state.
#include <algorithm>
#include <optional>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/descriptor.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/pipeline.h"

namespace vernier::vulkan {
namespace {

/// Samples are nothing to pipelines that discard what they would rasterise.
bool fitsSamples(const GraphicsState& state, const SubpassFormats& formats) {
    return formats.samples == 0 || state.rasterizerDiscard || state.samples == formats.samples;
}

/// Whether a pipeline's state was made for these attachments. Drawing with another would write texels of one
/// size into images of another.
bool fits(const GraphicsState& state, const SubpassFormats& formats) {
    if (state.colorCount != formats.colorCount || state.depthStencilFormat != formats.depthStencil()) return false;
    if (!fitsSamples(state, formats)) return false;
    return std::equal(formats.colors, formats.colors + formats.colorCount, state.colorFormats.begin());
}

/// The same for a plan in dynamic rendering, where an attachment that either does not have is left alone.
bool fitsDynamic(const GraphicsState& state, const SubpassFormats& formats) {
    for (uint32_t n = 0; n < kMaxColorAttachments; ++n) {
        const VkFormat wanted = n < state.colorCount ? state.colorFormats[n] : VK_FORMAT_UNDEFINED;
        if (wanted != VK_FORMAT_UNDEFINED && formats.colors[n] != VK_FORMAT_UNDEFINED && wanted != formats.colors[n])
            return false;
    }
    const VkFormat depthStencil = state.depthStencilFormat;
    return (depthStencil == VK_FORMAT_UNDEFINED || depthStencil == formats.depthStencil()) &&
           fitsSamples(state, formats);
}

/// Empty for a bind point that does not exist here.
std::optional<command::BindPoint> bindPoint(VkPipelineBindPoint point) {
    if (point == VK_PIPELINE_BIND_POINT_GRAPHICS) return command::BindPoint::graphics;
    if (point == VK_PIPELINE_BIND_POINT_COMPUTE) return command::BindPoint::compute;
    return std::nullopt;
}

template <class Command>
void record(VkCommandBuffer handle, const Command& command) {
    recording(handle, [&](CommandBuffer& buffer) { buffer.stream.record(command); });
}

}  // namespace

void CommandBuffer::checkPipeline() {
    pipelineFits = pipeline != nullptr && pass.inside && pipeline->plans == nullptr &&
                   fits(pipeline->graphics->state(), pass.formats);
    if (pipelineFits) takeSamples(pipeline->graphics->state());
}

void CommandBuffer::takeSamples(const GraphicsState& drawn) {
    if (pass.pass == nullptr && !pass.begunHere() && pass.formats.samples == 0 && !drawn.rasterizerDiscard)
        pass.formats.samples = drawn.samples;
}

SetState& CommandBuffer::changePlanState() {
    if (pipeline != nullptr && pipeline->plans != nullptr) pipelineFits = false;
    return set;
}

bool CommandBuffer::choosePlan(const char* command) {
    if (pipeline == nullptr || pipeline->plans == nullptr || !pass.inside) return false;
    auto plan = pipeline->plans->find(set, pass.formats);
    if (!plan) {
        fail(command, plan.error().message);
        return false;
    }
    const GraphicsState& planned = (*plan)->state();
    if (pass.pass != nullptr ? !fits(planned, pass.formats) : !fitsDynamic(planned, pass.formats)) return false;
    takeSamples(planned);
    const DynamicState* fixed = &pipeline->fixed;
    if (pipeline->viewportCountDynamic && set.viewportCount != fixed->viewportCount) {
        DynamicState counted = *fixed;
        counted.viewportCount = set.viewportCount;
        fixed = stream.arena().create(counted);
    }
    stream.record(pipeline->binding(**plan, *fixed));
    if (plans.empty() || plans.back() != *plan) plans.push_back(std::move(*plan));
    pipelineFits = true;
    return true;
}

VKAPI_ATTR void VKAPI_CALL CmdBindPipeline(VkCommandBuffer commandBuffer, VkPipelineBindPoint pipelineBindPoint,
                                           VkPipeline pipeline) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const Pipeline& bound = *object(pipeline);
        const std::optional<command::BindPoint> point = bindPoint(pipelineBindPoint);
        if (bound.library != nullptr) return buffer.fail("vkCmdBindPipeline", "pipeline is a library");
        const bool isCompute = bound.compute != nullptr;
        if (!point || (*point == command::BindPoint::compute) != isCompute) {
            return buffer.fail("vkCmdBindPipeline", "pipelineBindPoint is not that of the pipeline");
        }
        if (isCompute) {
            buffer.computePipeline = &bound;
            return buffer.stream.record(command::BindComputePipeline{bound.compute.get(), bound.computeAddresses});
        }
        buffer.pipeline = &bound;
        buffer.checkPipeline();
        if (bound.plans != nullptr) return;  // a draw will choose the plan
        buffer.stream.record(bound.binding(*bound.graphics, bound.fixed));
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBindDescriptorSets(VkCommandBuffer commandBuffer, VkPipelineBindPoint pipelineBindPoint,
                                                 VkPipelineLayout, uint32_t firstSet, uint32_t descriptorSetCount,
                                                 const VkDescriptorSet* pDescriptorSets, uint32_t dynamicOffsetCount,
                                                 const uint32_t* pDynamicOffsets) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const std::optional<command::BindPoint> point = bindPoint(pipelineBindPoint);
        if (!point) return buffer.fail("vkCmdBindDescriptorSets", "pipelineBindPoint must be GRAPHICS or COMPUTE");
        std::span<const uint32_t> offsets = copyArray(buffer, dynamicOffsetCount, pDynamicOffsets);
        const std::span sets = buffer.stream.arena().array<const DescriptorSet*>(descriptorSetCount);
        const std::span perSet = buffer.stream.arena().array<std::span<const uint32_t>>(descriptorSetCount);
        for (uint32_t i = 0; i < descriptorSetCount; ++i) {
            const DescriptorSetObject* set = object(pDescriptorSets[i]);
            sets[i] = set != nullptr ? &set->set : nullptr;
            const size_t wanted = set != nullptr ? set->layout->dynamicCount : 0;
            const size_t count = std::min(wanted, offsets.size());
            perSet[i] = offsets.first(count);
            offsets = offsets.subspan(count);
        }
        buffer.stream.record(command::BindDescriptorSets{*point, firstSet, sets, perSet});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdPushConstants(VkCommandBuffer commandBuffer, VkPipelineLayout,
                                            VkShaderStageFlags stageFlags, uint32_t offset, uint32_t size,
                                            const void* pValues) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const auto bytes = copyArray(buffer, size, static_cast<const std::byte*>(pValues));
        buffer.stream.record(command::PushConstants{stageFlags, offset, bytes});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBindVertexBuffers(VkCommandBuffer commandBuffer, uint32_t firstBinding,
                                                uint32_t bindingCount, const VkBuffer* pBuffers,
                                                const VkDeviceSize* pOffsets) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        buffer.stream.record(
            command::BindVertexBuffers{firstBinding, copyRanges(buffer, bindingCount, pBuffers, pOffsets)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBindIndexBuffer(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                                              VkIndexType indexType) {
    recording(commandBuffer, [&](CommandBuffer& into) {
        if (indexType != VK_INDEX_TYPE_UINT16 && indexType != VK_INDEX_TYPE_UINT32 &&
            indexType != VK_INDEX_TYPE_UINT8_EXT) {
            return into.fail("vkCmdBindIndexBuffer", "indexType must be UINT8, UINT16 or UINT32");
        }
        into.stream.record(command::BindIndexBuffer{{object(buffer), offset}, indexType});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetViewport(VkCommandBuffer commandBuffer, uint32_t firstViewport, uint32_t viewportCount,
                                          const VkViewport* pViewports) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        buffer.stream.record(command::SetViewports{firstViewport, copyArray(buffer, viewportCount, pViewports)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetScissor(VkCommandBuffer commandBuffer, uint32_t firstScissor, uint32_t scissorCount,
                                         const VkRect2D* pScissors) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        buffer.stream.record(command::SetScissors{firstScissor, copyArray(buffer, scissorCount, pScissors)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineWidth(VkCommandBuffer commandBuffer, float lineWidth) {
    record(commandBuffer, command::SetLineWidth{lineWidth});
}

VKAPI_ATTR void VKAPI_CALL CmdSetLineStippleEXT(VkCommandBuffer commandBuffer, uint32_t lineStippleFactor,
                                                uint16_t lineStipplePattern) {
    record(commandBuffer, command::SetLineStipple{lineStippleFactor, lineStipplePattern});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBias(VkCommandBuffer commandBuffer, float depthBiasConstantFactor,
                                           float depthBiasClamp, float depthBiasSlopeFactor) {
    record(commandBuffer, command::SetDepthBias{depthBiasConstantFactor, depthBiasClamp, depthBiasSlopeFactor});
}

VKAPI_ATTR void VKAPI_CALL CmdSetBlendConstants(VkCommandBuffer commandBuffer, const float blendConstants[4]) {
    record(commandBuffer,
           command::SetBlendConstants{{blendConstants[0], blendConstants[1], blendConstants[2], blendConstants[3]}});
}

VKAPI_ATTR void VKAPI_CALL CmdSetColorWriteEnableEXT(VkCommandBuffer commandBuffer, uint32_t attachmentCount,
                                                     const VkBool32* pColorWriteEnables) {
    uint32_t mask = ~0u;
    for (uint32_t i = 0; i < std::min(attachmentCount, kMaxColorAttachments); ++i) {
        if (pColorWriteEnables[i] == VK_FALSE) mask &= ~(1u << i);
    }
    record(commandBuffer, command::SetColorWrites{mask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetDepthBounds(VkCommandBuffer commandBuffer, float minDepthBounds,
                                             float maxDepthBounds) {
    record(commandBuffer, command::SetDepthBounds{minDepthBounds, maxDepthBounds});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilCompareMask(VkCommandBuffer commandBuffer, VkStencilFaceFlags faceMask,
                                                    uint32_t compareMask) {
    record(commandBuffer, command::SetStencil{faceMask, command::SetStencil::Field::compareMask, compareMask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilWriteMask(VkCommandBuffer commandBuffer, VkStencilFaceFlags faceMask,
                                                  uint32_t writeMask) {
    record(commandBuffer, command::SetStencil{faceMask, command::SetStencil::Field::writeMask, writeMask});
}

VKAPI_ATTR void VKAPI_CALL CmdSetStencilReference(VkCommandBuffer commandBuffer, VkStencilFaceFlags faceMask,
                                                  uint32_t reference) {
    record(commandBuffer, command::SetStencil{faceMask, command::SetStencil::Field::reference, reference});
}

VKAPI_ATTR void VKAPI_CALL CmdSetSampleLocationsEXT(VkCommandBuffer commandBuffer,
                                                    const VkSampleLocationsInfoEXT* pSampleLocationsInfo) {
    record(commandBuffer, command::SetSampleLocations{sampleLocationsOf(*pSampleLocationsInfo)});
}

}  // namespace vernier::vulkan
