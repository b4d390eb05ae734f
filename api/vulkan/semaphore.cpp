// Semaphores, binary and timeline (VK_KHR_timeline_semaphore).
#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/sync.h"

namespace vernier::vulkan {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits in turn for each with what is left of the time.
bool waitAllCounters(const VkSemaphoreWaitInfo& info, uint64_t timeout) {
    const Clock::time_point start = Clock::now();
    for (uint32_t i = 0; i < info.semaphoreCount; ++i) {
        uint64_t left = timeout;
        if (timeout != UINT64_MAX) {
            const auto passed = static_cast<uint64_t>((Clock::now() - start) / std::chrono::nanoseconds(1));
            left = timeout - std::min(timeout, passed);
        }
        if (!object(info.pSemaphores[i])->counter.wait(info.pValues[i], left)) return false;
    }
    return true;
}

/// Any of several counters: there is no common condition to sleep on, so each is given a short wait in turn.
bool waitAnyCounter(const VkSemaphoreWaitInfo& info, uint64_t timeout) {
    constexpr uint64_t kSlice = 200'000;  // nanoseconds
    const Clock::time_point start = Clock::now();
    for (;;) {
        for (uint32_t i = 0; i < info.semaphoreCount; ++i) {
            if (object(info.pSemaphores[i])->counter.value() >= info.pValues[i]) return true;
        }
        const auto passed = static_cast<uint64_t>((Clock::now() - start) / std::chrono::nanoseconds(1));
        if (timeout != UINT64_MAX && passed >= timeout) return false;
        const uint64_t left = timeout == UINT64_MAX ? kSlice : std::min(kSlice, timeout - passed);
        if (info.semaphoreCount == 0) return true;
        if (object(info.pSemaphores[0])->counter.wait(info.pValues[0], left)) return true;
    }
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateSemaphore(VkDevice device, const VkSemaphoreCreateInfo* pCreateInfo,
                                               const VkAllocationCallbacks* pAllocator, VkSemaphore* pSemaphore) {
    const auto* type = findInChain<VkSemaphoreTypeCreateInfo>(pCreateInfo->pNext);
    const bool timeline = type != nullptr && type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
    const uint64_t value = timeline ? type->initialValue : 0;
    const VkResult result = createHandle(pAllocator, pSemaphore, timeline, value);
    if (result != VK_SUCCESS) return result;
    const VkResult shared =
        guarded([&] { return shareSemaphore(*object(device), *object(*pSemaphore), pCreateInfo->pNext, value); });
    if (shared != VK_SUCCESS) destroyHandle(pAllocator, std::exchange(*pSemaphore, VkSemaphore{VK_NULL_HANDLE}));
    return shared;
}

VKAPI_ATTR void VKAPI_CALL DestroySemaphore(VkDevice, VkSemaphore semaphore, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, semaphore);
}

VKAPI_ATTR VkResult VKAPI_CALL GetSemaphoreCounterValue(VkDevice device, VkSemaphore semaphore, uint64_t* pValue) {
    *pValue = object(semaphore)->counter.value();
    return object(device)->lost() ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL WaitSemaphores(VkDevice device, const VkSemaphoreWaitInfo* pWaitInfo, uint64_t timeout) {
    const bool any = (pWaitInfo->flags & VK_SEMAPHORE_WAIT_ANY_BIT) != 0;
    const bool met = any ? waitAnyCounter(*pWaitInfo, timeout) : waitAllCounters(*pWaitInfo, timeout);
    if (object(device)->lost()) return VK_ERROR_DEVICE_LOST;
    return met ? VK_SUCCESS : VK_TIMEOUT;
}

VKAPI_ATTR VkResult VKAPI_CALL SignalSemaphore(VkDevice, const VkSemaphoreSignalInfo* pSignalInfo) {
    object(pSignalInfo->semaphore)->counter.signal(pSignalInfo->value);
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
