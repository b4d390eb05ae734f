// The class behind lower(): one pass over the IR that emits machine code. lower.cpp has its values and the
// pieces, lower_inst.cpp its instructions, lower_flow.cpp its blocks and edges.
#pragma once

#include <algorithm>
#include <string>
#include <unordered_map>
#include <vector>

#include "spirv_interp/batch/fuse.h"
#include "spirv_interp/batch/join_stores.h"
#include "spirv_interp/batch/lower.h"
#include "spirv_interp/batch/machine.h"
#include "spirv_interp/batch/uniform.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ir.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/rates.h"

namespace vernier::batch {

/// What all pieces share: facts about blocks and values.
struct Facts {
    Facts(const ir::Program& p, bool packed)
        : program(p), cfg(p), rates(ir::computeRates(p)), definition(p.valueTypes.size()), uses(p.valueTypes.size()) {
        for (ir::Rate& rate : rates) {
            // What folding has left of operations on constants is computed with the draw.
            rate = std::max(rate, ir::Rate::draw);
            // And what changes more often than batches do, in every lane.
            if (!isUniform(rate) || (packed && rate == ir::Rate::workGroup)) rate = ir::Rate::invocation;
            scalar.push_back(rate != ir::Rate::invocation);
        }
        uniform = uniformValues(p, cfg, scalar);
        for (size_t v = 0; v < uniform.size(); ++v) scalar[v] = scalar[v] || uniform[v];
        for (const ir::Block& block : p.blocks) {
            for (const ir::Inst& inst : block.insts) {
                if (inst.result != ir::kNoValue) definition[inst.result] = &inst;
                for (const ir::ValueId value : p.operandsOf(inst)) ++uses[value];
            }
        }
    }

    const ir::Program& program;
    ir::Cfg cfg;
    std::vector<ir::Rate> rates;              // by value
    std::vector<bool> scalar;                 // the same for all lanes of a batch
    std::vector<bool> uniform;                // those of them that the batch's own code computes
    std::vector<const ir::Inst*> definition;  // of the first result
    std::vector<uint32_t> uses;
};

/// Lowers one piece, that of the values of one rate. What changes less is a scalar there; so is what is the same for
/// all lanes and can be computed from scalars. The rest is in rows.
class Lowerer {
  public:
    Lowerer(const Facts& facts, LoweredProgram& lowered, std::vector<uint32_t>& scalarIndex, ir::Rate rate,
            MachineCode& code)
        : facts_(facts),
          program_(facts.program),
          scalars_(lowered.scalars),
          inputScalars_(lowered.inputScalars),
          scalarIndex_(scalarIndex),
          rate_(rate),
          code_(code),
          registers_(facts.program.valueTypes.size(), kNone) {
        code_.inputs.assign(program_.inputs.size(), kNone);
        code_.outputs.assign(program_.outputs.size(), kNone);
    }

    void lowerBatch();
    /// Emits, for a piece that is straight-line, those of its values that have a place in the scalar file and
    /// everything they need, and keeps them there.
    void lowerStraight();
    /// The name of the first operation there is no way to run; empty if all is well.
    const std::string& unsupported() const { return unsupported_; }

  private:
    // Values.
    /// Known before the piece runs.
    bool isGiven(ir::ValueId value) const {
        const ir::Inst* inst = facts_.definition[value];
        if (inst != nullptr && (inst->op == ir::Op::constant || inst->op == ir::Op::undef)) return true;
        // Inputs that do not vary between lanes are put into the scalar file before the piece runs.
        const bool given = inst != nullptr && inst->op == ir::Op::input && facts_.scalar[value];
        return facts_.rates[value] < rate_ || (given && facts_.rates[value] == rate_);
    }
    /// In the scalar file from its definition on: in straight-line pieces everything of 32 bits.
    bool isScalar(ir::ValueId value) const {
        return isGiven(value) || (rate_ == ir::Rate::invocation ? facts_.uniform[value] : !isWide(value));
    }
    bool isWide(ir::ValueId value) const { return ir::isWide(program_.valueTypes[value]); }
    uint32_t scalarOf(ir::ValueId value);
    uint32_t newRegister(bool wide);
    uint32_t registerOf(ir::ValueId value);
    /// A row with the value: its own, or one into which a scalar is spread.
    Operand rowOf(ir::ValueId value);
    Operand wordOf(ir::ValueId value, uint8_t word);
    Operand operandOf(ir::ValueId value) { return wordOf(value, 0); }
    Operand target(const ir::Inst& inst) { return Operand::write(registerOf(inst.result)); }

