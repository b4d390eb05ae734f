// What the device is and can do, as the vkGetPhysicalDevice* queries tell it. Features and limits are
// computed once.
#pragma once

#include <vulkan/vulkan_core.h>

#include "api/vulkan/configuration.h"
#include "api/vulkan/handle.h"
#include "runtime/accuracy.h"

namespace vernier::vulkan {

/// Not a PCI id, and not one of the ids Khronos gives out by VkVendorId (those are 0x1000x): "VRN" in ASCII.
inline constexpr uint32_t kVendorId = 0x56524E;

struct PhysicalDevice : Dispatchable {
    PhysicalDevice(Instance& owner, const Configuration& settings, const DeviceAccuracy& chosen);

    Instance& instance;
    Configuration configuration;
    Isa isa;
    Accuracy accuracy;
    VkPhysicalDeviceFeatures features;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
};

/// The features of Vulkan 1.0 that the device has (features.def).
VkPhysicalDeviceFeatures supportedFeatures();
/// Fills every feature structure of the chain that the driver knows, VkPhysicalDeviceFeatures2 among them
/// (features.cpp).
void fillFeatureChain(void* chain);
/// VK_ERROR_FEATURE_NOT_PRESENT when something is wanted that is not there; `missing` names it
/// (features.cpp).
VkResult checkFeatures(const VkDeviceCreateInfo& info, const char*& missing);

/// The limits of the specification's table "Required Limits" (limits.cpp).
VkPhysicalDeviceLimits deviceLimits(const VkPhysicalDeviceFeatures& features, const Accuracy& accuracy);
/// Fills every property structure of the chain that the driver knows, but for those of whole core versions
/// (properties.cpp).
void fillPropertyChain(const PhysicalDevice& device, void* chain);
/// Fills those (core_properties.cpp).
void fillCoreProperties(const PhysicalDevice& device, void* chain);
/// The position of every axis of accuracy, two bits each.
uint16_t axisBits(const Accuracy& accuracy);

/// The memory that allocations may come from (memory_heap.cpp): three quarters of what this process may use.
VkDeviceSize heapSize();

}  // namespace vernier::vulkan
