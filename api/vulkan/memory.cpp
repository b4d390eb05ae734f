#include "api/vulkan/memory.h"

#include <utility>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/external.h"
#include "api/vulkan/resource_limits.h"

namespace vernier::vulkan {
namespace {

/// Takes `size` bytes out of the heap's budget; false when there are not so many left.
bool reserve(Device& device, VkDeviceSize size) {
    const VkDeviceSize heap = device.physicalDevice.memory.memoryHeaps[0].size;
    VkDeviceSize used = device.allocated.load();
    do {
        if (size > heap || used > heap - size) return false;
    } while (!device.allocated.compare_exchange_weak(used, used + size));
    return true;
}

}  // namespace

VkMemoryRequirements memoryRequirements(VkDeviceSize size) {
    const VkDeviceSize rounded = (size + kBufferAlignment - 1) / kBufferAlignment * kBufferAlignment;
    return {rounded, kBufferAlignment, 1};
}

void fillRequirementChain(void* chain) {
    if (auto* dedicated = findInChain<VkMemoryDedicatedRequirements>(chain)) {
        dedicated->prefersDedicatedAllocation = VK_FALSE;
        dedicated->requiresDedicatedAllocation = VK_FALSE;
    }
}

Status checkBinding(const DeviceMemory* memory, VkDeviceSize offset, VkDeviceSize size) {
    if (memory == nullptr) return invalidArgument("memory is VK_NULL_HANDLE");
    if (offset % kBufferAlignment != 0) {
        return invalidArgument("memoryOffset " + std::to_string(offset) + " is not a multiple of " +
                               std::to_string(kBufferAlignment));
    }
    const VkDeviceSize available = memory->memory->size();
    if (offset > available || available - offset < size) {
        return invalidArgument("memoryOffset " + std::to_string(offset) + " + " + std::to_string(size) +
                               " bytes do not fit in " + std::to_string(available) + " bytes of memory");
    }
    return {};
}

VKAPI_ATTR VkResult VKAPI_CALL AllocateMemory(VkDevice device, const VkMemoryAllocateInfo* pAllocateInfo,
                                              const VkAllocationCallbacks* pAllocator, VkDeviceMemory* pMemory) {
    return guarded([&] {
        Device& owner = *object(device);
        const VkDeviceSize size = pAllocateInfo->allocationSize;
        if (pAllocateInfo->memoryTypeIndex != 0) {
            return owner.report("vkAllocateMemory", VK_ERROR_UNKNOWN, "there is one memory type, 0");
        }
        if (size > kMaxAllocation || !reserve(owner, size)) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        std::unique_ptr<Memory> made;
        VkResult result = makeMemory(owner, *pAllocateInfo, made);
        if (result == VK_SUCCESS) result = createHandle(pAllocator, pMemory, std::move(made));
        if (result != VK_SUCCESS) owner.allocated -= size;
        return result;
    });
}

VKAPI_ATTR void VKAPI_CALL FreeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* pAllocator) {
    if (memory != VK_NULL_HANDLE) object(device)->allocated -= object(memory)->memory->size();
    destroyHandle(pAllocator, memory);
}

VKAPI_ATTR VkResult VKAPI_CALL MapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                                         VkMemoryMapFlags, void** ppData) {
    return guarded([&] {
        const Memory& mapped = *object(memory)->memory;
        const bool whole = size == VK_WHOLE_SIZE;
        if (offset > mapped.size() || (!whole && size > mapped.size() - offset)) {
            return object(device)->report("vkMapMemory", VK_ERROR_MEMORY_MAP_FAILED, "the range is outside the memory");
        }
        if (std::exchange(object(memory)->mapped, true) && object(device)->validates()) {
            (void)object(device)->report("vkMapMemory", VK_SUCCESS, "the memory is mapped already");
        }
        *ppData = mapped.data() + offset;
        return VK_SUCCESS;
    });
}

VKAPI_ATTR void VKAPI_CALL UnmapMemory(VkDevice device, VkDeviceMemory memory) {
    if (!std::exchange(object(memory)->mapped, false) && object(device)->validates()) {
        (void)object(device)->report("vkUnmapMemory", VK_SUCCESS, "the memory is not mapped");
    }
}

// The one memory type is coherent: there is nothing to flush.

VKAPI_ATTR VkResult VKAPI_CALL FlushMappedMemoryRanges(VkDevice, uint32_t, const VkMappedMemoryRange*) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL InvalidateMappedMemoryRanges(VkDevice, uint32_t, const VkMappedMemoryRange*) {
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetDeviceMemoryCommitment(VkDevice, VkDeviceMemory memory,
                                                     VkDeviceSize* pCommittedMemoryInBytes) {
    *pCommittedMemoryInBytes = object(memory)->memory->size();
}

}  // namespace vernier::vulkan
