// Vulkan 1.1: what it brings beside what extensions brought before, by the names that core has.
#include <set>

#include "tests/vulkan/test_pipeline.h"

namespace vernier::test {
namespace {

class Core11Test : public DrawTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
};

TEST_F(Core11Test, everyCommandIsThere) {
    VERNIER_SKIP_WHEN_VALIDATED();
    // By the names that core has, without the extensions that had them before.
    for (const char* name :
         {"vkBindBufferMemory2", "vkBindImageMemory2", "vkGetDeviceGroupPeerMemoryFeatures", "vkCmdSetDeviceMask",
          "vkCmdDispatchBase", "vkGetImageMemoryRequirements2", "vkGetBufferMemoryRequirements2",
          "vkGetImageSparseMemoryRequirements2", "vkTrimCommandPool", "vkGetDeviceQueue2",
          "vkCreateSamplerYcbcrConversion", "vkDestroySamplerYcbcrConversion", "vkCreateDescriptorUpdateTemplate",
          "vkDestroyDescriptorUpdateTemplate", "vkUpdateDescriptorSetWithTemplate",
          "vkGetDescriptorSetLayoutSupport"}) {
        EXPECT_NE(vkGetDeviceProcAddr(device, name), nullptr) << name;
    }
    for (const char* name :
         {"vkEnumeratePhysicalDeviceGroups", "vkGetPhysicalDeviceFeatures2", "vkGetPhysicalDeviceProperties2",
          "vkGetPhysicalDeviceFormatProperties2", "vkGetPhysicalDeviceImageFormatProperties2",
          "vkGetPhysicalDeviceQueueFamilyProperties2", "vkGetPhysicalDeviceMemoryProperties2",
          "vkGetPhysicalDeviceSparseImageFormatProperties2", "vkGetPhysicalDeviceExternalBufferProperties",
          "vkGetPhysicalDeviceExternalFenceProperties", "vkGetPhysicalDeviceExternalSemaphoreProperties"}) {
        EXPECT_NE(vkGetInstanceProcAddr(instance, name), nullptr) << name;
    }
}

TEST_F(Core11Test, mandatoryFeatures) {
    EXPECT_TRUE(
        features<VkPhysicalDeviceMultiviewFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES).multiview);
    EXPECT_TRUE(features<VkPhysicalDevice16BitStorageFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES)
                    .storageBuffer16BitAccess);
    EXPECT_TRUE(
        features<VkPhysicalDeviceVariablePointersFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VARIABLE_POINTERS_FEATURES)
            .variablePointersStorageBuffer);
    // Truths about what is not there: every structure of the chain is written.
    auto hidden =
        make<VkPhysicalDeviceProtectedMemoryFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROTECTED_MEMORY_FEATURES);
    hidden.protectedMemory = VK_TRUE;
    auto ycbcr = make<VkPhysicalDeviceSamplerYcbcrConversionFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SAMPLER_YCBCR_CONVERSION_FEATURES, &hidden);
    auto all = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &ycbcr);
    vkGetPhysicalDeviceFeatures2(physicalDevice, &all);
    EXPECT_FALSE(hidden.protectedMemory);
    EXPECT_TRUE(ycbcr.samplerYcbcrConversion);
    EXPECT_TRUE(all.features.robustBufferAccess);
}

TEST_F(Core11Test, mandatoryLimits) {
    EXPECT_GE(
        properties<VkPhysicalDeviceMaintenance3Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES)
            .maxPerSetDescriptors,
        1024u);
    EXPECT_GE(
        properties<VkPhysicalDeviceMaintenance3Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES)
            .maxMemoryAllocationSize,
        VkDeviceSize{1} << 30);
    const auto views =
        properties<VkPhysicalDeviceMultiviewProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_PROPERTIES);
    EXPECT_GE(views.maxMultiviewViewCount, 6u);
    EXPECT_GE(views.maxMultiviewInstanceIndex, (1u << 27) - 1);
    const auto protectedMemory = properties<VkPhysicalDeviceProtectedMemoryProperties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROTECTED_MEMORY_PROPERTIES);
    EXPECT_FALSE(protectedMemory.protectedNoFault);
}

