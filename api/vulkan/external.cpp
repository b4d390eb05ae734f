// Sharing memory with other processes and devices: VK_KHR_external_memory_fd, VK_EXT_external_memory_host.
#include "api/vulkan/external.h"

#include <unistd.h>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/memory.h"

namespace vernier::vulkan {
namespace {

constexpr VkExternalMemoryHandleTypeFlagBits kFd = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
constexpr VkExternalMemoryHandleTypeFlagBits kHost = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;

VkResult keep(const Device& device, Result<std::unique_ptr<Memory>> result, std::unique_ptr<Memory>& made) {
    if (!result && result.error().code == ErrorCode::invalidArgument)
        return device.report("vkAllocateMemory", VK_ERROR_INVALID_EXTERNAL_HANDLE, result.error().message);
    if (!result) return device.report("vkAllocateMemory", result.error());
    made = std::move(result).value();
    return VK_SUCCESS;
}

VkResult importHost(const Device& device, const VkImportMemoryHostPointerInfoEXT& from, VkDeviceSize size,
                    std::unique_ptr<Memory>& made) {
    const VkDeviceSize alignment = hostPointerAlignment();
    if (from.handleType != kHost || from.pHostPointer == nullptr || size == 0 || size % alignment != 0 ||
        reinterpret_cast<uintptr_t>(from.pHostPointer) % alignment != 0) {
        return device.report("vkAllocateMemory", VK_ERROR_INVALID_EXTERNAL_HANDLE,
                             "host memory must be whole pages of the process: address and size multiples of " +
                                 std::to_string(alignment));
    }
    return keep(device, Memory::wrap(from.pHostPointer, size), made);
}

}  // namespace

VkExternalMemoryProperties externalMemoryProperties(VkExternalMemoryHandleTypeFlags handleType) {
    if (handleType == kFd) {
        return {VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT, kFd, kFd};
    }
    if (handleType == kHost) return {VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT, 0, kHost};
    return {};
}

bool areExternalMemoryTypes(VkExternalMemoryHandleTypeFlags handleTypes) {
    return (handleTypes & ~VkExternalMemoryHandleTypeFlags{kFd | kHost}) == 0;
}

VkDeviceSize hostPointerAlignment() {
    return static_cast<VkDeviceSize>(sysconf(_SC_PAGESIZE));
}

VkResult makeMemory(const Device& device, const VkMemoryAllocateInfo& info, std::unique_ptr<Memory>& made) {
    const VkDeviceSize size = info.allocationSize;
    if (const auto* fd = findInChain<VkImportMemoryFdInfoKHR>(info.pNext); fd != nullptr && fd->handleType != 0) {
        if (fd->handleType != kFd) {
            return device.report("vkAllocateMemory", VK_ERROR_INVALID_EXTERNAL_HANDLE,
                                 "VkImportMemoryFdInfoKHR::handleType: only opaque file descriptors are imported");
        }
        return keep(device, Memory::import(fd->fd, size), made);
    }
    const auto* host = findInChain<VkImportMemoryHostPointerInfoEXT>(info.pNext);
    if (host != nullptr && host->handleType != 0) return importHost(device, *host, size, made);
    const auto* exported = findInChain<VkExportMemoryAllocateInfo>(info.pNext);
    if (exported != nullptr && (exported->handleTypes & ~VkExternalMemoryHandleTypeFlags{kFd}) != 0) {
        return device.report("vkAllocateMemory", VK_ERROR_FEATURE_NOT_PRESENT,
                             "VkExportMemoryAllocateInfo::handleTypes: only opaque file descriptors are exported");
    }
    if (exported != nullptr && exported->handleTypes != 0) return keep(device, Memory::createShared(size), made);
    Result<std::unique_ptr<Memory>> own = Memory::create(device.runtime->desc().allocator, size);
    if (!own) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    made = std::move(own).value();
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetMemoryFdKHR(VkDevice device, const VkMemoryGetFdInfoKHR* pGetFdInfo, int* pFd) {
    return guarded([&] {
        *pFd = -1;
        const Memory& memory = *object(pGetFdInfo->memory)->memory;
        if (pGetFdInfo->handleType != kFd || !memory.shared()) {
            return object(device)->report("vkGetMemoryFdKHR", VK_ERROR_UNKNOWN,
                                          "the memory was not allocated to be exported as an opaque file descriptor");
        }
        *pFd = memory.exportFd();
        return *pFd >= 0 ? VK_SUCCESS : VK_ERROR_TOO_MANY_OBJECTS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL GetMemoryFdPropertiesKHR(VkDevice device, VkExternalMemoryHandleTypeFlagBits, int,
                                                        VkMemoryFdPropertiesKHR* pMemoryFdProperties) {
    return guarded([&] {
        // Opaque handles say nothing of themselves, and there are no others.
        pMemoryFdProperties->memoryTypeBits = 0;
        return object(device)->report("vkGetMemoryFdPropertiesKHR", VK_ERROR_INVALID_EXTERNAL_HANDLE,
                                      "there are no handles by file descriptor but opaque ones");
    });
}

VKAPI_ATTR VkResult VKAPI_CALL
GetMemoryHostPointerPropertiesEXT(VkDevice, VkExternalMemoryHandleTypeFlagBits handleType, const void*,
                                  VkMemoryHostPointerPropertiesEXT* pMemoryHostPointerProperties) {
    pMemoryHostPointerProperties->memoryTypeBits = handleType == kHost ? 1 : 0;
    return handleType == kHost ? VK_SUCCESS : VK_ERROR_INVALID_EXTERNAL_HANDLE;
}

VKAPI_ATTR void VKAPI_CALL
GetPhysicalDeviceExternalBufferProperties(VkPhysicalDevice, const VkPhysicalDeviceExternalBufferInfo* pInfo,
                                          VkExternalBufferProperties* pExternalBufferProperties) {
    // Buffers with flags, sparse and protected ones, do not exist.
    pExternalBufferProperties->externalMemoryProperties =
        pInfo->flags == 0 ? externalMemoryProperties(pInfo->handleType) : VkExternalMemoryProperties{};
}

}  // namespace vernier::vulkan
