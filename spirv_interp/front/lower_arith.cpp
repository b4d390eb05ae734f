// Arithmetic, logic, conversions and bit operations, component by component.
#include <algorithm>
#include <optional>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

using ir::Op;

/// How the operands of an elementwise instruction relate to its result.
enum class Shape : uint8_t {
    same,      // all of the result's type
    swapped,   // as compare, with the operands exchanged
    compare,   // a boolean from operands of one type
    convert,   // one operand of another type, told by the immediate
    shift,     // the second operand may be of another width
    bitfield,  // offset and count are of any integer type
    logical,   // booleans; the result is inverted
};

struct Elementwise {
    spv::Op spirv;
    Op op;
    Shape shape;
    uint8_t operands;
};

constexpr Elementwise kElementwise[] = {
    {spv::Op::OpSNegate, Op::ineg, Shape::same, 1},
    {spv::Op::OpFNegate, Op::fneg, Shape::same, 1},
    {spv::Op::OpIAdd, Op::iadd, Shape::same, 2},
    {spv::Op::OpFAdd, Op::fadd, Shape::same, 2},
    {spv::Op::OpISub, Op::isub, Shape::same, 2},
    {spv::Op::OpFSub, Op::fsub, Shape::same, 2},
    {spv::Op::OpIMul, Op::imul, Shape::same, 2},
    {spv::Op::OpFMul, Op::fmul, Shape::same, 2},
    {spv::Op::OpUDiv, Op::udiv, Shape::same, 2},
    {spv::Op::OpSDiv, Op::sdiv, Shape::same, 2},
    {spv::Op::OpFDiv, Op::fdiv, Shape::same, 2},
    {spv::Op::OpUMod, Op::umod, Shape::same, 2},
    {spv::Op::OpSRem, Op::srem, Shape::same, 2},
    {spv::Op::OpSMod, Op::smod, Shape::same, 2},
    {spv::Op::OpFRem, Op::frem, Shape::same, 2},
    {spv::Op::OpFMod, Op::fmod, Shape::same, 2},
    {spv::Op::OpBitwiseOr, Op::ior, Shape::same, 2},
    {spv::Op::OpBitwiseXor, Op::ixor, Shape::same, 2},
    {spv::Op::OpBitwiseAnd, Op::iand, Shape::same, 2},
    {spv::Op::OpNot, Op::inot, Shape::same, 1},
    {spv::Op::OpLogicalOr, Op::bor, Shape::same, 2},
    {spv::Op::OpLogicalAnd, Op::band, Shape::same, 2},
    {spv::Op::OpLogicalNotEqual, Op::bxor, Shape::same, 2},
    {spv::Op::OpLogicalEqual, Op::bxor, Shape::logical, 2},
    {spv::Op::OpLogicalNot, Op::bnot, Shape::same, 1},
    {spv::Op::OpShiftRightLogical, Op::lshr, Shape::shift, 2},
    {spv::Op::OpShiftRightArithmetic, Op::ashr, Shape::shift, 2},
    {spv::Op::OpShiftLeftLogical, Op::shl, Shape::shift, 2},
    {spv::Op::OpBitFieldInsert, Op::bitFieldInsert, Shape::bitfield, 4},
    {spv::Op::OpBitFieldSExtract, Op::bitFieldSExtract, Shape::bitfield, 3},
    {spv::Op::OpBitFieldUExtract, Op::bitFieldUExtract, Shape::bitfield, 3},
    {spv::Op::OpBitReverse, Op::bitReverse, Shape::same, 1},
    {spv::Op::OpBitCount, Op::bitCount, Shape::same, 1},
    {spv::Op::OpDPdx, Op::ddxFine, Shape::same, 1},
    {spv::Op::OpDPdy, Op::ddyFine, Shape::same, 1},
    {spv::Op::OpDPdxFine, Op::ddxFine, Shape::same, 1},
    {spv::Op::OpDPdyFine, Op::ddyFine, Shape::same, 1},
    {spv::Op::OpDPdxCoarse, Op::ddxCoarse, Shape::same, 1},
    {spv::Op::OpDPdyCoarse, Op::ddyCoarse, Shape::same, 1},
    {spv::Op::OpQuantizeToF16, Op::quantizeF16, Shape::same, 1},
    {spv::Op::OpIsNan, Op::fisnan, Shape::compare, 1},
    {spv::Op::OpIsInf, Op::fisinf, Shape::compare, 1},
    {spv::Op::OpIEqual, Op::ieq, Shape::compare, 2},
    {spv::Op::OpINotEqual, Op::ine, Shape::compare, 2},
    {spv::Op::OpUGreaterThan, Op::ult, Shape::swapped, 2},
    {spv::Op::OpSGreaterThan, Op::slt, Shape::swapped, 2},
    {spv::Op::OpUGreaterThanEqual, Op::ule, Shape::swapped, 2},
    {spv::Op::OpSGreaterThanEqual, Op::sle, Shape::swapped, 2},
    {spv::Op::OpULessThan, Op::ult, Shape::compare, 2},
    {spv::Op::OpSLessThan, Op::slt, Shape::compare, 2},
    {spv::Op::OpULessThanEqual, Op::ule, Shape::compare, 2},
    {spv::Op::OpSLessThanEqual, Op::sle, Shape::compare, 2},
    {spv::Op::OpFOrdEqual, Op::foeq, Shape::compare, 2},
    {spv::Op::OpFUnordEqual, Op::fueq, Shape::compare, 2},
    {spv::Op::OpFOrdNotEqual, Op::fone, Shape::compare, 2},
    {spv::Op::OpFUnordNotEqual, Op::fune, Shape::compare, 2},
    {spv::Op::OpFOrdLessThan, Op::folt, Shape::compare, 2},
    {spv::Op::OpFUnordLessThan, Op::fult, Shape::compare, 2},
    {spv::Op::OpFOrdGreaterThan, Op::folt, Shape::swapped, 2},
    {spv::Op::OpFUnordGreaterThan, Op::fult, Shape::swapped, 2},
    {spv::Op::OpFOrdLessThanEqual, Op::fole, Shape::compare, 2},
    {spv::Op::OpFUnordLessThanEqual, Op::fule, Shape::compare, 2},
    {spv::Op::OpFOrdGreaterThanEqual, Op::fole, Shape::swapped, 2},
    {spv::Op::OpFUnordGreaterThanEqual, Op::fule, Shape::swapped, 2},
    {spv::Op::OpConvertFToU, Op::ftou, Shape::convert, 1},
    {spv::Op::OpConvertFToS, Op::ftos, Shape::convert, 1},
    {spv::Op::OpConvertSToF, Op::stof, Shape::convert, 1},
    {spv::Op::OpConvertUToF, Op::utof, Shape::convert, 1},
    {spv::Op::OpFConvert, Op::ftof, Shape::convert, 1},
    {spv::Op::OpUConvert, Op::zext, Shape::convert, 1},
    {spv::Op::OpSConvert, Op::sext, Shape::convert, 1},
};

}  // namespace

