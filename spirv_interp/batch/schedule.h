// The order of machine instructions inside straight-line code.
#pragma once

#include "spirv_interp/batch/machine.h"

namespace vernier::batch {

/// Reorders elementwise operations and loads between other instructions so that a value with one reader is computed
/// right before it, where the accumulator can hand it on, and few values are alive at a time. Registers must not be
/// allocated yet.
void schedule(MachineCode& code);

}  // namespace vernier::batch
