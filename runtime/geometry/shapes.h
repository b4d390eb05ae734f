// What points and lines cover, on the sub-pixel grid (specification, "Points" and "Line Segments").
#pragma once

#include <array>
#include <cstdint>

#include "runtime/geometry/chunk.h"

namespace vernier {

/// A square of `size` around a centre, in pixels; its sides lie on the sub-pixel grid, at the nearest place.
Shape squareShape(double x, double y, double size, uint32_t subPixelBits);

/// A segment between two points in sub-units, `width` pixels wide. Ends are half-open, as the sides of polygons are, so
/// that collinear segments which share an end cover nothing twice.
Shape rectangleShape(std::array<int32_t, 2> a, std::array<int32_t, 2> b, double width, uint32_t subPixelBits,
                     bool smooth);

/// The pixels whose diamonds the segment leaves; none: count is 0. `width` is rounded to whole pixels.
Shape bresenhamShape(std::array<int32_t, 2> a, std::array<int32_t, 2> b, double width, uint32_t subPixelBits);

/// The first of `width` pixels across, at pixel `major` along.
int32_t bresenhamMinor(const Shape& shape, int32_t major, uint32_t subPixelBits);

/// Pixels that the shape may cover, inclusive: x0, y0, x1, y1.
std::array<int32_t, 4> shapeBounds(const Shape& shape, uint32_t subPixelBits);

/// Length of a segment in pixels.
double segmentLength(const Shape& shape, uint32_t subPixelBits);

/// The part of pixel (x, y) that a rectangle or smooth line covers, 0 .. 1.
double coveredArea(const Shape& shape, int32_t x, int32_t y, uint32_t subPixelBits);

/// Half planes of a rectangle: a point (in sub-units) is inside when a * (x - x0) + b * (y - y0) + c >= 0 for all four.
/// Ties are decided as for polygons.
struct HalfPlane {
    int64_t a, b, x0, y0, c;
};
std::array<HalfPlane, 4> rectangleSides(const Shape& shape);

}  // namespace vernier
