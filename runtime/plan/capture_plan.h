// What transform feedback takes from the vertices that the last program before the rasteriser puts out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spirv_interp/capture.h"

namespace vernier {

/// A word that is copied from an output into a buffer.
struct CapturedOutput {
    uint32_t slot = ir::kNoIndex;  // of the compiled program's outputs; kNoIndex: never written, reads as 0
    uint32_t buffer = 0;           // below kCaptureBuffers
    uint32_t offset = 0;           // bytes from the begin of the vertex
    uint32_t stream = 0;           // of vertices
};

struct CapturePlan {
    std::vector<CapturedOutput> outputs;              // by buffer, then offset
    std::array<uint32_t, kCaptureBuffers> strides{};  // bytes from vertex to vertex; 0: nothing goes to the buffer
    std::array<uint32_t, kCaptureBuffers> extents{};  // bytes from the begin of a vertex to the end of its last word

    bool empty() const { return outputs.empty(); }
};

/// `last`: the linked program, which still has the outputs of the layout that it writes.
CapturePlan planCapture(const CaptureLayout& layout, const ir::Program& last);

}  // namespace vernier
