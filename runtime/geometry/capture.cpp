// Transform feedback: the vertices of primitives, before anything is clipped or culled, into buffers.
#include <algorithm>
#include <cstring>

#include "runtime/geometry/assemble.h"

namespace vernier {

/// The primitives at hand are those from `first` of the draw on. Every primitive has its place, whoever captures it:
/// strips and fans come apart in the order that keeps the winding, turned so that the provoking vertex is the first, or
/// the last where the last one provokes (transformFeedbackPreservesProvokingVertex).
void Assembler::capture(const PreparedDraw& draw, uint64_t first) const {
    const CaptureTarget& target = *draw.call.capture;
    const CapturePlan& plan = draw.call.pipeline->program().capture();
    const size_t words = plan.outputs.size();
    const uint32_t vertexCount = verticesPerPrimitive(draw.state->topology);
    const uint64_t end = std::min(first + primitives_.size(), target.primitives);
    for (uint64_t n = first; n < end; ++n) {
        const LocalPrimitive& primitive = primitives_[n - first];
        const uint32_t turn = primitive.provoking + (draw.state->provokingVertexLast ? 1 : 0);
        for (uint32_t v = 0; v < vertexCount; ++v) {
            const uint32_t* from = vertices_.captured.data() + primitive.vertex[(turn + v) % vertexCount] * words;
            for (size_t k = 0; k < words; ++k) {
                const CapturedOutput& output = plan.outputs[k];
                const uint64_t at = (n * vertexCount + v) * plan.strides[output.buffer] + output.offset;
                std::memcpy(target.data[output.buffer] + at, from + k, sizeof(uint32_t));
            }
        }
    }
}

}  // namespace vernier
