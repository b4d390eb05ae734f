// Coverage: E01, E02, E06, E07, E10, E11.
#include "conformance/oracle/case_list.h"
#include "conformance/oracle/case_support.h"
#include "conformance/oracle/coverage_checks.h"
#include "conformance/oracle/exact.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vernier::conformance::cases {

namespace {

using exact::SampleGrid;

constexpr VkExtent2D kSmall{16, 16};
constexpr VkExtent2D kMedium{64, 64};

SampleGrid gridOf(VkExtent2D extent, int64_t offsetX = 0, int64_t offsetY = 0) {
    return {extent, 8, {128 + offsetX, 128 + offsetY}};
}

GridPoint pixels(double x, double y) {
    return {static_cast<int64_t>(std::nearbyint(x * 256)), static_cast<int64_t>(std::nearbyint(y * 256))};
}

// Legal coverage, a partition, and in declared mode the exact answer.
Status checkCounts(std::string_view name, const RenderedImage& image, std::span<const GridTriangle> triangles,
                   const SampleGrid& grid, Strictness strictness, bool tiling) {
    const auto counts = coverageCounts(image, grid.extent);
    if (!counts) return verdict(name, counts.error().message);
    std::string wrong = exact::checkLegalCoverage(triangles, grid, *counts);
    if (wrong.empty() && tiling) wrong = exact::checkPartition(triangles, grid, *counts);
    if (wrong.empty() && strictness == Strictness::declared) {
        wrong = exact::checkDeclaredCoverage(triangles, grid, {{0, 0}, grid.extent}, *counts);
    }
    return verdict(name, wrong);
}

Result<std::vector<Scene>> collect(std::vector<Result<Scene>> scenes) {
    std::vector<Scene> result;
    for (auto& scene : scenes) {
        if (!scene) return scene.error();
        result.push_back(std::move(*scene));
    }
    return result;
}

// Squares whose diagonal runs through centres, with borders between centres and on them, and a skewed one.
std::vector<std::vector<GridTriangle>> diagonalQuads() {
    const auto quad = [](GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
        return std::vector<GridTriangle>{{a, b, c}, {d, c, b}};
    };
    return {quad(pixels(1, 1), pixels(1, 7), pixels(7, 1), pixels(7, 7)),
            quad(pixels(0.5, 0.5), pixels(0.5, 6.5), pixels(6.5, 0.5), pixels(6.5, 6.5)),
            quad(pixels(0, 0), pixels(0, 16), pixels(16, 0), pixels(16, 16)),
            quad(pixels(2.5, 1), pixels(1.5, 9), pixels(14.5, 2), pixels(13.5, 10))};
}

std::vector<GridTriangle> gridTriangles(const Tiling& tiling) {
    std::vector<GridTriangle> result;
    for (const auto& t : tiling.triangles) {
        GridTriangle triangle;
        for (size_t i = 0; i < 3; ++i) triangle[i] = pixels(tiling.points[t[i]][0], tiling.points[t[i]][1]);
        result.push_back(triangle);
    }
    return result;
}

}  // namespace

Result<std::vector<Scene>> buildE01() {
    std::vector<Result<Scene>> scenes;
    for (const auto& quad : diagonalQuads()) scenes.push_back(coverageScene("E01", quad, kSmall));
    return collect(std::move(scenes));
}

Status checkE01(const CaseImages& images, Strictness strictness) {
    const auto quads = diagonalQuads();
    if (Status s = checkShape(images, quads.size(), 1, kSmall); !s) return s;
    for (size_t i = 0; i < quads.size(); ++i) {
        if (Status s = checkCounts("E01", images[i][0], quads[i], gridOf(kSmall), strictness, true); !s) return s;
    }
    return {};
}

namespace {

// All orders of the three vertices: three rotations in both windings, of each triangle on its own.
std::vector<std::vector<GridTriangle>> vertexOrders() {
    const std::vector<GridTriangle> quad = diagonalQuads()[0];
    std::vector<std::vector<GridTriangle>> result;
    for (size_t first = 0; first < 6; ++first) {
        for (size_t second = 0; second < 6; ++second) {
            const auto ordered = [](const GridTriangle& t, size_t order) {
                const size_t r = order % 3;
                GridTriangle turned{t[r], t[(r + 1) % 3], t[(r + 2) % 3]};
                if (order >= 3) std::swap(turned[1], turned[2]);
                return turned;
            };
            result.push_back({ordered(quad[0], first), ordered(quad[1], second)});
        }
    }
    return result;
}

}  // namespace

