// The commands of vernier-spirv. Each prints to stdout and returns an exit code: 0, or 1 for a module that is not what
// it should be; what went wrong is an Error.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "spirv_interp/tool/invocation.h"
#include "spirv_interp/tool/module_input.h"

namespace vernier::tool {

struct IrOptions {
    bool contract = false;
    bool passes = false;   // before and after every pass that changes something
    std::string after;     // only after this pass
    bool listing = false;  // the batch code too
};

struct RunOptions {
    std::string engine = "both";  // "batch", "reference" or "both"
    MathTier tier = MathTier::standard;
};

struct StepOptions {
    bool all = false;  // the whole trace, without commands
};

struct ProfileOptions {
    bool mpfr = false;  // against 128 bits, not double
    uint32_t count = 20;
};

Result<int> validate(const ModuleInput& input);
Result<int> disassemble(const ModuleInput& input);
Result<int> printIr(const ModuleInput& input, const IrOptions& options);
Result<int> printRates(const ModuleInput& input);
Result<int> printCost(const ModuleInput& input, const IrOptions& options);
Result<int> run(const ModuleInput& input, const Invocation& invocation, const RunOptions& options);
Result<int> step(const ModuleInput& input, const Invocation& invocation, const StepOptions& options);
Result<int> profile(const ModuleInput& input, const Invocation& invocation, const ProfileOptions& options);

}  // namespace vernier::tool
