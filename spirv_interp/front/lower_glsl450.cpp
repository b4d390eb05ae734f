// The extended instruction set GLSL.std.450: functions applied component by component, and the instructions with
// results through pointers or structs. Operand words of an OpExtInst begin at 5.
#include <algorithm>

#include <spirv/unified1/GLSL.std.450.h>

#include "spirv_interp/front/lowering.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {
namespace {

using ir::Op;

struct Elementwise {
    GLSLstd450 function;
    Op op;
    uint8_t operands;
};

// FMin, FMax and FClamp leave open what a NaN gives: they do what their N twins must.
constexpr Elementwise kElementwise[] = {
    {GLSLstd450RoundEven, Op::froundEven, 1},
    {GLSLstd450Round, Op::froundEven, 1},
    {GLSLstd450Trunc, Op::ftrunc, 1},
    {GLSLstd450FAbs, Op::fabs, 1},
    {GLSLstd450SAbs, Op::iabs, 1},
    {GLSLstd450FSign, Op::fsign, 1},
    {GLSLstd450SSign, Op::isign, 1},
    {GLSLstd450Floor, Op::ffloor, 1},
    {GLSLstd450Ceil, Op::fceil, 1},
    {GLSLstd450Fract, Op::ffract, 1},
    {GLSLstd450Sin, Op::fsin, 1},
    {GLSLstd450Cos, Op::fcos, 1},
    {GLSLstd450Tan, Op::ftan, 1},
    {GLSLstd450Asin, Op::fasin, 1},
    {GLSLstd450Acos, Op::facos, 1},
    {GLSLstd450Atan, Op::fatan, 1},
    {GLSLstd450Sinh, Op::fsinh, 1},
    {GLSLstd450Cosh, Op::fcosh, 1},
    {GLSLstd450Tanh, Op::ftanh, 1},
    {GLSLstd450Asinh, Op::fasinh, 1},
    {GLSLstd450Acosh, Op::facosh, 1},
    {GLSLstd450Atanh, Op::fatanh, 1},
    {GLSLstd450Atan2, Op::fatan2, 2},
    {GLSLstd450Pow, Op::fpow, 2},
    {GLSLstd450Exp, Op::fexp, 1},
    {GLSLstd450Log, Op::flog, 1},
    {GLSLstd450Exp2, Op::fexp2, 1},
    {GLSLstd450Log2, Op::flog2, 1},
    {GLSLstd450Sqrt, Op::fsqrt, 1},
    {GLSLstd450InverseSqrt, Op::finverseSqrt, 1},
    {GLSLstd450FMin, Op::fmin, 2},
    {GLSLstd450UMin, Op::umin, 2},
    {GLSLstd450SMin, Op::smin, 2},
    {GLSLstd450FMax, Op::fmax, 2},
    {GLSLstd450UMax, Op::umax, 2},
    {GLSLstd450SMax, Op::smax, 2},
    {GLSLstd450FClamp, Op::fclamp, 3},
    {GLSLstd450NMin, Op::fmin, 2},
    {GLSLstd450NMax, Op::fmax, 2},
    {GLSLstd450NClamp, Op::fclamp, 3},
    {GLSLstd450FMix, Op::fmix, 3},
    {GLSLstd450Step, Op::fstep, 2},
    {GLSLstd450SmoothStep, Op::fsmoothstep, 3},
    {GLSLstd450Fma, Op::ffma, 3},
    {GLSLstd450Ldexp, Op::fldexp, 2},
    {GLSLstd450FindILsb, Op::findILsb, 1},
    {GLSLstd450FindSMsb, Op::findSMsb, 1},
    {GLSLstd450FindUMsb, Op::findUMsb, 1},
};

// Rounded from more digits than a double holds.
constexpr double kRadiansPerDegree = 0.017453292519943295769;
constexpr double kDegreesPerRadian = 57.295779513082320877;

}  // namespace

