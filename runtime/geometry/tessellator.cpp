#include "runtime/geometry/tessellator.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vernier {
namespace {

using Domain = TessellationDomain;
using Order = TessellationOrder;
using Spacing = TessellationSpacing;

/// The length of an edge. All floats that are multiples of 1 / kOne in [0, 1] exist, and so do their distances to 1.
constexpr uint32_t kOne = 1u << 24;
constexpr float kUnit = 1.0f / kOne;

/// Rounding to an even or odd number leaves room below and above: an even one is at least 2, an odd one at most 63.
struct Range {
    float least, most;
};
constexpr Range rangeOf(Spacing spacing) {
    constexpr auto kMost = static_cast<float>(kMaxTessellationLevel);
    if (spacing == Spacing::fractionalEven) return {2, kMost};
    if (spacing == Spacing::fractionalOdd) return {1, kMost - 1};
    return {1, kMost};
}

/// A NaN becomes the least.
float clampedLevel(float level, Spacing spacing) {
    const Range range = rangeOf(spacing);
    return level > range.least ? std::min(level, range.most) : range.least;
}

/// A clamped level rounded up to what the spacing allows.
uint32_t segmentsOf(float clamped, Spacing spacing) {
    const auto up = static_cast<uint32_t>(std::ceil(clamped));
    if (spacing == Spacing::fractionalEven) return up + (up & 1);
    if (spacing == Spacing::fractionalOdd) return up | 1;
    return up;
}

/// Levels <= 0 and NaN.
bool culls(float outer) {
    return !(outer > 0);
}

}  // namespace

// Of n segments for a level f, n - 2 are 1 / f long, and the first and the last (1 - (n - f) / 2) / f: all the same
// where f is n, nothing is left of the two where f approaches n - 2, and that is all that the specification asks for.
// Each place is computed in double precision and rounded to a multiple of `multiple` / kOne; the second half of the
// edge mirrors the first.
Tessellator::Edge Tessellator::edgeOf(double level, uint32_t segments, uint32_t multiple) {
    Edge edge;
    edge.segments = segments;
    const double missing = (segments - level) / 2;
    for (uint32_t n = 1; 2 * n < segments; ++n) {
        const double steps = (n - missing) / level * kOne / multiple;
        edge.ends[n] = static_cast<uint32_t>(steps + 0.5) * multiple;
        edge.ends[segments - n] = kOne - edge.ends[n];
    }
    if (segments % 2 == 0) edge.ends[segments / 2] = kOne / 2;
    edge.ends[segments] = kOne;
    return edge;
}

Tessellator::Edge Tessellator::outerEdge(float level) const {
    const float clamped = clampedLevel(level, modes_.spacing);
    const uint32_t segments = segmentsOf(clamped, modes_.spacing);
    return edgeOf(modes_.spacing == Spacing::equal ? segments : clamped, segments, 1);
}

/// `split`: an edge of one segment counts as one of a level that is a little above 1, here by nothing.
Tessellator::Edge Tessellator::innerEdge(float level, bool split, uint32_t multiple) const {
    const float clamped = clampedLevel(level, modes_.spacing);
    uint32_t segments = segmentsOf(clamped, modes_.spacing);
    if (modes_.spacing == Spacing::equal) {
        if (split && segments == 1) segments = 2;
        return edgeOf(segments, segments, multiple);
    }
    if (split && segments == 1) segments = 3;
    return edgeOf(clamped, segments, multiple);
}

uint32_t Tessellator::addPoint(uint32_t u, uint32_t v, uint32_t w) {
    patch_.points.push_back(
        {static_cast<float>(u) * kUnit, static_cast<float>(v) * kUnit, static_cast<float>(w) * kUnit});
    return static_cast<uint32_t>(patch_.points.size() - 1);
}

/// Counter-clockwise.
void Tessellator::addTriangle(uint32_t a, uint32_t b, uint32_t c) {
    if (modes_.order == Order::clockwise) std::swap(b, c);
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
}

