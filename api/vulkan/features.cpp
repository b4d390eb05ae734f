// Which features of Vulkan the device has, as structures tell it.
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

/// A feature, and where its value lies: in the structure of its row, and in those that core versions have (Vulkan 1.1
/// to 1.3) if they have a member of its name.
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
constexpr FeatureRow kFeatureRows[] = {
#define VERNIER_CORE_FEATURE(member, supported)                                   \
    {kStructureType<VkPhysicalDeviceFeatures2>,                                   \
     static_cast<uint16_t>(offsetof(VkPhysicalDeviceFeatures2, features.member)), \
     {},                                                                          \
     supported,                                                                   \
     #member},
#define VERNIER_FEATURE(type, member, supported)                    \
    {kStructureType<type>,                                          \
     static_cast<uint16_t>(offsetof(type, member)),                 \
     {VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan11Features, member),  \
      VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan12Features, member),  \
      VERNIER_OFFSET_IN(VkPhysicalDeviceVulkan13Features, member)}, \
     supported,                                                     \
     #member},
#include "api/vulkan/features.def"
#undef VERNIER_FEATURE
#undef VERNIER_CORE_FEATURE
};
#undef VERNIER_OFFSET_IN

constexpr VkStructureType kCoreFeatures[] = {kStructureType<VkPhysicalDeviceVulkan11Features>,
                                             kStructureType<VkPhysicalDeviceVulkan12Features>,
                                             kStructureType<VkPhysicalDeviceVulkan13Features>};

/// Calls visit(row, offset in the structure) for every feature that the structure has.
template <class Visit>
constexpr void forEachFeature(VkStructureType structure, Visit&& visit) {
    const auto* core = std::ranges::find(kCoreFeatures, structure);
    for (const FeatureRow& row : kFeatureRows) {
        if (row.type == structure) {
            visit(row, row.offset);
        } else if (core != std::end(kCoreFeatures) && row.coreOffsets[core - kCoreFeatures] != 0) {
            visit(row, row.coreOffsets[core - kCoreFeatures]);
        }
    }
}

/// Whether each member of a structure of `bytes` bytes has one row. All but the head are VkBool32, and the last may be
/// followed by padding.
constexpr bool isWhole(VkStructureType structure, size_t bytes) {
    std::array<bool, 64> known{};
    size_t count = 0;
    bool twice = false;
    forEachFeature(structure, [&](const FeatureRow&, uint32_t offset) {
        bool& member = known[(offset - sizeof(VkBaseOutStructure)) / sizeof(VkBool32)];
        twice = twice || member;
        member = true;
        ++count;
    });
    const size_t padding = bytes - sizeof(VkBaseOutStructure) - count * sizeof(VkBool32);
    return !twice && padding < alignof(VkBaseOutStructure);
}
#define VERNIER_CORE_FEATURE(member, supported)
#define VERNIER_FEATURE(type, member, supported) static_assert(isWhole(kStructureType<type>, sizeof(type)), #type);
VERNIER_FEATURE(VkPhysicalDeviceFeatures2, , )
VERNIER_FEATURE(VkPhysicalDeviceVulkan11Features, , )
VERNIER_FEATURE(VkPhysicalDeviceVulkan13Features, , )
#include "api/vulkan/features.def"
#undef VERNIER_FEATURE
#undef VERNIER_CORE_FEATURE

/// The name of a feature that a structure of the chain asks for and that is not there, or nullptr.
const char* missingFeature(const void* chain) {
    const char* missing = nullptr;
    for (auto* node = static_cast<const VkBaseInStructure*>(chain); node != nullptr; node = node->pNext) {
        forEachFeature(node->sType, [&](const FeatureRow& row, uint32_t offset) {
            VkBool32 value = VK_FALSE;
            std::memcpy(&value, reinterpret_cast<const std::byte*>(node) + offset, sizeof value);
            if (value != VK_FALSE && !row.supported) missing = row.name;
        });
    }
    return missing;
}

}  // namespace

VkPhysicalDeviceFeatures supportedFeatures() {
    VkPhysicalDeviceFeatures2 structure{kStructureType<VkPhysicalDeviceFeatures2>, nullptr, {}};
    fillFeatureChain(&structure);
    return structure.features;
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
    missing = missingFeature(info.pNext);
    if (missing == nullptr && info.pEnabledFeatures != nullptr) {
        const VkPhysicalDeviceFeatures2 wanted{kStructureType<VkPhysicalDeviceFeatures2>, nullptr,
                                               *info.pEnabledFeatures};
        missing = missingFeature(&wanted);
    }
    return missing != nullptr ? VK_ERROR_FEATURE_NOT_PRESENT : VK_SUCCESS;
}

}  // namespace vernier::vulkan
