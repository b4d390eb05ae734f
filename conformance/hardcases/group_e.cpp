// E: coverage and edges.
#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/geometry_stage_cases.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/painter_input.h"
#include "conformance/hardcases/tessellation_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kSmall{16, 16}, kMedium{64, 64};
constexpr double kUnit = 1.0 / 256;  // a sub-unit of 8 sub-pixel bits, in pixels
constexpr double kTurn = 6.283185307179586476925;

CoverageOptions plain(VkExtent2D extent) {
    CoverageOptions options;
    options.extent = extent;
    return options;
}

CoverageOptions tiling(VkExtent2D extent) {
    CoverageOptions options = plain(extent);
    options.tiling = true;
    return options;
}

double onGrid(double pixels) {
    return std::nearbyint(pixels * 256) / 256;
}

WindowTriangles quad(WindowPoint a, WindowPoint b, WindowPoint c, WindowPoint d) {
    return {{a, b, c}, {d, c, b}};
}

// Squares whose diagonal runs through centres, with borders between centres and on them, and a skewed one.
std::vector<WindowTriangles> diagonalQuads() {
    return {quad({1, 1}, {1, 7}, {7, 1}, {7, 7}), quad({0.5, 0.5}, {0.5, 6.5}, {6.5, 0.5}, {6.5, 6.5}),
            quad({0, 0}, {0, 16}, {16, 0}, {16, 16}), quad({2.5, 1}, {1.5, 9}, {14.5, 2}, {13.5, 10})};
}

void e01(CaseInput& input) {
    for (const WindowTriangles& each : diagonalQuads()) addCoverage(input, "E01", each, tiling(kSmall));
    // The coordinates of a public bug report: both triangles leave the whole diagonal out.
    addCoverage(input, "E01_report",
                quad({0.5, 0.49993896484375}, {0.5, 6.5}, {6.50006103515625, 0.49993896484375}, {6.5, 6.5}),
                tiling(kSmall));
}

// All orders of the three vertices: three rotations in both windings, of each triangle on its own.
void e02(CaseInput& input) {
    const WindowTriangles base = diagonalQuads()[0];
    const auto ordered = [](const WindowTriangle& t, size_t order) {
        const size_t r = order % 3;
        WindowTriangle turned{t[r], t[(r + 1) % 3], t[(r + 2) % 3]};
        if (order >= 3) std::swap(turned[1], turned[2]);
        return turned;
    };
    for (size_t first = 0; first < 6; ++first) {
        for (size_t second = 0; second < 6; ++second) {
            const size_t scene =
                addCoverage(input, "E02", {ordered(base[0], first), ordered(base[1], second)}, tiling(kSmall));
            if (scene != 0) judgeSame(input, scene, 0, "the order of the vertices changes no coverage");
        }
    }
}

// Two rectangles that meet on a row (or column) of centres.
void meeting(CaseInput& input, bool vertical) {
    const auto at = [vertical](double along, double across) {
        return vertical ? WindowPoint{across, along} : WindowPoint{along, across};
    };
    WindowTriangles both = quad(at(2.25, 1.5), at(12.75, 1.5), at(2.25, 7.5), at(12.75, 7.5));
    for (const WindowTriangle& t : quad(at(2.25, 7.5), at(12.75, 7.5), at(2.25, 13.5), at(12.75, 13.5)))
        both.push_back(t);
    addCoverage(input, vertical ? "E04" : "E03", both, tiling(kSmall));
}
void e03(CaseInput& input) {
    meeting(input, false);
}
void e04(CaseInput& input) {
    meeting(input, true);
}

// A closed fan around a hub that is a pixel centre.
WindowTriangles fan(uint32_t triangles, double radius, double turn) {
    const WindowPoint hub{32.5, 32.5};
    const auto rim = [&](uint32_t i) {
        const double angle = kTurn * (i % triangles + turn) / triangles;
        return WindowPoint{onGrid(hub.x + radius * std::cos(angle)), onGrid(hub.y + radius * std::sin(angle))};
    };
    WindowTriangles result;
    for (uint32_t i = 0; i < triangles; ++i) result.push_back({hub, rim(i), rim(i + 1)});
    return result;
}

void e05(CaseInput& input) {
    for (const uint32_t triangles : {3u, 4u, 5u, 7u, 8u, 16u, 31u, 64u}) {
        addCoverage(input, "E05", fan(triangles, 27.3, 0), tiling(kMedium));
        addCoverage(input, "E05_turned", fan(triangles, 27.3, 0.37), tiling(kMedium));
    }
}

