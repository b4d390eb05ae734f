// Superinstructions: several IR instructions in one dispatch, with the bits they would give one by one. Found
// for additions and subtractions whose operands are products, and for masks and exclusive ors of shifts, used nowhere
// else.
#pragma once

#include <optional>
#include <vector>

#include "spirv_interp/batch/bytecode.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

struct Fusion {
    Op op = Op::multiplyAdd;
    std::vector<ir::ValueId> operands;  // without the destination
};

/// By value: it exists only inside the superinstruction of its one user. `definition` and `uses` are by
/// value.
std::vector<bool> fusedValues(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
                              const std::vector<uint32_t>& uses, const std::vector<bool>& scalar);

/// The superinstruction that ends in `inst`, made of values that are `fused` (empty: none are).
std::optional<Fusion> findFusion(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
                                 const std::vector<bool>& fused, const std::vector<bool>& scalar, const ir::Inst& inst);

}  // namespace vernier::batch
