#include "api/vulkan/run/layer.h"

#include <cstring>
#include <initializer_list>
#include <map>
#include <mutex>

namespace vernier::layer {
namespace {

/// The commands that end instances and devices are asked for when these are made: later the loader answers with what
/// the program calls, which is the first layer's.
struct Known {
    Next next;
    PFN_vkDestroyInstance destroyInstance = nullptr;
    PFN_vkDestroyDevice destroyDevice = nullptr;
};

struct Registry {
    std::mutex mutex;
    std::map<void*, Known> instances, devices;  // by keyOf()
};

Registry& registry() {
    static Registry one;
    return one;
}

Known find(const std::map<void*, Known>& all, void* key) {
    const std::lock_guard lock(registry().mutex);
    const auto found = all.find(key);
    return found != all.end() ? found->second : Known{};
}

void keep(std::map<void*, Known>& all, void* key, const Known& known) {
    const std::lock_guard lock(registry().mutex);
    all[key] = known;
}

Known take(std::map<void*, Known>& all, void* key) {
    const std::lock_guard lock(registry().mutex);
    const auto found = all.find(key);
    if (found == all.end()) return {};
    const Known known = found->second;
    all.erase(found);
    return known;
}

/// The structure of the loader's that is in the chain of a creation; nullptr: the loader is older than the layer.
template <class Link>
Link* findLink(const void* chain, VkStructureType type, VkLayerFunction function) {
    auto* link = static_cast<Link*>(const_cast<void*>(chain));
    while (link != nullptr && !(link->sType == type && link->function == function))
        link = static_cast<Link*>(const_cast<void*>(link->pNext));
    return link;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks,
                                              VkInstance* instance) {
    auto* const link = findLink<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO,
                                                           VK_LAYER_LINK_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    Next next;
    next.ofInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next.ofInstance(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, callbacks, instance);
    if (result != VK_SUCCESS) return result;
    next.instance = *instance;
    const auto destroy = reinterpret_cast<PFN_vkDestroyInstance>(next.ofInstance(*instance, "vkDestroyInstance"));
    keep(registry().instances, keyOf(*instance), {next, destroy, nullptr});
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* callbacks) {
    if (instance == VK_NULL_HANDLE) return;
    take(registry().instances, keyOf(instance)).destroyInstance(instance, callbacks);
}

PFN_vkVoidFunction ownCommand(const char* name, bool devicesOnly);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction own = ownCommand(name, true)) return own;
    return find(registry().devices, keyOf(device)).next.ofDevice(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction own = ownCommand(name, false)) return own;
    if (instance == VK_NULL_HANDLE) return nullptr;
    const Next next = find(registry().instances, keyOf(instance)).next;
    return next.ofInstance != nullptr ? next.ofInstance(instance, name) : nullptr;
}

PFN_vkVoidFunction ownCommand(const char* name, bool devicesOnly) {
    static const OwnCommand kOfAllLayers[] = {
        {"vkCreateInstance", reinterpret_cast<PFN_vkVoidFunction>(&createInstance), false},
        {"vkDestroyInstance", reinterpret_cast<PFN_vkVoidFunction>(&destroyInstance), false},
        {"vkGetInstanceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(&getInstanceProcAddr), false},
        {"vkGetDeviceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(&getDeviceProcAddr), true},
    };
    for (const std::span<const OwnCommand> commands : {std::span<const OwnCommand>(kOfAllLayers), ownCommands()}) {
        for (const OwnCommand& own : commands) {
            if (std::strcmp(own.name, name) == 0 && (own.ofDevice || !devicesOnly)) return own.function;
        }
    }
    return nullptr;
}

}  // namespace

VkResult createDeviceOfNext(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo& info,
                            const VkAllocationCallbacks* callbacks, VkDevice* device, Next& next) {
    auto* const link =
        findLink<VkLayerDeviceCreateInfo>(info.pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO, VK_LAYER_LINK_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    auto* const loader = findLink<VkLayerDeviceCreateInfo>(info.pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO,
                                                           VK_LOADER_DATA_CALLBACK);
    next.instance = find(registry().instances, keyOf(physicalDevice)).next.instance;
    next.ofInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    next.ofDevice = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    if (loader != nullptr) next.setLoaderData = loader->u.pfnSetDeviceLoaderData;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(next.ofInstance(next.instance, "vkCreateDevice"));
    const VkResult result = create(physicalDevice, &info, callbacks, device);
    if (result != VK_SUCCESS) return result;
    const auto destroy = reinterpret_cast<PFN_vkDestroyDevice>(next.ofDevice(*device, "vkDestroyDevice"));
    keep(registry().devices, keyOf(*device), {next, nullptr, destroy});
    return VK_SUCCESS;
}

void destroyDeviceOfNext(VkDevice device, const VkAllocationCallbacks* callbacks) {
    take(registry().devices, keyOf(device)).destroyDevice(device, callbacks);
}

}  // namespace vernier::layer

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version);

VkResult vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    if (version == nullptr || version->sType != LAYER_NEGOTIATE_INTERFACE_STRUCT) return VK_ERROR_INITIALIZATION_FAILED;
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = vernier::layer::getInstanceProcAddr;
    version->pfnGetDeviceProcAddr = vernier::layer::getDeviceProcAddr;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
