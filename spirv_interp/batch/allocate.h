// Register allocation: rows for virtual registers, by linear scan over live intervals that cover whole loops
// where a value must survive them.
#pragma once

#include <vector>

#include "spirv_interp/batch/machine.h"

namespace vernier::batch {

struct Allocation {
    std::vector<uint32_t> row;  // by virtual register: index of its (first) row; kNone if it is never alive
    uint32_t rows = 0;
};

/// Joins registers at both ends of moves where that makes the move needless (marking it dead), lets operations hand
/// their results on in the accumulator where `handlers` allow it, and gives every register that is left its rows.
Allocation allocate(MachineCode& code, const HandlerTable& handlers);

}  // namespace vernier::batch
