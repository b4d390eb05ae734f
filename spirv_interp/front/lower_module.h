// The lowering alone, without validation and passes: for measuring and testing the steps of loadShader.
#pragma once

#include "spirv_interp/capture.h"
#include "spirv_interp/program.h"

namespace vernier {

/// `source.words` must be a valid module. The result is not optimised: it may hold unreachable blocks and dead code,
/// and is not in loop-closed form; ir::optimise puts that right.
Result<ir::Program> lowerModule(const ShaderSource& source);
/// And what transform feedback keeps.
Result<ir::Program> lowerModule(const ShaderSource& source, CaptureLayout& capture);

/// The same of any words, valid or not: what the lowering relies on is checked, and an Error tells what does not hold.
/// The result has no unreachable blocks, is well-formed but for its loops (ir::LoopForm::open), and so is what
/// ir::optimise makes of it, loops included. It need not mean what the specification says of the module.
Result<ir::Program> lowerAnyModule(const ShaderSource& source);

}  // namespace vernier
