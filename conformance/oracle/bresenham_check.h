// What the specification asks of Bresenham lines beyond single pixels (Vulkan, Bresenham Line Segment Rasterization):
// implementations may differ from the diamond-exit rule, within four conditions.
#pragma once

#include "conformance/oracle/lines.h"

#include <span>
#include <string>

namespace vernier::conformance::exact {

/// Judges the fragments of connected segments of one major axis and direction, in any order, each fragment once,
/// against those of the diamond-exit rule:
///   1. none deviates by more than one unit in x or y from a fragment of the rule,
///   2. their number differs by one at most for each segment,
///   3. no column of x-major lines (no row of y-major ones) has two of them,
///   4. connected segments leave no column (row) out. (That no fragment comes twice is the caller's to see.)
/// Empty text: permitted; else the condition that is broken, with its number, and where.
std::string checkBresenham(std::span<const PixelIndex> exactly, std::span<const PixelIndex> observed, bool xMajor,
                           size_t segments = 1);

}  // namespace vernier::conformance::exact
