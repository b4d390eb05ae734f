#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

/// x times 2^exponent, if that is exact and both are normal numbers.
std::optional<float> scaled(float x, int exponent) {
    const float result = std::ldexp(x, exponent);
    if (!std::isnormal(x) || !std::isnormal(result)) return std::nullopt;
    return result;
}

class Reducer {
  public:
    explicit Reducer(Program& program) : program_(program), uses_(program.valueTypes.size()) {
        definition_.resize(program.valueTypes.size());
        for (Block& block : program.blocks) {
            for (Inst& inst : block.insts) {
                if (inst.result != kNoValue) definition_[inst.result] = &inst;
                for (const ValueId operand : program.operandsOf(inst)) ++uses_[operand];
            }
        }
    }

    bool run() {
        std::vector<std::pair<size_t, std::vector<Inst>>> blocks;
        for (size_t b = 0; b < program_.blocks.size(); ++b) {
            made_.clear();
            bool divides = false;
            for (Inst& inst : program_.blocks[b].insts) {
                if (inst.type == Type::f32 && inst.op == Op::fmul) scaleField(inst);
                if (inst.type == Type::f32 && (inst.op == Op::fmod || inst.op == Op::frem))
                    divides |= divideByPower(inst);
                made_.push_back(inst);
            }
            // Instructions are looked at through definition_: blocks change when all is done.
            if (divides) blocks.emplace_back(b, std::move(made_));
        }
        for (auto& [b, insts] : blocks) program_.blocks[b].insts = std::move(insts);
        auto& entry = program_.blocks[0].insts;
        entry.insert(entry.begin(), constants_.begin(), constants_.end());
        return changed_;
    }

  private:
    Program& program_;
    std::vector<Inst*> definition_;
    std::vector<uint32_t> uses_;
    std::map<std::pair<Type, uint64_t>, ValueId> constantOf_;
    std::vector<Inst> constants_, made_;
    bool changed_ = false;

    ValueId& operand(const Inst& inst, size_t k) { return program_.operands[inst.firstOperand + k]; }

    /// nullptr for what this pass has made.
    Inst* definition(ValueId value) const { return value < definition_.size() ? definition_[value] : nullptr; }
    /// The definition of a value that has one use, if it is this operation.
    Inst* only(ValueId value, Op op) const {
        Inst* inst = definition(value);
        return inst != nullptr && inst->op == op && uses_[value] == 1 ? inst : nullptr;
    }
    const uint64_t* constantBits(ValueId value) const {
        const Inst* inst = definition(value);
        return inst != nullptr && inst->op == Op::constant ? &inst->imm : nullptr;
    }
    /// Which of the first two operands is a constant; the other one is not.
    std::optional<size_t> constantOperand(const Inst& inst) {
        for (const size_t k : {0, 1}) {
            if (constantBits(operand(inst, k)) != nullptr && constantBits(operand(inst, 1 - k)) == nullptr) return k;
        }
        return std::nullopt;
    }

    ValueId constant(Type type, uint64_t bits) {
        const auto [found, isNew] = constantOf_.try_emplace({type, bits}, kNoValue);
        if (isNew) {
            Inst inst;
            inst.op = Op::constant;
            inst.type = type;
            inst.imm = bits;
            inst.result = found->second = program_.newValue(type);
            constants_.push_back(inst);
        }
        return found->second;
    }
    ValueId constant(float value) { return constant(Type::f32, std::bit_cast<uint32_t>(value)); }

    /// float((x >> s) & m) * c is float(x & (m << s)) * (c / 2^s): both factors are the others times a power of two,
    /// and rounding a product of the same value gives the same bits. The masked word must be positive.
    void scaleField(Inst& product) {
        const std::optional<size_t> factor = constantOperand(product);
        if (!factor) return;
        const Inst* conversion = only(operand(product, 1 - *factor), Op::stof);
        if (conversion == nullptr || static_cast<Type>(conversion->imm) != Type::i32) return;
        Inst* masked = only(operand(*conversion, 0), Op::iand);
        if (masked == nullptr) return;
        const std::optional<size_t> mask = constantOperand(*masked);
        if (!mask) return;
        const Inst* shifted = definition(operand(*masked, 1 - *mask));
        if (shifted == nullptr || shifted->op != Op::lshr) return;
        const uint64_t* shift = constantBits(operand(*shifted, 1));
        if (shift == nullptr || *shift > 31) return;
        const uint64_t wide = *constantBits(operand(*masked, *mask)) << *shift;
        const auto scale = scaled(std::bit_cast<float>(static_cast<uint32_t>(*constantBits(operand(product, *factor)))),
                                  -static_cast<int>(*shift));
        if (wide > INT32_MAX || !scale) return;
        operand(*masked, 1 - *mask) = operand(*shifted, 0);
        operand(*masked, *mask) = constant(Type::i32, wide);
        operand(product, *factor) = constant(*scale);
        changed_ = true;
    }

    ValueId make(const Inst& like, Op op, std::initializer_list<ValueId> operands) {
        Inst inst = like;
        inst.op = op;
        inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
        inst.operandCount = static_cast<uint16_t>(operands.size());
        program_.operands.insert(program_.operands.end(), operands);
        inst.result = program_.newValue(like.type);
        made_.push_back(inst);
        return inst.result;
    }

    /// x - c * floor(x / c), or of the quotient cut off, with a product in the place of the quotient.
    bool divideByPower(Inst& inst) {
        const uint64_t* bits = constantBits(operand(inst, 1));
        if (bits == nullptr) return false;
        const float divisor = std::bit_cast<float>(static_cast<uint32_t>(*bits));
        int exponent = 0;
        if (std::fabs(std::frexp(divisor, &exponent)) != 0.5f || !std::isnormal(divisor) || !std::isnormal(1 / divisor))
            return false;
        const ValueId x = operand(inst, 0), c = operand(inst, 1);
        const ValueId quotient = make(inst, Op::fmul, {x, constant(1 / divisor)});
        const ValueId whole = make(inst, inst.op == Op::fmod ? Op::ffloor : Op::ftrunc, {quotient});
        const ValueId product = make(inst, Op::fmul, {c, whole});
        inst.op = Op::fsub;
        operand(inst, 1) = product;
        changed_ = true;
        return true;
    }
};

}  // namespace

bool reduceStrength(Program& program) {
    return Reducer(program).run();
}

}  // namespace vernier::ir
