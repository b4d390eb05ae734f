// Vertex fetch, the vertex program, and projection, for the vertices of a run of primitives.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/prepared_draw.h"
#include "runtime/geometry/stage_vertices.h"
#include "spirv_interp/program.h"

namespace vernier {

/// One thread's registers, by program. Kept from pass to pass.
class ContextCache {
  public:
    struct Entry {
        BatchContext context;
        uint64_t begun = 0;  // the token that beginDraw was last called for; 0 = none. Tokens are never used twice
    };
    Entry& get(const std::shared_ptr<const BatchProgram>& program);
    /// The program's registers, ready for the draw with the token.
    BatchContext& begin(const std::shared_ptr<const BatchProgram>& program, uint64_t token,
                        const ResourceBindings& bindings);
    /// Drops the contexts when there are many: nobody may use one then.
    void trim();

  private:
    std::unordered_map<const BatchProgram*, Entry> entries_;
};

struct VertexRef {
    uint32_t index;     // gl_VertexIndex
    uint32_t instance;  // counted from 0
};

/// Vertices as the rasteriser gets them: structure of arrays. Attributes go straight into the chunk.
struct ShadedVertices {
    std::vector<float> clip[4];
    std::vector<int32_t> x, y;
    std::vector<float> z;
    std::vector<double> inverseW;
    std::vector<uint32_t> flags;
    std::vector<uint8_t> culled;       // bit per cull distance: negative
    std::vector<float> clipDistances;  // vertex-major
    std::vector<float> pointSize;
    std::vector<uint32_t> layers, viewports;  // empty unless the program writes them
    std::vector<uint32_t> captured;           // vertex-major, by CapturePlan::outputs; empty unless it is asked for
    uint32_t firstAttribute = 0;              // of vertex 0 in Chunk::attributes
    uint32_t attributeStride = 0;

    uint32_t attributesOf(uint32_t vertex) const { return firstAttribute + vertex * attributeStride; }
    void resize(uint32_t count, const Plan& plan);
    /// Replaces them by copies: vertex n by that with the number chosen[n].
    void choose(const std::vector<uint32_t>& chosen, const Plan& plan, Chunk& chunk);
};

/// Runs `draw`'s vertex program for `refs`. `token` identifies the draw's bindings for ContextCache. Returns
/// false when the program ran out of its loop budget.
bool shadeVertices(const PreparedDraw& draw, uint64_t token, const std::vector<VertexRef>& refs, ContextCache& cache,
                   ShadedVertices& vertices, Chunk& chunk);

/// The same, for a stage behind.
bool shadeForStages(const PreparedDraw& draw, uint64_t token, const std::vector<VertexRef>& refs, ContextCache& cache,
                    StageVertices& vertices);

/// Projects what the last stage before the rasteriser put out.
void finishVertices(const PreparedDraw& draw, const StageVertices& from, ShadedVertices& vertices, Chunk& chunk);

}  // namespace vernier
