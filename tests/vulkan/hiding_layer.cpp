// VK_LAYER_VERNIER_hiding: devices lack the feature that VERNIER_HIDDEN_FEATURE names, whatever they are made with.
// Above VK_LAYER_KHRONOS_validation it makes that complain of all that uses the feature: truth_hidden.py.
//
// What can be asked of the physical device stays: a test that looks whether the feature is reported, or skips itself
// where it is not, shall not pass for one that uses it.
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "api/vulkan/run/layer.h"

namespace vernier::layer {
namespace {

// The structures with features by their types; kVkPhysicalDeviceFeatures is of the one around it.
constexpr VkStructureType kVkPhysicalDeviceFeatures = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
#define VERNIER_FEATURES(type, value) constexpr VkStructureType k##type = value;
#define VERNIER_FEATURE(type, member)
#include "reported_features.inc"
#undef VERNIER_FEATURES
#undef VERNIER_FEATURE

/// What may be in the chain of VkDeviceCreateInfo.
struct Structure {
    VkStructureType type;
    size_t bytes;
};
constexpr Structure kStructures[] = {
    {VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO, sizeof(VkLayerDeviceCreateInfo)},
    {VK_STRUCTURE_TYPE_DEVICE_GROUP_DEVICE_CREATE_INFO, sizeof(VkDeviceGroupDeviceCreateInfo)},
    {VK_STRUCTURE_TYPE_DEVICE_PRIVATE_DATA_CREATE_INFO, sizeof(VkDevicePrivateDataCreateInfo)},
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, sizeof(VkPhysicalDeviceFeatures2)},
#define VERNIER_FEATURES(type, value) {value, sizeof(type)},
#define VERNIER_FEATURE(type, member)
#include "reported_features.inc"
#undef VERNIER_FEATURES
#undef VERNIER_FEATURE
};

struct Feature {
    const char* name;
    VkStructureType type;
    size_t offset;
};
constexpr Feature kFeatures[] = {
#define VERNIER_FEATURES(type, value)
#define VERNIER_FEATURE(type, member) {#member, k##type, offsetof(type, member)},
#include "reported_features.inc"
#undef VERNIER_FEATURES
#undef VERNIER_FEATURE
};

/// `members`: a structure of that type, or the VkPhysicalDeviceFeatures in it.
void hide(const char* name, VkStructureType type, void* members) {
    constexpr VkBool32 kOff = VK_FALSE;
    for (const Feature& feature : kFeatures) {
        if (feature.type == type && std::strcmp(feature.name, name) == 0)
            std::memcpy(static_cast<std::byte*>(members) + feature.offset, &kOff, sizeof kOff);
    }
}

/// A copy of a chain, without the feature.
class Chain {
  public:
    Chain(const void* original, const char* hidden) {
        VkBaseOutStructure** end = &first_;
        for (auto* node = static_cast<const VkBaseInStructure*>(original); node != nullptr; node = node->pNext) {
            VkBaseOutStructure* const copied = copy(*node);
            if (copied == nullptr) return;
            const bool core = copied->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
            hide(hidden, copied->sType,
                 core ? static_cast<void*>(&reinterpret_cast<VkPhysicalDeviceFeatures2*>(copied)->features) : copied);
            copied->pNext = nullptr;
            *end = copied;
            end = &copied->pNext;
        }
        whole_ = true;
    }
    /// Whether all structures are known here.
    bool isWhole() const { return whole_; }
    const void* first() const { return first_; }

  private:
    VkBaseOutStructure* copy(const VkBaseInStructure& node) {
        for (const Structure& structure : kStructures) {
            if (structure.type != node.sType) continue;
            copies_.push_back(std::make_unique<std::byte[]>(structure.bytes));
            std::memcpy(copies_.back().get(), &node, structure.bytes);
            return reinterpret_cast<VkBaseOutStructure*>(copies_.back().get());
        }
        std::fprintf(stderr, "VK_LAYER_VERNIER_hiding: devices with structures of type %d cannot be made\n",
                     node.sType);
        return nullptr;
    }

    std::vector<std::unique_ptr<std::byte[]>> copies_;
    VkBaseOutStructure* first_ = nullptr;
    bool whole_ = false;
};

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks, VkDevice* device) {
    const char* const variable = std::getenv("VERNIER_HIDDEN_FEATURE");
    const char* const hidden = variable != nullptr ? variable : "";
    const Chain chain(info->pNext, hidden);
    if (!chain.isWhole()) return VK_ERROR_INITIALIZATION_FAILED;
    VkDeviceCreateInfo changed = *info;
    changed.pNext = chain.first();
    VkPhysicalDeviceFeatures features{};
    if (info->pEnabledFeatures != nullptr) {
        features = *info->pEnabledFeatures;
        hide(hidden, kVkPhysicalDeviceFeatures, &features);
        changed.pEnabledFeatures = &features;
    }
    Next next;
    return createDeviceOfNext(physicalDevice, changed, callbacks, device, next);
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* callbacks) {
    if (device != VK_NULL_HANDLE) destroyDeviceOfNext(device, callbacks);
}

}  // namespace

std::span<const OwnCommand> ownCommands() {
    static const OwnCommand kOwn[] = {
        {"vkCreateDevice", reinterpret_cast<PFN_vkVoidFunction>(&createDevice), false},
        {"vkDestroyDevice", reinterpret_cast<PFN_vkVoidFunction>(&destroyDevice), true},
    };
    return kOwn;
}

}  // namespace vernier::layer
