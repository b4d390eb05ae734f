// Which operation of the interpreter does the work of an IR instruction, and what is known about operations.
#pragma once

#include <optional>
#include <string_view>

#include "spirv_interp/batch/bytecode.h"
#include "spirv_interp/batch/machine.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

std::string_view opName(Op op);
/// Operands, the destination included.
size_t operandCount(Op op);
/// Takes scalars as operands.
bool isVectorOp(Op op);
/// Has a form that computes a scalar from scalars.
bool takesScalars(Op op);
/// Has 64-bit operands or a 64-bit result.
bool isWideOp(Op op);

/// An elementwise operation or a load: it may change places with others of its kind, as far as its operands allow.
bool isMovableOp(Op op);

/// What a strip operation reads that may come from the accumulator: `sources` operands from `first` on. A result is
/// left in the accumulator; without one the accumulator stays as it is.
struct StripShape {
    uint8_t first = 1, sources = 0;
    bool result = true;
};
/// Nothing for operations that leave arbitrary bits in the accumulator.
std::optional<StripShape> stripShape(const MachineInst& inst);

/// The elementwise operation for an instruction; nothing for instructions that are lowered in another way.
std::optional<Op> elementOp(const ir::Program& program, const ir::Inst& inst);

}  // namespace vernier::batch
