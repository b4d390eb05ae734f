// Which vertices make up which primitive (specification, "Primitive Topologies").
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vernier {

struct DrawCall;

/// Numbers of a primitive's vertices within its run of vertices, in the specification's order.
struct PrimitiveVertices {
    std::array<uint32_t, 3> vertex;
    uint32_t provokingFirst, provokingLast;  // positions in `vertex`
};

/// Vertices of one primitive: 1, 2 or 3.
uint32_t verticesPerPrimitive(VkPrimitiveTopology topology);

/// Complete primitives that `vertices` consecutive vertices make.
/// Patches are of `patchVertices`.
uint32_t primitiveCount(VkPrimitiveTopology topology, uint32_t vertices, uint32_t patchVertices = 1);

PrimitiveVertices primitiveVertices(VkPrimitiveTopology topology, uint32_t primitive);

/// All vertices of primitive `primitive` of `primitives` in a run, as the stage behind the vertices gets them: in the
/// specification's order, those of its neighbours included. `vertices` has room for plan.inputVertices.
void inputVertices(VkPrimitiveTopology topology, uint32_t primitive, uint32_t primitives, uint32_t* vertices);

/// A run of vertices without a restart in it.
struct VertexRun {
    uint32_t first = 0;           // vertex or index number, counted from the draw's first
    uint32_t firstPrimitive = 0;  // of the draw (one instance)
    uint32_t primitives = 0;
    uint32_t vertices = 0;  // those of an incomplete last primitive too
};

/// The runs of a draw that have primitives: one, or as many as primitive restart makes of it.
std::vector<VertexRun> vertexRuns(const DrawCall& call, VkPrimitiveTopology topology, bool restart);

/// Index number `n` of the draw; 0 outside the buffer (robustBufferAccess).
uint32_t fetchIndex(const DrawCall& call, uint32_t n);

}  // namespace vernier
