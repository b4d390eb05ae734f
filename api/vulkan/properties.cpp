// The properties of core versions after 1.0 and of extensions.
#include <cstdio>
#include <cstring>

#include "api/vulkan/chain.h"
#include "api/vulkan/external.h"
#include "api/vulkan/physical_device.h"
#include "api/vulkan/resource_limits.h"
#include "runtime/plan/sample_positions.h"
#include "runtime/raster/depth_resolve.h"
#include "runtime/resource/buffer_view.h"
#include "spirv_interp/capture.h"
#include "spirv_interp/program.h"

namespace vernier::vulkan {
namespace {

constexpr VkShaderStageFlags kSubgroupStages = VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT;

/// A name, a number and what tells apart the devices of this driver.
void fillUuid(uint8_t (&uuid)[VK_UUID_SIZE], const char (&name)[9], uint32_t number, const PhysicalDevice& device) {
    std::memset(uuid, 0, VK_UUID_SIZE);
    std::memcpy(uuid, name, 8);
    std::memcpy(uuid + 8, &number, sizeof number);
    const uint16_t axes = axisBits(device.accuracy);
    std::memcpy(uuid + 12, &axes, sizeof axes);
    uuid[14] = static_cast<uint8_t>(device.isa);
}

void fill(const PhysicalDevice& device, VkPhysicalDeviceIDProperties& p) {
    fillUuid(p.deviceUUID, "VrnrDev ", device.properties.deviceID, device);
    fillUuid(p.driverUUID, "VrnrDrvr", device.properties.driverVersion, device);
    std::memset(p.deviceLUID, 0, sizeof p.deviceLUID);
    p.deviceNodeMask = 0;
    p.deviceLUIDValid = VK_FALSE;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceSubgroupProperties& p) {
    p.subgroupSize = ir::kSubgroupSize;
    p.supportedStages = kSubgroupStages;
    p.supportedOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                            VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
                            VK_SUBGROUP_FEATURE_SHUFFLE_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT |
                            VK_SUBGROUP_FEATURE_CLUSTERED_BIT | VK_SUBGROUP_FEATURE_QUAD_BIT;
    p.quadOperationsInAllStages = VK_TRUE;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceTransformFeedbackPropertiesEXT& p) {
    p.maxTransformFeedbackStreams = ir::kVertexStreams;
    p.maxTransformFeedbackBuffers = kCaptureBuffers;
    p.maxTransformFeedbackBufferSize = UINT32_MAX;  // what counters can tell
    // Bytes of a vertex, with gaps.
    p.maxTransformFeedbackStreamDataSize = p.maxTransformFeedbackBufferDataSize =
        p.maxTransformFeedbackBufferDataStride = kMaxInterfaceComponents * sizeof(float);
    p.transformFeedbackQueries = p.transformFeedbackDraw = VK_TRUE;
    p.transformFeedbackStreamsLinesTriangles = p.transformFeedbackRasterizationStreamSelect = VK_FALSE;
}

/// Khronos gives out VkDriverId; this driver has none, and has passed no conformance tests.
void fill(const PhysicalDevice& device, VkPhysicalDeviceDriverProperties& p) {
    const uint32_t version = device.properties.driverVersion;
    p.driverID = VkDriverId{};
    std::snprintf(p.driverName, sizeof p.driverName, "Vernier");
    std::snprintf(p.driverInfo, sizeof p.driverInfo, "%u.%u.%u", VK_API_VERSION_MAJOR(version),
                  VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
    p.conformanceVersion = {};
}

void fill(const PhysicalDevice&, VkPhysicalDeviceInlineUniformBlockProperties& p) {
    p.maxInlineUniformBlockSize = kMaxInlineUniformBlockBytes;
    p.maxPerStageDescriptorInlineUniformBlocks = p.maxPerStageDescriptorUpdateAfterBindInlineUniformBlocks =
        p.maxDescriptorSetInlineUniformBlocks = p.maxDescriptorSetUpdateAfterBindInlineUniformBlocks =
            kMaxInlineUniformBlocks;
}

/// Descriptors that are updated after they are bound are like others, but for how many there may be.
void fill(const PhysicalDevice& device, VkPhysicalDeviceDescriptorIndexingProperties& p) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    p.maxUpdateAfterBindDescriptorsInAllPools = UINT32_MAX;
    // Lanes that name several descriptors are served one descriptor after the other.
    p.shaderUniformBufferArrayNonUniformIndexingNative = p.shaderSampledImageArrayNonUniformIndexingNative =
        p.shaderStorageBufferArrayNonUniformIndexingNative = p.shaderStorageImageArrayNonUniformIndexingNative =
            p.shaderInputAttachmentArrayNonUniformIndexingNative = VK_FALSE;
    p.robustBufferAccessUpdateAfterBind = VK_TRUE;
    p.quadDivergentImplicitLod = VK_FALSE;
    p.maxPerStageDescriptorUpdateAfterBindSamplers = p.maxPerStageDescriptorUpdateAfterBindUniformBuffers =
        p.maxPerStageDescriptorUpdateAfterBindStorageBuffers = p.maxPerStageDescriptorUpdateAfterBindSampledImages =
            p.maxPerStageDescriptorUpdateAfterBindStorageImages = p.maxPerStageUpdateAfterBindResources =
                p.maxDescriptorSetUpdateAfterBindSamplers = p.maxDescriptorSetUpdateAfterBindUniformBuffers =
                    p.maxDescriptorSetUpdateAfterBindStorageBuffers = p.maxDescriptorSetUpdateAfterBindSampledImages =
                        p.maxDescriptorSetUpdateAfterBindStorageImages = kMaxDescriptorsPerSet;
    p.maxPerStageDescriptorUpdateAfterBindInputAttachments = p.maxDescriptorSetUpdateAfterBindInputAttachments =
        limits.maxPerStageDescriptorInputAttachments;
    p.maxDescriptorSetUpdateAfterBindUniformBuffersDynamic = limits.maxDescriptorSetUniformBuffersDynamic;
    p.maxDescriptorSetUpdateAfterBindStorageBuffersDynamic = limits.maxDescriptorSetStorageBuffersDynamic;
}

/// There is one size.
void fill(const PhysicalDevice&, VkPhysicalDeviceSubgroupSizeControlProperties& p) {
    p.minSubgroupSize = p.maxSubgroupSize = ir::kSubgroupSize;
    p.maxComputeWorkgroupSubgroups = kMaxWorkGroupInvocations / ir::kSubgroupSize;
    p.requiredSubgroupSizeStages = kSubgroupStages;
}

/// Texels are read wherever they lie, but loads of whole texels want them aligned to themselves.
void fill(const PhysicalDevice&, VkPhysicalDeviceTexelBufferAlignmentProperties& p) {
    p.storageTexelBufferOffsetAlignmentBytes = p.uniformTexelBufferOffsetAlignmentBytes = kTexelBufferAlignment;
    p.storageTexelBufferOffsetSingleTexelAlignment = p.uniformTexelBufferOffsetSingleTexelAlignment = VK_TRUE;
}

/// Every operation of every width rounds to nearest even, and keeps denormals, signs of zeros, infinities and NaNs;
/// there is no other mode.
void fill(const PhysicalDevice&, VkPhysicalDeviceFloatControlsProperties& p) {
    p.denormBehaviorIndependence = p.roundingModeIndependence = VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_NONE;
    for (VkBool32* mode :
         {&p.shaderSignedZeroInfNanPreserveFloat16, &p.shaderSignedZeroInfNanPreserveFloat32,
          &p.shaderSignedZeroInfNanPreserveFloat64, &p.shaderDenormPreserveFloat16, &p.shaderDenormPreserveFloat32,
          &p.shaderDenormPreserveFloat64, &p.shaderRoundingModeRTEFloat16, &p.shaderRoundingModeRTEFloat32,
          &p.shaderRoundingModeRTEFloat64}) {
        *mode = VK_TRUE;
    }
    for (VkBool32* mode :
         {&p.shaderDenormFlushToZeroFloat16, &p.shaderDenormFlushToZeroFloat32, &p.shaderDenormFlushToZeroFloat64,
          &p.shaderRoundingModeRTZFloat16, &p.shaderRoundingModeRTZFloat32, &p.shaderRoundingModeRTZFloat64}) {
        *mode = VK_FALSE;
    }
}

void fill(const PhysicalDevice&, VkPhysicalDeviceProtectedMemoryProperties& p) {
    p.protectedNoFault = VK_FALSE;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceMaintenance3Properties& p) {
    p.maxPerSetDescriptors = kMaxDescriptorsPerSet;
    p.maxMemoryAllocationSize = kMaxAllocation;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceRobustness2PropertiesEXT& p) {
    // Buffers end with the last byte of their range.
    p.robustStorageBufferAccessSizeAlignment = p.robustUniformBufferAccessSizeAlignment = 1;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceExternalMemoryHostPropertiesEXT& p) {
    p.minImportedHostPointerAlignment = hostPointerAlignment();
}

void fill(const PhysicalDevice&, VkPhysicalDeviceTimelineSemaphoreProperties& p) {
    p.maxTimelineSemaphoreValueDifference = UINT64_MAX;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceFragmentShaderBarycentricPropertiesKHR& p) {
    p.triStripVertexOrderIndependentOfProvokingVertex = VK_FALSE;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceProvokingVertexPropertiesEXT& p) {
    p.provokingVertexModePerPipeline = VK_TRUE;
    p.transformFeedbackPreservesTriangleFanProvokingVertex = VK_TRUE;
}

void fill(const PhysicalDevice&, VkPhysicalDevicePointClippingProperties& p) {
    p.pointClippingBehavior = VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceDepthStencilResolveProperties& p) {
    p.supportedDepthResolveModes = kDepthResolveModes;
    p.supportedStencilResolveModes = kStencilResolveModes;
    p.independentResolveNone = p.independentResolve = VK_TRUE;
}

void fill(const PhysicalDevice& device, VkPhysicalDeviceLineRasterizationPropertiesEXT& p) {
    p.lineSubPixelPrecisionBits = device.accuracy.subPixelBits;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceMultiviewProperties& p) {
    p.maxMultiviewViewCount = kMaxViews;
    p.maxMultiviewInstanceIndex = UINT32_MAX;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceSampleLocationsPropertiesEXT& p) {
    p.sampleLocationSampleCounts = kSampleCounts;
    p.maxSampleLocationGridSize = {1, 1};
    p.sampleLocationCoordinateRange[0] = 0;
    p.sampleLocationCoordinateRange[1] = 1 - 1.0f / (1u << kSampleLocationBits);
    p.sampleLocationSubPixelBits = kSampleLocationBits;
    p.variableSampleLocations = VK_TRUE;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceVertexAttributeDivisorPropertiesEXT& p) {
    p.maxVertexAttribDivisor = UINT32_MAX;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceMultiDrawPropertiesEXT& p) {
    p.maxMultiDrawCount = UINT32_MAX;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceCustomBorderColorPropertiesEXT& p) {
    p.maxCustomBorderColorSamplers = UINT32_MAX;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceSamplerFilterMinmaxProperties& p) {
    p.filterMinmaxSingleComponentFormats = VK_TRUE;
    p.filterMinmaxImageComponentMapping = VK_TRUE;
}

void fill(const PhysicalDevice&, VkPhysicalDevicePushDescriptorPropertiesKHR& p) {
    p.maxPushDescriptors = kMaxPushDescriptors;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceMaintenance4Properties& p) {
    p.maxBufferSize = kMaxAllocation;
}

void fill(const PhysicalDevice&, VkPhysicalDeviceExtendedDynamicState3PropertiesEXT& p) {
    p.dynamicPrimitiveTopologyUnrestricted = VK_TRUE;
}

void fill(const PhysicalDevice& device, VkPhysicalDeviceGraphicsPipelineLibraryPropertiesEXT& p) {
    // Else linking moves work between shaders (ShaderProgram::join()).
    p.graphicsPipelineLibraryFastLinking = device.accuracy.math != MathTier::fast ? VK_TRUE : VK_FALSE;
    p.graphicsPipelineLibraryIndependentInterpolationDecoration = VK_TRUE;  // those of the fragment shader count
}

void fill(const PhysicalDevice&, VkPhysicalDeviceShaderIntegerDotProductProperties& p) {
    // None of them is faster than the products and sums written out.
    VkPhysicalDeviceShaderIntegerDotProductProperties none{};
    none.sType = p.sType;
    none.pNext = p.pNext;
    p = none;
}

/// What fills structures of one type.
struct Filler {
    VkStructureType type;
    void (*fill)(const PhysicalDevice& device, void* structure);
};

template <class Structure>
constexpr Filler fillerOf() {
    return {kStructureType<Structure>,
            [](const PhysicalDevice& device, void* structure) { fill(device, *static_cast<Structure*>(structure)); }};
}

constexpr Filler kFillers[] = {
    fillerOf<VkPhysicalDeviceCustomBorderColorPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceDepthStencilResolveProperties>(),
    fillerOf<VkPhysicalDeviceDescriptorIndexingProperties>(),
    fillerOf<VkPhysicalDeviceDriverProperties>(),
    fillerOf<VkPhysicalDeviceExtendedDynamicState3PropertiesEXT>(),
    fillerOf<VkPhysicalDeviceExternalMemoryHostPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceFloatControlsProperties>(),
    fillerOf<VkPhysicalDeviceFragmentShaderBarycentricPropertiesKHR>(),
    fillerOf<VkPhysicalDeviceGraphicsPipelineLibraryPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceIDProperties>(),
    fillerOf<VkPhysicalDeviceInlineUniformBlockProperties>(),
    fillerOf<VkPhysicalDeviceLineRasterizationPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceMaintenance3Properties>(),
    fillerOf<VkPhysicalDeviceMaintenance4Properties>(),
    fillerOf<VkPhysicalDeviceMultiDrawPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceMultiviewProperties>(),
    fillerOf<VkPhysicalDevicePointClippingProperties>(),
    fillerOf<VkPhysicalDeviceProtectedMemoryProperties>(),
    fillerOf<VkPhysicalDeviceProvokingVertexPropertiesEXT>(),
    fillerOf<VkPhysicalDevicePushDescriptorPropertiesKHR>(),
    fillerOf<VkPhysicalDeviceRobustness2PropertiesEXT>(),
    fillerOf<VkPhysicalDeviceSampleLocationsPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceSamplerFilterMinmaxProperties>(),
    fillerOf<VkPhysicalDeviceShaderIntegerDotProductProperties>(),
    fillerOf<VkPhysicalDeviceSubgroupProperties>(),
    fillerOf<VkPhysicalDeviceSubgroupSizeControlProperties>(),
    fillerOf<VkPhysicalDeviceTexelBufferAlignmentProperties>(),
    fillerOf<VkPhysicalDeviceTimelineSemaphoreProperties>(),
    fillerOf<VkPhysicalDeviceTransformFeedbackPropertiesEXT>(),
    fillerOf<VkPhysicalDeviceVertexAttributeDivisorPropertiesEXT>(),
};

}  // namespace

void fillPropertyChain(const PhysicalDevice& device, void* chain) {
    for (auto* node = static_cast<VkBaseOutStructure*>(chain); node != nullptr; node = node->pNext) {
        for (const Filler& filler : kFillers) {
            if (filler.type == node->sType) filler.fill(device, node);
        }
    }
}

}  // namespace vernier::vulkan
