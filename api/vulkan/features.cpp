// Which features of Vulkan the device has: what the runtime does, no more.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "api/vulkan/chain.h"
#include "api/vulkan/physical_device.h"

namespace vernier::vulkan {
namespace {

// X-macro over the members of VkPhysicalDeviceFeatures that are supported.
#define VERNIER_FEATURES(X)                    \
    X(robustBufferAccess)                      \
    X(fullDrawIndexUint32)                     \
    X(imageCubeArray)                          \
    X(independentBlend)                        \
    X(sampleRateShading)                       \
    X(dualSrcBlend)                            \
    X(logicOp)                                 \
    X(multiDrawIndirect)                       \
    X(drawIndirectFirstInstance)               \
    X(depthClamp)                              \
    X(depthBiasClamp)                          \
    X(depthBounds)                             \
    X(multiViewport)                           \
    X(fillModeNonSolid)                        \
    X(wideLines)                               \
    X(largePoints)                             \
    X(alphaToOne)                              \
    X(samplerAnisotropy)                       \
    X(textureCompressionETC2)                  \
    X(textureCompressionASTC_LDR)              \
    X(textureCompressionBC)                    \
    X(occlusionQueryPrecise)                   \
    X(pipelineStatisticsQuery)                 \
    X(vertexPipelineStoresAndAtomics)          \
    X(fragmentStoresAndAtomics)                \
    X(shaderImageGatherExtended)               \
    X(shaderStorageImageExtendedFormats)       \
    X(shaderStorageImageReadWithoutFormat)     \
    X(shaderStorageImageWriteWithoutFormat)    \
    X(shaderUniformBufferArrayDynamicIndexing) \
    X(shaderSampledImageArrayDynamicIndexing)  \
    X(shaderStorageBufferArrayDynamicIndexing) \
    X(shaderStorageImageArrayDynamicIndexing)  \
    X(shaderClipDistance)                      \
    X(shaderCullDistance)                      \
    X(shaderFloat64)                           \
    X(shaderInt64)                             \
    X(shaderInt16)                             \
    X(shaderResourceMinLod)                    \
    X(inheritedQueries)

#define VERNIER_PRIMITIVES_GENERATED_FEATURES(X)                                                                \
    X(VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT, primitivesGeneratedQuery, true)                      \
    X(VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT, primitivesGeneratedQueryWithRasterizerDiscard, true) \
    X(VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT, primitivesGeneratedQueryWithNonZeroStreams, false)

// The members of the structures that extensions bring, and whether they are supported.
#define VERNIER_EXTENSION_FEATURES(X)                                                                                 \
    X(VkPhysicalDeviceTimelineSemaphoreFeatures, timelineSemaphore, true)                                             \
    X(VkPhysicalDeviceDepthClipEnableFeaturesEXT, depthClipEnable, true)                                              \
    X(VkPhysicalDeviceDepthClipControlFeaturesEXT, depthClipControl, true)                                            \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, rectangularLines, true)                                           \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, bresenhamLines, true)                                             \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, smoothLines, true)                                                \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, stippledRectangularLines, true)                                   \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, stippledBresenhamLines, true)                                     \
    X(VkPhysicalDeviceLineRasterizationFeaturesEXT, stippledSmoothLines, true)                                        \
    X(VkPhysicalDeviceMultiviewFeatures, multiview, true)                                                             \
    X(VkPhysicalDeviceMultiviewFeatures, multiviewGeometryShader, false)                                              \
    X(VkPhysicalDeviceMultiviewFeatures, multiviewTessellationShader, false)                                          \
    X(VkPhysicalDeviceFragmentShaderBarycentricFeaturesKHR, fragmentShaderBarycentric, true)                          \
    X(VkPhysicalDeviceProvokingVertexFeaturesEXT, provokingVertexLast, true)                                          \
    X(VkPhysicalDeviceProvokingVertexFeaturesEXT, transformFeedbackPreservesProvokingVertex, true)                    \
    X(VkPhysicalDeviceTransformFeedbackFeaturesEXT, transformFeedback, true)                                          \
    X(VkPhysicalDeviceTransformFeedbackFeaturesEXT, geometryStreams, false)                                           \
    VERNIER_PRIMITIVES_GENERATED_FEATURES(X)                                                                          \
    X(VkPhysicalDevice16BitStorageFeatures, storageBuffer16BitAccess, true)                                           \
    X(VkPhysicalDevice16BitStorageFeatures, uniformAndStorageBuffer16BitAccess, true)                                 \
    X(VkPhysicalDevice16BitStorageFeatures, storagePushConstant16, true)                                              \
    X(VkPhysicalDevice16BitStorageFeatures, storageInputOutput16, true)                                               \
    X(VkPhysicalDevice8BitStorageFeatures, storageBuffer8BitAccess, true)                                             \
    X(VkPhysicalDevice8BitStorageFeatures, uniformAndStorageBuffer8BitAccess, true)                                   \
    X(VkPhysicalDevice8BitStorageFeatures, storagePushConstant8, true)                                                \
    X(VkPhysicalDeviceShaderFloat16Int8Features, shaderFloat16, true)                                                 \
    X(VkPhysicalDeviceShaderFloat16Int8Features, shaderInt8, true)                                                    \
    X(VkPhysicalDeviceShaderAtomicInt64Features, shaderBufferInt64Atomics, true)                                      \
    X(VkPhysicalDeviceShaderAtomicInt64Features, shaderSharedInt64Atomics, true)                                      \
    X(VkPhysicalDeviceProtectedMemoryFeatures, protectedMemory, false)                                                \
    X(VkPhysicalDeviceSamplerYcbcrConversionFeatures, samplerYcbcrConversion, true)                                   \
    X(VkPhysicalDeviceRobustness2FeaturesEXT, robustBufferAccess2, true)                                              \
    X(VkPhysicalDeviceRobustness2FeaturesEXT, robustImageAccess2, true)                                               \
    X(VkPhysicalDeviceRobustness2FeaturesEXT, nullDescriptor, true)                                                   \
    X(VkPhysicalDeviceImageRobustnessFeatures, robustImageAccess, true)                                               \
    X(VkPhysicalDeviceShaderSubgroupExtendedTypesFeatures, shaderSubgroupExtendedTypes, true)                         \
    X(VkPhysicalDeviceImagelessFramebufferFeatures, imagelessFramebuffer, true)                                       \
    X(VkPhysicalDeviceVariablePointersFeatures, variablePointersStorageBuffer, true)                                  \
    X(VkPhysicalDeviceVariablePointersFeatures, variablePointers, true)                                               \
    X(VkPhysicalDeviceShaderDrawParametersFeatures, shaderDrawParameters, true)                                       \
    X(VkPhysicalDeviceUniformBufferStandardLayoutFeatures, uniformBufferStandardLayout, true)                         \
    X(VkPhysicalDeviceScalarBlockLayoutFeatures, scalarBlockLayout, true)                                             \
    X(VkPhysicalDeviceShaderDemoteToHelperInvocationFeatures, shaderDemoteToHelperInvocation, true)                   \
    X(VkPhysicalDeviceShaderTerminateInvocationFeatures, shaderTerminateInvocation, true)                             \
    X(VkPhysicalDeviceShaderIntegerDotProductFeatures, shaderIntegerDotProduct, true)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderBufferFloat32Atomics, true)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderBufferFloat32AtomicAdd, true)                               \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderBufferFloat64Atomics, true)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderBufferFloat64AtomicAdd, true)                               \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderSharedFloat32Atomics, true)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderSharedFloat32AtomicAdd, true)                               \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderSharedFloat64Atomics, true)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderSharedFloat64AtomicAdd, true)                               \
    X(VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR, pipelineExecutableInfo, true)                          \
    X(VkPhysicalDeviceConditionalRenderingFeaturesEXT, conditionalRendering, true)                                    \
    X(VkPhysicalDeviceConditionalRenderingFeaturesEXT, inheritedConditionalRendering, true)                           \
    X(VkPhysicalDeviceCustomBorderColorFeaturesEXT, customBorderColors, true)                                         \
    X(VkPhysicalDeviceCustomBorderColorFeaturesEXT, customBorderColorWithoutFormat, true)                             \
    X(VkPhysicalDeviceBorderColorSwizzleFeaturesEXT, borderColorSwizzle, true)                                        \
    X(VkPhysicalDeviceBorderColorSwizzleFeaturesEXT, borderColorSwizzleFromImage, true)                               \
    X(VkPhysicalDeviceNonSeamlessCubeMapFeaturesEXT, nonSeamlessCubeMap, true)                                        \
    X(VkPhysicalDeviceColorWriteEnableFeaturesEXT, colorWriteEnable, true)                                            \
    X(VkPhysicalDeviceHostQueryResetFeatures, hostQueryReset, true)                                                   \
    X(VkPhysicalDeviceIndexTypeUint8FeaturesEXT, indexTypeUint8, true)                                                \
    X(VkPhysicalDeviceMultiDrawFeaturesEXT, multiDraw, true)                                                          \
    X(VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT, primitiveTopologyListRestart, true)                    \
    X(VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT, primitiveTopologyPatchListRestart, false)              \
    X(VkPhysicalDeviceSeparateDepthStencilLayoutsFeatures, separateDepthStencilLayouts, true)                         \
    X(VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT, vertexAttributeInstanceRateDivisor, true)                    \
    X(VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT, vertexAttributeInstanceRateZeroDivisor, true)                \
    X(VkPhysicalDeviceImageViewMinLodFeaturesEXT, minLod, true)                                                       \
    X(VkPhysicalDeviceImage2DViewOf3DFeaturesEXT, image2DViewOf3D, true)                                              \
    X(VkPhysicalDeviceImage2DViewOf3DFeaturesEXT, sampler2DViewOf3D, true)                                            \
    X(VkPhysicalDevice4444FormatsFeaturesEXT, formatA4R4G4B4, true)                                                   \
    X(VkPhysicalDevice4444FormatsFeaturesEXT, formatA4B4G4R4, true)                                                   \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderImageFloat32Atomics, true)                                  \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, shaderImageFloat32AtomicAdd, true)                                \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, sparseImageFloat32Atomics, false)                                 \
    X(VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, sparseImageFloat32AtomicAdd, false)                               \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderBufferFloat16Atomics, false)                               \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderBufferFloat16AtomicAdd, false)                             \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderBufferFloat16AtomicMinMax, false)                          \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderBufferFloat32AtomicMinMax, true)                           \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderBufferFloat64AtomicMinMax, true)                           \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderSharedFloat16Atomics, false)                               \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderSharedFloat16AtomicAdd, false)                             \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderSharedFloat16AtomicMinMax, false)                          \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderSharedFloat32AtomicMinMax, true)                           \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderSharedFloat64AtomicMinMax, true)                           \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, shaderImageFloat32AtomicMinMax, true)                            \
    X(VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, sparseImageFloat32AtomicMinMax, false)                           \
    X(VkPhysicalDeviceDynamicRenderingFeatures, dynamicRendering, true)                                               \
    X(VkPhysicalDeviceSynchronization2Features, synchronization2, true)                                               \
    X(VkPhysicalDeviceMaintenance4Features, maintenance4, true)                                                       \
    X(VkPhysicalDevicePrivateDataFeatures, privateData, true)                                                         \
    X(VkPhysicalDevicePipelineCreationCacheControlFeatures, pipelineCreationCacheControl, true)                       \
    X(VkPhysicalDeviceZeroInitializeWorkgroupMemoryFeatures, shaderZeroInitializeWorkgroupMemory, true)               \
    X(VkPhysicalDeviceSubgroupSizeControlFeatures, subgroupSizeControl, true)                                         \
    X(VkPhysicalDeviceSubgroupSizeControlFeatures, computeFullSubgroups, true)                                        \
    X(VkPhysicalDeviceTexelBufferAlignmentFeaturesEXT, texelBufferAlignment, true)                                    \
    X(VkPhysicalDeviceExtendedDynamicStateFeaturesEXT, extendedDynamicState, true)                                    \
    X(VkPhysicalDeviceExtendedDynamicState2FeaturesEXT, extendedDynamicState2, true)                                  \
    X(VkPhysicalDeviceExtendedDynamicState2FeaturesEXT, extendedDynamicState2LogicOp, true)                           \
    X(VkPhysicalDeviceExtendedDynamicState2FeaturesEXT, extendedDynamicState2PatchControlPoints, false)               \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3DepthClampEnable, true)                  \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3PolygonMode, true)                       \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3RasterizationSamples, true)              \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3SampleMask, true)                        \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3AlphaToCoverageEnable, true)             \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3AlphaToOneEnable, true)                  \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3LogicOpEnable, true)                     \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ColorBlendEnable, true)                  \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ColorBlendEquation, true)                \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ColorWriteMask, true)                    \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3DepthClipEnable, true)                   \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3SampleLocationsEnable, true)             \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ProvokingVertexMode, true)               \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3LineRasterizationMode, true)             \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3LineStippleEnable, true)                 \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3DepthClipNegativeOneToOne, true)         \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3TessellationDomainOrigin, false)         \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3RasterizationStream, false)              \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ConservativeRasterizationMode, false)    \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ExtraPrimitiveOverestimationSize, false) \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ColorBlendAdvanced, false)               \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ViewportWScalingEnable, false)           \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ViewportSwizzle, false)                  \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageToColorEnable, false)            \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageToColorLocation, false)          \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageModulationMode, false)           \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageModulationTableEnable, false)    \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageModulationTable, false)          \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3CoverageReductionMode, false)            \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3RepresentativeFragmentTestEnable, false) \
    X(VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, extendedDynamicState3ShadingRateImageEnable, false)           \
    X(VkPhysicalDeviceVertexInputDynamicStateFeaturesEXT, vertexInputDynamicState, true)                              \
    X(VkPhysicalDeviceInlineUniformBlockFeatures, inlineUniformBlock, true)                                           \
    X(VkPhysicalDeviceInlineUniformBlockFeatures, descriptorBindingInlineUniformBlockUpdateAfterBind, true)           \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderInputAttachmentArrayDynamicIndexing, true)                    \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderUniformTexelBufferArrayDynamicIndexing, true)                 \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderStorageTexelBufferArrayDynamicIndexing, true)                 \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderUniformBufferArrayNonUniformIndexing, true)                   \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderSampledImageArrayNonUniformIndexing, true)                    \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderStorageBufferArrayNonUniformIndexing, true)                   \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderStorageImageArrayNonUniformIndexing, true)                    \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderInputAttachmentArrayNonUniformIndexing, true)                 \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderUniformTexelBufferArrayNonUniformIndexing, true)              \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, shaderStorageTexelBufferArrayNonUniformIndexing, true)              \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingUniformBufferUpdateAfterBind, true)                \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingSampledImageUpdateAfterBind, true)                 \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingStorageImageUpdateAfterBind, true)                 \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingStorageBufferUpdateAfterBind, true)                \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingUniformTexelBufferUpdateAfterBind, true)           \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingStorageTexelBufferUpdateAfterBind, true)           \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingUpdateUnusedWhilePending, true)                    \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingPartiallyBound, true)                              \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, descriptorBindingVariableDescriptorCount, true)                     \
    X(VkPhysicalDeviceDescriptorIndexingFeatures, runtimeDescriptorArray, true)                                       \
    X(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddress, true)                                         \
    X(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddressCaptureReplay, false)                           \
    X(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddressMultiDevice, false)                             \
    X(VkPhysicalDeviceVulkanMemoryModelFeatures, vulkanMemoryModel, true)                                             \
    X(VkPhysicalDeviceVulkanMemoryModelFeatures, vulkanMemoryModelDeviceScope, true)                                  \
    X(VkPhysicalDeviceVulkanMemoryModelFeatures, vulkanMemoryModelAvailabilityVisibilityChains, true)                 \
    X(VkPhysicalDeviceTextureCompressionASTCHDRFeatures, textureCompressionASTC_HDR, false)                           \
    X(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge, true)                                               \
    X(VkPhysicalDeviceVulkan12Features, drawIndirectCount, true)                                                      \
    X(VkPhysicalDeviceVulkan12Features, descriptorIndexing, true)                                                     \
    X(VkPhysicalDeviceVulkan12Features, samplerFilterMinmax, true)                                                    \
    X(VkPhysicalDeviceVulkan12Features, shaderOutputViewportIndex, true)                                              \
    X(VkPhysicalDeviceVulkan12Features, shaderOutputLayer, true)                                                      \
    X(VkPhysicalDeviceVulkan12Features, subgroupBroadcastDynamicId, true)