Result<std::vector<Scene>> buildE02() {
    std::vector<Result<Scene>> scenes;
    for (const auto& quad : vertexOrders()) scenes.push_back(coverageScene("E02", quad, kSmall));
    return collect(std::move(scenes));
}

Status checkE02(const CaseImages& images, Strictness strictness) {
    const auto orders = vertexOrders();
    if (Status s = checkShape(images, orders.size(), 1, kSmall); !s) return s;
    for (size_t i = 0; i < orders.size(); ++i) {
        if (Status s = checkCounts("E02", images[i][0], orders[i], gridOf(kSmall), strictness, true); !s) return s;
        if (images[i][0].texels != images[0][0].texels) {
            return verdict("E02", "vertex order " + std::to_string(i) + " gives another coverage than order 0");
        }
    }
    return {};
}

namespace {

const Tiling& onGrid() {
    static const Tiling tiling = jitteredTiling(9, 6.5, 1.9, 256, 6);
    return tiling;
}

// Dense enough that hundreds of centres lie within a sub-unit of an edge.
const Tiling& offGrid() {
    static const Tiling tiling = jitteredTiling(28, 2.21875, 0.6, 0x1p16, 7);
    return tiling;
}

std::vector<ClipPosition> clipPositions(const Tiling& tiling, const VkViewport& viewport) {
    std::vector<ClipPosition> result;
    for (const auto& t : tiling.triangles) {
        for (const size_t i : t) {
            result.push_back({static_cast<float>(tiling.points[i][0] * 2 / viewport.width - 1),
                              static_cast<float>(tiling.points[i][1] * 2 / viewport.height - 1), 0.5f, 1.0f});
        }
    }
    return result;
}

constexpr VkViewport kMediumViewport{0, 0, 64, 64, 0, 1};

}  // namespace

Result<std::vector<Scene>> buildE06() {
    std::vector<GridTriangle> triangles = gridTriangles(onGrid());
    std::vector<Result<Scene>> scenes{coverageScene("E06", triangles, kMedium)};
    std::ranges::reverse(triangles);
    scenes.push_back(coverageScene("E06_reversed", triangles, kMedium));
    return collect(std::move(scenes));
}

Status checkE06(const CaseImages& images, Strictness strictness) {
    if (Status s = checkShape(images, 2, 1, kMedium); !s) return s;
    const auto triangles = gridTriangles(onGrid());
    if (Status s = checkCounts("E06", images[0][0], triangles, gridOf(kMedium), strictness, true); !s) return s;
    if (images[0][0].texels != images[1][0].texels)
        return verdict("E06", "the coverage depends on the order of the triangles");
    return {};
}

Result<std::vector<Scene>> buildE07() {
    return collect({coverageScene("E07", clipPositions(offGrid(), kMediumViewport), kMedium, kMediumViewport)});
}

Status checkE07(const CaseImages& images, Strictness strictness) {
    if (Status s = checkShape(images, 1, 1, kMedium); !s) return s;
    // Legal snapping of the unsnapped vertices lies within one sub-unit of the snapped ones that the checks
    // start from.
    return checkCounts("E07", images[0][0], gridTriangles(offGrid()), gridOf(kMedium), strictness, true);
}

