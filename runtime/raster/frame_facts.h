// What a frame ran and left out, told from what it counted.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/plan/fact.h"
#include "runtime/raster/pass_targets.h"

namespace vernier {

struct FrameCommands {
    uint64_t draws = 0, dispatches = 0;
};

std::vector<Fact> frameFacts(const FrameCommands& commands, const PassStatistics& statistics);

}  // namespace vernier
