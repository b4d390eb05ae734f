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
    // Work moves from a fragment program into the one before where that pays (ir/lift.h), unless that is of geometry.
    bool lift = true;
    bool liftLinear = false;  // also where the result differs in its last bits
};

struct LinkFacts {
    uint32_t removedOutputs = 0;  // of `producer`, because nobody reads them
    LiftFacts lifted;             // from the fragment program, now done per vertex
};

/// Two stages that follow each other: vertex, control, evaluation, geometry, fragment, without those that a pipeline
/// does not have. Outputs of `producer` that `consumer` does not read are removed with the code behind them, unless
/// `options` keep them; built-in ones stay in front of the rasteriser. Inputs of `consumer` that nothing writes become
/// 0. Where such an input is part of an array indexed at run time, a producer of values to be interpolated gets an
/// output that is 0 instead, so that afterwards every user input of a fragment program has the output of the same
/// location, component and type; who runs other stages, and what a geometry stage puts out, gives 0. Both programs come
/// as optimise() leaves them, go so, and verify. An invalidArgument Error when an output and the input of the same
/// place differ in type ("Interface Matching" in the Vulkan specification); the programs are then unchanged.
Status linkStages(Program& producer, Program& consumer, LinkFacts* facts = nullptr, const LinkOptions& options = {});

/// Whether the producer has an output of the same place and type for every input of the consumer that comes from it:
/// both can then run as they are, unlinked.
bool writesAll(const Program& producer, const Program& consumer);

}  // namespace vernier::ir
