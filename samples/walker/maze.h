// Mazes as map texts, to see how the walker scales.
#pragma once

#include <cstdint>
#include <string>

namespace samples {

/// columns x rows square sectors, all reachable from each other: a spanning tree by depth-first search, and a few
/// loops. Floors differ by steps that can be climbed.
std::string mazeMap(uint32_t columns, uint32_t rows, uint64_t seed);

}  // namespace samples
