// Device groups (VK_KHR_device_group, VK_KHR_device_group_creation): each is of one device.
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/instance.h"

namespace vernier::vulkan {

VKAPI_ATTR VkResult VKAPI_CALL
EnumeratePhysicalDeviceGroups(VkInstance instance, uint32_t* pPhysicalDeviceGroupCount,
                              VkPhysicalDeviceGroupProperties* pPhysicalDeviceGroupProperties) {
    OutputArray<VkPhysicalDeviceGroupProperties> output(pPhysicalDeviceGroupCount, pPhysicalDeviceGroupProperties);
    for (const auto& device : object(instance)->physicalDevices) {
        VkPhysicalDeviceGroupProperties* group = output.next();
        if (group == nullptr) continue;
        group->physicalDeviceCount = 1;
        group->physicalDevices[0] = handleOf<VkPhysicalDevice>(device.get());
        group->subsetAllocation = VK_FALSE;
    }
    return output.result();
}

// No device has a peer whose memory it could reach.
VKAPI_ATTR void VKAPI_CALL GetDeviceGroupPeerMemoryFeatures(VkDevice, uint32_t, uint32_t, uint32_t,
                                                            VkPeerMemoryFeatureFlags* pPeerMemoryFeatures) {
    *pPeerMemoryFeatures = 0;
}

// Commands run on the only device, whatever valid mask is set.
VKAPI_ATTR void VKAPI_CALL CmdSetDeviceMask(VkCommandBuffer, uint32_t) {}

}  // namespace vernier::vulkan
