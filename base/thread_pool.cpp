#include "base/thread_pool.h"

#include <immintrin.h>

#include <utility>

namespace vernier {
namespace {

constexpr uint32_t kDefaultMxcsr = 0x1F80;  // all exceptions masked, round to nearest, DAZ and FTZ off

/// Looks at `ready` for about as long as sleeping and waking up would take; returns whether it came true.
template <class Ready>
bool awaitBriefly(const Ready& ready) {
    constexpr int kLooks = 1000;  // of 20 to 70 nanoseconds
    for (int n = 0; n < kLooks; ++n) {
        if (ready()) return true;
        _mm_pause();
    }
    return false;
}

}  // namespace

FloatControlScope::FloatControlScope() : saved_(_mm_getcsr()) {
    _mm_setcsr(kDefaultMxcsr);
}
FloatControlScope::~FloatControlScope() {
    _mm_setcsr(saved_);
}

ThreadPool::ThreadPool(uint32_t threads) {
    try {
        workers_.reserve(threads - 1);
        for (uint32_t worker = 1; worker < threads; ++worker)
            workers_.emplace_back([this, worker] { workerMain(worker); });
    } catch (...) {
        stopWorkers();
        throw;
    }
}

ThreadPool::~ThreadPool() {
    stopWorkers();
}

void ThreadPool::stopWorkers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    for (auto& worker : workers_) worker.join();
}

void ThreadPool::parallelFor(uint32_t count, const std::function<void(uint32_t, uint32_t)>& step) {
    const std::lock_guard caller(callers_);
    const FloatControlScope floatControl;
    if (workers_.empty() || count <= 1) {
        for (uint32_t index = 0; index < count; ++index) step(index, 0);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        step_ = &step;
        count_ = count;
        next_.store(0, std::memory_order_relaxed);
        ++generation_;
    }
    wake_.notify_all();
    runSteps(step, count, 0);
    {
        // Nothing is left to share: who has not come by now need not be waited for.
        const std::lock_guard lock(mutex_);
        step_ = nullptr;
    }
    const auto allDone = [this] { return busy_.load(std::memory_order_acquire) == 0; };
    awaitBriefly(allDone);
    std::unique_lock lock(mutex_);
    done_.wait(lock, allDone);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadPool::expectLoop() {
    if (workers_.empty()) return;
    {
        const std::lock_guard lock(mutex_);
        ++expected_;
    }
    wake_.notify_all();
}

void ThreadPool::runSteps(const Step& step, uint32_t count, uint32_t worker) noexcept {
    try {
        for (uint32_t index; (index = next_.fetch_add(1, std::memory_order_relaxed)) < count;) step(index, worker);
    } catch (...) {
        next_.store(count, std::memory_order_relaxed);
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
    }
}

void ThreadPool::workerMain(uint32_t worker) {
    const FloatControlScope floatControl;
    uint32_t seen = 0, expected = 0;
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [&] { return stop_ || generation_ != seen || expected_ != expected; });
        if (stop_) return;
        expected = expected_;
        if (generation_ == seen) {
            lock.unlock();
            awaitBriefly([&] { return generation_.load(std::memory_order_relaxed) != seen || stop_; });
            lock.lock();
            continue;
        }
        seen = generation_;
        if (step_ == nullptr) continue;
        const Step& step = *step_;
        const uint32_t count = count_;
        ++busy_;
        lock.unlock();
        runSteps(step, count, worker);
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
        lock.unlock();
        awaitBriefly([&] { return generation_.load(std::memory_order_relaxed) != seen || stop_; });
        lock.lock();
    }
}

}  // namespace vernier
