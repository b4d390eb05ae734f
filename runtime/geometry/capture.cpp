// Transform feedback: the vertices of primitives, before anything is clipped or culled, into buffers.
#include "runtime/geometry/capture.h"

#include <algorithm>
#include <cstring>

#include "runtime/geometry/assemble.h"

namespace vernier {
namespace {

/// Which vertex of a primitive is captured first: strips and fans come apart in the order that keeps the winding,
/// turned so that the provoking vertex is the first, or the last where the last one provokes
/// (transformFeedbackPreservesProvokingVertex).
uint32_t firstCaptured(const PreparedDraw& draw, const LocalPrimitive& primitive) {
    return primitive.provoking + (draw.state->provokingVertexLast ? 1 : 0);
}

std::vector<const CapturedOutput*> outputsOf(const CapturePlan& plan, uint32_t stream) {
    std::vector<const CapturedOutput*> outputs;
    for (const CapturedOutput& output : plan.outputs)
        if (output.stream == stream) outputs.push_back(&output);
    return outputs;
}

}  // namespace

uint64_t RunningCapture::Buffer::room(uint32_t extent, uint32_t stride) const {
    if (offset > size || size - offset < extent) return 0;
    return std::min((size - offset - extent) / stride + 1, (UINT32_MAX - offset) / stride);
}

/// The primitives at hand are those from `first` of the draw on. Every primitive has its place, whoever captures it.
void Assembler::capture(const PreparedDraw& draw, uint64_t first) const {
    const CaptureTarget& target = *draw.call.capture;
    const CapturePlan& plan = draw.call.pipeline->program().capture();
    const size_t words = plan.outputs.size();
    const uint32_t vertexCount = verticesPerPrimitive(draw.state->topology);
    const uint64_t end = std::min(first + primitives_.size(), target.primitives);
    for (uint64_t n = first; n < end; ++n) {
        const LocalPrimitive& primitive = primitives_[n - first];
        const uint32_t turn = firstCaptured(draw, primitive);
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

/// What the stages have made: the primitives at hand, and the points of the other streams.
void Assembler::captureStages(const PreparedDraw& draw, uint32_t drawIndex, Chunk& chunk) const {
    const CapturePlan& plan = draw.call.pipeline->program().capture();
    for (uint32_t stream = 0; stream < ir::kVertexStreams; ++stream) {
        const std::vector<const CapturedOutput*> outputs = outputsOf(plan, stream);
        CapturedPrimitives captured;
        captured.draw = drawIndex;
        captured.stream = stream;
        const auto take = [&](uint32_t vertex) {
            for (const CapturedOutput* output : outputs)
                captured.words.push_back(output->slot == ir::kNoIndex ? 0 : outputs_.plane(output->slot)[vertex]);
        };
        if (stream == 0) {
            const uint32_t each = verticesPerPrimitive(draw.plan->rasterTopology);
            captured.verticesPerPrimitive = each;
            captured.primitives = static_cast<uint32_t>(primitives_.size());
            for (const LocalPrimitive& primitive : primitives_)
                for (uint32_t v = 0; v < each; ++v) take(primitive.vertex[(firstCaptured(draw, primitive) + v) % each]);
        } else {
            captured.primitives = static_cast<uint32_t>(otherStreams_[stream].size());
            for (const uint32_t vertex : otherStreams_[stream]) take(vertex);
        }
        if (captured.primitives != 0) chunk.captured.push_back(std::move(captured));
    }
}

uint32_t writeCaptured(const PreparedDraw& draw, const CapturedPrimitives& captured) {
    const CapturePlan& plan = draw.call.pipeline->program().capture();
    const std::vector<const CapturedOutput*> outputs = outputsOf(plan, captured.stream);
    RunningCapture& running = *draw.call.capture->running;
    std::array<bool, kCaptureBuffers> used{};
    for (const CapturedOutput* output : outputs) used[output->buffer] = true;
    uint64_t vertices = uint64_t{captured.primitives} * captured.verticesPerPrimitive;
    for (uint32_t b = 0; b < kCaptureBuffers; ++b)
        if (used[b]) vertices = std::min(vertices, running.buffers[b].room(plan.extents[b], plan.strides[b]));
    const uint64_t primitives = vertices / captured.verticesPerPrimitive;
    const uint32_t* word = captured.words.data();
    for (uint64_t n = 0; n < primitives * captured.verticesPerPrimitive; ++n) {
        for (const CapturedOutput* output : outputs) {
            const RunningCapture::Buffer& buffer = running.buffers[output->buffer];
            std::memcpy(buffer.data + buffer.offset + output->offset, word++, sizeof(uint32_t));
        }
        for (uint32_t b = 0; b < kCaptureBuffers; ++b)
            if (used[b]) running.buffers[b].offset += plan.strides[b];
    }
    return static_cast<uint32_t>(primitives);
}

}  // namespace vernier
