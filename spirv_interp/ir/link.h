// Joins two stages: what one writes and the other does not read is not computed.
#pragma once

#include "base/result.h"
#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Outputs of `vertex` that `fragment` does not read are removed with the code behind them (built-in ones stay). Inputs
/// of `fragment` that nothing writes become 0; where such an input is part of an array indexed at run time, `vertex`
/// gets an output that is 0 instead, so that afterwards every user input of `fragment` has the output of the same
/// location, component and type. Both programs are optimised again and verify. An invalidArgument Error when an output
/// and the input of the same place differ in type ("Interface Matching" in the Vulkan specification); the programs are
/// then unchanged.
Status linkStages(Program& vertex, Program& fragment);

}  // namespace vernier::ir
