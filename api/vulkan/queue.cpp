// Submitting work.
#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/sync.h"

namespace vernier::vulkan {
namespace {

/// One wait or signal of a batch. Values count for timeline semaphores alone; missing ones are 0.
void addSemaphore(VkSemaphore handle, const uint64_t* values, uint32_t valueCount, uint32_t index,
                  std::vector<BinarySignal*>& binaries, std::vector<Submission::TimelinePoint>& points) {
    Semaphore& semaphore = *object(handle);
    if (!semaphore.timeline) {
        binaries.push_back(&semaphore.binary);
    } else {
        points.push_back({&semaphore.counter, index < valueCount ? values[index] : 0});
    }
}

Submission makeSubmission(const VkSubmitInfo& info) {
    Submission submission;
    const auto* timeline = findInChain<VkTimelineSemaphoreSubmitInfo>(info.pNext);
    const VkTimelineSemaphoreSubmitInfo none{};
    const VkTimelineSemaphoreSubmitInfo& values = timeline != nullptr ? *timeline : none;
    for (uint32_t i = 0; i < info.waitSemaphoreCount; ++i) {
        addSemaphore(info.pWaitSemaphores[i], values.pWaitSemaphoreValues, values.waitSemaphoreValueCount, i,
                     submission.waitSemaphores, submission.waitTimelines);
    }
    for (uint32_t i = 0; i < info.commandBufferCount; ++i) {
        submission.commands.push_back(&object(info.pCommandBuffers[i])->stream);
    }
    for (uint32_t i = 0; i < info.signalSemaphoreCount; ++i) {
        addSemaphore(info.pSignalSemaphores[i], values.pSignalSemaphoreValues, values.signalSemaphoreValueCount, i,
                     submission.signalSemaphores, submission.signalTimelines);
    }
    return submission;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit(VkQueue queue, uint32_t submitCount, const VkSubmitInfo* pSubmits,
                                           VkFence fence) {
    return guarded([&] {
        Device& device = object(queue)->device;
        if (device.lost()) return VK_ERROR_DEVICE_LOST;
        for (uint32_t i = 0; i < submitCount; ++i) {
            for (uint32_t j = 0; j < pSubmits[i].commandBufferCount; ++j) {
                if (!object(pSubmits[i].pCommandBuffers[j])->executable()) {
                    return device.report("vkQueueSubmit", VK_ERROR_UNKNOWN,
                                         "a command buffer is not in the executable state");
                }
            }
        }
        std::vector<Submission> batches;
        for (uint32_t i = 0; i < submitCount; ++i) batches.push_back(makeSubmission(pSubmits[i]));
        if (batches.empty()) batches.emplace_back();
        batches.back().fence = object(fence);
        for (Submission& batch : batches) device.runtime->queue().submit(std::move(batch));
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL QueueBindSparse(VkQueue queue, uint32_t, const VkBindSparseInfo*, VkFence) {
    return guarded([&] {
        return object(queue)->device.report("vkQueueBindSparse", VK_ERROR_FEATURE_NOT_PRESENT,
                                            "there is no sparse binding");
    });
}

}  // namespace vernier::vulkan
