// Which work may run side by side, and that the rest runs in order.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <random>
#include <stdexcept>
#include <vector>

#include "runtime/command/scheduler.h"

namespace vernier {
namespace {

AccessSet accesses(const std::vector<std::pair<const std::byte*, uint64_t>>& reads,
                   const std::vector<std::pair<const std::byte*, uint64_t>>& writes) {
    AccessSet set;
    for (const auto& [begin, bytes] : reads) set.read(begin, bytes);
    for (const auto& [begin, bytes] : writes) set.write(begin, bytes);
    set.finish();
    return set;
}

TEST(AccessSet, ConflictsOnlyWhereOneWrites) {
    std::array<std::byte, 100> memory{};
    const std::byte* m = memory.data();
    const AccessSet reads = accesses({{m, 50}}, {}), readsToo = accesses({{m + 10, 50}}, {});
    const AccessSet writes = accesses({}, {{m + 49, 10}}), behind = accesses({}, {{m + 59, 10}});
    EXPECT_FALSE(AccessSet::conflicts(reads, readsToo));
    EXPECT_TRUE(AccessSet::conflicts(reads, writes));
    EXPECT_TRUE(AccessSet::conflicts(writes, reads));
    EXPECT_FALSE(AccessSet::conflicts(reads, behind));
    EXPECT_FALSE(AccessSet::conflicts(writes, behind));
    EXPECT_TRUE(AccessSet::conflicts(writes, writes));
    EXPECT_FALSE(AccessSet::conflicts(accesses({{nullptr, 10}, {m, 0}}, {}), accesses({}, {{m, 100}})));
}

TEST(AccessSet, NamesNothingLessWhenThereAreManyRanges) {
    std::vector<std::byte> memory(1 << 20);
    std::mt19937 random(5);
    AccessSet many;
    std::vector<uint32_t> starts;
    for (int n = 0; n < 3000; ++n) {
        starts.push_back(static_cast<uint32_t>(random() % (memory.size() - 16)));
        many.write(memory.data() + starts.back(), 16);
    }
    many.finish();
    for (const uint32_t start : starts)
        ASSERT_TRUE(AccessSet::conflicts(accesses({{memory.data() + start + 15, 1}}, {}), many)) << start;
    AccessSet copy;
    copy.add(many);
    copy.finish();
    EXPECT_TRUE(AccessSet::conflicts(copy, many));
}

/// Every piece of work computes from cells it reads the cells it writes: any other order gives other values.
TEST(Scheduler, GivesWhatTheOrderGives) {
    constexpr uint32_t kCells = 24, kWork = 400;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        ThreadPool pool(threads);
        Scheduler scheduler(pool);
        std::mt19937 random(threads);
        std::array<uint32_t, kCells> cells{}, expected{};
        for (uint32_t n = 0; n < kWork; ++n) {
            const uint32_t a = random() % kCells, b = random() % kCells, c = random() % kCells;
            const auto compute = [=](std::array<uint32_t, kCells>& on) { on[c] = on[c] * 31 + on[a] + on[b] * 7 + n; };
            compute(expected);
            AccessSet& set = scheduler.nextAccesses();
            set.read(&cells[a], 4);
            set.read(&cells[b], 4);
            set.write(&cells[c], 4);
            scheduler.submit([&cells, &pool, compute] {
                std::atomic<uint32_t> steps{0};
                pool.parallelFor(5, [&](uint32_t, uint32_t) { ++steps; });
                if (steps == 5) compute(cells);
            });
            if (n % 97 == 0) scheduler.finish();
        }
        scheduler.finish();
        EXPECT_EQ(cells, expected) << threads << " threads";
    }
}

TEST(Scheduler, WaitsForNamedWorkToo) {
    ThreadPool pool(3);
    Scheduler scheduler(pool);
    std::atomic<int> order{0};
    int first = 0, second = 0;
    scheduler.nextAccesses();
    const Scheduler::Mask before = scheduler.submit([&] { first = ++order; });
    scheduler.nextAccesses();
    scheduler.submit([&] { second = ++order; }, before);
    scheduler.finish();
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 2);
}

TEST(Scheduler, ThrowsWhatWorkThrewAndLeavesTheRestOut) {
    ThreadPool pool(2);
    Scheduler scheduler(pool);
    std::byte cell{};
    bool ran = false;
    scheduler.nextAccesses().write(&cell, 1);
    scheduler.submit([] { throw std::runtime_error("work"); });
    scheduler.nextAccesses().write(&cell, 1);
    scheduler.submit([&] { ran = true; });
    EXPECT_THROW(scheduler.finish(), std::runtime_error);
    EXPECT_FALSE(ran);
    scheduler.nextAccesses();
    scheduler.submit([&] { ran = true; });
    scheduler.finish();
    EXPECT_TRUE(ran);
}

}  // namespace
}  // namespace vernier
