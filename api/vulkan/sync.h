// Semaphores and events. A fence is a vernier::BinarySignal.
#pragma once

#include <atomic>

#include "api/vulkan/handle.h"
#include "runtime/command/sync.h"

namespace vernier::vulkan {

/// Binary or timeline: only the signal of its own kind is used.
struct Semaphore {
    Semaphore(bool isTimeline, uint64_t value) : timeline(isTimeline), counter(value) {}
    bool timeline;
    BinarySignal binary;
    Timeline counter;
};

struct Event {
    std::atomic<bool> set{false};
};

}  // namespace vernier::vulkan
