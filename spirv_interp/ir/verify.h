// The judge of well-formed programs: every invariant that ir.h states.
#pragma once

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Whether values leave loops through phis only. They may leave freely in what comes from the lowering, before the
/// passes.
enum class LoopForm : uint8_t { closed, open };

/// An invalidArgument Error naming the block, the instruction and the broken rule, or success. Safe on any Program.
Status verify(const Program& program, LoopForm form = LoopForm::closed);

}  // namespace vernier::ir
