// Memory, semaphores and fences that leave the device by file descriptors, inside this process and to another one, and
// memory of the host's.
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/vulkan/test_device.h"

extern char** environ;

namespace vernier::test {
namespace {

constexpr uint64_t kLong = 20'000'000'000, kShort = 20'000'000;
constexpr VkDeviceSize kBytes = 65536;
/// Tells the process that ExternalTest.anotherProcess starts the descriptors it was given.
constexpr const char* kPeerVariable = "VERNIER_TEST_PEER";

class ExternalTest : public VulkanTest {
  protected:
    uint32_t apiVersion() override { return VK_API_VERSION_1_1; }
    std::vector<const char*> moreExtensions() override {
        return {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME,
                VK_KHR_EXTERNAL_FENCE_FD_EXTENSION_NAME, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME};
    }

    // --- Memory

    VkDeviceMemory allocate(VkDeviceSize size, const void* chain, VkResult expected = VK_SUCCESS) {
        auto info = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        info.pNext = chain;
        info.allocationSize = size;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        EXPECT_EQ(vkAllocateMemory(device, &info, nullptr, &memory), expected);
        if (memory != VK_NULL_HANDLE) defer([this, memory] { vkFreeMemory(device, memory, nullptr); });
        return memory;
    }
    VkDeviceMemory exportable(VkDeviceSize size) {
        auto info = make<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
        info.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        return allocate(size, &info);
    }
    VkDeviceMemory import(int fd, VkDeviceSize size, VkResult expected = VK_SUCCESS) {
        auto info = make<VkImportMemoryFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR);
        info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        info.fd = fd;
        return allocate(size, &info, expected);
    }
    int fdOf(VkDeviceMemory memory) {
        auto info = make<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
        info.memory = memory;
        info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        int fd = -1;
        EXPECT_EQ(command<PFN_vkGetMemoryFdKHR>("vkGetMemoryFdKHR")(device, &info, &fd), VK_SUCCESS);
        EXPECT_GE(fd, 0);
        return fd;
    }
    uint8_t* map(VkDeviceMemory memory) {
        void* data = nullptr;
        EXPECT_EQ(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
        return static_cast<uint8_t*>(data);
    }
    VkBuffer bufferOn(VkDeviceMemory memory, VkDeviceSize size, VkExternalMemoryHandleTypeFlags type) {
        auto external = make<VkExternalMemoryBufferCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO);
        external.handleTypes = type;
        auto info = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
        info.pNext = &external;
        info.size = size;
        info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        VkBuffer buffer = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateBuffer(device, &info, nullptr, &buffer), VK_SUCCESS);
        defer([this, buffer] { vkDestroyBuffer(device, buffer, nullptr); });
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(device, buffer, &needs);
        EXPECT_LE(needs.size, size);
        EXPECT_EQ(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
        return buffer;
    }

    // --- Semaphores and fences

