// Stores of words that lie one behind the other, as of the components of a vector: one operation does them, where the
// last of them stands.
#pragma once

#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::batch {

class JoinedStores {
  public:
    static constexpr size_t kMost = 4;
    struct Group {
        std::vector<const ir::Inst*> stores;  // two to kMost, by address
        const ir::Inst* last;                 // in the block
    };

    JoinedStores() = default;
    /// `definition` and `uses` are by value, `scalar` tells the values that are the same in all lanes: the descriptor
    /// of joined stores is one, their offsets are none. Between them stands nothing that has an effect or reads memory.
    JoinedStores(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
                 const std::vector<uint32_t>& uses, const std::vector<bool>& scalar);

    /// The group that a store is in, or nullptr.
    const Group* of(const ir::Inst& store) const;
    /// Whether a value is the offset of joined stores alone, which do not ask for it.
    bool isInner(ir::ValueId value) const { return value < inner_.size() && inner_[value]; }

  private:
    std::vector<Group> groups_;
    std::vector<bool> inner_;
};

}  // namespace vernier::batch
