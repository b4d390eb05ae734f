// Transform feedback as a vertex shader asks for it: which of its outputs go where in the buffers. Tells what the
// decorations XfbBuffer, XfbStride and Offset say ("Transform Feedback" in the Vulkan specification).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "spirv_interp/program.h"

namespace vernier {

inline constexpr uint32_t kCaptureBuffers = 4;

/// One 32-bit word of a captured output; values of 64 bits are two.
struct CapturedWord {
    ir::InterfaceSlot output;  // the slot of Program::outputs that has its builtin, location and component
    uint32_t buffer = 0;       // below kCaptureBuffers
    uint32_t offset = 0;       // bytes from the begin of the vertex, a multiple of 4; offset + 4 <= the buffer's stride
};

struct CaptureLayout {
    std::vector<CapturedWord> words;                  // in the order of their declarations
    std::array<uint32_t, kCaptureBuffers> strides{};  // bytes from vertex to vertex; 0: nothing goes to the buffer

    bool empty() const { return words.empty(); }
};

/// loadShader() that also tells what is captured: nothing without the execution mode Xfb. Outputs that the shader never
/// writes are in the layout, but not in the program. Thread-safe. Defined in front/.
Result<ir::Program> loadShader(const ShaderSource& source, CaptureLayout& capture);

}  // namespace vernier