void Lowering::lowerExtended(const Instruction& inst) {
    if (lowerExtendedElementwise(inst) || lowerGeometric(inst) || lowerPacking(inst)) return;
    switch (inst[4]) {
        case GLSLstd450Modf:
        case GLSLstd450ModfStruct:
        case GLSLstd450Frexp:
        case GLSLstd450FrexpStruct:
            lowerSplit(inst);
            return;
        case GLSLstd450InterpolateAtCentroid:
        case GLSLstd450InterpolateAtSample:
        case GLSLstd450InterpolateAtOffset:
            lowerInterpolate(inst);
            return;
        default:
            refuse(inst, "GLSL.std.450 instruction " + std::to_string(inst[4]) + " is not supported");
    }
}

bool Lowering::lowerExtendedElementwise(const Instruction& inst) {
    const uint32_t function = inst[4];
    const SpirvType& type = typeInfo(inst[1]);
    if (type.leaves == 0) refuse(inst, "the result has no scalars");
    Leaves operands[3];
    const auto apply = [&](uint32_t count, const auto& each) {
        for (uint32_t k = 0; k < count; ++k) operands[k] = leavesOf(inst[5 + k]);
        const NewScalars leaves = newLeaves(type.leaves);
        for (size_t i = 0; i < leaves.size(); ++i) {
            ir::ValueId x[3] = {};
            for (uint32_t k = 0; k < count; ++k) x[k] = operands[k][std::min(i, operands[k].size() - 1)];
            leaves[i] = each(x);
        }
        setValue(inst[2], inst[1], leaves);
    };
    switch (function) {
        case GLSLstd450Radians:
        case GLSLstd450Degrees: {
            const ir::ValueId factor = emitter_.constantFloat(
                type.scalar, function == GLSLstd450Radians ? kRadiansPerDegree : kDegreesPerRadian);
            apply(1, [&](const ir::ValueId* x) { return normalised(mul(x[0], factor), type.scalar); });
            return true;
        }
        case GLSLstd450UClamp:
        case GLSLstd450SClamp: {
            const bool isUnsigned = function == GLSLstd450UClamp;
            apply(3, [&](const ir::ValueId* x) {
                const ir::ValueId above[] = {
                    emitTyped(isUnsigned ? Op::umax : Op::smax, type.scalar, Leaves(x, 2), type.scalar), x[2]};
                return emitTyped(isUnsigned ? Op::umin : Op::smin, type.scalar, above, type.scalar);
            });
            return true;
        }
        default:
            break;
    }
    for (const Elementwise& entry : kElementwise) {
        if (static_cast<uint32_t>(entry.function) != function) continue;
        apply(entry.operands, [&](ir::ValueId* x) {
            if (entry.op == Op::fldexp) x[1] = toI32(signExtended(x[1], scalarOfId(inst[6])));
            return emitTyped(entry.op, type.scalar, Leaves(x, entry.operands), scalarOfId(inst[5]));
        });
        return true;
    }
    return false;
}

/// `value`, which has no other sign than `x` but may be +0 where `x` is negative, with the sign of `x`.
ir::ValueId Lowering::withSignOf(ir::ValueId value, ir::ValueId x) {
    const ir::Type type = emitter_.typeOf(x);
    const bool wide = type == ir::Type::f64;
    const auto upper = [&](ir::ValueId v) {
        return wide ? emitter_.emit(Op::highWord, ir::Type::i32, {v}) : convert(Op::bitcast, ir::Type::i32, v);
    };
    const ir::ValueId sign = binary(Op::iand, upper(x), emitter_.constantI32(0x80000000u));
    const ir::ValueId bits = binary(Op::ior, upper(value), sign);
    if (!wide) return convert(Op::bitcast, type, bits);
    return emitter_.emit(Op::makeWide, type, {emitter_.emit(Op::lowWord, ir::Type::i32, {value}), bits});
}

