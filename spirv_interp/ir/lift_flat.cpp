#include "spirv_interp/ir/lift_flat.h"

#include <algorithm>
#include <unordered_map>

#include "spirv_interp/ir/cost.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

// Scalars between the stages, new ones included: half of what Vulkan's maxVertexOutputComponents may be.
constexpr size_t kMostOutputs = 64;
constexpr uint16_t kLastLocation = 0xFF00;  // room for the locations of new ones behind it

class FlatLifter {
  public:
    FlatLifter(Program& vertex, Program& fragment)
        : vertex_(vertex),
          fragment_(fragment),
          kinds_(fragment.valueTypes.size(), Kind::other),
          definition_(fragment.valueTypes.size(), nullptr) {}

    uint32_t run() {
        if (!findStores()) return 0;
        classify();
        findRoots();
        uint32_t operations = 0;
        if (roots_.empty() || !pays(operations)) return 0;
        cloneIntoVertex();
        readInFragment();
        return operations;
    }

  private:
    /// `fixed` is made of constants; `flat` of flat inputs too.
    enum class Kind : uint8_t { other, fixed, flat };

    const InterfaceSlot* outputOf(const InterfaceSlot& input, size_t& index) const {
        for (index = 0; index < vertex_.outputs.size(); ++index) {
            const InterfaceSlot& output = vertex_.outputs[index];
            if (output.builtin == input.builtin && output.location == input.location &&
                output.component == input.component) {
                return &output;
            }
        }
        return nullptr;
    }

    bool isLiftableInput(const InterfaceSlot& slot) const {
        if (slot.builtin != Builtin::user || slot.interpolation != Interpolation::flat) return false;
        size_t index = 0;
        return outputOf(slot, index) != nullptr && stored_[index] != kNoValue;
    }

    /// The value each output of the vertex program has at its end; kNoValue for an output stored in another block than
    /// the last, or several times. False when the program has several ends.
    bool findStores() {
        stored_.assign(vertex_.outputs.size(), kNoValue);
        std::vector<uint32_t> stores(vertex_.outputs.size());
        size_t ends = 0;
        for (BlockId b = 0; b < vertex_.blocks.size(); ++b) {
            if (vertex_.blocks[b].insts.back().op != Op::ret) continue;
            end_ = b;
            ++ends;
        }
        if (ends != 1) return false;
        for (BlockId b = 0; b < vertex_.blocks.size(); ++b) {
            for (const Inst& inst : vertex_.blocks[b].insts) {
                if (inst.op != Op::storeOutput) continue;
                const bool only = ++stores[inst.imm] == 1 && b == end_;
                stored_[inst.imm] = only ? vertex_.operandsOf(inst)[0] : kNoValue;
            }
        }
        return true;
    }

