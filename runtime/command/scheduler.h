// Runs pieces of work in an order that nobody can tell from the order in which they were handed over: those that touch
// the same memory one after the other, others side by side.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>

#include "base/thread_pool.h"
#include "runtime/command/access_set.h"

namespace vernier {

/// Used by one thread, the queue's; work runs on all threads of the pool. There are no stops but where somebody waits.
class Scheduler {
  public:
    /// Work that is pending at a time, at most; handing over more waits.
    static constexpr uint32_t kMostPending = 32;
    using Mask = uint32_t;  // a bit per pending piece of work
    static_assert(sizeof(Mask) * 8 == kMostPending);

    explicit Scheduler(ThreadPool& pool);
    /// Waits for all work.
    ~Scheduler();
    Scheduler(const Scheduler&) = delete;
    Scheduler& operator=(const Scheduler&) = delete;

    /// The set to which the accesses of the next work are to be added: empty.
    AccessSet& nextAccesses();
    /// Hands over work with these accesses. `also`: pending work to wait for besides. Returns its bit.
    Mask submit(std::function<void()> work, Mask also = 0);
    /// Pending work that conflicts with `accesses`, which have been finished.
    Mask conflicting(const AccessSet& accesses) const;

    void waitFor(Mask work);
    /// Waits until `ready`, which may become true when work ends, or until nothing is pending.
    void waitUntil(const std::function<bool()>& ready);
    /// Waits for all work, and throws what the first piece that failed threw. After a failure, work that had not begun
    /// is left out.
    void finish();

  private:
    struct Item final : Job {
        void run() noexcept override;
        Scheduler* owner = nullptr;
        AccessSet accesses;
        std::function<void()> work;
        Mask waitsFor = 0;
        uint32_t slot = 0;
    };
    void ended(const Item& item) noexcept;

    ThreadPool& pool_;
    std::array<Item, kMostPending> items_;
    uint32_t next_ = 0;  // the slot after the one that was used last
    Item* open_ = nullptr;
    std::atomic<Mask> pending_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_;  // of what follows, Item::waitsFor, and changes of pending_
    std::exception_ptr failure_;
};

}  // namespace vernier
