// A font made of strokes, drawn into a bitmap of 16 x 6 cells: the characters from space to '~', and a block for those
// beyond.
#pragma once

#include <cstdint>
#include <vector>

namespace samples {

constexpr uint32_t kFontColumns = 16, kFontRows = 6;
constexpr uint32_t kFontFirst = 32;

/// Coverage 0..255 of kFontColumns * width by kFontRows * height texels, where a cell is 6 units wide and 10 high and a
/// unit has `unit` texels: width 6 * unit, height 10 * unit. Strokes are one unit wide, with soft edges.
std::vector<uint8_t> fontTexels(uint32_t unit);

}  // namespace samples
