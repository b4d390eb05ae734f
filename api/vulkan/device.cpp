#include "api/vulkan/device.h"

#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/chain.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/instance.h"
#include "runtime/raster/frame_facts.h"

namespace vernier::vulkan {

Messages& Device::messages() const {
    return physicalDevice.instance.messages;
}

VkResult Device::report(const char* command, VkResult result, std::string_view text) const {
    messages().error(command, {VK_OBJECT_TYPE_DEVICE, reinterpret_cast<uint64_t>(this)}, text);
    return result;
}

VkResult Device::report(const char* command, const Error& error) const {
    return report(command, resultOf(error), error.message);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDevice(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo* pCreateInfo,
                                            const VkAllocationCallbacks* pAllocator, VkDevice* pDevice) {
    return guarded([&] {
        PhysicalDevice& parent = *object(physicalDevice);
        const auto refuse = [&](VkResult result, const std::string& text) {
            parent.instance.messages.error("vkCreateDevice",
                                           {VK_OBJECT_TYPE_PHYSICAL_DEVICE, reinterpret_cast<uint64_t>(&parent)}, text);
            return result;
        };
        ExtensionSet extensions = parent.instance.extensions;
        const char* missing = nullptr;
        if (selectExtensions(ExtensionScope::device,
                             {pCreateInfo->ppEnabledExtensionNames, pCreateInfo->enabledExtensionCount}, extensions,
                             missing) != VK_SUCCESS) {
            return refuse(VK_ERROR_EXTENSION_NOT_PRESENT, std::string("no device extension ") + missing);
        }
        if (checkFeatures(*pCreateInfo, missing) != VK_SUCCESS) {
            return refuse(VK_ERROR_FEATURE_NOT_PRESENT, std::string("no feature ") + missing);
        }
        for (uint32_t i = 0; i < pCreateInfo->queueCreateInfoCount; ++i) {
            const VkDeviceQueueCreateInfo& queue = pCreateInfo->pQueueCreateInfos[i];
            if (queue.queueFamilyIndex != 0 || queue.queueCount > 1 || queue.flags != 0) {
                return refuse(VK_ERROR_INITIALIZATION_FAILED, "there is one queue family with one unprotected queue");
            }
        }
        DeviceDesc desc;
        desc.threads = parent.configuration.threads;
        desc.maxIsa = parent.isa;
        desc.accuracy = parent.accuracy;
        desc.skips = parent.configuration.skips;
        if (ExplainLog& log = parent.instance.explainLog; log.enabled())
            desc.report = [&log](const SubmissionReport& ran) {
                log.submission(frameFacts(ran.commands, ran.statistics));
            };
        if (parent.configuration.validate) {
            desc.misuse = [&parent](const std::string& text) {
                const auto handle = reinterpret_cast<uint64_t>(&parent);
                parent.instance.messages.error("vkCmdDraw, vkCmdDispatch", {VK_OBJECT_TYPE_PHYSICAL_DEVICE, handle},
                                               text);
            };
        }
        Result<std::unique_ptr<vernier::Device>> made = vernier::Device::create(desc);
        if (!made) return refuse(resultOf(made.error()), made.error().message);
        return createHandle(pAllocator, pDevice, parent, extensions, std::move(made).value());
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyDevice(VkDevice device, const VkAllocationCallbacks* pAllocator) {
    if (device != VK_NULL_HANDLE && object(device)->validates()) {
        const VkDeviceSize left = object(device)->allocated;
        if (left != 0) {
            (void)object(device)->report("vkDestroyDevice", VK_SUCCESS,
                                         std::to_string(left) + " bytes of device memory are still allocated");
        }
    }
    destroyHandle(pAllocator, device);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue(VkDevice device, uint32_t queueFamilyIndex, uint32_t queueIndex,
                                          VkQueue* pQueue) {
    const bool exists = queueFamilyIndex == 0 && queueIndex == 0;
    *pQueue = exists ? handleOf<VkQueue>(&object(device)->queue) : VK_NULL_HANDLE;
}

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue2(VkDevice device, const VkDeviceQueueInfo2* pQueueInfo, VkQueue* pQueue) {
    *pQueue = VK_NULL_HANDLE;
    if (pQueueInfo->flags == 0) GetDeviceQueue(device, pQueueInfo->queueFamilyIndex, pQueueInfo->queueIndex, pQueue);
}

VKAPI_ATTR VkResult VKAPI_CALL DeviceWaitIdle(VkDevice device) {
    return guarded([&] {
        object(device)->runtime->queue().waitIdle();
        return object(device)->lost() ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
    });
}

VKAPI_ATTR VkResult VKAPI_CALL QueueWaitIdle(VkQueue queue) {
    return DeviceWaitIdle(handleOf<VkDevice>(&object(queue)->device));
}

}  // namespace vernier::vulkan
