// Superinstructions: several IR instructions in one dispatch, with the bits they would give one by one. Which there are
// was chosen from what shaders execute: docs/superinstructions.md.
#pragma once

#include <vector>

#include "spirv_interp/batch/bytecode.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

struct Fusion {
    Op op = Op::multiplyAdd;
    std::vector<ir::ValueId> operands;  // without the destination
    size_t rows = 0;                    // so many operands behind the first are taken from rows, scalars too
};

/// The superinstructions of a program.
class Fusions {
  public:
    Fusions() = default;
    /// `definition` and `uses` are by value, `scalar` tells the values that are the same in all lanes. What becomes
    /// part of a superinstruction is in a row, has one use, and that in the same block.
    Fusions(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
            const std::vector<uint32_t>& uses, const std::vector<bool>& scalar);

    /// Whether a value exists only inside the superinstruction of its one user.
    bool isInner(ir::ValueId value) const { return value < inner_.size() && inner_[value]; }
    /// The superinstruction that gives a value, or nullptr.
    const Fusion* of(ir::ValueId value) const {
        return value < fusionOf_.size() && fusionOf_[value] != kNone ? &fusions_[fusionOf_[value]] : nullptr;
    }

  private:
    static constexpr uint32_t kNone = ~0u;
    std::vector<bool> inner_;
    std::vector<Fusion> fusions_;
    std::vector<uint32_t> fusionOf_;
};

}  // namespace vernier::batch
