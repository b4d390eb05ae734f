// Buffers and buffer views.
#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/device.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/external.h"
#include "api/vulkan/memory.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/resource/buffer_view.h"

namespace vernier::vulkan {
namespace {

bool hasAddress(const Buffer& buffer) {
    return buffer.data() != nullptr && (buffer.usage() & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL CreateBuffer(VkDevice device, const VkBufferCreateInfo* pCreateInfo,
                                            const VkAllocationCallbacks* pAllocator, VkBuffer* pBuffer) {
    return guarded([&] {
        if (pCreateInfo->flags != 0) {
            return object(device)->report("vkCreateBuffer", VK_ERROR_FEATURE_NOT_PRESENT,
                                          "flags: sparse and protected buffers are not supported");
        }
        const auto* external = findInChain<VkExternalMemoryBufferCreateInfo>(pCreateInfo->pNext);
        if (external != nullptr && !areExternalMemoryTypes(external->handleTypes)) {
            return object(device)->report("vkCreateBuffer", VK_ERROR_FEATURE_NOT_PRESENT,
                                          "handleTypes: only opaque file descriptors and host memory are supported");
        }
        if (pCreateInfo->size > kMaxAllocation) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        return createHandle(pAllocator, pBuffer, pCreateInfo->size, pCreateInfo->usage);
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyBuffer(VkDevice device, VkBuffer buffer, const VkAllocationCallbacks* pAllocator) {
    if (const Buffer* of = object(buffer); of != nullptr && hasAddress(*of))
        object(device)->runtime->addresses().remove(of->data(), of->size());
    destroyHandle(pAllocator, buffer);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateBufferView(VkDevice device, const VkBufferViewCreateInfo* pCreateInfo,
                                                const VkAllocationCallbacks* pAllocator, VkBufferView* pView) {
    return guarded([&] {
        const BufferViewInfo info{pCreateInfo->format, pCreateInfo->offset, pCreateInfo->range};
        Result<BufferView> view =
            BufferView::create(*object(pCreateInfo->buffer), info, object(device)->runtime->isa());
        if (!view) return object(device)->report("vkCreateBufferView", view.error());
        return createHandle(pAllocator, pView, std::move(view).value());
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyBufferView(VkDevice, VkBufferView bufferView,
                                             const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, bufferView);
}

VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements(VkDevice, VkBuffer buffer,
                                                       VkMemoryRequirements* pMemoryRequirements) {
    *pMemoryRequirements = memoryRequirements(object(buffer)->size());
}

VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements2(VkDevice, const VkBufferMemoryRequirementsInfo2* pInfo,
                                                        VkMemoryRequirements2* pMemoryRequirements) {
    pMemoryRequirements->memoryRequirements = memoryRequirements(object(pInfo->buffer)->size());
    fillRequirementChain(pMemoryRequirements->pNext);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceBufferMemoryRequirements(VkDevice, const VkDeviceBufferMemoryRequirements* pInfo,
                                                             VkMemoryRequirements2* pMemoryRequirements) {
    pMemoryRequirements->memoryRequirements = memoryRequirements(pInfo->pCreateInfo->size);
    fillRequirementChain(pMemoryRequirements->pNext);
}

VKAPI_ATTR VkResult VKAPI_CALL BindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory,
                                                VkDeviceSize memoryOffset) {
    return guarded([&] {
        if (const Status fits = checkBinding(object(memory), memoryOffset, object(buffer)->size()); !fits) {
            return object(device)->report("vkBindBufferMemory", fits.error());
        }
        Buffer& bound = *object(buffer);
        bound.bind(*object(memory)->memory, memoryOffset);
        if (hasAddress(bound)) object(device)->runtime->addresses().add(bound.data(), bound.size());
        return VK_SUCCESS;
    });
}

VKAPI_ATTR VkDeviceAddress VKAPI_CALL GetBufferDeviceAddress(VkDevice, const VkBufferDeviceAddressInfo* pInfo) {
    return reinterpret_cast<uintptr_t>(object(pInfo->buffer)->data());
}

// Addresses cannot be asked for when they are captured (bufferDeviceAddressCaptureReplay).

VKAPI_ATTR uint64_t VKAPI_CALL GetBufferOpaqueCaptureAddress(VkDevice, const VkBufferDeviceAddressInfo*) {
    return 0;
}

VKAPI_ATTR uint64_t VKAPI_CALL GetDeviceMemoryOpaqueCaptureAddress(VkDevice,
                                                                   const VkDeviceMemoryOpaqueCaptureAddressInfo*) {
    return 0;
}

VKAPI_ATTR VkResult VKAPI_CALL BindBufferMemory2(VkDevice device, uint32_t bindInfoCount,
                                                 const VkBindBufferMemoryInfo* pBindInfos) {
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < bindInfoCount; ++i) {
        const VkBindBufferMemoryInfo& bind = pBindInfos[i];
        const VkResult one = BindBufferMemory(device, bind.buffer, bind.memory, bind.memoryOffset);
        if (one != VK_SUCCESS) result = one;
    }
    return result;
}

}  // namespace vernier::vulkan
