// Dot products of integers, from vectors or from four bytes packed into a word.
#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

using ir::Op;

constexpr LeafType kByte{ir::Type::i32, 8, false};

struct Shape {
    bool firstSigned, secondSigned, accumulates;
};

std::optional<Shape> shapeOf(spv::Op op) {
    switch (op) {
        case spv::Op::OpSDot:
            return Shape{true, true, false};
        case spv::Op::OpUDot:
            return Shape{false, false, false};
        case spv::Op::OpSUDot:
            return Shape{true, false, false};
        case spv::Op::OpSDotAccSat:
            return Shape{true, true, true};
        case spv::Op::OpUDotAccSat:
            return Shape{false, false, true};
        case spv::Op::OpSUDotAccSat:
            return Shape{true, false, true};
        default:
            return std::nullopt;
    }
}

}  // namespace

/// The low bits of the exact sum, in the width of the result; with an accumulator, added to it with saturation.
bool Lowering::lowerIntegerDot(const Instruction& inst) {
    const std::optional<Shape> shape = shapeOf(inst.op);
    if (!shape) return false;
    const LeafType result = scalarType(inst[1]);
    const auto components = [&](uint32_t id, bool isSigned) {
        const Leaves given = leavesOf(id);
        LeafType type = scalarOfId(id);
        NewScalars parts = arena_.copy(given);
        if (given.size() == 1) {
            // PackedVectorFormat4x8Bit: the first component in the lowest byte.
            parts = newLeaves(4);
            for (uint32_t k = 0; k < 4; ++k) {
                const ir::ValueId down = binary(Op::lshr, given[0], emitter_.constantI32(8 * k));
                parts[k] = binary(Op::iand, down, emitter_.constantI32(kByte.mask()));
            }
            type = kByte;
        }
        for (ir::ValueId& part : parts) part = convertInteger(isSigned, result, part, type);
        return parts;
    };
    const Leaves a = components(inst[3], shape->firstSigned), b = components(inst[4], shape->secondSigned);
    ir::ValueId sum = binary(Op::imul, a[0], b[0]);
    for (size_t k = 1; k < a.size(); ++k) sum = binary(Op::iadd, sum, binary(Op::imul, a[k], b[k]));
    sum = normalised(sum, result);
    if (shape->accumulates) sum = saturatingSum(sum, scalarOf(inst[5]), result, shape->firstSigned);
    setScalar(inst[2], inst[1], sum);
    return true;
}

ir::ValueId Lowering::saturatingSum(ir::ValueId a, ir::ValueId b, const LeafType& type, bool isSigned) {
    if (type.isNarrowInteger()) {
        if (!isSigned) return binary(Op::umin, binary(Op::iadd, a, b), emitter_.constantI32(type.mask()));
        const uint32_t largest = type.mask() >> 1;
        const ir::ValueId sum = binary(Op::iadd, signExtended(a, type), signExtended(b, type));
        const ir::ValueId below = binary(Op::smin, sum, emitter_.constantI32(largest));
        return normalised(binary(Op::smax, below, emitter_.constantI32(~largest)), type);
    }
    const ir::ValueId sum = binary(Op::iadd, a, b);
    if (!isSigned) {
        return emitter_.emit(Op::select, type,
                             {compare(Op::ult, sum, a), emitter_.constant(type, ~0ull >> (64 - type.bits)), sum});
    }
    // It overflows when the operands have one sign and the sum has the other; then it is the limit of their sign.
    const ir::ValueId zero = emitter_.constant(type, 0);
    const ir::ValueId overflow =
        compare(Op::slt, binary(Op::iand, binary(Op::ixor, a, sum), binary(Op::ixor, b, sum)), zero);
    const ir::ValueId sign = binary(Op::ashr, a, emitter_.constant(type, type.bits - 1u));
    const ir::ValueId limit = binary(Op::ixor, sign, emitter_.constant(type, ~0ull >> (65 - type.bits)));
    return emitter_.emit(Op::select, type, {overflow, limit, sum});
}

}  // namespace vernier
