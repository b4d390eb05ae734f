#include "tests/vulkan/test_device.h"

#include <vernier/vernier_glsl.h>

#include <cstdlib>

namespace vernier::test {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL keepMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    // With validation switched on in the environment, every test is also a test of clean use.
    const std::string id = data->pMessageIdName != nullptr ? data->pMessageIdName : "";
    if (id.find("VUID") != std::string::npos || id.find("InconsistentSpirv") != std::string::npos)
        ADD_FAILURE() << data->pMessage;
    static_cast<std::vector<std::string>*>(user)->push_back(data->pMessage);
    return VK_FALSE;
}

bool hasFeaturesOf12(const void* chain) {
    const auto* node = static_cast<const VkBaseInStructure*>(chain);
    while (node != nullptr && node->sType != VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) node = node->pNext;
    return node != nullptr;
}

}  // namespace

void useDriver(const char* manifest) {
    setenv("VK_ICD_FILENAMES", manifest, 1);
    setenv("VK_DRIVER_FILES", manifest, 1);
}

void useOwnDriver() {
    useDriver(VERNIER_ICD_JSON);
}

std::vector<uint32_t> compileGlsl(VkShaderStageFlagBits stage, const std::string& source, uint32_t apiVersion) {
    // Kept for all tests: every shader would set the compiler up anew.
    struct Compiler {
        Compiler() { vnRetainGlslCompiler(); }
        ~Compiler() { vnReleaseGlslCompiler(); }
    };
    static const Compiler kept;
    VnGlslDesc desc{};
    desc.stage = stage;
    desc.source = source.c_str();
    desc.target = apiVersion == VK_API_VERSION_1_0 ? VN_GLSL_TARGET_VULKAN_1_0 : VN_GLSL_TARGET_VULKAN_1_1;
    VnGlslOutput* output = nullptr;
    const VnGlslResult result = vnCompileGlsl(&desc, &output);
    EXPECT_EQ(result, VN_GLSL_SUCCESS) << (output != nullptr ? output->log : "");
    std::vector<uint32_t> words;
    if (result == VN_GLSL_SUCCESS) words.assign(output->words, output->words + output->wordCount);
    vnFreeGlslOutput(output);
    return words;
}

const char* VulkanTest::driver() {
    return VERNIER_ICD_JSON;
}

void VulkanTest::SetUp() {
    useDriver(driver());
    auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = apiVersion();
    std::vector<const char*> extensions = moreInstanceExtensions();
    for (const char* name : {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_KHR_GET_PHYSICAL_DEVICE_PROPERTIES_2_EXTENSION_NAME,
                             VK_KHR_DEVICE_GROUP_CREATION_EXTENSION_NAME}) {
        extensions.push_back(name);
    }
    auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    ASSERT_EQ(vkCreateInstance(&info, nullptr, &instance), VK_SUCCESS);

    auto messengerInfo =
        make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    messengerInfo.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messengerInfo.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messengerInfo.pfnUserCallback = keepMessage;
    messengerInfo.pUserData = &messages;
    const auto createMessenger = ofInstance<PFN_vkCreateDebugUtilsMessengerEXT>("vkCreateDebugUtilsMessengerEXT");
    ASSERT_NE(createMessenger, nullptr);
    ASSERT_EQ(createMessenger(instance, &messengerInfo, nullptr, &messenger_), VK_SUCCESS);

    uint32_t count = 1;
    ASSERT_EQ(vkEnumeratePhysicalDevices(instance, &count, &physicalDevice), VK_SUCCESS);
    ASSERT_EQ(count, 1u);
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physicalDevice, &features);
    const float priority = 1;
    auto queueInfo = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    std::vector<const char*> deviceExtensions = moreExtensions();
    for (const char* name : {VK_KHR_MAINTENANCE_1_EXTENSION_NAME, VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME,
                             VK_KHR_DEVICE_GROUP_EXTENSION_NAME}) {
        deviceExtensions.push_back(name);
    }
    auto timeline =
        make<VkPhysicalDeviceTimelineSemaphoreFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES);
    timeline.timelineSemaphore = VK_TRUE;
    timeline.pNext = moreFeatures();
    auto deviceInfo = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    // A feature may not be asked for twice, and all of Vulkan 1.2 are in one structure.
    deviceInfo.pNext = hasFeaturesOf12(timeline.pNext) ? timeline.pNext : &timeline;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    deviceInfo.enabledExtensionCount = static_cast<uint32_t>(deviceExtensions.size());
    deviceInfo.ppEnabledExtensionNames = deviceExtensions.data();
    deviceInfo.pEnabledFeatures = &features;
    ASSERT_EQ(vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device), VK_SUCCESS);
    vkGetDeviceQueue(device, 0, 0, &queue);
    ASSERT_NE(queue, nullptr);
    auto poolInfo = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    ASSERT_EQ(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), VK_SUCCESS);
}

void VulkanTest::TearDown() {
    if (device != VK_NULL_HANDLE) vkDeviceWaitIdle(device);
    while (!deferred_.empty()) {
        deferred_.back()();
        deferred_.pop_back();
    }
    if (device != VK_NULL_HANDLE) {
        vkDestroyCommandPool(device, pool, nullptr);
        vkDestroyDevice(device, nullptr);
    }
    if (instance != VK_NULL_HANDLE) {
        ofInstance<PFN_vkDestroyDebugUtilsMessengerEXT>("vkDestroyDebugUtilsMessengerEXT")(instance, messenger_,
                                                                                           nullptr);
        vkDestroyInstance(instance, nullptr);
    }
}

