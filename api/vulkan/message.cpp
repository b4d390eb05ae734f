#include "api/vulkan/message.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "api/vulkan/allocation.h"
#include "api/vulkan/entry_points.h"
#include "api/vulkan/instance.h"

namespace vernier::vulkan {
namespace {

/// One list for each enum, cut out of the one generated list by type.
template <class Enum>
const char* findName(Enum wanted) {
    const auto check = [wanted]<class Other>(Other value, const char* name, const char*& found) {
        if constexpr (std::is_same_v<Enum, Other>) {
            if (value == wanted) found = name;
        }
    };
    const char* found = nullptr;
#define VERNIER_ENUM_NAME(type, value) check(static_cast<type>(value), #value, found);
#include "enum_names.inc"
#undef VERNIER_ENUM_NAME
    return found;
}

template <class Enum>
std::string nameOrNumber(Enum value) {
    const char* name = findName(value);
    return name != nullptr ? name : std::to_string(static_cast<int64_t>(value));
}

}  // namespace

std::string nameOf(VkResult value) {
    return nameOrNumber(value);
}
std::string nameOf(VkFormat value) {
    return nameOrNumber(value);
}
std::string nameOf(VkDescriptorType value) {
    return nameOrNumber(value);
}
std::string nameOf(VkObjectType value) {
    return nameOrNumber(value);
}

VkResult resultOf(const Error& error) {
    switch (error.code) {
        case ErrorCode::outOfHostMemory:
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        case ErrorCode::outOfDeviceMemory:
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        case ErrorCode::deviceLost:
            return VK_ERROR_DEVICE_LOST;
        case ErrorCode::unsupported:
            return VK_ERROR_FEATURE_NOT_PRESENT;
        case ErrorCode::invalidArgument:
            break;
    }
    return VK_ERROR_UNKNOWN;
}

void Messages::add(const DebugMessenger* messenger) {
    const std::lock_guard lock(mutex_);
    messengers_.push_back(messenger);
}

void Messages::remove(const DebugMessenger* messenger) {
    std::unique_lock lock(mutex_);
    std::erase(messengers_, messenger);
    // A callback that destroys its own messenger, which it must not, does not wait for itself.
    const auto elsewhere = [&](const Running& one) {
        return one.messenger == messenger && one.thread != std::this_thread::get_id();
    };
    returned_.wait(lock, [&] { return std::ranges::none_of(running_, elsewhere); });
}

void Messages::send(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
                    const VkDebugUtilsMessengerCallbackDataEXT& data) const {
    if (log_) std::fprintf(stderr, "vernier: %s\n", data.pMessage);
    std::unique_lock lock(mutex_);
    // Callbacks run without the lock: messengers come and go meanwhile.
    const std::vector<const DebugMessenger*> messengers = messengers_;
    for (const DebugMessenger* messenger : messengers) {
        if (std::ranges::count(messengers_, messenger) == 0) continue;
        const VkDebugUtilsMessengerCreateInfoEXT info = messenger->info;
        if ((info.messageSeverity & severity) == 0 || (info.messageType & types) == 0) continue;
        const Running running{messenger, std::this_thread::get_id()};
        running_.push_back(running);
        lock.unlock();
        info.pfnUserCallback(severity, types, &data, info.pUserData);
        lock.lock();
        running_.erase(std::ranges::find(running_, running));
        returned_.notify_all();
    }
}

void Messages::error(const char* command, MessageObject about, std::string_view text) const {
    const std::string message = std::string(command) + ": " + std::string(text);
    VkDebugUtilsObjectNameInfoEXT named{};
    named.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    named.objectType = about.type;
    named.objectHandle = about.handle;
    VkDebugUtilsMessengerCallbackDataEXT data{};
    data.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT;
    data.pMessageIdName = command;
    data.pMessage = message.c_str();
    if (about.type != VK_OBJECT_TYPE_UNKNOWN) {
        data.objectCount = 1;
        data.pObjects = &named;
    }
    send(VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, data);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateDebugUtilsMessengerEXT(VkInstance instance,
                                                            const VkDebugUtilsMessengerCreateInfoEXT* pCreateInfo,
                                                            const VkAllocationCallbacks* pAllocator,
                                                            VkDebugUtilsMessengerEXT* pMessenger) {
    VkResult result = createHandle(pAllocator, pMessenger, *pCreateInfo);
    if (result != VK_SUCCESS) return result;
    result = guarded([&] {
        object(instance)->messages.add(object(*pMessenger));
        return VK_SUCCESS;
    });
    if (result != VK_SUCCESS) destroyHandle(pAllocator, *pMessenger);
    return result;
}

VKAPI_ATTR void VKAPI_CALL DestroyDebugUtilsMessengerEXT(VkInstance instance, VkDebugUtilsMessengerEXT messenger,
                                                         const VkAllocationCallbacks* pAllocator) {
    object(instance)->messages.remove(object(messenger));
    destroyHandle(pAllocator, messenger);
}

VKAPI_ATTR void VKAPI_CALL SubmitDebugUtilsMessageEXT(VkInstance instance,
                                                      VkDebugUtilsMessageSeverityFlagBitsEXT messageSeverity,
                                                      VkDebugUtilsMessageTypeFlagsEXT messageTypes,
                                                      const VkDebugUtilsMessengerCallbackDataEXT* pCallbackData) {
    (void)guarded([&] {
        object(instance)->messages.send(messageSeverity, messageTypes, *pCallbackData);
        return VK_SUCCESS;
    });
}

// Names, tags and labels are for tools that show them; the driver keeps none (VK_EXT_debug_utils leaves that
// to it, and VK_EXT_debug_marker before it did).

VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectNameEXT(VkDevice, const VkDebugUtilsObjectNameInfoEXT*) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL SetDebugUtilsObjectTagEXT(VkDevice, const VkDebugUtilsObjectTagInfoEXT*) {
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL QueueBeginDebugUtilsLabelEXT(VkQueue, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL QueueEndDebugUtilsLabelEXT(VkQueue) {}
VKAPI_ATTR void VKAPI_CALL QueueInsertDebugUtilsLabelEXT(VkQueue, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL CmdBeginDebugUtilsLabelEXT(VkCommandBuffer, const VkDebugUtilsLabelEXT*) {}
VKAPI_ATTR void VKAPI_CALL CmdEndDebugUtilsLabelEXT(VkCommandBuffer) {}
VKAPI_ATTR void VKAPI_CALL CmdInsertDebugUtilsLabelEXT(VkCommandBuffer, const VkDebugUtilsLabelEXT*) {}

VKAPI_ATTR VkResult VKAPI_CALL DebugMarkerSetObjectNameEXT(VkDevice, const VkDebugMarkerObjectNameInfoEXT*) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL DebugMarkerSetObjectTagEXT(VkDevice, const VkDebugMarkerObjectTagInfoEXT*) {
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL CmdDebugMarkerBeginEXT(VkCommandBuffer, const VkDebugMarkerMarkerInfoEXT*) {}
VKAPI_ATTR void VKAPI_CALL CmdDebugMarkerEndEXT(VkCommandBuffer) {}
VKAPI_ATTR void VKAPI_CALL CmdDebugMarkerInsertEXT(VkCommandBuffer, const VkDebugMarkerMarkerInfoEXT*) {}

}  // namespace vernier::vulkan
