// Subgroup operations to machine code.
#include "spirv_interp/batch/lowerer.h"

namespace vernier::batch {

void Lowerer::lowerSubgroup(const ir::Inst& inst) {
    const auto operands = program_.operandsOf(inst);
    const auto put = [this](Op op, std::vector<Operand> places) { emit(op, std::move(places)).inPlace = false; };
    switch (inst.op) {
        case ir::Op::subgroupInvocation:
            return put(Op::subgroupInvocation, {target(inst)});
        case ir::Op::subgroupBallot: {
            const ir::Inst* condition = facts_.definition[operands[0]];
            if (condition != nullptr && condition->op == ir::Op::constant && condition->imm != 0) {
                return put(Op::subgroupActive, {target(inst)});
            }
            const Operand from = rowOf(operands[0]);
            return put(Op::subgroupBallot, {target(inst), from});
        }
        case ir::Op::subgroupShuffle: {
            const Operand from = rowOf(operands[0]), place = operandOf(operands[1]);
            return put(place.isScalar() ? Op::subgroupBroadcast : Op::subgroupShuffle, {target(inst), from, place});
        }
        case ir::Op::quadShuffle: {
            const Operand from = rowOf(operands[0]), place = rowOf(operands[1]);
            return put(Op::quadShuffle, {target(inst), from, place});
        }
        default: {
            const ir::Reduction reduction = ir::reductionOf(inst);
            const uint32_t packed = static_cast<uint32_t>(reduction.op) | static_cast<uint32_t>(reduction.mode) << 8 |
                                    reduction.cluster << 16;
            const Operand from = rowOf(operands[0]);
            return put(isWide(inst.result) ? Op::subgroupReduce64 : Op::subgroupReduce,
                       {target(inst), from, Operand::number(packed)});
        }
    }
}

}  // namespace vernier::batch