void e06(CaseInput& input) {
    WindowTriangles triangles = jitteredTiling(9, 6.5, 1.9, 256, 6);
    addCoverage(input, "E06", triangles, tiling(kMedium));
    std::ranges::reverse(triangles);
    const size_t reversed = addCoverage(input, "E06_reversed", triangles, tiling(kMedium));
    judgeSame(input, reversed, 0, "the order of triangles that do not overlap changes no coverage");
}

// Dense enough that hundreds of centres lie within a sub-unit of an edge.
void e07(CaseInput& input) {
    addCoverage(input, "E07", jitteredTiling(28, 2.21875, 0.6, 0x1p16, 7), tiling(kMedium));
}

// The edge a-b on one side, a-m and m-b on the other, m on the line and, in the second scene, off it by rounding.
void e08(CaseInput& input) {
    const WindowPoint a{4, 4}, b{60, 32}, above{50, 2}, below{10, 60};
    for (const WindowPoint m : {WindowPoint{32, 18}, WindowPoint{31.001, 17.5005}}) {
        addCoverage(input, "E08", {{a, b, above}, {a, m, below}, {m, b, below}}, plain(kMedium));
    }
}

// A sliver a-b-c and triangles beyond each of its edges.
WindowTriangles withNeighbours(WindowPoint a, WindowPoint b, WindowPoint c, double reach) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    const double side = dx * (c.y - a.y) - dy * (c.x - a.x) >= 0 ? 1 : -1;
    const auto apex = [&](double sign) {
        return WindowPoint{onGrid((a.x + b.x) / 2 - sign * dy / length * reach),
                           onGrid((a.y + b.y) / 2 + sign * dx / length * reach)};
    };
    const WindowPoint far = apex(side), near = apex(-side);
    return {{a, b, c}, {a, b, near}, {a, c, far}, {c, b, far}};
}

void e09(CaseInput& input) {
    std::mt19937 random(9);
    const auto between = [&random](double low, double high) {
        return onGrid(low + (high - low) * static_cast<double>(random()) / 4294967296.0);
    };
    for (int i = 0; i < 12; ++i) {
        const WindowPoint a{between(-300, 5), between(0, 64)}, b{between(60, 360), between(0, 64)};
        const double t = between(0.1, 0.9);
        const double off = static_cast<double>(static_cast<int>(random() % 3) - 1) * kUnit;
        const WindowPoint c{onGrid(a.x + (b.x - a.x) * t), onGrid(a.y + (b.y - a.y) * t) + off};
        addCoverage(input, "E09", withNeighbours(a, b, c, 30), tiling(kMedium));
    }
}

constexpr float kSliverViewport = 8192;

// The sliver of 0.777 square pixels, moved by half a pixel so that the lattice points inside it become centres, and a
// triangle beyond each of its edges.
WindowTriangles sliverAndNeighbours() {
    const auto at = [](double x, double y) { return WindowPoint{(x + 128) / 256, (y + 128) / 256}; };
    const WindowPoint a = at(965334, 9134), b = at(1857265, 1515506), c = at(1515249, 937879);
    const WindowPoint left{(965334 - 300000) / 256.0, 1515506 / 256.0}, right{1857265 / 256.0, (9134 + 200000) / 256.0};
    const std::vector<exact::GridTriangle> grid = snapped({{a, b, c}, {a, b, left}}, 8);
    const bool leftIsFar = exact::orientation(grid[0]) == exact::orientation(grid[1]);
    const WindowPoint far = leftIsFar ? left : right, near = leftIsFar ? right : left;  // far: on c's side of a-b
    return {{a, b, c}, {a, b, near}, {a, c, far}, {c, b, far}};
}

// Upper left corners of windows that show all of the sliver's centres.
std::vector<exact::GridPoint> sliverWindows() {
    const exact::GridTriangle sliver = snapped(sliverAndNeighbours(), 8)[0];
    std::vector<exact::GridPoint> result;
    for (int64_t y = sliver[0].y / 256; y <= sliver[1].y / 256; ++y) {
        const int64_t along =
            sliver[0].x + (sliver[1].x - sliver[0].x) * (y * 256 + 128 - sliver[0].y) / (sliver[1].y - sliver[0].y);
        for (int64_t x = along / 256 - 2; x <= along / 256 + 2; ++x) {
            if (!exact::covers(sliver, {x * 256 + 128, y * 256 + 128})) continue;
            const bool shown = std::ranges::any_of(
                result, [&](const auto& w) { return x >= w.x && y >= w.y && x < w.x + 64 && y < w.y + 64; });
            if (!shown) result.push_back({x - 8, y - 8});
        }
    }
    return result;
}

