// Signals in shared memory, through two mappings of it, as two processes have.
#include "runtime/command/shared_signal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <thread>
#include <vector>

#include "runtime/command/sync.h"

namespace vernier {
namespace {

using Kind = SharedSignal::Kind;
using Payload = std::shared_ptr<SharedSignal>;

Payload make(Kind kind, uint64_t value = 0) {
    Result<Payload> made = SharedSignal::create(kind, value);
    EXPECT_TRUE(made.ok());
    return made.ok() ? *made : nullptr;
}

Payload again(Kind kind, const Payload& payload) {
    Result<Payload> other = SharedSignal::import(kind, payload->exportFd());
    EXPECT_TRUE(other.ok());
    return other.ok() ? *other : nullptr;
}

TEST(SharedSignal, TimelinesRiseAndWakeWhoWaitsElsewhere) {
    const Payload first = make(Kind::timelineSemaphore, 3), second = again(Kind::timelineSemaphore, first);
    EXPECT_EQ(second->value(), 3u);
    EXPECT_FALSE(second->wait(4, 2'000'000));
    std::thread other([&] { EXPECT_TRUE(second->wait(uint64_t{1} << 40, UINT64_MAX)); });
    first->raise(7);
    first->raise(5);  // never back
    EXPECT_EQ(second->value(), 7u);
    first->raise(uint64_t{1} << 40);
    other.join();
}

TEST(SharedSignal, OneOfThoseWhoWaitGetsABinarySignal) {
    constexpr uint32_t kThreads = 4, kEach = 200;
    const Payload producer = make(Kind::binarySemaphore);
    std::atomic<uint32_t> got{0};
    std::vector<std::thread> threads;
    for (uint32_t i = 0; i < kThreads; ++i) {
        threads.emplace_back([&, consumer = again(Kind::binarySemaphore, producer)] {
            for (uint32_t n = 0; n < kEach; ++n) {
                consumer->consume();
                ++got;
            }
        });
    }
    for (uint32_t sent = 0; sent < kThreads * kEach; ++sent) {
        producer->raise(1);
        while (got.load() <= sent) std::this_thread::yield();
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(got, kThreads * kEach);
    EXPECT_EQ(producer->value(), 0u);
}

TEST(SharedSignal, OfOneKindIsNotAnother) {
    const Payload fence = make(Kind::fence, 1);
    const int fd = fence->exportFd();
    EXPECT_FALSE(SharedSignal::import(Kind::binarySemaphore, fd).ok());
    EXPECT_FALSE(SharedSignal::import(Kind::timelineSemaphore, fd).ok());
    EXPECT_EQ(close(fd), 0);  // still the caller's
    EXPECT_FALSE(SharedSignal::import(Kind::fence, -1).ok());
}

TEST(SharedSignal, BinarySignalsGiveTemporaryPayloadsBack) {
    BinarySignal signal(true);
    signal.share(make(Kind::binarySemaphore, 1), true);
    signal.consume();
    EXPECT_TRUE(signal.signalled());  // its own, which nobody touched
    const Payload payload = make(Kind::fence, 1);
    signal.share(payload, true);
    signal.reset();
    EXPECT_FALSE(signal.signalled());
    EXPECT_EQ(payload->value(), 1u);
    signal.share(payload, false);
    EXPECT_TRUE(signal.wait(0));
    signal.reset();
    EXPECT_EQ(payload->value(), 0u);
}

}  // namespace
}  // namespace vernier
