#include "runtime/command/scheduler.h"

#include <utility>

namespace vernier {

void Scheduler::Item::run() noexcept {
    try {
        if (!owner->failed_.load(std::memory_order_relaxed)) work();
        work = nullptr;
    } catch (...) {
        const std::lock_guard lock(owner->mutex_);
        if (!owner->failure_) owner->failure_ = std::current_exception();
        owner->failed_ = true;
    }
    owner->ended(*this);
}

Scheduler::Scheduler(ThreadPool& pool) : pool_(pool) {
    for (uint32_t n = 0; n < kMostPending; ++n) {
        items_[n].owner = this;
        items_[n].slot = n;
    }
}

Scheduler::~Scheduler() {
    waitFor(~Mask{0});
}

void Scheduler::ended(const Item& item) noexcept {
    const Mask own = Mask{1} << item.slot;
    const std::lock_guard lock(mutex_);
    pending_ &= ~own;
    // In the order in which they were handed over, which is that of the slots from here on.
    for (uint32_t n = 1; n < kMostPending; ++n) {
        Item& other = items_[(item.slot + n) % kMostPending];
        if ((pending_ >> other.slot & 1) == 0 || (other.waitsFor & own) == 0) continue;
        other.waitsFor &= ~own;
        if (other.waitsFor == 0) pool_.post(other);
    }
}

AccessSet& Scheduler::nextAccesses() {
    if (open_ == nullptr) {
        const auto isFree = [&](uint32_t slot) { return (pending_.load(std::memory_order_acquire) >> slot & 1) == 0; };
        if (!isFree(next_)) pool_.workUntil([&] { return isFree(next_); });
        open_ = &items_[next_];
        next_ = (next_ + 1) % kMostPending;
    }
    open_->accesses.clear();
    return open_->accesses;
}

Scheduler::Mask Scheduler::submit(std::function<void()> work, Mask also) {
    Item& item = *std::exchange(open_, nullptr);
    item.work = std::move(work);
    item.accesses.finish();
    // Work that ends meanwhile is taken out below; nobody else begins any.
    const Mask before = conflicting(item.accesses) | also;
    const Mask own = Mask{1} << item.slot;
    const std::lock_guard lock(mutex_);
    item.waitsFor = before & pending_;
    pending_ |= own;
    if (item.waitsFor == 0) pool_.post(item);
    return own;
}

Scheduler::Mask Scheduler::conflicting(const AccessSet& accesses) const {
    const Mask pending = pending_.load(std::memory_order_acquire);
    Mask result = 0;
    for (uint32_t n = 0; n < kMostPending; ++n)
        if ((pending >> n & 1) != 0 && AccessSet::conflicts(items_[n].accesses, accesses)) result |= Mask{1} << n;
    return result;
}

void Scheduler::waitFor(Mask work) {
    waitUntil([&] { return (pending_.load(std::memory_order_acquire) & work) == 0; });
}

void Scheduler::waitUntil(const std::function<bool()>& ready) {
    pool_.workUntil([&] { return ready() || pending_.load(std::memory_order_acquire) == 0; });
}

void Scheduler::finish() {
    waitFor(~Mask{0});
    if (!failed_) return;
    failed_ = false;
    std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace vernier