void e10(CaseInput& input) {
    for (const exact::GridPoint& window : sliverWindows()) {
        CoverageOptions options = tiling(kMedium);
        options.viewport = VkViewport{0, 0, kSliverViewport, kSliverViewport, 0, 1};
        options.windowX = window.x;
        options.windowY = window.y;
        addCoverage(input, "E10", sliverAndNeighbours(), options);
    }
}

const WindowTriangles& trianglesWithoutArea() {
    static const WindowTriangles triangles{
        {{{4.5, 4.5}, {4.5, 4.5}, {4.5, 4.5}}},
        {{{1, 1}, {1, 1}, {12, 9}}},
        {{{1, 1}, {12, 9}, {1, 1}}},
        {{{0.5, 2.5}, {8.5, 2.5}, {15.5, 2.5}}},
        {{{3.5, 0.5}, {3.5, 14.5}, {3.5, 7.5}}},
        {{{0.5, 0.5}, {15.5, 15.5}, {7.5, 7.5}}},
        {{{0, 0}, {16, 8}, {8, 4}}},
    };
    return triangles;
}

void e11(CaseInput& input) {
    const auto positions = clipAt(trianglesWithoutArea(), viewportOf(kSmall));
    for (const VkCullModeFlags cull : {VK_CULL_MODE_NONE, VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_BACK_BIT}) {
        CountOptions options = plain(kSmall);
        options.cull = cull;
        judgeEmpty(input, input.scene(countScene("E11", positions, options)), options, "the triangles have no area");
    }
}

// Off the grid by less than snapping moves.
void e12(CaseInput& input) {
    WindowTriangles triangles;
    for (const WindowTriangle& t : trianglesWithoutArea()) {
        WindowTriangle moved = t;
        moved[0].x += 0.0009;
        moved[1].y -= 0.0007;
        moved[2].x -= 0.0011;
        triangles.push_back(moved);
    }
    addCoverage(input, "E12", triangles, plain(kSmall));
}

void e13(CaseInput& input) {
    addCoverage(input, "E13_quarter_pixels", jitteredTiling(40, 0.25, 0.11, 256, 13), tiling(kSmall));
    // Squares of one sub-unit, cut into triangles of half a square sub-unit, around a pixel centre.
    WindowTriangles tiny;
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            const double left = 4.5 + (x - 20) * kUnit, top = 4.5 + (y - 20) * kUnit;
            const double right = left + kUnit, bottom = top + kUnit;
            for (const WindowTriangle& t : quad({left, top}, {left, bottom}, {right, top}, {right, bottom}))
                tiny.push_back(t);
        }
    }
    addCoverage(input, "E13_sub_units", tiny, tiling({8, 8}));
}

// One triangle around a plane of 8192 pixels, seen through windows at its corners and centre.
void e14(CaseInput& input) {
    const WindowTriangles huge{{{{-9000, -8192}, {26000, -8192}, {-9000, 26000}}}};
    for (const auto& [x, y] : {std::pair{0, 0}, {8128, 0}, {0, 8128}, {8128, 8128}, {4064, 4064}}) {
        CoverageOptions options = plain(kMedium);
        options.viewport = VkViewport{0, 0, kSliverViewport, kSliverViewport, 0, 1};
        options.windowX = x;
        options.windowY = y;
        addCoverage(input, "E14", huge, options);
    }
    addCoverage(input, "E14_whole", {{{{-700, -500}, {3000, -500}, {-700, 3000}}}}, plain({777, 613}));
}

// Vertices half-way between two sub-units, for every number of sub-pixel bits on the dial.
void e15(CaseInput& input) {
    for (const int bits : {4, 8, 12, 16}) {
        WindowTriangles triangles = jitteredTiling(12, 4.875, 1.6, std::ldexp(1.0, bits), 15);
        const double half = std::ldexp(1.0, -bits - 1);
        for (WindowTriangle& t : triangles) {
            for (WindowPoint& p : t) p = {p.x + half, p.y + half};
        }
        addCoverage(input, "E15", triangles, tiling(kMedium));
    }
}

