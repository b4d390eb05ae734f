#include "spirv_interp/batch/lower.h"

#include <algorithm>
#include <optional>
#include <string>

#include "spirv_interp/batch/fuse.h"
#include "spirv_interp/batch/select.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/rates.h"

namespace vernier::batch {

uint32_t ScalarFile::constant(uint64_t bits, bool wide) {
    const auto low = static_cast<uint32_t>(bits), high = static_cast<uint32_t>(bits >> 32);
    for (uint32_t k = 0; k + (wide ? 1 : 0) < words_.size(); ++k) {
        const bool lowFits = constant_[k] && words_[k] == low;
        if (lowFits && (!wide || (constant_[k + 1] && words_[k + 1] == high))) return k;
    }
    const uint32_t index = reserve(wide);
    words_[index] = low;
    constant_[index] = true;
    if (wide) {
        words_[index + 1] = high;
        constant_[index + 1] = true;
    }
    return index;
}

uint32_t ScalarFile::reserve(bool wide) {
    const auto index = static_cast<uint32_t>(words_.size());
    words_.resize(words_.size() + (wide ? 2 : 1));
    constant_.resize(words_.size());
    return index;
}

std::vector<bool> scalarValues(const ir::Program& program) {
    const std::vector<ir::Rate> rates = ir::computeRates(program);
    std::vector<bool> scalar(rates.size());
    std::transform(rates.begin(), rates.end(), scalar.begin(), [](ir::Rate r) { return r != ir::Rate::invocation; });
    return scalar;
}

namespace {

/// The target blocks of a program and the facts about its values that both pieces share.
struct Facts {
    explicit Facts(const ir::Program& p)
        : program(p), cfg(p), scalar(scalarValues(p)), definition(p.valueTypes.size()), uses(p.valueTypes.size()) {
        for (const ir::Block& block : p.blocks) {
            for (const ir::Inst& inst : block.insts) {
                if (inst.result != ir::kNoValue) definition[inst.result] = &inst;
                for (const ir::ValueId value : p.operandsOf(inst)) ++uses[value];
            }
        }
    }

    const ir::Program& program;
    ir::Cfg cfg;
    std::vector<bool> scalar;
    std::vector<const ir::Inst*> definition;  // of the first result
    std::vector<uint32_t> uses;
};

bool isConversion(ir::Op op) {
    return op == ir::Op::ftof || op == ir::Op::zext || op == ir::Op::sext || op == ir::Op::itrunc;
}

/// Lowers one piece. In draw-rate code every value but a constant is in a row.
class Lowerer {
  public:
    Lowerer(const Facts& facts, ScalarFile& scalars, std::vector<uint32_t>& scalarIndex, bool draw, MachineCode& code)
        : facts_(facts), program_(facts.program), scalars_(scalars), scalarIndex_(scalarIndex), draw_(draw),
          code_(code), registers_(facts.program.valueTypes.size(), kNone) {
        code_.inputs.assign(program_.inputs.size(), kNone);
        code_.outputs.assign(program_.outputs.size(), kNone);
    }

    void lowerBatch();
    /// Emits the definitions that `wanted` names and everything they need, and keeps them in the scalar file.
    void lowerDraw(const std::vector<bool>& wanted);
    /// The name of the first operation there is no way to run; empty if all is well.
    const std::string& unsupported() const { return unsupported_; }

  private:
    // Values.
    bool isScalar(ir::ValueId value) const {
        const ir::Inst* inst = facts_.definition[value];
        const bool constant = inst != nullptr && (inst->op == ir::Op::constant || inst->op == ir::Op::undef);
        return constant || (!draw_ && facts_.scalar[value]);
    }
    bool isWide(ir::ValueId value) const { return ir::isWide(program_.valueTypes[value]); }
    uint32_t scalarOf(ir::ValueId value);
    uint32_t newRegister(bool wide);
    uint32_t registerOf(ir::ValueId value);
    /// A row with the value: its own, or a temporary one into which a scalar is spread.
    Operand rowOf(ir::ValueId value);
    Operand wordOf(ir::ValueId value, uint8_t word);
    Operand operandOf(ir::ValueId value) { return wordOf(value, 0); }
    Operand target(const ir::Inst& inst) { return Operand::write(registerOf(inst.result)); }

