#include "spirv_interp/ir/optimise.h"

#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {

void optimise(Program& program, const OptimiseOptions& options) {
    removeUnreachable(program);
    removeDead(program);
    // Which resources are only read, for the passes that move loads.
    analyse(program);
    // A branch that goes away exposes constants and equal values, and the other way round; two rounds find nearly all.
    // The first puts loops into the shape that unrolling knows.
    for (int round = 0; round < 2; ++round) {
        bool changed = simplifyPhis(program);
        changed |= foldConstants(program);
        changed |= eliminateCommon(program);
        changed |= removeDead(program);
        changed |= foldBranches(program);
        changed |= convertIfs(program);
        if (round == 0) changed |= unrollLoops(program);
        if (!changed) break;
    }
    foldBranches(program);
    simplifyPhis(program);
    foldConstants(program);
    if (options.contract) contract(program);
    removeDead(program);
    closeLoops(program);
    compact(program);
    analyse(program);
}

}  // namespace vernier::ir
