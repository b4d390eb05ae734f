// The vertices that a primitive or patch has, where a program is made for more.
#pragma once

#include <cstdint>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Inputs of vertices (InterfaceSlot::index) with a number of `vertices` or more become 0, and arrays over vertices
/// that are indexed at run time end there: what lies behind is undefined. The program comes as optimise() leaves it,
/// goes so, and verifies.
void limitVertices(Program& program, uint32_t vertices);

}  // namespace vernier::ir
