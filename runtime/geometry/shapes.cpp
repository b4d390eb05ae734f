#include "runtime/geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vernier {
namespace {

__extension__ using Wide = unsigned __int128;

/// The greatest integer whose square is not above `value`, which is below 2^108; `exact` when it is the root.
int64_t integerRoot(Wide value, bool& exact) {
    auto root = static_cast<uint64_t>(std::sqrt(static_cast<double>(value)));
    while (Wide{root} * root > value) --root;
    while (Wide{root + 1} * (root + 1) <= value) ++root;
    exact = Wide{root} * root == value;
    return static_cast<int64_t>(root);
}

/// The pixel to which a coordinate belongs after it was moved to the left by next to nothing.
int32_t pixelBefore(int32_t coordinate, uint32_t bits) {
    return (coordinate - 1) >> bits;
}

/// Whether a segment's end lies in the diamond of its pixel once it is moved by (-e, -e^2) ("Bresenham Line Segment
/// Rasterization"): of the boundary only the sides on the right belong to it.
bool insideDiamond(int32_t x, int32_t y, uint32_t bits) {
    const int32_t half = 1 << (bits - 1);
    const int32_t dx = x - ((pixelBefore(x, bits) << bits) + half), dy = y - ((pixelBefore(y, bits) << bits) + half);
    const int32_t distance = std::abs(dx) + std::abs(dy);
    return distance < half || (distance == half && dx > 0);
}

/// Inside or on a side that belongs to the shape: as for triangles, the left ones and the top one.
int64_t tie(int64_t a, int64_t b) {
    return a > 0 || (a == 0 && b > 0) ? 0 : -1;
}

struct Point {
    double x, y;
};

constexpr int kMaxCorners = 16;

/// Cuts a convex polygon to nx * x + ny * y + d >= 0. (Rounding could make it cross a line more than twice: what
/// exceeds the bound would be a sliver of rounding errors.)
int cut(const Point* from, int count, double nx, double ny, double d, Point* to) {
    int result = 0;
    for (int n = 0; n < count && result + 2 <= kMaxCorners; ++n) {
        const Point &p = from[n], &q = from[n + 1 == count ? 0 : n + 1];
        const double ep = nx * p.x + ny * p.y + d, eq = nx * q.x + ny * q.y + d;
        if (ep >= 0) to[result++] = p;
        if ((ep >= 0) != (eq >= 0)) {
            const double t = ep / (ep - eq);
            to[result++] = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
        }
    }
    return result;
}

}  // namespace

Shape squareShape(double x, double y, double size, uint32_t subPixelBits) {
    // A double of this magnitude has its last bit worth 1: adding it rounds to the nearest, ties to even. A side is a
    // pixel below 2^16 with at most 16 bits behind the point.
    constexpr double kMagic = 0x1.8p52;
    const auto units = static_cast<double>(1u << subPixelBits);
    const auto snap = [units](double side) { return static_cast<int64_t>(side * units + kMagic - kMagic); };
    Shape shape;
    shape.sides = {snap(x - 0.5 * size), snap(y - 0.5 * size), snap(x + 0.5 * size), snap(y + 0.5 * size)};
    return shape;
}

Shape rectangleShape(std::array<int32_t, 2> a, std::array<int32_t, 2> b, double width, uint32_t subPixelBits,
                     bool smooth) {
    Shape shape;
    shape.kind = smooth ? Shape::Kind::smooth : Shape::Kind::rectangle;
    shape.ax = a[0];
    shape.ay = a[1];
    shape.bx = b[0];
    shape.by = b[1];
    const int64_t dx = int64_t{b[0]} - a[0], dy = int64_t{b[1]} - a[1];
    // The width on the sub-pixel grid, too, so that everything is an integer.
    const auto units = static_cast<uint64_t>(std::nearbyint(width * static_cast<double>(1u << subPixelBits)));
    const Wide square = static_cast<Wide>(dx * dx) + static_cast<Wide>(dy * dy);
    shape.reach = integerRoot(square * units * units, shape.sharp);
    return shape;
}