    VkSemaphore makeSemaphore(bool exported, bool timeline = false, uint64_t value = 0) {
        auto type = make<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
        type.semaphoreType = timeline ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY;
        type.initialValue = value;
        auto out = make<VkExportSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_SEMAPHORE_CREATE_INFO);
        out.pNext = &type;
        out.handleTypes = exported ? VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
        auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        info.pNext = &out;
        VkSemaphore semaphore = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
        defer([this, semaphore] { vkDestroySemaphore(device, semaphore, nullptr); });
        return semaphore;
    }
    int fdOf(VkSemaphore semaphore) {
        auto info = make<VkSemaphoreGetFdInfoKHR>(VK_STRUCTURE_TYPE_SEMAPHORE_GET_FD_INFO_KHR);
        info.semaphore = semaphore;
        info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
        int fd = -1;
        EXPECT_EQ(command<PFN_vkGetSemaphoreFdKHR>("vkGetSemaphoreFdKHR")(device, &info, &fd), VK_SUCCESS);
        return fd;
    }
    VkResult import(VkSemaphore semaphore, int fd, VkSemaphoreImportFlags flags = 0) {
        auto info = make<VkImportSemaphoreFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_SEMAPHORE_FD_INFO_KHR);
        info.semaphore = semaphore;
        info.flags = flags;
        info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
        info.fd = fd;
        return command<PFN_vkImportSemaphoreFdKHR>("vkImportSemaphoreFdKHR")(device, &info);
    }
    VkFence makeFence(bool exported, bool signalled = false) {
        auto out = make<VkExportFenceCreateInfo>(VK_STRUCTURE_TYPE_EXPORT_FENCE_CREATE_INFO);
        out.handleTypes = exported ? VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT : 0;
        auto info = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        info.pNext = &out;
        info.flags = signalled ? VK_FENCE_CREATE_SIGNALED_BIT : 0;
        VkFence fence = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateFence(device, &info, nullptr, &fence), VK_SUCCESS);
        defer([this, fence] { vkDestroyFence(device, fence, nullptr); });
        return fence;
    }
    int fdOf(VkFence fence) {
        auto info = make<VkFenceGetFdInfoKHR>(VK_STRUCTURE_TYPE_FENCE_GET_FD_INFO_KHR);
        info.fence = fence;
        info.handleType = VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT;
        int fd = -1;
        EXPECT_EQ(command<PFN_vkGetFenceFdKHR>("vkGetFenceFdKHR")(device, &info, &fd), VK_SUCCESS);
        return fd;
    }
    VkResult import(VkFence fence, int fd, VkFenceImportFlags flags = 0) {
        auto info = make<VkImportFenceFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_FENCE_FD_INFO_KHR);
        info.fence = fence;
        info.flags = flags;
        info.handleType = VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT;
        info.fd = fd;
        return command<PFN_vkImportFenceFdKHR>("vkImportFenceFdKHR")(device, &info);
    }
    VkResult wait(VkFence fence, uint64_t timeout) { return vkWaitForFences(device, 1, &fence, VK_TRUE, timeout); }

    struct Point {
        VkSemaphore semaphore;
        uint64_t value;
    };
    /// Waits, runs, signals; without waiting for it. Empty points are left out.
    void submitBetween(Point before, VkCommandBuffer commands, Point after, VkFence fence = VK_NULL_HANDLE) {
        auto values = make<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
        values.waitSemaphoreValueCount = before.semaphore != VK_NULL_HANDLE ? 1 : 0;
        values.pWaitSemaphoreValues = &before.value;
        values.signalSemaphoreValueCount = after.semaphore != VK_NULL_HANDLE ? 1 : 0;
        values.pSignalSemaphoreValues = &after.value;
        const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        auto info = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
        info.pNext = &values;
        info.waitSemaphoreCount = values.waitSemaphoreValueCount;
        info.pWaitSemaphores = &before.semaphore;
        info.pWaitDstStageMask = &stage;
        info.commandBufferCount = commands != VK_NULL_HANDLE ? 1 : 0;
        info.pCommandBuffers = &commands;
        info.signalSemaphoreCount = values.signalSemaphoreValueCount;
        info.pSignalSemaphores = &after.semaphore;
        ASSERT_EQ(vkQueueSubmit(queue, 1, &info, fence), VK_SUCCESS);
    }
    static constexpr Point kNothing{VK_NULL_HANDLE, 0};
    VkCommandBuffer fill(VkBuffer buffer, uint32_t value) {
        const VkCommandBuffer commands = begin();
        vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, value);
        EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
        return commands;
    }
};

