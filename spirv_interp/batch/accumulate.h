// The accumulator: which operands of strip operations are read from it, and which results need no row.
#pragma once

#include <cstdint>
#include <functional>

#include "spirv_interp/batch/machine.h"

namespace vernier::batch {

/// The form of a strip operation as its operands stand.
Form formOf(const MachineInst& inst);

/// Turns reads of the value that the accumulator holds into reads of the accumulator, and results that are read
/// nowhere else into results without a row, wherever `handlers` has the form. `sameRow` gives registers that share
/// rows one name.
void useAccumulator(MachineCode& code, const HandlerTable& handlers, const std::function<uint32_t(uint32_t)>& sameRow);

}  // namespace vernier::batch
