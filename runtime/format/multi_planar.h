// Formats whose components lie in two or three planes, each an image by itself: "Formats Requiring Sampler Y'CbCr
// Conversion for VK_IMAGE_ASPECT_COLOR_BIT Image Views" in the Vulkan specification.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <span>

namespace vernier {

inline constexpr uint32_t kMaxPlanes = 3;

/// Plane 0 holds G (luma); the others B and R, or both in that order. All components have the same number of bits.
struct MultiPlanarFormat {
    VkFormat format;
    const char* name;  // without VK_FORMAT_
    uint32_t planeCount;
    std::array<VkFormat, kMaxPlanes> planes;           // the formats that the planes are compatible with
    uint32_t chromaWidthDivisor, chromaHeightDivisor;  // of planes 1 and 2 against plane 0
    uint32_t bits;                                     // of each component

    uint32_t widthDivisor(uint32_t plane) const { return plane == 0 ? 1 : chromaWidthDivisor; }
    uint32_t heightDivisor(uint32_t plane) const { return plane == 0 ? 1 : chromaHeightDivisor; }
};

/// nullptr: not a multi-planar format that Vernier knows.
const MultiPlanarFormat* findMultiPlanar(VkFormat format);

std::span<const MultiPlanarFormat> multiPlanarFormats();

/// What all of them can do, in optimal and linear tiling.
inline constexpr VkFormatFeatureFlags kMultiPlanarFeatures =
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
    VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT |
    VK_FORMAT_FEATURE_MIDPOINT_CHROMA_SAMPLES_BIT | VK_FORMAT_FEATURE_COSITED_CHROMA_SAMPLES_BIT |
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_YCBCR_CONVERSION_LINEAR_FILTER_BIT |
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_YCBCR_CONVERSION_SEPARATE_RECONSTRUCTION_FILTER_BIT |
    VK_FORMAT_FEATURE_SAMPLED_IMAGE_YCBCR_CONVERSION_CHROMA_RECONSTRUCTION_EXPLICIT_BIT |
    VK_FORMAT_FEATURE_DISJOINT_BIT;

/// Which plane an aspect names; kMaxPlanes for aspects that are not exactly one plane.
constexpr uint32_t planeOfAspect(VkImageAspectFlags aspects) {
    return aspects == VK_IMAGE_ASPECT_PLANE_0_BIT   ? 0
           : aspects == VK_IMAGE_ASPECT_PLANE_1_BIT ? 1
           : aspects == VK_IMAGE_ASPECT_PLANE_2_BIT ? 2
                                                    : kMaxPlanes;
}

}  // namespace vernier
