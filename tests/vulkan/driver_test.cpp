// What the driver says about itself: identity, entry points, extensions, features, limits, formats.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <set>

#include "tests/vulkan/test_device.h"

namespace vernier::test {
namespace {

class DriverTest : public VulkanTest {};

TEST_F(DriverTest, identityIsItsOwn) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physicalDevice, &properties);
    EXPECT_EQ(std::string(properties.deviceName).rfind("Vernier (software, ", 0), 0u) << properties.deviceName;
    EXPECT_EQ(properties.deviceType, VK_PHYSICAL_DEVICE_TYPE_CPU);
    EXPECT_EQ(properties.vendorID, 0x56524Eu);
    EXPECT_NE(properties.vendorID, static_cast<uint32_t>(VK_VENDOR_ID_MESA));
    EXPECT_EQ(VK_API_VERSION_MAJOR(properties.apiVersion), 1u);
    EXPECT_EQ(VK_API_VERSION_MINOR(properties.apiVersion), 3u);
    uint32_t ofInstance = 0;
    EXPECT_EQ(vkEnumerateInstanceVersion(&ofInstance), VK_SUCCESS);
    EXPECT_GE(ofInstance, VK_API_VERSION_1_1);
}

TEST_F(DriverTest, environmentChoosesTypeAndProfile) {
    const auto create = [](VkInstance* made) {
        const auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
        return vkCreateInstance(&info, nullptr, made);
    };
    setenv("VERNIER_DEVICE_TYPE", "integrated", 1);
    setenv("VERNIER_PROFILE", "draft", 1);
    VkInstance other = VK_NULL_HANDLE;
    ASSERT_EQ(create(&other), VK_SUCCESS);
    uint32_t count = 1;
    VkPhysicalDevice chosen = VK_NULL_HANDLE;
    ASSERT_EQ(vkEnumeratePhysicalDevices(other, &count, &chosen), VK_SUCCESS);
    VkPhysicalDeviceProperties properties{}, standard{};
    vkGetPhysicalDeviceProperties(chosen, &properties);
    vkGetPhysicalDeviceProperties(physicalDevice, &standard);
    EXPECT_EQ(properties.deviceType, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);
    EXPECT_LE(properties.limits.subPixelPrecisionBits, standard.limits.subPixelPrecisionBits);
    EXPECT_NE(memcmp(properties.pipelineCacheUUID, standard.pipelineCacheUUID, VK_UUID_SIZE), 0);
    vkDestroyInstance(other, nullptr);

    setenv("VERNIER_PROFILE", "exactish", 1);
    EXPECT_NE(create(&other), VK_SUCCESS) << "an unknown profile must be refused";
    setenv("VERNIER_PROFILE", "standard,", 1);
    EXPECT_NE(create(&other), VK_SUCCESS) << "an empty name must be refused";
    unsetenv("VERNIER_PROFILE");
    setenv("VERNIER_THREADS", "257", 1);
    EXPECT_NE(create(&other), VK_SUCCESS) << "more threads than a device takes must be refused";
    unsetenv("VERNIER_THREADS");
    setenv("VERNIER_SKIP", "everything=off", 1);
    EXPECT_NE(create(&other), VK_SUCCESS) << "an unknown rule must be refused";
    unsetenv("VERNIER_SKIP");
    unsetenv("VERNIER_DEVICE_TYPE");
}

TEST_F(DriverTest, accuraciesAreDevicesWhenAskedFor) {
    setenv("VERNIER_PROFILE", "standard,reference", 1);
    setenv("VERNIER_AXIS_SUBPIXEL", "12", 1);
    const auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    VkInstance other = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateInstance(&info, nullptr, &other), VK_SUCCESS);
    uint32_t count = 0;
    ASSERT_EQ(vkEnumeratePhysicalDevices(other, &count, nullptr), VK_SUCCESS);
    ASSERT_EQ(count, 2u);
    VkPhysicalDevice devices[2];
    ASSERT_EQ(vkEnumeratePhysicalDevices(other, &count, devices), VK_SUCCESS);
    VkPhysicalDeviceProperties properties[2];
    for (uint32_t i = 0; i < 2; ++i) {
        vkGetPhysicalDeviceProperties(devices[i], &properties[i]);
        EXPECT_EQ(properties[i].limits.subPixelPrecisionBits, 12u);
    }
    EXPECT_NE(std::string(properties[1].deviceName).find("reference, subpixel=12"), std::string::npos)
        << properties[1].deviceName;
    EXPECT_NE(memcmp(properties[0].pipelineCacheUUID, properties[1].pipelineCacheUUID, VK_UUID_SIZE), 0);
    vkDestroyInstance(other, nullptr);

    setenv("VERNIER_AXIS_SUBPIXEL", "7", 1);
    EXPECT_NE(vkCreateInstance(&info, nullptr, &other), VK_SUCCESS) << "an unknown position must be refused";
    unsetenv("VERNIER_AXIS_SUBPIXEL");
    unsetenv("VERNIER_PROFILE");
}