// Clip coordinates around 0 and one unit in the last place around half-way points of the grid.
void e16(CaseInput& input) {
    const std::vector<ClipPosition> base{{0, -0.9f, 0.5f, 1}, {0.8f, 0, 0.5f, 1}, {-0.7f, 0.6f, 0.5f, 1}};
    const auto with = [&base](float zero) {
        std::vector<ClipPosition> moved = base;
        moved[0][0] = zero;
        moved[1][1] = zero;
        return moved;
    };
    const size_t plainScene = input.scene(countScene("E16", with(0.0f), plain(kMedium)));
    for (const float zero : {-0.0f, 0x1p-149f, -0x1p-149f, 0x1p-126f, -0x1p-126f}) {
        judgeSame(input, input.scene(countScene("E16_zero", with(zero), plain(kMedium))), plainScene,
                  "-0 and denormals are snapped to 0");
    }
    for (const float direction : {-2.0f, 2.0f}) {
        WindowTriangles moved;
        std::vector<ClipPosition> positions;
        for (WindowTriangle t : jitteredTiling(9, 6.5, 1.9, 256, 16)) {
            for (WindowPoint& p : t) {
                ClipPosition clip = clipAt({p.x + kUnit / 2, p.y + kUnit / 2}, viewportOf(kMedium));
                for (size_t c : {0, 1}) clip[c] = std::nextafter(clip[c], direction);
                positions.push_back(clip);
                p = {static_cast<double>(clip[0]) * 32 + 32, static_cast<double>(clip[1]) * 32 + 32};
            }
            moved.push_back(t);
        }
        judgeCoverage(input, input.scene(countScene("E16_ulp", positions, plain(kMedium))), moved, tiling(kMedium));
    }
}

// Triangles whose outermost vertices are on a centre, and a sub-unit before and behind it, on all four sides.
void e17(CaseInput& input) {
    WindowTriangles triangles;
    for (int side = 0; side < 4; ++side) {
        for (int step = -1; step <= 1; ++step) {
            const double ox = 2.5 + side * 16, oy = 2.5 + (step + 1) * 16, d = step * kUnit;
            const auto at = [&](double along, double outward) {
                const double o = side % 2 == 0 ? outward + d : 8 - outward - d;
                return side < 2 ? WindowPoint{ox + o, oy + along} : WindowPoint{ox + along, oy + o};
            };
            triangles.push_back({at(0, 0), at(8, 0), at(4, 6.25)});
            triangles.push_back({at(1, 7.5), at(5, 0), at(7, 7.25)});
        }
    }
    addCoverage(input, "E17", triangles, plain(kMedium));
}

// Triangles with a vertex at, or a sub-unit beside, a corner that tiles and blocks of 8, 16 and 64 pixels share.
void e18(CaseInput& input) {
    constexpr VkExtent2D kTarget{160, 144};
    for (const double offset : {0.0, kUnit, -kUnit, 0.5}) {
        WindowTriangles triangles;
        for (const WindowPoint corner : {WindowPoint{64, 64}, WindowPoint{128, 64}, WindowPoint{16, 32},
                                         WindowPoint{40, 104}, WindowPoint{104, 24}, WindowPoint{128, 128}}) {
            const WindowPoint p{corner.x + offset, corner.y + offset};
            triangles.push_back({p, {p.x + 13, p.y + 3.25}, {p.x + 4.5, p.y + 12}});
            triangles.push_back({p, {p.x - 13, p.y - 3.25}, {p.x - 4.5, p.y - 12}});
            triangles.push_back({p, {p.x + 13, p.y - 13}, {p.x + 1, p.y - 14}});
        }
        addCoverage(input, "E18", triangles, plain(kTarget));
    }
}

void e19(CaseInput& input) {
    const WindowTriangles triangles = jitteredTiling(9, 6.5, 1.9, 256, 19);
    for (int i = 0; i < 18; ++i) {
        CoverageOptions options = tiling(kMedium);
        options.scissor = VkRect2D{{i, 2 * i}, {static_cast<uint32_t>(41 - i), static_cast<uint32_t>(29 - i)}};
        addCoverage(input, "E19", triangles, options);
    }
    CoverageOptions nothing = tiling(kMedium);
    nothing.scissor = VkRect2D{{20, 20}, {0, 0}};
    addCoverage(input, "E19_empty", triangles, nothing);
    CoverageOptions beyond = tiling(kMedium);
    beyond.scissor = VkRect2D{{40, 50}, {1000, 1000}};
    addCoverage(input, "E19_beyond", triangles, beyond);
}

void e20(CaseInput& input) {
    std::mt19937 random(20);
    WindowTriangles triangles;
    for (int i = 0; i < 240; ++i) {
        const auto at = [&] { return static_cast<double>(random() % (128 * 256)) / 256; };
        triangles.push_back({{{at(), at()}, {at(), at()}, {at(), at()}}});
    }
    PainterOptions options;
    options.extent = {128, 128};  // powers of two: coordinates are exact, and those half-way on a coarser grid stay so
    for (const bool first : {false, true}) {
        for (const uint32_t perDraw : {0u, 7u}) {
            options.firstWins = first;
            options.depthTest = perDraw != 0;
            options.perDraw = perDraw;
            addPainter(input, "E20", triangles, options);
        }
    }
}

