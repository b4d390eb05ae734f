#include "spirv_interp/front/structure.h"

#include <algorithm>

namespace vernier {
namespace {

struct BlockShape {
    std::vector<uint32_t>
        next;  // blocks to visit, the merge block first, then the continue target, then the successors
    bool loop = false;
    bool merges = false;  // next[0] is a merge block
};

BlockShape shapeOf(const Module& module, const Function& function, const SpirvBlock& block) {
    BlockShape shape;
    std::vector<uint32_t> labels;
    for (uint32_t offset = block.first; offset < block.end;) {
        const Instruction inst = module.next(offset);
        switch (inst.op) {
            case spv::Op::OpLoopMerge:
                shape.loop = true;
                shape.merges = true;
                labels = {inst[1], inst[2]};
                break;
            case spv::Op::OpSelectionMerge:
                shape.merges = true;
                labels = {inst[1]};
                break;
            case spv::Op::OpSwitch:
                appendTargets(inst, literalWordsOf(module, inst), labels);
                break;
            default:
                appendTargets(inst, 1, labels);
                break;
        }
    }
    const size_t constructs = shape.loop ? 2 : shape.merges ? 1 : 0;
    // The successors are visited last to first, so that the first comes first in the order.
    std::reverse(labels.begin() + static_cast<std::ptrdiff_t>(constructs), labels.end());
    for (size_t i = 0; i < labels.size(); ++i) {
        const auto found = function.blockOfLabel.find(labels[i]);
        if (found != function.blockOfLabel.end()) {
            shape.next.push_back(found->second);
        } else if (i == 0) {
            shape.merges = false;
        }
    }
    return shape;
}

}  // namespace

uint32_t literalWordsOf(const Module& module, const Instruction& inst) {
    const Instruction selector = module.definition(inst[1]);
    const Instruction type = module.definition(selector[1]);
    return type.op == spv::Op::OpTypeInt && type[2] > 32 ? 2 : 1;
}

void appendTargets(const Instruction& terminator, uint32_t literalWords, std::vector<uint32_t>& labels) {
    switch (terminator.op) {
        case spv::Op::OpBranch:
            labels.push_back(terminator[1]);
            break;
        case spv::Op::OpBranchConditional:
            labels.push_back(terminator[2]);
            labels.push_back(terminator[3]);
            break;
        case spv::Op::OpSwitch:
            labels.push_back(terminator[2]);
            for (uint32_t word = 3 + literalWords; word < terminator.count; word += literalWords + 1) {
                labels.push_back(terminator[word]);
            }
            break;
        default:
            break;
    }
}

// Reverse postorder of a depth-first walk that visits a construct's merge block before its body: what the merge block
// leads to is finished first, so it comes after the body in the order, and the body stays together. The blocks finished
// between a loop's merge block and its header are the loop.
std::vector<StructuredBlock> structuredOrder(const Module& module, const Function& function) {
    std::vector<StructuredBlock> postorder;
    if (function.blocks.empty()) return postorder;
    struct Visit {
        uint32_t block;
        BlockShape shape;
        uint32_t nextChild = 0;
        size_t finishedAfterMerge = 0;
    };
    std::vector<bool> seen(function.blocks.size(), false);
    std::vector<Visit> stack;
    const auto visit = [&](uint32_t block) {
        seen[block] = true;
        stack.push_back({block, shapeOf(module, function, function.blocks[block]), 0, postorder.size()});
    };
    visit(0);
    while (!stack.empty()) {
        Visit& top = stack.back();
        if (top.nextChild == (top.shape.merges ? 1 : 0)) top.finishedAfterMerge = postorder.size();
        if (top.nextChild < top.shape.next.size()) {
            const uint32_t child = top.shape.next[top.nextChild++];
            if (!seen[child]) visit(child);
            continue;
        }
        StructuredBlock done{top.block, 0};
        // For now the number of blocks in the loop; its place is known when the order is reversed.
        if (top.shape.loop) done.loopEnd = static_cast<uint32_t>(postorder.size() + 1 - top.finishedAfterMerge);
        postorder.push_back(done);
        stack.pop_back();
    }
    std::reverse(postorder.begin(), postorder.end());
    for (uint32_t i = 0; i < postorder.size(); ++i) {
        if (postorder[i].loopEnd != 0) postorder[i].loopEnd += i;
    }
    return postorder;
}

}  // namespace vernier
