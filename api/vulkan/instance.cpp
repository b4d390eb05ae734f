#include "api/vulkan/instance.h"

#include <cstdio>

#include "api/vulkan/allocation.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"

namespace vernier::vulkan {

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceExtensionProperties(const char* pLayerName, uint32_t* pPropertyCount,
                                                                    VkExtensionProperties* pProperties) {
    if (pLayerName != nullptr) return VK_ERROR_LAYER_NOT_PRESENT;
    return enumerateExtensions(ExtensionScope::instance, pPropertyCount, pProperties);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceVersion(uint32_t* pApiVersion) {
    *pApiVersion = kApiVersion;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceLayerProperties(uint32_t* pPropertyCount, VkLayerProperties*) {
    *pPropertyCount = 0;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateInstance(const VkInstanceCreateInfo* pCreateInfo,
                                              const VkAllocationCallbacks* pAllocator, VkInstance* pInstance) {
    return guarded([&] {
        const Result<Configuration> configuration = readConfiguration();
        if (!configuration) {
            // No messenger can hear it yet, and "no device" would be a riddle.
            std::fprintf(stderr, "vernier: vkCreateInstance: %s\n", configuration.error().message.c_str());
            return VK_ERROR_INITIALIZATION_FAILED;
        }
        ExtensionSet extensions;
        const char* missing = nullptr;
        const VkResult selected = selectExtensions(
            ExtensionScope::instance, {pCreateInfo->ppEnabledExtensionNames, pCreateInfo->enabledExtensionCount},
            extensions, missing);
        if (selected != VK_SUCCESS) {
            if (configuration->log) {
                std::fprintf(stderr, "vernier: vkCreateInstance: no instance extension %s\n", missing);
            }
            return selected;
        }
        const VkResult created = createHandle(pAllocator, pInstance, *configuration);
        if (created != VK_SUCCESS) return created;
        object(*pInstance)->extensions = extensions;
        object(*pInstance)->messages.setLog(configuration->log);
        if (Status status = object(*pInstance)->explainLog.open(configuration->explain); !status) {
            std::fprintf(stderr, "vernier: %s\n", status.error().message.c_str());
            destroyHandle(pAllocator, *pInstance);
            return VK_ERROR_INITIALIZATION_FAILED;
        }
        return VK_SUCCESS;
    });
}

VKAPI_ATTR void VKAPI_CALL DestroyInstance(VkInstance instance, const VkAllocationCallbacks* pAllocator) {
    destroyHandle(pAllocator, instance);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumeratePhysicalDevices(VkInstance instance, uint32_t* pPhysicalDeviceCount,
                                                        VkPhysicalDevice* pPhysicalDevices) {
    OutputArray<VkPhysicalDevice> output(pPhysicalDeviceCount, pPhysicalDevices);
    for (const auto& device : object(instance)->physicalDevices) output.add(handleOf<VkPhysicalDevice>(device.get()));
    return output.result();
}

}  // namespace vernier::vulkan
