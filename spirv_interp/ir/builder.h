// Appends instructions and blocks to a Program. Knows nothing of SSA construction or folding.
#pragma once

#include <initializer_list>
#include <span>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

class Builder {
  public:
    explicit Builder(Program& program) : program_(program) {}

    Program& program() { return program_; }
    BlockId newBlock();
    /// Instructions are appended to this block from now on.
    void setBlock(BlockId block) { block_ = block; }
    BlockId block() const { return block_; }
    /// The source line of the instructions to come.
    void setLine(uint32_t line) { line_ = line; }

    /// Appends an instruction; returns its first result, or kNoValue.
    ValueId append(Op op, Type type, std::span<const ValueId> operands, uint64_t imm = 0);
    ValueId append(Op op, Type type, std::initializer_list<ValueId> operands, uint64_t imm = 0) {
        return append(op, type, std::span<const ValueId>(operands.begin(), operands.size()), imm);
    }
    ValueId constant(Type type, uint64_t bits) { return append(Op::constant, type, {}, bits); }
    /// The instruction appended last to the current block.
    Inst& last() { return program_.blocks[block_].insts.back(); }

    // Terminators; they record both ends of their edges.
    void jump(BlockId to);
    void branch(ValueId condition, BlockId ifTrue, BlockId ifFalse);
    void switchOn(ValueId selector, BlockId otherwise, std::span<const int32_t> cases,
                  std::span<const BlockId> targets);
    void ret() { append(Op::ret, Type::none, {}); }
    void kill() { append(Op::kill, Type::none, {}); }

    /// Marks `header` as the header of the loop of blocks [header, end).
    void markLoop(BlockId header, BlockId end);

  private:
    void addEdge(BlockId to);

    Program& program_;
    BlockId block_ = 0;
    uint32_t line_ = 0;
};

}  // namespace vernier::ir
