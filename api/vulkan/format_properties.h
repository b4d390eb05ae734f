// Format and image queries that creation checks share with the vkGetPhysicalDevice* commands.
#pragma once

#include <vulkan/vulkan_core.h>

#include "api/vulkan/handle.h"
#include "runtime/format/format.h"

namespace vernier::vulkan {

/// All zero for a format the device does not know.
VkFormatProperties formatProperties(VkFormat format);

/// The usages of all aspects: `usage` with what VkImageStencilUsageCreateInfo in the chain says of stencil.
VkImageUsageFlags usageOfAspects(const void* chain, VkImageUsageFlags usage);

/// vkGetPhysicalDeviceImageFormatProperties.
VkResult imageFormatProperties(const PhysicalDevice& device, VkFormat format, VkImageType type, VkImageTiling tiling,
                               VkImageUsageFlags usage, VkImageCreateFlags flags, VkImageFormatProperties& properties);

}  // namespace vernier::vulkan
