// Tessellation: patches in, points, lines or triangles out, through the control program, the tessellator and the
// evaluation program (specification, "Tessellation").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/geometry/stage_vertices.h"
#include "runtime/geometry/tessellator.h"
#include "runtime/geometry/vertex_stage.h"

namespace vernier {

/// One thread's. Not thread-safe.
class TessellationStage {
  public:
    /// `out` becomes what the patches `in` are subdivided into, in their order, with the outputs of the evaluation
    /// program, which runs once for each point of a patch. All primitives of a patch have its PrimitiveId. `token` as
    /// for shadeVertices(). Returns false when a program ran out of its loop budget.
    bool run(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache,
             StagePrimitives& out);

  private:
    bool control(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache);
    void subdivide(const PreparedDraw& draw, const StagePrimitives& in, StagePrimitives& out);
    bool evaluate(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache,
                  StagePrimitives& out);

    struct Point {
        TessellationPoint place;
        uint32_t patch = 0;
    };
    std::vector<uint32_t> rows_;  // the outputs of the control program, patch by patch
    std::vector<Point> points_;
    std::optional<Tessellator> tessellator_;
    TessellationModes modes_;  // of it
};

}  // namespace vernier