    // Instructions.
    MachineInst& emit(Op op, std::vector<Operand> operands);
    void emitMove(const Operand& to, const Operand& from) {
        emit(from.isScalar() ? Op::broadcast : Op::copy, {to, from});
    }
    void lowerInst(const ir::Inst& inst);
    bool lowerFused(const ir::Inst& inst);
    void lowerElement(const ir::Inst& inst, Op op);
    void emitVector(Op op, const Operand& to, std::vector<Operand> from);
    void lowerWords(const ir::Inst& inst);
    void lowerImage(const ir::Inst& inst);
    void lowerAtomic(const ir::Inst& inst);
    void lowerLocal(const ir::Inst& inst);
    void lowerOutput(const ir::Inst& inst);
    void lowerInputIndexed(const ir::Inst& inst);
    void lowerInterpolation(const ir::Inst& inst);

    // Control flow.
    void planBlocks();
    void planOutputs();
    void lowerTerminator(ir::BlockId block);
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
    std::vector<uint32_t>& scalarIndex_;  // by value
    const bool draw_;
    MachineCode& code_;
    std::vector<uint32_t> registers_;  // by value
    uint32_t loop_ = kNone;            // header of the loop being lowered
    uint32_t line_ = 0;
    std::vector<bool> fused_;          // values that only exist inside a superinstruction
    std::vector<bool> fallsIn_;        // blocks that run on from the block before, with its mask
    std::vector<bool> full_;           // blocks that every lane runs first
    std::vector<uint32_t> endLabels_, loopLabels_, headLabels_;  // by block
    struct OutputPlan {
        uint32_t stores = 0;
        bool alias = false;
    };
    std::vector<OutputPlan> outputPlans_;
    ir::BlockId block_ = 0;
    std::string unsupported_;
};

uint32_t Lowerer::scalarOf(ir::ValueId value) {
    uint32_t& index = scalarIndex_[value];
    if (index != kNone) return index;
    const ir::Inst* inst = facts_.definition[value];
    if (inst != nullptr && inst->op == ir::Op::constant) return index = scalars_.constant(inst->imm, isWide(value));
    if (inst == nullptr || inst->op == ir::Op::undef) return index = scalars_.constant(0, isWide(value));
    return index = scalars_.reserve(isWide(value));
}

uint32_t Lowerer::newRegister(bool wide) {
    code_.registers.push_back({wide, loop_});
    return static_cast<uint32_t>(code_.registers.size() - 1);
}

uint32_t Lowerer::registerOf(ir::ValueId value) {
    uint32_t& index = registers_[value];
    if (index == kNone) index = newRegister(isWide(value));
    return index;
}

Operand Lowerer::wordOf(ir::ValueId value, uint8_t word) {
    if (isScalar(value)) return Operand::scalar(scalarOf(value) + word);
    return Operand::read(registerOf(value), word);
}

Operand Lowerer::rowOf(ir::ValueId value) {
    if (!isScalar(value)) return Operand::read(registerOf(value));
    const uint32_t temporary = newRegister(isWide(value));
    emit(Op::broadcast, {Operand::write(temporary), wordOf(value, 0)});
    if (isWide(value)) emit(Op::broadcast, {Operand::write(temporary, 1), wordOf(value, 1)});
    return Operand::read(temporary);
}

MachineInst& Lowerer::emit(Op op, std::vector<Operand> operands) {
    MachineInst inst;
    inst.op = op;
    inst.operands = std::move(operands);
    inst.line = line_;
    code_.insts.push_back(std::move(inst));
    return code_.insts.back();
}

void Lowerer::emitVector(Op op, const Operand& to, std::vector<Operand> from) {
    const auto isScalarOperand = [](const Operand& o) { return o.isScalar(); };
    if (std::all_of(from.begin(), from.end(), isScalarOperand)) {
        const uint32_t temporary = newRegister(false);
        emit(Op::broadcast, {Operand::write(temporary), from[0]});
        from[0] = Operand::read(temporary);
    }
    uint8_t form = 0;
    for (size_t k = 0; k < from.size(); ++k) form |= static_cast<uint8_t>(from[k].isScalar() ? 1 << k : 0);
    from.insert(from.begin(), to);
    emit(op, std::move(from)).form = form;
}

void Lowerer::lowerElement(const ir::Inst& inst, Op op) {
    const auto operands = program_.operandsOf(inst);
    std::vector<Operand> from;
    if (isVectorOp(op)) {
        for (const ir::ValueId value : operands) from.push_back(operandOf(value));
        emitVector(op, target(inst), std::move(from));
        return;
    }
    for (const ir::ValueId value : operands) from.push_back(rowOf(value));
    from.insert(from.begin(), target(inst));
    // A 64-bit row pair may overlap another one shifted by a row: such operations never work in place.
    emit(op, std::move(from)).inPlace = !isWideOp(op);
}

/// Operations that only move words: copies, halves of wide values, and select and b1 logic on them.
void Lowerer::lowerWords(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const bool wide = ir::isWide(inst.type);
    const bool renames = inst.op != ir::Op::select && isWide(operands[0]) == wide && inst.op != ir::Op::makeWide &&
                         inst.op != ir::Op::lowWord && inst.op != ir::Op::highWord;
    if (renames && !isScalar(operands[0])) {
        registers_[inst.result] = registerOf(operands[0]);
        return;
    }
    const uint32_t to = registerOf(inst.result);
    switch (inst.op) {
        case ir::Op::makeWide:
            emitMove(Operand::write(to, 0), operandOf(operands[0]));
            emitMove(Operand::write(to, 1), operandOf(operands[1]));
            return;
        case ir::Op::lowWord: return emitMove(Operand::write(to), wordOf(operands[0], 0));
        case ir::Op::highWord: return emitMove(Operand::write(to), wordOf(operands[0], 1));
        case ir::Op::select:
            for (uint8_t word = 0; word <= (wide ? 1 : 0); ++word) {
                emitVector(Op::select, Operand::write(to, word),
                           {operandOf(operands[0]), wordOf(operands[1], word), wordOf(operands[2], word)});
            }
            return;
        default:  // renaming a scalar, itrunc
            for (uint8_t word = 0; word <= (wide ? 1 : 0); ++word) {
                emitMove(Operand::write(to, word), wordOf(operands[0], word));
            }
            return;
    }
}

bool Lowerer::lowerFused(const ir::Inst& inst) {
    const std::optional<Fusion> fusion = findFusion(program_, facts_.definition, fused_, facts_.scalar, inst);
    if (!fusion) return false;
    if (fusion->op == Op::multiplyAdd || fusion->op == Op::multiplySubtract || fusion->op == Op::subtractMultiply) {
        emitVector(fusion->op, target(inst),
                   {operandOf(fusion->operands[0]), operandOf(fusion->operands[1]), operandOf(fusion->operands[2])});
        return true;
    }
    std::vector<Operand> operands{target(inst)};
    for (const ir::ValueId value : fusion->operands) operands.push_back(operandOf(value));
    emit(fusion->op, std::move(operands));
    return true;
}

void Lowerer::lowerInst(const ir::Inst& inst) {
    line_ = inst.line;
    const auto operands = program_.operandsOf(inst);
    if (inst.result != ir::kNoValue) {
        if (isScalar(inst.result)) return;  // constants, and in batch code what the draw-rate code computes
        if (inst.result < fused_.size() && fused_[inst.result]) return;
    }
    if (lowerFused(inst)) return;
    switch (inst.op) {
        case ir::Op::phi: return;
        case ir::Op::input: {
            uint32_t& reg = code_.inputs[inst.imm];
            if (reg == kNone) {
                reg = newRegister(false);
                code_.registers[reg].loop = kNone;
            }
            registers_[inst.result] = reg;
            return;
        }
        case ir::Op::inputIndexed: return lowerInputIndexed(inst);
        case ir::Op::copy:
        case ir::Op::bitcast:
        case ir::Op::makeWide:
        case ir::Op::lowWord:
        case ir::Op::highWord:
        case ir::Op::itrunc:
        case ir::Op::select: return lowerWords(inst);
        case ir::Op::loadBuffer: {
            const Operand descriptor = operandOf(operands[0]), offset = operandOf(operands[1]);
            emit(Op::loadBuffer, {target(inst), descriptor, offset, Operand::number(static_cast<uint32_t>(inst.imm))})
                .form = static_cast<uint8_t>(descriptor.isScalar() | offset.isScalar() << 1);
            return;
        }
        case ir::Op::storeBuffer: {
            const Operand descriptor = operandOf(operands[0]), offset = operandOf(operands[1]);
            const Operand value = rowOf(operands[2]);
            emit(Op::storeBuffer, {descriptor, offset, value, Operand::number(static_cast<uint32_t>(inst.imm))}).form =
                static_cast<uint8_t>(descriptor.isScalar() | offset.isScalar() << 1);
            return;
        }
        case ir::Op::bufferSize: {
            const Operand descriptor = operandOf(operands[0]);
            emit(Op::bufferSize, {target(inst), descriptor, Operand::number(static_cast<uint32_t>(inst.imm))}).form =
                descriptor.isScalar();
            return;
        }
        case ir::Op::atomicBuffer: return lowerAtomic(inst);
        case ir::Op::loadLocal:
        case ir::Op::storeLocal: return lowerLocal(inst);
        case ir::Op::image:
        case ir::Op::imageStore: return lowerImage(inst);
        case ir::Op::ddxFine: emit(Op::ddxFine, {target(inst), rowOf(operands[0])}); return;
        case ir::Op::ddyFine: emit(Op::ddyFine, {target(inst), rowOf(operands[0])}); return;
        case ir::Op::ddxCoarse: emit(Op::ddxCoarse, {target(inst), rowOf(operands[0])}); return;
        case ir::Op::ddyCoarse: emit(Op::ddyCoarse, {target(inst), rowOf(operands[0])}); return;
        case ir::Op::interpolateAtCentroid:
        case ir::Op::interpolateAtSample:
        case ir::Op::interpolateAtOffset: return lowerInterpolation(inst);
        case ir::Op::storeOutput: return lowerOutput(inst);
        case ir::Op::demote: emit(Op::discard, {}); return;
        case ir::Op::isHelper: emit(Op::helperLanes, {target(inst)}); return;
        case ir::Op::jump:
        case ir::Op::branch:
        case ir::Op::switchOn:
        case ir::Op::ret:
        case ir::Op::kill: return;  // lowerTerminator
        default: break;
    }
    if (isConversion(inst.op) && program_.valueTypes[operands[0]] == inst.type) return lowerWords(inst);
    if (const std::optional<Op> op = elementOp(program_, inst)) return lowerElement(inst, *op);
    if (unsupported_.empty()) unsupported_ = ir::opInfo(inst.op).name;
}

void Lowerer::lowerAtomic(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const auto operation = static_cast<ir::AtomicOp>(inst.imm >> 32);
    const Operand descriptor = rowOf(operands[0]), offset = rowOf(operands[1]);
    const Operand value = operands.size() > 2 ? rowOf(operands[2]) : offset;
    const Operand comparator = operands.size() > 3 ? rowOf(operands[3]) : value;
    emit(Op::atomicBuffer,
         {target(inst), descriptor, offset, Operand::number(static_cast<uint32_t>(inst.imm)),
          Operand::number(static_cast<uint32_t>(operation)), value, comparator})
        .inPlace = false;
}

void Lowerer::lowerLocal(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const Operand first = Operand::number(ir::immLow(inst)), words = Operand::number(ir::immHigh(inst));
    const Operand index = operandOf(operands[0]);
    if (inst.op == ir::Op::loadLocal) {
        emit(index.isScalar() ? Op::loadLocalScalar : Op::loadLocal, {target(inst), index, first, words});
    } else {
        const Operand value = rowOf(operands[1]);
        emit(index.isScalar() ? Op::storeLocalScalar : Op::storeLocal, {index, value, first, words});
    }
}

void Lowerer::lowerInputIndexed(const ir::Inst& inst) {
    const uint32_t first = ir::immLow(inst), count = ir::immHigh(inst);
    std::vector<Operand> rows;
    for (uint32_t k = 0; k < count; ++k) {
        uint32_t& reg = code_.inputs[first + k];
        if (reg == kNone) {
            reg = newRegister(false);
            code_.registers[reg].loop = kNone;
        }
        rows.push_back(Operand::read(reg));
    }
    const Operand index = rowOf(program_.operandsOf(inst)[0]);
    MachineInst& out = emit(Op::inputIndexed, {target(inst), index, Operand::number(code_.indexedRows),
                                               Operand::number(count)});
    out.inPlace = false;
    out.hidden = std::move(rows);
    code_.indexedRows += count;
}

void Lowerer::lowerInterpolation(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const Operand a = operands.empty() ? Operand{} : rowOf(operands[0]);
    const Operand b = operands.size() < 2 ? Operand{} : rowOf(operands[1]);
    const uint32_t where = inst.op == ir::Op::interpolateAtCentroid ? 0 : inst.op == ir::Op::interpolateAtSample ? 1 : 2;
    emit(Op::interpolate,
         {target(inst), a, b, Operand::number(static_cast<uint32_t>(inst.imm)), Operand::number(where)})
        .inPlace = false;
}

void Lowerer::lowerImage(const ir::Inst& inst) {
    const ir::ImageOp& op = program_.imageOps[inst.imm];
    const ir::ImageOperands places = ir::imageOperands(op);
    const auto operands = program_.operandsOf(inst);
    const auto row = [&](uint32_t place) { return place == ir::kNoIndex ? Operand{} : rowOf(operands[place]); };
    const auto rows = [&](uint32_t place, uint32_t count, uint32_t room, std::vector<Operand>& to) {
        for (uint32_t k = 0; k < room; ++k) {
            to.push_back(place != ir::kNoIndex && k < count ? rowOf(operands[place + k]) : Operand{});
        }
    };
    std::vector<Operand> hidden{row(places.image), row(places.sampler)};
    rows(places.coords, op.coords, 4, hidden);
    hidden.push_back(row(places.dref));
    hidden.push_back(row(places.lodOrBias));
    rows(places.gradients, op.gradients, 3, hidden);
    const uint32_t ddy = places.gradients == ir::kNoIndex ? ir::kNoIndex : places.gradients + op.gradients;
    rows(ddy, op.gradients, 3, hidden);
    rows(places.offsets, op.offsets, 3, hidden);
    hidden.push_back(row(places.sample));
    const uint32_t values = places.values == ir::kNoIndex ? 0 : static_cast<uint32_t>(operands.size()) - places.values;
    rows(places.values, values, 4, hidden);
    for (uint32_t k = 0; k < 4; ++k) {
        const bool wanted = inst.result != ir::kNoValue && facts_.uses[inst.result + k] != 0;
        hidden.push_back(wanted ? Operand::write(registerOf(inst.result + k)) : Operand{});
    }
    MachineInst& out = emit(Op::image, {Operand::number(static_cast<uint32_t>(code_.imageSites.size()))});
    out.inPlace = false;
    out.hidden = std::move(hidden);
    ImageSite site;
    site.op = static_cast<uint32_t>(inst.imm);
    site.effects = op.kind == ir::ImageKind::store || op.kind == ir::ImageKind::atomic;
    code_.imageSites.push_back(site);
}

void Lowerer::lowerOutput(const ir::Inst& inst) {
    const ir::ValueId value = program_.operandsOf(inst)[0];
    uint32_t& reg = code_.outputs[inst.imm];
    if (outputPlans_[inst.imm].alias && !isScalar(value)) {
        reg = registerOf(value);
        return;
    }
    const Operand to = Operand::write(reg), from = operandOf(value);
    if (full_[block_]) return emitMove(to, from);
    emit(from.isScalar() ? Op::broadcastMasked : Op::copyMasked, {to, from, Operand::mask(kCurrentMask)});
}

/// Blocks that continue the block before them under the same mask, and those that all lanes run.
void Lowerer::planBlocks() {
    const auto count = static_cast<ir::BlockId>(program_.blocks.size());
    fallsIn_.assign(count, false);
    full_.assign(count, false);
    endLabels_.resize(count);
    loopLabels_.resize(count);
    headLabels_.resize(count);
    for (ir::BlockId b = 0; b < count; ++b) {
        const ir::Block& block = program_.blocks[b];
        fallsIn_[b] = b > 0 && !block.loopHeader && block.predecessors.size() == 1 && block.predecessors[0] == b - 1 &&
                      program_.blocks[b - 1].insts.back().op == ir::Op::jump &&
                      facts_.cfg.loop[b] == facts_.cfg.loop[b - 1];
        full_[b] = b == 0 || (fallsIn_[b] && full_[b - 1]);
        endLabels_[b] = newLabel();
        loopLabels_[b] = newLabel();
        headLabels_[b] = newLabel();
    }
    code_.masks = 1 + count;
}

/// An output that is stored once, where every lane that is not discarded passes, needs no row of its own.
void Lowerer::planOutputs() {
    outputPlans_.resize(program_.outputs.size());
    uint32_t returns = 0;
    ir::BlockId returning = 0;
    for (ir::BlockId b = 0; b < program_.blocks.size(); ++b) {
        if (program_.blocks[b].insts.back().op == ir::Op::ret) {
            ++returns;
            returning = b;
        }
    }
    std::vector<bool> zeroFirst(program_.outputs.size());
    for (ir::BlockId b = 0; b < program_.blocks.size(); ++b) {
        for (const ir::Inst& inst : program_.blocks[b].insts) {
            if (inst.op != ir::Op::storeOutput) continue;
            OutputPlan& plan = outputPlans_[inst.imm];
            const bool everyLane = full_[b] || (returns == 1 && b == returning);
            if (plan.stores == 0) zeroFirst[inst.imm] = !full_[b];
            plan.alias = plan.stores == 0 && everyLane && facts_.cfg.loop[b] == ir::kNoIndex;
            ++plan.stores;
        }
    }
    for (uint32_t k = 0; k < program_.outputs.size(); ++k) {
        if (outputPlans_[k].stores == 0) continue;
        code_.outputs[k] = newRegister(false);
        // Lanes that do not come past a store: zero, so that nothing depends on what was in the row before.
        if (zeroFirst[k] && !outputPlans_[k].alias) {
            emit(Op::broadcast, {Operand::write(code_.outputs[k]), Operand::scalar(scalars_.constant(0, false))});
        }
    }
}

std::vector<Move> Lowerer::movesOf(ir::BlockId from, size_t successor) {
    const ir::Block& block = program_.blocks[from];
    const ir::BlockId to = block.successors[successor];
    // The n-th edge from `from` to `to` is the n-th entry of `from` among the predecessors of `to`.
    const auto earlier = std::count(block.successors.begin(),
                                    block.successors.begin() + static_cast<ptrdiff_t>(successor), to);
    const auto& predecessors = program_.blocks[to].predecessors;
    size_t edge = 0;
    for (auto left = earlier; edge < predecessors.size(); ++edge) {
        if (predecessors[edge] == from && left-- == 0) break;
    }
    std::vector<Move> moves;
    for (const ir::Inst& phi : program_.blocks[to].insts) {
        if (phi.op != ir::Op::phi) break;
        const ir::ValueId source = program_.operandsOf(phi)[edge];
        const uint32_t reg = registers_[phi.result];
        for (uint8_t word = 0; word <= (ir::isWide(phi.type) ? 1 : 0); ++word) {
            moves.push_back({Operand::write(reg, word), wordOf(source, word)});
        }
    }
    return moves;
}

void Lowerer::emitMoves(std::vector<Move> moves, uint32_t mask) {
    sequentialise(
        std::move(moves),
        [&](const Move& move) {
            if (full_[block_] && mask == kCurrentMask) return emitMove(move.to, move.from);
            emit(move.from.isScalar() ? Op::broadcastMasked : Op::copyMasked, {move.to, move.from, Operand::mask(mask)});
        },
        [&](const Operand& row) {
            const uint32_t temporary = newRegister(false);
            emit(Op::copy, {Operand::write(temporary), Operand::read(row.id, row.word)});
            return Operand::read(temporary);
        });
}

uint32_t Lowerer::edgeMask(ir::BlockId from, size_t successor) {
    const ir::BlockId to = program_.blocks[from].successors[successor];
    const bool moves = program_.blocks[to].insts.front().op == ir::Op::phi;
    return moves ? code_.masks++ : maskOf(to);
}

void Lowerer::lowerEdge(ir::BlockId from, size_t successor, uint32_t mask) {
    const ir::BlockId to = program_.blocks[from].successors[successor];
    if (mask == maskOf(to)) return;
    const uint32_t label = newLabel();
    emit(Op::skipEmpty, {Operand::mask(mask), Operand::label(label)});
    emitMoves(movesOf(from, successor), mask);
    emit(Op::follow, {Operand::mask(maskOf(to)), Operand::mask(mask)});
    bind(label);
}

void Lowerer::lowerTerminator(ir::BlockId b) {
    const ir::Block& block = program_.blocks[b];
    const ir::Inst& last = block.insts.back();
    line_ = last.line;
    const auto operands = program_.operandsOf(last);
    switch (last.op) {
        case ir::Op::jump: {
            emitMoves(movesOf(b, 0), kCurrentMask);
            const ir::BlockId to = block.successors[0];
            if (!(to == b + 1 && fallsIn_[to])) emit(Op::leave, {Operand::mask(maskOf(to))});
            return;
        }
        case ir::Op::branch: {
            const Operand condition = operandOf(operands[0]);
            const uint32_t yes = edgeMask(b, 0), no = edgeMask(b, 1);
            emit(condition.isScalar() ? Op::splitScalar : Op::split,
                 {condition, Operand::mask(yes), Operand::mask(no)});
            lowerEdge(b, 0, yes);
            lowerEdge(b, 1, no);
            return;
        }
        case ir::Op::switchOn: {
            const Operand selector = operandOf(operands[0]);
            std::vector<uint32_t> masks(block.successors.size());
            for (size_t k = 0; k < block.cases.size(); ++k) {
                masks[k + 1] = edgeMask(b, k + 1);
                const uint32_t wanted = scalars_.constant(static_cast<uint32_t>(block.cases[k]), false);
                emit(Op::choose, {selector, Operand::scalar(wanted), Operand::mask(masks[k + 1])}).form =
                    selector.isScalar();
            }
            masks[0] = edgeMask(b, 0);
            emit(Op::leave, {Operand::mask(masks[0])});
            for (size_t k = 0; k < masks.size(); ++k) lowerEdge(b, k, masks[k]);
            return;
        }
        case ir::Op::kill: emit(Op::discard, {}); return;
        default: return;  // ret: the lanes go nowhere
    }
}

void Lowerer::lowerBatch() {
    const auto count = static_cast<ir::BlockId>(program_.blocks.size());
    fused_ = fusedValues(program_, facts_.definition, facts_.uses, facts_.scalar);
    planBlocks();
    planOutputs();
    // Phis first: edges name them before their block comes. A loop's own phis live through all of its rounds.
    for (ir::BlockId b = 0; b < count; ++b) {
        const uint32_t loop = facts_.cfg.loop[b];
        loop_ = program_.blocks[b].loopHeader ? facts_.cfg.loopParent[b] : loop;
        for (const ir::Inst& inst : program_.blocks[b].insts) {
            if (inst.op != ir::Op::phi) break;
            const uint32_t reg = registerOf(inst.result);
            if (program_.blocks[b].loopHeader) code_.registers[reg].phiOf = b;
        }
    }
    std::vector<size_t> open;  // indices into code_.loops
    for (ir::BlockId b = 0; b < count; ++b) {
        const ir::Block& block = program_.blocks[b];
        block_ = b;
        if (block.loopHeader) {
            MachineLoop loop;
            loop.header = b;
            loop.parent = facts_.cfg.loopParent[b];
            loop.begin = static_cast<uint32_t>(code_.insts.size());
            loop.backEdges = static_cast<uint32_t>(
                std::count_if(block.predecessors.begin(), block.predecessors.end(), [&](auto p) { return p >= b; }));
            open.push_back(code_.loops.size());
            code_.loops.push_back(loop);
        }
        loop_ = facts_.cfg.loop[b];
        if (b > 0 && !fallsIn_[b]) {
            bind(headLabels_[b]);
            ir::BlockId last = b;
            while (last + 1 < count && fallsIn_[last + 1]) ++last;
            const uint32_t skip = block.loopHeader ? loopLabels_[b] : endLabels_[last];
            emit(Op::enter, {Operand::mask(maskOf(b)), Operand::label(skip)});
        }
        for (const ir::Inst& inst : block.insts) lowerInst(inst);
        lowerTerminator(b);
        bind(endLabels_[b]);
        while (!open.empty() && program_.blocks[code_.loops[open.back()].header].loopEnd == b + 1) {
            MachineLoop& loop = code_.loops[open.back()];
            emit(Op::repeat, {Operand::mask(maskOf(loop.header)), Operand::label(headLabels_[loop.header])});
            loop.end = static_cast<uint32_t>(code_.insts.size() - 1);
            bind(loopLabels_[loop.header]);
            open.pop_back();
        }
    }
    emit(Op::end, {});
}

void Lowerer::lowerDraw(const std::vector<bool>& wanted) {
    std::vector<bool> needed = wanted;
    for (size_t b = program_.blocks.size(); b-- > 0;) {
        const auto& insts = program_.blocks[b].insts;
        for (size_t k = insts.size(); k-- > 0;) {
            const ir::Inst& inst = insts[k];
            if (inst.result == ir::kNoValue || !needed[inst.result]) continue;
            for (const ir::ValueId value : program_.operandsOf(inst)) needed[value] = true;
        }
    }
    for (const ir::Block& block : program_.blocks) {
        for (const ir::Inst& inst : block.insts) {
            if (inst.result == ir::kNoValue || !needed[inst.result]) continue;
            lowerInst(inst);
            if (!wanted[inst.result] || isScalar(inst.result)) continue;
            for (uint8_t word = 0; word <= (isWide(inst.result) ? 1 : 0); ++word) {
                emit(Op::keepScalar, {Operand::number(scalarIndex_[inst.result] + word), wordOf(inst.result, word)});
            }
        }
    }
    emit(Op::end, {});
}

}  // namespace

Result<LoweredProgram> lower(const ir::Program& program) {
    LoweredProgram lowered;
    const Facts facts(program);
    std::vector<uint32_t> scalarIndex(program.valueTypes.size(), kNone);
    Lowerer batch(facts, lowered.scalars, scalarIndex, false, lowered.batch);
    batch.lowerBatch();
    std::vector<bool> wanted(program.valueTypes.size());
    for (size_t v = 0; v < wanted.size(); ++v) wanted[v] = scalarIndex[v] != kNone;
    Lowerer draw(facts, lowered.scalars, scalarIndex, true, lowered.draw);
    draw.lowerDraw(wanted);
    for (const Lowerer* piece : {&batch, &draw}) {
        if (!piece->unsupported().empty()) {
            return unsupported("IR of '" + program.name + "': the batch interpreter cannot run " + piece->unsupported() +
                               " on operands of this type");
        }
    }
    return lowered;
}

}  // namespace vernier::batch
