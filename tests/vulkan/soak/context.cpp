#include "tests/vulkan/soak/context.h"

#include <vernier/vernier_glsl.h>

#include <cstdio>
#include <cstring>

namespace vernier::soak {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<Verdict*>(user)->fail(std::string("a message: ") + data->pMessage);
    return VK_FALSE;
}

}  // namespace

void Verdict::fail(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (!failed_) std::fprintf(stderr, "soak: %s\n", text.c_str());
    failed_ = true;
}

void check(Verdict& verdict, VkResult result, const char* command) {
    if (result < 0) verdict.fail(std::string(command) + " gave " + std::to_string(result));
}

std::mutex& loaderMutex() {
    static std::mutex mutex;
    return mutex;
}

Context::Context(Verdict& owner) : verdict(owner) {
    const std::lock_guard lock(loaderMutex());
    auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = VK_API_VERSION_1_1;
    const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_KHR_SURFACE_EXTENSION_NAME,
                                      VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME};
    auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = static_cast<uint32_t>(std::size(extensions));
    info.ppEnabledExtensionNames = extensions;
    SOAK_CHECK(verdict, vkCreateInstance, &info, nullptr, &instance);
    if (instance == VK_NULL_HANDLE) return;
    auto messenger = make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = &verdict;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    SOAK_CHECK(verdict, create, instance, &messenger, nullptr, &messenger_);
    uint32_t count = 1;
    SOAK_CHECK(verdict, vkEnumeratePhysicalDevices, instance, &count, &physicalDevice);
    if (physicalDevice == VK_NULL_HANDLE) {
        verdict.fail("no device");
        return;
    }
    const float priority = 1;
    auto queueInfo = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    const char* const deviceExtensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME, VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME};
    auto timeline =
        make<VkPhysicalDeviceTimelineSemaphoreFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES);
    timeline.timelineSemaphore = VK_TRUE;
    auto deviceInfo = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    deviceInfo.pNext = &timeline;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    deviceInfo.enabledExtensionCount = static_cast<uint32_t>(std::size(deviceExtensions));
    deviceInfo.ppEnabledExtensionNames = deviceExtensions;
    SOAK_CHECK(verdict, vkCreateDevice, physicalDevice, &deviceInfo, nullptr, &device);
    if (device != VK_NULL_HANDLE) vkGetDeviceQueue(device, 0, 0, &queue);
}

Context::~Context() {
    const std::lock_guard lock(loaderMutex());
    if (device != VK_NULL_HANDLE) vkDestroyDevice(device, nullptr);
    if (instance == VK_NULL_HANDLE) return;
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger_, nullptr);
    }
    vkDestroyInstance(instance, nullptr);
}

VkShaderModule Context::compile(VkShaderStageFlagBits stage, const char* glsl) const {
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = glsl;
    VnGlslOutput* output = nullptr;
    VkShaderModule module = VK_NULL_HANDLE;
    if (vnCompileGlsl(&desc, &output) != VN_GLSL_SUCCESS) {
        verdict.fail(output != nullptr ? output->log : "no GLSL compiler");
    } else {
        auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
        info.codeSize = output->wordCount * sizeof(uint32_t);
        info.pCode = output->words;
        SOAK_CHECK(verdict, vkCreateShaderModule, device, &info, nullptr, &module);
    }
    vnFreeGlslOutput(output);
    return module;
}

}  // namespace vernier::soak
