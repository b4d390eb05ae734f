// The lowering alone, without validation and passes: for measuring and testing the steps of loadShader.
#pragma once

#include "spirv_interp/program.h"

namespace vernier {

/// `source.words` must be a valid module. The result is not optimised: it may hold unreachable blocks and dead code,
/// and is not in loop-closed form; ir::optimise puts that right.
Result<ir::Program> lowerModule(const ShaderSource& source);

}  // namespace vernier
