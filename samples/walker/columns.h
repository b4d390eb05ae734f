// The classic version: from the player's sector outwards through a queue of windows, a vertical line per column for
// each ceiling, floor, step and wall; every pixel is drawn once.
#pragma once

#include <vector>

#include "samples/walker/view.h"

namespace samples {

/// A line down the middle of one column, from edge to edge of its pixels, as two vertices.
struct ColumnVertex {
    float x, y;       // pixels
    uint32_t number;  // surfaceNumber() and kDarkColumn
    float depth;      // of walls the distance, of floors and ceilings their height above the eye
};

struct ColumnStatistics {
    uint32_t windows = 0, sectors = 0, mostQueued = 0;
};

constexpr uint32_t kMostQueued = 256;  // windows; more are not looked through
constexpr uint32_t kMostVisits = 32;   // of one sector

std::vector<ColumnVertex> drawColumns(const Map& map, const View& view, ColumnStatistics* statistics = nullptr);

}  // namespace samples
