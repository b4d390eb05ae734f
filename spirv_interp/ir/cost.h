// What operations cost, to decide whether work is worth moving or doing twice.
#pragma once

#include <cstdint>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

inline constexpr uint32_t kTooDear = 1000;

/// In simple operations of the batch interpreter, about; kTooDear for what cannot be moved at all.
uint32_t costOf(const Program& program, const Inst& inst);

}  // namespace vernier::ir
