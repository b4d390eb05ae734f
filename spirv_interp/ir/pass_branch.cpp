#include <algorithm>
#include <optional>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

/// The terminator becomes a jump to successor `kept`; the other edges go.
void jumpTo(Program& program, BlockId b, size_t kept) {
    Block& block = program.blocks[b];
    for (size_t i = 0; i < block.successors.size(); ++i) {
        if (i != kept) removePredecessor(program, b, block.successors[i]);
    }
    block.successors = {block.successors[kept]};
    block.cases.clear();
    block.insts.back().op = Op::jump;
    block.insts.back().operandCount = 0;
}

bool foldTerminators(Program& program) {
    std::vector<const Inst*> definition(program.valueTypes.size(), nullptr);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (inst.op == Op::constant || inst.op == Op::bnot || inst.op == Op::undef) definition[inst.result] = &inst;
        }
    }
    bool changed = false;
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
        Block& block = program.blocks[b];
        Inst& end = block.insts.back();
        if (end.op != Op::branch && end.op != Op::switchOn) continue;
        // Where every edge goes to one block whose phis do not tell the edges apart, the condition does not matter.
        const Block& target = program.blocks[block.successors[0]];
        const bool onlyOne = std::all_of(block.successors.begin(), block.successors.end(),
                                         [&](BlockId s) { return s == block.successors[0]; });
        if (onlyOne && target.insts.front().op != Op::phi) {
            jumpTo(program, b, 0);
            changed = true;
            continue;
        }
        const Inst* condition = definition[program.operands[end.firstOperand]];
        if (condition == nullptr) continue;
        if (condition->op == Op::bnot && end.op == Op::branch) {
            program.operands[end.firstOperand] = program.operands[condition->firstOperand];
            std::swap(block.successors[0], block.successors[1]);
            changed = true;
        } else if (condition->op != Op::bnot) {
            const uint64_t bits = condition->op == Op::constant ? condition->imm : 0;
            size_t kept = 0;
            if (end.op == Op::branch) {
                kept = bits != 0 ? 0 : 1;
            } else {
                const auto found = std::find_if(block.cases.begin(), block.cases.end(),
                                                [bits](int32_t c) { return static_cast<uint32_t>(c) == bits; });
                if (found != block.cases.end()) kept = static_cast<size_t>(found - block.cases.begin()) + 1;
            }
            jumpTo(program, b, kept);
            changed = true;
        }
    }
    return changed;
}

/// A block that only jumps is left out: its predecessors go where it goes. Latches stay, so that a loop keeps one back
/// edge.
bool skipEmptyBlocks(Program& program) {
    std::vector<bool> keep(program.blocks.size(), true);
    bool changed = false;
    for (BlockId b = 1; b < program.blocks.size(); ++b) {
        Block& block = program.blocks[b];
        if (block.insts.size() != 1 || block.insts[0].op != Op::jump || block.loopHeader) continue;
        const BlockId to = block.successors[0];
        Block& target = program.blocks[to];
        if (to <= b) continue;
        const bool hasPhis = target.insts.front().op == Op::phi;
        // An edge of a predecessor that is there already would have to carry two values.
        const bool clash = std::any_of(block.predecessors.begin(), block.predecessors.end(), [&](BlockId p) {
            return std::find(target.predecessors.begin(), target.predecessors.end(), p) != target.predecessors.end() ||
                   std::count(block.predecessors.begin(), block.predecessors.end(), p) > 1;
        });
        if (hasPhis && clash) continue;
        const auto index = static_cast<size_t>(std::find(target.predecessors.begin(), target.predecessors.end(), b) -
                                               target.predecessors.begin());
        for (Inst& phi : target.insts) {
            if (phi.op != Op::phi) break;
            std::vector<ValueId> operands(program.operandsOf(phi).begin(), program.operandsOf(phi).end());
            const ValueId value = operands[index];
            operands.erase(operands.begin() + static_cast<std::ptrdiff_t>(index));
            operands.insert(operands.end(), block.predecessors.size(), value);
            phi.firstOperand = static_cast<uint32_t>(program.operands.size());
            phi.operandCount = static_cast<uint16_t>(operands.size());
            program.operands.insert(program.operands.end(), operands.begin(), operands.end());
        }
        target.predecessors.erase(target.predecessors.begin() + static_cast<std::ptrdiff_t>(index));
        for (const BlockId p : block.predecessors) {
            target.predecessors.push_back(p);
            // Once per edge: a predecessor with two edges is listed twice.
            auto& successors = program.blocks[p].successors;
            *std::find(successors.begin(), successors.end(), b) = to;
        }
        block.predecessors.clear();
        block.successors.clear();
        keep[b] = false;
        changed = true;
    }
    if (changed) removeBlocks(program, keep);
    return changed;
}

/// A block with one successor takes in that successor if it has no other predecessor and stands in the same loop.
bool mergeChains(Program& program) {
    const Cfg cfg(program);
    std::vector<bool> keep(program.blocks.size(), true);
    std::vector<ValueId> replacement(program.valueTypes.size(), kNoValue);
    bool changed = false;
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
        if (!keep[b]) continue;
        Block& block = program.blocks[b];
        while (block.insts.back().op == Op::jump) {
            const BlockId next = block.successors[0];
            Block& other = program.blocks[next];
            if (next <= b || other.predecessors.size() != 1 || other.loopHeader || cfg.loop[next] != cfg.loop[b]) break;
            block.insts.pop_back();
            for (const Inst& inst : other.insts) {
                if (inst.op == Op::phi) {
                    replacement[inst.result] = program.operands[inst.firstOperand];
                } else {
                    block.insts.push_back(inst);
                }
            }
            block.successors = std::move(other.successors);
            block.cases = std::move(other.cases);
            for (const BlockId s : block.successors) {
                auto& predecessors = program.blocks[s].predecessors;
                std::replace(predecessors.begin(), predecessors.end(), next, b);
            }
            other.successors.clear();
            other.predecessors.clear();
            keep[next] = false;
            changed = true;
        }
    }
    if (!changed) return false;
    removeBlocks(program, keep);
    replaceUses(program, replacement);
    return true;
}

}  // namespace

bool foldBranches(Program& program) {
    bool any = false;
    for (bool changed = true; changed;) {
        changed = foldTerminators(program);
        changed |= removeUnreachable(program);
        changed |= skipEmptyBlocks(program);
        changed |= mergeChains(program);
        any |= changed;
    }
    return any;
}

}  // namespace vernier::ir
