#include "runtime/command/sync.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace vernier {
namespace {

using Clock = std::chrono::steady_clock;

/// Time-outs beyond this many nanoseconds (about 146 years) overflow clocks; they mean for ever.
constexpr uint64_t kForever = UINT64_MAX / 4;

template <class Ready>
bool waitFor(std::unique_lock<std::mutex>& lock, std::condition_variable& changed, uint64_t nanoseconds, Ready ready) {
    if (nanoseconds >= kForever) {
        changed.wait(lock, ready);
        return true;
    }
    return changed.wait_until(lock, Clock::now() + std::chrono::nanoseconds(nanoseconds), ready);
}

}  // namespace

uint64_t Timeline::value() const {
    const std::lock_guard lock(mutex_);
    return payload_ ? payload_->value() : value_;
}

void Timeline::signal(uint64_t value) {
    // Notified under the lock, and a payload raised after it: whoever waits may destroy the timeline as soon as it sees
    // the value.
    std::unique_lock lock(mutex_);
    if (const std::shared_ptr<SharedSignal> payload = payload_) {
        lock.unlock();
        return payload->raise(value);
    }
    value_ = std::max(value_, value);
    changed_.notify_all();
}

bool Timeline::wait(uint64_t value, uint64_t timeoutNanoseconds) const {
    std::unique_lock lock(mutex_);
    if (const std::shared_ptr<SharedSignal> payload = payload_) {
        lock.unlock();
        return payload->wait(value, timeoutNanoseconds);
    }
    return waitFor(lock, changed_, timeoutNanoseconds, [&] { return value_ >= value; });
}

void Timeline::share(std::shared_ptr<SharedSignal> payload) {
    const std::lock_guard lock(mutex_);
    payload_ = std::move(payload);
}

std::shared_ptr<SharedSignal> Timeline::payload() const {
    const std::lock_guard lock(mutex_);
    return payload_;
}

bool BinarySignal::signalled() const {
    const std::lock_guard lock(mutex_);
    return current() ? current()->value() != 0 : signalled_;
}

void BinarySignal::signal() {
    std::unique_lock lock(mutex_);
    if (const std::shared_ptr<SharedSignal> payload = current()) {
        lock.unlock();
        return payload->raise(1);
    }
    signalled_ = true;
    changed_.notify_all();
}

void BinarySignal::reset() {
    const std::lock_guard lock(mutex_);
    temporary_.reset();
    if (payload_) payload_->reset();
    signalled_ = false;
}

bool BinarySignal::wait(uint64_t timeoutNanoseconds) const {
    std::unique_lock lock(mutex_);
    if (const std::shared_ptr<SharedSignal> payload = current()) {
        lock.unlock();
        return payload->wait(1, timeoutNanoseconds);
    }
    return waitFor(lock, changed_, timeoutNanoseconds, [&] { return signalled_; });
}

void BinarySignal::consume() {
    std::unique_lock lock(mutex_);
    if (const std::shared_ptr<SharedSignal> payload = current()) {
        lock.unlock();
        payload->consume();
        lock.lock();
        temporary_.reset();
        return;
    }
    changed_.wait(lock, [&] { return signalled_; });
    signalled_ = false;
}

void BinarySignal::share(std::shared_ptr<SharedSignal> payload, bool temporarily) {
    const std::lock_guard lock(mutex_);
    (temporarily ? temporary_ : payload_) = std::move(payload);
}

std::shared_ptr<SharedSignal> BinarySignal::payload() const {
    const std::lock_guard lock(mutex_);
    return current();
}

bool waitSignals(const BinarySignal* const* signals, uint32_t count, bool all, uint64_t timeoutNanoseconds) {
    const bool forever = timeoutNanoseconds >= kForever;
    const auto deadline = Clock::now() + std::chrono::nanoseconds(forever ? 0 : timeoutNanoseconds);
    const auto left = [&]() -> uint64_t {
        if (forever) return UINT64_MAX;
        const auto now = Clock::now();
        return now >= deadline ? 0
                               : static_cast<uint64_t>(
                                     std::chrono::duration_cast<std::chrono::nanoseconds>(deadline - now).count());
    };
    if (all || count == 1)
        return std::all_of(signals, signals + count, [&](const BinarySignal* s) { return s->wait(left()); });
    // Waiting for any of several is rare: look at each in turn, sleeping a little longer each time.
    constexpr auto kLongestPause = std::chrono::microseconds(500);
    for (auto pause = std::chrono::microseconds(5);; pause = std::min(pause * 2, kLongestPause)) {
        if (std::any_of(signals, signals + count, [](const BinarySignal* s) { return s->signalled(); })) return true;
        if (left() == 0) return false;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace vernier
