#include "spirv_interp/ir/rates.h"

#include <algorithm>

#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

Rate rateOf(Builtin builtin) {
    switch (builtin) {
        case Builtin::numWorkgroups:
            return Rate::draw;
        case Builtin::workgroupId:
            return Rate::workGroup;
        default:
            return Rate::invocation;
    }
}

}  // namespace

std::vector<Rate> computeRates(const Program& program) {
    std::vector<Rate> rates(program.valueTypes.size(), Rate::invocation);
    // In structured order definitions come before uses, except round a loop, where a phi is in between: and which
    // operand a phi takes is a matter of the invocation's way, so its rate is never lower.
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (!isMovable(program, inst)) continue;
            Rate rate = opInfo(inst.op).kind == 'R' ? Rate::draw : Rate::constant;
            switch (inst.op) {
                case Op::input:
                    rate = rateOf(program.inputs[inst.imm].builtin);
                    break;
                case Op::inputIndexed:
                case Op::subgroupInvocation:
                case Op::interpolateAtCentroid:
                case Op::interpolateAtSample:
                case Op::interpolateAtOffset:
                    rate = Rate::invocation;
                    break;
                default:
                    break;
            }
            for (const ValueId operand : program.operandsOf(inst)) rate = std::max(rate, rates[operand]);
            rates[inst.result] = rate;
        }
    }
    return rates;
}

}  // namespace vernier::ir
