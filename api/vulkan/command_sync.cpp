// Barriers, events, queries and timestamps. The queue runs one command after the other, so that a barrier has
// something to do only inside a render pass, where draws are collected.
#include <algorithm>

#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/sync.h"
#include "runtime/command/query_pool.h"
#include "runtime/resource/memory.h"

namespace vernier::vulkan {
namespace {

template <class Command>
void record(VkCommandBuffer handle, const Command& command) {
    recording(handle, [&](CommandBuffer& buffer) { buffer.stream.record(command); });
}

bool inRange(const QueryPool& pool, uint32_t first, uint32_t count) {
    return first <= pool.count() && count <= pool.count() - first;
}

/// Records a command about queries, unless they are outside the pool.
template <class Command>
void recordQueries(VkCommandBuffer handle, const char* name, uint32_t first, uint32_t count, const Command& command) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (!inRange(*command.pool, first, count)) return buffer.fail(name, "the queries are outside the pool");
        buffer.stream.record(command);
    });
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier(VkCommandBuffer commandBuffer, VkPipelineStageFlags, VkPipelineStageFlags,
                                              VkDependencyFlags, uint32_t, const VkMemoryBarrier*, uint32_t,
                                              const VkBufferMemoryBarrier*, uint32_t, const VkImageMemoryBarrier*) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (buffer.pass.inside) buffer.stream.record(command::Flush{});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer commandBuffer, const VkDependencyInfo*) {
    CmdPipelineBarrier(commandBuffer, 0, 0, 0, 0, nullptr, 0, nullptr, 0, nullptr);
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent(VkCommandBuffer commandBuffer, VkEvent event, VkPipelineStageFlags) {
    record(commandBuffer, command::SetEvent{&object(event)->set, true});
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent(VkCommandBuffer commandBuffer, VkEvent event, VkPipelineStageFlags) {
    record(commandBuffer, command::SetEvent{&object(event)->set, false});
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents(VkCommandBuffer commandBuffer, uint32_t eventCount, const VkEvent* pEvents,
                                         VkPipelineStageFlags, VkPipelineStageFlags, uint32_t, const VkMemoryBarrier*,
                                         uint32_t, const VkBufferMemoryBarrier*, uint32_t,
                                         const VkImageMemoryBarrier*) {
    for (uint32_t i = 0; i < eventCount; ++i) {
        record(commandBuffer, command::WaitEvent{&object(pEvents[i])->set});
    }
}

VKAPI_ATTR void VKAPI_CALL CmdSetEvent2(VkCommandBuffer commandBuffer, VkEvent event, const VkDependencyInfo*) {
    CmdSetEvent(commandBuffer, event, 0);
}

VKAPI_ATTR void VKAPI_CALL CmdResetEvent2(VkCommandBuffer commandBuffer, VkEvent event, VkPipelineStageFlags2) {
    CmdResetEvent(commandBuffer, event, 0);
}

VKAPI_ATTR void VKAPI_CALL CmdWaitEvents2(VkCommandBuffer commandBuffer, uint32_t eventCount, const VkEvent* pEvents,
                                          const VkDependencyInfo*) {
    CmdWaitEvents(commandBuffer, eventCount, pEvents, 0, 0, 0, nullptr, 0, nullptr, 0, nullptr);
}

VKAPI_ATTR void VKAPI_CALL CmdBeginQuery(VkCommandBuffer commandBuffer, VkQueryPool queryPool, uint32_t query,
                                         VkQueryControlFlags flags) {
    CmdBeginQueryIndexedEXT(commandBuffer, queryPool, query, flags, 0);
}

VKAPI_ATTR void VKAPI_CALL CmdEndQuery(VkCommandBuffer commandBuffer, VkQueryPool queryPool, uint32_t query) {
    recordQueries(commandBuffer, "vkCmdEndQuery", query, 1, command::EndQuery{object(queryPool), query});
}

// `index` is a vertex stream.

VKAPI_ATTR void VKAPI_CALL CmdBeginQueryIndexedEXT(VkCommandBuffer commandBuffer, VkQueryPool queryPool, uint32_t query,
                                                   VkQueryControlFlags, uint32_t index) {
    recordQueries(commandBuffer, "vkCmdBeginQuery", query, 1,
                  command::BeginQuery{object(queryPool), query, std::min(index, ir::kVertexStreams - 1)});
}

VKAPI_ATTR void VKAPI_CALL CmdEndQueryIndexedEXT(VkCommandBuffer commandBuffer, VkQueryPool queryPool, uint32_t query,
                                                 uint32_t) {
    CmdEndQuery(commandBuffer, queryPool, query);
}

VKAPI_ATTR void VKAPI_CALL CmdResetQueryPool(VkCommandBuffer commandBuffer, VkQueryPool queryPool, uint32_t firstQuery,
                                             uint32_t queryCount) {
    recordQueries(commandBuffer, "vkCmdResetQueryPool", firstQuery, queryCount,
                  command::ResetQueries{object(queryPool), firstQuery, queryCount});
}

VKAPI_ATTR void VKAPI_CALL CmdWriteTimestamp(VkCommandBuffer commandBuffer, VkPipelineStageFlagBits,
                                             VkQueryPool queryPool, uint32_t query) {
    recordQueries(commandBuffer, "vkCmdWriteTimestamp", query, 1, command::WriteTimestamp{object(queryPool), query});
}

VKAPI_ATTR void VKAPI_CALL CmdWriteTimestamp2(VkCommandBuffer commandBuffer, VkPipelineStageFlags2,
                                              VkQueryPool queryPool, uint32_t query) {
    CmdWriteTimestamp(commandBuffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queryPool, query);
}

VKAPI_ATTR void VKAPI_CALL CmdCopyQueryPoolResults(VkCommandBuffer commandBuffer, VkQueryPool queryPool,
                                                   uint32_t firstQuery, uint32_t queryCount, VkBuffer dstBuffer,
                                                   VkDeviceSize dstOffset, VkDeviceSize stride,
                                                   VkQueryResultFlags flags) {
    if (object(dstBuffer)->data() == nullptr) {
        return recording(commandBuffer, [](CommandBuffer& buffer) {
            buffer.fail("vkCmdCopyQueryPoolResults", "the buffer has no memory bound");
        });
    }
    recordQueries(commandBuffer, "vkCmdCopyQueryPoolResults", firstQuery, queryCount,
                  command::CopyQueryResults{object(queryPool), firstQuery, queryCount, object(dstBuffer), dstOffset,
                                            stride, flags});
}

}  // namespace vernier::vulkan