TEST_F(ExternalTest, theDeviceTellsWhatCanBeShared) {
    auto asked = make<VkPhysicalDeviceExternalBufferInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO);
    asked.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const auto buffers = [&](VkExternalMemoryHandleTypeFlagBits type) {
        asked.handleType = type;
        auto told = make<VkExternalBufferProperties>(VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES);
        vkGetPhysicalDeviceExternalBufferProperties(physicalDevice, &asked, &told);
        return told.externalMemoryProperties;
    };
    const VkExternalMemoryProperties fd = buffers(VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
    EXPECT_EQ(fd.externalMemoryFeatures,
              VkFlags{VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT});
    EXPECT_EQ(fd.compatibleHandleTypes, VkFlags{VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT});
    EXPECT_EQ(fd.exportFromImportedHandleTypes, VkFlags{VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT});
    const VkExternalMemoryProperties host = buffers(VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT);
    EXPECT_EQ(host.externalMemoryFeatures, VkFlags{VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT});
    EXPECT_EQ(buffers(VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT).externalMemoryFeatures, 0u);

    auto image =
        make<VkPhysicalDeviceExternalImageFormatInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO);
    auto format = make<VkPhysicalDeviceImageFormatInfo2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2);
    format.pNext = &image;
    format.format = VK_FORMAT_R8G8B8A8_UNORM;
    format.type = VK_IMAGE_TYPE_2D;
    format.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    auto told = make<VkExternalImageFormatProperties>(VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES);
    auto properties = make<VkImageFormatProperties2>(VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2);
    properties.pNext = &told;
    image.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties2(physicalDevice, &format, &properties), VK_SUCCESS);
    EXPECT_EQ(told.externalMemoryProperties.compatibleHandleTypes,
              VkFlags{VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT});
    image.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;
    EXPECT_EQ(vkGetPhysicalDeviceImageFormatProperties2(physicalDevice, &format, &properties),
              VK_ERROR_FORMAT_NOT_SUPPORTED);

    auto semaphore =
        make<VkPhysicalDeviceExternalSemaphoreInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO);
    auto semaphoreTold = make<VkExternalSemaphoreProperties>(VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES);
    semaphore.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT;
    vkGetPhysicalDeviceExternalSemaphoreProperties(physicalDevice, &semaphore, &semaphoreTold);
    EXPECT_EQ(semaphoreTold.externalSemaphoreFeatures, 3u);
    semaphore.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT;
    vkGetPhysicalDeviceExternalSemaphoreProperties(physicalDevice, &semaphore, &semaphoreTold);
    EXPECT_EQ(semaphoreTold.externalSemaphoreFeatures, 0u);
    auto fence = make<VkPhysicalDeviceExternalFenceInfo>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_FENCE_INFO);
    auto fenceTold = make<VkExternalFenceProperties>(VK_STRUCTURE_TYPE_EXTERNAL_FENCE_PROPERTIES);
    fence.handleType = VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT;
    vkGetPhysicalDeviceExternalFenceProperties(physicalDevice, &fence, &fenceTold);
    EXPECT_EQ(fenceTold.externalFenceFeatures, 3u);
}

TEST_F(ExternalTest, importedMemoryIsTheSameMemory) {
    const VkDeviceMemory first = exportable(kBytes);
    const VkDeviceMemory second = import(fdOf(first), kBytes);
    const VkDeviceMemory third = import(fdOf(second), kBytes);  // what was imported can be exported again
    uint8_t *const a = map(first), *const b = map(second), *const c = map(third);
    ASSERT_TRUE(a != nullptr && b != nullptr && c != nullptr);
    EXPECT_NE(a, b);
    EXPECT_EQ(a[kBytes - 1], 0);
    a[0] = 7;
    b[kBytes - 1] = 8;
    EXPECT_EQ(c[0], 7);
    EXPECT_EQ(c[kBytes - 1], 8);
    const VkBuffer buffer = bufferOn(second, kBytes, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
    const VkFence fence = makeFence(false);
    submitBetween(kNothing, fill(buffer, 0x01020304), kNothing, fence);
    ASSERT_EQ(wait(fence, kLong), VK_SUCCESS);
    EXPECT_EQ(a[0], 4);
    EXPECT_EQ(a[kBytes - 1], 1);
}

TEST_F(ExternalTest, theExporterMayGoFirst) {
    auto info = make<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    info.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.pNext = &info;
    allocation.allocationSize = kBytes;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateMemory(device, &allocation, nullptr, &memory), VK_SUCCESS);
    map(memory)[5] = 55;
    vkUnmapMemory(device, memory);
    const int fd = fdOf(memory);
    vkFreeMemory(device, memory, nullptr);
    EXPECT_EQ(map(import(fd, kBytes))[5], 55);
}

