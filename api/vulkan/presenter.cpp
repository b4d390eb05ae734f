#include "api/vulkan/presenter.h"

#include <numeric>

namespace vernier::vulkan {
namespace {

uint32_t takeFirst(std::vector<uint32_t>& list) {
    const uint32_t first = list.front();
    list.erase(list.begin());
    return first;
}

}  // namespace

Presenter::Presenter(std::shared_ptr<Screen> screen, std::vector<const Image*> images, VkPresentModeKHR mode,
                     Clock::duration period)
    : screen_(std::move(screen)),
      images_(std::move(images)),
      mode_(mode),
      period_(mode == VK_PRESENT_MODE_IMMEDIATE_KHR || screen_->setsPace() ? Clock::duration::zero() : period),
      states_(images_.size(), State::free),
      free_(images_.size()),
      nextRefresh_(Clock::now()) {
    std::iota(free_.begin(), free_.end(), 0u);
    waiting_.reserve(images_.size());
    thread_ = std::thread([this] { main(); });
}

VkResult Presenter::acquire(uint64_t timeout, uint32_t& index) {
    // Beyond this many nanoseconds clocks overflow.
    constexpr uint64_t kForever = UINT64_MAX / 4;
    std::unique_lock lock(mutex_);
    const auto ready = [&] { return !free_.empty() || retired_ || status_ != VK_SUCCESS; };
    if (timeout >= kForever) {
        changed_.wait(lock, ready);
    } else if (!changed_.wait_for(lock, std::chrono::nanoseconds(timeout), ready)) {
        return timeout == 0 ? VK_NOT_READY : VK_TIMEOUT;
    }
    if (status_ != VK_SUCCESS) return status_;
    if (retired_) return VK_ERROR_OUT_OF_DATE_KHR;
    index = takeFirst(free_);
    states_[index] = State::acquired;
    return VK_SUCCESS;
}

bool Presenter::enqueue(uint32_t index) {
    const std::lock_guard lock(mutex_);
    if (index >= states_.size() || states_[index] != State::acquired) return false;
    states_[index] = State::enqueued;
    return true;
}

void Presenter::takeBack(uint32_t index) {
    const std::lock_guard lock(mutex_);
    states_[index] = State::acquired;
}

void Presenter::present(uint32_t index) noexcept {
    const std::lock_guard lock(mutex_);
    if (status_ != VK_SUCCESS || stopped_) return release(index);
    if (mode_ == VK_PRESENT_MODE_MAILBOX_KHR) {
        while (!waiting_.empty()) release(takeFirst(waiting_));
    }
    states_[index] = State::waiting;
    waiting_.push_back(index);
    changed_.notify_all();
}

VkResult Presenter::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

void Presenter::retire() {
    const std::lock_guard lock(mutex_);
    retired_ = true;
    while (!waiting_.empty()) release(takeFirst(waiting_));
    changed_.notify_all();
}

bool Presenter::active() const {
    const std::lock_guard lock(mutex_);
    return !retired_ && !stopped_;
}

void Presenter::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        changed_.notify_all();
    }
    if (screen_) screen_->stop();
    if (thread_.joinable()) thread_.join();
}

bool Presenter::awaitTurn(std::unique_lock<std::mutex>& lock) {
    do {
        changed_.wait(lock, [&] { return stopped_ || !waiting_.empty(); });
        if (period_ == Clock::duration::zero()) break;
        changed_.wait_until(lock, nextRefresh_, [&] { return stopped_; });
        // What waited may not any more.
    } while (!stopped_ && waiting_.empty());
    const Clock::time_point now = Clock::now();
    nextRefresh_ = (now < nextRefresh_ + period_ ? nextRefresh_ : now) + period_;
    return !stopped_;
}

void Presenter::main() {
    std::unique_lock lock(mutex_);
    while (awaitTurn(lock)) {
        const uint32_t index = takeFirst(waiting_);
        lock.unlock();
        const VkResult result = screen_->show(*images_[index], [this, index] {
            const std::lock_guard done(mutex_);
            release(index);
        });
        lock.lock();
        if (result != VK_SUCCESS) {
            status_ = result;
            while (!waiting_.empty()) release(takeFirst(waiting_));
            changed_.notify_all();
        }
    }
}

void Presenter::release(uint32_t index) {
    states_[index] = State::free;
    free_.push_back(index);
    changed_.notify_all();
}

}  // namespace vernier::vulkan