struct CoreCommand {
    const char* name;
    enum class Level { loader, instance, physicalDevice, device } level;
    bool implemented;
};
constexpr CoreCommand kCoreCommands[] = {
#define VERNIER_CORE_COMMAND(name, level, implemented) {#name, CoreCommand::Level::level, implemented},
#include "core_commands.inc"
#undef VERNIER_CORE_COMMAND
};

TEST_F(DriverTest, deviceCommandsAreThereOrNull) {
    VERNIER_SKIP_WHEN_VALIDATED();  // the layer has every command
    for (const CoreCommand& command : kCoreCommands) {
        if (command.level != CoreCommand::Level::device) continue;
        EXPECT_EQ(vkGetDeviceProcAddr(device, command.name) != nullptr, command.implemented) << command.name;
        EXPECT_TRUE(command.implemented) << command.name;
    }
    for (const char* name : {"vkNoSuchCommand", "vkCreateSwapchainKHR", "vkAcquireNextImage2KHR", "vkQueueSubmit2KHR",
                             "vkGetDescriptorSetLayoutSupportKHR", "vkGetPhysicalDeviceFeatures", "vkCreateInstance"}) {
        EXPECT_EQ(vkGetDeviceProcAddr(device, name), nullptr) << name;
    }
    EXPECT_NE(vkGetDeviceProcAddr(device, "vkWaitSemaphoresKHR"), nullptr) << "its extension is enabled";
}

TEST(DriverLibrary, speaksToTheLoaderDirectly) {
    void* library = dlopen(VERNIER_ICD_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library, nullptr) << dlerror();
    const auto negotiate =
        reinterpret_cast<VkResult (*)(uint32_t*)>(dlsym(library, "vk_icdNegotiateLoaderICDInterfaceVersion"));
    const auto get = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vk_icdGetInstanceProcAddr"));
    ASSERT_NE(negotiate, nullptr);
    ASSERT_NE(get, nullptr);
    EXPECT_EQ(dlsym(library, "vkGetInstanceProcAddr"), nullptr);
    for (const auto& [asked, expected] : {std::pair{5u, 5u}, {7u, 7u}, {99u, 7u}}) {
        uint32_t version = asked;
        EXPECT_EQ(negotiate(&version), VK_SUCCESS);
        EXPECT_EQ(version, expected);
    }
    uint32_t old = 2;
    EXPECT_EQ(negotiate(&old), VK_ERROR_INCOMPATIBLE_DRIVER);
    for (const char* name : {"vkCreateInstance", "vkEnumerateInstanceExtensionProperties", "vkGetInstanceProcAddr",
                             "vkEnumerateInstanceVersion", "vk_icdNegotiateLoaderICDInterfaceVersion"}) {
        EXPECT_NE(get(nullptr, name), nullptr) << name;
    }
    for (const char* name : {"vkCreateDevice", "vkQueueSubmit", "vkDestroySurfaceKHR"}) {
        EXPECT_EQ(get(nullptr, name), nullptr) << name;
    }
    dlclose(library);
}

TEST_F(DriverTest, featuresNotListedAreRefused) {
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physicalDevice, &features);
    ASSERT_EQ(features.sparseBinding, VK_FALSE);
    VkPhysicalDeviceFeatures wanted{};
    wanted.sparseBinding = VK_TRUE;
    const float priority = 1;
    auto queueInfo = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    auto info = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.pEnabledFeatures = &wanted;
    VkDevice refused = VK_NULL_HANDLE;
    EXPECT_EQ(vkCreateDevice(physicalDevice, &info, nullptr, &refused), VK_ERROR_FEATURE_NOT_PRESENT);
    // The loader adds a message of its own.
    EXPECT_THAT(messages, testing::Contains(testing::HasSubstr("sparseBinding")));
}

