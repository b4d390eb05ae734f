#include "runtime/command/transform_feedback.h"

#include <algorithm>

namespace vernier {

void TransformFeedback::bind(uint32_t buffer, std::byte* data, uint64_t size) {
    if (buffer < kCaptureBuffers) bound_[buffer] = {data, data == nullptr ? 0 : size, 0};
}

void TransformFeedback::begin() {
    buffers_ = bound_;
    active_ = true;
}

CaptureTarget TransformFeedback::place(const CapturePlan& plan, uint32_t verticesPerPrimitive, uint64_t primitives) {
    CaptureTarget target;
    target.primitives = primitives;
    for (uint32_t b = 0; b < kCaptureBuffers; ++b) {
        if (plan.extents[b] == 0) continue;
        const uint64_t vertices = buffers_[b].room(plan.extents[b], plan.strides[b]);
        target.primitives = std::min(target.primitives, vertices / verticesPerPrimitive);
    }
    for (uint32_t b = 0; b < kCaptureBuffers && target.primitives != 0; ++b) {
        if (plan.extents[b] == 0) continue;
        target.data[b] = buffers_[b].data + buffers_[b].offset;
        buffers_[b].offset += target.primitives * verticesPerPrimitive * plan.strides[b];
    }
    return target;
}

RunningCapture TransformFeedback::running() const {
    return {buffers_};
}

void TransformFeedback::goOn(const RunningCapture& behind) {
    buffers_ = behind.buffers;
}

}  // namespace vernier
