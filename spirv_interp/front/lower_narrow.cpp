// Scalars of less than 32 bits, in lanes of 32 (LeafType tells how).
//
// Integers are computed in 32 bits; operands are sign-extended first where the operation looks at their sign, results
// are cut where they can have bits above. An instruction on halves computes in binary32 and rounds its results once to
// binary16: for
// + - * / and sqrt that is the correctly rounded half, because 24 >= 2 * 11 + 2 (Figueroa, "When is Double Rounding
// Innocuous?", SIGNUM Newsletter 30(3), 1995). A fused multiply-add goes through binary64 for the same reason.
#include <array>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/halves.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

using ir::Op;

/// Whether the operation looks at the sign of its integer operands (of `ashr`, of the first).
bool readsSign(Op op) {
    switch (op) {
        case Op::sdiv:
        case Op::srem:
        case Op::smod:
        case Op::slt:
        case Op::sle:
        case Op::smin:
        case Op::smax:
        case Op::iabs:
        case Op::isign:
        case Op::ashr:
        case Op::findSMsb:
            return true;
        default:
            return false;
    }
}

bool isShift(Op op) {
    return op == Op::shl || op == Op::lshr || op == Op::ashr;
}

/// Whether operands without bits above the width give results without any.
bool staysNarrow(Op op) {
    switch (op) {
        case Op::udiv:
        case Op::umod:
        case Op::umin:
        case Op::umax:
        case Op::iand:
        case Op::ior:
        case Op::ixor:
        case Op::lshr:
        case Op::bitFieldUExtract:
            return true;
        default:
            return false;
    }
}

constexpr float kHalfBelowOne = 0x1.ffcp-1f;

}  // namespace

/// Emits an operation on operands of scalar type `from` (shift counts and bit-field places have the type the operation
/// wants) with a result of type `to`.
ir::ValueId Lowering::emitTyped(Op op, const LeafType& to, Leaves operands, const LeafType& from, uint64_t imm) {
    if (to.isHalf() && op == Op::ffma) return halfFma(operands);
    std::array<ir::ValueId, 4> x{};
    std::copy(operands.begin(), operands.end(), x.begin());
    if (from.isNarrowInteger()) {
        if (readsSign(op)) {
            x[0] = signExtended(x[0], from);
            if (operands.size() > 1 && !isShift(op)) x[1] = signExtended(x[1], from);
        }
        if (isShift(op)) x[1] = binary(Op::iand, x[1], emitter_.constantI32(from.bits - 1u));
    }
    ir::ValueId result = emitter_.emit(op, to, Leaves(x.data(), operands.size()), imm);
    if (to.isNarrowInteger()) {
        if (op == Op::bitReverse) return binary(Op::lshr, result, emitter_.constantI32(32u - to.bits));
        return staysNarrow(op) ? result : normalised(result, to);
    }
    if (!to.isHalf() || ir::keepsHalves(op)) return result;
    result = normalised(result, to);
    // As with other floats, the fraction of a number just below an integer stays below 1.
    if (op == Op::ffract) result = binary(Op::fmin, result, emitter_.constantFloat(ir::Type::f32, kHalfBelowOne));
    return result;
}

/// a * b + c with one rounding. The product is exact in binary64; the sum is not always, but then the smaller operand
/// is so small that the half next to it is the half next to the exact sum.
ir::ValueId Lowering::halfFma(Leaves operands) {
    ir::ValueId x[3];
    for (size_t k = 0; k < 3; ++k) x[k] = convert(Op::ftof, ir::Type::f64, operands[k]);
    return convert(Op::ftoh, ir::Type::f32, add(mul(x[0], x[1]), x[2]));
}

/// The value as its type holds it: cut to the bits of a narrow integer, or rounded to a half.
ir::ValueId Lowering::normalised(ir::ValueId value, const LeafType& type) {
    if (type.isNarrowInteger()) return binary(Op::iand, value, emitter_.constantI32(type.mask()));
    return type.isHalf() ? convert(Op::ftoh, ir::Type::f32, value) : value;
}

/// Leaves computed in f32 as values of a type whose floats may be halves.
Lowering::Leaves Lowering::rounded(uint32_t type, NewScalars leaves) {
    const LeafTypes types = leafTypes(type);
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (types[i].isHalf()) leaves[i] = normalised(leaves[i], types[i]);
    }
    return leaves;
}

