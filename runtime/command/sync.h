// Order between queues and the host. A timeline is a number that only grows; fences, binary semaphores and timeline
// semaphores are all made of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

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

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    uint64_t value_;
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

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    bool signalled_;
};

/// Waits until all (or any) of the signals are set. False: timed out. Signals may be set from other threads meanwhile.
bool waitSignals(const BinarySignal* const* signals, uint32_t count, bool all, uint64_t timeoutNanoseconds);

}  // namespace vernier
