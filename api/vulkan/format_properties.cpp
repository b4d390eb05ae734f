// What can be done with formats and images: the runtime's format table, less what this driver leaves out.
#include <algorithm>
#include <bit>

#include "api/vulkan/chain.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/enumerate.h"
#include "api/vulkan/external.h"
#include "api/vulkan/format_properties.h"
#include "api/vulkan/physical_device.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/format/multi_planar.h"
#include "runtime/limits.h"

namespace vernier::vulkan {
namespace {

struct UsageNeed {
    VkImageUsageFlagBits usage;
    VkFormatFeatureFlags anyOf;
};
constexpr UsageNeed kUsageNeeds[] = {
    {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_FORMAT_FEATURE_TRANSFER_SRC_BIT},
    {VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_FORMAT_FEATURE_TRANSFER_DST_BIT},
    {VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT},
    {VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
    {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT,
     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
    {VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT,
     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
    // An image needs nothing more for it.
    {VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT,
     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
};
constexpr VkImageUsageFlags kKnownUsages = [] {
    VkImageUsageFlags all = 0;
    for (const auto& need : kUsageNeeds) all |= need.usage;
    return all;
}();

// Aliases and changing sample locations ask for nothing: the same description always gives the same layout, and depths
// are kept as they are.
constexpr VkImageCreateFlags kKnownFlags =
    VK_IMAGE_CREATE_ALIAS_BIT | VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT |
    VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT | VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT |
    VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT |
    VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT | VK_IMAGE_CREATE_DISJOINT_BIT |
    VK_IMAGE_CREATE_MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_BIT_EXT;
// Usages that views of another format may bring to an image whose own format has them not.
constexpr VkImageUsageFlags kExtendedUsages = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;

// What multi-planar images, which are flat and of one layer, cannot be.
constexpr VkImageCreateFlags kFlagsOfPlain = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT |
                                             VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT |
                                             VK_IMAGE_CREATE_SAMPLE_LOCATIONS_COMPATIBLE_DEPTH_BIT_EXT;

bool flagsFit(VkImageType type, VkImageCreateFlags flags) {
    if ((flags & ~kKnownFlags) != 0) return false;
    if ((flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) != 0 && type != VK_IMAGE_TYPE_2D) return false;
    constexpr VkImageCreateFlags kSlices =
        VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT | VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
    return (flags & kSlices) == 0 || type == VK_IMAGE_TYPE_3D;
}

VkSampleCountFlags sampleCounts(VkFormatFeatureFlags features, VkImageType type, VkImageTiling tiling,
                                VkImageUsageFlags usage, VkImageCreateFlags flags) {
    constexpr VkFormatFeatureFlags kAttachment =
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    const bool multisampled = tiling == VK_IMAGE_TILING_OPTIMAL && type == VK_IMAGE_TYPE_2D &&
                              (flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) == 0 && (features & kAttachment) != 0 &&
                              (usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0;
    return multisampled ? kSampleCounts : VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT};
}

/// As VkFormatFeatureFlags2: with what has no bit among the first 31.
VkFormatFeatureFlags2 wideFeatures(VkFormat format, VkFormatFeatureFlags features) {
    VkFormatFeatureFlags2 wide = features;
    constexpr VkFormatFeatureFlags kStorage =
        VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
    if ((features & kStorage) != 0) {
        wide |=
            VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT | VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    }
    const FormatInfo* info = findFormat(format);  // of several planes: none
    if ((features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT) != 0 && info != nullptr &&
        (info->aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
        wide |= VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT;
    }
    return wide;
}

VkDeviceSize maxResourceSize(const PhysicalDevice& device) {
    return std::max(device.memory.memoryHeaps[0].size, VkDeviceSize{1} << 31);
}

VkExtent3D maxExtent(VkImageType type) {
    switch (type) {
        case VK_IMAGE_TYPE_1D:
            return {kMaxImageDimension2D, 1, 1};
        case VK_IMAGE_TYPE_2D:
            return {kMaxImageDimension2D, kMaxImageDimension2D, 1};
        default:
            return {kMaxImageDimension3D, kMaxImageDimension3D, kMaxImageDimension3D};
    }
}

}  // namespace

VkFormatProperties formatProperties(VkFormat format) {
    if (findMultiPlanar(format) != nullptr) return {kMultiPlanarFeatures, kMultiPlanarFeatures, 0};
    const FormatInfo* info = findFormat(format);
    if (info == nullptr) return {};
    return {info->linearTilingFeatures, info->optimalTilingFeatures, info->bufferFeatures};
}

VkImageUsageFlags usageOfAspects(const void* chain, VkImageUsageFlags usage) {
    const auto* stencil = findInChain<VkImageStencilUsageCreateInfo>(chain);
    return stencil != nullptr ? usage | stencil->stencilUsage : usage;
}

VkResult imageFormatProperties(const PhysicalDevice& device, VkFormat format, VkImageType type, VkImageTiling tiling,
                               VkImageUsageFlags usage, VkImageCreateFlags flags, VkImageFormatProperties& properties) {
    properties = {};
    const VkFormatProperties formats = formatProperties(format);
    const bool linear = tiling == VK_IMAGE_TILING_LINEAR;
    const VkFormatFeatureFlags features = linear ? formats.linearTilingFeatures : formats.optimalTilingFeatures;
    const bool knownType = type == VK_IMAGE_TYPE_1D || type == VK_IMAGE_TYPE_2D || type == VK_IMAGE_TYPE_3D;
    if (features == 0 || !knownType || (!linear && tiling != VK_IMAGE_TILING_OPTIMAL) || !flagsFit(type, flags)) {
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    if ((usage & ~kKnownUsages) != 0) return VK_ERROR_FORMAT_NOT_SUPPORTED;
    constexpr VkImageCreateFlags kExtended = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
    const VkImageUsageFlags extended = (flags & kExtended) == kExtended ? kExtendedUsages : 0;
    for (const UsageNeed& need : kUsageNeeds) {
        if ((usage & need.usage & ~extended) != 0 && (features & need.anyOf) == 0) return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    const bool depthStencil = (features & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
    if (depthStencil && type == VK_IMAGE_TYPE_3D) return VK_ERROR_FORMAT_NOT_SUPPORTED;

    if (findMultiPlanar(format) != nullptr) {
        if (type != VK_IMAGE_TYPE_2D || (flags & kFlagsOfPlain) != 0) return VK_ERROR_FORMAT_NOT_SUPPORTED;
        properties = {maxExtent(type), 1, 1, VK_SAMPLE_COUNT_1_BIT, maxResourceSize(device)};
        return VK_SUCCESS;
    }
    if ((flags & VK_IMAGE_CREATE_DISJOINT_BIT) != 0) return VK_ERROR_FORMAT_NOT_SUPPORTED;
    properties.maxExtent = maxExtent(type);
    const auto largest = std::max(properties.maxExtent.width, properties.maxExtent.depth);
    properties.maxMipLevels = linear ? 1 : static_cast<uint32_t>(std::bit_width(largest));
    properties.maxArrayLayers = linear || type == VK_IMAGE_TYPE_3D ? 1 : kMaxArrayLayers;
    properties.sampleCounts = sampleCounts(features, type, tiling, usage, flags);
    properties.maxResourceSize = maxResourceSize(device);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties(VkPhysicalDevice, VkFormat format,
                                                             VkFormatProperties* pFormatProperties) {
    *pFormatProperties = formatProperties(format);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFormatProperties2(VkPhysicalDevice, VkFormat format,
                                                              VkFormatProperties2* pFormatProperties) {
    const VkFormatProperties plain = formatProperties(format);
    pFormatProperties->formatProperties = plain;
    if (auto* p = findInChain<VkFormatProperties3>(pFormatProperties->pNext)) {
        p->linearTilingFeatures = wideFeatures(format, plain.linearTilingFeatures);
        p->optimalTilingFeatures = wideFeatures(format, plain.optimalTilingFeatures);
        p->bufferFeatures = wideFeatures(format, plain.bufferFeatures);
    }
    // No format is better than another: samples are read again when all is drawn, as vkCmdResolveImage does.
    if (auto* p = findInChain<VkSubpassResolvePerformanceQueryEXT>(pFormatProperties->pNext)) p->optimal = VK_FALSE;
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties(VkPhysicalDevice physicalDevice, VkFormat format,
                                                                      VkImageType type, VkImageTiling tiling,
                                                                      VkImageUsageFlags usage, VkImageCreateFlags flags,
                                                                      VkImageFormatProperties* pImageFormatProperties) {
    return imageFormatProperties(*object(physicalDevice), format, type, tiling, usage, flags, *pImageFormatProperties);
}

VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceImageFormatProperties2(
    VkPhysicalDevice physicalDevice, const VkPhysicalDeviceImageFormatInfo2* pImageFormatInfo,
    VkImageFormatProperties2* pImageFormatProperties) {
    const auto* external = findInChain<VkPhysicalDeviceExternalImageFormatInfo>(pImageFormatInfo->pNext);
    const VkExternalMemoryHandleTypeFlags handleType = external != nullptr ? external->handleType : 0;
    if (auto* p = findInChain<VkExternalImageFormatProperties>(pImageFormatProperties->pNext)) {
        p->externalMemoryProperties = externalMemoryProperties(handleType);
    }
    if (auto* p = findInChain<VkSamplerYcbcrConversionImageFormatProperties>(pImageFormatProperties->pNext)) {
        p->combinedImageSamplerDescriptorCount = 1;
    }
    if (auto* p = findInChain<VkFilterCubicImageViewImageFormatPropertiesEXT>(pImageFormatProperties->pNext)) {
        const auto* view = findInChain<VkPhysicalDeviceImageViewImageFormatInfoEXT>(pImageFormatInfo->pNext);
        const bool flat = view != nullptr && (view->imageViewType == VK_IMAGE_VIEW_TYPE_2D ||
                                              view->imageViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY);
        p->filterCubic = flat && (formatProperties(pImageFormatInfo->format).optimalTilingFeatures &
                                  VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT) != 0;
        p->filterCubicMinmax = VK_FALSE;
    }
    if (handleType != 0 && externalMemoryProperties(handleType).compatibleHandleTypes == 0) {
        pImageFormatProperties->imageFormatProperties = {};
        return VK_ERROR_FORMAT_NOT_SUPPORTED;
    }
    return imageFormatProperties(*object(physicalDevice), pImageFormatInfo->format, pImageFormatInfo->type,
                                 pImageFormatInfo->tiling,
                                 usageOfAspects(pImageFormatInfo->pNext, pImageFormatInfo->usage),
                                 pImageFormatInfo->flags, pImageFormatProperties->imageFormatProperties);
}

// Sparse resources are not supported: nothing to list.

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceSparseImageFormatProperties(VkPhysicalDevice, VkFormat, VkImageType,
                                                                        VkSampleCountFlagBits, VkImageUsageFlags,
                                                                        VkImageTiling, uint32_t* pPropertyCount,
                                                                        VkSparseImageFormatProperties*) {
    *pPropertyCount = 0;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceSparseImageFormatProperties2(VkPhysicalDevice,
                                                                         const VkPhysicalDeviceSparseImageFormatInfo2*,
                                                                         uint32_t* pPropertyCount,
                                                                         VkSparseImageFormatProperties2*) {
    *pPropertyCount = 0;
}

}  // namespace vernier::vulkan
