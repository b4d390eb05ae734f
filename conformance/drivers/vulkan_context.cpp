#include "conformance/drivers/vulkan_context.h"

#include <algorithm>
#include <cstring>

namespace vernier::conformance {
namespace {

std::string resultName(VkResult result) {
    switch (result) {
#define VERNIER_NAME(name) \
    case name:             \
        return #name;
        VERNIER_NAME(VK_NOT_READY)
        VERNIER_NAME(VK_TIMEOUT)
        VERNIER_NAME(VK_INCOMPLETE)
        VERNIER_NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        VERNIER_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        VERNIER_NAME(VK_ERROR_INITIALIZATION_FAILED)
        VERNIER_NAME(VK_ERROR_DEVICE_LOST)
        VERNIER_NAME(VK_ERROR_MEMORY_MAP_FAILED)
        VERNIER_NAME(VK_ERROR_LAYER_NOT_PRESENT)
        VERNIER_NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
        VERNIER_NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        VERNIER_NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
        VERNIER_NAME(VK_ERROR_TOO_MANY_OBJECTS)
        VERNIER_NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
        VERNIER_NAME(VK_ERROR_FRAGMENTED_POOL)
        VERNIER_NAME(VK_ERROR_UNKNOWN)
        VERNIER_NAME(VK_ERROR_INVALID_SHADER_NV)
#undef VERNIER_NAME
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

}  // namespace

std::string versionText(const VkPhysicalDeviceProperties& properties) {
    const auto dotted = [](uint32_t version) {
        return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) +
               "." + std::to_string(VK_API_VERSION_PATCH(version));
    };
    return "driver " + dotted(properties.driverVersion) + ", Vulkan " + dotted(properties.apiVersion);
}

Error vulkanError(std::string_view call, VkResult result) {
    ErrorCode code = ErrorCode::invalidArgument;
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            code = ErrorCode::outOfHostMemory;
            break;
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            code = ErrorCode::outOfDeviceMemory;
            break;
        case VK_ERROR_DEVICE_LOST:
            code = ErrorCode::deviceLost;
            break;
        case VK_ERROR_LAYER_NOT_PRESENT:
        case VK_ERROR_EXTENSION_NOT_PRESENT:
        case VK_ERROR_FEATURE_NOT_PRESENT:
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            code = ErrorCode::unsupported;
            break;
        default:
            break;
    }
    // Only the function's name: the arguments are this file's own words.
    return {code, std::string(call.substr(0, call.find('('))) + ": " + resultName(result)};
}

Status VulkanContext::create(const VulkanOptions& options) {
    VERNIER_TRY(createInstance(options.validate));
    return createDevice(options);
}

Status VulkanContext::createInstance(bool validate) {
    // Absent in a Vulkan 1.0 loader.
    const auto enumerateVersion = reinterpret_cast<PFN_vkEnumerateInstanceVersion>(
        vkGetInstanceProcAddr(VK_NULL_HANDLE, "vkEnumerateInstanceVersion"));
    if (enumerateVersion != nullptr) enumerateVersion(&instanceVersion_);
    // 1.1 is asked for where there is one only for its viewports of negative height.
    instanceVersion_ = std::min<uint32_t>(instanceVersion_, VK_API_VERSION_1_1);

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "vernier-conformance";
    application.apiVersion = instanceVersion_;
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = &VulkanContext::onMessage;
    messenger.pUserData = this;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    std::vector<const char*> extensions{VK_KHR_GET_PHYSICAL_DEVICE_PROPERTIES_2_EXTENSION_NAME};
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validate) {
        info.pNext = &messenger;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VERNIER_TRY_VK(vkCreateInstance(&info, nullptr, &instance_));
    cleanup_.add([this] { vkDestroyInstance(instance_, nullptr); });
    if (!validate) return {};
    const auto create = instanceFunction<PFN_vkCreateDebugUtilsMessengerEXT>("vkCreateDebugUtilsMessengerEXT");
    const auto destroy = instanceFunction<PFN_vkDestroyDebugUtilsMessengerEXT>("vkDestroyDebugUtilsMessengerEXT");
    VkDebugUtilsMessengerEXT handle = VK_NULL_HANDLE;
    VERNIER_TRY_VK(create(instance_, &messenger, nullptr, &handle));
    cleanup_.add([this, destroy, handle] { destroy(instance_, handle, nullptr); });
    return {};
}

VkBool32 VulkanContext::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT types,
                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* context) {
    // The loader reports other drivers' missing libraries as general errors: not a matter of the scene.
    if ((types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0) {
        static_cast<VulkanContext*>(context)->validationErrors_ += std::string(data->pMessage) + "\n";
    }
    return VK_FALSE;
}

Status VulkanContext::createDevice(const VulkanOptions& options) {
    const uint32_t deviceIndex = options.deviceIndex;
    uint32_t count = 0;
    VERNIER_TRY_VK(vkEnumeratePhysicalDevices(instance_, &count, nullptr));
    std::vector<VkPhysicalDevice> devices(count);
    VERNIER_TRY_VK(vkEnumeratePhysicalDevices(instance_, &count, devices.data()));
    if (deviceIndex >= count) {
        return unsupported("physical device " + std::to_string(deviceIndex) + ": the loader offers " +
                           std::to_string(count));
    }
    physicalDevice_ = devices[deviceIndex];
    vkGetPhysicalDeviceProperties(physicalDevice_, &properties_);
    vkGetPhysicalDeviceFeatures(physicalDevice_, &features_);
    vkGetPhysicalDeviceMemoryProperties(physicalDevice_, &memory_);

    uint32_t familyCount = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice_, &familyCount, nullptr);
    std::vector<VkQueueFamilyProperties> families(familyCount);
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice_, &familyCount, families.data());
    const auto family = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& each) {
        return (each.queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
    });
    if (family == families.end()) return unsupported(std::string(properties_.deviceName) + " has no graphics queue");
    queueFamily_ = static_cast<uint32_t>(family - families.begin());
    compute_ = (family->queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;

    negativeViewports_ = instanceVersion_ >= VK_API_VERSION_1_1 && properties_.apiVersion >= VK_API_VERSION_1_1;
    VERNIER_TRY(extensions_.query(
        physicalDevice_, instanceFunction<PFN_vkGetPhysicalDeviceFeatures2KHR>("vkGetPhysicalDeviceFeatures2KHR")));
    negativeViewports_ = negativeViewports_ || extensions_.maintenance1;

    if (!options.robustBufferAccess) features_.robustBufferAccess = VK_FALSE;
    const auto getProperties =
        instanceFunction<PFN_vkGetPhysicalDeviceProperties2KHR>("vkGetPhysicalDeviceProperties2KHR");
    if (getProperties != nullptr) {
        VkPhysicalDeviceProperties2 properties{};
        properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        if (extensions_.depthStencilResolve) {
            depthStencilResolve_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_STENCIL_RESOLVE_PROPERTIES;
            properties.pNext = &depthStencilResolve_;
        }
        if (apiVersion() >= VK_API_VERSION_1_1) {
            subgroups_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
            subgroups_.pNext = properties.pNext;
            properties.pNext = &subgroups_;
        }
        getProperties(physicalDevice_, &properties);
    }
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = queueFamily_;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.pEnabledFeatures = &features_;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions_.names().size());
    info.ppEnabledExtensionNames = extensions_.names().data();
    info.pNext = extensions_.featureChain();
    VERNIER_TRY_VK(vkCreateDevice(physicalDevice_, &info, nullptr, &device_));
    cleanup_.add([this] { vkDestroyDevice(device_, nullptr); });
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    return {};
}

VkFormatProperties VulkanContext::formatProperties(VkFormat format) const {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(physicalDevice_, format, &properties);
    return properties;
}

VkSampleCountFlags VulkanContext::sampleCounts(VkFormat format, VkImageUsageFlags usage) const {
    VkImageFormatProperties properties{};
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(physicalDevice_, format, VK_IMAGE_TYPE_2D,
                                                                     VK_IMAGE_TILING_OPTIMAL, usage, 0, &properties);
    return result == VK_SUCCESS ? properties.sampleCounts : 0;
}

Result<uint32_t> VulkanContext::memoryType(uint32_t typeBits, VkMemoryPropertyFlags flags) const {
    for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
        if ((typeBits >> i & 1) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
    return unsupported("no memory type among bits " + std::to_string(typeBits) + " has properties " +
                       std::to_string(flags));
}

}  // namespace vernier::conformance