/// One of these, and where its value lies: in the structure of its extension, and in those that core versions have
/// (Vulkan 1.1 to 1.3) if they have a member of its name.
struct FeatureRow {
    VkStructureType type;
    uint16_t offset;
    std::array<uint16_t, 3> coreOffsets;  // 0: none
    bool supported;
    const char* name;
};

#define VERNIER_OFFSET_IN(core, member)                        \
    []<class S>(const S*) constexpr->uint16_t {                \
        if constexpr (requires(S s) { s.member; }) {           \
            return static_cast<uint16_t>(offsetof(S, member)); \
        } else {                                               \
            return 0;                                          \
        }                                                      \
    }                                                          \
    (static_cast<const core*>(nullptr))
#define VERNIER_FEATURE_ROW(type, member, supported)                \
    {kStructureType<type>,                                          \
     static_cast<uint16_t>(offsetof(type, member)),                 \
     {VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan11Features, member),  \
      VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan12Features, member),  \
      VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan13Features, member)}, \
     supported,                                                     \
     #member},
constexpr FeatureRow kFeatureRows[] = {VERNIER_EXTENSION_FEATURES(VERNIER_FEATURE_ROW)};
#undef VERNIER_FEATURE_ROW
#undef VERNIER_OFFSET_IN

constexpr VkStructureType kCoreFeatures[] = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES,
                                             VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                             VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

