#include "spirv_interp/ir/limit_vertices.h"

#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/optimise.h"

namespace vernier::ir {

void limitVertices(Program& program, uint32_t vertices) {
    bool changed = false;
    for (Block& block : program.blocks) {
        for (Inst& inst : block.insts) {
            if (inst.op == Op::inputIndexed) {
                // Vertex by vertex: what stays is the begin.
                const uint32_t first = immLow(inst), count = immHigh(inst);
                uint32_t kept = 0;
                while (kept < count && program.inputs[first + kept].index <= vertices) ++kept;
                if (kept == 0 || kept == count) continue;
                inst.imm = immPair(first, kept);
                changed = true;
            } else if (immKind(inst.op) == ImmKind::input && program.inputs[inst.imm].index > vertices) {
                inst.op = Op::constant;
                inst.operandCount = 0;
                inst.imm = 0;
                changed = true;
            }
        }
    }
    if (changed) optimise(program);
}

}  // namespace vernier::ir
