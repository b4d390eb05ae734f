// Positions that were built and measured, and that the dial does not have: what each would have saved, and what it
// would have cost.
#pragma once

#include <span>

namespace vernier::bench {

struct RemovedPosition {
    const char* axis;
    const char* position;
    const char* saved;    // of time, and of what
    const char* error;    // beside what is computed
    const char* verdict;  // why it is not offered
};

std::span<const RemovedPosition> removedPositions();

}  // namespace vernier::bench
