// Positions that the dial does not have: what each would save, what it would cost, and how that is known.
#pragma once

#include <span>

namespace vernier::bench {

struct RemovedPosition {
    const char* axis;
    const char* position;
    const char* saved;    // of time, and of what
    const char* error;    // beside what is computed
    const char* verdict;  // why it is not offered
    const char* known;    // from what: built into the renderer, its arithmetic alone, or not built
};

std::span<const RemovedPosition> removedPositions();

}  // namespace vernier::bench
