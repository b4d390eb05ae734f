// The order of machine instructions inside straight-line code.
#pragma once

#include "spirv_interp/batch/machine.h"

namespace vernier::batch {

/// Reorders elementwise operations and loads between other instructions so that a value with one reader is computed
/// right before it, where the accumulator can hand it on, and few values are alive at a time. What a phi becomes in the
/// next round is computed after its last use in this one, so that both can have one place; scalars get it here.
/// Registers must not be allocated yet.
void schedule(MachineCode& code);

}  // namespace vernier::batch
