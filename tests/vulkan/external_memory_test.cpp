// Memory that leaves the device by file descriptors, and memory of the host's.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/vulkan/test_external.h"

namespace vernier::test {
namespace {

class ExternalMemoryTest : public ExternalTest {};

TEST_F(ExternalMemoryTest, importedMemoryIsTheSameMemory) {
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

TEST_F(ExternalMemoryTest, theExporterMayGoFirst) {
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

TEST_F(ExternalMemoryTest, imagesLieInSharedMemory) {
    auto external = make<VkExternalMemoryImageCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO);
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto info =
        flatImage(VK_FORMAT_R8G8B8A8_UNORM, {19, 7}, VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    info.pNext = &external;
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

TEST_F(ExternalMemoryTest, wrongDescriptorsAreRefused) {
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
    info.memory = allocate(kBytes);
    info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    int none = 0;
    EXPECT_NE(command<PFN_vkGetMemoryFdKHR>("vkGetMemoryFdKHR")(device, &info, &none), VK_SUCCESS);
    EXPECT_EQ(none, -1);
}

TEST_F(ExternalMemoryTest, hostMemoryIsUsedWhereItLies) {
    const auto limits = properties<VkPhysicalDeviceExternalMemoryHostPropertiesEXT>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT);
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

}  // namespace
}  // namespace vernier::test
