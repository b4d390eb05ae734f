// Extensions of a Vulkan device that scenes may ask for: which there are, with the features that go with them.
#pragma once

#include "base/result.h"

#include <vulkan/vulkan.h>

#include <vector>

namespace vernier::conformance {

// X(name of the member, extension, structure of its features, type of that structure)
#define VERNIER_FEATURE_EXTENSIONS(X)                                                                            \
    X(customBorders, VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME, VkPhysicalDeviceCustomBorderColorFeaturesEXT,    \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CUSTOM_BORDER_COLOR_FEATURES_EXT)                                        \
    X(lines, VK_EXT_LINE_RASTERIZATION_EXTENSION_NAME, VkPhysicalDeviceLineRasterizationFeaturesEXT,             \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_LINE_RASTERIZATION_FEATURES_EXT)                                         \
    X(provokingVertex, VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME, VkPhysicalDeviceProvokingVertexFeaturesEXT,       \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT)                                           \
    X(clipControl, VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME, VkPhysicalDeviceDepthClipControlFeaturesEXT,        \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_CONTROL_FEATURES_EXT)                                         \
    X(depthClip, VK_EXT_DEPTH_CLIP_ENABLE_EXTENSION_NAME, VkPhysicalDeviceDepthClipEnableFeaturesEXT,            \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_ENABLE_FEATURES_EXT)                                          \
    X(float16, VK_KHR_SHADER_FLOAT16_INT8_EXTENSION_NAME, VkPhysicalDeviceShaderFloat16Int8Features,             \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES)                                            \
    X(floatAtomics, VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, VkPhysicalDeviceShaderAtomicFloatFeaturesEXT,     \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT)                                        \
    X(floatAtomics2, VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME, VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_2_FEATURES_EXT)                                      \
    X(barycentric, VK_KHR_FRAGMENT_SHADER_BARYCENTRIC_EXTENSION_NAME,                                            \
      VkPhysicalDeviceFragmentShaderBarycentricFeaturesKHR,                                                      \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_BARYCENTRIC_FEATURES_KHR)                                \
    X(multiview, VK_KHR_MULTIVIEW_EXTENSION_NAME, VkPhysicalDeviceMultiviewFeatures,                             \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES)

// X(name of the member, extension): those without features, or whose features need no asking
#define VERNIER_PLAIN_EXTENSIONS(X)                                     \
    X(maintenance1, VK_KHR_MAINTENANCE_1_EXTENSION_NAME)                \
    X(maintenance2, VK_KHR_MAINTENANCE_2_EXTENSION_NAME)                \
    X(renderPass2, VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME)           \
    X(depthStencilResolve, VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME) \
    X(stencilExport, VK_EXT_SHADER_STENCIL_EXPORT_EXTENSION_NAME)       \
    X(cubicFilters, VK_EXT_FILTER_CUBIC_EXTENSION_NAME)                 \
    X(reductions, VK_EXT_SAMPLER_FILTER_MINMAX_EXTENSION_NAME)          \
    X(sampleLocations, VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME)          \
    X(viewportIndexLayer, VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME)

/// Members by the names of the tables: the features, all off where the extension is absent; for extensions without
/// features whether they are there.
class VulkanExtensions {
  public:
    VulkanExtensions() = default;
    VulkanExtensions(const VulkanExtensions&) = delete;
    VulkanExtensions& operator=(const VulkanExtensions&) = delete;

    /// Asks the device. With `getFeatures` nullptr no extension with features counts as there.
    Status query(VkPhysicalDevice device, PFN_vkGetPhysicalDeviceFeatures2KHR getFeatures);

    /// For vkCreateDevice: the names of all that are there, and the chain that switches on all their features.
    const std::vector<const char*>& names() const { return names_; }
    const void* featureChain() const { return chain_; }

#define VERNIER_MEMBER(name, extension, Struct, type) Struct name{};
    VERNIER_FEATURE_EXTENSIONS(VERNIER_MEMBER)
#undef VERNIER_MEMBER
#define VERNIER_MEMBER(name, extension) bool name = false;
    VERNIER_PLAIN_EXTENSIONS(VERNIER_MEMBER)
#undef VERNIER_MEMBER

  private:
    std::vector<const char*> names_;
    void* chain_ = nullptr;
};

}  // namespace vernier::conformance
