// Joins two stages: what one writes and the other does not read is not computed.
#pragma once

#include <span>

#include "base/result.h"
#include "spirv_interp/ir/ir.h"
#include "spirv_interp/ir/lift.h"

namespace vernier::ir {

struct LinkOptions {
    bool dropUnread = true;                 // outputs that nobody reads
    std::span<const InterfaceSlot> kept{};  // but not those in the places of these: somebody else reads them
    bool lift = true;                       // work moves from `fragment` to `vertex` where that pays (ir/lift.h)
    bool liftLinear = false;                // also where the result differs in its last bits
};

struct LinkFacts {
    uint32_t removedOutputs = 0;  // of the vertex program, because nobody reads them
    LiftFacts lifted;             // from the fragment program, now done per vertex
};

/// Outputs of `vertex` that `fragment` does not read are removed with the code behind them (built-in ones stay) unless
/// `options` keep them. Inputs of `fragment` that nothing writes become 0; where such an input is part of an array
/// indexed at run time, `vertex` gets an output that is 0 instead, so that afterwards every user input of `fragment`
/// has the output of the same location, component and type. Both programs come as optimise() leaves them, go so, and
/// verify. An invalidArgument Error when an output and the input of the same place differ in type ("Interface Matching"
/// in the Vulkan specification); the programs are then unchanged.
Status linkStages(Program& vertex, Program& fragment, LinkFacts* facts = nullptr, const LinkOptions& options = {});

}  // namespace vernier::ir
