// Recomputes what a Program tells about itself.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Sets the facts at the end of Program from its instructions, readOnly of every resource, and drops inputs and outputs
/// that no instruction names (indices are renumbered). earlyFragmentTests, postDepthCoverage, localWords and localSize
/// are left alone.
void analyse(Program& program);

}  // namespace vernier::ir
