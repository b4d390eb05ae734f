#include <gtest/gtest.h>

#include <thread>

#include "runtime/command/device.h"
#include "runtime/command/query_pool.h"
#include "runtime/command/sync.h"

namespace vernier {
namespace {

using namespace std::chrono_literals;
constexpr uint64_t kShort = 2'000'000;  // nanoseconds

TEST(Timeline, OnlyGrowsAndWakesWhoWaits) {
    Timeline timeline(3);
    EXPECT_TRUE(timeline.wait(3, 0));
    EXPECT_FALSE(timeline.wait(4, kShort));
    std::thread other([&] {
        std::this_thread::sleep_for(5ms);
        timeline.signal(10);
    });
    EXPECT_TRUE(timeline.wait(7));
    other.join();
    timeline.signal(2);
    EXPECT_EQ(timeline.value(), 10u);
}

TEST(BinarySignal, ConsumesResetsAndTimesOut) {
    BinarySignal signal;
    EXPECT_FALSE(signal.wait(kShort));
    signal.signal();
    EXPECT_TRUE(signal.wait(0));
    signal.consume();
    EXPECT_FALSE(signal.signalled());
    BinarySignal set(true);
    const BinarySignal* both[] = {&signal, &set};
    EXPECT_TRUE(waitSignals(both, 2, false, kShort));
    EXPECT_FALSE(waitSignals(both, 2, true, kShort));
    set.reset();
    EXPECT_FALSE(waitSignals(both, 2, false, kShort));
}

TEST(Queue, RunsSubmissionsInOrderAndWaitsForSemaphores) {
    DeviceDesc desc;
    desc.threads = 2;
    const auto device = Device::create(desc).value();
    BinarySignal semaphore, fence;
    Timeline timeline;
    std::vector<int> order;
    Submission first;
    first.waitSemaphores = {&semaphore};
    first.signalTimelines = {{&timeline, 5}};
    first.done = [&] { order.push_back(1); };
    Submission second;
    second.waitTimelines = {{&timeline, 5}};
    second.fence = &fence;
    second.done = [&] { order.push_back(2); };
    device->queue().submit(std::move(first));
    device->queue().submit(std::move(second));
    EXPECT_FALSE(fence.wait(kShort)) << "the first submission still waits";
    semaphore.signal();
    device->queue().waitIdle();
    EXPECT_TRUE(fence.signalled());
    EXPECT_EQ(order, (std::vector<int>{1, 2}));
    EXPECT_FALSE(device->queue().lost());
}

TEST(Device, RefusesAnAbsurdNumberOfThreads) {
    DeviceDesc desc;
    desc.threads = 100000;
    const auto device = Device::create(desc);
    ASSERT_FALSE(device.ok());
    EXPECT_NE(device.error().message.find("100000"), std::string::npos);
}

TEST(QueryPool, WritesTheWidthsAndAvailabilityAskedFor) {
    QueryPool pool(VK_QUERY_TYPE_OCCLUSION, 2, 0);
    uint64_t out[4]{};
    auto* bytes = reinterpret_cast<std::byte*>(out);
    EXPECT_EQ(pool.results(0, 2, bytes, sizeof out, 8, VK_QUERY_RESULT_64_BIT), VK_NOT_READY);
    PassStatistics statistics;
    statistics.samplesPassed = 0x1'0000'0005;
    pool.write(0, statistics);
    EXPECT_EQ(pool.results(0, 1, bytes, sizeof out, 8, VK_QUERY_RESULT_64_BIT), VK_SUCCESS);
    EXPECT_EQ(out[0], 0x1'0000'0005u);
    EXPECT_EQ(pool.results(0, 2, bytes, sizeof out, 16, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT),
              VK_NOT_READY);
    EXPECT_EQ(out[1], 1u);
    EXPECT_EQ(out[3], 0u);
    pool.reset(0, 2);
    EXPECT_EQ(pool.results(0, 1, bytes, sizeof out, 8, 0), VK_NOT_READY);
}

}  // namespace
}  // namespace vernier
