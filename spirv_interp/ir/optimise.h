// The passes in the order that loading and linking want.
#pragma once

#include <functional>
#include <string_view>

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Sees the program as it came (pass "lowering"), and after every pass that changed it, by the pass's name in passes.h.
using PassObserver = std::function<void(std::string_view pass, const Program& program)>;

struct OptimiseOptions {
    bool contract = false;
    const PassObserver* observer = nullptr;
};

/// Accepts unreachable blocks and programs out of loop-closed form; afterwards the program verifies if it was sound,
/// its values are numbered without holes, and its facts are right (analyse.h).
void optimise(Program& program, const OptimiseOptions& options = {});

}  // namespace vernier::ir
