#include "spirv_interp/ir/cfg.h"

#include <algorithm>

#include "spirv_interp/ir/ops.h"

namespace vernier::ir {

// Structured order is a reverse postorder of a reducible graph, so the dominators settle in one pass of the iteration
// of Cooper, Harvey and Kennedy ("A Simple, Fast Dominance Algorithm", 2001): back edges do not matter.
Cfg::Cfg(const Program& program) {
    const auto count = static_cast<BlockId>(program.blocks.size());
    idom.assign(count, kNoIndex);
    loop.assign(count, kNoIndex);
    loopParent.assign(count, kNoIndex);
    if (count == 0) return;
    idom[0] = 0;
    for (BlockId b = 1; b < count; ++b) {
        BlockId common = kNoIndex;
        for (const BlockId p : program.blocks[b].predecessors) {
            if (p >= b || idom[p] == kNoIndex) continue;
            BlockId other = p;
            if (common == kNoIndex) common = p;
            while (common != other) {
                if (common > other) {
                    common = idom[common];
                } else {
                    other = idom[other];
                }
            }
        }
        idom[b] = common == kNoIndex ? 0 : common;
    }
    std::vector<BlockId> open;
    for (BlockId b = 0; b < count; ++b) {
        while (!open.empty() && program.blocks[open.back()].loopEnd <= b) open.pop_back();
        if (program.blocks[b].loopHeader) {
            loopParent[b] = open.empty() ? kNoIndex : open.back();
            open.push_back(b);
        }
        if (!open.empty()) loop[b] = open.back();
    }
}

std::vector<BlockId> definingBlocks(const Program& program) {
    std::vector<BlockId> result(program.valueTypes.size(), kNoIndex);
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
        for (const Inst& inst : program.blocks[b].insts) {
            for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) result[inst.result + r] = b;
        }
    }
    return result;
}

void removePredecessor(Program& program, BlockId from, BlockId to) {
    Block& block = program.blocks[to];
    const auto found = std::find(block.predecessors.begin(), block.predecessors.end(), from);
    if (found == block.predecessors.end()) return;
    const auto index = static_cast<uint32_t>(found - block.predecessors.begin());
    block.predecessors.erase(found);
    for (Inst& inst : block.insts) {
        if (inst.op != Op::phi) break;
        const auto first = program.operands.begin() + inst.firstOperand;
        std::copy(first + index + 1, first + inst.operandCount, first + index);
        --inst.operandCount;
    }
}

void removeBlocks(Program& program, const std::vector<bool>& keep) {
    const auto count = static_cast<BlockId>(program.blocks.size());
    std::vector<BlockId> renumbered(count + 1);
    BlockId next = 0;
    for (BlockId b = 0; b < count; ++b) {
        renumbered[b] = next;
        if (keep[b]) {
            ++next;
            continue;
        }
        for (const BlockId s : program.blocks[b].successors) removePredecessor(program, b, s);
    }
    renumbered[count] = next;
    if (next == count) return;
    for (BlockId b = 0; b < count; ++b) {
        if (!keep[b]) continue;
        Block& block = program.blocks[b];
        for (BlockId& p : block.predecessors) p = renumbered[p];
        for (BlockId& s : block.successors) s = renumbered[s];
        if (block.loopHeader) block.loopEnd = renumbered[block.loopEnd];
        if (renumbered[b] != b) program.blocks[renumbered[b]] = std::move(block);
    }
    program.blocks.resize(next);
}

bool removeUnreachable(Program& program) {
    bool changed = false;
    const auto count = static_cast<BlockId>(program.blocks.size());
    std::vector<bool> reached(count, false);
    std::vector<BlockId> work{0};
    reached[0] = true;
    while (!work.empty()) {
        const BlockId b = work.back();
        work.pop_back();
        for (const BlockId s : program.blocks[b].successors) {
            if (!reached[s]) {
                reached[s] = true;
                work.push_back(s);
            }
        }
    }
    if (std::find(reached.begin(), reached.end(), false) != reached.end()) {
        removeBlocks(program, reached);
        changed = true;
    }
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
        Block& block = program.blocks[b];
        const auto isBack = [b](BlockId p) { return p >= b; };
        if (block.loopHeader && std::none_of(block.predecessors.begin(), block.predecessors.end(), isBack)) {
            block.loopHeader = false;
            block.loopEnd = 0;
            changed = true;
        }
    }
    return changed;
}

ValueId resolve(std::vector<ValueId>& replacement, ValueId value) {
    ValueId end = value;
    while (end < replacement.size() && replacement[end] != kNoValue) end = replacement[end];
    while (value != end) {
        const ValueId next = replacement[value];
        replacement[value] = end;
        value = next;
    }
    return end;
}

void replaceUses(Program& program, std::vector<ValueId>& replacement) {
    for (Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            for (uint32_t i = 0; i < inst.operandCount; ++i) {
                ValueId& operand = program.operands[inst.firstOperand + i];
                operand = resolve(replacement, operand);
            }
        }
    }
}

void compact(Program& program) {
    std::vector<ValueId> renumbered(program.valueTypes.size(), kNoValue);
    std::vector<Type> types;
    std::vector<ValueId> operands;
    for (Block& block : program.blocks) {
        for (Inst& inst : block.insts) {
            const uint32_t results = opInfo(inst.op).results;
            if (results == 0) {
                inst.result = kNoValue;
                continue;
            }
            const auto first = static_cast<ValueId>(types.size());
            for (uint32_t r = 0; r < results; ++r) {
                renumbered[inst.result + r] = first + r;
                types.push_back(inst.type);
            }
            inst.result = first;
        }
    }
    for (Block& block : program.blocks) {
        for (Inst& inst : block.insts) {
            const auto first = static_cast<uint32_t>(operands.size());
            for (const ValueId operand : program.operandsOf(inst)) operands.push_back(renumbered[operand]);
            inst.firstOperand = first;
        }
    }
    program.operands = std::move(operands);
    program.valueTypes = std::move(types);
}

}  // namespace vernier::ir