    void classify() {
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result == kNoValue) continue;
                definition_[inst.result] = &inst;
                kinds_[inst.result] = kindOf(inst);
            }
        }
    }

    Kind kindOf(const Inst& inst) const {
        if (inst.op == Op::input) return isLiftableInput(fragment_.inputs[inst.imm]) ? Kind::flat : Kind::other;
        if (inst.op == Op::constant || inst.op == Op::undef) return Kind::fixed;
        const bool own = inst.op == Op::phi || inst.op == Op::inputIndexed || inst.op == Op::subgroupInvocation ||
                         immKind(inst.op) == ImmKind::input;
        if (opInfo(inst.op).kind != 'P' || own || isWide(inst.type)) return Kind::other;
        Kind kind = Kind::fixed;
        for (const ValueId operand : fragment_.operandsOf(inst)) {
            if (kinds_[operand] == Kind::other) return Kind::other;
            kind = std::max(kind, kinds_[operand]);
        }
        return kind;
    }

    bool isLifted(ValueId value) const { return kinds_[value] == Kind::flat && definition_[value]->op != Op::input; }

    /// Lifted values that something else uses.
    void findRoots() {
        std::vector<bool> seen(fragment_.valueTypes.size());
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                if (inst.result != kNoValue && isLifted(inst.result)) continue;
                for (const ValueId operand : fragment_.operandsOf(inst)) {
                    if (!isLifted(operand) || seen[operand]) continue;
                    seen[operand] = true;
                    roots_.push_back(operand);
                }
            }
        }
    }

    bool pays(uint32_t& operations) const {
        uint32_t saved = 0;
        std::vector<bool> readBefore(fragment_.inputs.size()), readAfter(fragment_.inputs.size());
        for (const Block& block : fragment_.blocks) {
            for (const Inst& inst : block.insts) {
                const bool lifted = inst.result != kNoValue && isLifted(inst.result);
                if (lifted) {
                    saved += costOf(fragment_, inst);
                    ++operations;
                }
                for (const ValueId operand : fragment_.operandsOf(inst)) {
                    const Inst* from = definition_[operand];
                    if (from == nullptr || from->op != Op::input) continue;
                    readBefore[from->imm] = true;
                    if (!lifted) readAfter[from->imm] = true;
                }
            }
        }
        const auto gone = static_cast<uint32_t>(std::count(readBefore.begin(), readBefore.end(), true) -
                                                std::count(readAfter.begin(), readAfter.end(), true));
        const auto isFar = [](const InterfaceSlot& output) { return output.location > kLastLocation; };
        if (vertex_.outputs.size() + roots_.size() > kMostOutputs) return false;
        if (std::any_of(vertex_.outputs.begin(), vertex_.outputs.end(), isFar)) return false;
        return saved + gone >= kLeastGain + roots_.size();
    }

    void insert(Inst inst, std::span<const ValueId> operands) {
        inst.firstOperand = static_cast<uint32_t>(vertex_.operands.size());
        inst.operandCount = static_cast<uint16_t>(operands.size());
        vertex_.operands.insert(vertex_.operands.end(), operands.begin(), operands.end());
        auto& insts = vertex_.blocks[end_].insts;
        insts.insert(insts.end() - 1, inst);
    }

    /// A value of the fragment program, made anew at the end of the vertex program.
    ValueId cloned(ValueId value) {
        // Operands come first: in the order of a walk that visits them before their user.
        std::vector<ValueId> open{value};
        while (!open.empty()) {
            const ValueId at = open.back();
            const Inst& inst = *definition_[at];
            if (clones_.contains(at)) {
                open.pop_back();
                continue;
            }
            if (inst.op == Op::input) {
                size_t index = 0;
                outputOf(fragment_.inputs[inst.imm], index);
                clones_[at] = stored_[index];
                continue;
            }
            const size_t before = open.size();
            std::vector<ValueId> operands;
            for (const ValueId operand : fragment_.operandsOf(inst)) {
                const auto found = clones_.find(operand);
                if (found == clones_.end()) {
                    open.push_back(operand);
                } else {
                    operands.push_back(found->second);
                }
            }
            if (open.size() != before) continue;
            Inst clone = inst;
            clone.result = vertex_.newValue(inst.type);
            clone.line = 0;
            insert(clone, operands);
            clones_[at] = clone.result;
        }
        return clones_[value];
    }

    void cloneIntoVertex() {
        uint16_t location = 0;
        for (const InterfaceSlot& output : vertex_.outputs) location = std::max(location, output.location);
        uint32_t component = 4;
        for (const ValueId root : roots_) {
            if (component == 4) {
                ++location;
                component = 0;
            }
            InterfaceSlot slot;
            slot.location = location;
            slot.component = static_cast<uint8_t>(component++);
            slot.type = fragment_.valueTypes[root];
            ValueId value = cloned(root);
            // Between the stages there are numbers only.
            if (slot.type == Type::b1) {
                slot.type = Type::i32;
                Inst widen;
                widen.op = Op::zext;
                widen.type = Type::i32;
                widen.imm = static_cast<uint64_t>(Type::b1);
                widen.result = vertex_.newValue(Type::i32);
                insert(widen, std::span(&value, 1));
                value = widen.result;
            }
            Inst store;
            store.op = Op::storeOutput;
            store.imm = vertex_.outputs.size();
            vertex_.outputs.push_back(slot);
            insert(store, std::span(&value, 1));
            slot.interpolation = Interpolation::flat;
            fragment_.inputs.push_back(slot);
        }
    }

    void readInFragment() {
        const size_t first = fragment_.inputs.size() - roots_.size();
        std::unordered_map<ValueId, size_t> slotOf;
        for (size_t k = 0; k < roots_.size(); ++k) slotOf[roots_[k]] = first + k;
        for (Block& block : fragment_.blocks) {
            for (size_t i = 0; i < block.insts.size(); ++i) {
                const auto found = slotOf.find(block.insts[i].result);
                if (found == slotOf.end()) continue;
                Inst read;
                read.op = Op::input;
                read.type = fragment_.inputs[found->second].type;
                read.imm = found->second;
                if (block.insts[i].type != Type::b1) {
                    read.result = block.insts[i].result;
                    block.insts[i] = read;
                    continue;
                }
                Inst& test = block.insts[i];
                const ValueId result = test.result;
                Inst zero;
                zero.op = Op::constant;
                zero.type = Type::i32;
                zero.result = fragment_.newValue(Type::i32);
                read.result = fragment_.newValue(Type::i32);
                test = {};
                test.op = Op::ine;
                test.type = Type::b1;
                test.imm = static_cast<uint64_t>(Type::i32);
                test.result = result;
                test.firstOperand = static_cast<uint32_t>(fragment_.operands.size());
                test.operandCount = 2;
                fragment_.operands.insert(fragment_.operands.end(), {read.result, zero.result});
                block.insts.insert(block.insts.begin() + static_cast<ptrdiff_t>(i), {read, zero});
                i += 2;
            }
        }
    }

    Program& vertex_;
    Program& fragment_;
    BlockId end_ = 0;              // of the vertex program
    std::vector<ValueId> stored_;  // by output of the vertex program
    std::vector<Kind> kinds_;      // by value of the fragment program
    std::vector<const Inst*> definition_;
    std::vector<ValueId> roots_;
    std::unordered_map<ValueId, ValueId> clones_;  // from values of the fragment to those of the vertex program
};

}  // namespace

uint32_t liftFlat(Program& vertex, Program& fragment) {
    return FlatLifter(vertex, fragment).run();
}

}  // namespace vernier::ir
