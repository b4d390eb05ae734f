#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {

bool simplifyPhis(Program& program) {
    const Cfg cfg(program);
    const std::vector<BlockId> home = definingBlocks(program);
    std::vector<bool> undefined(program.valueTypes.size(), false);
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            if (inst.op == Op::undef) undefined[inst.result] = true;
        }
    }
    std::vector<ValueId> replacement(program.valueTypes.size(), kNoValue);
    bool any = false;
    // A phi that goes may make another one trivial: again until nothing changes.
    for (bool changed = true; changed;) {
        changed = false;
        for (BlockId b = 0; b < program.blocks.size(); ++b) {
            for (const Inst& phi : program.blocks[b].insts) {
                if (phi.op != Op::phi) break;
                if (replacement[phi.result] != kNoValue) continue;
                ValueId same = kNoValue, unknown = kNoValue;
                bool trivial = true;
                for (const ValueId operand : program.operandsOf(phi)) {
                    const ValueId value = resolve(replacement, operand);
                    if (value == phi.result || value == same) continue;
                    if (undefined[value]) {
                        unknown = value;
                    } else {
                        trivial = trivial && same == kNoValue;
                        same = value;
                    }
                }
                if (!trivial) continue;
                // Where an operand is undefined, the other may stand for it only if it exists on every way here.
                if (same != kNoValue && unknown != kNoValue && (home[same] == b || !cfg.dominates(home[same], b)))
                    continue;
                if (same == kNoValue) same = unknown;
                if (same == kNoValue) continue;
                replacement[phi.result] = same;
                changed = any = true;
            }
        }
    }
    if (!any) return false;
    for (Block& block : program.blocks) {
        std::erase_if(block.insts,
                      [&](const Inst& inst) { return inst.op == Op::phi && replacement[inst.result] != kNoValue; });
    }
    replaceUses(program, replacement);
    return true;
}

}  // namespace vernier::ir