ir::ValueId Lowering::signExtended(ir::ValueId value, const LeafType& type) {
    if (!type.isNarrowInteger()) return value;
    const ir::ValueId distance = emitter_.constantI32(32u - type.bits);
    return binary(Op::ashr, binary(Op::shl, value, distance), distance);
}

/// A conversion between numbers; `result` is the instruction's result id, whose decorations tell the rounding.
ir::ValueId Lowering::convertNumber(Op op, const LeafType& to, ir::ValueId value, const LeafType& from,
                                    uint32_t result) {
    switch (op) {
        case Op::zext:
        case Op::sext:
            return convertInteger(op == Op::sext, to, value, from);
        case Op::ftou:
            value = convert(op, to, value);
            return to.isNarrowInteger() ? binary(Op::umin, value, emitter_.constantI32(to.mask())) : value;
        case Op::ftos: {
            value = convert(op, to, value);
            if (!to.isNarrowInteger()) return value;
            const uint32_t largest = to.mask() >> 1;
            value = binary(Op::smin, value, emitter_.constantI32(largest));
            return normalised(binary(Op::smax, value, emitter_.constantI32(~largest)), to);
        }
        // To a half by way of binary32: integers it does not hold exactly are all too large for a half.
        case Op::stof:
            return normalised(convert(op, to, signExtended(value, from)), to);
        case Op::utof:
            return normalised(convert(op, to, value), to);
        default:
            break;
    }
    if (from.type == to.type && from.bits == to.bits) return value;
    if (!to.isHalf()) return from.type == to.type ? value : convert(Op::ftof, to, value);
    const uint32_t mode = module_.decorationOr(result, spv::Decoration::FPRoundingMode, Decoration::kNoMember,
                                               static_cast<uint32_t>(spv::FPRoundingMode::RTE));
    switch (static_cast<spv::FPRoundingMode>(mode)) {
        case spv::FPRoundingMode::RTE:
            return convert(Op::ftoh, ir::Type::f32, value);
        case spv::FPRoundingMode::RTZ:
            return convert(Op::ftohZero, ir::Type::f32, value);
        default:
            refuseId(result, "is decorated with a rounding mode other than RTE and RTZ, which is not supported");
    }
}

/// UConvert and SConvert, which change the width in either direction.
ir::ValueId Lowering::convertInteger(bool isSigned, const LeafType& to, ir::ValueId value, const LeafType& from) {
    if (isSigned) value = signExtended(value, from);
    if (to.bits == 64) return from.bits == 64 ? value : convert(isSigned ? Op::sext : Op::zext, to, value);
    value = toI32(value);
    return to.bits < from.bits || isSigned ? normalised(value, to) : value;
}

/// The bits of a scalar as an integer of its width, and back.
ir::ValueId Lowering::pieceOf(ir::ValueId value, const LeafType& type) {
    if (type.isHalf()) {
        return emitter_.emit(Op::packHalf, ir::Type::i32, {value, emitter_.constantFloat(ir::Type::f32, 0)});
    }
    if (!ir::isFloat(type)) return value;
    return convert(Op::bitcast, type.bits == 64 ? ir::Type::i64 : ir::Type::i32, value);
}

ir::ValueId Lowering::ofPiece(ir::ValueId piece, const LeafType& type) {
    if (type.isHalf()) return emitter_.emit(Op::unpackHalfLow, ir::Type::f32, {piece});
    return ir::isFloat(type) ? convert(Op::bitcast, type, piece) : piece;
}

/// An index of any integer type as i32. One that does not fit becomes the last or the first there is: out of range
/// either way.
ir::ValueId Lowering::indexOf(uint32_t id) {
    const LeafType& type = scalarOfId(id);
    ir::ValueId index = type.isSigned ? signExtended(scalarOf(id), type) : scalarOf(id);
    if (ir::isWide(emitter_.typeOf(index))) {
        const auto limit = [&](int64_t value) {
            return emitter_.constant(ir::Type::i64, static_cast<uint64_t>(value));
        };
        index = binary(Op::smax, binary(Op::smin, index, limit(INT32_MAX)), limit(INT32_MIN));
    }
    return toI32(index);
}

}  // namespace vernier
