#include "spirv_interp/batch/uniform.h"

#include <algorithm>

#include "spirv_interp/batch/select.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::batch {
namespace {

/// Takes values to be uniform until a reason is found against it; what depends on them falls with them.
class Analysis {
  public:
    Analysis(const ir::Program& program, const ir::Cfg& cfg, const std::vector<bool>& scalar)
        : program_(program), cfg_(cfg), scalar_(scalar), uniform_(scalar) {}

    std::vector<bool> run() {
        for (const ir::Block& block : program_.blocks) {
            for (const ir::Inst& inst : block.insts) {
                if (inst.result != ir::kNoValue && takesScalars(program_, inst)) uniform_[inst.result] = true;
            }
        }
        for (bool changed = true; changed;) {
            changed = false;
            countDivergentBranches();
            for (ir::BlockId b = 0; b < program_.blocks.size(); ++b) {
                for (const ir::Inst& inst : program_.blocks[b].insts) {
                    if (inst.result == ir::kNoValue || !uniform_[inst.result] || scalar_[inst.result]) continue;
                    if (holds(inst, b)) continue;
                    uniform_[inst.result] = false;
                    changed = true;
                }
            }
        }
        for (size_t v = 0; v < uniform_.size(); ++v) uniform_[v] = uniform_[v] && !scalar_[v];
        return std::move(uniform_);
    }

  private:
    bool isUniform(ir::ValueId value) const { return scalar_[value] || uniform_[value]; }

    /// By block: the branches up to it that lanes may leave in different ways.
    void countDivergentBranches() {
        divergent_.assign(1, 0);
        for (const ir::Block& block : program_.blocks) {
            const ir::Inst& last = block.insts.back();
            const bool diverges = block.successors.size() > 1 && !isUniform(program_.operandsOf(last)[0]);
            divergent_.push_back(divergent_.back() + (diverges ? 1 : 0));
        }
    }

    bool holds(const ir::Inst& inst, ir::BlockId b) const {
        const auto operands = program_.operandsOf(inst);
        if (!std::all_of(operands.begin(), operands.end(), [&](ir::ValueId v) { return isUniform(v); })) return false;
        if (inst.op != ir::Op::phi) return true;
        const ir::Block& block = program_.blocks[b];
        // All lanes enter a loop together, and those that go on come to its header together.
        if (block.loopHeader) return block.predecessors.size() == 2;
        // Elsewhere lanes may come by different ways, or out of a loop after different rounds.
        ir::BlockId first = cfg_.idom[b];
        for (const ir::BlockId p : block.predecessors) {
            for (ir::BlockId loop = cfg_.loop[p]; loop != ir::kNoIndex; loop = cfg_.loopParent[loop]) {
                if (b < loop || b >= program_.blocks[loop].loopEnd) first = std::min(first, loop);
            }
        }
        return divergent_[b] == divergent_[first];
    }

    const ir::Program& program_;
    const ir::Cfg& cfg_;
    const std::vector<bool>& scalar_;
    std::vector<bool> uniform_;
    std::vector<uint32_t> divergent_;  // before each block
};

}  // namespace

bool takesScalars(const ir::Program& program, const ir::Inst& inst) {
    if (inst.result == ir::kNoValue || ir::isWide(inst.type)) return false;
    for (const ir::ValueId value : program.operandsOf(inst)) {
        if (ir::isWide(program.valueTypes[value])) return false;
    }
    switch (inst.op) {
        case ir::Op::phi:
        case ir::Op::copy:
        case ir::Op::bitcast:
        case ir::Op::select:
            return true;
        case ir::Op::loadBuffer:
            return ir::immHigh(inst) != 1 && ir::immHigh(inst) != 2;  // whole words
        default: {
            const std::optional<Op> op = elementOp(program, inst);
            return op && takesScalars(*op);
        }
    }
}

std::vector<bool> uniformValues(const ir::Program& program, const ir::Cfg& cfg, const std::vector<bool>& scalar) {
    return Analysis(program, cfg, scalar).run();
}

}  // namespace vernier::batch
