#include <algorithm>
#include <unordered_map>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

bool isCommutative(Op op) {
    switch (op) {
        case Op::fadd:
        case Op::fmul:
        case Op::iadd:
        case Op::imul:
        case Op::iand:
        case Op::ior:
        case Op::ixor:
        case Op::band:
        case Op::bor:
        case Op::bxor:
        case Op::ieq:
        case Op::ine:
        case Op::foeq:
        case Op::fone:
        case Op::fueq:
        case Op::fune:
            return true;
        default:
            return false;
    }
}

struct Seen {
    Inst* inst;
    BlockId block;
    uint32_t next;  // of the same hash; 0 = none
};

}  // namespace

bool eliminateCommon(Program& program) {
    const Cfg cfg(program);
    std::vector<ValueId> replacement(program.valueTypes.size(), kNoValue);
    std::unordered_map<uint64_t, uint32_t> first;
    std::vector<Seen> seen(1);
    bool changed = false;
    const auto hashOf = [&](const Inst& inst) {
        uint64_t hash = static_cast<uint64_t>(inst.op) << 8 | static_cast<uint64_t>(inst.type);
        const auto mix = [&hash](uint64_t value) { hash = (hash ^ value) * 0x9E3779B97F4A7C15ull, hash ^= hash >> 29; };
        mix(inst.imm);
        for (const ValueId operand : program.operandsOf(inst)) mix(operand);
        return hash;
    };
    const auto equal = [&](const Inst& a, const Inst& b) {
        return a.op == b.op && a.type == b.type && a.imm == b.imm &&
               std::ranges::equal(program.operandsOf(a), program.operandsOf(b));
    };
    for (BlockId b = 0; b < program.blocks.size(); ++b) {
        for (Inst& inst : program.blocks[b].insts) {
            for (uint32_t i = 0; i < inst.operandCount; ++i) {
                ValueId& operand = program.operands[inst.firstOperand + i];
                operand = resolve(replacement, operand);
            }
            if (!isMovable(program, inst)) continue;
            if (isCommutative(inst.op)) {
                ValueId* operands = program.operands.data() + inst.firstOperand;
                if (operands[0] > operands[1]) std::swap(operands[0], operands[1]);
            }
            uint32_t& head = first[hashOf(inst)];
            bool found = false;
            for (uint32_t s = head; s != 0 && !found; s = seen[s].next) {
                if (!equal(*seen[s].inst, inst) || !cfg.dominates(seen[s].block, b)) continue;
                replacement[inst.result] = seen[s].inst->result;
                seen[s].inst->noContraction |= inst.noContraction;
                seen[s].inst->relaxed &= inst.relaxed;
                found = changed = true;
            }
            if (found) continue;
            seen.push_back({&inst, b, head});
            head = static_cast<uint32_t>(seen.size() - 1);
        }
    }
    if (changed) replaceUses(program, replacement);
    return changed;
}

}  // namespace vernier::ir
