#include "conformance/oracle/tessellator.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace vernier::conformance::exact {
namespace {

/// Numbers of points from one end of an edge to the other.
using Side = std::vector<uint32_t>;

/// The coordinates u and v alone: w follows from them.
struct Direction {
    Rational u, v;
};

Rational cross(const Direction& a, const Direction& b) {
    return a.u * b.v - a.v * b.u;
}

Direction between(const DomainPoint& from, const DomainPoint& to) {
    return {to[0] - from[0], to[1] - from[1]};
}

DomainPoint mixed(const DomainPoint& a, const DomainPoint& b, const Rational& share) {
    DomainPoint result;
    for (size_t c = 0; c < 3; ++c) result[c] = a[c] + share * (b[c] - a[c]);
    return result;
}

/// Where two lines meet that are not parallel.
DomainPoint meeting(const DomainPoint& p, const Direction& d, const DomainPoint& q, const Direction& e) {
    const Rational along = cross(between(p, q), e) / cross(d, e);
    const Rational u = p[0] + along * d.u, v = p[1] + along * d.v;
    return {u, v, Rational(1 - u - v)};
}

/// Twice the area of a triangle, with the sign of the specification's formula.
Rational area(const DomainPoint& a, const DomainPoint& b, const DomainPoint& c) {
    return a[0] * b[1] - b[0] * a[1] + b[0] * c[1] - c[0] * b[1] + c[0] * a[1] - a[0] * c[1];
}

class Subdivider {
  public:
    Subdivider(const PatchModes& modes, const PatchLevels& levels, const TessellationChoices& choices)
        : modes_(modes), levels_(levels), choices_(choices) {}

    Subdivision run() {
        const size_t relevant = modes_.domain == PatchDomain::triangles ? 3
                                : modes_.domain == PatchDomain::quads   ? 4
                                                                        : 2;
        const auto discards = [](double level) { return !(level > 0); };  // NaN, too
        if (std::any_of(levels_.outer.begin(), levels_.outer.begin() + relevant, discards)) return {};
        if (modes_.domain == PatchDomain::triangles) triangles();
        if (modes_.domain == PatchDomain::quads) quads();
        if (modes_.domain == PatchDomain::isolines) isolines();
        if (modes_.points) {
            result_.primitives.clear();
            for (uint32_t n = 0; n < result_.points.size(); ++n) result_.primitives.push_back({n});
        }
        if (choices_.turned) {
            std::ranges::reverse(result_.primitives);
            for (auto& primitive : result_.primitives) {
                std::rotate(primitive.begin(), primitive.end() - 1, primitive.end());
            }
        }
        return std::move(result_);
    }

  private:
    using Ring = std::array<Side, 3>;

    std::vector<Rational> ends(double level, bool split = false) const {
        return edgeEnds(level, modes_.spacing, split, choices_);
    }

    uint32_t add(const DomainPoint& point) {
        result_.points.push_back(point);
        return static_cast<uint32_t>(result_.points.size() - 1);
    }

    /// With an upper-left origin triangles whose area is negative are counter-clockwise, with a lower-left one those
    /// whose area is positive.
    void addTriangle(uint32_t a, uint32_t b, uint32_t c) {
        const auto& points = result_.points;
        const bool positive = area(points[a], points[b], points[c]) > 0;
        if (positive != (modes_.clockwise != modes_.lowerLeft)) std::swap(b, c);
        result_.primitives.push_back({a, b, c});
    }

    /// The area between two parallel edges that begin at the same end: each triangle has a segment of one edge and a
    /// point of the other. `place`: how far along a point is.
    void fill(const Side& outer, const Side& inner, const std::function<Rational(const DomainPoint&)>& place) {
        const auto middle = [&](const Side& side, size_t n) {
            return Rational(place(result_.points[side[n]]) + place(result_.points[side[n + 1]]));
        };
        size_t o = 0, i = 0;
        while (o + 1 < outer.size() || i + 1 < inner.size()) {
            const bool outerLeft = o + 1 < outer.size(), innerLeft = i + 1 < inner.size();
            const bool onOuter =
                outerLeft && (!innerLeft || choices_.outerFirst || middle(outer, o) <= middle(inner, i));
            if (onOuter) {
                addTriangle(outer[o], outer[o + 1], inner[i]);
                ++o;
            } else {
                addTriangle(outer[o], inner[i], inner[i + 1]);
                ++i;
            }
        }
    }

