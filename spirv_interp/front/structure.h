// The order in which the blocks of a function are lowered: structured order, as ir.h asks for.
#pragma once

#include <vector>

#include "spirv_interp/front/module.h"

namespace vernier {

struct StructuredBlock {
    uint32_t index = 0;    // into Function::blocks
    uint32_t loopEnd = 0;  // of a loop header: one past the last block of the loop, in this order; 0 otherwise
};

/// The reachable blocks. Every edge but back edges goes forward; the blocks of a loop are contiguous, header first.
std::vector<StructuredBlock> structuredOrder(const Module& module, const Function& function);

/// Words of the literals of an OpSwitch: by the width of its selector's type.
uint32_t literalWordsOf(const Module& module, const Instruction& inst);

/// The labels a terminator goes to, in the order of its operands. OpSwitch lists each case; literals may take two
/// words.
void appendTargets(const Instruction& terminator, uint32_t literalWords, std::vector<uint32_t>& labels);

}  // namespace vernier
