#include "base/thread_pool.h"

#include <optional>

namespace vernier {
namespace {

/// Looks at `ready` for about as long as sleeping and waking up would take; returns whether it came true.
template <class Ready>
bool awaitBriefly(const Ready& ready) {
    constexpr int kLooks = 1000;
    for (int n = 0; n < kLooks; ++n) {
        if (ready()) return true;
        pauseBriefly();
    }
    return false;
}

constexpr uint64_t shareOf(uint32_t first, uint32_t end) {
    return uint64_t{first} << 32 | end;
}

/// Takes the first or the last index of a share; false when it has none.
bool take(std::atomic<uint64_t>& share, bool fromEnd, uint32_t& index) {
    uint64_t indices = share.load(std::memory_order_relaxed);
    while (true) {
        const auto first = static_cast<uint32_t>(indices >> 32), end = static_cast<uint32_t>(indices);
        if (first >= end) return false;
        index = fromEnd ? end - 1 : first;
        const uint64_t rest = fromEnd ? shareOf(first, end - 1) : shareOf(first + 1, end);
        if (share.compare_exchange_weak(indices, rest, std::memory_order_relaxed)) return true;
    }
}

/// Which worker of which pool this thread is.
struct Place {
    const ThreadPool* pool = nullptr;
    uint32_t worker = 0;
};
thread_local Place currentPlace;

}  // namespace

FloatControlScope::FloatControlScope() : saved_(floatControl()) {
    setFloatControl(kDefaultFloatControl);
}
FloatControlScope::~FloatControlScope() {
    setFloatControl(saved_);
}

/// Makes the thread a worker of the pool: the one that it is already, or else worker 0 as soon as nobody is.
class ThreadPool::Seat {
  public:
    explicit Seat(ThreadPool& pool) {
        if (currentPlace.pool == &pool) return;
        turn_.emplace(pool.callers_);
        floatControl_.emplace();
        before_ = currentPlace;
        currentPlace = {&pool, 0};
    }
    ~Seat() {
        if (turn_) currentPlace = before_;
    }
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;
    static uint32_t worker() { return currentPlace.worker; }

