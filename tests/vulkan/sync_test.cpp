// Fences, semaphores, events and queries.
#include <chrono>
#include <thread>

#include "tests/vulkan/test_device.h"

namespace vernier::test {
namespace {

class SyncTest : public VulkanTest {
  protected:
    VkFence makeFence(VkFenceCreateFlags flags) {
        auto info = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        info.flags = flags;
        VkFence fence = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateFence(device, &info, nullptr, &fence), VK_SUCCESS);
        defer([this, fence] { vkDestroyFence(device, fence, nullptr); });
        return fence;
    }
};

TEST_F(SyncTest, fencesSignalResetAndTimeOut) {
    const VkFence fences[] = {makeFence(0), makeFence(VK_FENCE_CREATE_SIGNALED_BIT)};
    EXPECT_EQ(vkGetFenceStatus(device, fences[0]), VK_NOT_READY);
    EXPECT_EQ(vkGetFenceStatus(device, fences[1]), VK_SUCCESS);
    EXPECT_EQ(vkWaitForFences(device, 2, fences, VK_FALSE, 0), VK_SUCCESS);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(vkWaitForFences(device, 2, fences, VK_TRUE, 20'000'000), VK_TIMEOUT);
    EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
    EXPECT_EQ(vkQueueSubmit(queue, 0, nullptr, fences[0]), VK_SUCCESS);
    EXPECT_EQ(vkWaitForFences(device, 2, fences, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    EXPECT_EQ(vkResetFences(device, 2, fences), VK_SUCCESS);
    EXPECT_EQ(vkGetFenceStatus(device, fences[1]), VK_NOT_READY);
}

TEST_F(SyncTest, hostSetsAnEventThatTheQueueWaitsFor) {
    const auto info = make<VkEventCreateInfo>(VK_STRUCTURE_TYPE_EVENT_CREATE_INFO);
    VkEvent first = VK_NULL_HANDLE, second = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateEvent(device, &info, nullptr, &first), VK_SUCCESS);
    ASSERT_EQ(vkCreateEvent(device, &info, nullptr, &second), VK_SUCCESS);
    defer([=, this] {
        vkDestroyEvent(device, first, nullptr);
        vkDestroyEvent(device, second, nullptr);
    });
    const VkCommandBuffer commands = begin();
    vkCmdWaitEvents(commands, 1, &first, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, nullptr, 0,
                    nullptr, 0, nullptr);
    vkCmdSetEvent(commands, second, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
    ASSERT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    auto submitInfo = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submitInfo.commandBufferCount = 1;
    submitInfo.pCommandBuffers = &commands;
    const VkFence fence = makeFence(0);
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submitInfo, fence), VK_SUCCESS);
    EXPECT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, 10'000'000), VK_TIMEOUT);
    EXPECT_EQ(vkGetEventStatus(device, second), VK_EVENT_RESET);
    ASSERT_EQ(vkSetEvent(device, first), VK_SUCCESS);
    EXPECT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    EXPECT_EQ(vkGetEventStatus(device, second), VK_EVENT_SET);
    ASSERT_EQ(vkResetEvent(device, first), VK_SUCCESS);
    EXPECT_EQ(vkGetEventStatus(device, first), VK_EVENT_RESET);
}

TEST_F(SyncTest, binarySemaphoresOrderSubmissions) {
    const auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    VkSemaphore semaphore = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
    defer([=, this] { vkDestroySemaphore(device, semaphore, nullptr); });
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    for (int round = 0; round < 3; ++round) {
        VkSubmitInfo batches[2] = {make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO),
                                   make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO)};
        batches[0].signalSemaphoreCount = 1;
        batches[0].pSignalSemaphores = &semaphore;
        batches[1].waitSemaphoreCount = 1;
        batches[1].pWaitSemaphores = &semaphore;
        batches[1].pWaitDstStageMask = &stage;
        const VkFence fence = makeFence(0);
        ASSERT_EQ(vkQueueSubmit(queue, 2, batches, fence), VK_SUCCESS);
        ASSERT_EQ(vkWaitForFences(device, 1, &fence, VK_TRUE, 5'000'000'000), VK_SUCCESS);
    }
}