TEST_F(ExternalTest, imagesLieInSharedMemory) {
    auto external = make<VkExternalMemoryImageCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO);
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto info = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.pNext = &external;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.extent = {19, 7, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    TestImage images[2];
    for (TestImage& image : images) {
        image.format = info.format;
        image.extent = {info.extent.width, info.extent.height};
        ASSERT_EQ(vkCreateImage(device, &info, nullptr, &image.image), VK_SUCCESS);
        defer([this, made = image.image] { vkDestroyImage(device, made, nullptr); });
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device, image.image, &needs);
        auto dedicated = make<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
        dedicated.image = image.image;
        auto out = make<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
        out.pNext = &dedicated;
        out.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        auto in = make<VkImportMemoryFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR);
        in.pNext = &dedicated;
        in.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        if (&image != images) in.fd = fdOf(images[0].memory);
        image.memory = &image == images ? allocate(needs.size, &out) : allocate(needs.size, &in);
        ASSERT_EQ(vkBindImageMemory(device, image.image, image.memory, 0), VK_SUCCESS);
    }
    const VkCommandBuffer commands = begin();
    auto barrier = make<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.image = images[0].image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
    const VkClearColorValue color{.float32 = {1, 0, 1, 0}};
    vkCmdClearColorImage(commands, images[0].image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1,
                         &barrier.subresourceRange);
    submit(commands);
    if (validated()) return;  // the layer does not know that the second image has the contents of the first
    const std::vector<uint8_t> texels = readImage(images[1], VK_IMAGE_ASPECT_COLOR_BIT, 4);
    for (size_t i = 0; i < texels.size(); ++i) ASSERT_EQ(texels[i], i % 2 == 0 ? 255 : 0);
}

