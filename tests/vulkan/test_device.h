// What the driver's tests share: a device reached through the unmodified Vulkan loader, and the few lines
// that every test would write again. Handles are destroyed with the device.
#pragma once

#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "tests/vulkan/structures.h"
#include "tests/vulkan/validated.h"

namespace vernier::test {

/// Points the loader to a driver's manifest, or to the driver of this build. Call before instances are made.
void useDriver(const char* manifest);
void useOwnDriver();

/// GLSL to SPIR-V for a version of core Vulkan; the test fails when it does not compile.
std::vector<uint32_t> compileGlsl(VkShaderStageFlagBits stage, const std::string& source,
                                  uint32_t apiVersion = VK_API_VERSION_1_0);

struct TestBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* data = nullptr;  // mapped
    VkDeviceSize size = 0;
};

struct TestImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
};

#define VERNIER_SKIP_WHEN_VALIDATED() \
    if (::vernier::test::validated()) GTEST_SKIP() << "invalid use, or questions to the driver alone"

/// A fixture with an instance, a device and a queue, all features on.
class VulkanTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;
    /// The manifest of the driver.
    virtual const char* driver();
    /// The version of core Vulkan that the instance is made for.
    virtual uint32_t apiVersion() { return VK_API_VERSION_1_0; }
    /// Extensions that the instance gets besides those every test has.
    virtual std::vector<const char*> moreInstanceExtensions() { return {}; }
    /// Extensions that the device gets besides those every test has, and their features: a chain, or nullptr.
    virtual std::vector<const char*> moreExtensions() { return {}; }
    virtual void* moreFeatures() { return nullptr; }

    TestBuffer makeBuffer(VkDeviceSize size, VkBufferUsageFlags usage);
    TestImage makeImage(VkFormat format, VkExtent2D extent, VkImageUsageFlags usage,
                        VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT, uint32_t layers = 1);
    /// As described, with memory of its own; it has no view.
    TestImage makeImage(const VkImageCreateInfo& info);
    VkImageView makeView(VkImage image, VkImageViewType type, VkFormat format, const VkImageSubresourceRange& range,
                         const void* chain = nullptr);
    /// Memory that is freed at the end, where it is `expected` to be had.
    VkDeviceMemory allocate(VkDeviceSize size, const void* chain = nullptr, VkResult expected = VK_SUCCESS);
    VkShaderModule makeShader(VkShaderStageFlagBits stage, const std::string& glsl);
    /// Of SPIR-V.
    VkShaderModule makeShader(const std::vector<uint32_t>& words);
    /// `statistics`: of queries that count those.
    VkQueryPool makeQueries(VkQueryType type, uint32_t count = 1, VkQueryPipelineStatisticFlags statistics = 0);
    /// Of the test's pool; not begun.
    VkCommandBuffer makeCommands(VkCommandBufferLevel level);
    /// A primary command buffer.
    VkCommandBuffer begin();
    /// Ends, submits and waits.
    void submit(VkCommandBuffer commands);
    /// The texels of level 0 of a layer, tightly packed.
    std::vector<uint8_t> readImage(const TestImage& image, VkImageAspectFlags aspect, uint32_t texelBytes,
                                   uint32_t layer = 0);
    /// A device command of an extension.
    template <class Function>
    Function command(const char* name) const {
        return reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
    }
    /// Likewise, of the instance.
    template <class Function>
    Function ofInstance(const char* name) const {
        return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
    }

    /// A structure of features, as the device fills it in.
    template <class T>
    T features(VkStructureType type) const {
        T part = make<T>(type);
        auto all = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &part);
        vkGetPhysicalDeviceFeatures2(physicalDevice, &all);
        return part;
    }
    /// Likewise, of properties.
    template <class T>
    T properties(VkStructureType type) const {
        T part = make<T>(type);
        auto all = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &part);
        vkGetPhysicalDeviceProperties2(physicalDevice, &all);
        return part;
    }

    /// Remembers how to destroy something; done in reverse order at the end.
    void defer(std::function<void()> destroy) { deferred_.push_back(std::move(destroy)); }

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    std::vector<std::string> messages;  // what the driver said through VK_EXT_debug_utils

  private:
    std::vector<std::function<void()>> deferred_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// All of the image, once everything before is done, and before everything after.
void changeLayout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspects, VkImageLayout from,
                  VkImageLayout to);

}  // namespace vernier::test
