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

/// A name, a number and what tells apart the devices of this driver.
void fillUuid(uint8_t (&uuid)[VK_UUID_SIZE], const char (&name)[9], uint32_t number, const PhysicalDevice& device) {
    std::memset(uuid, 0, VK_UUID_SIZE);
    std::memcpy(uuid, name, 8);
    std::memcpy(uuid + 8, &number, sizeof number);
    const uint16_t axes = axisBits(device.accuracy);
    std::memcpy(uuid + 12, &axes, sizeof axes);
    uuid[14] = static_cast<uint8_t>(device.isa);
}

void setIds(const PhysicalDevice& device, VkPhysicalDeviceIDProperties& p) {
    fillUuid(p.deviceUUID, "VrnrDev ", device.properties.deviceID, device);
    fillUuid(p.driverUUID, "VrnrDrvr", device.properties.driverVersion, device);
    std::memset(p.deviceLUID, 0, sizeof p.deviceLUID);
    p.deviceNodeMask = 0;
    p.deviceLUIDValid = VK_FALSE;
}

void setSubgroups(VkPhysicalDeviceSubgroupProperties& p) {
    p.subgroupSize = ir::kSubgroupSize;
    p.supportedStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    p.supportedOperations = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                            VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT |
                            VK_SUBGROUP_FEATURE_SHUFFLE_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT |
                            VK_SUBGROUP_FEATURE_CLUSTERED_BIT | VK_SUBGROUP_FEATURE_QUAD_BIT;
    p.quadOperationsInAllStages = VK_TRUE;
}

void setTransformFeedback(VkPhysicalDeviceTransformFeedbackPropertiesEXT& p) {
    p.maxTransformFeedbackStreams = 1;
    p.maxTransformFeedbackBuffers = kCaptureBuffers;
    p.maxTransformFeedbackBufferSize = UINT32_MAX;  // what counters can tell
    // Bytes of a vertex, with gaps.
    p.maxTransformFeedbackStreamDataSize = p.maxTransformFeedbackBufferDataSize =
        p.maxTransformFeedbackBufferDataStride = kMaxInterfaceComponents * sizeof(float);
    p.transformFeedbackQueries = p.transformFeedbackDraw = VK_TRUE;
    p.transformFeedbackStreamsLinesTriangles = p.transformFeedbackRasterizationStreamSelect = VK_FALSE;
}

