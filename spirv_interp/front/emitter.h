// Builds a Program while SPIR-V is walked: folds constants as they appear and turns variables into SSA values on the
// fly (Braun, Buchwald, Hack, Leissa, Mallon, Zwinkau, "Simple and Efficient Construction of Static Single Assignment
// Form", CC 2013). Blocks are created in any order and take their place when begin() is called.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "spirv_interp/front/scalars.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

class Emitter {
  public:
    explicit Emitter(ir::Program& program) : program_(program) {}

    /// Applied to the instructions to come.
    void setLine(uint32_t line, uint32_t file = 0) {
        line_ = line;
        file_ = file;
    }
    void setFlags(bool noContraction, bool relaxed) {
        noContraction_ = noContraction;
        relaxed_ = relaxed;
    }
    uint32_t line() const { return line_; }
    uint32_t file() const { return file_; }

    // Values.
    ir::ValueId constant(ir::Type type, uint64_t bits);
    ir::ValueId constantI32(uint32_t value) { return constant(ir::Type::i32, value); }
    ir::ValueId constantBool(bool value) { return constant(ir::Type::b1, value ? ir::kTrueBits : 0); }
    ir::ValueId constantFloat(ir::Type type, double value);
    ir::ValueId undef(ir::Type type);
    ir::Type typeOf(ir::ValueId value) const { return program_.valueTypes[defined(value)]; }
    bool hasType(ir::ValueId value, ir::Type type) const {
        return value < program_.valueTypes.size() && program_.valueTypes[value] == type;
    }
    /// The bits of a value that is constant.
    std::optional<uint64_t> constantBits(ir::ValueId value);
    bool isUndef(ir::ValueId value);
    /// Appends an instruction to the current block, or finds its value without one. Not for phis and terminators.
    /// Operands and results that the operation does not take end the lowering, as do edges that no structure has.
    ir::ValueId emit(ir::Op op, ir::Type type, std::span<const ir::ValueId> operands, uint64_t imm = 0);
    ir::ValueId emit(ir::Op op, ir::Type type, std::initializer_list<ir::ValueId> operands, uint64_t imm = 0) {
        return emit(op, type, std::span<const ir::ValueId>(operands.begin(), operands.size()), imm);
    }

    // Blocks. An edge is recorded by the terminator of its source.
    ir::BlockId newBlock();
    /// Takes the next place in the order; later instructions go there. A block that is no loop header is sealed: all
    /// its predecessors have their terminators.
    void begin(ir::BlockId block, bool loopHeader = false);
    ir::BlockId current() const { return current_; }
    /// Whether an edge into the block has been recorded.
    bool reached(ir::BlockId block) const { return !program_.blocks[block].predecessors.empty(); }
    /// After the last block of a loop: seals its header.
    void endLoop(ir::BlockId header);
    void jump(ir::BlockId to);
    void branch(ir::ValueId condition, ir::BlockId ifTrue, ir::BlockId ifFalse);
    void switchOn(ir::ValueId selector, ir::BlockId otherwise, std::span<const int32_t> cases,
                  std::span<const ir::BlockId> targets);
    void ret();
    void kill();
    /// Whether the current block has its terminator.
    bool terminated() const { return terminated_; }

    // Variables, one scalar each.
    uint32_t newVariables(uint32_t count);
    void write(uint32_t variable, ir::ValueId value) { define(current_, variable, value); }
    ir::ValueId read(uint32_t variable, ir::Type type);

    size_t instructionCount() const { return instructionCount_; }

    /// Puts blocks, phis and constants in their places. Nothing may be emitted afterwards.
    void finish();

  private:
    struct Phi {
        ir::BlockId block;
        uint32_t index;  // in phis of the block
        uint32_t variable;
    };
    struct State {
        std::vector<ir::Inst> phis;
        std::vector<Phi> incomplete;
        bool sealed = false;
        bool placed = false;
        uint32_t position = 0;  // in the order, when placed
        uint32_t loopEnd = 0;
    };

    /// A map from (block, variable) to a value, open addressing.
    class Definitions {
      public:
        ir::ValueId* find(uint64_t key);
        void set(uint64_t key, ir::ValueId value);

      private:
        void grow();
        struct Slot {
            uint64_t key = kEmpty;
            ir::ValueId value = 0;
        };
        static constexpr uint64_t kEmpty = ~0ull;
        std::vector<Slot> slots_;
        size_t used_ = 0;
    };

    /// The value, if there is one.
    ir::ValueId defined(ir::ValueId value) const;
    void check(ir::Op op, ir::Type type, std::span<const ir::ValueId> operands, uint64_t imm) const;

    static uint64_t key(ir::BlockId block, uint32_t variable) { return static_cast<uint64_t>(block) << 32 | variable; }
    void define(ir::BlockId block, uint32_t variable, ir::ValueId value) {
        definitions_.set(key(block, variable), value);
    }
    ir::ValueId readAt(ir::BlockId block, uint32_t variable, ir::Type type);
    ir::ValueId newPhi(ir::BlockId block, uint32_t variable, ir::Type type);
    void drain();
    void complete(const Phi& phi);
    ir::ValueId simplified(ir::Op op, ir::Type type, std::span<const ir::ValueId> operands);
    ir::ValueId resolved(ir::ValueId value);
    void addEdge(ir::BlockId to);
    void terminate(ir::Op op, std::initializer_list<ir::ValueId> operands);
    ir::Inst& append(ir::Op op, ir::Type type, std::span<const ir::ValueId> operands, uint64_t imm);

    ir::Program& program_;
    uint32_t line_ = 0, file_ = 0;
    bool noContraction_ = false, relaxed_ = false, terminated_ = true;
    ir::BlockId current_ = 0;
    std::vector<State> states_;
    std::vector<ir::BlockId> order_;
    Definitions definitions_;
    std::vector<Phi> pending_;
    std::vector<ir::ValueId> replacement_;
    uint32_t variableCount_ = 0;
    size_t instructionCount_ = 0;
    std::vector<ir::Inst> leaves_;                            // constants and undefs, for the front of the entry
    std::unordered_map<ir::ValueId, uint32_t> leafOf_;        // value to index in leaves_
    std::unordered_map<uint64_t, ir::ValueId> constants_[6];  // by type
    ir::ValueId undefs_[6] = {ir::kNoValue, ir::kNoValue, ir::kNoValue, ir::kNoValue, ir::kNoValue, ir::kNoValue};
};

}  // namespace vernier
