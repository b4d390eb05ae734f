#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {

bool contract(Program& program) {
    std::vector<const Inst*> product(program.valueTypes.size(), nullptr);
    std::vector<uint32_t> uses(program.valueTypes.size(), 0);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (inst.op == Op::fmul && !inst.noContraction) product[inst.result] = &inst;
            for (const ValueId operand : program.operandsOf(inst)) ++uses[operand];
        }
    }
    bool changed = false;
    for (Block& block : program.blocks) {
        for (Inst& inst : block.insts) {
            if (inst.op != Op::fadd || inst.noContraction) continue;
            for (uint32_t k = 0; k < 2; ++k) {
                const ValueId factor = program.operands[inst.firstOperand + k];
                const ValueId addend = program.operands[inst.firstOperand + 1 - k];
                const Inst* mul = product[factor];
                if (mul == nullptr || uses[factor] != 1) continue;
                const ValueId x = program.operands[mul->firstOperand], y = program.operands[mul->firstOperand + 1];
                inst.op = Op::ffma;
                inst.firstOperand = static_cast<uint32_t>(program.operands.size());
                inst.operandCount = 3;
                program.operands.insert(program.operands.end(), {x, y, addend});
                changed = true;
                break;
            }
        }
    }
    return changed;
}

}  // namespace vernier::ir