TestBuffer VulkanTest::makeBuffer(VkDeviceSize size, VkBufferUsageFlags usage) {
    TestBuffer result;
    result.size = size;
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = size;
    info.usage = usage;
    EXPECT_EQ(vkCreateBuffer(device, &info, nullptr, &result.buffer), VK_SUCCESS);
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, result.buffer, &needs);
    EXPECT_EQ(needs.memoryTypeBits, 1u);
    EXPECT_GE(needs.size, size);
    auto flags = make<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    result.memory = allocate(needs.size, (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0 ? &flags : nullptr);
    EXPECT_EQ(vkBindBufferMemory(device, result.buffer, result.memory, 0), VK_SUCCESS);
    EXPECT_EQ(vkMapMemory(device, result.memory, 0, VK_WHOLE_SIZE, 0, &result.data), VK_SUCCESS);
    defer([this, buffer = result.buffer] { vkDestroyBuffer(device, buffer, nullptr); });
    return result;
}

VkDeviceMemory VulkanTest::allocate(VkDeviceSize size, const void* chain, VkResult expected) {
    auto info = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, chain);
    info.allocationSize = size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateMemory(device, &info, nullptr, &memory), expected);
    defer([this, memory] { vkFreeMemory(device, memory, nullptr); });
    return memory;
}

TestImage VulkanTest::makeImage(const VkImageCreateInfo& info) {
    TestImage result;
    result.format = info.format;
    result.extent = {info.extent.width, info.extent.height};
    EXPECT_EQ(vkCreateImage(device, &info, nullptr, &result.image), VK_SUCCESS);
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, result.image, &needs);
    result.memory = allocate(needs.size);
    EXPECT_EQ(vkBindImageMemory(device, result.image, result.memory, 0), VK_SUCCESS);
    defer([this, image = result.image] { vkDestroyImage(device, image, nullptr); });
    return result;
}

VkImageView VulkanTest::makeView(VkImage image, VkImageViewType type, VkFormat format,
                                 const VkImageSubresourceRange& range, const void* chain) {
    auto info = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, chain);
    info.image = image;
    info.viewType = type;
    info.format = format;
    info.subresourceRange = range;
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateImageView(device, &info, nullptr, &view), VK_SUCCESS);
    defer([this, view] { vkDestroyImageView(device, view, nullptr); });
    return view;
}

TestImage VulkanTest::makeImage(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage,
                                VkSampleCountFlagBits samples, uint32_t layers) {
    auto info = flatImage(format, extent, usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    info.arrayLayers = layers;
    info.samples = samples;
    TestImage result = makeImage(info);
    const bool both = format == VK_FORMAT_D32_SFLOAT_S8_UINT;
    const bool depth = both || format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    if (depth) aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    if (both) aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
    result.view = makeView(result.image, layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, format,
                           {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS});
    return result;
}

VkShaderModule VulkanTest::makeShader(VkShaderStageFlagBits stage, const std::string& glsl) {
    return makeShader(compileGlsl(stage, glsl, apiVersion()));
}

VkShaderModule VulkanTest::makeShader(const std::vector<uint32_t>& words) {
    auto info = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = words.size() * sizeof(uint32_t);
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateShaderModule(device, &info, nullptr, &module), VK_SUCCESS)
        << (messages.empty() ? "" : messages.back());
    defer([this, module] { vkDestroyShaderModule(device, module, nullptr); });
    return module;
}

VkQueryPool VulkanTest::makeQueries(VkQueryType type, uint32_t count, VkQueryPipelineStatisticFlags statistics) {
    auto info = make<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = type;
    info.queryCount = count;
    info.pipelineStatistics = statistics;
    VkQueryPool queries = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateQueryPool(device, &info, nullptr, &queries), VK_SUCCESS);
    defer([this, queries] { vkDestroyQueryPool(device, queries, nullptr); });
    return queries;
}

VkCommandBuffer VulkanTest::makeCommands(VkCommandBufferLevel level) {
    auto allocation = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    allocation.commandPool = pool;
    allocation.level = level;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateCommandBuffers(device, &allocation, &commands), VK_SUCCESS);
    return commands;
}

VkCommandBuffer VulkanTest::begin() {
    const VkCommandBuffer commands = makeCommands(VK_COMMAND_BUFFER_LEVEL_PRIMARY);
    const auto info = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    EXPECT_EQ(vkBeginCommandBuffer(commands, &info), VK_SUCCESS);
    return commands;
}

void VulkanTest::submit(VkCommandBuffer commands) {
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    const auto fenceInfo = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkFence fence = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateFence(device, &fenceInfo, nullptr, &fence), VK_SUCCESS);
    auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &info, fence), VK_SUCCESS);
    ASSERT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    vkDestroyFence(device, fence, nullptr);
    vkFreeCommandBuffers(device, pool, 1, &commands);
}

std::vector<uint8_t> VulkanTest::readImage(const TestImage& image, VkImageAspectFlags aspect, uint32_t texelBytes,
                                           uint32_t layer) {
    const VkDeviceSize size = VkDeviceSize{texelBytes} * image.extent.width * image.extent.height;
    const TestBuffer buffer = makeBuffer(size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    VkBufferImageCopy region{};
    region.imageSubresource = {aspect, 0, layer, 1};
    region.imageExtent = {image.extent.width, image.extent.height, 1};
    vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.buffer, 1, &region);
    submit(commands);
    std::vector<uint8_t> texels(size);
    std::memcpy(texels.data(), buffer.data, size);
    return texels;
}

void changeLayout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspects, VkImageLayout from,
                  VkImageLayout to) {
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspects, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace vernier::test
