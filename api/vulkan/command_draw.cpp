// Draws and what they depend on, clears inside a render pass, and secondary command buffers.
#include <string>
#include <vector>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {
namespace {

/// A draw without a pipeline for the current subpass is left out and remembered as an error.
template <class Command>
void recordDraw(VkCommandBuffer handle, const char* name, const Command& command) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (!buffer.pipelineFits && !buffer.choosePlan(name)) {
            return buffer.fail(name, "no pipeline is bound that was made for the attachments of the current subpass");
        }
        buffer.stream.record(command);
    });
}

/// Draws whose arguments overlap could be any number, wherever the buffer ends.
void recordIndirect(VkCommandBuffer handle, const char* name, const command::DrawIndirect& command) {
    const size_t size = command.indexed ? sizeof(VkDrawIndexedIndirectCommand) : sizeof(VkDrawIndirectCommand);
    if (command.drawCount > 1 && command.stride < size) {
        return recording(handle, [&](CommandBuffer& buffer) {
            buffer.fail(name, "stride " + std::to_string(command.stride) + " is less than the " + std::to_string(size) +
                                  " bytes of a draw's arguments");
        });
    }
    recordDraw(handle, name, command);
}

/// Element `index` of an array whose elements are `stride` bytes apart.
template <class Element>
const Element* elementAt(const Element* first, uint32_t index, uint32_t stride) {
    return reinterpret_cast<const Element*>(reinterpret_cast<const std::byte*>(first) + size_t{index} * stride);
}

/// Whether the attachment that a clear names exists in the subpass.
bool clears(const SubpassFormats& formats, const VkClearAttachment& attachment) {
    if (attachment.aspectMask == VK_IMAGE_ASPECT_COLOR_BIT) {
        return attachment.colorAttachment < formats.colorCount &&
               formats.colors[attachment.colorAttachment] != VK_FORMAT_UNDEFINED;
    }
    return (attachment.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) == 0 && formats.depthStencil() != VK_FORMAT_UNDEFINED;
}