bool Lowering::lowerArithmetic(const Instruction& inst) {
    return lowerElementwise(inst) || lowerExtendedResult(inst) || lowerMatrix(inst);
}

ir::ValueId Lowering::toI32(ir::ValueId value) {
    return emitter_.typeOf(value) == ir::Type::i64 ? convert(Op::itrunc, ir::Type::i32, value) : value;
}

/// An integer with the bits of another width: cut, or filled with zeros.
ir::ValueId Lowering::withType(ir::ValueId value, ir::Type type) {
    if (emitter_.typeOf(value) == type) return value;
    return type == ir::Type::i64 ? convert(Op::zext, type, value) : convert(Op::itrunc, type, value);
}

bool Lowering::lowerElementwise(const Instruction& inst) {
    const auto found = std::find_if(std::begin(kElementwise), std::end(kElementwise),
                                    [&](const Elementwise& entry) { return entry.spirv == inst.op; });
    if (found == std::end(kElementwise)) return false;
    const ir::Type type = scalarType(inst[1]);
    const std::span<ir::ValueId> leaves = newLeaves(leafTypes(inst[1]).size());
    Leaves operands[4];
    for (uint32_t k = 0; k < found->operands; ++k) operands[k] = leavesOf(inst[3 + k]);
    for (size_t i = 0; i < leaves.size(); ++i) {
        ir::ValueId x[4] = {};
        for (uint32_t k = 0; k < found->operands; ++k) x[k] = operands[k][std::min(i, operands[k].size() - 1)];
        const Leaves given(x, found->operands);
        switch (found->shape) {
            case Shape::same:
                leaves[i] = emitter_.emit(found->op, type, given);
                break;
            case Shape::swapped:
                std::swap(x[0], x[1]);
                [[fallthrough]];
            case Shape::compare:
                leaves[i] = emitter_.emit(found->op, type, given, static_cast<uint64_t>(emitter_.typeOf(x[0])));
                break;
            case Shape::convert: {
                // UConvert and SConvert change the width in either direction.
                const bool integer = found->op == Op::zext || found->op == Op::sext;
                const ir::Type from = emitter_.typeOf(x[0]);
                if (from == type && (integer || found->op == Op::ftof)) {
                    leaves[i] = x[0];
                } else {
                    leaves[i] = convert(integer && type == ir::Type::i32 ? Op::itrunc : found->op, type, x[0]);
                }
                break;
            }
            case Shape::shift:
                leaves[i] = emitter_.emit(found->op, type, {x[0], withType(x[1], type)});
                break;
            case Shape::bitfield: {
                const uint32_t firstCount = found->operands - 2u;
                for (uint32_t k = firstCount; k < found->operands; ++k) x[k] = toI32(x[k]);
                leaves[i] = emitter_.emit(found->op, type, given);
                break;
            }
            case Shape::logical:
                leaves[i] = emitter_.emit(Op::bnot, type, {emitter_.emit(found->op, type, given)});
                break;
        }
    }
    setValue(inst[2], inst[1], leaves);
    return true;
}

