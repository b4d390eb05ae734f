#include "spirv_interp/batch/join_stores.h"

#include <algorithm>
#include <optional>

#include "spirv_interp/ir/ops.h"

namespace vernier::batch {
namespace {

constexpr uint32_t kWordBytes = 4;

struct Offset {
    ir::ValueId base = ir::kNoValue;
    uint32_t displacement = 0;  // modulo 2^32
};

/// Finds groups in one block after the other.
class Finder {
  public:
    Finder(const ir::Program& program, const std::vector<const ir::Inst*>& definition, const std::vector<bool>& scalar)
        : program_(program), definition_(definition), scalar_(scalar) {}

    std::vector<JoinedStores::Group> run() {
        for (const ir::Block& block : program_.blocks) {
            for (const ir::Inst& inst : block.insts) {
                if (inst.op == ir::Op::storeBuffer) {
                    if (!joins(inst)) close();
                    if (isCandidate(inst)) open_.push_back(&inst);
                } else if (ir::opInfo(inst.op).kind != 'P') {
                    close();
                }
            }
            close();
        }
        return std::move(groups_);
    }

  private:
    ir::ValueId operand(const ir::Inst& inst, size_t k) const { return program_.operandsOf(inst)[k]; }

    /// A word, of one buffer for all lanes, at an offset of each lane's own.
    bool isCandidate(const ir::Inst& store) const {
        return ir::immHigh(store) == 0 && scalar_[operand(store, 0)] && !scalar_[operand(store, 1)];
    }

    Offset offsetOf(const ir::Inst& store) const {
        const ir::ValueId value = operand(store, 1);
        const ir::Inst* sum = definition_[value];
        if (sum == nullptr || sum->op != ir::Op::iadd) return {value, 0};
        for (const size_t k : {0, 1}) {
            const ir::Inst* constant = definition_[operand(*sum, k)];
            if (constant == nullptr || constant->op != ir::Op::constant) continue;
            return {operand(*sum, 1 - k), static_cast<uint32_t>(constant->imm)};
        }
        return {value, 0};
    }

    bool joins(const ir::Inst& store) const {
        if (open_.empty() || open_.size() == JoinedStores::kMost || !isCandidate(store)) return false;
        const ir::Inst& first = *open_[0];
        if (operand(first, 0) != operand(store, 0) || first.imm != store.imm) return false;
        const Offset at = offsetOf(store);
        return std::all_of(open_.begin(), open_.end(), [&](const ir::Inst* other) {
            const Offset there = offsetOf(*other);
            const uint32_t distance =
                std::min(at.displacement - there.displacement, there.displacement - at.displacement);
            return there.base == at.base && distance != 0 && distance % kWordBytes == 0 &&
                   distance < JoinedStores::kMost * kWordBytes;
        });
    }

    /// Makes a group of what is open, if it leaves no word out.
    void close() {
        if (open_.size() > 1) {
            const ir::Inst* last = open_.back();
            std::stable_sort(open_.begin(), open_.end(), [&](const ir::Inst* a, const ir::Inst* b) {
                return static_cast<int32_t>(offsetOf(*a).displacement - offsetOf(*b).displacement) < 0;
            });
            const uint32_t span = offsetOf(*open_.back()).displacement - offsetOf(*open_[0]).displacement;
            if (span == (open_.size() - 1) * kWordBytes) groups_.push_back({open_, last});
        }
        open_.clear();
    }

    const ir::Program& program_;
    const std::vector<const ir::Inst*>& definition_;
    const std::vector<bool>& scalar_;
    std::vector<const ir::Inst*> open_;
    std::vector<JoinedStores::Group> groups_;
};

}  // namespace

JoinedStores::JoinedStores(const ir::Program& program, const std::vector<const ir::Inst*>& definition,
                           const std::vector<uint32_t>& uses, const std::vector<bool>& scalar)
    : groups_(Finder(program, definition, scalar).run()), inner_(program.valueTypes.size()) {
    for (const Group& group : groups_) {
        for (size_t k = 1; k < group.stores.size(); ++k) {
            const ir::ValueId offset = program.operandsOf(*group.stores[k])[1];
            inner_[offset] =
                uses[offset] == 1 && definition[offset] != nullptr && definition[offset]->op == ir::Op::iadd;
        }
    }
}

const JoinedStores::Group* JoinedStores::of(const ir::Inst& store) const {
    for (const Group& group : groups_) {
        if (std::find(group.stores.begin(), group.stores.end(), &store) != group.stores.end()) return &group;
    }
    return nullptr;
}

}  // namespace vernier::batch