/// The next point is that of the edge whose next segment has its middle first; then the triangles overlap nowhere, as
/// both edges are parallel. The outer edge has the inner one on its left.
void Tessellator::fillBetween(const Side& outer, const Side& inner) {
    size_t o = 0, i = 0;
    const auto middle = [](const Side& side, size_t n) { return side.places[n] + side.places[n + 1]; };
    while (o + 1 < outer.points.size() || i + 1 < inner.points.size()) {
        const bool outerNext =
            i + 1 >= inner.points.size() || (o + 1 < outer.points.size() && middle(outer, o) <= middle(inner, i));
        if (outerNext) {
            addTriangle(outer.points[o], outer.points[o + 1], inner.points[i]);
            ++o;
        } else {
            addTriangle(outer.points[o], inner.points[i + 1], inner.points[i]);
            ++i;
        }
    }
}

// Corners, counter-clockwise: w = 1, u = 1, v = 1. Side s goes from corner s to the next; its outer level is that of
// the coordinate that is 0 on it: v, w and u. A place t along it and the height h above it are the coordinates 1 - t -
// h of the corner behind, t - h of the one ahead, and 2h of the third: lines perpendicular to the side keep t. Those
// through the ends of the first segments t of two sides that meet in a corner meet where 2h = t - h; so h is t / 3, and
// the ends of inner edges are multiples of 3.
void Tessellator::subdivideTriangle(const TessellationLevels& levels) {
    const std::array<Edge, 3> sides{outerEdge(levels.outer[1]), outerEdge(levels.outer[2]), outerEdge(levels.outer[0])};
    bool split = false;
    for (const Edge& side : sides) split |= side.segments > 1;
    const Edge inner = innerEdge(levels.inner[0], split, 3);

    const auto add = [this](uint32_t side, uint32_t t, uint32_t h) {
        const uint32_t behind = kOne - t - h, ahead = t - h, third = 2 * h;
        return side == 0   ? addPoint(ahead, third, behind)
               : side == 1 ? addPoint(behind, ahead, third)
                           : addPoint(third, behind, ahead);
    };
    // Three sides, which share their ends.
    const auto ring = [&add](const std::array<Edge, 3>& edges, uint32_t depth) {
        std::array<Side, 3> result;
        const uint32_t h = edges[0].ends[depth] / 3;
        for (uint32_t s = 0; s < 3; ++s) {
            const uint32_t last = edges[s].segments - depth;
            for (uint32_t n = depth; n < last; ++n) {
                result[s].points.push_back(add(s, edges[s].ends[n], h));
                result[s].places.push_back(edges[s].ends[n]);
            }
            result[s].places.push_back(edges[s].ends[last]);
        }
        for (uint32_t s = 0; s < 3; ++s) result[s].points.push_back(result[(s + 1) % 3].points[0]);
        return result;
    };

    std::array<Side, 3> around = ring(sides, 0);
    if (inner.segments == 1) return addTriangle(around[0].points[0], around[1].points[0], around[2].points[0]);
    for (uint32_t depth = 1; 2 * depth <= inner.segments; ++depth) {
        std::array<Side, 3> within;
        if (2 * depth == inner.segments) {
            const uint32_t third = kOne / 3;
            const uint32_t center = addPoint(third, third, kOne - 2 * third);
            for (Side& side : within) side = {{center}, {kOne / 2}};
        } else {
            within = ring({inner, inner, inner}, depth);
        }
        for (uint32_t s = 0; s < 3; ++s) fillBetween(around[s], within[s]);
        around = std::move(within);
    }
    if (inner.segments % 2 == 1) addTriangle(around[0].points[0], around[1].points[0], around[2].points[0]);
}