TEST_F(DriverTest, enumerationsFollowTheTwoCallIdiom) {
    uint32_t count = 0;
    ASSERT_EQ(vkEnumerateDeviceExtensionProperties(physicalDevice, nullptr, &count, nullptr), VK_SUCCESS);
    ASSERT_GT(count, 1u);
    std::vector<VkExtensionProperties> all(count);
    ASSERT_EQ(vkEnumerateDeviceExtensionProperties(physicalDevice, nullptr, &count, all.data()), VK_SUCCESS);
    std::set<std::string> names;
    for (const auto& extension : all) EXPECT_TRUE(names.insert(extension.extensionName).second);
    uint32_t tooFew = 1;
    EXPECT_EQ(vkEnumerateDeviceExtensionProperties(physicalDevice, nullptr, &tooFew, all.data()), VK_INCOMPLETE);
    EXPECT_EQ(tooFew, 1u);
}

/// The tables "Required Format Support" that a device without compression must meet, the corner cases of
/// them.
TEST_F(DriverTest, mandatoryFormats) {
    const auto optimal = [&](VkFormat format) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(physicalDevice, format, &properties);
        return properties.optimalTilingFeatures;
    };
    constexpr VkFormatFeatureFlags kColor =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT |
        VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
    for (const VkFormat format :
         {VK_FORMAT_R5G6B5_UNORM_PACK16, VK_FORMAT_A1R5G5B5_UNORM_PACK16, VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8_UNORM,
          VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB,
          VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT}) {
        EXPECT_EQ(optimal(format) & kColor, kColor) << format;
    }
    EXPECT_TRUE(optimal(VK_FORMAT_D16_UNORM) & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
    EXPECT_TRUE((optimal(VK_FORMAT_D24_UNORM_S8_UINT) | optimal(VK_FORMAT_D32_SFLOAT_S8_UINT)) &
                VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
    EXPECT_EQ(optimal(VK_FORMAT_UNDEFINED), 0u);
    if (!validated()) {
        EXPECT_EQ(optimal(static_cast<VkFormat>(0x7FFFFFF0)), 0u);
    }

    VkImageFormatProperties image{};
    EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties(physicalDevice, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D,
                                                       VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0,
                                                       &image),
              VK_SUCCESS);
    EXPECT_TRUE(image.sampleCounts & VK_SAMPLE_COUNT_4_BIT);
    EXPECT_GE(image.maxExtent.width, 4096u);
    EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties(physicalDevice, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D,
                                                       VK_IMAGE_TILING_OPTIMAL,
                                                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, &image),
              VK_ERROR_FORMAT_NOT_SUPPORTED);
}

TEST_F(DriverTest, oneHeapOneTypeOneQueueFamily) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    ASSERT_EQ(memory.memoryHeapCount, 1u);
    ASSERT_EQ(memory.memoryTypeCount, 1u);
    EXPECT_GT(memory.memoryHeaps[0].size, 64u << 20);
    uint32_t count = 4;
    VkQueueFamilyProperties families[4];
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families);
    ASSERT_EQ(count, 1u);
    EXPECT_EQ(families[0].queueFlags,
              VkQueueFlags{VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT});
}

TEST_F(DriverTest, oneGroupOfOneDevice) {
    const auto enumerate = reinterpret_cast<PFN_vkEnumeratePhysicalDeviceGroupsKHR>(
        vkGetInstanceProcAddr(instance, "vkEnumeratePhysicalDeviceGroupsKHR"));
    ASSERT_NE(enumerate, nullptr);
    uint32_t count = 3;
    VkPhysicalDeviceGroupProperties groups[3];
    for (auto& group : groups)
        group = make<VkPhysicalDeviceGroupProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_GROUP_PROPERTIES);
    ASSERT_EQ(enumerate(instance, &count, groups), VK_SUCCESS);
    ASSERT_EQ(count, 1u);
    EXPECT_EQ(groups[0].physicalDeviceCount, 1u);
    EXPECT_EQ(groups[0].physicalDevices[0], physicalDevice);
}

TEST_F(DriverTest, moreMemoryThanTheHeapHasIsRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    auto tooMuch = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    tooMuch.allocationSize = memory.memoryHeaps[0].size + 1;
    VkDeviceMemory refused = VK_NULL_HANDLE;
    EXPECT_EQ(vkAllocateMemory(device, &tooMuch, nullptr, &refused), VK_ERROR_OUT_OF_DEVICE_MEMORY);
}

}  // namespace
}  // namespace vernier::test