    /// A closed line through corners, each side divided at `ends`; sides share the corners. Nothing is added twice.
    template <size_t kSides>
    std::array<Side, kSides> outline(const std::array<DomainPoint, kSides>& corners,
                                     const std::array<std::vector<Rational>, kSides>& ends) {
        std::array<Side, kSides> sides;
        for (size_t s = 0; s < kSides; ++s) {
            for (size_t n = 0; n + 1 < ends[s].size(); ++n)
                sides[s].push_back(add(mixed(corners[s], corners[(s + 1) % kSides], ends[s][n])));
        }
        for (size_t s = 0; s < kSides; ++s) sides[s].push_back(sides[(s + 1) % kSides].front());
        return sides;
    }

    /// Triangle Tessellation.
    void triangles() {
        // Sides: w = 0, u = 0 and v = 0, which have the third, first and second outer level.
        const std::array<DomainPoint, 3> corners{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        const std::array<std::vector<Rational>, 3> outerEnds{ends(levels_.outer[2]), ends(levels_.outer[0]),
                                                             ends(levels_.outer[1])};
        const bool split = std::ranges::any_of(outerEnds, [](const auto& each) { return each.size() > 2; });
        const std::vector<Rational> innerEnds = ends(levels_.inner[0], split);
        Ring outer = outline<3>(corners, outerEnds);
        if (innerEnds.size() == 2) return addTriangle(outer[0][0], outer[1][0], outer[2][0]);
        // The outer edges as the inner level divides them, for a time.
        std::array<std::vector<DomainPoint>, 3> edges;
        for (size_t s = 0; s < 3; ++s) {
            for (const Rational& end : innerEnds) edges[s].push_back(mixed(corners[s], corners[(s + 1) % 3], end));
        }
        while (edges[0].size() > 2) {
            if (edges[0].size() == 3) {
                const Rational third = fraction(1, 3);
                const uint32_t center = add({third, third, third});
                for (size_t s = 0; s < 3; ++s) fillSide(s, outer[s], {center});
                return;
            }
            edges = innerEdges(edges);
            Ring inner;
            for (size_t s = 0; s < 3; ++s) {
                for (size_t n = 0; n + 1 < edges[s].size(); ++n) inner[s].push_back(add(edges[s][n]));
            }
            for (size_t s = 0; s < 3; ++s) inner[s].push_back(inner[(s + 1) % 3].front());
            for (size_t s = 0; s < 3; ++s) fillSide(s, outer[s], inner[s]);
            outer = std::move(inner);
        }
        addTriangle(outer[0][0], outer[1][0], outer[2][0]);
    }

    void fillSide(size_t side, const Side& outer, const Side& inner) {
        fill(outer, inner, [side](const DomainPoint& p) { return Rational(p[(side + 1) % 3] - p[side]); });
    }

    /// The inner triangle of one whose edges are divided: its corners are where the perpendiculars through the points
    /// next to a corner meet, and its edges are divided by those through the points between. In an equilateral triangle
    /// a perpendicular to an edge goes towards the third corner as it leaves both ends alike.
    static std::array<std::vector<DomainPoint>, 3> innerEdges(const std::array<std::vector<DomainPoint>, 3>& edges) {
        const auto perpendicular = [](size_t side) {
            DomainPoint direction{fraction(-1, 2), fraction(-1, 2), fraction(-1, 2)};
            direction[(side + 2) % 3] = 1;
            return Direction{direction[0], direction[1]};
        };
        std::array<DomainPoint, 3> corners;
        for (size_t s = 0; s < 3; ++s) {
            const size_t before = (s + 2) % 3;
            corners[s] =
                meeting(edges[s][1], perpendicular(s), edges[before][edges[before].size() - 2], perpendicular(before));
        }
        std::array<std::vector<DomainPoint>, 3> result;
        for (size_t s = 0; s < 3; ++s) {
            const Direction edge = between(corners[s], corners[(s + 1) % 3]);
            for (size_t n = 1; n + 1 < edges[s].size(); ++n)
                result[s].push_back(meeting(edges[s][n], perpendicular(s), corners[s], edge));
        }
        return result;
    }

    /// Quad Tessellation. The first inner level divides along u, as in the specification's figures.
    void quads() {
        // Sides: v = 0, u = 1, v = 1, u = 0.
        const std::array<DomainPoint, 4> corners{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
        const std::array<std::vector<Rational>, 4> outerEnds{ends(levels_.outer[1]), ends(levels_.outer[2]),
                                                             ends(levels_.outer[3]), ends(levels_.outer[0])};
        const std::array<Side, 4> outer = outline<4>(corners, outerEnds);
        const bool whole = ends(levels_.inner[0]).size() == 2 && ends(levels_.inner[1]).size() == 2 &&
                           std::ranges::all_of(outerEnds, [](const auto& each) { return each.size() == 2; });
        if (whole) return addRectangle(outer[0][0], outer[1][0], outer[2][0], outer[3][0]);
        const std::vector<Rational> alongU = ends(levels_.inner[0], true), alongV = ends(levels_.inner[1], true);
        std::vector<Side> rows;  // of the mesh's inner points
        for (size_t v = 1; v + 1 < alongV.size(); ++v) {
            Side& row = rows.emplace_back();
            for (size_t u = 1; u + 1 < alongU.size(); ++u) row.push_back(add({alongU[u], alongV[v], 0}));
        }
        for (size_t r = 0; r + 1 < rows.size(); ++r) {
            for (size_t n = 0; n + 1 < rows[r].size(); ++n)
                addRectangle(rows[r][n], rows[r][n + 1], rows[r + 1][n + 1], rows[r + 1][n]);
        }
        Side left, right, bottom = rows.front(), top = rows.back();
        for (const Side& row : rows) {
            left.push_back(row.front());
            right.push_back(row.back());
        }
        std::ranges::reverse(top);
        std::ranges::reverse(left);
        fill(outer[0], bottom, [](const DomainPoint& p) { return p[0]; });
        fill(outer[1], right, [](const DomainPoint& p) { return p[1]; });
        fill(outer[2], top, [](const DomainPoint& p) { return Rational(-p[0]); });
        fill(outer[3], left, [](const DomainPoint& p) { return Rational(-p[1]); });
    }

    /// Corners one after the other.
    void addRectangle(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        if (choices_.otherDiagonals) {
            addTriangle(a, b, d);
            addTriangle(b, c, d);
        } else {
            addTriangle(a, b, c);
            addTriangle(a, c, d);
        }
    }

    /// Isoline Tessellation: the first outer level counts lines, at equal distances from v = 0, the second one
    /// segments.
    void isolines() {
        const std::vector<Rational> down = edgeEnds(levels_.outer[0], PatchSpacing::equal),
                                    along = ends(levels_.outer[1]);
        for (size_t line = 0; line + 1 < down.size(); ++line) {
            for (size_t n = 0; n < along.size(); ++n) {
                const uint32_t point = add({along[n], down[line], 0});
                if (n != 0) result_.primitives.push_back({point - 1, point});
            }
        }
    }

    const PatchModes& modes_;
    const PatchLevels& levels_;
    const TessellationChoices& choices_;
    Subdivision result_;
};

}  // namespace

// Tessellator Spacing: the level is clamped and rounded up to a number of segments, all of one length but for the two
// of fractional spacings.
std::vector<Rational> edgeEnds(double level, PatchSpacing spacing, bool split, const TessellationChoices& choices) {
    const bool even = spacing == PatchSpacing::fractionalEven, odd = spacing == PatchSpacing::fractionalOdd;
    const double clamped =
        std::clamp<double>(level, even ? 2 : 1, odd ? kMaxTessellationLevel - 1 : kMaxTessellationLevel);
    auto segments = static_cast<int>(std::ceil(clamped));
    if ((even && segments % 2 == 1) || (odd && segments % 2 == 0)) ++segments;
    if (split && segments == 1) segments = odd ? 3 : 2;
    Rational shorter = 1;  // than the others, so many times
    if (spacing != PatchSpacing::equal) shorter = 1 - (segments - rational(clamped)) / 2;
    if (choices.shortInside) shorter *= shorter;
    const int first = choices.shortInside ? segments / 2 - 1 : 0;
    const Rational length = 1 / Rational(segments < 2 ? Rational(1) : Rational(segments - 2 + 2 * shorter));
    std::vector<Rational> ends{0};
    for (int n = 0; n < segments; ++n) {
        const bool additional = segments > 1 && (n == first || n == segments - 1 - first);
        ends.push_back(ends.back() + (additional ? Rational(length * shorter) : length));
    }
    return ends;
}

Subdivision subdivide(const PatchModes& modes, const PatchLevels& levels, const TessellationChoices& choices) {
    return Subdivider(modes, levels, choices).run();
}

}  // namespace vernier::conformance::exact
