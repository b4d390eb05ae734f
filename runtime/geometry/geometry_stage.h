// The geometry stage: primitives in, points or strips of vertices out (specification, "Geometry Shading").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/geometry/stage_vertices.h"
#include "runtime/geometry/vertex_stage.h"

namespace vernier {

/// Runs the geometry program of a draw for all primitives. `vertices` becomes what the program puts out, in the order
/// of the primitives, of each one's invocations, and of their emissions; `primitives` what the rasteriser gets of it,
/// `otherStreams` what it does not.
/// `token` as for shadeVertices(). Returns false when the program ran out of its loop budget.
bool runGeometry(const PreparedDraw& draw, uint64_t token, const StagePrimitives& in, ContextCache& cache,
                 StageVertices& vertices, std::vector<LocalPrimitive>& primitives, VertexStreams& otherStreams);

}  // namespace vernier
