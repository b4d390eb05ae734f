// Where transform feedback goes on. How much a draw captures follows from its counts and its topology alone: the walk
// through the commands knows what every draw writes before any of them runs, and what runs has nothing to count. Where
// stages make primitives of their own, the draw has to run first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/geometry/draw_call.h"
#include "runtime/plan/capture_plan.h"

namespace vernier {

/// Not thread-safe: it belongs to the walk.
class TransformFeedback {
  public:
    /// `data` nullptr: nothing is bound, which has no room. Counts from the next begin() on.
    void bind(uint32_t buffer, std::byte* data, uint64_t size);
    /// From the begin of every buffer.
    void begin();
    /// After begin(): goes on so many bytes behind the begin of a buffer.
    void resume(uint32_t buffer, uint32_t offset) { buffers_[buffer].offset = offset; }
    void end() { active_ = false; }

    bool active() const { return active_; }
    /// Bytes from the begin of a buffer to where it goes on.
    uint64_t offset(uint32_t buffer) const { return buffers_[buffer].offset; }

    /// Takes room for the primitives of a draw. Those that one of the buffers has no room for are dropped.
    CaptureTarget place(const CapturePlan& plan, uint32_t verticesPerPrimitive, uint64_t primitives);
    /// Where a draw goes on whose stages tell what there is to capture; and from where it has been.
    RunningCapture running() const;
    void goOn(const RunningCapture& behind);

  private:
    std::array<RunningCapture::Buffer, kCaptureBuffers> bound_{}, buffers_{};
    bool active_ = false;
};

}  // namespace vernier
