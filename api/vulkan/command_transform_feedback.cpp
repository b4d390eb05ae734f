// VK_EXT_transform_feedback: buffers, begin and end, draws of what was captured.
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/entry_points.h"
#include "runtime/resource/memory.h"
#include "spirv_interp/capture.h"

namespace vernier::vulkan {
namespace {

bool inRange(uint32_t first, uint32_t count) {
    return first <= kCaptureBuffers && count <= kCaptureBuffers - first;
}

/// Records a begin or an end with its counters.
template <class Command>
void recordCounters(VkCommandBuffer handle, const char* name, uint32_t first, uint32_t count, const VkBuffer* buffers,
                    const VkDeviceSize* offsets) {
    recording(handle, [&](CommandBuffer& buffer) {
        if (!inRange(first, count)) return buffer.fail(name, "there are no such counter buffers");
        buffer.stream.record(Command{first, copyRanges(buffer, count, buffers, offsets)});
    });
}

}  // namespace

VKAPI_ATTR void VKAPI_CALL CmdBindTransformFeedbackBuffersEXT(VkCommandBuffer commandBuffer, uint32_t firstBinding,
                                                              uint32_t bindingCount, const VkBuffer* pBuffers,
                                                              const VkDeviceSize* pOffsets,
                                                              const VkDeviceSize* pSizes) {
    recording(commandBuffer, [&](CommandBuffer& buffer) {
        if (!inRange(firstBinding, bindingCount)) {
            return buffer.fail("vkCmdBindTransformFeedbackBuffersEXT", "there are no such bindings");
        }
        buffer.stream.record(command::BindTransformFeedbackBuffers{
            firstBinding, copyRanges(buffer, bindingCount, pBuffers, pOffsets, pSizes)});
    });
}

VKAPI_ATTR void VKAPI_CALL CmdBeginTransformFeedbackEXT(VkCommandBuffer commandBuffer, uint32_t firstCounterBuffer,
                                                        uint32_t counterBufferCount, const VkBuffer* pCounterBuffers,
                                                        const VkDeviceSize* pCounterBufferOffsets) {
    recordCounters<command::BeginTransformFeedback>(commandBuffer, "vkCmdBeginTransformFeedbackEXT", firstCounterBuffer,
                                                    counterBufferCount, pCounterBuffers, pCounterBufferOffsets);
}

VKAPI_ATTR void VKAPI_CALL CmdEndTransformFeedbackEXT(VkCommandBuffer commandBuffer, uint32_t firstCounterBuffer,
                                                      uint32_t counterBufferCount, const VkBuffer* pCounterBuffers,
                                                      const VkDeviceSize* pCounterBufferOffsets) {
    recordCounters<command::EndTransformFeedback>(commandBuffer, "vkCmdEndTransformFeedbackEXT", firstCounterBuffer,
                                                  counterBufferCount, pCounterBuffers, pCounterBufferOffsets);
}

}  // namespace vernier::vulkan
