// Fences and events.
#include "api/vulkan/sync.h"

#include <utility>
#include <vector>

#include "api/vulkan/allocation.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"

namespace vernier::vulkan {

VKAPI_ATTR VkResult VKAPI_CALL CreateFence(VkDevice device, const VkFenceCreateInfo* pCreateInfo,
                                           const VkAllocationCallbacks* pAllocator, VkFence* pFence) {
    const VkResult result = createHandle(pAllocator, pFence, (pCreateInfo->flags & VK_FENCE_CREATE_SIGNALED_BIT) != 0);
    if (result != VK_SUCCESS) return result;
    const VkResult shared = guarded([&] { return shareFence(*object(device), *object(*pFence), pCreateInfo->pNext); });
    if (shared != VK_SUCCESS) destroyHandle(pAllocator, std::exchange(*pFence, VkFence{VK_NULL_HANDLE}));
    return shared;
}

VKAPI_ATTR void VKAPI_CALL DestroyFence(VkDevice, VkFence fence, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL ResetFences(VkDevice, uint32_t fenceCount, const VkFence* pFences) {
    for (uint32_t i = 0; i < fenceCount; ++i) object(pFences[i])->reset();
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetFenceStatus(VkDevice device, VkFence fence) {
    if (object(device)->lost()) return VK_ERROR_DEVICE_LOST;
    return object(fence)->signalled() ? VK_SUCCESS : VK_NOT_READY;
}

VKAPI_ATTR VkResult VKAPI_CALL WaitForFences(VkDevice device, uint32_t fenceCount, const VkFence* pFences,
                                             VkBool32 waitAll, uint64_t timeout) {
    return guarded([&] {
        std::vector<const BinarySignal*> signals(fenceCount);
        for (uint32_t i = 0; i < fenceCount; ++i) signals[i] = object(pFences[i]);
        const bool met = waitSignals(signals.data(), fenceCount, waitAll != VK_FALSE, timeout);
        if (object(device)->lost()) return VK_ERROR_DEVICE_LOST;
        return met ? VK_SUCCESS : VK_TIMEOUT;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL CreateEvent(VkDevice, const VkEventCreateInfo*, const VkAllocationCallbacks* pAllocator,
                                           VkEvent* pEvent) {
    return createHandle(pAllocator, pEvent);
}

VKAPI_ATTR void VKAPI_CALL DestroyEvent(VkDevice, VkEvent event, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, event);
}

VKAPI_ATTR VkResult VKAPI_CALL GetEventStatus(VkDevice device, VkEvent event) {
    if (object(device)->lost()) return VK_ERROR_DEVICE_LOST;
    return object(event)->set.load(std::memory_order_acquire) ? VK_EVENT_SET : VK_EVENT_RESET;
}

VKAPI_ATTR VkResult VKAPI_CALL SetEvent(VkDevice, VkEvent event) {
    object(event)->set.store(true, std::memory_order_release);
    object(event)->set.notify_all();
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL ResetEvent(VkDevice, VkEvent event) {
    object(event)->set.store(false, std::memory_order_release);
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
