// The control flow graph of a Program: dominators, loops, and edits that keep blocks, edges and phis consistent.
#pragma once

#include <vector>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Facts about the blocks of a program in structured order; stale after any change of its blocks or edges.
struct Cfg {
    std::vector<BlockId> idom;        // immediate dominator; the entry's is itself
    std::vector<BlockId> loop;        // header of the innermost loop around a block, kNoIndex outside loops
    std::vector<BlockId> loopParent;  // of a loop header: header of the next loop out, or kNoIndex

    explicit Cfg(const Program& program);

    bool dominates(BlockId a, BlockId b) const {
        while (b > a) b = idom[b];
        return a == b;
    }
    /// Whether every loop around `inner` is also around `outer`: a value of `inner` may be used in `outer` directly.
    bool loopsContain(const Program& program, BlockId inner, BlockId outer) const {
        const BlockId header = loop[inner];
        return header == kNoIndex || (outer >= header && outer < program.blocks[header].loopEnd);
    }
};

/// Where each value is defined; kNoIndex for values without a definition.
std::vector<BlockId> definingBlocks(const Program& program);

/// Takes one edge from `from` to `to` away: the entry in the predecessors and the phis' operands. The caller changes
/// the terminator and the successors of `from`.
void removePredecessor(Program& program, BlockId from, BlockId to);

/// Drops the blocks with keep[b] == false, which no kept block may go to (edges out of dropped blocks are taken away),
/// and renumbers the rest.
void removeBlocks(Program& program, const std::vector<bool>& keep);

/// Drops blocks that cannot be reached from the entry, and loops whose back edges are all gone. Returns whether it did.
bool removeUnreachable(Program& program);

/// replacement[v] stands for v, through chains; kNoValue = v stays. Rewrites every operand.
void replaceUses(Program& program, std::vector<ValueId>& replacement);

/// The end of a chain of replacements, shortening it.
ValueId resolve(std::vector<ValueId>& replacement, ValueId value);

/// Renumbers values in the order of their definition and rebuilds the pool of operands without holes.
void compact(Program& program);

}  // namespace vernier::ir
