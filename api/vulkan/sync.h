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

/// Makes the payload of a new semaphore or fence one that can be exported, if the structures in the chain of its
/// creation ask for that. VK_SUCCESS, or what the creation returns; errors have been reported.
VkResult shareSemaphore(const Device& device, Semaphore& semaphore, const void* chain, uint64_t value);
VkResult shareFence(const Device& device, BinarySignal& fence, const void* chain);

}  // namespace vernier::vulkan
