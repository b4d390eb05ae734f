// GLSL.std.450: packing floats into words and back.
#include <spirv/unified1/GLSL.std.450.h>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

using ir::Op;

struct Packing {
    GLSLstd450 function;
    bool pack;
    bool isSigned;
    uint32_t bits;  // per component
};

constexpr Packing kPackings[] = {
    {GLSLstd450PackSnorm4x8, true, true, 8},      {GLSLstd450PackUnorm4x8, true, false, 8},
    {GLSLstd450PackSnorm2x16, true, true, 16},    {GLSLstd450PackUnorm2x16, true, false, 16},
    {GLSLstd450UnpackSnorm4x8, false, true, 8},   {GLSLstd450UnpackUnorm4x8, false, false, 8},
    {GLSLstd450UnpackSnorm2x16, false, true, 16}, {GLSLstd450UnpackUnorm2x16, false, false, 16},
};

}  // namespace

bool Lowering::lowerPacking(const Instruction& inst) {
    if (inst[4] < GLSLstd450PackSnorm4x8 || inst[4] > GLSLstd450UnpackDouble2x32) return false;
    const Leaves operand = leavesOf(inst[5]);
    NewScalars leaves;
    switch (inst[4]) {
        case GLSLstd450PackHalf2x16:
            leaves = newLeaves(1);
            leaves[0] = emitter_.emit(Op::packHalf, ir::Type::i32, {operand[0], operand[1]});
            break;
        case GLSLstd450UnpackHalf2x16:
            leaves = newLeaves(2);
            leaves[0] = emitter_.emit(Op::unpackHalfLow, ir::Type::f32, {operand[0]});
            leaves[1] = emitter_.emit(Op::unpackHalfHigh, ir::Type::f32, {operand[0]});
            break;
        case GLSLstd450PackDouble2x32:
            leaves = newLeaves(1);
            leaves[0] = emitter_.emit(Op::makeWide, ir::Type::f64, {operand[0], operand[1]});
            break;
        case GLSLstd450UnpackDouble2x32:
            leaves = newLeaves(2);
            leaves[0] = emitter_.emit(Op::lowWord, ir::Type::i32, {operand[0]});
            leaves[1] = emitter_.emit(Op::highWord, ir::Type::i32, {operand[0]});
            break;
        default: {
            for (const Packing& packing : kPackings) {
                if (static_cast<uint32_t>(packing.function) != inst[4]) continue;
                const uint32_t count = 32 / packing.bits;
                leaves = newLeaves(packing.pack ? 1 : count);
                if (packing.pack) {
                    leaves[0] = packNorm(operand, packing.bits, packing.isSigned);
                } else {
                    for (uint32_t i = 0; i < count; ++i) {
                        leaves[i] = unpackNorm(operand[0], i, packing.bits, packing.isSigned);
                    }
                }
                setValue(inst[2], inst[1], leaves);
                return true;
            }
            return false;
        }
    }
    setValue(inst[2], inst[1], leaves);
    return true;
}

/// round(clamp(c, -1 or 0, 1) * (2^(bits-1) - 1 or 2^bits - 1)), the first component in the lowest bits.
ir::ValueId Lowering::packNorm(Leaves components, uint32_t bits, bool isSigned) {
    const double scale = static_cast<double>((1u << (isSigned ? bits - 1 : bits)) - 1);
    ir::ValueId word = ir::kNoValue;
    for (uint32_t i = 0; i < components.size(); ++i) {
        const ir::ValueId low = emitter_.constantFloat(ir::Type::f32, isSigned ? -1 : 0);
        const ir::ValueId clamped =
            emitter_.emit(Op::fclamp, ir::Type::f32, {components[i], low, emitter_.constantFloat(ir::Type::f32, 1)});
        const ir::ValueId rounded = unary(Op::froundEven, mul(clamped, emitter_.constantFloat(ir::Type::f32, scale)));
        ir::ValueId field = convert(Op::ftos, ir::Type::i32, rounded);
        if (isSigned) field = binary(Op::iand, field, emitter_.constantI32((1u << bits) - 1));
        if (i != 0) field = binary(Op::shl, field, emitter_.constantI32(i * bits));
        word = i == 0 ? field : binary(Op::ior, word, field);
    }
    return word;
}

/// f / (2^(bits-1) - 1 or 2^bits - 1), not below -1.
ir::ValueId Lowering::unpackNorm(ir::ValueId word, uint32_t index, uint32_t bits, bool isSigned) {
    const double scale = static_cast<double>((1u << (isSigned ? bits - 1 : bits)) - 1);
    const ir::ValueId field = emitter_.emit(isSigned ? Op::bitFieldSExtract : Op::bitFieldUExtract, ir::Type::i32,
                                            {word, emitter_.constantI32(index * bits), emitter_.constantI32(bits)});
    const ir::ValueId value =
        binary(Op::fdiv, convert(Op::stof, ir::Type::f32, field), emitter_.constantFloat(ir::Type::f32, scale));
    return isSigned ? binary(Op::fmax, value, emitter_.constantFloat(ir::Type::f32, -1)) : value;
}

}  // namespace vernier
