// Values that are the same for all lanes that run, though they change inside a draw: loop counters and what is computed
// from them. They live in the scalar file and are computed once per batch.
#pragma once

#include <vector>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

/// Whether the interpreter computes an instruction from scalars, if all its operands are.
bool takesScalars(const ir::Program& program, const ir::Inst& inst);

/// By value: whether all lanes that run its definition get the same value there, and the interpreter computes it from
/// scalars. `scalar`: the values known before the first batch.
std::vector<bool> uniformValues(const ir::Program& program, const ir::Cfg& cfg, const std::vector<bool>& scalar);

}  // namespace vernier::batch
