// Transform feedback: what draws capture, counters, and draws of what was captured.
#include <cstring>

#include "runtime/command/buffer_range.h"
#include "runtime/command/executor.h"

namespace vernier {

void Executor::run(const command::BindTransformFeedbackBuffers& command) {
    for (size_t i = 0; i < command.ranges.size(); ++i) {
        const command::BufferRange& range = command.ranges[i];
        const VertexStream stream = streamOf(range);
        std::byte* data = stream.data == nullptr ? nullptr : range.buffer->data() + range.offset;
        feedback_.bind(command.first + static_cast<uint32_t>(i), data, stream.size);
    }
}

void Executor::run(const command::BeginTransformFeedback& command) {
    feedback_.begin();
    for (uint32_t i = 0; i < command.counters.size() && command.first + i < kCaptureBuffers; ++i) {
        const command::BufferRange& counter = command.counters[i];
        if (counter.buffer == nullptr) continue;
        awaitWrites(argumentBytes<uint32_t>(counter));
        feedback_.resume(command.first + i, argumentsAt<uint32_t>(counter).value_or(0));
    }
}

/// A counter is written by work of its own, which what reads it waits for, but for no draw: the value is known.
void Executor::run(const command::EndTransformFeedback& command) {
    if (!feedback_.active()) return;
    feedback_.end();
    for (uint32_t i = 0; i < command.counters.size() && command.first + i < kCaptureBuffers; ++i) {
        const command::BufferRange& counter = command.counters[i];
        if (argumentBytes<uint32_t>(counter).size < sizeof(uint32_t)) continue;
        std::byte* to = counter.buffer->data() + counter.offset;
        const auto value = static_cast<uint32_t>(feedback_.offset(command.first + i));
        scheduler_.nextAccesses().write(to, sizeof value);
        scheduler_.submit([to, value] { std::memcpy(to, &value, sizeof value); });
    }
}

void Executor::run(const command::DrawIndirectByteCount& command) {
    awaitWrites(argumentBytes<uint32_t>(command.counter));
    const auto counter = argumentsAt<uint32_t>(command.counter);
    if (!counter || *counter < command.counterOffset || command.stride == 0) return;
    draw({false, (*counter - command.counterOffset) / command.stride, command.instances, 0, command.firstInstance, 0,
          0});
}

/// nullptr: the program captures nothing.
const CaptureTarget* Executor::placeCapture(const DrawCall& call) {
    const CapturePlan& plan = pipeline_->program().capture();
    if (plan.empty()) return nullptr;
    if (pipeline_->plan().stages) return placeRunning(plan);
    const VkPrimitiveTopology topology = pipeline_->state().topology;
    uint64_t primitives = 0;
    for (const VertexRun& run : vertexRuns(call, topology, pipeline_->state().primitiveRestart))
        primitives += run.primitives;
    const uint32_t vertexCount = verticesPerPrimitive(topology);
    const CaptureTarget target = feedback_.place(plan, vertexCount, primitives * call.instances);
    if (target.primitives != 0) {
        AccessSet writes;
        for (uint32_t b = 0; b < kCaptureBuffers; ++b)
            if (target.data[b] != nullptr)
                writes.write(target.data[b], (target.primitives * vertexCount - 1) * plan.strides[b] + plan.extents[b]);
        writes.finish();
        pass_->captured.finish();
        // What is captured twice in a place is there in the order of the draws.
        if (AccessSet::conflicts(writes, pass_->captured)) catchUp();
        pass_->captured.add(writes);
        pass_->geometry.add(writes);
        pass_->writesVertices = true;
    }
    return pass_->arena.create(target);
}

/// The draw is run at once: it may write what is left of every buffer.
const CaptureTarget* Executor::placeRunning(const CapturePlan& plan) {
    CaptureTarget& target = *pass_->arena.create(CaptureTarget());
    target.running = pass_->arena.create(feedback_.running());
    for (uint32_t b = 0; b < kCaptureBuffers; ++b) {
        const RunningCapture::Buffer& buffer = target.running->buffers[b];
        if (plan.extents[b] != 0 && buffer.data != nullptr && buffer.offset < buffer.size)
            pass_->geometry.write(buffer.data + buffer.offset, buffer.size - buffer.offset);
    }
    pass_->writesVertices = true;
    return &target;
}

}  // namespace vernier
