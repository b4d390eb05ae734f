// What programs share, made ahead of the first of them.
#pragma once

#include "base/simd.h"
#include "spirv_interp/program.h"

namespace vernier {

/// Makes the tables that all programs for an instruction set and a tier share; otherwise the first
/// BatchProgram::compile makes them. Thread-safe. Defined in batch/.
void prepareBatches(Isa isa, MathTier tier);

}  // namespace vernier
