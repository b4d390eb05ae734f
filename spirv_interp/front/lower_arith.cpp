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
    convert,   // one operand of another type
    count,     // of bits: the result may be of another width
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
    {spv::Op::OpBitCount, Op::bitCount, Shape::count, 1},
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
    return lowerElementwise(inst) || lowerExtendedResult(inst) || lowerMatrix(inst) || lowerIntegerDot(inst);
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
    const LeafType type = scalarType(inst[1]);
    const NewScalars leaves = newLeaves(leafTypes(inst[1]).size());
    Leaves operands[4];
    for (uint32_t k = 0; k < found->operands; ++k) operands[k] = leavesOf(inst[3 + k]);
    const LeafType from = scalarOfId(inst[3]);
    for (size_t i = 0; i < leaves.size(); ++i) {
        ir::ValueId x[4] = {};
        for (uint32_t k = 0; k < found->operands; ++k) x[k] = operands[k][std::min(i, operands[k].size() - 1)];
        const Leaves given(x, found->operands);
        switch (found->shape) {
            case Shape::same:
                leaves[i] = emitTyped(found->op, type, given, from);
                break;
            case Shape::swapped:
                std::swap(x[0], x[1]);
                [[fallthrough]];
            case Shape::compare:
                leaves[i] = emitTyped(found->op, type, given, from, static_cast<uint64_t>(from.type));
                break;
            case Shape::convert:
                leaves[i] = convertNumber(found->op, type, x[0], from, inst[2]);
                break;
            case Shape::count:
                leaves[i] = withType(emitter_.emit(found->op, from, given), type);
                break;
            case Shape::shift:
                x[1] = withType(x[1], type);
                leaves[i] = emitTyped(found->op, type, given, from);
                break;
            case Shape::bitfield: {
                const uint32_t firstCount = found->operands - 2u;
                for (uint32_t k = firstCount; k < found->operands; ++k) x[k] = toI32(x[k]);
                leaves[i] = emitTyped(found->op, type, given, from);
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
            const NewScalars leaves = newLeaves(operand.size());
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
            const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
            const LeafType type = scalarOfId(inst[3]);
            const NewScalars leaves = newLeaves(a.size() * 2);
            for (size_t i = 0; i < a.size(); ++i) {
                const auto [low, high] = extended(inst.op, a[i], b[i], type);
                leaves[i] = low;
                leaves[a.size() + i] = high;
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
    if (leafTypes(inst[1]).empty()) refuse(inst, "a choice between images or pointers to variables is not supported");
    const Leaves condition = leavesOf(inst[3]), yes = leavesOf(inst[4]), no = leavesOf(inst[5]);
    const NewScalars leaves = newLeaves(yes.size());
    for (size_t i = 0; i < yes.size(); ++i) {
        leaves[i] = emitter_.emit(Op::select, emitter_.typeOf(yes[i]),
                                  {condition[std::min(i, condition.size() - 1)], yes[i], no[i]});
    }
    setValue(inst[2], inst[1], leaves);
}

/// Both halves of a sum, difference or product of twice the width.
std::pair<ir::ValueId, ir::ValueId> Lowering::extended(spv::Op op, ir::ValueId a, ir::ValueId b, const LeafType& type) {
    const bool product = op == spv::Op::OpUMulExtended || op == spv::Op::OpSMulExtended;
    Op low = Op::imul, high = Op::umulHigh;
    if (op == spv::Op::OpIAddCarry) low = Op::iadd, high = Op::addCarry;
    if (op == spv::Op::OpISubBorrow) low = Op::isub, high = Op::subBorrow;
    if (op == spv::Op::OpSMulExtended) high = Op::smulHigh;
    if (!type.isNarrowInteger()) return {binary(low, a, b), binary(high, a, b)};
    if (op == spv::Op::OpSMulExtended) a = signExtended(a, type), b = signExtended(b, type);
    // 32 bits hold all of it, except that a difference that borrows has ones above.
    const ir::ValueId whole = binary(low, a, b);
    const ir::ValueId above =
        op == spv::Op::OpISubBorrow ? binary(high, a, b) : binary(Op::lshr, whole, emitter_.constantI32(type.bits));
    return {normalised(whole, type), product ? normalised(above, type) : above};
}

/// The bits of the operand's components, lowest first, dealt out to the result's.
void Lowering::lowerBitcast(const Instruction& inst) {
    const LeafTypes types = leafTypes(inst[1]);
    if (types.empty() || isBufferPointer(inst[1]) || isBufferPointer(module_.definition(inst[3])[1])) {
        refuse(inst, "only pointers into physical storage buffers have bits");
    }
    const Leaves operand = leavesOf(inst[3]);
    const LeafType from = scalarOfId(inst[3]), to = types[0];
    const NewScalars leaves = newLeaves(types.size());
    if (operand.size() * from.bits != leaves.size() * to.bits) refuse(inst, "the widths differ");
    const auto split = [&](ir::ValueId piece, uint32_t width, uint32_t index) {
        if (width == 64) {
            const uint32_t perWord = 32 / std::min<uint32_t>(to.bits, 32);
            piece = emitter_.emit(index / perWord == 0 ? Op::lowWord : Op::highWord, ir::Type::i32, {piece});
            index %= perWord;
        }
        if (to.bits >= 32) return piece;
        const ir::ValueId down = binary(Op::lshr, piece, emitter_.constantI32(index * to.bits));
        return binary(Op::iand, down, emitter_.constantI32(to.mask()));
    };
    const auto join = [&](size_t first, uint32_t count) {
        ir::ValueId word = pieceOf(operand[first], from);
        for (uint32_t k = 1; k < count; ++k) {
            word = binary(Op::ior, word,
                          binary(Op::shl, pieceOf(operand[first + k], from), emitter_.constantI32(k * from.bits)));
        }
        return word;
    };
    for (size_t i = 0; i < leaves.size(); ++i) {
        ir::ValueId piece = ir::kNoValue;
        if (from.bits >= to.bits) {
            const auto parts = static_cast<uint32_t>(from.bits / to.bits);
            piece = pieceOf(operand[i / parts], from);
            if (parts != 1) piece = split(piece, from.bits, static_cast<uint32_t>(i % parts));
        } else {
            const auto parts = static_cast<uint32_t>(to.bits / from.bits);
            if (to.bits == 64) {
                const ir::ValueId low = join(i * parts, parts / 2);
                piece = emitter_.emit(Op::makeWide, ir::Type::i64, {low, join(i * parts + parts / 2, parts / 2)});
            } else {
                piece = join(i * parts, parts);
            }
        }
        leaves[i] = ofPiece(piece, to);
    }
    setValue(inst[2], inst[1], leaves);
}

}  // namespace vernier
