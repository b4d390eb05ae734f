// What can leave the device; semaphores and fences that do, and all of it shared with another process.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>

#include "tests/vulkan/test_external.h"

extern char** environ;

namespace vernier::test {
namespace {

/// Tells the process that ExternalTest.anotherProcess starts the descriptors it was given.
constexpr const char* kPeerVariable = "VERNIER_TEST_PEER";

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