/// Instructions whose result has another shape than their operands.
bool Lowering::lowerExtendedResult(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpAny:
        case spv::Op::OpAll: {
            const Leaves operand = leavesOf(inst[3]);
            ir::ValueId result = operand[0];
            for (const ir::ValueId leaf : operand.subspan(1)) {
                result = binary(inst.op == spv::Op::OpAny ? Op::bor : Op::band, result, leaf);
            }
            setScalar(inst[2], inst[1], result);
            return true;
        }
        case spv::Op::OpFwidth:
        case spv::Op::OpFwidthFine:
        case spv::Op::OpFwidthCoarse: {
            const bool coarse = inst.op == spv::Op::OpFwidthCoarse;
            const Leaves operand = leavesOf(inst[3]);
            const std::span<ir::ValueId> leaves = newLeaves(operand.size());
            for (size_t i = 0; i < leaves.size(); ++i) {
                leaves[i] = add(unary(Op::fabs, unary(coarse ? Op::ddxCoarse : Op::ddxFine, operand[i])),
                                unary(Op::fabs, unary(coarse ? Op::ddyCoarse : Op::ddyFine, operand[i])));
            }
            setValue(inst[2], inst[1], leaves);
            return true;
        }
        case spv::Op::OpIAddCarry:
        case spv::Op::OpISubBorrow:
        case spv::Op::OpUMulExtended:
        case spv::Op::OpSMulExtended: {
            // A struct of two: the low part, then carry, borrow or high part.
            Op low = Op::imul, high = Op::umulHigh;
            if (inst.op == spv::Op::OpIAddCarry) low = Op::iadd, high = Op::addCarry;
            if (inst.op == spv::Op::OpISubBorrow) low = Op::isub, high = Op::subBorrow;
            if (inst.op == spv::Op::OpSMulExtended) high = Op::smulHigh;
            const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
            const std::span<ir::ValueId> leaves = newLeaves(a.size() * 2);
            for (size_t i = 0; i < a.size(); ++i) {
                leaves[i] = binary(low, a[i], b[i]);
                leaves[a.size() + i] = binary(high, a[i], b[i]);
            }
            setValue(inst[2], inst[1], leaves);
            return true;
        }
        case spv::Op::OpSelect:
            lowerSelect(inst);
            return true;
        case spv::Op::OpBitcast:
            lowerBitcast(inst);
            return true;
        default:
            return false;
    }
}

void Lowering::lowerSelect(const Instruction& inst) {
    if (idValue(inst[4]).kind != IdValue::Kind::value)
        refuse(inst, "a choice between pointers or images is not supported");
    const Leaves condition = leavesOf(inst[3]), yes = leavesOf(inst[4]), no = leavesOf(inst[5]);
    const std::span<ir::ValueId> leaves = newLeaves(yes.size());
    for (size_t i = 0; i < yes.size(); ++i) {
        leaves[i] = emitter_.emit(Op::select, emitter_.typeOf(yes[i]),
                                  {condition[std::min(i, condition.size() - 1)], yes[i], no[i]});
    }
    setValue(inst[2], inst[1], leaves);
}

void Lowering::lowerBitcast(const Instruction& inst) {
    const std::vector<ir::Type>& types = leafTypes(inst[1]);
    if (idValue(inst[3]).kind != IdValue::Kind::value || types.empty()) refuse(inst, "pointers have no bits");
    const Leaves operand = leavesOf(inst[3]);
    const std::span<ir::ValueId> leaves = newLeaves(types.size());
    const bool toWide = ir::isWide(types[0]), fromWide = ir::isWide(emitter_.typeOf(operand[0]));
    const auto cast = [this](ir::ValueId value, ir::Type type) {
        return emitter_.typeOf(value) == type ? value : convert(Op::bitcast, type, value);
    };
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (toWide == fromWide) {
            leaves[i] = cast(operand[i], types[i]);
        } else if (toWide) {
            // The lower-numbered component has the lower bits.
            leaves[i] = emitter_.emit(Op::makeWide, types[i],
                                      {cast(operand[2 * i], ir::Type::i32), cast(operand[2 * i + 1], ir::Type::i32)});
        } else {
            const Op word = i % 2 == 0 ? Op::lowWord : Op::highWord;
            leaves[i] = cast(emitter_.emit(word, ir::Type::i32, {operand[i / 2]}), types[i]);
        }
    }
    setValue(inst[2], inst[1], leaves);
}

}  // namespace vernier