namespace {

constexpr VkExtent2D kWindow{64, 64};
constexpr float kSliverViewport = 8192;

// The sliver of 0.777 square pixels, moved by half a pixel so that the lattice points inside it become
// centres, and a triangle beyond each of its edges.
std::vector<GridTriangle> sliverAndNeighbours() {
    const GridPoint a{965334 + 128, 9134 + 128}, b{1857265 + 128, 1515506 + 128}, c{1515249 + 128, 937879 + 128};
    const GridPoint left{965334 - 300000, 1515506}, right{1857265, 9134 + 200000};
    const bool leftIsFar = (exact::edgeFunction(a, b, c) > 0) == (exact::edgeFunction(a, b, left) > 0);
    const GridPoint far = leftIsFar ? left : right,
                    near = leftIsFar ? right : left;  // far: on c's side of a-b
    return {{a, b, c}, {a, b, near}, {a, c, far}, {c, b, far}};
}

struct Centre {
    int64_t x, y;
};

std::vector<Centre> sliverCentres() {
    const GridTriangle sliver = sliverAndNeighbours()[0];
    std::vector<Centre> result;
    for (int64_t y = sliver[0].y / 256; y <= sliver[1].y / 256; ++y) {
        const int64_t along =
            sliver[0].x + (sliver[1].x - sliver[0].x) * (y * 256 + 128 - sliver[0].y) / (sliver[1].y - sliver[0].y);
        for (int64_t x = along / 256 - 2; x <= along / 256 + 2; ++x) {
            if (exact::covers(sliver, {x * 256 + 128, y * 256 + 128})) result.push_back({x, y});
        }
    }
    return result;
}

// Upper left corners of windows that show all of the sliver's centres.
std::vector<Centre> sliverWindows() {
    std::vector<Centre> result;
    for (const Centre& c : sliverCentres()) {
        const bool shown = std::ranges::any_of(result, [&c](const Centre& w) {
            return c.x >= w.x && c.y >= w.y && c.x < w.x + kWindow.width && c.y < w.y + kWindow.height;
        });
        if (!shown) result.push_back({c.x - 8, c.y - 8});
    }
    return result;
}

}  // namespace

Result<std::vector<Scene>> buildE10() {
    std::vector<Result<Scene>> scenes;
    for (const Centre& window : sliverWindows()) {
        const VkViewport whole{0, 0, kSliverViewport, kSliverViewport, 0, 1};
        std::vector<ClipPosition> positions;
        for (const GridTriangle& t : sliverAndNeighbours()) {
            for (const GridPoint& p : t) positions.push_back(clipOnGrid(p, whole));
        }
        const VkViewport moved{
            static_cast<float>(-window.x), static_cast<float>(-window.y), kSliverViewport, kSliverViewport, 0, 1};
        scenes.push_back(coverageScene("E10", positions, kWindow, moved));
    }
    return collect(std::move(scenes));
}

Status checkE10(const CaseImages& images, Strictness strictness) {
    const auto windows = sliverWindows();
    if (Status s = checkShape(images, windows.size(), 1, kWindow); !s) return s;
    const auto triangles = sliverAndNeighbours();
    for (size_t i = 0; i < windows.size(); ++i) {
        const SampleGrid grid = gridOf(kWindow, windows[i].x * 256, windows[i].y * 256);
        Status s = checkCounts("E10", images[i][0], triangles, grid, strictness, true);
        if (!s) {
            return verdict("E10", "window at (" + std::to_string(windows[i].x) + ", " + std::to_string(windows[i].y) +
                                      "): " + s.error().message);
        }
    }
    return {};
}

Result<std::vector<Scene>> buildE11() {
    const GridPoint p = pixels(4.5, 4.5);
    const std::vector<GridTriangle> empty{
        {p, p, p},
        {pixels(1, 1), pixels(1, 1), pixels(12, 9)},
        {pixels(1, 1), pixels(12, 9), pixels(1, 1)},
        {pixels(0.5, 2.5), pixels(8.5, 2.5), pixels(15.5, 2.5)},
        {pixels(3.5, 0.5), pixels(3.5, 14.5), pixels(3.5, 7.5)},
        {pixels(0.5, 0.5), pixels(15.5, 15.5), pixels(7.5, 7.5)},
        {pixels(0, 0), pixels(16, 8), pixels(8, 4)},
    };
    return collect({coverageScene("E11", empty, kSmall)});
}

Status checkE11(const CaseImages& images, Strictness) {
    if (Status s = checkShape(images, 1, 1, kSmall); !s) return s;
    const auto counts = coverageCounts(images[0][0], kSmall);
    if (!counts) return verdict("E11", counts.error().message);
    for (uint32_t i = 0; i < counts->size(); ++i) {
        if ((*counts)[i] == 0) continue;
        return verdict("E11", pixelText(i % kSmall.width, i / kSmall.width) + " is covered " +
                                  std::to_string((*counts)[i]) + " times by triangles without area");
    }
    return {};
}

}  // namespace vernier::conformance::cases
