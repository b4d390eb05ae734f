// What transform feedback takes from the vertices of a program.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spirv_interp/capture.h"

namespace vernier {

/// A word that is copied from an output into a buffer.
struct CapturedOutput {
    uint32_t slot = ir::kNoIndex;  // of the compiled vertex program's outputs; kNoIndex: never written, reads as 0
    uint32_t buffer = 0;           // below kCaptureBuffers
    uint32_t offset = 0;           // bytes from the begin of the vertex
};

struct CapturePlan {
    std::vector<CapturedOutput> outputs;              // by buffer, then offset
    std::array<uint32_t, kCaptureBuffers> strides{};  // bytes from vertex to vertex; 0: nothing goes to the buffer
    std::array<uint32_t, kCaptureBuffers> extents{};  // bytes from the begin of a vertex to the end of its last word

    bool empty() const { return outputs.empty(); }
};

/// `vertex`: the linked program, which still has the outputs of the layout that it writes.
CapturePlan planCapture(const CaptureLayout& layout, const ir::Program& vertex);

}  // namespace vernier