Shape bresenhamShape(std::array<int32_t, 2> a, std::array<int32_t, 2> b, double width, uint32_t subPixelBits) {
    const uint32_t bits = subPixelBits;
    Shape shape;
    shape.kind = Shape::Kind::bresenham;
    shape.width = std::max(1, static_cast<int32_t>(std::nearbyint(width)));
    const int64_t dx = int64_t{b[0]} - a[0], dy = int64_t{b[1]} - a[1];
    shape.yMajor = std::abs(dy) > std::abs(dx);
    // "offsetting them in the minor direction": the first pixel across comes from the line moved by (w - 1) / 2.
    const int32_t offset = (shape.width - 1) * (1 << (bits - 1));
    const int minor = shape.yMajor ? 0 : 1;
    a[static_cast<size_t>(minor)] -= offset;
    b[static_cast<size_t>(minor)] -= offset;
    shape.ax = a[0];
    shape.ay = a[1];
    shape.bx = b[0];
    shape.by = b[1];
    if (dx == 0 && dy == 0) return shape;
    const int32_t from = shape.yMajor ? a[1] : a[0], to = shape.yMajor ? b[1] : b[0];
    const int32_t half = 1 << (bits - 1);
    const int32_t start = pixelBefore(from, bits), end = pixelBefore(to, bits);
    // Moved by next to nothing, an end on the centre line lies before it.
    const bool startBefore = from <= (start << bits) + half, endBefore = to <= (end << bits) + half;
    const bool startInside = insideDiamond(a[0], a[1], bits), endInside = insideDiamond(b[0], b[1], bits);
    shape.step = to > from ? 1 : -1;
    // A pixel is left behind if its centre line is crossed and the segment does not end in its diamond, or if the
    // segment starts in its diamond beyond the centre line. (Going on, the distance |x - xf| + |y - yf| never falls.)
    const bool crossesFirst = shape.step > 0 ? startBefore : !startBefore;
    const bool crossesLast = shape.step > 0 ? !endBefore : endBefore;
    shape.first = crossesFirst || startInside ? start : start + shape.step;
    const int32_t last = crossesLast && !endInside ? end : end - shape.step;
    shape.count = std::max(0, (last - shape.first) * shape.step + 1);
    return shape;
}

int32_t bresenhamMinor(const Shape& shape, int32_t major, uint32_t bits) {
    const int64_t dx = int64_t{shape.bx} - shape.ax, dy = int64_t{shape.by} - shape.ay;
    const int64_t along = shape.yMajor ? dy : dx, across = shape.yMajor ? dx : dy;
    const int64_t startAlong = shape.yMajor ? shape.ay : shape.ax, startAcross = shape.yMajor ? shape.ax : shape.ay;
    const int64_t centre = (int64_t{major} << bits) + (int64_t{1} << (bits - 1));
    int64_t numerator = (centre - startAlong) * across, denominator = along;
    if (denominator < 0) {
        numerator = -numerator;
        denominator = -denominator;
    }
    int64_t quotient = numerator / denominator;
    int64_t remainder = numerator % denominator;
    if (remainder < 0) {
        --quotient;
        remainder += denominator;
    }
    const int64_t place = startAcross + quotient;
    auto pixel = static_cast<int32_t>(place >> bits);
    // Between two pixels, the perturbed line decides: moved by (-e, -e^2), it lies higher where y grows with x.
    const bool between = remainder == 0 && (place & ((int64_t{1} << bits) - 1)) == 0;
    const bool rising = !shape.yMajor && ((across > 0) == (along > 0)) && across != 0;
    return between && !rising ? pixel - 1 : pixel;
}

