// Threads that share out loops of independent steps.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace vernier {

/// Runs loops on the calling thread and `threads - 1` workers, which sleep when there is nothing to do, though not at
/// once: waking up takes as long as a short loop. parallelFor may be called by several threads: their loops run one
/// after the other. Steps of a loop run in any order, on any thread; nothing that depends on the order may be computed
/// in them.
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
    /// thrown from here, after all threads are done.
    void parallelFor(uint32_t count, const std::function<void(uint32_t index, uint32_t worker)>& step);

    /// A loop will follow soon: wakes the workers, so that they wait for it awake (for some microseconds).
    void expectLoop();

  private:
    using Step = std::function<void(uint32_t index, uint32_t worker)>;
    void workerMain(uint32_t worker);
    void runSteps(const Step& step, uint32_t count, uint32_t worker) noexcept;
    void stopWorkers();

    std::mutex callers_;  // one loop at a time
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    const Step* step_ = nullptr;  // nullptr: it is too late to join the loop
    std::atomic<uint32_t> next_{0};
    uint32_t count_ = 0;
    // Written under the mutex; read without it by who waits awake.
    std::atomic<uint32_t> generation_{0};  // of loops
    std::atomic<uint32_t> expected_{0};    // calls of expectLoop
    std::atomic<uint32_t> busy_{0};        // workers in the loop
    std::atomic<bool> stop_{false};
    std::exception_ptr failure_;  // the first of the loop that runs
    std::vector<std::thread> workers_;
};

/// Sets the SSE control word to round-to-nearest with denormals kept and exceptions masked, and restores the caller's
/// on destruction: an application's own setting must not change a pixel.
class FloatControlScope {
  public:
    FloatControlScope();
    ~FloatControlScope();
    FloatControlScope(const FloatControlScope&) = delete;
    FloatControlScope& operator=(const FloatControlScope&) = delete;

  private:
    uint32_t saved_;
};

}  // namespace vernier