TEST_F(ExternalTest, wrongDescriptorsAreRefused) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkDeviceMemory memory = exportable(kBytes);
    const int fd = fdOf(memory);
    import(fd, kBytes * 2, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    import(-1, kBytes, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    const VkSemaphore semaphore = makeSemaphore(true), timeline = makeSemaphore(true, true, 3);
    EXPECT_EQ(import(semaphore, fd), VK_ERROR_INVALID_EXTERNAL_HANDLE);
    const int semaphoreFd = fdOf(semaphore);
    import(semaphoreFd, kBytes, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    EXPECT_EQ(import(timeline, semaphoreFd), VK_ERROR_INVALID_EXTERNAL_HANDLE);
    EXPECT_EQ(import(makeFence(true), semaphoreFd), VK_ERROR_INVALID_EXTERNAL_HANDLE);
    const int file = open("/proc/self/exe", O_RDONLY);
    import(file, kBytes, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    const int unsealed = memfd_create("other", 0);
    ASSERT_EQ(ftruncate(unsealed, 1 << 20), 0);
    import(unsealed, kBytes, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    // Refused descriptors stay the caller's; nobody can shrink what is shared.
    EXPECT_NE(ftruncate(fd, 0), 0);
    for (const int open : {fd, semaphoreFd, file, unsealed}) EXPECT_EQ(close(open), 0);
    // What was not made to be exported is not.
    auto info = make<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
    info.memory = allocate(kBytes, nullptr);
    info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    int none = 0;
    EXPECT_NE(command<PFN_vkGetMemoryFdKHR>("vkGetMemoryFdKHR")(device, &info, &none), VK_SUCCESS);
    EXPECT_EQ(none, -1);
}

TEST_F(ExternalTest, hostMemoryIsUsedWhereItLies) {
    auto limits = make<VkPhysicalDeviceExternalMemoryHostPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT);
    auto properties = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(physicalDevice, &properties);
    const VkDeviceSize alignment = limits.minImportedHostPointerAlignment;
    ASSERT_GE(alignment, 4096u);
    const VkDeviceSize bytes = 4 * alignment;
    void* const pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(pages, MAP_FAILED);
    auto told = make<VkMemoryHostPointerPropertiesEXT>(VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT);
    ASSERT_EQ(command<PFN_vkGetMemoryHostPointerPropertiesEXT>("vkGetMemoryHostPointerPropertiesEXT")(
                  device, VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT, pages, &told),
              VK_SUCCESS);
    EXPECT_EQ(told.memoryTypeBits, 1u);
    auto info = make<VkImportMemoryHostPointerInfoEXT>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT);
    info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    info.pHostPointer = pages;
    auto allocation = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.pNext = &info;
    allocation.allocationSize = bytes;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    ASSERT_EQ(vkAllocateMemory(device, &allocation, nullptr, &memory), VK_SUCCESS);
    EXPECT_EQ(map(memory), pages);
    const VkBuffer buffer = bufferOn(memory, bytes, VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT);
    const VkFence fence = makeFence(false);
    submitBetween(kNothing, fill(buffer, 0x11223344), kNothing, fence);
    ASSERT_EQ(wait(fence, kLong), VK_SUCCESS);
    EXPECT_EQ(static_cast<uint32_t*>(pages)[bytes / 4 - 1], 0x11223344u);
    vkFreeMemory(device, memory, nullptr);
    EXPECT_EQ(static_cast<uint32_t*>(pages)[0], 0x11223344u);  // still the caller's
    if (!validated()) {
        info.pHostPointer = static_cast<uint8_t*>(pages) + 64;
        allocate(alignment, &info, VK_ERROR_INVALID_EXTERNAL_HANDLE);
    }
    defer([=] { munmap(pages, bytes); });
}

TEST_F(ExternalTest, binarySemaphoresShareASignal) {
    const VkSemaphore first = makeSemaphore(true), second = makeSemaphore(false);
    ASSERT_EQ(import(second, fdOf(first)), VK_SUCCESS);
    const VkFence fences[] = {makeFence(false), makeFence(false)};
    // The second waits on a thread of its own kind: a device has one queue, in order, so the signal comes first.
    for (int round = 0; round < 3; ++round) {
        submitBetween(kNothing, VK_NULL_HANDLE, {first, 0});
        submitBetween({second, 0}, VK_NULL_HANDLE, kNothing, fences[0]);
        ASSERT_EQ(wait(fences[0], kLong), VK_SUCCESS);
        vkResetFences(device, 1, fences);
    }
    // A temporary payload is gone with the first wait; the semaphore's own signal was never touched.
    const VkSemaphore third = makeSemaphore(true);
    submitBetween(kNothing, VK_NULL_HANDLE, {third, 0});
    ASSERT_EQ(vkQueueWaitIdle(queue), VK_SUCCESS);
    ASSERT_EQ(import(third, fdOf(first), VK_SEMAPHORE_IMPORT_TEMPORARY_BIT), VK_SUCCESS);
    submitBetween(kNothing, VK_NULL_HANDLE, {first, 0});
    submitBetween({third, 0}, VK_NULL_HANDLE, kNothing, fences[0]);
    ASSERT_EQ(wait(fences[0], kLong), VK_SUCCESS);
    submitBetween({third, 0}, VK_NULL_HANDLE, kNothing, fences[1]);
    ASSERT_EQ(wait(fences[1], kLong), VK_SUCCESS);
}

TEST_F(ExternalTest, timelineSemaphoresShareACount) {
    const auto value = command<PFN_vkGetSemaphoreCounterValueKHR>("vkGetSemaphoreCounterValueKHR");
    const auto signal = command<PFN_vkSignalSemaphoreKHR>("vkSignalSemaphoreKHR");
    const auto waitFor = command<PFN_vkWaitSemaphoresKHR>("vkWaitSemaphoresKHR");
    const VkSemaphore first = makeSemaphore(true, true, 5), second = makeSemaphore(false, true, 0);
    ASSERT_EQ(import(second, fdOf(first)), VK_SUCCESS);
    uint64_t now = 0;
    ASSERT_EQ(value(device, second, &now), VK_SUCCESS);
    EXPECT_EQ(now, 5u);
    submitBetween({second, 6}, VK_NULL_HANDLE, {second, 9});
    auto info = make<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    const uint64_t nine = 9;
    info.semaphoreCount = 1;
    info.pSemaphores = &first;
    info.pValues = &nine;
    EXPECT_EQ(waitFor(device, &info, kShort), VK_TIMEOUT);
    auto signalInfo = make<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    signalInfo.semaphore = first;
    signalInfo.value = 6;
    ASSERT_EQ(signal(device, &signalInfo), VK_SUCCESS);
    EXPECT_EQ(waitFor(device, &info, kLong), VK_SUCCESS);
}

TEST_F(ExternalTest, fencesShareASignal) {
    const VkFence first = makeFence(true), second = makeFence(false);
    ASSERT_EQ(import(second, fdOf(first)), VK_SUCCESS);
    EXPECT_EQ(wait(second, kShort), VK_TIMEOUT);
    submitBetween(kNothing, VK_NULL_HANDLE, kNothing, first);
    EXPECT_EQ(wait(second, kLong), VK_SUCCESS);
    ASSERT_EQ(vkResetFences(device, 1, &second), VK_SUCCESS);
    EXPECT_EQ(vkGetFenceStatus(device, first), VK_NOT_READY);
    // Resetting gives a temporary payload back without touching it.
    const VkFence signalled = makeFence(true, true);
    ASSERT_EQ(import(first, fdOf(signalled), VK_FENCE_IMPORT_TEMPORARY_BIT), VK_SUCCESS);
    EXPECT_EQ(vkGetFenceStatus(device, first), VK_SUCCESS);
    ASSERT_EQ(vkResetFences(device, 1, &first), VK_SUCCESS);
    EXPECT_EQ(vkGetFenceStatus(device, first), VK_NOT_READY);
    EXPECT_EQ(vkGetFenceStatus(device, signalled), VK_SUCCESS);
}

/// What the two processes share, in the order of the descriptors.
constexpr size_t kShared = 4;  // memory, binary semaphore, timeline semaphore, fence

/// This test again, in a process of its own that inherits the descriptors.
pid_t startPeer(const std::array<int, kShared>& fds) {
    std::string list;
    for (const int fd : fds) {
        fcntl(fd, F_SETFD, 0);
        list += std::to_string(fd) + " ";
    }
    setenv(kPeerVariable, list.c_str(), 1);
    std::string program = "/proc/self/exe", filter = "--gtest_filter=ExternalTest.peer", output = "--gtest_output=";
    char* arguments[] = {program.data(), filter.data(), output.data(), nullptr};
    pid_t peer = -1;
    const int failed = posix_spawn(&peer, program.c_str(), nullptr, nullptr, arguments, environ);
    unsetenv(kPeerVariable);
    return failed == 0 ? peer : -1;
}

// The parent fills, the peer's queue waits for the timeline, adds its part and signals the binary semaphore and the
// fence, for which the parent's queue and the parent wait.
TEST_F(ExternalTest, anotherProcess) {
    const VkDeviceMemory memory = exportable(kBytes);
    const VkSemaphore binary = makeSemaphore(true), timeline = makeSemaphore(true, true, 0);
    const VkFence fence = makeFence(true), done = makeFence(false);
    const pid_t peer = startPeer({fdOf(memory), fdOf(binary), fdOf(timeline), fdOf(fence)});
    ASSERT_GT(peer, 0);
    const VkBuffer buffer = bufferOn(memory, kBytes, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
    submitBetween(kNothing, fill(buffer, 1), {timeline, 1});
    submitBetween({binary, 0}, VK_NULL_HANDLE, kNothing, done);
    EXPECT_EQ(wait(done, kLong), VK_SUCCESS);
    EXPECT_EQ(wait(fence, kLong), VK_SUCCESS);
    const auto* words = reinterpret_cast<const uint32_t*>(map(memory));
    EXPECT_EQ(words[0], 2u);
    EXPECT_EQ(words[kBytes / 4 - 1], 1u);
    int status = -1;
    ASSERT_EQ(waitpid(peer, &status, 0), peer);
    EXPECT_EQ(status, 0);
}

TEST_F(ExternalTest, peer) {
    const char* list = std::getenv(kPeerVariable);
    if (list == nullptr) GTEST_SKIP() << "the other process of ExternalTest.anotherProcess";
    std::array<int, kShared> fds{};
    for (int& fd : fds) fd = static_cast<int>(std::strtol(list, const_cast<char**>(&list), 10));
    const VkDeviceMemory memory = import(fds[0], kBytes);
    const VkSemaphore binary = makeSemaphore(false), timeline = makeSemaphore(false, true);
    const VkFence fence = makeFence(false);
    ASSERT_EQ(import(binary, fds[1]), VK_SUCCESS);
    ASSERT_EQ(import(timeline, fds[2]), VK_SUCCESS);
    ASSERT_EQ(import(fence, fds[3]), VK_SUCCESS);
    // Half of what the parent filled becomes 2, after the parent is done.
    const VkBuffer buffer = bufferOn(memory, kBytes, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
    const VkCommandBuffer commands = begin();
    vkCmdFillBuffer(commands, buffer, 0, kBytes / 2, 2);
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    submitBetween({timeline, 1}, commands, {binary, 0}, fence);
    ASSERT_EQ(wait(fence, kLong), VK_SUCCESS);
}

}  // namespace
}  // namespace vernier::test
