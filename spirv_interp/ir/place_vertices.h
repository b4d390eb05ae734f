// Where a geometry program puts its vertices: memory of the runner, which reads them when the program has run.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Lanes that share the memory: as many run at a time at most.
inline constexpr uint32_t kVertexLanes = 64;

/// Bits of Builtin::vertexFlags: the vertex is the first of its strip; and from kStreamBit on, its vertex stream.
inline constexpr uint32_t kStartsStrip = 1;
inline constexpr uint32_t kStreamBit = 1;

/// The outputs that every vertex has a word of: all but the last, which is Builtin::vertexCount.
inline uint32_t wordsOfVertex(const Program& program) {
    return static_cast<uint32_t>(program.outputs.size()) - 1;
}

/// The place of an output of an invocation's vertex in the memory, in words, less the number of the lane.
inline size_t placeOfVertex(const Program& program, uint32_t vertex, uint32_t output) {
    return (size_t{vertex} * wordsOfVertex(program) + output) * kVertexLanes;
}

/// Makes every storeVertex a store to a resource of the kind stageMemory, which is added: word `lane` of
/// placeOfVertex(); a vertex beyond outputVertices lies outside. The program gets the input Builtin::stageOffset, four
/// times the number of the lane. Comes as optimise() leaves it after linking, goes so, and verifies.
void placeVertices(Program& program);

}  // namespace vernier::ir
