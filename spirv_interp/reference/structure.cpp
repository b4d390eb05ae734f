// The structured order of a function's blocks: every construct is one run of places, its merge block right behind it.
#include <algorithm>

#include "spirv_interp/reference/module_data.h"

namespace vernier::reference {
namespace {

/// The labels that a block may go to, in the order in which they are to come.
std::vector<Id> targets(const Function& function, const Block& block) {
    std::vector<Id> labels;
    if (block.end == block.begin) return labels;
    const Instruction& last = function.instructions[block.end - 1];
    switch (last.op) {
        case spv::OpBranch:
            labels.push_back(last.operand(0));
            break;
        case spv::OpBranchConditional:
            labels = {last.operand(1), last.operand(2)};
            break;
        case spv::OpSwitch:
            // Literals of 64 bits take two words: whatever is a label is a target, and a literal that happens to be a
            // label as well only changes the order.
            labels.push_back(last.operand(1));
            for (size_t k = 3; k < last.operands.size(); ++k) labels.push_back(last.operands[k]);
            break;
        default:
            break;
    }
    return labels;
}

}  // namespace

/// Reversed postorder of a depth-first walk that goes to the merge block first, then to the continue target: what is
/// walked first comes last. (Case constructs that fall through keep their order, as an edge never goes backwards.)
void orderBlocks(Function& function) {
    const size_t count = function.blocks.size();
    std::vector<uint32_t> postorder;
    std::vector<bool> seen(count);
    struct Visit {
        uint32_t block;
        std::vector<Id> next;  // walked from the back
    };
    std::vector<Visit> stack;
    const auto push = [&](uint32_t index) {
        if (seen[index]) return;
        seen[index] = true;
        const Block& block = function.blocks[index];
        Visit visit{index, targets(function, block)};
        // The last of the targets is to be walked first, behind it the merge block.
        if (block.continueTarget != 0) visit.next.push_back(block.continueTarget);
        if (block.merge != 0) visit.next.push_back(block.merge);
        stack.push_back(std::move(visit));
    };
    for (uint32_t root = 0; root < count; ++root) {
        push(root);
        while (!stack.empty()) {
            Visit& top = stack.back();
            if (top.next.empty()) {
                postorder.push_back(top.block);
                stack.pop_back();
                continue;
            }
            const auto found = function.blockOf.find(top.next.back());
            top.next.pop_back();
            if (found != function.blockOf.end()) push(found->second);
        }
        // Blocks that cannot be reached are walked later: they must not come before the entry.
        if (root == 0) std::reverse(postorder.begin(), postorder.end());
    }
    for (uint32_t place = 0; place < count; ++place) function.blocks[postorder[place]].rank = place;
    for (Block& block : function.blocks) {
        if (block.continueTarget == 0) continue;
        const auto merge = function.blockOf.find(block.merge);
        block.loopEnd =
            merge != function.blockOf.end() ? function.blocks[merge->second].rank : static_cast<uint32_t>(count);
    }
}

}  // namespace vernier::reference
