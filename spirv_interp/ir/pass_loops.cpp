#include <algorithm>
#include <unordered_map>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

/// One value defined in a loop and used outside, at a time: a phi where edges leave the loop, and more phis on the way
/// from there to the uses where ways meet.
class Closer {
  public:
    Closer(Program& program, const Cfg& cfg) : program_(program), cfg_(cfg), added_(program.blocks.size()) {}

    /// The value that stands for `value`, defined in a loop around `home`, at the end of block `at`.
    ValueId at(ValueId value, BlockId home, BlockId block) {
        if (value != value_) {
            value_ = value;
            known_.clear();
        }
        return find(home, block);
    }

    void finish() {
        for (BlockId b = 0; b < added_.size(); ++b) {
            auto& insts = program_.blocks[b].insts;
            insts.insert(insts.begin(), added_[b].begin(), added_[b].end());
        }
    }

  private:
    Program& program_;
    const Cfg& cfg_;
    std::vector<std::vector<Inst>> added_;
    ValueId value_ = kNoValue;
    std::unordered_map<BlockId, ValueId> known_;

    bool inside(BlockId home, BlockId block) const { return cfg_.loopsContain(program_, home, block); }

    ValueId find(BlockId home, BlockId start) {
        // New phis are filled in one after the other; each fills the blocks above it by looking up or adding phis.
        std::vector<BlockId> work;
        const auto lookUp = [&](BlockId from) {
            BlockId b = from;
            while (true) {
                if (inside(home, b)) return value_;
                if (const auto found = known_.find(b); found != known_.end()) return found->second;
                const auto& predecessors = program_.blocks[b].predecessors;
                if (predecessors.size() == 1 && !inside(home, predecessors[0])) {
                    b = predecessors[0];
                    continue;
                }
                Inst phi;
                phi.op = Op::phi;
                phi.type = program_.valueTypes[value_];
                phi.result = program_.newValue(phi.type);
                phi.firstOperand = static_cast<uint32_t>(program_.operands.size());
                phi.operandCount = static_cast<uint16_t>(predecessors.size());
                program_.operands.resize(program_.operands.size() + predecessors.size(), kNoValue);
                added_[b].push_back(phi);
                known_[b] = phi.result;
                work.push_back(b);
                return phi.result;
            }
        };
        const ValueId result = lookUp(start);
        while (!work.empty()) {
            const BlockId b = work.back();
            work.pop_back();
            const Inst phi = *std::find_if(added_[b].rbegin(), added_[b].rend(),
                                           [&](const Inst& inst) { return inst.result == known_[b]; });
            for (uint32_t i = 0; i < phi.operandCount; ++i) {
                program_.operands[phi.firstOperand + i] = lookUp(program_.blocks[b].predecessors[i]);
            }
        }
        return result;
    }
};

}  // namespace

bool closeLoops(Program& program) {
    bool any = false;
    // A phi put into a loop further out needs one itself outside that loop: one run per level of nesting.
    for (bool changed = true; changed;) {
        changed = false;
        const Cfg cfg(program);
        const std::vector<BlockId> home = definingBlocks(program);
        struct Use {
            ValueId value;
            BlockId block;
            uint32_t operand;
        };
        std::vector<Use> uses;
        for (BlockId b = 0; b < program.blocks.size(); ++b) {
            for (const Inst& inst : program.blocks[b].insts) {
                for (uint32_t i = 0; i < inst.operandCount; ++i) {
                    const ValueId value = program.operands[inst.firstOperand + i];
                    const BlockId where = inst.op == Op::phi ? program.blocks[b].predecessors[i] : b;
                    if (!cfg.loopsContain(program, home[value], where)) {
                        uses.push_back({value, where, inst.firstOperand + i});
                    }
                }
            }
        }
        if (uses.empty()) break;
        std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.value < b.value; });
        Closer closer(program, cfg);
        for (const Use& use : uses) {
            const ValueId closed = closer.at(use.value, home[use.value], use.block);
            program.operands[use.operand] = closed;
        }
        closer.finish();
        changed = any = true;
    }
    return any;
}

}  // namespace vernier::ir
