#include "spirv_interp/ir/optimise.h"

#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/passes.h"

namespace vernier::ir {

void optimise(Program& program, const OptimiseOptions& options) {
    const auto show = [&](std::string_view pass) {
        if (options.observer != nullptr) (*options.observer)(pass, program);
    };
    const auto run = [&](std::string_view name, bool (*pass)(Program&)) {
        const bool changed = pass(program);
        if (changed) show(name);
        return changed;
    };
    show("lowering");
    removeUnreachable(program);
    run("removeDead", removeDead);
    // Which resources are only read, for the passes that move loads.
    analyse(program);
    // A branch that goes away exposes constants and equal values, and the other way round; two rounds find nearly all.
    // The first puts loops into the shape that unrolling knows; how much of them is known shows when they are small.
    int rounds = 2;
    bool unrolls = true;
    for (int round = 0; round < rounds; ++round) {
        bool changed = run("simplifyPhis", simplifyPhis);
        changed |= run("foldConstants", foldConstants);
        changed |= run("eliminateCommon", eliminateCommon);
        changed |= run("removeDead", removeDead);
        changed |= run("foldBranches", foldBranches);
        changed |= run("convertIfs", convertIfs);
        if (round == 0) changed |= run("unrollLoops", unrollLoops);
        if (unrolls && (round > 0 || !changed)) {
            unrolls = false;
            if (run("unrollConstantLoops", unrollConstantLoops)) {
                changed = true;
                rounds = round + 2;
            }
        }
        if (!changed) break;
    }
    run("foldBranches", foldBranches);
    run("simplifyPhis", simplifyPhis);
    run("foldConstants", foldConstants);
    run("reduceStrength", reduceStrength);
    if (options.contract) run("contract", contract);
    run("hoistInvariants", hoistInvariants);
    run("removeDead", removeDead);
    run("closeLoops", closeLoops);
    compact(program);
    analyse(program);
    show("compact");
}

}  // namespace vernier::ir