    // Instructions.
    MachineInst& emit(Op op, std::vector<Operand> operands);
    void emitMove(const Operand& to, const Operand& from) {
        emit(to.isScalar() ? Op::moveScalar : from.isScalar() ? Op::broadcast : Op::copy, {to, from});
    }
    void lowerInst(const ir::Inst& inst);
    bool lowerFused(const ir::Inst& inst);
    void lowerElement(const ir::Inst& inst, Op op);
    void lowerScalar(const ir::Inst& inst);
    void emitVector(Op op, const Operand& to, std::vector<Operand> from);
    void lowerWords(const ir::Inst& inst);
    void lowerStore(const ir::Inst& inst);
    void lowerImage(const ir::Inst& inst);
    void lowerAtomic(const ir::Inst& inst);
    void lowerLocal(const ir::Inst& inst);
    void lowerOutput(const ir::Inst& inst);
    void lowerInputIndexed(const ir::Inst& inst);
    void lowerInterpolation(const ir::Inst& inst);
    void lowerSubgroup(const ir::Inst& inst);  // lower_subgroup.cpp

    // Control flow.
    void planBlocks();
    void planOutputs();
    void lowerTerminator(ir::BlockId block);
    /// Whether `to` comes next in the code. Behind a loop it does not: lanes may still wait at the loop's header.
    bool isNext(ir::BlockId from, ir::BlockId to) const { return to == from + 1 && !endsLoop_[from]; }
    /// Whether an edge goes to the block that comes next in the code and has nothing to do on the way.
    bool entersNext(ir::BlockId from, size_t successor) const {
        const ir::BlockId to = program_.blocks[from].successors[successor];
        return isNext(from, to) && !fallsIn_[to] && program_.blocks[to].insts.front().op != ir::Op::phi;
    }
    uint32_t newLabel() {
        code_.labels.push_back(0);
        return static_cast<uint32_t>(code_.labels.size() - 1);
    }
    void bind(uint32_t label) { code_.labels[label] = static_cast<uint32_t>(code_.insts.size()); }
    uint32_t maskOf(ir::BlockId block) const { return 1 + block; }
    std::vector<Move> movesOf(ir::BlockId from, size_t successor);
    /// Moves for an edge and hands the lanes of `mask` on to its target.
    void lowerEdge(ir::BlockId from, size_t successor, uint32_t mask);
    /// The mask slot into which the lanes of an edge go first: the target's own if it has no moves.
    uint32_t edgeMask(ir::BlockId from, size_t successor);
    void emitMoves(std::vector<Move> moves, uint32_t mask);

    const Facts& facts_;
    const ir::Program& program_;
    ScalarFile& scalars_;
    std::vector<uint32_t>& inputScalars_;
    std::vector<uint32_t>& scalarIndex_;  // by value
    const ir::Rate rate_;
    MachineCode& code_;
    std::vector<uint32_t> registers_;                   // by value
    std::unordered_map<ir::ValueId, uint32_t> spread_;  // in this block: rows of scalars
    uint32_t loop_ = kNone;                             // header of the loop being lowered
    uint32_t line_ = 0;
    Fusions fusions_;
    JoinedStores stores_;
    std::vector<bool> fallsIn_;   // blocks that run on from the block before, with its mask
    std::vector<bool> full_;      // blocks that every lane runs first
    std::vector<bool> endsLoop_;  // last blocks of loops
    std::vector<uint32_t> endLabels_, loopLabels_, headLabels_, bodyLabels_;  // by block
    struct OutputPlan {
        uint32_t stores = 0;
        bool alias = false;
    };
    std::vector<OutputPlan> outputPlans_;
    ir::BlockId block_ = 0;
    std::string unsupported_;
};

}  // namespace vernier::batch
