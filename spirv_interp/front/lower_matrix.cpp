// Products of vectors and matrices. A matrix lies column after column in its leaves. Sums run from the first term to
// the last, so that the rounding is the same wherever the code runs.
#include "spirv_interp/front/lowering.h"

namespace vernier {

ir::ValueId Lowering::dot(Leaves a, Leaves b) {
    ir::ValueId sum = mul(a[0], b[0]);
    for (size_t i = 1; i < a.size(); ++i) sum = add(sum, mul(a[i], b[i]));
    return sum;
}

bool Lowering::lowerMatrix(const Instruction& inst) {
    const auto rowsOf = [this](uint32_t matrix) { return typeInfo(typeInfo(typeOfId(matrix)).element).count; };
    const auto result = [&] { return newLeaves(leafTypes(inst[1]).size()); };
    // sum over k of matrix[column k][row] * vector[k]
    const auto rowTimes = [this](Leaves matrix, uint32_t rows, uint32_t row, Leaves vector) {
        ir::ValueId sum = mul(matrix[row], vector[0]);
        for (uint32_t k = 1; k < vector.size(); ++k) sum = add(sum, mul(matrix[k * rows + row], vector[k]));
        return sum;
    };
    NewScalars leaves;
    switch (inst.op) {
        case spv::Op::OpDot:
            leaves = newLeaves(1);
            leaves[0] = dot(leavesOf(inst[3]), leavesOf(inst[4]));
            break;
        case spv::Op::OpVectorTimesScalar:
        case spv::Op::OpMatrixTimesScalar: {
            leaves = result();
            const Leaves operand = leavesOf(inst[3]);
            const ir::ValueId scalar = scalarOf(inst[4]);
            for (size_t i = 0; i < leaves.size(); ++i) leaves[i] = mul(operand[i], scalar);
            break;
        }
        case spv::Op::OpVectorTimesMatrix: {
            leaves = result();
            const Leaves vector = leavesOf(inst[3]), matrix = leavesOf(inst[4]);
            for (size_t c = 0; c < leaves.size(); ++c) {
                leaves[c] = dot(vector, matrix.subspan(c * vector.size(), vector.size()));
            }
            break;
        }
        case spv::Op::OpMatrixTimesVector: {
            leaves = result();
            const Leaves matrix = leavesOf(inst[3]), vector = leavesOf(inst[4]);
            const auto rows = static_cast<uint32_t>(leaves.size());
            for (uint32_t r = 0; r < rows; ++r) leaves[r] = rowTimes(matrix, rows, r, vector);
            break;
        }
        case spv::Op::OpMatrixTimesMatrix: {
            leaves = result();
            const Leaves a = leavesOf(inst[3]), b = leavesOf(inst[4]);
            const uint32_t rows = rowsOf(inst[3]), inner = rowsOf(inst[4]);
            for (uint32_t i = 0; i < leaves.size(); ++i) {
                leaves[i] = rowTimes(a, rows, i % rows, b.subspan(i / rows * inner, inner));
            }
            break;
        }
        case spv::Op::OpOuterProduct: {
            leaves = result();
            const Leaves column = leavesOf(inst[3]), row = leavesOf(inst[4]);
            for (size_t i = 0; i < leaves.size(); ++i)
                leaves[i] = mul(column[i % column.size()], row[i / column.size()]);
            break;
        }
        case spv::Op::OpTranspose: {
            leaves = result();
            const Leaves matrix = leavesOf(inst[3]);
            const uint32_t rows = rowsOf(inst[3]);
            const auto columns = static_cast<uint32_t>(matrix.size() / rows);
            for (uint32_t i = 0; i < leaves.size(); ++i) leaves[i] = matrix[i % columns * rows + i / columns];
            break;
        }
        default:
            return false;
    }
    setValue(inst[2], inst[1], rounded(inst[1], leaves));
    return true;
}

}  // namespace vernier
