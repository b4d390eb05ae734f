// The limits of the device, in the order of the specification's table "Required Limits".
#include <algorithm>

#include "api/vulkan/physical_device.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/geometry/primitive_setup.h"
#include "runtime/geometry/tessellator.h"
#include "runtime/limits.h"
#include "runtime/resource/buffer_view.h"
#include "runtime/resource/memory.h"
#include "runtime/texture/texture.h"
#include "spirv_interp/program.h"
#include "spirv_interp/tessellation.h"

namespace vernier::vulkan {
namespace {

/// Descriptors are structs in host memory: these bounds only keep requests sane.
constexpr uint32_t kMaxDescriptors = 1u << 16;

void setDescriptorLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxTexelBufferElements = kMaxTexelBufferElements;
    limits.maxUniformBufferRange = 1u << 16;
    limits.maxStorageBufferRange = kMaxBufferBytes;
    limits.maxPushConstantsSize = kMaxPushConstantBytes;
    limits.maxBoundDescriptorSets = kMaxDescriptorSets;
    limits.maxPerStageDescriptorSamplers = kMaxDescriptors;
    limits.maxPerStageDescriptorUniformBuffers = kMaxDescriptors;
    limits.maxPerStageDescriptorStorageBuffers = kMaxDescriptors;
    limits.maxPerStageDescriptorSampledImages = kMaxDescriptors;
    limits.maxPerStageDescriptorStorageImages = kMaxDescriptors;
    limits.maxPerStageDescriptorInputAttachments = kMaxColorAttachments;
    limits.maxPerStageResources = kMaxDescriptorsPerSet;
    limits.maxDescriptorSetSamplers = kMaxDescriptors;
    limits.maxDescriptorSetUniformBuffers = kMaxDescriptors;
    limits.maxDescriptorSetUniformBuffersDynamic = 64;
    limits.maxDescriptorSetStorageBuffers = kMaxDescriptors;
    limits.maxDescriptorSetStorageBuffersDynamic = 64;
    limits.maxDescriptorSetSampledImages = kMaxDescriptors;
    limits.maxDescriptorSetStorageImages = kMaxDescriptors;
    limits.maxDescriptorSetInputAttachments = kMaxColorAttachments;
}

void setAlignments(VkPhysicalDeviceLimits& limits) {
    limits.bufferImageGranularity = 1;
    limits.minMemoryMapAlignment = kBufferAlignment;
    limits.minTexelBufferOffsetAlignment = kTexelBufferAlignment;
    limits.minUniformBufferOffsetAlignment = 16;
    limits.minStorageBufferOffsetAlignment = 16;
    limits.optimalBufferCopyOffsetAlignment = 1;
    limits.optimalBufferCopyRowPitchAlignment = 1;
    limits.nonCoherentAtomSize = 1;
}

void setComputeLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxComputeSharedMemorySize = kMaxWorkGroupMemory;
    std::copy_n(kMaxWorkGroupCount, 3, limits.maxComputeWorkGroupCount);
    limits.maxComputeWorkGroupInvocations = kMaxWorkGroupInvocations;
    std::copy_n(kMaxWorkGroupSize, 3, limits.maxComputeWorkGroupSize);
}

void setTessellationLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxTessellationGenerationLevel = kMaxTessellationLevel;
    limits.maxTessellationPatchSize = kMaxPatchVertices;
    limits.maxTessellationControlPerVertexInputComponents = kMaxInterfaceComponents;
    limits.maxTessellationControlPerVertexOutputComponents = kMaxInterfaceComponents;
    limits.maxTessellationControlPerPatchOutputComponents = kMaxInterfaceComponents - 8;  // the levels
    limits.maxTessellationControlTotalOutputComponents = kMaxPatchVertices * kMaxInterfaceComponents;
    limits.maxTessellationEvaluationInputComponents = kMaxInterfaceComponents;
    limits.maxTessellationEvaluationOutputComponents = kMaxInterfaceComponents;
}

void setGeometryLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxGeometryShaderInvocations = ir::kMaxGeometryInvocations;
    limits.maxGeometryInputComponents = kMaxInterfaceComponents;
    limits.maxGeometryOutputComponents = kMaxInterfaceComponents;
    limits.maxGeometryOutputVertices = ir::kMaxGeometryVertices;
    limits.maxGeometryTotalOutputComponents = ir::kMaxGeometryComponents;
}

void setVertexLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxVertexInputAttributes = kMaxVertexAttributes;
    limits.maxVertexInputBindings = kMaxVertexBindings;
    limits.maxVertexInputAttributeOffset = kMaxVertexAttributeOffset;
    limits.maxVertexInputBindingStride = kMaxVertexBindingStride;
    limits.maxVertexOutputComponents = kMaxInterfaceComponents;
}

