// What semaphores and fences are made of that other processes share: a number in shared memory.
#pragma once

#include <cstdint>
#include <memory>

#include "base/result.h"
#include "base/shared_pages.h"

namespace vernier {

/// A number that threads of several processes can raise and wait for; waits sleep (futex(2)). Of binary semaphores and
/// fences it is 0 or 1. Safe between threads and processes.
class SharedSignal {
  public:
    enum class Kind : uint8_t { binarySemaphore, timelineSemaphore, fence };

    static Result<std::shared_ptr<SharedSignal>> create(Kind kind, uint64_t value);
    /// Of a descriptor that exportFd() gave, of the same kind. Owns the descriptor if, and only if, it succeeds.
    static Result<std::shared_ptr<SharedSignal>> import(Kind kind, int fd);
    /// A new descriptor, which the caller owns; -1 when the process has no more.
    int exportFd() const { return pages_->exportFd(); }

    uint64_t value() const;
    /// Raises the value (never lowers it) and wakes who waits.
    void raise(uint64_t value);
    /// Back to 0.
    void reset();
    /// Waits until value() >= `value`. UINT64_MAX waits for ever. False: timed out.
    bool wait(uint64_t value, uint64_t timeoutNanoseconds) const;
    /// Waits for 1 and takes it back in one step: of several that wait, one gets it.
    void consume();

  private:
    struct Words;
    explicit SharedSignal(std::unique_ptr<SharedPages> pages) : pages_(std::move(pages)) {}
    Words& words() const;

    std::unique_ptr<SharedPages> pages_;
};

}  // namespace vernier
