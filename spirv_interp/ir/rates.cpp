#include "spirv_interp/ir/rates.h"

#include <algorithm>

#include "spirv_interp/ir/cost.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

Rate rateOfFragmentInput(const Program& program, const InterfaceSlot& slot) {
    switch (slot.builtin) {
        case Builtin::frontFacing:
        case Builtin::primitiveId:
        case Builtin::layer:
        case Builtin::viewportIndex:
        case Builtin::viewIndex:
            return Rate::primitive;
        case Builtin::sampleId:
        case Builtin::samplePosition:
            return Rate::sample;
        case Builtin::fragCoord:
        case Builtin::pointCoord:
        case Builtin::sampleMaskIn:
            return program.perSample ? Rate::sample : Rate::pixel;
        default:
            if (slot.interpolation == Interpolation::flat) return Rate::primitive;
            return slot.sampling == Sampling::sample ? Rate::sample : Rate::pixel;
    }
}

Rate rateOfInput(const Program& program, const InterfaceSlot& slot) {
    if (program.stage == Stage::fragment) return rateOfFragmentInput(program, slot);
    switch (slot.builtin) {
        case Builtin::numWorkgroups:
            return Rate::draw;
        case Builtin::workgroupId:
            return Rate::workGroup;
        case Builtin::instanceIndex:
        case Builtin::baseVertex:
        case Builtin::baseInstance:
        case Builtin::drawIndex:
        case Builtin::viewIndex:
            return Rate::instance;
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
                case Op::interpolateAtCentroid:
                case Op::interpolateAtSample:
                case Op::interpolateAtOffset:
                    rate = rateOfInput(program, program.inputs[inst.imm]);
                    break;
                case Op::inputIndexed:
                    for (uint32_t k = 0; k < immHigh(inst); ++k) {
                        rate = std::max(rate, rateOfInput(program, program.inputs[immLow(inst) + k]));
                    }
                    break;
                case Op::subgroupInvocation:
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

namespace {

/// The sum of weightOf(inst) by the rate of the result.
template <class F>
std::array<uint32_t, kRateCount> sumByRate(const Program& program, F&& weightOf) {
    const std::vector<Rate> rates = computeRates(program);
    std::array<uint32_t, kRateCount> sums{};
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            const bool leaf = inst.op == Op::constant || inst.op == Op::undef || inst.op == Op::input ||
                              inst.op == Op::phi || inst.op == Op::copy;
            if (inst.result != kNoValue && !leaf) sums[static_cast<size_t>(rates[inst.result])] += weightOf(inst);
        }
    }
    return sums;
}

}  // namespace

std::array<uint32_t, kRateCount> countByRate(const Program& program) {
    return sumByRate(program, [](const Inst&) { return 1u; });
}

std::array<uint32_t, kRateCount> costByRate(const Program& program) {
    return sumByRate(program, [&](const Inst& inst) {
        const uint32_t cost = costOf(program, inst);
        return cost < kTooDear ? cost : inst.op == Op::image ? kImageCost : kAccessCost;
    });
}

std::string_view rateName(Rate rate) {
    constexpr std::string_view kNames[kRateCount] = {"constant",  "draw",  "work-group", "instance",
                                                     "primitive", "pixel", "sample",     "invocation"};
    return kNames[static_cast<size_t>(rate)];
}

}  // namespace vernier::ir