/// Calls visit(row, offset in the structure) for every feature that the structure has.
template <class Visit>
void forEachFeature(VkStructureType structure, Visit&& visit) {
    const auto* core = std::ranges::find(kCoreFeatures, structure);
    for (const FeatureRow& row : kFeatureRows) {
        if (row.type == structure) {
            visit(row, row.offset);
        } else if (core != std::end(kCoreFeatures) && row.coreOffsets[core - kCoreFeatures] != 0) {
            visit(row, row.coreOffsets[core - kCoreFeatures]);
        }
    }
}

// VkPhysicalDeviceFeatures is nothing but VkBool32 members.
constexpr size_t kFeatureCount = sizeof(VkPhysicalDeviceFeatures) / sizeof(VkBool32);
constexpr const char* kFeatureNames[] = {
#define VERNIER_FEATURE_NAME(name) #name,
#include "feature_names.inc"
#undef VERNIER_FEATURE_NAME
};
static_assert(std::size(kFeatureNames) == kFeatureCount);

}  // namespace

VkPhysicalDeviceFeatures supportedFeatures() {
    VkPhysicalDeviceFeatures features{};
#define VERNIER_SET_FEATURE(name) features.name = VK_TRUE;
    VERNIER_FEATURES(VERNIER_SET_FEATURE)
#undef VERNIER_SET_FEATURE
    return features;
}