/// Modf and Frexp: the fraction or mantissa is the result, the other half goes to a pointer or is the struct's second
/// member.
void Lowering::lowerSplit(const Instruction& inst) {
    const bool modf = inst[4] == GLSLstd450Modf || inst[4] == GLSLstd450ModfStruct;
    const bool toPointer = inst[4] == GLSLstd450Modf || inst[4] == GLSLstd450Frexp;
    const Leaves operand = leavesOf(inst[5]);
    const size_t count = operand.size();
    const NewScalars both = newLeaves(2 * count);
    for (size_t i = 0; i < count; ++i) {
        const ir::ValueId x = operand[i];
        if (modf) {
            // Both parts have the operand's sign; an infinity has the fraction 0.
            const ir::ValueId whole = unary(Op::ftrunc, x);
            const ir::ValueId zero = emitter_.constantFloat(emitter_.typeOf(x), 0);
            const ir::ValueId fraction =
                emitter_.emit(Op::select, emitter_.typeOf(x),
                              {emitter_.emit(Op::fisinf, ir::Type::b1, {x}, static_cast<uint64_t>(emitter_.typeOf(x))),
                               zero, sub(x, whole)});
            both[i] = withSignOf(fraction, x);
            both[count + i] = whole;
        } else {
            both[i] = unary(Op::ffrexpMantissa, x);
            both[count + i] = convert(Op::ffrexpExponent, ir::Type::i32, x);
        }
    }
    if (!toPointer && typeInfo(inst[1]).members.size() != 2) refuse(inst, "the result is no structure of two members");
    if (!modf) {
        const LeafType exponent =
            toPointer ? scalarType(pointerOf(inst[6]).type) : scalarType(typeInfo(inst[1]).members[1]);
        for (size_t i = count; i < 2 * count; ++i) both[i] = normalised(both[i], exponent);
    }
    if (toPointer) {
        store(pointerOf(inst[6]), both.subspan(count));
        setValue(inst[2], inst[1], both.first(count));
    } else {
        setValue(inst[2], inst[1], both);
    }
}

void Lowering::lowerInterpolate(const Instruction& inst) {
    const Pointer& pointer = pointerOf(inst[5]);
    if (pointer.base != Pointer::Base::input) refuse(inst, "the interpolant is no input");
    const Leaves at = inst.count > 6 ? leavesOf(inst[6]) : Leaves();
    const auto interpolated = [&](uint32_t slot) {
        switch (inst[4]) {
            case GLSLstd450InterpolateAtCentroid:
                return emitter_.emit(Op::interpolateAtCentroid, ir::Type::f32, {}, slot);
            case GLSLstd450InterpolateAtSample:
                return emitter_.emit(Op::interpolateAtSample, ir::Type::f32, {indexOf(inst[6])}, slot);
            default:
                return emitter_.emit(Op::interpolateAtOffset, ir::Type::f32, {at[0], at[1]}, slot);
        }
    };
    const LeafTypes types = leafTypes(inst[1]);
    const NewScalars leaves = newLeaves(types.size());
    for (uint32_t i = 0; i < leaves.size(); ++i) {
        if (types[i] != ir::Type::f32) refuse(inst, "the interpolant is not of 32-bit floats");
        if (pointer.dynamic == ir::kNoValue) {
            leaves[i] = interpolated(pointer.root + pointer.offset + i);
            continue;
        }
        // All that an index could mean; one out of range means the last.
        const NewScalars choices = newLeaves(pointer.extent);
        for (uint32_t slot = 0; slot < pointer.extent; ++slot) {
            const bool fits = program_.inputs[pointer.root + slot].type == ir::Type::f32;
            choices[slot] = fits ? interpolated(pointer.root + slot) : emitter_.undef(ir::Type::f32);
        }
        leaves[i] = chooseLeaf(choices, place(pointer, i));
    }
    setValue(inst[2], inst[1], leaves);
}

}  // namespace vernier
