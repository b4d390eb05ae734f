// Sharing semaphores and fences with other processes and devices: VK_KHR_external_semaphore_fd,
// VK_KHR_external_fence_fd. Both go by opaque file descriptors, which refer to what they come from ("reference
// transference"). Sync files are made by the kernel's drivers alone, and not offered.
#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/sync.h"

namespace vernier::vulkan {
namespace {

using Kind = SharedSignal::Kind;
using Payload = std::shared_ptr<SharedSignal>;

constexpr VkExternalSemaphoreHandleTypeFlagBits kSemaphoreFd = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
constexpr VkExternalFenceHandleTypeFlagBits kFenceFd = VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT;

Kind kindOf(bool timeline) {
    return timeline ? Kind::timelineSemaphore : Kind::binarySemaphore;
}

/// `attach` makes the payload that of the object.
template <class Attach>
VkResult import(VkDevice device, const char* command, Kind kind, bool opaque, int fd, Attach attach) {
    return guarded([&] {
        const Device& owner = *object(device);
        if (!opaque) {
            return owner.report(command, VK_ERROR_INVALID_EXTERNAL_HANDLE, "only opaque file descriptors are imported");
        }
        Result<Payload> payload = SharedSignal::import(kind, fd);
        if (!payload) return owner.report(command, VK_ERROR_INVALID_EXTERNAL_HANDLE, payload.error().message);
        attach(std::move(payload).value());
        return VK_SUCCESS;
    });
}

VkResult get(VkDevice device, const char* command, bool opaque, const Payload& payload, int* fd) {
    return guarded([&] {
        *fd = -1;
        if (!opaque || !payload) {
            return object(device)->report(command, VK_ERROR_UNKNOWN,
                                          "it was not made to be exported as an opaque file descriptor");
        }
        *fd = payload->exportFd();
        return *fd >= 0 ? VK_SUCCESS : VK_ERROR_TOO_MANY_OBJECTS;
    });
}

}  // namespace

VkResult shareSemaphore(const Device& device, Semaphore& semaphore, const void* chain, uint64_t value) {
    const auto* exported = findInChain<VkExportSemaphoreCreateInfo>(chain);
    if (exported == nullptr || exported->handleTypes == 0) return VK_SUCCESS;
    if (exported->handleTypes != kSemaphoreFd) {
        return device.report("vkCreateSemaphore", VK_ERROR_FEATURE_NOT_PRESENT,
                             "VkExportSemaphoreCreateInfo::handleTypes: only opaque file descriptors are exported");
    }
    Result<Payload> payload = SharedSignal::create(kindOf(semaphore.timeline), value);
    if (!payload) return device.report("vkCreateSemaphore", payload.error());
    if (semaphore.timeline) {
        semaphore.counter.share(std::move(payload).value());
    } else {
        semaphore.binary.share(std::move(payload).value(), false);
    }
    return VK_SUCCESS;
}

VkResult shareFence(const Device& device, BinarySignal& fence, const void* chain) {
    const auto* exported = findInChain<VkExportFenceCreateInfo>(chain);
    if (exported == nullptr || exported->handleTypes == 0) return VK_SUCCESS;
    if (exported->handleTypes != kFenceFd) {
        return device.report("vkCreateFence", VK_ERROR_FEATURE_NOT_PRESENT,
                             "VkExportFenceCreateInfo::handleTypes: only opaque file descriptors are exported");
    }
    Result<Payload> payload = SharedSignal::create(Kind::fence, fence.signalled() ? 1 : 0);
    if (!payload) return device.report("vkCreateFence", payload.error());
    fence.share(std::move(payload).value(), false);
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL ImportSemaphoreFdKHR(VkDevice device, const VkImportSemaphoreFdInfoKHR* pInfo) {
    Semaphore& semaphore = *object(pInfo->semaphore);
    return import(device, "vkImportSemaphoreFdKHR", kindOf(semaphore.timeline), pInfo->handleType == kSemaphoreFd,
                  pInfo->fd, [&](Payload payload) {
                      // Timelines are never imported for a time.
                      if (semaphore.timeline) return semaphore.counter.share(std::move(payload));
                      const bool temporarily = (pInfo->flags & VK_SEMAPHORE_IMPORT_TEMPORARY_BIT) != 0;
                      semaphore.binary.share(std::move(payload), temporarily);
                  });
}

VKAPI_ATTR VkResult VKAPI_CALL GetSemaphoreFdKHR(VkDevice device, const VkSemaphoreGetFdInfoKHR* pGetFdInfo, int* pFd) {
    const Semaphore& semaphore = *object(pGetFdInfo->semaphore);
    return get(device, "vkGetSemaphoreFdKHR", pGetFdInfo->handleType == kSemaphoreFd,
               semaphore.timeline ? semaphore.counter.payload() : semaphore.binary.payload(), pFd);
}

VKAPI_ATTR VkResult VKAPI_CALL ImportFenceFdKHR(VkDevice device, const VkImportFenceFdInfoKHR* pInfo) {
    return import(device, "vkImportFenceFdKHR", Kind::fence, pInfo->handleType == kFenceFd, pInfo->fd,
                  [&](Payload payload) {
                      const bool temporarily = (pInfo->flags & VK_FENCE_IMPORT_TEMPORARY_BIT) != 0;
                      object(pInfo->fence)->share(std::move(payload), temporarily);
                  });
}

VKAPI_ATTR VkResult VKAPI_CALL GetFenceFdKHR(VkDevice device, const VkFenceGetFdInfoKHR* pGetFdInfo, int* pFd) {
    return get(device, "vkGetFenceFdKHR", pGetFdInfo->handleType == kFenceFd, object(pGetFdInfo->fence)->payload(),
               pFd);
}

VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceExternalFenceProperties(VkPhysicalDevice, const VkPhysicalDeviceExternalFenceInfo* pInfo,
                                         VkExternalFenceProperties* pExternalFenceProperties) {
    const bool known = pInfo->handleType == kFenceFd;
    pExternalFenceProperties->exportFromImportedHandleTypes = known ? kFenceFd : 0;
    pExternalFenceProperties->compatibleHandleTypes = known ? kFenceFd : 0;
    pExternalFenceProperties->externalFenceFeatures =
        known ? VK_EXTERNAL_FENCE_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_FENCE_FEATURE_IMPORTABLE_BIT : 0;
}

VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceExternalSemaphoreProperties(VkPhysicalDevice, const VkPhysicalDeviceExternalSemaphoreInfo* pInfo,
                                             VkExternalSemaphoreProperties* pExternalSemaphoreProperties) {
    const bool known = pInfo->handleType == kSemaphoreFd;
    pExternalSemaphoreProperties->exportFromImportedHandleTypes = known ? kSemaphoreFd : 0;
    pExternalSemaphoreProperties->compatibleHandleTypes = known ? kSemaphoreFd : 0;
    pExternalSemaphoreProperties->externalSemaphoreFeatures =
        known ? VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_SEMAPHORE_FEATURE_IMPORTABLE_BIT : 0;
}

}  // namespace vernier::vulkan