std::array<int32_t, 4> shapeBounds(const Shape& shape, uint32_t bits) {
    if (shape.kind == Shape::Kind::square) {
        const auto pixelOf = [bits](int64_t side) {
            return static_cast<int32_t>(std::clamp<int64_t>(side >> bits, kGuardBandMin, kGuardBandMax));
        };
        return {pixelOf(shape.sides[0]), pixelOf(shape.sides[1]), pixelOf(shape.sides[2]), pixelOf(shape.sides[3])};
    }
    if (shape.kind == Shape::Kind::bresenham) {
        const int32_t last = shape.first + (shape.count - 1) * shape.step;
        const int32_t from = bresenhamMinor(shape, shape.first, bits), to = bresenhamMinor(shape, last, bits);
        std::array<int32_t, 4> bounds{std::min(shape.first, last), std::min(from, to), std::max(shape.first, last),
                                      std::max(from, to) + shape.width - 1};
        if (shape.yMajor) {
            std::swap(bounds[0], bounds[1]);
            std::swap(bounds[2], bounds[3]);
        }
        return bounds;
    }
    // Half the width to each side, and one unit for its rounding.
    const double length = segmentLength(shape, bits) * static_cast<double>(1u << bits);
    const auto half = length == 0 ? 0 : static_cast<int32_t>(static_cast<double>(shape.reach) / length * 0.5) + 1;
    return {(std::min(shape.ax, shape.bx) - half) >> bits, (std::min(shape.ay, shape.by) - half) >> bits,
            (std::max(shape.ax, shape.bx) + half) >> bits, (std::max(shape.ay, shape.by) + half) >> bits};
}

double segmentLength(const Shape& shape, uint32_t subPixelBits) {
    const double dx = double(shape.bx) - shape.ax, dy = double(shape.by) - shape.ay;
    return std::sqrt(dx * dx + dy * dy) / static_cast<double>(1u << subPixelBits);
}

std::array<HalfPlane, 4> rectangleSides(const Shape& shape) {
    const int64_t dx = int64_t{shape.bx} - shape.ax, dy = int64_t{shape.by} - shape.ay;
    std::array<HalfPlane, 4> sides{{{dx, dy, shape.ax, shape.ay, 0},
                                    {-dx, -dy, shape.bx, shape.by, 0},
                                    {2 * dy, -2 * dx, shape.ax, shape.ay, shape.reach},
                                    {-2 * dy, 2 * dx, shape.ax, shape.ay, shape.reach}}};
    // Where the long sides are not on the grid of the cross product, nothing can lie on them.
    for (size_t n = 0; n < 4; ++n)
        if (n < 2 || shape.sharp) sides[n].c += tie(sides[n].a, sides[n].b);
    return sides;
}

double coveredArea(const Shape& shape, int32_t x, int32_t y, uint32_t bits) {
    const double unit = 1 / static_cast<double>(1u << bits);
    const double ax = shape.ax * unit - x, ay = shape.ay * unit - y;
    const double length = segmentLength(shape, bits);
    const double ux = (double(shape.bx) - shape.ax) * unit / length, uy = (double(shape.by) - shape.ay) * unit / length;
    const double half = 0.5 * static_cast<double>(shape.reach) * unit * unit / length;
    const double along = ux * ax + uy * ay, across = uy * ax - ux * ay;
    const double planes[4][3] = {
        {ux, uy, -along}, {-ux, -uy, along + length}, {uy, -ux, half - across}, {-uy, ux, half + across}};
    Point polygon[kMaxCorners] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, next[kMaxCorners];
    int count = 4;
    for (const auto& plane : planes) {
        count = cut(polygon, count, plane[0], plane[1], plane[2], next);
        std::copy_n(next, count, polygon);
        if (count < 3) return 0;
    }
    double doubled = 0;
    for (int n = 0; n < count; ++n) {
        const Point &p = polygon[n], &q = polygon[n + 1 == count ? 0 : n + 1];
        doubled += p.x * q.y - q.x * p.y;
    }
    return std::clamp(0.5 * doubled, 0.0, 1.0);
}

}  // namespace vernier
