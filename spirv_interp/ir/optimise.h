// The passes in the order that loading and linking want.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

struct OptimiseOptions {
    bool contract = false;
};

/// Accepts unreachable blocks and programs out of loop-closed form; afterwards the program verifies if it was sound,
/// its values are numbered without holes, and its facts are right (analyse.h).
void optimise(Program& program, const OptimiseOptions& options = {});

}  // namespace vernier::ir
