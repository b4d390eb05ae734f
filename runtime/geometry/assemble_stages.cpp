// Primitives of draws with stages between the vertices and the rasteriser: their vertices, those stages, and what
// comes out.
#include <algorithm>
#include <numeric>

#include "runtime/geometry/assemble.h"
#include "runtime/geometry/geometry_stage.h"

namespace vernier {

/// The vertices of primitives as the stage behind the vertices gets them.
void Assembler::numberInputs(const PreparedDraw& draw, const PrimitiveRange& range) {
    startReuse();
    const uint32_t each = draw.plan->inputVertices;
    inputs_.verticesPerPrimitive = each;
    inputs_.numbers.clear();
    inputs_.ids.clear();
    std::array<uint32_t, kMaxInputVertices> numbers;
    auto instance = static_cast<uint32_t>(range.first / draw.primitivesPerInstance);
    auto primitive = static_cast<uint32_t>(range.first % draw.primitivesPerInstance);
    auto run = runAt(draw, primitive);
    const bool indexed = draw.call.indices.data != nullptr;
    for (uint32_t left = range.count; left != 0; --left) {
        if (draw.state->topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST) {
            std::iota(numbers.begin(), numbers.begin() + each, (primitive - run->firstPrimitive) * each);
        } else {
            const uint32_t number = primitive - run->firstPrimitive;
            inputVertices(draw.state->topology, number, run->primitives, numbers.data());
            if (draw.state->provokingVertexLast && each % 3 == 0) {
                // Turned so that the provoking vertex is the last, as OpenGL orders strips and fans (4.6, table 10.1).
                const uint32_t last = primitiveVertices(draw.state->topology, number).provokingLast;
                std::rotate(numbers.begin(), numbers.begin() + (last + 1) % 3 * (each / 3), numbers.begin() + each);
            }
        }
        for (uint32_t v = 0; v < each; ++v)
            inputs_.numbers.push_back(
                localVertex({vertexIndex(draw.call, indexed, run->first + numbers[v]), instance}));
        inputs_.ids.push_back(primitive);
        if (++primitive == draw.primitivesPerInstance) {
            primitive = 0;
            ++instance;
            run = draw.runs.begin();
        } else if (primitive == run->firstPrimitive + run->primitives) {
            ++run;
        }
    }
}

/// The primitives that patches have been subdivided into, for the rasteriser.
void Assembler::takeTessellated(const PreparedDraw& draw) {
    std::swap(outputs_, tessellated_.vertices);
    primitives_.clear();
    for (std::vector<uint32_t>& points : otherStreams_) points.clear();
    const uint32_t each = tessellated_.verticesPerPrimitive;
    for (size_t n = 0; n < tessellated_.ids.size(); ++n) {
        LocalPrimitive& primitive = primitives_.emplace_back();
        const uint32_t* numbers = tessellated_.numbers.data() + n * each;
        for (uint32_t v = 0; v < 3; ++v) primitive.vertex[v] = numbers[v < each ? v : 0];
        primitive.provoking = draw.state->provokingVertexLast ? each - 1 : 0;
        primitive.primitiveId = tessellated_.ids[n];
        primitive.startsStrip = true;
    }
}

/// From the vertices to those that the rasteriser gets, with the primitives that they make up.
bool Assembler::runStages(const PreparedDraw& draw, uint64_t token, const PrimitiveRange& range, Chunk& chunk) {
    numberInputs(draw, range);
    bool finished = shadeForStages(draw, token, refs_, contexts_, inputs_.vertices);
    statistics_.vertexInvocations += refs_.size();
    const bool tessellates = draw.call.pipeline->controlProgram() != nullptr;
    if (tessellates) {
        finished &= tessellation_.run(draw, token, inputs_, contexts_, tessellated_);
        statistics_.controlPatches += inputs_.ids.size();
        statistics_.evaluationInvocations += tessellated_.vertices.count();
    }
    if (draw.call.pipeline->geometryProgram() == nullptr) {
        takeTessellated(draw);
    } else {
        const StagePrimitives& in = tessellates ? tessellated_ : inputs_;
        finished &= runGeometry(draw, token, in, contexts_, outputs_, primitives_, otherStreams_);
        statistics_.geometryInvocations +=
            in.ids.size() * draw.call.pipeline->geometryProgram()->source().geometry.invocations;
        statistics_.geometryPrimitives += primitives_.size();
        for (const std::vector<uint32_t>& points : otherStreams_) statistics_.geometryPrimitives += points.size();
    }
    // Points, each of them a vertex, but for the first stream.
    statistics_.generatedPrimitives[0] += primitives_.size();
    for (uint32_t stream = 1; stream < ir::kVertexStreams; ++stream)
        statistics_.generatedPrimitives[stream] += otherStreams_[stream].size();
    finishVertices(draw, outputs_, vertices_, chunk);
    return finished;
}

}  // namespace vernier