  private:
    std::optional<std::unique_lock<std::mutex>> turn_;
    std::optional<FloatControlScope> floatControl_;
    Place before_;
};

ThreadPool::ThreadPool(uint32_t threads) {
    try {
        loops_.reserve(threads);  // a thread has one open loop at most
        for (uint32_t worker = 0; worker < threads; ++worker) shares_.emplace_back(size_t{2} * threads);
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
    parallelFor({count, 0}, step);
}

void ThreadPool::parallelFor(std::array<uint32_t, 2> counts, const std::function<void(uint32_t, uint32_t)>& step) {
    const Seat seat(*this);
    const uint32_t count = counts[0] + counts[1], threads = threadCount();
    if (workers_.empty() || count <= 1) {
        for (uint32_t index = 0; index < count; ++index) step(index, Seat::worker());
        return;
    }
    Share* shares = shares_[Seat::worker()].data();
    for (uint32_t kind = 0, first = 0; kind < 2; first += counts[kind++]) {
        const auto start = [&](uint32_t worker) {
            return first + static_cast<uint32_t>(uint64_t{counts[kind]} * worker / threads);
        };
        for (uint32_t worker = 0; worker < threads; ++worker)
            shares[kind * threads + worker].indices.store(shareOf(start(worker), start(worker + 1)),
                                                          std::memory_order_relaxed);
    }
    Loop loop{step, shares, {}, {}};
    {
        const std::lock_guard lock(mutex_);
        loops_.push_back(&loop);
        ++generation_;
    }
    wake_.notify_all();
    runSteps(loop, Seat::worker());
    {
        // Nothing is left to share: who has not come by now need not be waited for.
        const std::lock_guard lock(mutex_);
        std::erase(loops_, &loop);
    }
    const auto allDone = [&] { return loop.busy.load(std::memory_order_acquire) == 0; };
    awaitBriefly(allDone);
    std::unique_lock lock(mutex_);
    done_.wait(lock, allDone);
    if (loop.failure) std::rethrow_exception(loop.failure);
}

void ThreadPool::expectLoop() {
    if (workers_.empty()) return;
    {
        const std::lock_guard lock(mutex_);
        ++expected_;
    }
    wake_.notify_all();
}

void ThreadPool::post(Job& job) noexcept {
    {
        const std::lock_guard lock(mutex_);
        job.next_ = nullptr;
        (lastJob_ ? lastJob_->next_ : firstJob_) = &job;
        lastJob_ = &job;
        ++generation_;
    }
    wake_.notify_all();
}

void ThreadPool::runSteps(Loop& loop, uint32_t worker) noexcept {
    try {
        const uint32_t threads = threadCount();
        uint32_t index;
        for (uint32_t kind = 0; kind < 2; ++kind)
            while (take(loop.shares[kind * threads + worker].indices, false, index)) loop.step(index, worker);
        for (uint32_t kind = 0; kind < 2; ++kind)
            for (uint32_t n = 1; n < threads; ++n)
                while (take(loop.shares[kind * threads + (worker + n) % threads].indices, true, index))
                    loop.step(index, worker);
    } catch (...) {
        for (uint32_t n = 0; n < 2 * threadCount(); ++n) loop.shares[n].indices.store(0, std::memory_order_relaxed);
        const std::lock_guard lock(mutex_);
        if (!loop.failure) loop.failure = std::current_exception();
    }
}

/// Whether some thread has begun with every step.
bool ThreadPool::isBegun(const Loop& loop) const {
    for (uint32_t n = 0; n < 2 * threadCount(); ++n) {
        const uint64_t indices = loop.shares[n].indices.load(std::memory_order_relaxed);
        if (static_cast<uint32_t>(indices >> 32) < static_cast<uint32_t>(indices)) return false;
    }
    return true;
}

/// Takes a job or joins a loop, if there is one to take or join. `lock` holds the mutex before and after.
bool ThreadPool::takeWork(std::unique_lock<std::mutex>& lock, uint32_t worker) {
    if (Job* job = firstJob_; job != nullptr) {
        firstJob_ = job->next_;
        if (firstJob_ == nullptr) lastJob_ = nullptr;
        lock.unlock();
        job->run();
        lock.lock();
        ++generation_;  // who waits for the job looks again
        wake_.notify_all();
        return true;
    }
    for (Loop* loop : loops_) {
        if (isBegun(*loop)) continue;
        ++loop->busy;
        lock.unlock();
        runSteps(*loop, worker);
        lock.lock();
        if (--loop->busy == 0) done_.notify_all();
        return true;
    }
    return false;
}

void ThreadPool::workUntil(const std::function<bool()>& done) {
    const Seat seat(*this);
    std::unique_lock lock(mutex_);
    while (!done()) {
        if (takeWork(lock, Seat::worker())) continue;
        const uint32_t seen = generation_;
        const auto changed = [&] { return generation_.load(std::memory_order_acquire) != seen; };
        lock.unlock();
        awaitBriefly(changed);
        lock.lock();
        wake_.wait(lock, changed);
    }
}

void ThreadPool::workerMain(uint32_t worker) {
    const FloatControlScope floatControl;
    currentPlace = {this, worker};
    uint32_t expected = 0;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (takeWork(lock, worker)) continue;
        const uint32_t seen = generation_;
        const auto changed = [&] { return generation_.load(std::memory_order_relaxed) != seen || stop_; };
        lock.unlock();
        const bool came = awaitBriefly(changed);
        lock.lock();
        if (came) continue;
        wake_.wait(lock, [&] { return changed() || expected_ != expected; });
        expected = expected_;
    }
}

}  // namespace vernier
