// Fragment inputs that are of a primitive rather than of one of its vertices (SPV_KHR_fragment_shader_barycentric), and
// how programs spell them: as inputs like others, so that everything that carries inputs carries these.
//   BaryCoordKHR, BaryCoordNoPerspKHR   components of a location that no shader can have, interpolated as others are
//   PerVertexKHR                        flat, with a number after the location: that of the vertex, and one
#pragma once

#include "spirv_interp/ir/ir.h"
#include "spirv_interp/ir/split_samples.h"

namespace vernier::ir {

inline constexpr uint16_t kBaryCoordLocation = 0xFF7E, kBaryCoordNoPerspLocation = 0xFF7F;
static_assert(kBaryCoordNoPerspLocation < kFirstCarried);

constexpr bool isBaryCoord(const InterfaceSlot& slot) {
    return slot.builtin == Builtin::user &&
           (slot.location == kBaryCoordLocation || slot.location == kBaryCoordNoPerspLocation);
}

constexpr bool isPerVertex(const InterfaceSlot& input) {
    return input.builtin == Builtin::user && input.index != 0;
}

/// Of an input that isPerVertex().
constexpr uint32_t vertexNumber(const InterfaceSlot& input) {
    return input.index - 1u;
}

}  // namespace vernier::ir
