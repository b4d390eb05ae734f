// A device and its queue: what both front ends are built on.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "base/thread_pool.h"
#include "runtime/accuracy.h"
#include "runtime/command/command_buffer.h"
#include "runtime/command/sync.h"
#include "runtime/raster/frame_facts.h"
#include "runtime/resource/address_space.h"
#include "runtime/resource/memory.h"
#include "runtime/skips.h"

namespace vernier {

/// What a submission ran.
struct SubmissionReport {
    FrameCommands commands;
    PassStatistics statistics;
    SubmissionReport since(const SubmissionReport& earlier) const {
        return {{commands.draws - earlier.commands.draws, commands.dispatches - earlier.commands.dispatches},
                combine(statistics, earlier.statistics, std::minus<>{})};
    }
};

struct DeviceDesc {
    uint32_t threads = 0;  // 0: as many as there are usable CPUs
    Isa maxIsa = kHighestIsa;
    Accuracy accuracy;
    Skips skips;
    HostAllocator allocator;
    /// Called on the queue's thread after each submission that was run to its end.
    std::function<void(const SubmissionReport&)> report;
    /// Called on the queue's thread with what a draw or dispatch does wrong that does no harm; empty: not looked for.
    std::function<void(const std::string&)> misuse;
};

/// One batch of work: waits, runs the command buffers in order, signals. Everything named stays alive until it is done.
struct Submission {
    struct TimelinePoint {
        Timeline* timeline = nullptr;
        uint64_t value = 0;
    };
    std::vector<BinarySignal*> waitSemaphores;
    std::vector<TimelinePoint> waitTimelines;
    std::vector<const CommandBuffer*> commands;
    std::vector<BinarySignal*> signalSemaphores;
    std::vector<TimelinePoint> signalTimelines;
    BinarySignal* fence = nullptr;
    std::function<void()> done;  // called on the queue's thread last of all; presents and frees
};

class Device;

/// Runs submissions one after the other on a thread of its own, which sleeps when there is none. Thread-safe.
class Queue {
  public:
    explicit Queue(Device& device);
    ~Queue();
    /// Returns at once.
    void submit(Submission submission);
    /// Waits until everything submitted before has run.
    void waitIdle();
    /// A shader ran out of its loop budget, or memory ran out in the middle of a submission: later work is not run.
    bool lost() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

class Device {
  public:
    static Result<std::unique_ptr<Device>> create(const DeviceDesc& desc);
    ~Device();

    const DeviceDesc& desc() const { return desc_; }
    Isa isa() const { return isa_; }
    ThreadPool& pool() { return pool_; }
    Queue& queue() { return *queue_; }
    /// The buffers that programs may reach by address.
    AddressSpace& addresses() { return addresses_; }

  private:
    explicit Device(const DeviceDesc& desc);
    DeviceDesc desc_;
    Isa isa_;
    ThreadPool pool_;
    AddressSpace addresses_;
    std::unique_ptr<Queue> queue_;
};

}  // namespace vernier
