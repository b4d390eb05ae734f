// Submitting work.
#include <algorithm>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/command_buffer.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/sync.h"

namespace vernier::vulkan {
namespace {

/// One wait or signal of a batch. The value counts for timeline semaphores alone.
void addSemaphore(VkSemaphore handle, uint64_t value, std::vector<BinarySignal*>& binaries,
                  std::vector<Submission::TimelinePoint>& points) {
    Semaphore& semaphore = *object(handle);
    if (!semaphore.timeline) {
        binaries.push_back(&semaphore.binary);
    } else {
        points.push_back({&semaphore.counter, value});
    }
}

Submission makeSubmission(const VkSubmitInfo& info) {
    Submission submission;
    const auto* timeline = findInChain<VkTimelineSemaphoreSubmitInfo>(info.pNext);
    const VkTimelineSemaphoreSubmitInfo none{};
    const VkTimelineSemaphoreSubmitInfo& values = timeline != nullptr ? *timeline : none;
    for (uint32_t i = 0; i < info.waitSemaphoreCount; ++i) {
        const uint64_t value = i < values.waitSemaphoreValueCount ? values.pWaitSemaphoreValues[i] : 0;
        addSemaphore(info.pWaitSemaphores[i], value, submission.waitSemaphores, submission.waitTimelines);
    }
    for (uint32_t i = 0; i < info.commandBufferCount; ++i) {
        submission.commands.push_back(&object(info.pCommandBuffers[i])->stream);
    }
    for (uint32_t i = 0; i < info.signalSemaphoreCount; ++i) {
        const uint64_t value = i < values.signalSemaphoreValueCount ? values.pSignalSemaphoreValues[i] : 0;
        addSemaphore(info.pSignalSemaphores[i], value, submission.signalSemaphores, submission.signalTimelines);
    }
    return submission;
}

Submission makeSubmission(const VkSubmitInfo2& info) {
    Submission submission;
    for (uint32_t i = 0; i < info.waitSemaphoreInfoCount; ++i) {
        const VkSemaphoreSubmitInfo& wait = info.pWaitSemaphoreInfos[i];
        addSemaphore(wait.semaphore, wait.value, submission.waitSemaphores, submission.waitTimelines);
    }
    for (uint32_t i = 0; i < info.commandBufferInfoCount; ++i) {
        submission.commands.push_back(&object(info.pCommandBufferInfos[i].commandBuffer)->stream);
    }
    for (uint32_t i = 0; i < info.signalSemaphoreInfoCount; ++i) {
        const VkSemaphoreSubmitInfo& signal = info.pSignalSemaphoreInfos[i];
        addSemaphore(signal.semaphore, signal.value, submission.signalSemaphores, submission.signalTimelines);
    }
    return submission;
}

bool allExecutable(const VkSubmitInfo& info) {
    const auto executable = [](VkCommandBuffer commands) { return object(commands)->executable(); };
    return std::all_of(info.pCommandBuffers, info.pCommandBuffers + info.commandBufferCount, executable);
}

bool allExecutable(const VkSubmitInfo2& info) {
    const auto executable = [](const VkCommandBufferSubmitInfo& one) {
        return object(one.commandBuffer)->executable();
    };
    return std::all_of(info.pCommandBufferInfos, info.pCommandBufferInfos + info.commandBufferInfoCount, executable);
}

template <class Info>
VkResult submit(VkQueue queue, const char* command, uint32_t count, const Info* infos, VkFence fence) {
    return guarded([&] {
        Device& device = object(queue)->device;
        if (device.lost()) return VK_ERROR_DEVICE_LOST;
        for (uint32_t i = 0; i < count; ++i) {
            if (!allExecutable(infos[i])) {
                return device.report(command, VK_ERROR_UNKNOWN, "a command buffer is not in the executable state");
            }
        }
        if (fence != VK_NULL_HANDLE && device.validates() && object(fence)->signalled()) {
            (void)device.report(command, VK_SUCCESS, "the fence is signalled already");
        }
        std::vector<Submission> batches;
        for (uint32_t i = 0; i < count; ++i) batches.push_back(makeSubmission(infos[i]));
        if (batches.empty()) batches.emplace_back();
        batches.back().fence = object(fence);
        for (Submission& batch : batches) device.runtime->queue().submit(std::move(batch));
        return VK_SUCCESS;
    });
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit(VkQueue queue, uint32_t submitCount, const VkSubmitInfo* pSubmits,
                                           VkFence fence) {
    return submit(queue, "vkQueueSubmit", submitCount, pSubmits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL QueueSubmit2(VkQueue queue, uint32_t submitCount, const VkSubmitInfo2* pSubmits,
                                            VkFence fence) {
    return submit(queue, "vkQueueSubmit2", submitCount, pSubmits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL QueueBindSparse(VkQueue queue, uint32_t, const VkBindSparseInfo*, VkFence) {
    return guarded([&] {
        return object(queue)->device.report("vkQueueBindSparse", VK_ERROR_FEATURE_NOT_PRESENT,
                                            "there is no sparse binding");
    });
}

}  // namespace vernier::vulkan