TEST_F(Core11Test, idsTellDevicesAndDriversApart) {
    const auto ids = properties<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
    const uint8_t zeros[VK_UUID_SIZE] = {};
    EXPECT_NE(std::memcmp(ids.deviceUUID, zeros, VK_UUID_SIZE), 0);
    EXPECT_NE(std::memcmp(ids.driverUUID, zeros, VK_UUID_SIZE), 0);
    EXPECT_NE(std::memcmp(ids.driverUUID, ids.deviceUUID, VK_UUID_SIZE), 0);
    EXPECT_FALSE(ids.deviceLUIDValid);
    // Another instance gives the same device the same name.
    const VkPhysicalDevice before = physicalDevice;
    const auto info = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.apiVersion = VK_API_VERSION_1_1;
    auto withVersion = info;
    withVersion.pApplicationInfo = &application;
    for (const char* profile : {"standard", "reference"}) {
        setenv("VERNIER_PROFILE", profile, 1);
        VkInstance other = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateInstance(&withVersion, nullptr, &other), VK_SUCCESS);
        uint32_t count = 1;
        ASSERT_EQ(vkEnumeratePhysicalDevices(other, &count, &physicalDevice), VK_SUCCESS);
        const auto again = properties<VkPhysicalDeviceIDProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES);
        EXPECT_EQ(std::memcmp(again.deviceUUID, ids.deviceUUID, VK_UUID_SIZE) == 0, std::string(profile) == "standard");
        vkDestroyInstance(other, nullptr);
    }
    unsetenv("VERNIER_PROFILE");
    physicalDevice = before;
}

TEST_F(Core11Test, queuesByDescription) {
    auto info = make<VkDeviceQueueInfo2>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_INFO_2);
    VkQueue same = VK_NULL_HANDLE;
    vkGetDeviceQueue2(device, &info, &same);
    EXPECT_EQ(same, queue);
    if (validated()) return;
    info.flags = VK_DEVICE_QUEUE_CREATE_PROTECTED_BIT;
    vkGetDeviceQueue2(device, &info, &same);
    EXPECT_EQ(same, VkQueue{VK_NULL_HANDLE});
}

TEST_F(Core11Test, memoryAndTemplatesByTheNamesOfCore) {
    auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = 100;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
    auto about = make<VkBufferMemoryRequirementsInfo2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_REQUIREMENTS_INFO_2);
    about.buffer = buffer;
    auto dedicated = make<VkMemoryDedicatedRequirements>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_REQUIREMENTS);
    auto needs = make<VkMemoryRequirements2>(VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, &dedicated);
    vkGetBufferMemoryRequirements2(device, &about, &needs);
    EXPECT_FALSE(dedicated.requiresDedicatedAllocation);
    auto forBuffer = make<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
    forBuffer.buffer = buffer;
    auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &forBuffer);
    allocation.allocationSize = needs.memoryRequirements.size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateMemory(device, &allocation, nullptr, &memory), VK_SUCCESS);
    auto bind = make<VkBindBufferMemoryInfo>(VK_STRUCTURE_TYPE_BIND_BUFFER_MEMORY_INFO);
    bind.buffer = buffer;
    bind.memory = memory;
    ASSERT_EQ(vkBindBufferMemory2(device, 1, &bind), VK_SUCCESS);
    const VkCommandBuffer commands = begin();
    vkCmdFillBuffer(commands, buffer, 0, 100, 0x01020304);
    submit(commands);
    void* data = nullptr;
    ASSERT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    EXPECT_EQ(static_cast<uint32_t*>(data)[24], 0x01020304u);
    vkTrimCommandPool(device, pool, 0);
    vkDestroyBuffer(device, buffer, nullptr);
    vkFreeMemory(device, memory, nullptr);
}

}  // namespace
}  // namespace vernier::test
