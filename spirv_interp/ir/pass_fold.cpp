#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/fold.h"
#include "spirv_interp/ir/halves.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

class Folder {
  public:
    explicit Folder(Program& program)
        : program_(program),
          definition_(program.valueTypes.size(), nullptr),
          replacement_(program.valueTypes.size(), kNoValue) {}

    bool run() {
        for (Block& block : program_.blocks) {
            for (Inst& inst : block.insts) {
                for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) definition_[inst.result + r] = &inst;
                if (inst.op == Op::constant) constants_[static_cast<size_t>(inst.type)].emplace(inst.imm, inst.result);
            }
        }
        for (Block& block : program_.blocks) {
            for (Inst& inst : block.insts) {
                for (uint32_t i = 0; i < inst.operandCount; ++i) {
                    ValueId& operand = program_.operands[inst.firstOperand + i];
                    operand = resolve(replacement_, operand);
                }
                if (opInfo(inst.op).kind == 'P' && inst.operandCount != 0 && inst.op != Op::phi) simplify(inst);
            }
        }
        if (!changed_) return false;
        for (Block& block : program_.blocks) {
            std::erase_if(block.insts, [this](const Inst& inst) {
                return inst.result != kNoValue && inst.op != Op::phi && replacement_[inst.result] != kNoValue;
            });
        }
        auto& entry = program_.blocks[0].insts;
        entry.insert(entry.begin(), added_.begin(), added_.end());
        replaceUses(program_, replacement_);
        return true;
    }

  private:
    Program& program_;
    std::vector<Inst*> definition_;
    std::vector<ValueId> replacement_;
    std::unordered_map<uint64_t, ValueId> constants_[6];
    std::vector<Inst> added_;
    bool changed_ = false;

    ValueId operand(const Inst& inst, uint32_t i) const { return program_.operands[inst.firstOperand + i]; }
    void setOperand(const Inst& inst, uint32_t i, ValueId value) { program_.operands[inst.firstOperand + i] = value; }

    const Inst* definition(ValueId value) const { return value < definition_.size() ? definition_[value] : nullptr; }

    std::optional<uint64_t> bits(ValueId value) const {
        if (const Inst* inst = definition(value)) {
            if (inst->op == Op::constant) return inst->imm;
            return std::nullopt;
        }
        for (const Inst& inst : added_) {
            if (inst.result == value) return inst.imm;
        }
        return std::nullopt;
    }

    ValueId constant(Type type, uint64_t imm) {
        const auto [found, isNew] = constants_[static_cast<size_t>(type)].try_emplace(imm, kNoValue);
        if (!isNew) {
            // A constant outside the entry block need not dominate this place.
            const Inst* inst = definition(found->second);
            const auto& entry = program_.blocks[0].insts;
            const bool inEntry = inst == nullptr || (inst >= entry.data() && inst < entry.data() + entry.size());
            if (inEntry) return found->second;
        }
        Inst inst;
        inst.op = Op::constant;
        inst.type = type;
        inst.imm = imm;
        inst.result = program_.newValue(type);
        replacement_.push_back(kNoValue);
        added_.push_back(inst);
        found->second = inst.result;
        return inst.result;
    }

    void replace(const Inst& inst, ValueId value) {
        replacement_[inst.result] = value;
        changed_ = true;
    }

    /// Makes the instruction another one with as many operands or fewer.
    void rewrite(Inst& inst, Op op, std::initializer_list<ValueId> operands, uint64_t imm = 0) {
        inst.op = op;
        inst.imm = imm;
        inst.operandCount = static_cast<uint16_t>(operands.size());
        uint32_t i = 0;
        for (const ValueId value : operands) setOperand(inst, i++, value);
        changed_ = true;
    }

    /// Whether an f32 is known to hold a binary16 value: looks through so many operations.
    bool isHalf(ValueId value, int depth = 4) const {
        const Inst* const inst = definition(value);
        if (inst == nullptr || replacement_[value] != kNoValue || inst->type != Type::f32) return false;
        switch (inst->op) {
            case Op::ftoh:
            case Op::ftohZero:
            case Op::unpackHalfLow:
            case Op::unpackHalfHigh:
            case Op::quantizeF16:
                return true;
            case Op::constant: {
                // Zeros, and what a normal half is.
                const uint64_t magnitude = inst->imm & 0x7FFFFFFF;
                return magnitude == 0 || (magnitude >= 0x38800000 && magnitude < 0x47800000 && magnitude % 0x2000 == 0);
            }
            case Op::select:
                return areHalves(*inst, 1, depth);
            default:
                return keepsHalves(inst->op) && areHalves(*inst, 0, depth);
        }
    }
    bool areHalves(const Inst& inst, uint32_t firstOperand, int depth) const {
        if (depth == 0) return false;
        for (uint32_t i = firstOperand; i < inst.operandCount; ++i) {
            if (!isHalf(operand(inst, i), depth - 1)) return false;
        }
        return true;
    }

    const Inst* definedBy(ValueId value, Op op) const {
        const Inst* inst = definition(value);
        return inst != nullptr && inst->op == op && replacement_[value] == kNoValue ? inst : nullptr;
    }

    void simplify(Inst& inst) {
        if (inst.op == Op::copy) return replace(inst, operand(inst, 0));
        if (inst.op == Op::inputIndexed) return chooseInput(inst);
        uint64_t known[4] = {};
        std::optional<uint64_t> each[4];
        bool all = inst.operandCount <= 4;
        for (uint32_t i = 0; i < inst.operandCount && i < 4; ++i) {
            each[i] = bits(operand(inst, i));
            known[i] = each[i].value_or(0);
            all = all && each[i].has_value();
        }
        if (all) {
            if (const auto folded = foldConstant(inst.op, inst.type, inst.imm, {known, inst.operandCount})) {
                return replace(inst, constant(inst.type, *folded));
            }
        }
        if (inst.op >= Op::fadd && inst.op <= Op::fsmoothstep) return simplifyFloat(inst, each);
        if (inst.op >= Op::iadd && inst.op <= Op::subBorrow) return simplifyInteger(inst, each);
        simplifyOther(inst, each);
    }

    /// An index that has become constant names one input. Where that has another type, the place is outside of what the
    /// shader declares.
    void chooseInput(Inst& inst) {
        const std::optional<uint64_t> index = bits(operand(inst, 0));
        if (!index) return;
        const auto last = static_cast<int32_t>(immHigh(inst)) - 1;
        const uint64_t slot =
            uint64_t{immLow(inst)} + static_cast<uint32_t>(std::clamp(static_cast<int32_t>(*index), 0, last));
        if (program_.inputs[slot].type == inst.type) rewrite(inst, Op::input, {}, slot);
    }

    static bool isFloatConstant(const std::optional<uint64_t>& bits, Type type, double value) {
        if (!bits) return false;
        return type == Type::f32 ? *bits == std::bit_cast<uint32_t>(static_cast<float>(value))
                                 : *bits == std::bit_cast<uint64_t>(value);
    }

    /// 1 / c when c is a power of two whose reciprocal is a normal number: x / c and x * (1 / c) then round the same
    /// value.
    static std::optional<uint64_t> exactReciprocal(const std::optional<uint64_t>& bits, Type type) {
        if (!bits) return std::nullopt;
        int exponent = 0;
        if (type == Type::f32) {
            const float c = std::bit_cast<float>(static_cast<uint32_t>(*bits));
            if (std::fabs(std::frexp(c, &exponent)) != 0.5f || !std::isnormal(c) || !std::isnormal(1 / c))
                return std::nullopt;
            return std::bit_cast<uint32_t>(1 / c);
        }
        const double c = std::bit_cast<double>(*bits);
        if (std::fabs(std::frexp(c, &exponent)) != 0.5 || !std::isnormal(c) || !std::isnormal(1 / c))
            return std::nullopt;
        return std::bit_cast<uint64_t>(1 / c);
    }

    void simplifyFloat(Inst& inst, const std::optional<uint64_t>* each) {
        const ValueId a = operand(inst, 0), b = inst.operandCount > 1 ? operand(inst, 1) : kNoValue;
        switch (inst.op) {
            case Op::fadd:
                if (isFloatConstant(each[1], inst.type, -0.0)) return replace(inst, a);
                if (isFloatConstant(each[0], inst.type, -0.0)) return replace(inst, b);
                if (const Inst* n = definedBy(b, Op::fneg)) return rewrite(inst, Op::fsub, {a, operand(*n, 0)});
                if (const Inst* n = definedBy(a, Op::fneg)) return rewrite(inst, Op::fsub, {b, operand(*n, 0)});
                return;
            case Op::fsub:
                if (isFloatConstant(each[1], inst.type, 0.0)) return replace(inst, a);
                if (const Inst* n = definedBy(b, Op::fneg)) return rewrite(inst, Op::fadd, {a, operand(*n, 0)});
                return;
            case Op::fmul:
                if (isFloatConstant(each[1], inst.type, 1.0)) return replace(inst, a);
                if (isFloatConstant(each[0], inst.type, 1.0)) return replace(inst, b);
                if (isFloatConstant(each[1], inst.type, -1.0)) return rewrite(inst, Op::fneg, {a});
                if (isFloatConstant(each[0], inst.type, -1.0)) return rewrite(inst, Op::fneg, {b});
                if (const Inst* m = definedBy(a, Op::fneg), *n = definedBy(b, Op::fneg); m != nullptr && n != nullptr) {
                    return rewrite(inst, Op::fmul, {operand(*m, 0), operand(*n, 0)});
                }
                return;
            case Op::fdiv:
                if (isFloatConstant(each[1], inst.type, 1.0)) return replace(inst, a);
                if (const auto reciprocal = exactReciprocal(each[1], inst.type)) {
                    return rewrite(inst, Op::fmul, {a, constant(inst.type, *reciprocal)});
                }
                return;
            case Op::fneg:
                if (const Inst* n = definedBy(a, Op::fneg)) return replace(inst, operand(*n, 0));
                return;
            case Op::fabs:
                if (definedBy(a, Op::fabs) != nullptr) return replace(inst, a);
                if (const Inst* n = definedBy(a, Op::fneg)) return rewrite(inst, Op::fabs, {operand(*n, 0)});
                return;
            default:
                return;
        }
    }

    void simplifyInteger(Inst& inst, const std::optional<uint64_t>* each) {
        const ValueId a = operand(inst, 0), b = inst.operandCount > 1 ? operand(inst, 1) : kNoValue;
        const auto is = [&](int k, uint64_t value) { return each[k] && *each[k] == value; };
        const uint64_t ones = inst.type == Type::i64 ? ~0ull : 0xFFFFFFFFull;
        const uint64_t width = inst.type == Type::i64 ? 64 : 32;
        const bool power = each[1] && std::has_single_bit(*each[1]);
        switch (inst.op) {
            case Op::iadd: {
                if (is(0, 0)) return replace(inst, b);
                if (is(1, 0)) return replace(inst, a);
                // (x + c) + d: offsets into buffers are made of such sums.
                const ValueId inner = each[1] ? a : b;
                const auto outer = each[1] ? each[1] : each[0];
                if (const Inst* sum = definedBy(inner, Op::iadd); sum != nullptr && outer) {
                    for (uint32_t k = 0; k < 2; ++k) {
                        const auto c = bits(operand(*sum, k));
                        if (!c) continue;
                        const ValueId total = constant(inst.type, (*c + *outer) & ones);
                        return rewrite(inst, Op::iadd, {operand(*sum, 1 - k), total});
                    }
                }
                return;
            }
            case Op::isub:
                if (is(1, 0)) return replace(inst, a);
                if (a == b) return replace(inst, constant(inst.type, 0));
                return;
            case Op::imul:
                if (is(0, 0) || is(1, 0)) return replace(inst, constant(inst.type, 0));
                if (is(0, 1)) return replace(inst, b);
                if (is(1, 1)) return replace(inst, a);
                if (power) return shiftBy(inst, Op::shl, a, *each[1]);
                if (each[0] && std::has_single_bit(*each[0])) return shiftBy(inst, Op::shl, b, *each[0]);
                return;
            case Op::udiv:
                if (power) return shiftBy(inst, Op::lshr, a, *each[1]);
                return;
            case Op::umin:
                if (each[1] && mostOf(a) <= *each[1] && inst.type == Type::i32) return replace(inst, a);
                return;
            case Op::umod:
                if (power) return rewrite(inst, Op::iand, {a, constant(inst.type, *each[1] - 1)});
                return;
            case Op::sdiv:
                if (is(1, 1)) return replace(inst, a);
                return;
            case Op::iand:
                if (is(0, ones) || a == b) return replace(inst, b);
                if (is(1, ones)) return replace(inst, a);
                if (is(0, 0) || is(1, 0)) return replace(inst, constant(inst.type, 0));
                return;
            case Op::ior:
                if (is(0, 0) || a == b) return replace(inst, b);
                if (is(1, 0)) return replace(inst, a);
                return;
            case Op::ixor:
                if (is(0, 0)) return replace(inst, b);
                if (is(1, 0)) return replace(inst, a);
                if (a == b) return replace(inst, constant(inst.type, 0));
                return;
            case Op::shl:
            case Op::lshr:
            case Op::ashr:
                if (each[1] && *each[1] % width == 0) return replace(inst, a);
                return;
            case Op::inot:
                if (const Inst* n = definedBy(a, Op::inot)) return replace(inst, operand(*n, 0));
                return;
            case Op::ineg:
                if (const Inst* n = definedBy(a, Op::ineg)) return replace(inst, operand(*n, 0));
                return;
            default:
                return;
        }
    }

    /// No more than this is a 32-bit integer, without a sign.
    uint64_t mostOf(ValueId value, uint32_t depth = 0) const {
        constexpr uint64_t kAll = UINT32_MAX;
        constexpr uint32_t kDeepest = 6;
        const Inst* inst = definition(value);
        if (inst == nullptr) return bits(value).value_or(kAll);
        if (inst->type != Type::i32 || depth == kDeepest) return kAll;
        const auto most = [&](uint32_t k) { return mostOf(operand(*inst, k), depth + 1); };
        const auto known = [&](uint32_t k) { return bits(operand(*inst, k)); };
        const auto unlessWrapped = [](uint64_t sum) { return sum <= kAll ? sum : kAll; };
        switch (inst->op) {
            case Op::constant:
                return inst->imm;
            case Op::input:
                return mostOfInput(program_.inputs[inst->imm]);
            case Op::iand:
            case Op::umin:
                return std::min(most(0), most(1));
            case Op::umax:
            case Op::select:
                return std::max(most(inst->op == Op::select ? 2 : 0), most(1));
            case Op::iadd:
                return unlessWrapped(most(0) + most(1));
            case Op::imul:
                return unlessWrapped(most(0) * most(1));
            case Op::shl:
                return known(1) ? unlessWrapped(most(0) << (*known(1) % 32)) : kAll;
            case Op::lshr:
                return known(1) ? most(0) >> (*known(1) % 32) : kAll;
            case Op::umod:
                return known(1).value_or(0) != 0 ? *known(1) - 1 : kAll;
            case Op::zext:
                return 1;  // from b1
            default:
                return kAll;
        }
    }

    uint64_t mostOfInput(const InterfaceSlot& slot) const {
        switch (slot.builtin) {
            case Builtin::localInvocationId:
                return program_.localSize[slot.component] - 1;
            case Builtin::localInvocationIndex:
                return uint64_t{program_.localSize[0]} * program_.localSize[1] * program_.localSize[2] - 1;
            default:
                return UINT32_MAX;
        }
    }

    void shiftBy(Inst& inst, Op op, ValueId value, uint64_t power) {
        rewrite(inst, op, {value, constant(inst.type, static_cast<uint64_t>(std::countr_zero(power)))});
    }

    void simplifyOther(Inst& inst, const std::optional<uint64_t>* each) {
        const ValueId a = operand(inst, 0), b = inst.operandCount > 1 ? operand(inst, 1) : kNoValue;
        const auto is = [&](int k, uint64_t value) { return each[k] && *each[k] == value; };
        switch (inst.op) {
            case Op::select: {
                const ValueId no = operand(inst, 2);
                if (each[0]) return replace(inst, *each[0] != 0 ? b : no);
                if (b == no) return replace(inst, b);
                if (inst.type == Type::b1 && is(1, kTrueBits) && is(2, 0)) return replace(inst, a);
                if (inst.type == Type::b1 && is(1, 0) && is(2, kTrueBits)) return rewrite(inst, Op::bnot, {a});
                if (const Inst* n = definedBy(a, Op::bnot)) return rewrite(inst, Op::select, {operand(*n, 0), no, b});
                return;
            }
            case Op::band:
                if (is(0, kTrueBits) || a == b) return replace(inst, b);
                if (is(1, kTrueBits)) return replace(inst, a);
                if (is(0, 0) || is(1, 0)) return replace(inst, constant(Type::b1, 0));
                return;
            case Op::bor:
                if (is(0, 0) || a == b) return replace(inst, b);
                if (is(1, 0)) return replace(inst, a);
                if (is(0, kTrueBits) || is(1, kTrueBits)) return replace(inst, constant(Type::b1, kTrueBits));
                return;
            case Op::bxor:
                if (is(0, 0)) return replace(inst, b);
                if (is(1, 0)) return replace(inst, a);
                if (is(0, kTrueBits)) return rewrite(inst, Op::bnot, {b});
                if (is(1, kTrueBits)) return rewrite(inst, Op::bnot, {a});
                return;
            case Op::bnot:
                return invert(inst, a);
            case Op::bitcast:
                if (static_cast<Type>(inst.imm) == inst.type) return replace(inst, a);
                if (const Inst* inner = definedBy(a, Op::bitcast)) {
                    const ValueId source = operand(*inner, 0);
                    const Type from = program_.valueTypes[source];
                    if (from == inst.type) return replace(inst, source);
                    return rewrite(inst, Op::bitcast, {source}, static_cast<uint64_t>(from));
                }
                return;
            case Op::ftoh:
            case Op::ftohZero:
                if (static_cast<Type>(inst.imm) == Type::f32 && isHalf(a)) return replace(inst, a);
                return;
            case Op::unpackHalfLow:
            case Op::unpackHalfHigh:
                // Halves whose bits were asked for on the way. Mesa's modules do so between any two operations.
                if (const Inst* pair = definedBy(a, Op::packHalf)) {
                    const ValueId value = operand(*pair, inst.op == Op::unpackHalfLow ? 0 : 1);
                    if (isHalf(value)) return replace(inst, value);
                    return rewrite(inst, Op::ftoh, {value}, static_cast<uint64_t>(Type::f32));
                }
                return;
            case Op::packHalf:
                if (const Inst* half = definedBy(a, Op::unpackHalfLow); half != nullptr && is(1, 0)) {
                    return rewrite(inst, Op::iand, {operand(*half, 0), constant(Type::i32, 0xFFFF)});
                }
                return;
            case Op::utof:
                // Conversions of signed integers are one machine instruction on every instruction set.
                if (static_cast<Type>(inst.imm) == Type::i32 && mostOf(a) <= INT32_MAX) {
                    return rewrite(inst, Op::stof, {a}, inst.imm);
                }
                return;
            case Op::lowWord:
            case Op::highWord:
                if (const Inst* wide = definedBy(a, Op::makeWide)) {
                    return replace(inst, operand(*wide, inst.op == Op::lowWord ? 0 : 1));
                }
                return;
            case Op::ine:
                // A boolean that was kept as a word.
                if (const Inst* word = definedBy(a, Op::zext);
                    word != nullptr && static_cast<Type>(word->imm) == Type::b1 && is(1, 0)) {
                    return replace(inst, operand(*word, 0));
                }
                return;
            default:
                return;
        }
    }

    /// not (a < b) is b <= a for integers, and b <= a or unordered for floats.
    void invert(Inst& inst, ValueId condition) {
        if (const Inst* n = definedBy(condition, Op::bnot)) return replace(inst, operand(*n, 0));
        struct Inverse {
            Op op, inverse;
            bool swap;
        };
        static constexpr Inverse kInverses[] = {
            {Op::ieq, Op::ine, false},   {Op::ine, Op::ieq, false},   {Op::slt, Op::sle, true},
            {Op::sle, Op::slt, true},    {Op::ult, Op::ule, true},    {Op::ule, Op::ult, true},
            {Op::foeq, Op::fune, false}, {Op::fune, Op::foeq, false}, {Op::fone, Op::fueq, false},
            {Op::fueq, Op::fone, false}, {Op::folt, Op::fule, true},  {Op::fole, Op::fult, true},
            {Op::fult, Op::fole, true},  {Op::fule, Op::folt, true},
        };
        for (const Inverse& entry : kInverses) {
            const Inst* compared = definedBy(condition, entry.op);
            if (compared == nullptr) continue;
            const ValueId x = operand(*compared, entry.swap ? 1 : 0), y = operand(*compared, entry.swap ? 0 : 1);
            // The instruction has room for one operand only; its new ones go to the end of the pool.
            inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
            program_.operands.resize(program_.operands.size() + 2);
            return rewrite(inst, entry.inverse, {x, y}, compared->imm);
        }
    }
};

}  // namespace

bool foldConstants(Program& program) {
    return Folder(program).run();
}

}  // namespace vernier::ir
