#include "runtime/command/device.h"

#include <algorithm>
#include <new>
#include <system_error>

#include "base/cpu_budget.h"
#include "runtime/command/executor.h"
#include "runtime/command/thread_limit.h"
#include "spirv_interp/prepare.h"

namespace vernier {

struct Queue::Impl {
    explicit Impl(Device& owner) : device(owner), thread([this] { main(); }) {}
    ~Impl() {
        {
            const std::lock_guard lock(mutex);
            stop = true;
        }
        wake.notify_all();
        thread.join();
    }

    void main();
    void process(Submission& submission);

    Device& device;
    std::unique_ptr<Executor> executor;  // made on the queue's thread by the first submission
    std::atomic<bool> lost{false};

    std::mutex mutex;
    std::condition_variable wake;
    std::deque<Submission> pending;
    uint64_t submitted = 0;
    bool stop = false;
    Timeline completed;
    std::thread thread;  // last: it uses everything above
};

void Queue::Impl::main() {
    const FloatControlScope floatControl;
    // Beside the application, which has nothing to draw yet.
    prepareBatches(device.isa(), device.desc().accuracy.math);
    uint64_t done = 0;
    std::unique_lock lock(mutex);
    while (true) {
        wake.wait(lock, [this] { return stop || !pending.empty(); });
        if (pending.empty()) return;  // stop, and nothing left to do
        Submission submission = std::move(pending.front());
        pending.pop_front();
        lock.unlock();
        process(submission);
        completed.signal(++done);
        lock.lock();
    }
}

void Queue::Impl::process(Submission& submission) {
    for (BinarySignal* semaphore : submission.waitSemaphores) semaphore->consume();
    for (const auto& point : submission.waitTimelines) point.timeline->wait(point.value);
    if (!lost) {
        try {
            if (!executor) executor = std::make_unique<Executor>(device);
            const SubmissionReport before = executor->ran();
            for (const CommandBuffer* commands : submission.commands) executor->run(*commands);
            if (!executor->finish()) lost = true;
            if (device.desc().report && !lost) device.desc().report(executor->ran().since(before));
        } catch (...) {  // memory ran out: std::bad_alloc, or std::length_error of a container
            executor.reset();
            lost = true;
        }
    }
    // Signals come even from a lost device: nobody may wait for ever.
    for (BinarySignal* semaphore : submission.signalSemaphores) semaphore->signal();
    for (const auto& point : submission.signalTimelines) point.timeline->signal(point.value);
    if (submission.fence) submission.fence->signal();
    if (submission.done) submission.done();
}

Queue::Queue(Device& device) : impl_(std::make_unique<Impl>(device)) {}
Queue::~Queue() = default;

void Queue::submit(Submission submission) {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->pending.push_back(std::move(submission));
        ++impl_->submitted;
    }
    impl_->wake.notify_one();
}

void Queue::waitIdle() {
    uint64_t target = 0;
    {
        const std::lock_guard lock(impl_->mutex);
        target = impl_->submitted;
    }
    impl_->completed.wait(target);
}

bool Queue::lost() const {
    return impl_->lost;
}

Device::Device(const DeviceDesc& desc)
    : desc_(desc),
      isa_(bestIsaUpTo(desc.maxIsa)),
      pool_(desc.threads ? desc.threads : usableCpuCount()),
      queue_(std::make_unique<Queue>(*this)) {}

Device::~Device() = default;

Result<std::unique_ptr<Device>> Device::create(const DeviceDesc& desc) {
    if (desc.threads > kMaxThreads)
        return invalidArgument("device: threads is " + std::to_string(desc.threads) + ", but must be at most " +
                               std::to_string(kMaxThreads));
    try {
        return std::unique_ptr<Device>(new Device(desc));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::outOfHostMemory, "device: no memory"};
    } catch (const std::system_error& error) {
        return Error{ErrorCode::outOfHostMemory, std::string("device: no thread could be started: ") + error.what()};
    }
}

}  // namespace vernier
