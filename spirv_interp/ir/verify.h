// The judge of well-formed programs: every invariant that ir.h states.
#pragma once

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// An invalidArgument Error naming the block, the instruction and the broken rule, or success. Safe on any Program.
Status verify(const Program& program);

}  // namespace vernier::ir
