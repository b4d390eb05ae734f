// Exact coverage of sample points by lines and points on the sub-pixel grid.
//
// Rectangular lines (Vulkan, Basic Line Segment Rasterization, strict lines): the samples within half a width of the
// segment, between its ends. The corners are irrational; questions about them are decided by comparing squares.
// Bresenham lines (Vulkan, Bresenham Line Segment Rasterization): the pixels whose diamond the segment leaves, with
// ends moved by (-e, -e^2) so that nothing is ever exactly on a corner. Points (Vulkan, Basic Point Rasterization):
// squares.
#pragma once

#include "conformance/oracle/coverage.h"

#include <vector>

namespace vernier::conformance::exact {

/// A segment on the grid, and its width in sub-units.
struct GridLine {
    GridPoint a, b;
    Rational width;
};

/// What a strict line allows at a sample when its outline may move by `slack` sub-units: snapping moves the ends, and
/// an implementation that draws two triangles snaps their corners too.
Coverage classifyLine(const GridLine& line, const GridPoint& sample, int64_t slack);

/// The declared rule: the rectangle itself, of its borders the left ones and the top one, as of triangles; nothing for
/// a segment without length.
bool lineCovers(const GridLine& line, const GridPoint& sample);

/// Pixels of a Bresenham line of width 1 between points in pixels, in the order of the major axis (x for a slope of
/// exactly 1). The first pixel is drawn, the last only if the segment leaves its diamond.
struct PixelIndex {
    int64_t x = 0, y = 0;
    friend bool operator==(const PixelIndex&, const PixelIndex&) = default;
};
std::vector<PixelIndex> bresenhamPixels(const std::array<Rational, 2>& a, const std::array<Rational, 2>& b);

/// A square around a centre, in sub-units.
struct GridSquare {
    Rational x, y, size;
};

/// What a point allows at a sample when its borders may move by `slack` sub-units.
Coverage classifySquare(const GridSquare& square, const GridPoint& sample, int64_t slack);

/// The declared rule: corners snapped to nearest even, left and top borders in, right and bottom ones out.
bool squareCovers(const GridSquare& square, const GridPoint& sample);

}  // namespace vernier::conformance::exact
