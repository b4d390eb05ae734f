// What layers of ours share: how the loader, a layer and the next layer or the driver find each other, by vk_layer.h. A
// layer defines ownCommands(), and is built with layer.cpp; all other commands go past it.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

#include <span>

namespace vernier::layer {

/// A command that a layer takes part in.
struct OwnCommand {
    const char* name;
    PFN_vkVoidFunction function;
    bool ofDevice;
};

/// Of the layer: besides those of instances and vkGet*ProcAddr, which are in layer.cpp.
std::span<const OwnCommand> ownCommands();

/// Handles belong to others and have no room for what a layer knows: it is kept beside them, by the pointer that all
/// dispatchable handles of an instance or device start with.
template <class Handle>
void* keyOf(Handle handle) {
    return *reinterpret_cast<void**>(handle);
}

/// Where the commands of the next layer, or the driver, are.
struct Next {
    VkInstance instance = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr ofInstance = nullptr;
    PFN_vkGetDeviceProcAddr ofDevice = nullptr;
    PFN_vkSetDeviceLoaderData setLoaderData = nullptr;  // nullptr: the loader does not say
};

/// vkCreateDevice of the next. The chain of `info` must have the loader's structures.
VkResult createDeviceOfNext(VkPhysicalDevice physicalDevice, const VkDeviceCreateInfo& info,
                            const VkAllocationCallbacks* callbacks, VkDevice* device, Next& next);
/// vkDestroyDevice of the next, for a device of createDeviceOfNext().
void destroyDeviceOfNext(VkDevice device, const VkAllocationCallbacks* callbacks);

}  // namespace vernier::layer
