#include "conformance/oracle/coverage.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vernier::conformance::exact {

namespace {

Wide magnitude(Wide value) {
    return value < 0 ? -value : value;
}

int64_t distance(const GridPoint& a, const GridPoint& b) {
    return (a.x < b.x ? b.x - a.x : a.x - b.x) + (a.y < b.y ? b.y - a.y : a.y - b.y);
}

// How far an edge function can move when both ends move by delta per coordinate: E is bilinear in the two
// ends.
Wide support(const GridPoint& a, const GridPoint& b, const GridPoint& p, int64_t delta) {
    return static_cast<Wide>(delta) * (distance(a, p) + distance(b, p)) + static_cast<Wide>(2) * delta * delta;
}

GridTriangle clockwise(const GridTriangle& triangle) {
    if (orientation(triangle) >= 0) return triangle;
    return {triangle[0], triangle[2], triangle[1]};
}

// Outside the bounding box of all snap boxes no snapping can cover the sample.
bool outOfReach(const GridTriangle& triangle, const GridPoint& p, int64_t delta) {
    const auto [minX, maxX] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    const auto [minY, maxY] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    return p.x < minX - delta || p.x > maxX + delta || p.y < minY - delta || p.y > maxY + delta;
}

// The area is an edge function of the third vertex, which moves too.
bool orientationIsOpen(const GridTriangle& triangle, int64_t delta) {
    const Wide area = magnitude(edgeFunction(triangle[0], triangle[1], triangle[2]));
    const Wide moved =
        static_cast<Wide>(delta) * (distance(triangle[0], triangle[2]) + distance(triangle[1], triangle[2]) +
                                    distance(triangle[0], triangle[1])) +
        static_cast<Wide>(6) * delta * delta;
    return area <= moved;
}

}  // namespace

Integer snapNearestEven(const Rational& pixels, int bits) {
    return roundHalfEven(pixels * powerOfTwo(bits));
}

SnapBox legalSnapBox(const Rational& pixels, int bits) {
    const Rational units = pixels * powerOfTwo(bits);
    return {ceilOf(units - 1), floorOf(units + 1)};
}

int orientation(const GridTriangle& triangle) {
    const Wide area = edgeFunction(triangle[0], triangle[1], triangle[2]);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

bool covers(const GridTriangle& triangle, const GridPoint& sample) {
    if (orientation(triangle) == 0) return false;
    const GridTriangle t = clockwise(triangle);
    for (size_t i = 0; i < 3; ++i) {
        const GridPoint& a = t[i];
        const GridPoint& b = t[(i + 1) % 3];
        const Wide e = edgeFunction(a, b, sample);
        if (e < 0 || (e == 0 && !isTopLeft(a, b))) return false;
    }
    return true;
}

Coverage classifyEdge(const GridPoint& a, const GridPoint& b, const GridPoint& sample, int64_t delta) {
    const Wide e = edgeFunction(a, b, sample);
    if (magnitude(e) <= support(a, b, sample, delta)) return Coverage::may;
    return e > 0 ? Coverage::must : Coverage::mustNot;
}

Coverage classify(const GridTriangle& triangle, const GridPoint& sample, int64_t delta) {
    if (outOfReach(triangle, sample, delta)) return Coverage::mustNot;
    const bool open = orientationIsOpen(triangle, delta);
    const GridTriangle t = clockwise(triangle);
    Coverage result = Coverage::must;
    int outsideEdges = 0, insideEdges = 0;
    for (size_t i = 0; i < 3; ++i) {
        const Coverage edge = classifyEdge(t[i], t[(i + 1) % 3], sample, delta);
        outsideEdges += edge == Coverage::mustNot;
        insideEdges += edge == Coverage::must;
        if (edge != Coverage::must) result = Coverage::may;
    }
    // With either orientation possible, only a sample strictly on both sides of some edges is out for
    // certain.
    if (open) return outsideEdges != 0 && insideEdges != 0 ? Coverage::mustNot : Coverage::may;
    return outsideEdges != 0 ? Coverage::mustNot : result;
}

std::vector<SharedEdge> findSharedEdges(std::span<const GridTriangle> triangles) {
    std::multimap<std::pair<GridPoint, GridPoint>, size_t> open;  // directed edge -> triangle
    std::vector<SharedEdge> result;
    for (size_t index = 0; index < triangles.size(); ++index) {
        if (orientation(triangles[index]) == 0) continue;
        const GridTriangle t = clockwise(triangles[index]);
        for (size_t i = 0; i < 3; ++i) {
            const GridPoint& a = t[i];
            const GridPoint& b = t[(i + 1) % 3];
            if (const auto partner = open.find({b, a}); partner != open.end()) {
                result.push_back({partner->second, index, a, b});
                open.erase(partner);
            } else {
                open.insert({{a, b}, index});
            }
        }
    }
    return result;
}

bool isExclusive(std::span<const GridTriangle> triangles, const SharedEdge& edge, const GridPoint& sample,
                 int64_t delta) {
    if (classifyEdge(edge.a, edge.b, sample, delta) != Coverage::may) return false;
    for (const size_t index : {edge.first, edge.second}) {
        const GridTriangle t = clockwise(triangles[index]);
        for (size_t i = 0; i < 3; ++i) {
            const GridPoint& a = t[i];
            const GridPoint& b = t[(i + 1) % 3];
            const bool shared = (a == edge.a && b == edge.b) || (a == edge.b && b == edge.a);
            if (!shared && classifyEdge(a, b, sample, delta) != Coverage::must) return false;
        }
    }
    return true;
}

}  // namespace vernier::conformance::exact
