// Threads that share out loops of independent steps, and take on whole jobs.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "base/processor.h"

namespace vernier {

class ThreadPool;

/// A piece of work that one thread takes on as a whole; loops inside it are shared out. See ThreadPool::post.
class Job {
  public:
    virtual ~Job() = default;
    virtual void run() noexcept = 0;

  private:
    friend class ThreadPool;
    Job* next_ = nullptr;
};

/// Runs loops and jobs on the calling thread and `threads - 1` workers, which sleep when there is nothing to do, though
/// not at once: waking up takes as long as a short loop. Steps of a loop run in any order, on any thread; nothing that
/// depends on the order may be computed in them. A thread that has nothing else to do takes jobs before it joins loops.
/// Besides the workers one thread at a time may use the pool, as worker 0; others wait for their turn.
class ThreadPool {
  public:
    /// `threads` counts the caller too: 1 makes every loop run on the caller alone. At least 1. Throws std::bad_alloc
    /// or std::system_error when a thread cannot be started.
    explicit ThreadPool(uint32_t threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    uint32_t threadCount() const { return static_cast<uint32_t>(workers_.size()) + 1; }

    /// Calls step(index, worker) once for every index in [0, count) and returns when all are done. `worker` is below
    /// threadCount() and names the thread, for per-thread scratch memory. The floating-point control word of every
    /// thread is set to the default (round to nearest, denormals kept, no traps) for the duration. `step` must not
    /// call parallelFor. When a step throws, the steps that nobody has begun are left out and the first exception is
    /// thrown from here, after all threads are done. Jobs may call it: several loops run side by side then.
    /// Every thread begins with a run of indices of its own, the same for the same count, and takes from the end of the
    /// others' when it is done: what neighbours share, or loops one after the other, stays in a thread's caches.
    void parallelFor(uint32_t count, const std::function<void(uint32_t index, uint32_t worker)>& step);
    /// The same for counts[0] + counts[1] steps of two kinds, those of the first kind first: every thread begins with
    /// runs of its own of both.
    void parallelFor(std::array<uint32_t, 2> counts, const std::function<void(uint32_t index, uint32_t worker)>& step);

    /// A loop or job will follow soon: wakes the workers, so that they wait for it awake (for some microseconds).
    void expectLoop();

    /// Hands over a job, which stays alive until it has run. Jobs are begun in the order of the calls. Without workers
    /// they run in workUntil.
    void post(Job& job) noexcept;

    /// Works on jobs and loops until `done`, which may become true when a job ends; it is called by this thread alone.
    void workUntil(const std::function<bool()>& done);

  private:
    using Step = std::function<void(uint32_t index, uint32_t worker)>;
    /// Steps that nobody has begun, of one kind: indices from the upper half of `indices` to before the lower half.
    /// Whose they are takes the first, others the last.
    struct alignas(64) Share {
        std::atomic<uint64_t> indices{0};
    };
    /// A parallelFor that runs; lives on its caller's stack.
    struct Loop {
        const Step& step;
        Share* shares;                  // by kind and worker
        std::atomic<uint32_t> busy{0};  // threads that help; written under the mutex
        std::exception_ptr failure;     // the first; under the mutex
    };
    class Seat;

    void workerMain(uint32_t worker);
    void runSteps(Loop& loop, uint32_t worker) noexcept;
    bool isBegun(const Loop& loop) const;
    bool takeWork(std::unique_lock<std::mutex>& lock, uint32_t worker);
    void stopWorkers();

    std::mutex callers_;  // held by who is worker 0
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    std::vector<Loop*> loops_;  // that may be joined, the oldest first
    Job *firstJob_ = nullptr, *lastJob_ = nullptr;
    // Written under the mutex; read without it by who waits awake.
    std::atomic<uint32_t> generation_{0};  // of loops and jobs, begun or ended
    std::atomic<uint32_t> expected_{0};    // calls of expectLoop
    std::atomic<bool> stop_{false};
    std::vector<std::vector<Share>> shares_;  // by worker: of the loop that it called for
    std::vector<std::thread> workers_;
};

/// Sets the floating-point control word to round-to-nearest with denormals kept and exceptions masked, and restores the
/// caller's on destruction: an application's own setting must not change a pixel.
class FloatControlScope {
  public:
    FloatControlScope();
    ~FloatControlScope();
    FloatControlScope(const FloatControlScope&) = delete;
    FloatControlScope& operator=(const FloatControlScope&) = delete;

  private:
    FloatControl saved_;
};

}  // namespace vernier