/// Khronos gives out VkDriverId; this driver has none, and has passed no conformance tests.
void setDriver(const PhysicalDevice& device, VkPhysicalDeviceDriverProperties& p) {
    const uint32_t version = device.properties.driverVersion;
    p.driverID = VkDriverId{};
    std::snprintf(p.driverName, sizeof p.driverName, "Vernier");
    std::snprintf(p.driverInfo, sizeof p.driverInfo, "%u.%u.%u", VK_API_VERSION_MAJOR(version),
                  VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
    p.conformanceVersion = {};
}

void setInlineBlocks(VkPhysicalDeviceInlineUniformBlockProperties& p) {
    p.maxInlineUniformBlockSize = kMaxInlineUniformBlockBytes;
    p.maxPerStageDescriptorInlineUniformBlocks = p.maxPerStageDescriptorUpdateAfterBindInlineUniformBlocks =
        p.maxDescriptorSetInlineUniformBlocks = p.maxDescriptorSetUpdateAfterBindInlineUniformBlocks =
            kMaxInlineUniformBlocks;
}

/// Descriptors that are updated after they are bound are like others, but for how many there may be.
void setDescriptorIndexing(const VkPhysicalDeviceLimits& limits, VkPhysicalDeviceDescriptorIndexingProperties& p) {
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
void setSubgroupSizes(VkPhysicalDeviceSubgroupSizeControlProperties& p) {
    p.minSubgroupSize = p.maxSubgroupSize = ir::kSubgroupSize;
    p.maxComputeWorkgroupSubgroups = kMaxWorkGroupInvocations / ir::kSubgroupSize;
    p.requiredSubgroupSizeStages =
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
}

/// Texels are read wherever they lie, but loads of whole texels want them aligned to themselves.
void setTexelAlignments(VkPhysicalDeviceTexelBufferAlignmentProperties& p) {
    p.storageTexelBufferOffsetAlignmentBytes = p.uniformTexelBufferOffsetAlignmentBytes = kTexelBufferAlignment;
    p.storageTexelBufferOffsetSingleTexelAlignment = p.uniformTexelBufferOffsetSingleTexelAlignment = VK_TRUE;
}

/// Every operation of every width rounds to nearest even, and keeps denormals, signs of zeros, infinities and NaNs;
/// there is no other mode.
void setFloatControls(VkPhysicalDeviceFloatControlsProperties& p) {
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

}  // namespace

void fillPropertyChain(const PhysicalDevice& device, void* chain) {
    if (auto* p = findInChain<VkPhysicalDeviceIDProperties>(chain)) setIds(device, *p);
    if (auto* p = findInChain<VkPhysicalDeviceSubgroupProperties>(chain)) setSubgroups(*p);
    if (auto* p = findInChain<VkPhysicalDeviceProtectedMemoryProperties>(chain)) p->protectedNoFault = VK_FALSE;
    if (auto* p = findInChain<VkPhysicalDeviceMaintenance3Properties>(chain)) {
        p->maxPerSetDescriptors = kMaxDescriptorsPerSet;
        p->maxMemoryAllocationSize = kMaxAllocation;
    }
    if (auto* p = findInChain<VkPhysicalDeviceRobustness2PropertiesEXT>(chain)) {
        // Buffers end with the last byte of their range.
        p->robustStorageBufferAccessSizeAlignment = p->robustUniformBufferAccessSizeAlignment = 1;
    }
    if (auto* p = findInChain<VkPhysicalDeviceExternalMemoryHostPropertiesEXT>(chain)) {
        p->minImportedHostPointerAlignment = hostPointerAlignment();
    }
    if (auto* p = findInChain<VkPhysicalDeviceTimelineSemaphoreProperties>(chain)) {
        p->maxTimelineSemaphoreValueDifference = UINT64_MAX;
    }
    if (auto* p = findInChain<VkPhysicalDeviceFragmentShaderBarycentricPropertiesKHR>(chain)) {
        p->triStripVertexOrderIndependentOfProvokingVertex = VK_FALSE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceProvokingVertexPropertiesEXT>(chain)) {
        p->provokingVertexModePerPipeline = VK_TRUE;
        p->transformFeedbackPreservesTriangleFanProvokingVertex = VK_TRUE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceTransformFeedbackPropertiesEXT>(chain)) setTransformFeedback(*p);
    if (auto* p = findInChain<VkPhysicalDevicePointClippingProperties>(chain)) {
        p->pointClippingBehavior = VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES;
    }
    if (auto* p = findInChain<VkPhysicalDeviceDepthStencilResolveProperties>(chain)) {
        p->supportedDepthResolveModes = kDepthResolveModes;
        p->supportedStencilResolveModes = kStencilResolveModes;
        p->independentResolveNone = p->independentResolve = VK_TRUE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceLineRasterizationPropertiesEXT>(chain)) {
        p->lineSubPixelPrecisionBits = device.accuracy.subPixelBits;
    }
    if (auto* p = findInChain<VkPhysicalDeviceMultiviewProperties>(chain)) {
        p->maxMultiviewViewCount = kMaxViews;
        p->maxMultiviewInstanceIndex = UINT32_MAX;
    }
    if (auto* p = findInChain<VkPhysicalDeviceSampleLocationsPropertiesEXT>(chain)) {
        p->sampleLocationSampleCounts = kSampleCounts;
        p->maxSampleLocationGridSize = {1, 1};
        p->sampleLocationCoordinateRange[0] = 0;
        p->sampleLocationCoordinateRange[1] = 1 - 1.0f / (1u << kSampleLocationBits);
        p->sampleLocationSubPixelBits = kSampleLocationBits;
        p->variableSampleLocations = VK_TRUE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceVertexAttributeDivisorPropertiesEXT>(chain)) {
        p->maxVertexAttribDivisor = UINT32_MAX;
    }
    if (auto* p = findInChain<VkPhysicalDeviceMultiDrawPropertiesEXT>(chain)) p->maxMultiDrawCount = UINT32_MAX;
    if (auto* p = findInChain<VkPhysicalDeviceCustomBorderColorPropertiesEXT>(chain)) {
        p->maxCustomBorderColorSamplers = UINT32_MAX;
    }
    if (auto* p = findInChain<VkPhysicalDeviceSamplerFilterMinmaxProperties>(chain)) {
        p->filterMinmaxSingleComponentFormats = VK_TRUE;
        p->filterMinmaxImageComponentMapping = VK_TRUE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceFloatControlsProperties>(chain)) setFloatControls(*p);
    if (auto* p = findInChain<VkPhysicalDeviceDriverProperties>(chain)) setDriver(device, *p);
    if (auto* p = findInChain<VkPhysicalDevicePushDescriptorPropertiesKHR>(chain)) {
        p->maxPushDescriptors = kMaxPushDescriptors;
    }
    if (auto* p = findInChain<VkPhysicalDeviceInlineUniformBlockProperties>(chain)) setInlineBlocks(*p);
    if (auto* p = findInChain<VkPhysicalDeviceDescriptorIndexingProperties>(chain)) {
        setDescriptorIndexing(device.properties.limits, *p);
    }
    if (auto* p = findInChain<VkPhysicalDeviceMaintenance4Properties>(chain)) p->maxBufferSize = kMaxAllocation;
    if (auto* p = findInChain<VkPhysicalDeviceSubgroupSizeControlProperties>(chain)) setSubgroupSizes(*p);
    if (auto* p = findInChain<VkPhysicalDeviceTexelBufferAlignmentProperties>(chain)) setTexelAlignments(*p);
    if (auto* p = findInChain<VkPhysicalDeviceExtendedDynamicState3PropertiesEXT>(chain)) {
        p->dynamicPrimitiveTopologyUnrestricted = VK_TRUE;
    }
    if (auto* p = findInChain<VkPhysicalDeviceShaderIntegerDotProductProperties>(chain)) {
        // None of them is faster than the products and sums written out.
        const VkBaseOutStructure head{p->sType, static_cast<VkBaseOutStructure*>(p->pNext)};
        *p = {};
        p->sType = head.sType;
        p->pNext = head.pNext;
    }
}

}  // namespace vernier::vulkan