/// Whether what was recorded for passes of one kind may run in a pass of the other. In dynamic rendering, an attachment
/// that either does not have is left alone by draws; but for depth and stencil, draws have been planned.
bool mayRunIn(const CommandBuffer::Pass& recorded, const CommandBuffer::Pass& pass) {
    if (!pass.inside) return false;
    if (recorded.pass != nullptr || pass.pass != nullptr) return recorded.formats == pass.formats;
    const SubpassFormats &from = recorded.formats, &to = pass.formats;
    for (uint32_t n = 0; n < kMaxColorAttachments; ++n) {
        const bool used = from.colors[n] != VK_FORMAT_UNDEFINED && to.colors[n] != VK_FORMAT_UNDEFINED;
        if (used && from.colors[n] != to.colors[n]) return false;
    }
    const auto holds = [](VkFormat wanted, VkFormat has) { return wanted == VK_FORMAT_UNDEFINED || wanted == has; };
    return holds(from.depth, to.depth) && holds(from.stencil, to.stencil) && from.viewMask == to.viewMask &&
           (to.samples == 0 || from.samples == 0 || from.samples == to.samples);
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdDraw(VkCommandBuffer commandBuffer, uint32_t vertexCount, uint32_t instanceCount,
                                   uint32_t firstVertex, uint32_t firstInstance) {
    recordDraw(commandBuffer, "vkCmdDraw",
               command::Draw{false, vertexCount, instanceCount, firstVertex, firstInstance, 0});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexed(VkCommandBuffer commandBuffer, uint32_t indexCount, uint32_t instanceCount,
                                          uint32_t firstIndex, int32_t vertexOffset, uint32_t firstInstance) {
    recordDraw(commandBuffer, "vkCmdDrawIndexed",
               command::Draw{true, indexCount, instanceCount, firstIndex, firstInstance, vertexOffset});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirect(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                                           uint32_t drawCount, uint32_t stride) {
    recordIndirect(commandBuffer, "vkCmdDrawIndirect",
                   command::DrawIndirect{false, {object(buffer), offset}, drawCount, stride, {}});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexedIndirect(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                                                  uint32_t drawCount, uint32_t stride) {
    recordIndirect(commandBuffer, "vkCmdDrawIndexedIndirect",
                   command::DrawIndirect{true, {object(buffer), offset}, drawCount, stride, {}});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirectCount(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset,
                                                VkBuffer countBuffer, VkDeviceSize countBufferOffset,
                                                uint32_t maxDrawCount, uint32_t stride) {
    recordIndirect(
        commandBuffer, "vkCmdDrawIndirectCount",
        command::DrawIndirect{
            false, {object(buffer), offset}, maxDrawCount, stride, {object(countBuffer), countBufferOffset}});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndexedIndirectCount(VkCommandBuffer commandBuffer, VkBuffer buffer,
                                                       VkDeviceSize offset, VkBuffer countBuffer,
                                                       VkDeviceSize countBufferOffset, uint32_t maxDrawCount,
                                                       uint32_t stride) {
    recordIndirect(commandBuffer, "vkCmdDrawIndexedIndirectCount",
                   command::DrawIndirect{
                       true, {object(buffer), offset}, maxDrawCount, stride, {object(countBuffer), countBufferOffset}});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawIndirectByteCountEXT(VkCommandBuffer commandBuffer, uint32_t instanceCount,
                                                       uint32_t firstInstance, VkBuffer counterBuffer,
                                                       VkDeviceSize counterBufferOffset, uint32_t counterOffset,
                                                       uint32_t vertexStride) {
    recordDraw(
        commandBuffer, "vkCmdDrawIndirectByteCountEXT",
        command::DrawIndirectByteCount{
            {object(counterBuffer), counterBufferOffset}, counterOffset, vertexStride, instanceCount, firstInstance});
}

VKAPI_ATTR void VKAPI_CALL CmdDrawMultiEXT(VkCommandBuffer commandBuffer, uint32_t drawCount,
                                           const VkMultiDrawInfoEXT* pVertexInfo, uint32_t instanceCount,
                                           uint32_t firstInstance, uint32_t stride) {
    for (uint32_t i = 0; i < drawCount; ++i) {
        const VkMultiDrawInfoEXT& draw = *elementAt(pVertexInfo, i, stride);
        recordDraw(commandBuffer, "vkCmdDrawMultiEXT",
                   command::Draw{false, draw.vertexCount, instanceCount, draw.firstVertex, firstInstance, 0, i});
    }
}

VKAPI_ATTR void VKAPI_CALL CmdDrawMultiIndexedEXT(VkCommandBuffer commandBuffer, uint32_t drawCount,
                                                  const VkMultiDrawIndexedInfoEXT* pIndexInfo, uint32_t instanceCount,
                                                  uint32_t firstInstance, uint32_t stride,
                                                  const int32_t* pVertexOffset) {
    for (uint32_t i = 0; i < drawCount; ++i) {
        const VkMultiDrawIndexedInfoEXT& draw = *elementAt(pIndexInfo, i, stride);
        const int32_t vertexOffset = pVertexOffset != nullptr ? *pVertexOffset : draw.vertexOffset;
        recordDraw(
            commandBuffer, "vkCmdDrawMultiIndexedEXT",
            command::Draw{true, draw.indexCount, instanceCount, draw.firstIndex, firstInstance, vertexOffset, i});
    }
}

VKAPI_ATTR void VKAPI_CALL CmdBeginConditionalRenderingEXT(
    VkCommandBuffer commandBuffer, const VkConditionalRenderingBeginInfoEXT* pConditionalRenderingBegin) {
    const VkConditionalRenderingBeginInfoEXT& info = *pConditionalRenderingBegin;
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const bool inverted = (info.flags & VK_CONDITIONAL_RENDERING_INVERTED_BIT_EXT) != 0;
        buffer.stream.record(command::BeginConditionalRendering{{object(info.buffer), info.offset}, inverted});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdEndConditionalRenderingEXT(VkCommandBuffer commandBuffer) {
    recording(commandBuffer, [](CommandBuffer& buffer) { buffer.stream.record(command::EndConditionalRendering{}); });
}

VKAPI_ATTR void VKAPI_CALL CmdClearAttachments(VkCommandBuffer commandBuffer, uint32_t attachmentCount,
                                               const VkClearAttachment* pAttachments, uint32_t rectCount,
                                               const VkClearRect* pRects) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!buffer.pass.inside) return buffer.fail("vkCmdClearAttachments", "not inside a render pass");
        std::vector<VkClearAttachment> existing;
        for (uint32_t i = 0; i < attachmentCount; ++i) {
            if (clears(buffer.pass.formats, pAttachments[i])) existing.push_back(pAttachments[i]);
        }
        const std::span attachments = buffer.stream.copy(std::span<const VkClearAttachment>(existing));
        buffer.stream.record(command::ClearAttachments{attachments, copyArray(buffer, rectCount, pRects)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdExecuteCommands(VkCommandBuffer commandBuffer, uint32_t commandBufferCount,
                                              const VkCommandBuffer* pCommandBuffers) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        const std::span streams = buffer.stream.arena().array<const vernier::CommandBuffer*>(commandBufferCount);
        for (uint32_t i = 0; i < commandBufferCount; ++i) {
            const CommandBuffer& secondary = *object(pCommandBuffers[i]);
            if (!secondary.executable() || secondary.level != VK_COMMAND_BUFFER_LEVEL_SECONDARY) {
                return buffer.fail("vkCmdExecuteCommands", "a command buffer is not an executable secondary one");
            }
            if (secondary.pass.inside && !mayRunIn(secondary.pass, buffer.pass)) {
                return buffer.fail("vkCmdExecuteCommands", "a command buffer was recorded for another render pass");
            }
            streams[i] = &secondary.stream;
        }
        buffer.stream.record(command::ExecuteCommands{streams});
        // "the state of the primary command buffer is undefined after": what was bound is gone.
        buffer.pipeline = nullptr;
        buffer.pipelineFits = false;
    });
}

}  // namespace vernier::vulkan
