// The passes over programs. Each takes any program that verifies, loop-closed or not; all but closeLoops may leave it
// out of loop-closed form. They return whether they changed something.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Phis whose operands are all one value (or undefined) become that value.
bool simplifyPhis(Program& program);

/// Operations on constants are evaluated; identities that hold for every bit pattern are applied (IEEE 754: x * 1, x -
/// 0,
/// -(-x), division by a power of two, ...); copies disappear.
bool foldConstants(Program& program);

/// Equal pure operations and loads of memory nobody writes are done once, where one dominates the other.
bool eliminateCommon(Program& program);

/// Branches on constants become jumps; unreachable blocks disappear; blocks that only jump are skipped; chains of
/// blocks become one.
bool foldBranches(Program& program);

/// Small diamonds and triangles without side effects become selects: the batch interpreter runs both sides anyway when
/// the lanes disagree. Branches on draw-rate conditions, which it takes as a whole, stay unless they are tiny.
bool convertIfs(Program& program);

/// Loops that are known to run a small number of times become that many copies of their blocks: what is computed from
/// the counter becomes constant, and no lane masks are kept. Small ones that run often do the work of four rounds in
/// one. Only innermost loops that their header alone leaves.
bool unrollLoops(Program& program);

/// Loops that unrollLoops finds too large, if much of them becomes constant: to be called when everything else is done.
bool unrollConstantLoops(Program& program);

/// Operations on constants become cheaper ones that give the same bits: of fields of words that are converted and
/// scaled, the shift goes into the scale; remainders of divisions by powers of two do without the division.
bool reduceStrength(Program& program);

/// Operations that give the same in every round of a loop, and that every round runs, are done before the loop.
bool hoistInvariants(Program& program);

/// Operations whose results nobody uses are removed, and stores of undefined values to outputs.
bool removeDead(Program& program);

/// fmul + fadd, the product used once and neither marked noContraction, become ffma.
bool contract(Program& program);

/// Inserts the phis that loop-closed form asks for.
bool closeLoops(Program& program);

}  // namespace vernier::ir
