// Exact coverage of sample points by triangles on the sub-pixel grid.
//
// Framebuffer orientation: x to the right, y down, in sub-units of 2^-b pixel. Two questions are answered
// apart:
//   covers()    what the declared rule says: vertices snapped to nearest even, ties given to top and left
//   edges; classify()  what any legal snapping allows: every vertex coordinate may move by up to `delta`
//   sub-units
//               (Vulkan fixes the number of sub-pixel bits, not the rounding to them).
#pragma once

#include "conformance/oracle/exact.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vernier::conformance::exact {

struct GridPoint {
    int64_t x = 0, y = 0;
    friend bool operator==(const GridPoint&, const GridPoint&) = default;
    friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

using GridTriangle = std::array<GridPoint, 3>;

// |coordinates| up to 2^40 sub-units leave a product of differences below 2^83: far inside 127 bits.
__extension__ using Wide = __int128;

/// The nearest multiple of 2^-bits, ties to even, as a number of sub-units.
Integer snapNearestEven(const Rational& pixels, int bits);

/// The sub-unit codes a legal snapping may choose for a coordinate: those within one sub-unit of the exact
/// value.
struct SnapBox {
    Integer low, high;
};
SnapBox legalSnapBox(const Rational& pixels, int bits);

/// Twice the signed area of a, b, p: positive when p is to the right of a -> b as seen on the screen (y
/// down).
constexpr Wide edgeFunction(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
    return static_cast<Wide>(b.x - a.x) * (p.y - a.y) - static_cast<Wide>(b.y - a.y) * (p.x - a.x);
}

/// Sign of the triangle's area: +1 clockwise on the screen, -1 counter-clockwise, 0 empty.
int orientation(const GridTriangle& triangle);

/// Whether points exactly on a -> b belong to a clockwise triangle with that edge: top edges (horizontal,
/// interior below) and left edges (interior to the right).
constexpr bool isTopLeft(const GridPoint& a, const GridPoint& b) {
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

/// The declared rule: exact on the grid, top-left ties, nothing for a triangle without area.
bool covers(const GridTriangle& triangle, const GridPoint& sample);

enum class Coverage : uint8_t { mustNot, may, must };

/// What one edge of a clockwise triangle allows at a sample.
///
/// Moving a and b by at most `delta` per coordinate changes the edge function by at most
///   delta * (|b-p| + |a-p|)_1 + 2 delta^2,
/// which is delta * (|dx| + |dy|), the support of the snap box in the edge's normal, for samples beside the
/// edge.
Coverage classifyEdge(const GridPoint& a, const GridPoint& b, const GridPoint& sample, int64_t delta);

/// What the triangle allows at a sample when every vertex may move by `delta` sub-units. A triangle whose
/// orientation itself is open under such moves has `may` wherever its outline can reach.
Coverage classify(const GridTriangle& triangle, const GridPoint& sample, int64_t delta = 1);

/// An edge that two triangles run along in opposite directions (after orienting both clockwise).
struct SharedEdge {
    size_t first = 0, second = 0;  // triangle indices
    GridPoint a, b;
};
std::vector<SharedEdge> findSharedEdges(std::span<const GridTriangle> triangles);

/// A shared edge with its two triangles at one sample: when nothing but this edge is open there, exactly one
/// of the two covers the sample, whatever the snapping ("identical endpoints": Vulkan, Basic Polygon
/// Rasterization).
bool isExclusive(std::span<const GridTriangle> triangles, const SharedEdge& edge, const GridPoint& sample,
                 int64_t delta = 1);

}  // namespace vernier::conformance::exact