TEST_F(SyncTest, timelineSemaphoresCount) {
    const auto wait = reinterpret_cast<PFN_vkWaitSemaphoresKHR>(vkGetDeviceProcAddr(device, "vkWaitSemaphoresKHR"));
    const auto signal = reinterpret_cast<PFN_vkSignalSemaphoreKHR>(vkGetDeviceProcAddr(device, "vkSignalSemaphoreKHR"));
    const auto value = reinterpret_cast<PFN_vkGetSemaphoreCounterValueKHR>(
        vkGetDeviceProcAddr(device, "vkGetSemaphoreCounterValueKHR"));
    ASSERT_TRUE(wait != nullptr && signal != nullptr && value != nullptr);
    auto type = make<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    type.initialValue = 5;
    auto info = make<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    info.pNext = &type;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
    defer([=, this] { vkDestroySemaphore(device, semaphore, nullptr); });

    // A submission that waits for 6 and signals 8; the host signals 6.
    const uint64_t six = 6, eight = 8;
    auto values = make<VkTimelineSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
    values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
    values.pWaitSemaphoreValues = &six;
    values.pSignalSemaphoreValues = &eight;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    auto submitInfo = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submitInfo.pNext = &values;
    submitInfo.waitSemaphoreCount = submitInfo.signalSemaphoreCount = 1;
    submitInfo.pWaitSemaphores = submitInfo.pSignalSemaphores = &semaphore;
    submitInfo.pWaitDstStageMask = &stage;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submitInfo, VK_NULL_HANDLE), VK_SUCCESS);
    uint64_t now = 0;
    ASSERT_EQ(value(device, semaphore, &now), VK_SUCCESS);
    EXPECT_EQ(now, 5u);
    auto waitInfo = make<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    waitInfo.semaphoreCount = 1;
    waitInfo.pSemaphores = &semaphore;
    waitInfo.pValues = &eight;
    EXPECT_EQ(wait(device, &waitInfo, 5'000'000), VK_TIMEOUT);
    auto signalInfo = make<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    signalInfo.semaphore = semaphore;
    signalInfo.value = 6;
    ASSERT_EQ(signal(device, &signalInfo), VK_SUCCESS);
    EXPECT_EQ(wait(device, &waitInfo, UINT64_MAX), VK_SUCCESS);
    waitInfo.flags = VK_SEMAPHORE_WAIT_ANY_BIT;
    EXPECT_EQ(wait(device, &waitInfo, 0), VK_SUCCESS);
    ASSERT_EQ(value(device, semaphore, &now), VK_SUCCESS);
    EXPECT_EQ(now, 8u);
}

TEST_F(SyncTest, timestampsRiseAndResultsCanBeCopied) {
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_TIMESTAMP, 2);
    const TestBuffer copy = makeBuffer(32, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, queries, 0, 2);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, queries, 0);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
    vkCmdCopyQueryPoolResults(commands, queries, 0, 2, copy.buffer, 0, 16,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
    submit(commands);
    uint64_t times[2] = {};
    ASSERT_EQ(vkGetQueryPoolResults(device, queries, 0, 2, sizeof times, times, 8,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              VK_SUCCESS);
    EXPECT_GT(times[0], 0u);
    EXPECT_LE(times[0], times[1]);
    uint64_t copied[4];
    std::memcpy(copied, copy.data, sizeof copied);
    EXPECT_EQ(copied[0], times[0]);
    EXPECT_EQ(copied[1], 1u);
    EXPECT_EQ(copied[2], times[1]);
    EXPECT_EQ(copied[3], 1u);
}

TEST_F(SyncTest, statisticsThatDoNotExistAreNotCounted) {
    VERNIER_SKIP_WHEN_VALIDATED();
    const VkQueryPool queries = makeQueries(VK_QUERY_TYPE_PIPELINE_STATISTICS, 1, ~0u);
    const VkCommandBuffer commands = begin();
    vkCmdResetQueryPool(commands, queries, 0, 1);
    vkCmdBeginQuery(commands, queries, 0, 0);
    vkCmdEndQuery(commands, queries, 0);
    submit(commands);
    constexpr uint64_t kUntouched = 0xEEEEEEEEEEEEEEEE;
    std::vector<uint64_t> values(32, kUntouched);
    EXPECT_EQ(vkGetQueryPoolResults(device, queries, 0, 1, values.size() * 8, values.data(), 0, VK_QUERY_RESULT_64_BIT),
              VK_SUCCESS);
    for (size_t n = 0; n < values.size(); ++n) EXPECT_EQ(values[n], n < 11 ? 0 : kUntouched) << n;
}

}  // namespace
}  // namespace vernier::test
