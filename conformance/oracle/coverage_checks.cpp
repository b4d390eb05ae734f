#include "conformance/oracle/coverage_checks.h"

#include <algorithm>
#include <optional>

namespace vernier::conformance::exact {

namespace {

std::string text(const GridPoint& p) {
    return std::string("(").append(std::to_string(p.x)).append(", ").append(std::to_string(p.y)).append(")");
}

std::string wrongSample(uint32_t x, uint32_t y, uint32_t observed, const std::string& expected,
                        const std::string& cause) {
    return "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is covered " + std::to_string(observed) +
           " times, exactly " + expected + "; " + cause;
}

// The triangles that have anything to do with a sample, described.
std::string causes(std::span<const GridTriangle> triangles, const GridPoint& p) {
    std::string result;
    for (size_t i = 0; i < triangles.size(); ++i) {
        if (classify(triangles[i], p) == Coverage::mustNot) continue;
        result +=
            (result.empty() ? "" : "; ") + ("triangle " + std::to_string(i) + ": ") + describeSample(triangles[i], p);
    }
    return result.empty() ? "no triangle comes near" : result;
}

bool inside(const VkRect2D& scissor, uint32_t x, uint32_t y) {
    const int64_t dx = int64_t{x} - scissor.offset.x, dy = int64_t{y} - scissor.offset.y;
    return dx >= 0 && dy >= 0 && dx < scissor.extent.width && dy < scissor.extent.height;
}

template <class Check>
std::string forEachSample(const SampleGrid& grid, std::span<const uint32_t> observed, Check check) {
    for (uint32_t y = 0; y < grid.extent.height; ++y) {
        for (uint32_t x = 0; x < grid.extent.width; ++x) {
            const uint32_t count = observed[static_cast<size_t>(y) * grid.extent.width + x];
            if (std::string wrong = check(x, y, grid.sample(x, y), count); !wrong.empty()) return wrong;
        }
    }
    return {};
}

struct Edge {
    GridPoint a, b;
};

// Edges without a partner: the outline of the region that the triangles tile.
std::vector<Edge> outline(std::span<const GridTriangle> triangles, const std::vector<SharedEdge>& shared) {
    std::vector<Edge> result;
    for (size_t index = 0; index < triangles.size(); ++index) {
        const int side = orientation(triangles[index]);
        if (side == 0) continue;
        for (size_t i = 0; i < 3; ++i) {
            Edge edge{triangles[index][i], triangles[index][(i + 1) % 3]};
            if (side < 0) std::swap(edge.a, edge.b);
            const bool inner = std::ranges::any_of(shared, [&](const SharedEdge& s) {
                return (index == s.first && s.b == edge.a && s.a == edge.b) ||
                       (index == s.second && s.a == edge.a && s.b == edge.b);
            });
            if (!inner) result.push_back(edge);
        }
    }
    return result;
}

// Whether a sample is within `delta` of the segment itself (not only of its line).
bool nearSegment(const Edge& edge, const GridPoint& p, int64_t delta) {
    const auto [minX, maxX] = std::minmax(edge.a.x, edge.b.x);
    const auto [minY, maxY] = std::minmax(edge.a.y, edge.b.y);
    if (p.x < minX - delta || p.x > maxX + delta || p.y < minY - delta || p.y > maxY + delta) return false;
    return classifyEdge(edge.a, edge.b, p, delta) == Coverage::may;
}

}  // namespace

std::string describeSample(const GridTriangle& triangle, const GridPoint& sample) {
    const int side = orientation(triangle);
    if (side == 0) return "no area";
    bool inside = true;
    for (size_t i = 0; i < 3; ++i) {
        const GridPoint& a = triangle[side > 0 ? i : (3 - i) % 3];
        const GridPoint& b = triangle[side > 0 ? (i + 1) % 3 : (5 - i) % 3];
        const std::string edge = text(a) + "-" + text(b);
        const Wide e = edgeFunction(a, b, sample);
        if (e == 0) return "tie: on edge " + edge + (isTopLeft(a, b) ? " (top-left)" : " (not top-left)");
        if (classifyEdge(a, b, sample, 1) == Coverage::may) return "within one sub-unit of edge " + edge;
        inside = inside && e > 0;
    }
    return inside ? "strictly inside" : "strictly outside";
}

std::string checkDeclaredCoverage(std::span<const GridTriangle> triangles, const SampleGrid& grid,
                                  const VkRect2D& scissor, std::span<const uint32_t> observed) {
    return forEachSample(
        grid, observed, [&](uint32_t x, uint32_t y, const GridPoint& p, uint32_t count) -> std::string {
            const bool inScissor = inside(scissor, x, y);
            const auto covering = [&p](const GridTriangle& t) { return covers(t, p); };
            const auto expected = inScissor ? static_cast<uint32_t>(std::ranges::count_if(triangles, covering)) : 0u;
            if (count == expected) return {};
            return wrongSample(x, y, count, std::to_string(expected),
                               inScissor ? causes(triangles, p) : "outside the scissor");
        });
}

std::string checkScissor(const SampleGrid& grid, const VkRect2D& scissor, std::span<const uint32_t> observed) {
    return forEachSample(grid, observed, [&](uint32_t x, uint32_t y, const GridPoint&, uint32_t count) -> std::string {
        if (count == 0 || inside(scissor, x, y)) return {};
        return wrongSample(x, y, count, "0", "outside the scissor");
    });
}

std::string checkLegalCoverage(std::span<const GridTriangle> triangles, const SampleGrid& grid, const VkRect2D& scissor,
                               std::span<const uint32_t> observed) {
    const std::vector<SharedEdge> shared = findSharedEdges(triangles);
    return forEachSample(grid, observed,
                         [&](uint32_t x, uint32_t y, const GridPoint& p, uint32_t count) -> std::string {
                             if (!inside(scissor, x, y)) return {};
                             uint32_t low = 0, high = 0;
                             for (const GridTriangle& t : triangles) {
                                 const Coverage coverage = classify(t, p);
                                 low += coverage == Coverage::must;
                                 high += coverage != Coverage::mustNot;
                             }
                             for (const SharedEdge& edge : shared) {
                                 if (!isExclusive(triangles, edge, p)) continue;
                                 ++low;
                                 --high;
                             }
                             if (count >= low && count <= high) return {};
                             const std::string expected =
                                 low == high ? std::to_string(low) : std::to_string(low) + ".." + std::to_string(high);
                             return wrongSample(x, y, count, expected, causes(triangles, p));
                         });
}

std::string checkPartition(std::span<const GridTriangle> triangles, const SampleGrid& grid, const VkRect2D& scissor,
                           std::span<const uint32_t> observed) {
    const std::vector<Edge> boundary = outline(triangles, findSharedEdges(triangles));
    return forEachSample(
        grid, observed, [&](uint32_t x, uint32_t y, const GridPoint& p, uint32_t count) -> std::string {
            if (!inside(scissor, x, y)) return {};
            const auto open = [&p](const Edge& edge) { return nearSegment(edge, p, 1); };
            if (std::ranges::any_of(boundary, open)) return {};
            const bool isInner = std::ranges::any_of(triangles, [&p](const GridTriangle& t) { return covers(t, p); });
            if (count == (isInner ? 1u : 0u)) return {};
            return wrongSample(x, y, count, isInner ? "1 (interior of the tiling)" : "0 (outside the tiling)",
                               causes(triangles, p));
        });
}

}  // namespace vernier::conformance::exact
