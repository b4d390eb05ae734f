#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {
namespace {

/// An output that is never given a value need not exist; it is undefined either way. One that some vertices of a
/// geometry program have is stored for all of them.
bool dropUndefinedOutputs(Program& program) {
    std::vector<bool> undefined(program.valueTypes.size(), false);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (inst.op == Op::undef) undefined[inst.result] = true;
        }
    }
    std::vector<bool> stored(program.outputs.size(), false);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (inst.op == Op::storeVertex && !undefined[program.operandsOf(inst)[1]]) stored[inst.imm] = true;
        }
    }
    bool changed = false;
    for (Block& block : program.blocks) {
        changed |= std::erase_if(block.insts, [&](const Inst& inst) {
                       if (inst.op == Op::storeVertex) return !stored[inst.imm];
                       return inst.op == Op::storeOutput && undefined[program.operands[inst.firstOperand]];
                   }) != 0;
    }
    return changed;
}

}  // namespace

bool removeDead(Program& program) {
    std::vector<const Inst*> definition(program.valueTypes.size(), nullptr);
    std::vector<bool> live(program.valueTypes.size(), false);
    std::vector<const Inst*> work;
    bool changed = dropUndefinedOutputs(program);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) definition[inst.result + r] = &inst;
            if (hasSideEffect(program, inst)) work.push_back(&inst);
        }
    }
    while (!work.empty()) {
        const Inst* inst = work.back();
        work.pop_back();
        for (const ValueId operand : program.operandsOf(*inst)) {
            const Inst* from = definition[operand];
            // An instruction lives when its first result is marked; the others go with it.
            if (from == nullptr || live[from->result]) continue;
            live[from->result] = true;
            work.push_back(from);
        }
    }
    for (Block& block : program.blocks) {
        changed |= std::erase_if(block.insts, [&](const Inst& inst) {
                       return !hasSideEffect(program, inst) && !live[inst.result];
                   }) != 0;
    }
    return changed;
}

}  // namespace vernier::ir
