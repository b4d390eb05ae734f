#include "api/vulkan/physical_device.h"

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "api/vulkan/chain.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/extension.h"
#include "api/vulkan/instance.h"
#include "runtime/limits.h"

namespace vernier::vulkan {
namespace {

/// Pipeline caches may travel between processes when this is the same: it names the version of the driver and
/// everything that could change what it computes.
void fillCacheUuid(const PhysicalDevice& device, uint8_t (&uuid)[VK_UUID_SIZE]) {
    const char name[VK_UUID_SIZE + 1] = "Vernier";
    std::memcpy(uuid, name, VK_UUID_SIZE);
    const uint32_t version = device.properties.driverVersion;
    std::memcpy(uuid + 8, &version, sizeof version);
    const uint16_t axes = axisBits(device.accuracy);
    std::memcpy(uuid + 12, &axes, sizeof axes);
    uuid[14] = static_cast<uint8_t>(device.isa);
}

VkPhysicalDeviceMemoryProperties oneHeap(VkDeviceSize size) {
    VkPhysicalDeviceMemoryProperties memory{};
    memory.memoryHeapCount = 1;
    memory.memoryHeaps[0] = {size, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    memory.memoryTypeCount = 1;
    memory.memoryTypes[0] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                 VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                             0};
    return memory;
}

/// One queue, in order.
constexpr VkQueueFamilyProperties kQueueFamily{
    VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 64, {1, 1, 1}};

}  // namespace

uint16_t axisBits(const Accuracy& accuracy) {
    uint16_t place = 0;  // among all combinations of positions
    for (const Axis& axis : axes()) place = static_cast<uint16_t>(place * axis.positions.size() + axis.get(accuracy));
    return place;
}

PhysicalDevice::PhysicalDevice(Instance& owner, const Configuration& settings, const DeviceAccuracy& chosen)
    : instance(owner),
      configuration(settings),
      isa(bestIsaUpTo(settings.maxIsa)),
      accuracy(chosen.accuracy),
      features(supportedFeatures()),
      properties{},
      memory(oneHeap(heapSize())) {
    properties.apiVersion = kApiVersion;
    properties.driverVersion =
        VK_MAKE_API_VERSION(0, VERNIER_VERSION_MAJOR, VERNIER_VERSION_MINOR, VERNIER_VERSION_PATCH);
    properties.vendorID = kVendorId;
    properties.deviceID = 1;
    properties.deviceType = settings.deviceType;
    const std::string accuracyText = accuracy == accuracyOf(Profile::standard) ? "" : ", " + chosen.name;
    std::snprintf(properties.deviceName, sizeof properties.deviceName, "Vernier (software, %s%s)",
                  std::string(isaName(isa)).c_str(), accuracyText.c_str());
    fillCacheUuid(*this, properties.pipelineCacheUUID);
    properties.limits = deviceLimits(features, accuracy);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFeatures(VkPhysicalDevice physicalDevice,
                                                     VkPhysicalDeviceFeatures* pFeatures) {
    *pFeatures = object(physicalDevice)->features;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFeatures2(VkPhysicalDevice, VkPhysicalDeviceFeatures2* pFeatures) {
    fillFeatureChain(pFeatures);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties(VkPhysicalDevice physicalDevice,
                                                       VkPhysicalDeviceProperties* pProperties) {
    *pProperties = object(physicalDevice)->properties;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties2(VkPhysicalDevice physicalDevice,
                                                        VkPhysicalDeviceProperties2* pProperties) {
    pProperties->properties = object(physicalDevice)->properties;
    fillPropertyChain(*object(physicalDevice), pProperties->pNext);
    fillCoreProperties(*object(physicalDevice), pProperties->pNext);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice, uint32_t* pQueueFamilyPropertyCount,
                                                                  VkQueueFamilyProperties* pQueueFamilyProperties) {
    OutputArray<VkQueueFamilyProperties> output(pQueueFamilyPropertyCount, pQueueFamilyProperties);
    output.add(kQueueFamily);
    (void)output.result();
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties2(VkPhysicalDevice,
                                                                   uint32_t* pQueueFamilyPropertyCount,
                                                                   VkQueueFamilyProperties2* pQueueFamilyProperties) {
    OutputArray<VkQueueFamilyProperties2> output(pQueueFamilyPropertyCount, pQueueFamilyProperties);
    if (auto* entry = output.next()) entry->queueFamilyProperties = kQueueFamily;
    (void)output.result();
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties(VkPhysicalDevice physicalDevice,
                                                             VkPhysicalDeviceMemoryProperties* pMemoryProperties) {
    *pMemoryProperties = object(physicalDevice)->memory;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties2(VkPhysicalDevice physicalDevice,
                                                              VkPhysicalDeviceMemoryProperties2* pMemoryProperties) {
    pMemoryProperties->memoryProperties = object(physicalDevice)->memory;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMultisamplePropertiesEXT(VkPhysicalDevice, VkSampleCountFlagBits samples,
                                                                     VkMultisamplePropertiesEXT* pProperties) {
    // All pixels have the same locations.
    const bool supported = isSampleCount(static_cast<uint32_t>(samples));
    pProperties->maxSampleLocationGridSize = supported ? VkExtent2D{1, 1} : VkExtent2D{0, 0};
}

// Layers that are tools add themselves.
VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceToolProperties(VkPhysicalDevice, uint32_t* pToolCount,
                                                               VkPhysicalDeviceToolProperties*) {
    *pToolCount = 0;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateDeviceExtensionProperties(VkPhysicalDevice, const char* pLayerName,
                                                                  uint32_t* pPropertyCount,
                                                                  VkExtensionProperties* pProperties) {
    if (pLayerName != nullptr) return VK_ERROR_LAYER_NOT_PRESENT;
    return enumerateExtensions(ExtensionScope::device, pPropertyCount, pProperties);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateDeviceLayerProperties(VkPhysicalDevice, uint32_t* pPropertyCount,
                                                              VkLayerProperties*) {
    *pPropertyCount = 0;
    return VK_SUCCESS;
}

}  // namespace vernier::vulkan