// Sides, counter-clockwise: v = 0, u = 1, v = 1, u = 0. The first inner level subdivides along u, the second along v.
void Tessellator::subdivideQuad(const TessellationLevels& levels) {
    const std::array<Edge, 4> sides{outerEdge(levels.outer[1]), outerEdge(levels.outer[2]), outerEdge(levels.outer[3]),
                                    outerEdge(levels.outer[0])};
    Edge alongU = innerEdge(levels.inner[0], false, 1), alongV = innerEdge(levels.inner[1], false, 1);
    bool split = alongU.segments > 1 || alongV.segments > 1;
    for (const Edge& side : sides) split |= side.segments > 1;

    std::array<Side, 4> outer;
    for (uint32_t s = 0; s < 4; ++s) {
        for (uint32_t n = 0; n < sides[s].segments; ++n) {
            const uint32_t t = sides[s].ends[n];
            outer[s].points.push_back(s == 0   ? addPoint(t, 0, 0)
                                      : s == 1 ? addPoint(kOne, t, 0)
                                      : s == 2 ? addPoint(kOne - t, kOne, 0)
                                               : addPoint(0, kOne - t, 0));
            outer[s].places.push_back(t);
        }
        outer[s].places.push_back(kOne);
    }
    for (uint32_t s = 0; s < 4; ++s) outer[s].points.push_back(outer[(s + 1) % 4].points[0]);
    if (!split) {
        addTriangle(outer[0].points[0], outer[1].points[0], outer[2].points[0]);
        addTriangle(outer[0].points[0], outer[2].points[0], outer[3].points[0]);
        return;
    }

    alongU = innerEdge(levels.inner[0], true, 1);
    alongV = innerEdge(levels.inner[1], true, 1);
    const uint32_t columns = alongU.segments - 1, rows = alongV.segments - 1;  // of points
    const auto first = static_cast<uint32_t>(patch_.points.size());
    for (uint32_t row = 1; row <= rows; ++row)
        for (uint32_t column = 1; column <= columns; ++column) addPoint(alongU.ends[column], alongV.ends[row], 0);
    const auto at = [&](uint32_t column, uint32_t row) { return first + row * columns + column; };
    for (uint32_t row = 0; row + 1 < rows; ++row) {
        for (uint32_t column = 0; column + 1 < columns; ++column) {
            addTriangle(at(column, row), at(column + 1, row), at(column + 1, row + 1));
            addTriangle(at(column, row), at(column + 1, row + 1), at(column, row + 1));
        }
    }
    for (uint32_t s = 0; s < 4; ++s) {
        const Edge& edge = s % 2 == 0 ? alongU : alongV;
        const uint32_t count = edge.segments - 1;
        Side inner;
        for (uint32_t n = 0; n < count; ++n) {
            const uint32_t back = count - 1 - n;
            inner.points.push_back(s == 0   ? at(n, 0)
                                   : s == 1 ? at(columns - 1, n)
                                   : s == 2 ? at(back, rows - 1)
                                            : at(0, back));
            inner.places.push_back(edge.ends[n + 1]);
        }
        fillBetween(outer[s], inner);
    }
}

// The first outer level is the number of lines, at equal distances whatever the spacing, the second that of their
// segments.
void Tessellator::subdivideIsolines(const TessellationLevels& levels) {
    const auto lines = segmentsOf(clampedLevel(levels.outer[0], Spacing::equal), Spacing::equal);
    const Edge down = edgeOf(lines, lines, 1), along = outerEdge(levels.outer[1]);
    for (uint32_t line = 0; line < lines; ++line) {
        for (uint32_t n = 0; n <= along.segments; ++n) {
            const uint32_t point = addPoint(along.ends[n], down.ends[line], 0);
            if (n != 0) patch_.indices.insert(patch_.indices.end(), {point - 1, point});
        }
    }
}

const SubdividedPatch& Tessellator::subdivide(const TessellationLevels& levels) {
    if (hasLast_ && std::memcmp(&last_, &levels, sizeof levels) == 0) return patch_;
    last_ = levels;
    hasLast_ = true;
    patch_.points.clear();
    patch_.indices.clear();
    patch_.verticesPerPrimitive = modes_.pointMode ? 1 : modes_.domain == Domain::isolines ? 2 : 3;
    const uint32_t outers = modes_.domain == Domain::triangles ? 3 : modes_.domain == Domain::quads ? 4 : 2;
    if (std::any_of(levels.outer.begin(), levels.outer.begin() + outers, culls)) return patch_;
    switch (modes_.domain) {
        case Domain::triangles:
            subdivideTriangle(levels);
            break;
        case Domain::quads:
            subdivideQuad(levels);
            break;
        default:
            subdivideIsolines(levels);
            break;
    }
    if (modes_.pointMode) {
        patch_.indices.resize(patch_.points.size());
        for (uint32_t n = 0; n < patch_.indices.size(); ++n) patch_.indices[n] = n;
    }
    return patch_;
}

}  // namespace vernier
