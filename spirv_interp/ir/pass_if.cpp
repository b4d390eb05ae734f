#include <algorithm>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/cost.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"
#include "spirv_interp/ir/rates.h"

namespace vernier::ir {
namespace {

// In operations of the batch interpreter: about what setting up the lane masks of two blocks and testing them costs.
constexpr uint32_t kCostLimit = 8;
// Under a condition that is the same for all lanes only one side runs: selects must be next to free.
constexpr uint32_t kUniformCostLimit = 1;
/// A block that only computes values between `from` and one successor.
bool isArm(const Program& program, const Cfg& cfg, BlockId from, BlockId arm) {
    const Block& block = program.blocks[arm];
    return arm > from && block.predecessors.size() == 1 && block.insts.back().op == Op::jump && !block.loopHeader &&
           block.insts.front().op != Op::phi && cfg.loop[arm] == cfg.loop[from];
}

uint32_t armCost(const Program& program, BlockId arm) {
    uint32_t cost = 0;
    const auto& insts = program.blocks[arm].insts;
    for (size_t i = 0; i + 1 < insts.size() && cost < kTooDear; ++i) cost += costOf(program, insts[i]);
    return cost;
}

class IfConverter {
  public:
    explicit IfConverter(Program& program)
        : program_(program), cfg_(program), rates_(computeRates(program)), keep_(program.blocks.size(), true) {}

    bool run() {
        bool changed = false;
        // Inner ifs come later in the order: from the end, an outer one may follow in the same run.
        for (BlockId b = static_cast<BlockId>(program_.blocks.size()); b-- > 0;) changed |= convert(b);
        if (!changed) return false;
        removeBlocks(program_, keep_);
        return true;
    }

  private:
    Program& program_;
    const Cfg cfg_;
    const std::vector<Rate> rates_;
    std::vector<bool> keep_;

    bool convert(BlockId head) {
        if (program_.blocks[head].insts.back().op != Op::branch) return false;
        const BlockId yes = program_.blocks[head].successors[0], no = program_.blocks[head].successors[1];
        if (yes == no) return false;
        const bool yesArm = isArm(program_, cfg_, head, yes), noArm = isArm(program_, cfg_, head, no);
        const BlockId yesEnd = yesArm ? program_.blocks[yes].successors[0] : yes;
        const BlockId noEnd = noArm ? program_.blocks[no].successors[0] : no;
        BlockId merge = kNoIndex;
        bool useYes = yesArm, useNo = noArm;
        if (yesArm && noArm && yesEnd == noEnd) {
            merge = yesEnd;
        } else if (yesArm && yesEnd == no) {
            merge = no;
            useNo = false;
        } else if (noArm && noEnd == yes) {
            merge = yes;
            useYes = false;
        }
        if (merge == kNoIndex || merge == head) return false;
        const ValueId condition = program_.operands[program_.blocks[head].insts.back().firstOperand];
        const bool uniform = condition < rates_.size() && isUniform(rates_[condition]);
        const uint32_t cost = (useYes ? armCost(program_, yes) : 0) + (useNo ? armCost(program_, no) : 0);
        if (cost > (uniform ? kUniformCostLimit : kCostLimit)) return false;
        apply(head, useYes ? yes : head, useNo ? no : head, merge, condition);
        return true;
    }

    /// `yes` and `no` are the predecessors of `merge` on either side: an arm, or the head itself.
    void apply(BlockId head, BlockId yes, BlockId no, BlockId merge, ValueId condition) {
        Block& block = program_.blocks[head];
        block.insts.pop_back();
        for (const BlockId arm : {yes, no}) {
            if (arm == head) continue;
            Block& from = program_.blocks[arm];
            block.insts.insert(block.insts.end(), from.insts.begin(), from.insts.end() - 1);
            from.insts.clear();
            from.successors.clear();
            from.predecessors.clear();
            keep_[arm] = false;
        }
        Block& target = program_.blocks[merge];
        auto& predecessors = target.predecessors;
        const auto yesAt =
            static_cast<uint32_t>(std::find(predecessors.begin(), predecessors.end(), yes) - predecessors.begin());
        const auto noAt =
            static_cast<uint32_t>(std::find(predecessors.begin(), predecessors.end(), no) - predecessors.begin());
        for (Inst& phi : target.insts) {
            if (phi.op != Op::phi) break;
            ValueId* operands = program_.operands.data() + phi.firstOperand;
            const ValueId a = operands[yesAt], b = operands[noAt];
            const ValueId value = a == b ? a : select(block, phi, condition, a, b);
            operands = program_.operands.data() + phi.firstOperand;
            operands[yesAt] = value;
            std::copy(operands + noAt + 1, operands + phi.operandCount, operands + noAt);
            --phi.operandCount;
        }
        predecessors[yesAt] = head;
        predecessors.erase(predecessors.begin() + noAt);
        block.successors = {merge};
        Inst jump;
        jump.op = Op::jump;
        block.insts.push_back(jump);
    }

    ValueId select(Block& block, const Inst& phi, ValueId condition, ValueId a, ValueId b) {
        Inst inst;
        inst.op = Op::select;
        inst.type = phi.type;
        inst.line = phi.line;
        inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
        inst.operandCount = 3;
        program_.operands.insert(program_.operands.end(), {condition, a, b});
        inst.result = program_.newValue(phi.type);
        block.insts.push_back(inst);
        return inst.result;
    }
};

}  // namespace

bool convertIfs(Program& program) {
    return IfConverter(program).run();
}

}  // namespace vernier::ir
