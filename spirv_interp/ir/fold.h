// Evaluation of operations on constants, bit for bit what the batch interpreter computes on every target.
#pragma once

#include <optional>
#include <span>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// The bits of the result of `op` (result type, imm as in Inst) on constant operands, or nothing where the result
/// depends on the accuracy tier, on NaN bits, or on more than the operands. b1 is 0 or kTrueBits. Operand types follow
/// ops.def.
std::optional<uint64_t> foldConstant(Op op, Type type, uint64_t imm, std::span<const uint64_t> operands);

}  // namespace vernier::ir
