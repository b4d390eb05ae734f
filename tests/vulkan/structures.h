// Vulkan structures in one expression.
#pragma once

#include <vulkan/vulkan_core.h>

namespace vernier::test {

/// A structure with its sType set, `next` as its chain, and everything else zero.
template <class T>
T make(VkStructureType type, const void* next = nullptr) {
    T result{};
    result.sType = type;
    result.pNext = const_cast<void*>(next);
    return result;
}

/// A 2D image of one level, layer and sample.
inline VkImageCreateInfo flatImage(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage) {
    auto info = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    return info;
}

}  // namespace vernier::test
