// Order between queues and the host. A timeline is a number that only grows; fences, binary semaphores and timeline
// semaphores are all made of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "runtime/command/shared_signal.h"

namespace vernier {

/// A monotonic counter that threads can wait for. Thread-safe.
class Timeline {
  public:
    explicit Timeline(uint64_t value = 0) : value_(value) {}

    uint64_t value() const;
    /// Raises the value (never lowers it) and wakes who waits.
    void signal(uint64_t value);
    /// Waits until value() >= `value`. `timeoutNanoseconds`: UINT64_MAX waits for ever. False: timed out.
    bool wait(uint64_t value, uint64_t timeoutNanoseconds = UINT64_MAX) const;

    /// From now on it is another name of `payload`. Nobody may be using the timeline.
    void share(std::shared_ptr<SharedSignal> payload);
    /// nullptr: it is of this process alone.
    std::shared_ptr<SharedSignal> payload() const;

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    uint64_t value_;
    std::shared_ptr<SharedSignal> payload_;
};

/// A fence or binary semaphore: signalled or not, and reusable. Thread-safe.
class BinarySignal {
  public:
    explicit BinarySignal(bool signalled = false) : signalled_(signalled) {}

    bool signalled() const;
    void signal();
    void reset();
    bool wait(uint64_t timeoutNanoseconds = UINT64_MAX) const;
    /// Waits for the signal and takes it back in one step (a semaphore wait).
    void consume();

    /// From now on it is another name of `payload`; `temporarily`: until it is consumed or reset. Nobody may be using
    /// the signal.
    void share(std::shared_ptr<SharedSignal> payload, bool temporarily);
    /// nullptr: it is of this process alone.
    std::shared_ptr<SharedSignal> payload() const;

  private:
    const std::shared_ptr<SharedSignal>& current() const { return temporary_ ? temporary_ : payload_; }

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    bool signalled_;
    std::shared_ptr<SharedSignal> payload_, temporary_;
};

/// Waits until all (or any) of the signals are set. False: timed out. Signals may be set from other threads meanwhile.
bool waitSignals(const BinarySignal* const* signals, uint32_t count, bool all, uint64_t timeoutNanoseconds);

}  // namespace vernier
