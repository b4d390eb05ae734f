#include <algorithm>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

/// The block from which alone a loop is entered, and which goes nowhere else; kNoIndex if there is none.
BlockId entryOf(const Program& program, BlockId header) {
    const auto& predecessors = program.blocks[header].predecessors;
    const auto isOutside = [&](BlockId b) { return b < header || b >= program.blocks[header].loopEnd; };
    if (std::count_if(predecessors.begin(), predecessors.end(), isOutside) != 1) return kNoIndex;
    const BlockId entry = *std::find_if(predecessors.begin(), predecessors.end(), isOutside);
    return program.blocks[entry].insts.back().op == Op::jump ? entry : kNoIndex;
}

/// Whether every round of a loop that comes to its end has run a block.
bool runsAlways(const Program& program, const Cfg& cfg, BlockId block, BlockId header) {
    const auto& predecessors = program.blocks[header].predecessors;
    return std::all_of(predecessors.begin(), predecessors.end(), [&](BlockId from) {
        const bool inside = from >= header && from < program.blocks[header].loopEnd;
        return !inside || cfg.dominates(block, from);
    });
}

}  // namespace

bool hoistInvariants(Program& program) {
    const Cfg cfg(program);
    std::vector<BlockId> home = definingBlocks(program);
    bool changed = false;
    // Inner loops first: what leaves one may leave the next too.
    for (BlockId header = static_cast<BlockId>(program.blocks.size()); header-- > 0;) {
        if (!program.blocks[header].loopHeader) continue;
        const BlockId entry = entryOf(program, header), end = program.blocks[header].loopEnd;
        if (entry == kNoIndex) continue;
        const auto isOutside = [&](ValueId value) { return home[value] < header || home[value] >= end; };
        std::vector<Inst> moved;
        for (BlockId b = header; b < end; ++b) {
            if (!runsAlways(program, cfg, b, header)) continue;
            std::erase_if(program.blocks[b].insts, [&](const Inst& inst) {
                const auto operands = program.operandsOf(inst);
                if (!isMovable(program, inst) || !std::all_of(operands.begin(), operands.end(), isOutside))
                    return false;
                for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) home[inst.result + r] = entry;
                moved.push_back(inst);
                return true;
            });
        }
        auto& insts = program.blocks[entry].insts;
        insts.insert(insts.end() - 1, moved.begin(), moved.end());
        changed = changed || !moved.empty();
    }
    return changed;
}

}  // namespace vernier::ir
