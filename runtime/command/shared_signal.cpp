#include "runtime/command/shared_signal.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <climits>
#include <ctime>
#include <new>

namespace vernier {
namespace {

using Clock = std::chrono::steady_clock;

uint64_t tagOf(SharedSignal::Kind kind) {
    constexpr uint64_t kFirstTag = 0x6C6E6753;  // "Sgnl"; a number for each layout of the words, and for each kind
    return kFirstTag << 32 | static_cast<uint64_t>(kind);
}

/// Sleeps while `word` is `expected`, at most so long; may wake early.
void futexWait(const std::atomic<uint32_t>& word, uint32_t expected, uint64_t nanoseconds) {
    constexpr uint64_t kSecond = 1'000'000'000;
    timespec time{};
    time.tv_sec = static_cast<time_t>(nanoseconds / kSecond);
    time.tv_nsec = static_cast<long>(nanoseconds % kSecond);
    const bool forever = nanoseconds == UINT64_MAX;
    syscall(SYS_futex, &word, FUTEX_WAIT, expected, forever ? nullptr : &time, nullptr, 0);
}

void futexWakeAll(const std::atomic<uint32_t>& word) {
    syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace

/// As they lie in the shared memory. Futexes have 32 bits, values 64: who waits watches a count of the changes.
struct SharedSignal::Words {
    std::atomic<uint64_t> value;
    std::atomic<uint32_t> changes;
    static_assert(std::atomic<uint64_t>::is_always_lock_free && std::atomic<uint32_t>::is_always_lock_free);

    void changed() {
        changes.fetch_add(1);
        futexWakeAll(changes);
    }
};

SharedSignal::Words& SharedSignal::words() const {
    return *std::launder(reinterpret_cast<Words*>(pages_->data()));
}

Result<std::shared_ptr<SharedSignal>> SharedSignal::create(Kind kind, uint64_t value) {
    Result<std::unique_ptr<SharedPages>> pages = SharedPages::create(tagOf(kind), sizeof(Words), true);
    if (!pages) return pages.error();
    std::shared_ptr<SharedSignal> signal(new SharedSignal(std::move(pages).value()));
    new (signal->pages_->data()) Words{value, 0};
    return signal;
}

Result<std::shared_ptr<SharedSignal>> SharedSignal::import(Kind kind, int fd) {
    Result<std::unique_ptr<SharedPages>> pages = SharedPages::import(tagOf(kind), fd);
    if (!pages) return pages.error();
    return std::shared_ptr<SharedSignal>(new SharedSignal(std::move(pages).value()));
}

uint64_t SharedSignal::value() const {
    return words().value.load();
}

void SharedSignal::raise(uint64_t value) {
    Words& shared = words();
    uint64_t before = shared.value.load();
    while (before < value && !shared.value.compare_exchange_weak(before, value)) {
    }
    shared.changed();
}

void SharedSignal::reset() {
    words().value.store(0);
}

bool SharedSignal::wait(uint64_t value, uint64_t timeoutNanoseconds) const {
    const Words& shared = words();
    const Clock::time_point start = Clock::now();
    for (;;) {
        const uint32_t changes = shared.changes.load();
        if (shared.value.load() >= value) return true;
        uint64_t left = timeoutNanoseconds;
        if (left != UINT64_MAX) {
            const auto passed = static_cast<uint64_t>((Clock::now() - start) / std::chrono::nanoseconds(1));
            if (passed >= timeoutNanoseconds) return false;
            left -= passed;
        }
        futexWait(shared.changes, changes, left);
    }
}

void SharedSignal::consume() {
    Words& shared = words();
    for (;;) {
        (void)wait(1, UINT64_MAX);
        uint64_t signalled = 1;
        if (shared.value.compare_exchange_strong(signalled, 0)) return;
    }
}

}  // namespace vernier
