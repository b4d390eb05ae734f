#include "base/thread_pool.h"

#include <immintrin.h>

namespace vernier {
namespace {

constexpr uint32_t kDefaultMxcsr = 0x1F80;  // all exceptions masked, round to nearest, DAZ and FTZ off

}  // namespace

FloatControlScope::FloatControlScope() : saved_(_mm_getcsr()) {
    _mm_setcsr(kDefaultMxcsr);
}
FloatControlScope::~FloatControlScope() {
    _mm_setcsr(saved_);
}

ThreadPool::ThreadPool(uint32_t threads) {
    for (uint32_t worker = 1; worker < threads; ++worker) workers_.emplace_back([this, worker] { workerMain(worker); });
}

ThreadPool::~ThreadPool() {
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
        busy_ = static_cast<uint32_t>(workers_.size());
        ++generation_;
    }
    wake_.notify_all();
    runSteps(0);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::runSteps(uint32_t worker) {
    for (uint32_t index; (index = next_.fetch_add(1, std::memory_order_relaxed)) < count_;) (*step_)(index, worker);
}

void ThreadPool::workerMain(uint32_t worker) {
    const FloatControlScope floatControl;
    uint32_t seen = 0;
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [&] { return stop_ || generation_ != seen; });
        if (stop_) return;
        seen = generation_;
        lock.unlock();
        runSteps(worker);
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace vernier
