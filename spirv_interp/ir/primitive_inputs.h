// Fragment inputs that are of a primitive rather than of one of its vertices (SPV_KHR_fragment_shader_barycentric), and
// how programs spell them: as inputs like others, so that everything that carries inputs carries these.
//   BaryCoordKHR, BaryCoordNoPerspKHR   built-ins, interpolated as user inputs are
//   PerVertexKHR                        flat, with a number after the location: that of the vertex, and one
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

constexpr bool isBaryCoord(Builtin builtin) {
    return builtin == Builtin::baryCoord || builtin == Builtin::baryCoordNoPersp;
}

constexpr bool isPerVertex(const InterfaceSlot& input) {
    return input.builtin == Builtin::user && input.index != 0;
}

/// Of an input that isPerVertex().
constexpr uint32_t vertexNumber(const InterfaceSlot& input) {
    return input.index - 1u;
}

}  // namespace vernier::ir
