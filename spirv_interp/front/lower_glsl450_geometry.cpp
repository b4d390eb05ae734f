// GLSL.std.450: functions of whole vectors and matrices, by the formulas of the extended instruction set's
// specification.
#include <spirv/unified1/GLSL.std.450.h>

#include "spirv_interp/front/lowering.h"

namespace vernier {

using ir::Op;

bool Lowering::lowerGeometric(const Instruction& inst) {
    const auto operand = [&](uint32_t k) { return leavesOf(inst[5 + k]); };
    const auto minus = [this](Leaves a, Leaves b) {
        const NewScalars leaves = newLeaves(a.size());
        for (size_t i = 0; i < a.size(); ++i) leaves[i] = sub(a[i], b[i]);
        return leaves;
    };
    const auto length = [this](Leaves v) {
        return v.size() == 1 ? unary(Op::fabs, v[0]) : unary(Op::fsqrt, dot(v, v));
    };
    NewScalars leaves;
    switch (inst[4]) {
        case GLSLstd450Length:
            leaves = newLeaves(1);
            leaves[0] = length(operand(0));
            break;
        case GLSLstd450Distance:
            leaves = newLeaves(1);
            leaves[0] = length(minus(operand(0), operand(1)));
            break;
        case GLSLstd450Cross: {
            const Leaves a = operand(0), b = operand(1);
            leaves = newLeaves(3);
            for (size_t i = 0; i < 3; ++i) {
                const size_t j = (i + 1) % 3, k = (i + 2) % 3;
                leaves[i] = sub(mul(a[j], b[k]), mul(b[j], a[k]));
            }
            break;
        }
        case GLSLstd450Normalize:
            lowerNormalize(inst);
            return true;
        case GLSLstd450FaceForward: {
            const Leaves n = operand(0);
            const ir::ValueId d = dot(operand(2), operand(1));
            const ir::ValueId facing = compare(Op::folt, d, emitter_.constantFloat(emitter_.typeOf(d), 0));
            leaves = newLeaves(n.size());
            for (size_t i = 0; i < n.size(); ++i) {
                leaves[i] = emitter_.emit(Op::select, emitter_.typeOf(d), {facing, n[i], unary(Op::fneg, n[i])});
            }
            break;
        }
        case GLSLstd450Reflect: {
            const Leaves i = operand(0), n = operand(1);
            const ir::ValueId d = dot(n, i);
            const ir::ValueId twice = mul(emitter_.constantFloat(emitter_.typeOf(d), 2), d);
            leaves = newLeaves(i.size());
            for (size_t c = 0; c < i.size(); ++c) leaves[c] = sub(i[c], mul(twice, n[c]));
            break;
        }
        case GLSLstd450Refract:
            lowerRefract(inst);
            return true;
        case GLSLstd450Determinant:
            leaves = newLeaves(1);
            leaves[0] = determinant(operand(0), typeInfo(typeOfId(inst[5])).count);
            break;
        case GLSLstd450MatrixInverse:
            lowerInverse(inst);
            return true;
        default:
            return false;
    }
    setValue(inst[2], inst[1], rounded(inst[1], leaves));
    return true;
}

void Lowering::lowerNormalize(const Instruction& inst) {
    const Leaves v = leavesOf(inst[5]);
    const NewScalars leaves = newLeaves(v.size());
    if (v.size() == 1) {
        leaves[0] = unary(Op::fsign, v[0]);
    } else {
        const ir::ValueId scale = unary(Op::finverseSqrt, dot(v, v));
        for (size_t i = 0; i < v.size(); ++i) leaves[i] = mul(v[i], scale);
    }
    setValue(inst[2], inst[1], rounded(inst[1], leaves));
}

/// k = 1 - eta * eta * (1 - dot(N, I)^2); 0 when k < 0, otherwise eta * I - (eta * dot(N, I) + sqrt(k)) * N.
void Lowering::lowerRefract(const Instruction& inst) {
    const Leaves i = leavesOf(inst[5]), n = leavesOf(inst[6]);
    const ir::Type type = emitter_.typeOf(i[0]);
    // eta may be of another float width than the vectors.
    ir::ValueId eta = scalarOf(inst[7]);
    if (emitter_.typeOf(eta) != type) eta = convert(Op::ftof, type, eta);
    const ir::ValueId one = emitter_.constantFloat(type, 1), zero = emitter_.constantFloat(type, 0);
    const ir::ValueId d = dot(n, i);
    const ir::ValueId k = sub(one, mul(mul(eta, eta), sub(one, mul(d, d))));
    const ir::ValueId total = compare(Op::folt, k, zero);
    const ir::ValueId along = add(mul(eta, d), unary(Op::fsqrt, k));
    const NewScalars leaves = newLeaves(i.size());
    for (size_t c = 0; c < i.size(); ++c) {
        leaves[c] = emitter_.emit(Op::select, type, {total, zero, sub(mul(eta, i[c]), mul(along, n[c]))});
    }
    setValue(inst[2], inst[1], rounded(inst[1], leaves));
}

/// By the first column (Laplace). `m` is column-major.
ir::ValueId Lowering::determinant(Leaves m, uint32_t size) {
    if (size == 1) return m[0];
    if (size == 2) return sub(mul(m[0], m[3]), mul(m[2], m[1]));
    ir::ValueId sum = ir::kNoValue;
    for (uint32_t row = 0; row < size; ++row) {
        const ir::ValueId term = mul(m[row], minorOf(m, size, 0, row));
        sum = row == 0 ? term : row % 2 == 1 ? sub(sum, term) : add(sum, term);
    }
    return sum;
}

/// The determinant of what is left without a column and a row.
ir::ValueId Lowering::minorOf(Leaves m, uint32_t size, uint32_t column, uint32_t row) {
    const NewScalars rest = newLeaves((size - 1) * (size - 1));
    size_t next = 0;
    for (uint32_t c = 0; c < size; ++c) {
        for (uint32_t r = 0; r < size; ++r) {
            if (c != column && r != row) rest[next++] = m[c * size + r];
        }
    }
    return determinant(rest, size - 1);
}

/// The adjugate over the determinant; the minors of the first column serve both.
void Lowering::lowerInverse(const Instruction& inst) {
    const Leaves m = leavesOf(inst[5]);
    const uint32_t size = typeInfo(inst[1]).count;
    const ir::Type type = emitter_.typeOf(m[0]);
    const NewScalars cofactors = newLeaves(m.size());
    for (uint32_t c = 0; c < size; ++c) {
        for (uint32_t r = 0; r < size; ++r) {
            const ir::ValueId minor = minorOf(m, size, c, r);
            cofactors[c * size + r] = (c + r) % 2 == 1 ? unary(Op::fneg, minor) : minor;
        }
    }
    const ir::ValueId det = dot(m.first(size), cofactors.first(size));
    const ir::ValueId scale = emitter_.emit(Op::fdiv, type, {emitter_.constantFloat(type, 1), det});
    const NewScalars leaves = newLeaves(m.size());
    for (uint32_t c = 0; c < size; ++c) {
        for (uint32_t r = 0; r < size; ++r) leaves[c * size + r] = mul(cofactors[r * size + c], scale);
    }
    setValue(inst[2], inst[1], rounded(inst[1], leaves));
}

}  // namespace vernier
