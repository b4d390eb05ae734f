// From names to functions: vkGetInstanceProcAddr, vkGetDeviceProcAddr, and the three symbols the loader looks
// for (Vulkan-Loader, docs/LoaderDriverInterface.md). A command that is not implemented, or whose version or
// extension is not there, is NULL.
#include "api/vulkan/entry_points.h"

#include <vulkan/vk_icd.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "api/vulkan/device.h"
#include "api/vulkan/extension.h"
#include "api/vulkan/instance.h"

#define VERNIER_EXPORT extern "C" __attribute__((visibility("default")))

VERNIER_EXPORT PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name);
VERNIER_EXPORT PFN_vkVoidFunction VKAPI_CALL vk_icdGetPhysicalDeviceProcAddr(VkInstance instance, const char* name);
VERNIER_EXPORT VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t* version);

namespace vernier::vulkan {
namespace {

enum class Level : uint8_t { loader, instance, physicalDevice, device };

struct EntryPoint {
    const char* name;
    uint32_t coreVersion;     // 0: not core
    ExtensionSet extensions;  // that bring it
    Level level;

    PFN_vkVoidFunction function() const;
};

// Functions stand in a table of their own: their casts are no constant expressions, and with them among it the first
// table would be filled in by code, of more bytes than it has.
constexpr EntryPoint kEntryPoints[] = {
#define VERNIER_ENTRY_ROW(name, function, level, version, extensions) {#name, version, extensions, Level::level},
#include "entry_points.inc"
#undef VERNIER_ENTRY_ROW
};
const PFN_vkVoidFunction kFunctions[] = {
#define VERNIER_ENTRY_ROW(name, function, level, version, extensions) reinterpret_cast<PFN_vkVoidFunction>(&function),
#include "entry_points.inc"
#undef VERNIER_ENTRY_ROW
};

PFN_vkVoidFunction EntryPoint::function() const {
    return kFunctions[this - kEntryPoints];
}

/// Of our version or a listed extension; nullptr otherwise. The table is sorted by name.
const EntryPoint* find(std::string_view name, ExtensionSet available) {
    const auto nameOf = [](const EntryPoint& entry) { return std::string_view(entry.name); };
    const auto* entry = std::ranges::lower_bound(kEntryPoints, name, {}, nameOf);
    if (entry == std::end(kEntryPoints) || entry->name != name) return nullptr;
    const bool core = entry->coreVersion != 0 && entry->coreVersion <= kApiVersion;
    return core || entry->extensions.intersects(available) ? entry : nullptr;
}

constexpr ExtensionSet kDeviceExtensions = [] {
    ExtensionSet set;
#define VERNIER_EXTENSION_ROW(identifier, name, version, isInstance) \
    if (!isInstance) set |= Extension::identifier;
#include "extensions.inc"
#undef VERNIER_EXTENSION_ROW
    return set;
}();

/// With an instance: everything that it, or any device of it, could offer.
PFN_vkVoidFunction instanceProcAddr(VkInstance instance, std::string_view name) {
    const ExtensionSet available =
        instance != nullptr ? object(instance)->extensions | kDeviceExtensions : ExtensionSet();
    const EntryPoint* entry = find(name, available);
    if (entry == nullptr || (instance == nullptr && entry->level != Level::loader)) return nullptr;
    return entry->function();
}

}  // namespace

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetInstanceProcAddr(VkInstance instance, const char* pName) {
    return pName != nullptr ? instanceProcAddr(instance, pName) : nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetDeviceProcAddr(VkDevice device, const char* pName) {
    if (device == nullptr || pName == nullptr) return nullptr;
    const EntryPoint* entry = find(pName, object(device)->extensions);
    return entry != nullptr && entry->level == Level::device ? entry->function() : nullptr;
}

}  // namespace vernier::vulkan

PFN_vkVoidFunction vk_icdGetInstanceProcAddr(VkInstance instance, const char* name) {
    using namespace vernier::vulkan;
    if (name == nullptr) return nullptr;
    // Interface version 7 asks for the loader's own functions by name, too.
    const std::string_view wanted = name;
    if (wanted == "vk_icdNegotiateLoaderICDInterfaceVersion") {
        return reinterpret_cast<PFN_vkVoidFunction>(&vk_icdNegotiateLoaderICDInterfaceVersion);
    }
    if (wanted == "vk_icdGetPhysicalDeviceProcAddr") {
        return reinterpret_cast<PFN_vkVoidFunction>(&vk_icdGetPhysicalDeviceProcAddr);
    }
    return instanceProcAddr(instance, wanted);
}

PFN_vkVoidFunction vk_icdGetPhysicalDeviceProcAddr(VkInstance instance, const char* name) {
    using namespace vernier::vulkan;
    if (instance == nullptr || name == nullptr) return nullptr;
    const EntryPoint* entry = find(name, object(instance)->extensions | kDeviceExtensions);
    return entry != nullptr && entry->level == Level::physicalDevice ? entry->function() : nullptr;
}

VkResult vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t* version) {
    // 5 is the first in which a driver answers for its own API version; 7 is the newest known here.
    constexpr uint32_t kOldest = 5, kNewest = 7;
    if (version == nullptr || *version < kOldest) return VK_ERROR_INCOMPATIBLE_DRIVER;
    *version = std::min(*version, kNewest);
    return VK_SUCCESS;
}