constexpr std::string_view kPolygons = "Vulkan, Basic Polygon Rasterization";

const std::vector<HardCase> kCases{
    {"E01", "Quads split along a diagonal through pixel centres",
     "Polygons with identical endpoints on a shared edge: exactly one covers a sample on it.", kPolygons, e01},
    {"E02", "The same two triangles in all vertex orders and windings",
     "Coverage is a function of geometry: the same for all 36 orders.", kPolygons, e02},
    {"E03", "Rectangles that meet on a row of pixel centres",
     "The row is covered once. Declared: top edges are in, bottom edges out.", kPolygons, e03},
    {"E04", "Rectangles that meet on a column of pixel centres",
     "The column is covered once. Declared: left edges are in, right edges out.", kPolygons, e04},
    {"E05", "Fans of 3 to 64 triangles around a pixel centre", "Exactly one triangle covers the hub.", kPolygons, e05},
    {"E06", "A random tiling with vertices on the sub-pixel grid, in two orders",
     "A partition: every sample inside is covered once, none outside, whatever the order.", kPolygons, e06},
    {"E07", "A random tiling with vertices off the grid", "Snapping is per vertex: a partition of the snapped tiling.",
     kPolygons, e07},
    {"E08", "A T-junction, with the third vertex on the edge and beside it",
     "On the line: exactly one triangle along it. Beside it cracks are permitted, up to snapping.", kPolygons, e08},
    {"E09", "Slivers thinner than a sub-unit between their neighbours",
     "The exact test on snapped vertices; with the neighbours a partition.", kPolygons, e09},
    {"E10",
     "A sliver whose area is 0 in float, between its neighbours, at 8K",
     "Its area is 0.777 square pixels: its 24 centres are covered once.",
     kPolygons,
     e10,
     {},
     {{"swiftshader", "computes the area in float and takes the winding from it: a hole"}}},
    {"E11",
     "Triangles without area, without culling, culling front and culling back",
     "No fragments.",
     kPolygons,
     e11,
     {},
     {{"swiftshader", "calls triangles without area front-facing: fragments where back faces are culled"}}},
    {"E12", "Triangles that lose their area by snapping", "As if they had none.", kPolygons, e12},
    {"E13", "Thousands of triangles smaller than a pixel, down to half a square sub-unit",
     "Every sample is covered by one triangle of the tiling.", kPolygons, e13},
    {"E14", "One triangle around an 8K plane, with vertices far outside", "Every sample is covered once.", kPolygons,
     e14},
    {"E15", "Vertices half-way between two sub-units, of 4, 8, 12 and 16 bits",
     "Either neighbour, the same for every triangle at the vertex. Declared: ties to even.", kPolygons, e15},
    {"E16", "Vertices at -0, at denormals, and an ULP beside a snapping boundary",
     "-0 and denormals snap to 0; the snapped coordinate is that of the exact value.", kPolygons, e16},
    {"E17", "Triangles that end on a centre, and a sub-unit before and behind it",
     "The edge decides, never the rounding of a bounding box.", kPolygons, e17},
    {"E18", "Triangles that touch corners of tiles and blocks in a point",
     "Block tests agree with the test per sample.", kPolygons, e18},
    {"E19", "A tiling under scissors that move pixel by pixel",
     "The scissor changes no fragment inside and leaves none outside.", "Vulkan, Scissor Test; Invariance, rule 2",
     e19},
    {"E20", "240 overlapping triangles of equal depth, in one draw and in many",
     "API order decides: the last one is seen, or the first with a LESS depth test.",
     "Vulkan, Primitive Order and Rasterization Order", e20},
    {"E21", "240 overlapping triangles of equal depth out of invocations of a geometry shader",
     "By input primitive, invocation and emission: the last one is seen, or the first with a LESS depth test.",
     "Vulkan, Geometry Shader Primitive Ordering", e21},
    {"E22", "Patches that share edges, forwards, backwards and turned, with other inner levels, straight and in waves",
     "The points of an edge depend on its level and the spacing alone: every pixel is covered once.",
     "Vulkan, Tessellation Invariance, rules 2 to 4 and 8", e22},
};

}  // namespace

std::span<const HardCase> edgeCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
