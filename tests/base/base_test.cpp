#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <numeric>
#include <set>

#include "base/arena.h"
#include "base/cpu_budget.h"
#include "base/simd.h"
#include "base/thread_pool.h"

namespace vernier {
namespace {

TEST(Arena, HandsOutAlignedDisjointMemoryAndReusesItAfterReset) {
    Arena arena(256);
    std::vector<std::span<uint64_t>> spans;
    for (size_t i = 1; i <= 64; ++i) {
        spans.push_back(arena.array<uint64_t>(i));
        EXPECT_EQ(reinterpret_cast<uintptr_t>(spans.back().data()) % alignof(uint64_t), 0u);
        std::fill(spans.back().begin(), spans.back().end(), i);
    }
    for (size_t i = 1; i <= 64; ++i) EXPECT_THAT(spans[i - 1], testing::Each(i));
    void* aligned = arena.allocate(3, 64);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(aligned) % 64, 0u);
    const size_t used = arena.used();
    EXPECT_GE(used, 64u * 65 / 2 * 8);
    arena.reset();
    EXPECT_EQ(arena.used(), 0u);
    EXPECT_EQ(arena.array<uint64_t>(1).data(), spans[0].data());
}

TEST(ThreadPool, RunsEveryStepOnceOnValidWorkers) {
    for (const uint32_t threads : {1u, 2u, 5u}) {
        ThreadPool pool(threads);
        EXPECT_EQ(pool.threadCount(), threads);
        for (const uint32_t count : {0u, 1u, 3u, 1000u}) {
            std::vector<std::atomic<int>> seen(count);
            std::atomic<bool> workerInRange = true;
            pool.parallelFor(count, [&](uint32_t index, uint32_t worker) {
                ++seen[index];
                if (worker >= threads) workerInRange = false;
            });
            EXPECT_TRUE(workerInRange);
            for (const auto& times : seen) EXPECT_EQ(times, 1);
        }
    }
}

TEST(ThreadPool, EveryThreadBeginsWithRunsOfItsOwn) {
    for (const uint32_t threads : {1u, 2u, 5u}) {
        ThreadPool pool(threads);
        for (const std::array<uint32_t, 2> counts : {std::array{0u, 0u}, {1u, 0u}, {0u, 3u}, {64u, 7u}, {9u, 300u}}) {
            const uint32_t count = counts[0] + counts[1];
            std::vector<std::vector<uint32_t>> taken(threads);
            pool.parallelFor(counts, [&](uint32_t index, uint32_t worker) { taken[worker].push_back(index); });
            std::vector<uint32_t> seen(count);
            for (uint32_t worker = 0; worker < threads; ++worker) {
                for (const uint32_t index : taken[worker]) ++seen.at(index);
                if (taken[worker].empty() || count <= 1) continue;
                // Of the first kind: from the start of its own run on, if somebody else has not taken all of it.
                const auto start = [&](uint32_t n) { return static_cast<uint32_t>(uint64_t{counts[0]} * n / threads); };
                const uint32_t first = taken[worker].front();
                if (first >= start(worker) && first < start(worker + 1)) {
                    EXPECT_EQ(first, start(worker));
                }
            }
            for (const uint32_t times : seen) EXPECT_EQ(times, 1u);
        }
    }
}

TEST(ThreadPool, SerialisesCallersFromSeveralThreads) {
    ThreadPool pool(3);
    std::atomic<int> inside = 0, sum = 0;
    std::atomic<bool> mixed = false;
    std::vector<std::thread> callers;
    for (int caller = 1; caller <= 4; ++caller)
        callers.emplace_back([&, caller] {
            for (int round = 0; round < 50; ++round)
                pool.parallelFor(16, [&](uint32_t, uint32_t) {
                    int expected = 0;
                    if (!inside.compare_exchange_strong(expected, caller) && expected != caller) mixed = true;
                    ++sum;
                    inside = 0;
                });
        });
    for (auto& caller : callers) caller.join();
    EXPECT_EQ(sum, 4 * 50 * 16);
    EXPECT_FALSE(mixed);
}

TEST(ThreadPool, PassesOnWhatAStepThrowsAndGoesOnWorking) {
    for (const uint32_t threads : {1u, 4u}) {
        ThreadPool pool(threads);
        for (int round = 0; round < 20; ++round) {
            std::atomic<uint32_t> begun{0};
            EXPECT_THROW(pool.parallelFor(1000,
                                          [&](uint32_t index, uint32_t) {
                                              ++begun;
                                              if (index >= 3) throw std::bad_alloc();
                                          }),
                         std::bad_alloc);
            EXPECT_LE(begun, 3 + threads) << "steps went on after the first that threw";
            std::atomic<uint32_t> sum{0};
            pool.parallelFor(100, [&](uint32_t index, uint32_t) { sum += index; });
            EXPECT_EQ(sum, 4950u);
        }
    }
}

TEST(Arena, SizesThatNoMemoryHasAreRefused) {
    Arena arena;
    arena.allocate(16);
    EXPECT_THROW(static_cast<void>(arena.allocate(SIZE_MAX)), std::bad_alloc);
    EXPECT_THROW(static_cast<void>(arena.allocate(SIZE_MAX - 8)), std::bad_alloc);
    EXPECT_THROW(static_cast<void>(arena.array<uint64_t>(SIZE_MAX / 4)), std::bad_alloc);
    EXPECT_NE(arena.allocate(16), nullptr);
}

TEST(ThreadPool, SetsTheFloatingPointControlWordAndRestoresTheCallers) {
    const FloatControl before = floatControl();
    setFloatControl(before | kDenormalsAreZero);
    ThreadPool pool(2);
    std::atomic<bool> denormalsKept = true;
    pool.parallelFor(64, [&](uint32_t, uint32_t) {
        volatile float tiny = 1e-40f;
        volatile float half = tiny * 0.5f;
        if (half == 0) denormalsKept = false;
    });
    EXPECT_EQ(floatControl() & kDenormalsAreZero, kDenormalsAreZero);
    setFloatControl(before);
    EXPECT_TRUE(denormalsKept);
}

TEST(Isa, NamesRoundTripAndLimitsHold) {
    for (size_t value = 0; value <= static_cast<size_t>(kHighestIsa); ++value) {
        const auto isa = static_cast<Isa>(value);
        EXPECT_EQ(isaFromName(isaName(isa)), isa);
        EXPECT_NE(isaNames().find(isaName(isa)), std::string_view::npos);
        EXPECT_LE(bestIsaUpTo(isa), isa);
        EXPECT_LE(bestIsaUpTo(isa), bestIsa());
    }
    ASSERT_FALSE(availableIsas().empty());
    EXPECT_EQ(availableIsas().front(), kLowestIsa);
    EXPECT_EQ(availableIsas().back(), bestIsa());
    EXPECT_EQ(isaFromName("mmx"), std::nullopt);
}

TEST(CpuBudget, IsAtLeastOneAndNotAboveTheMachine) {
    EXPECT_GE(usableCpuCount(), 1u);
    EXPECT_LE(usableCpuCount(), std::thread::hardware_concurrency());
}

}  // namespace
}  // namespace vernier