void setFragmentLimits(VkPhysicalDeviceLimits& limits, const VkPhysicalDeviceFeatures& features) {
    limits.maxFragmentInputComponents = kMaxInterfaceComponents;
    limits.maxFragmentOutputAttachments = kMaxColorAttachments;
    limits.maxFragmentDualSrcAttachments = features.dualSrcBlend ? 1 : 0;
    limits.maxFragmentCombinedOutputResources = kMaxDescriptors;
    if (features.sampleRateShading) {
        limits.subPixelInterpolationOffsetBits = 4;
        limits.minInterpolationOffset = -0.5f;
        limits.maxInterpolationOffset = 0.5f - 1.0f / (1 << 4);
    }
}

void setImageLimits(VkPhysicalDeviceLimits& limits, const VkPhysicalDeviceFeatures& features) {
    limits.maxImageDimension1D = kMaxImageDimension2D;
    limits.maxImageDimension2D = kMaxImageDimension2D;
    limits.maxImageDimension3D = kMaxImageDimension3D;
    limits.maxImageDimensionCube = kMaxImageDimension2D;
    limits.maxImageArrayLayers = kMaxArrayLayers;
    limits.sampledImageColorSampleCounts = kSampleCounts;
    limits.sampledImageIntegerSampleCounts = kSampleCounts;
    limits.sampledImageDepthSampleCounts = kSampleCounts;
    limits.sampledImageStencilSampleCounts = kSampleCounts;
    limits.storageImageSampleCounts = VK_SAMPLE_COUNT_1_BIT;
    limits.subTexelPrecisionBits = 8;
    limits.mipmapPrecisionBits = 8;
    limits.maxSamplerLodBias = kMaxSamplerLodBias;
    limits.maxSamplerAnisotropy = kMaxSamplerAnisotropy;
    limits.minTexelOffset = -8;
    limits.maxTexelOffset = 7;
    if (features.shaderImageGatherExtended) {
        limits.minTexelGatherOffset = -8;
        limits.maxTexelGatherOffset = 7;
    }
}

void setFramebufferLimits(VkPhysicalDeviceLimits& limits) {
    limits.maxFramebufferWidth = limits.maxFramebufferHeight = kMaxImageDimension2D;
    limits.maxFramebufferLayers = kMaxArrayLayers;
    limits.framebufferColorSampleCounts = kSampleCounts;
    limits.framebufferDepthSampleCounts = kSampleCounts;
    limits.framebufferStencilSampleCounts = kSampleCounts;
    limits.framebufferNoAttachmentsSampleCounts = kSampleCounts;
    limits.maxColorAttachments = kMaxColorAttachments;
    limits.maxSampleMaskWords = 1;
    limits.standardSampleLocations = VK_TRUE;
}

/// Of what lies between vertices and fragments.
void setRasterLimits(VkPhysicalDeviceLimits& limits, const VkPhysicalDeviceFeatures& features, uint32_t subPixelBits) {
    limits.subPixelPrecisionBits = subPixelBits;
    limits.maxViewports = features.multiViewport ? kMaxViewports : 1;
    limits.maxViewportDimensions[0] = limits.maxViewportDimensions[1] = kMaxImageDimension2D;
    limits.viewportBoundsRange[0] = -2.0f * kMaxImageDimension2D;
    limits.viewportBoundsRange[1] = 2.0f * kMaxImageDimension2D - 1;
    limits.viewportSubPixelBits = subPixelBits;
    limits.maxClipDistances = features.shaderClipDistance ? kMaxClipDistances : 0;
    limits.maxCullDistances = features.shaderCullDistance ? kMaxClipDistances : 0;
    limits.maxCombinedClipAndCullDistances = std::max(limits.maxClipDistances, limits.maxCullDistances);
    limits.pointSizeRange[0] = kMinPointSize;
    limits.pointSizeRange[1] = kMaxPointSize;
    limits.lineWidthRange[0] = kMinLineWidth;
    limits.lineWidthRange[1] = kMaxLineWidth;
    limits.pointSizeGranularity = limits.lineWidthGranularity = 1.0f / static_cast<float>(1u << subPixelBits);
    limits.strictLines = VK_TRUE;
}

}  // namespace

VkPhysicalDeviceLimits deviceLimits(const VkPhysicalDeviceFeatures& features, const Accuracy& accuracy) {
    // Nothing is sparse: those limits stay 0.
    VkPhysicalDeviceLimits limits{};
    limits.maxMemoryAllocationCount = UINT32_MAX;
    limits.maxSamplerAllocationCount = UINT32_MAX;
    limits.maxDrawIndexedIndexValue = UINT32_MAX;
    limits.maxDrawIndirectCount = features.multiDrawIndirect ? UINT32_MAX : 1;
    limits.timestampComputeAndGraphics = VK_TRUE;
    limits.timestampPeriod = 1;
    limits.discreteQueuePriorities = 2;
    setImageLimits(limits, features);
    setDescriptorLimits(limits);
    setAlignments(limits);
    setComputeLimits(limits);
    setVertexLimits(limits);
    if (features.tessellationShader) setTessellationLimits(limits);
    if (features.geometryShader) setGeometryLimits(limits);
    setRasterLimits(limits, features, accuracy.subPixelBits);
    setFragmentLimits(limits, features);
    setFramebufferLimits(limits);
    return limits;
}

}  // namespace vernier::vulkan