void fillFeatureChain(void* chain) {
    for (auto* node = static_cast<VkBaseOutStructure*>(chain); node != nullptr; node = node->pNext) {
        forEachFeature(node->sType, [node](const FeatureRow& row, uint32_t offset) {
            const VkBool32 value = row.supported ? VK_TRUE : VK_FALSE;
            std::memcpy(reinterpret_cast<std::byte*>(node) + offset, &value, sizeof value);
        });
    }
}

VkResult checkFeatures(const VkDeviceCreateInfo& info, const char*& missing) {
    const auto* wanted2 = findInChain<VkPhysicalDeviceFeatures2>(info.pNext);
    const VkPhysicalDeviceFeatures* wanted = wanted2 != nullptr ? &wanted2->features : info.pEnabledFeatures;
    missing = nullptr;
    if (wanted != nullptr) {
        const VkPhysicalDeviceFeatures supported = supportedFeatures();
        const auto* have = reinterpret_cast<const VkBool32*>(&supported);
        const auto* want = reinterpret_cast<const VkBool32*>(wanted);
        for (size_t i = 0; i < kFeatureCount; ++i) {
            if (want[i] != VK_FALSE && have[i] == VK_FALSE) missing = kFeatureNames[i];
        }
    }
    for (auto* node = static_cast<const VkBaseInStructure*>(info.pNext); node != nullptr; node = node->pNext) {
        forEachFeature(node->sType, [&](const FeatureRow& row, uint32_t offset) {
            VkBool32 value = VK_FALSE;
            std::memcpy(&value, reinterpret_cast<const std::byte*>(node) + offset, sizeof value);
            if (value != VK_FALSE && !row.supported) missing = row.name;
        });
    }
    return missing != nullptr ? VK_ERROR_FEATURE_NOT_PRESENT : VK_SUCCESS;
}

}  // namespace vernier::vulkan
