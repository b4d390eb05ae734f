#include "spirv_interp/batch/accumulate.h"

#include <algorithm>
#include <optional>

#include "spirv_interp/batch/select.h"

namespace vernier::batch {
namespace {

using Kind = Operand::Kind;

class Marker {
  public:
    Marker(MachineCode& code, const HandlerTable& handlers, const std::function<uint32_t(uint32_t)>& sameRow)
        : code_(code), handlers_(handlers), sameRow_(sameRow), facts_(code.registers.size()) {}

    void run() {
        countReads();
        std::vector<bool> isTarget(code_.insts.size() + 1);
        for (const uint32_t label : code_.labels) isTarget[label] = true;
        for (uint32_t k = 0; k < code_.insts.size(); ++k) {
            if (isTarget[k]) held_.reset();
            MachineInst& inst = code_.insts[k];
            if (inst.dead) continue;
            const std::optional<StripShape> shape = stripShape(inst);
            if (held_ && shape) readHeld(inst, *shape);
            if (!shape) {
                held_.reset();
            } else if (shape->result) {
                held_ = k;
            } else if (held_ && writes(inst, code_.insts[*held_].operands[0])) {
                held_.reset();
            }
        }
        for (MachineInst& inst : code_.insts) dropStore(inst);
    }

  private:
    struct RegisterFacts {
        uint32_t reads = 0, writes = 0, marked = 0;
        bool shared = false;  // with another register, or the outside
    };

    /// The number of rows that hold a value tells 64-bit values apart: their words are never looked at here.
    bool same(const Operand& a, const Operand& b) const { return sameRow_(a.id) == sameRow_(b.id) && a.word == b.word; }

    void countReads() {
        for (const MachineInst& inst : code_.insts) {
            if (inst.dead) continue;
            const auto visit = [&](const Operand& operand) {
                if (!operand.isRow()) return;
                RegisterFacts& facts = facts_[operand.id];
                ++(operand.written ? facts.writes : facts.reads);
            };
            std::for_each(inst.operands.begin(), inst.operands.end(), visit);
            std::for_each(inst.hidden.begin(), inst.hidden.end(), visit);
        }
        std::vector<uint32_t> members(facts_.size());
        for (uint32_t reg = 0; reg < facts_.size(); ++reg) ++members[sameRow_(reg)];
        for (uint32_t reg = 0; reg < facts_.size(); ++reg) {
            facts_[reg].shared = members[sameRow_(reg)] > 1 || code_.registers[reg].wide;
        }
        for (const std::vector<uint32_t>* outside : {&code_.inputs, &code_.outputs}) {
            for (const uint32_t reg : *outside) {
                if (reg != kNone) facts_[reg].shared = true;
            }
        }
    }

    bool writes(const MachineInst& inst, const Operand& what) const {
        return std::any_of(inst.operands.begin(), inst.operands.end(), [&](const Operand& operand) {
            return operand.isRow() && operand.written && same(operand, what);
        });
    }

    bool exists(const MachineInst& inst) const {
        return handlers_[static_cast<size_t>(inst.op)][formOf(inst).index()] != nullptr;
    }

    void readHeld(MachineInst& inst, const StripShape& shape) {
        const Operand held = code_.insts[*held_].operands[0];
        for (size_t k = shape.first; k < size_t{shape.first} + shape.sources; ++k) {
            if (!inst.operands[k].isRow() || !same(inst.operands[k], held)) continue;
            const MachineInst before = inst;
            inst.operands[k].kind = Kind::accumulator;
            const bool swaps = isVectorOp(inst.op) && formSet(inst.op) == FormSet::commutative && k == 2;
            if (!exists(inst) && swaps) std::swap(inst.operands[1], inst.operands[2]);
            if (exists(inst)) {
                ++facts_[held.id].marked;
            } else {
                inst = before;
            }
        }
    }

    void dropStore(MachineInst& inst) {
        const std::optional<StripShape> shape = stripShape(inst);
        if (inst.dead || !shape || !shape->result) return;
        const RegisterFacts& facts = facts_[inst.operands[0].id];
        if (facts.shared || facts.writes != 1 || facts.marked != facts.reads) return;
        inst.operands[0].kind = Kind::accumulator;
        if (!exists(inst)) inst.operands[0].kind = Kind::row;
    }

    MachineCode& code_;
    const HandlerTable& handlers_;
    const std::function<uint32_t(uint32_t)>& sameRow_;
    std::vector<RegisterFacts> facts_;
    std::optional<uint32_t> held_;  // the instruction whose result the accumulator holds
};

}  // namespace

Form formOf(const MachineInst& inst) {
    Form form;
    const std::optional<StripShape> shape = stripShape(inst);
    if (!shape) return form;
    form.stored = !shape->result || inst.operands[0].kind != Kind::accumulator;
    for (size_t k = 0; k < shape->sources; ++k) {
        const Kind kind = inst.operands[shape->first + k].kind;
        form.sources[k] = kind == Kind::scalar        ? Source::scalar
                          : kind == Kind::accumulator ? Source::accumulator
                                                      : Source::row;
    }
    return form;
}

void useAccumulator(MachineCode& code, const HandlerTable& handlers, const std::function<uint32_t(uint32_t)>& sameRow) {
    Marker(code, handlers, sameRow).run();
}

}  // namespace vernier::batch
