// Random structured programs: nested conditionals, loops with several ways out and round, switches, discards,
// early returns, with every variable passing through phis.
#pragma once

#include <cstdint>

#include "spirv_interp/ir/ir.h"

namespace vernier::test {

/// Inputs: 3 of i32. Outputs: 6 of i32. Resource 0 is a read-only uniform buffer of kUniformWords words.
inline constexpr uint32_t kUniformWords = 8;
ir::Program randomProgram(uint64_t seed);

}  // namespace vernier::test
