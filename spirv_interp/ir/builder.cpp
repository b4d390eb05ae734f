#include "spirv_interp/ir/builder.h"

namespace vernier::ir {

BlockId Builder::newBlock() {
    program_.blocks.emplace_back();
    return static_cast<BlockId>(program_.blocks.size() - 1);
}

ValueId Builder::append(Op op, Type type, std::span<const ValueId> operands, uint64_t imm) {
    Inst inst;
    inst.op = op;
    inst.type = type;
    inst.line = line_;
    inst.imm = imm;
    inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
    inst.operandCount = static_cast<uint16_t>(operands.size());
    program_.operands.insert(program_.operands.end(), operands.begin(), operands.end());
    if (opInfo(op).results != 0) inst.result = program_.newValue(type, opInfo(op).results);
    program_.blocks[block_].insts.push_back(inst);
    return inst.result;
}

void Builder::addEdge(BlockId to) {
    program_.blocks[block_].successors.push_back(to);
    program_.blocks[to].predecessors.push_back(block_);
}

void Builder::jump(BlockId to) {
    append(Op::jump, Type::none, {});
    addEdge(to);
}

void Builder::branch(ValueId condition, BlockId ifTrue, BlockId ifFalse) {
    append(Op::branch, Type::none, {condition});
    addEdge(ifTrue);
    addEdge(ifFalse);
}

void Builder::switchOn(ValueId selector, BlockId otherwise, std::span<const int32_t> cases,
                       std::span<const BlockId> targets) {
    append(Op::switchOn, Type::none, {selector});
    program_.blocks[block_].cases.assign(cases.begin(), cases.end());
    addEdge(otherwise);
    for (const BlockId target : targets) addEdge(target);
}

void Builder::markLoop(BlockId header, BlockId end) {
    program_.blocks[header].loopHeader = true;
    program_.blocks[header].loopEnd = end;
}

}  // namespace vernier::ir
