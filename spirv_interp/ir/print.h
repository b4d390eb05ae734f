// The text form of programs. parse.h reads it back: print(parse(print(p))) is print(p).
//
//   program fragment "main"
//   input 0 f32 user 0.1 smooth center          location.component (.index when it is not 0), of the builtin otherwise
//   output 0 f32 user 0.0
//   resource 0 uniformBuffer 0.3 x1 read        set.binding, descriptors, then bytes N and read where they apply
//   imageOp 0 sampleImplicit d2 image 1 sampler 1 coords 2
//   local 12
//   b0:
//     %0 f32 = constant 0x3f800000              the bits
//     %2 b1 = folt.f32 %1 %0                    the type of the operands where the result's does not tell
//     %3 f32 = fadd %1 %0 !noContraction @12    flags, source line
//     branch %2 b1 b2
//   b1 loop b3 <- b0 b2:                        a loop header with the end of its loop; predecessors in phi order
//     %4 i32 = phi %5 %6
//     switchOn %4 b4 [-1: b2] [7: b3]
//
// `;` begins a comment.
#pragma once

#include <string>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Safe on programs that do not verify.
std::string print(const Program& program);

/// One instruction of `block`, without indentation or line end.
std::string printInst(const Program& program, const Block& block, const Inst& inst);

}  // namespace vernier::ir
