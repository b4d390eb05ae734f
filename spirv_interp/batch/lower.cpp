#include "spirv_interp/batch/lower.h"

#include <algorithm>
#include <optional>
#include <string>

#include "spirv_interp/batch/lowerer.h"

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

uint32_t Lowerer::scalarOf(ir::ValueId value) {
    uint32_t& index = scalarIndex_[value];
    if (index != kNone) return index;
    const ir::Inst* inst = facts_.definition[value];
    if (inst != nullptr && inst->op == ir::Op::constant) return index = scalars_.constant(inst->imm, isWide(value));
    if (inst == nullptr || inst->op == ir::Op::undef) return index = scalars_.constant(0, isWide(value));
    if (inst->op == ir::Op::input) {
        uint32_t& place = inputScalars_[inst->imm];
        if (place == kNone) place = scalars_.reserve(false);
        return index = place;
    }
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
    // What is known before the piece stays as it is: a block spreads it once.
    const bool stays = isGiven(value);
    const auto known = spread_.find(value);
    if (stays && known != spread_.end()) return Operand::read(known->second);
    const uint32_t temporary = newRegister(isWide(value));
    if (stays) spread_[value] = temporary;
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
    const bool commutative = formSet(op) == FormSet::commutative;
    // There are no forms for two scalar factors, nor for scalars alone.
    const size_t scalarsBarred = commutative ? std::min<size_t>(from.size(), 2) : from.size();
    if (std::all_of(from.begin(), from.begin() + static_cast<ptrdiff_t>(scalarsBarred), isScalarOperand)) {
        const uint32_t temporary = newRegister(false);
        emit(Op::broadcast, {Operand::write(temporary), from[0]});
        from[0] = Operand::read(temporary);
    }
    if (commutative && from[0].isScalar()) std::swap(from[0], from[1]);
    from.insert(from.begin(), to);
    emit(op, std::move(from));
}

void Lowerer::lowerStraight() {
    std::vector<bool> wanted(program_.valueTypes.size());
    for (ir::ValueId v = 0; v < wanted.size(); ++v) {
        wanted[v] = scalarIndex_[v] != kNone && facts_.rates[v] == rate_ && !isGiven(v);
    }
    std::vector<bool> needed = wanted;
    for (size_t b = program_.blocks.size(); b-- > 0;) {
        const auto& insts = program_.blocks[b].insts;
        for (size_t k = insts.size(); k-- > 0;) {
            const ir::Inst& inst = insts[k];
            if (inst.result == ir::kNoValue || !needed[inst.result] || isGiven(inst.result)) continue;
            for (const ir::ValueId value : program_.operandsOf(inst)) needed[value] = true;
        }
    }
    for (const ir::Block& block : program_.blocks) {
        for (const ir::Inst& inst : block.insts) {
            if (inst.result == ir::kNoValue || !needed[inst.result] || isGiven(inst.result)) continue;
            lowerInst(inst);
            if (takesScalars(program_, inst) || (isWide(inst.result) && !wanted[inst.result])) continue;
            for (uint8_t word = 0; word <= (isWide(inst.result) ? 1 : 0); ++word) {
                emit(Op::keepScalar,
                     {Operand::number(scalarOf(inst.result) + word), Operand::read(registerOf(inst.result), word)});
            }
        }
    }
    emit(Op::end, {});
}

Result<LoweredProgram> lower(const ir::Program& program, bool packed) {
    LoweredProgram lowered;
    lowered.inputScalars.assign(program.inputs.size(), kNone);
    const Facts facts(program, packed);
    // A piece asks for scalars of the rates below its own: it is lowered before theirs.
    std::vector<uint32_t> scalarIndex(program.valueTypes.size(), kNone);
    Lowerer batch(facts, lowered, scalarIndex, ir::Rate::invocation, lowered.batch);
    batch.lowerBatch();
    Lowerer workGroup(facts, lowered, scalarIndex, ir::Rate::workGroup, lowered.workGroup);
    workGroup.lowerStraight();
    Lowerer draw(facts, lowered, scalarIndex, ir::Rate::draw, lowered.draw);
    draw.lowerStraight();
    for (const Lowerer* piece : {&batch, &workGroup, &draw}) {
        if (!piece->unsupported().empty()) {
            return unsupported("IR of '" + program.name + "': the batch interpreter cannot run " +
                               piece->unsupported() + " on operands of this type");
        }
    }
    return lowered;
}

}  // namespace vernier::batch
