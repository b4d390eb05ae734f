// The property structures of Vulkan 1.1, 1.2 and 1.3 as a whole: what they hold is what the structures of the
// extensions hold that went into them, one after the other.
#include <cstddef>
#include <cstring>
#include <iterator>

#include "api/vulkan/chain.h"
#include "api/vulkan/physical_device.h"
#include "api/vulkan/resource_limits.h"

namespace vernier::vulkan {
namespace {

/// A run of members of a core structure, and the structure of which they are all members in the same order.
struct Part {
    VkStructureType core, part;
    uint32_t offset, bytes;
};

/// Members begin behind sType and pNext.
constexpr uint32_t kFirstMember = sizeof(VkBaseOutStructure);
using Core11 = VkPhysicalDeviceVulkan11Properties;
using Core12 = VkPhysicalDeviceVulkan12Properties;
using Core13 = VkPhysicalDeviceVulkan13Properties;

/// The members from `first` to the one before `next`.
#define VERNIER_PART(core, first, next, type)                                          \
    {                                                                                  \
        kStructureType<core>, kStructureType<type>, offsetof(core, first),             \
            offsetof(core, next) - offsetof(core, first) < sizeof(type) - kFirstMember \
                ? static_cast<uint32_t>(offsetof(core, next) - offsetof(core, first))  \
                : static_cast<uint32_t>(sizeof(type) - kFirstMember)                   \
    }
constexpr Part kParts[] = {
    VERNIER_PART(Core11, deviceUUID, subgroupSize, VkPhysicalDeviceIDProperties),
    VERNIER_PART(Core11, subgroupSize, pointClippingBehavior, VkPhysicalDeviceSubgroupProperties),
    VERNIER_PART(Core11, pointClippingBehavior, maxMultiviewViewCount, VkPhysicalDevicePointClippingProperties),
    VERNIER_PART(Core11, maxMultiviewViewCount, protectedNoFault, VkPhysicalDeviceMultiviewProperties),
    VERNIER_PART(Core11, protectedNoFault, maxPerSetDescriptors, VkPhysicalDeviceProtectedMemoryProperties),
    {kStructureType<Core11>, kStructureType<VkPhysicalDeviceMaintenance3Properties>,
     offsetof(Core11, maxPerSetDescriptors), sizeof(Core11) - offsetof(Core11, maxPerSetDescriptors)},
    VERNIER_PART(Core12, driverID, denormBehaviorIndependence, VkPhysicalDeviceDriverProperties),
    VERNIER_PART(Core12, denormBehaviorIndependence, maxUpdateAfterBindDescriptorsInAllPools,
                 VkPhysicalDeviceFloatControlsProperties),
    VERNIER_PART(Core12, maxUpdateAfterBindDescriptorsInAllPools, supportedDepthResolveModes,
                 VkPhysicalDeviceDescriptorIndexingProperties),
    VERNIER_PART(Core12, supportedDepthResolveModes, filterMinmaxSingleComponentFormats,
                 VkPhysicalDeviceDepthStencilResolveProperties),
    VERNIER_PART(Core12, filterMinmaxSingleComponentFormats, maxTimelineSemaphoreValueDifference,
                 VkPhysicalDeviceSamplerFilterMinmaxProperties),
    VERNIER_PART(Core12, maxTimelineSemaphoreValueDifference, framebufferIntegerColorSampleCounts,
                 VkPhysicalDeviceTimelineSemaphoreProperties),
    VERNIER_PART(Core13, minSubgroupSize, maxInlineUniformBlockSize, VkPhysicalDeviceSubgroupSizeControlProperties),
    VERNIER_PART(Core13, maxInlineUniformBlockSize, maxInlineUniformTotalSize,
                 VkPhysicalDeviceInlineUniformBlockProperties),
    VERNIER_PART(Core13, integerDotProduct8BitUnsignedAccelerated, storageTexelBufferOffsetAlignmentBytes,
                 VkPhysicalDeviceShaderIntegerDotProductProperties),
    VERNIER_PART(Core13, storageTexelBufferOffsetAlignmentBytes, maxBufferSize,
                 VkPhysicalDeviceTexelBufferAlignmentProperties),
    {kStructureType<Core13>, kStructureType<VkPhysicalDeviceMaintenance4Properties>, offsetof(Core13, maxBufferSize),
     sizeof(VkDeviceSize)},
};
#undef VERNIER_PART

/// The largest structure of a part.
union AnyPart {
    VkBaseOutStructure head;
    VkPhysicalDeviceIDProperties ids;
    VkPhysicalDeviceDriverProperties driver;
    VkPhysicalDeviceDescriptorIndexingProperties indexing;
    VkPhysicalDeviceShaderIntegerDotProductProperties products;
};

}  // namespace

void fillCoreProperties(const PhysicalDevice& device, void* chain) {
    for (auto* node = static_cast<VkBaseOutStructure*>(chain); node != nullptr; node = node->pNext) {
        for (const Part& part : kParts) {
            if (part.core != node->sType) continue;
            AnyPart filled;
            std::memset(&filled, 0, sizeof filled);
            filled.head.sType = part.part;
            fillPropertyChain(device, &filled);
            std::memcpy(reinterpret_cast<std::byte*>(node) + part.offset,
                        reinterpret_cast<const std::byte*>(&filled) + kFirstMember, part.bytes);
        }
    }
    if (auto* p = findInChain<Core12>(chain)) p->framebufferIntegerColorSampleCounts = kSampleCounts;
    if (auto* p = findInChain<Core13>(chain)) {
        p->maxInlineUniformTotalSize = kMaxInlineUniformBlocks * kMaxInlineUniformBlockBytes;
    }
}

}  // namespace vernier::vulkan
