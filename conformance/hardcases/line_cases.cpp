#include "conformance/hardcases/line_cases.h"

#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/oracle/bresenham_check.h"
#include "conformance/oracle/line_shape.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::hardcases {
namespace {

using exact::Coverage;
using exact::GridLine;
using exact::PixelIndex;
using exact::Rational;

// ---- Bresenham lines, each path in a cell of its own ----

constexpr uint32_t kCell = 32;
constexpr VkExtent2D kCells{128, 64};

/// Connected points, relative to the cell; all segments of one major axis and direction.
using Path = std::vector<WindowPoint>;

WindowPoint inCell(size_t cell, const WindowPoint& p) {
    const size_t perRow = kCells.width / kCell;
    return {p.x + static_cast<double>(cell % perRow * kCell), p.y + static_cast<double>(cell / perRow * kCell)};
}

bool isXMajor(const Path& path) {
    return std::abs(path[1].x - path[0].x) >= std::abs(path[1].y - path[0].y);
}

std::vector<PixelIndex> fragmentsOf(const WindowPoint& a, const WindowPoint& b) {
    return exact::bresenhamPixels({exact::rational(a.x), exact::rational(a.y)},
                                  {exact::rational(b.x), exact::rational(b.y)});
}

CountOptions bresenham(VkExtent2D extent) {
    CountOptions options;
    options.extent = extent;
    options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    options.lineMode = VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    return options;
}

Verdict judgePath(const std::vector<uint32_t>& counts, const Path& path, size_t cell) {
    std::vector<PixelIndex> exactly, observed;
    for (size_t i = 1; i < path.size(); ++i) {
        for (const PixelIndex& p : fragmentsOf(inCell(cell, path[i - 1]), inCell(cell, path[i]))) exactly.push_back(p);
    }
    const WindowPoint corner = inCell(cell, {0, 0});
    for (uint32_t y = 0; y < kCell; ++y) {
        for (uint32_t x = 0; x < kCell; ++x) {
            const auto px = static_cast<uint32_t>(corner.x) + x, py = static_cast<uint32_t>(corner.y) + y;
            const uint32_t count = counts[size_t{py} * kCells.width + px];
            if (count > 1) {
                return Verdict::wrong(pixelText(px, py) + " is drawn " + std::to_string(count) +
                                      " times: condition 4, connected segments draw no fragment twice");
            }
            if (count == 1) observed.push_back({px, py});
        }
    }
    const auto before = [](const PixelIndex& a, const PixelIndex& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
    std::ranges::sort(exactly, before);
    if (exactly == observed) return {};
    const auto [own, other] = std::ranges::mismatch(exactly, observed);
    const PixelIndex first = own != exactly.end() ? *own : *other;
    const std::string where = "path " + std::to_string(cell) + " leaves the diamond-exit rule at " +
                              pixelText(static_cast<uint32_t>(first.x), static_cast<uint32_t>(first.y));
    const std::string broken = exact::checkBresenham(exactly, observed, isXMajor(path), path.size() - 1);
    return broken.empty() ? Verdict::allowed(where + "; within the four conditions")
                          : Verdict::wrong(where + "; " + broken);
}

/// Adds a scene of at most eight paths and its judge.
void addPaths(CaseInput& input, std::string_view name, const std::vector<Path>& paths) {
    std::vector<ClipPosition> positions;
    for (size_t cell = 0; cell < paths.size(); ++cell) {
        for (size_t i = 1; i < paths[cell].size(); ++i) {
            for (const WindowPoint& p : {paths[cell][i - 1], paths[cell][i]})
                positions.push_back(clipAt(inCell(cell, p), viewportOf(kCells)));
        }
    }
    const size_t scene = input.scene(countScene(name, positions, bresenham(kCells)));
    input.judge({scene}, [paths](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const auto counts = readCounts(*images[0], kCells);
        if (!counts) return Verdict::wrong(counts.error().message);
        Verdict worst;
        for (size_t cell = 0; cell < paths.size(); ++cell) worst = worst.worse(judgePath(*counts, paths[cell], cell));
        return worst;
    });
}

/// The path in all octants, around the middle of a cell.
std::vector<Path> inOctants(const Path& path) {
    std::vector<Path> result;
    for (int octant = 0; octant < 8; ++octant) {
        Path turned;
        for (const WindowPoint& p : path) {
            double x = p.x, y = p.y;
            if ((octant & 1) != 0) std::swap(x, y);
            if ((octant & 2) != 0) x = -x;
            if ((octant & 4) != 0) y = -y;
            turned.push_back({16 + x, 16 + y});
        }
        result.push_back(turned);
    }
    return result;
}

// ---- Stipples ----

constexpr VkExtent2D kTarget{64, 64};

struct Stipple {
    uint32_t factor;
    uint16_t pattern;
};

void addStippled(CaseInput& input, const std::vector<WindowPoint>& points, bool strip, const Stipple& stipple) {
    CountOptions options = bresenham(kTarget);
    options.stippleFactor = stipple.factor;
    options.stipplePattern = stipple.pattern;
    if (strip) options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
    std::vector<ClipPosition> positions;
    for (const WindowPoint& p : points) positions.push_back(clipAt(p, viewportOf(kTarget)));
    const size_t scene = input.scene(countScene("P07_stipple", positions, options));
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        if (!counts) return Verdict::wrong(counts.error().message);
        std::vector<uint32_t> exactly(counts->size());
        std::vector<exact::LineShape> shapes;
        int64_t start = 0;
        for (size_t i = 1; i < points.size(); i += strip ? 1 : 2) {
            exact::LineShape::Setup setup;
            setup.ends = {{{points[i - 1].x, points[i - 1].y}, {points[i].x, points[i].y}}};
            setup.mode = options.lineMode;
            setup.stippleFactor = stipple.factor;
            setup.stipplePattern = stipple.pattern;
            setup.stippleStart = strip ? start : 0;
            setup.stippleFreedom = static_cast<int64_t>(strip ? i : 1);
            setup.subPixelBits = declared.subPixelBits;
            shapes.emplace_back(setup);
            for (const PixelIndex& p : fragmentsOf(points[i - 1], points[i])) {
                const int64_t bit = start / stipple.factor % 16;
                if ((stipple.pattern >> bit & 1) != 0)
                    ++exactly[static_cast<size_t>(p.y) * kTarget.width + static_cast<size_t>(p.x)];
                ++start;
            }
            if (!strip) start = 0;
        }
        Verdict worst;
        for (uint32_t i = 0; i < counts->size(); ++i) {
            if ((*counts)[i] == exactly[i]) continue;
            const uint32_t x = i % kTarget.width, y = i / kTarget.width;
            const int64_t unit = int64_t{1} << declared.subPixelBits;
            const exact::GridPoint centre{x * unit + unit / 2, y * unit + unit / 2};
            const auto most = static_cast<uint32_t>(std::ranges::count_if(
                shapes, [&](const exact::LineShape& shape) { return shape.classify(centre).possible; }));
            const std::string text = pixelText(x, y) + " is drawn " + std::to_string((*counts)[i]) +
                                     " times, exactly " + std::to_string(exactly[i]) +
                                     " by bit (fragment / factor) mod 16 of the pattern";
            worst = worst.worse(Verdict::inexact((*counts)[i] <= most, text));
        }
        return worst;
    });
}

// ---- Smooth lines ----

using Polygon = std::vector<WindowPoint>;

/// The part of a polygon on the side of a line where a x + b y <= c.
Polygon cut(const Polygon& polygon, double a, double b, double c) {
    Polygon result;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const WindowPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double u = a * p.x + b * p.y - c, v = a * q.x + b * q.y - c;
        if (u <= 0) result.push_back(p);
        if ((u < 0) != (v < 0) && u != v)
            result.push_back({p.x + (q.x - p.x) * u / (u - v), p.y + (q.y - p.y) * u / (u - v)});
    }
    return result;
}

double areaOf(const Polygon& polygon) {
    double twice = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const WindowPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        twice += p.x * q.y - q.x * p.y;
    }
    return std::abs(twice) / 2;
}

/// The part of pixel (x, y) inside the rectangle of a line.
double coveredPart(const WindowPoint& a, const WindowPoint& b, double width, uint32_t x, uint32_t y) {
    const double length = std::hypot(b.x - a.x, b.y - a.y), ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    const double left = x, top = y;
    Polygon pixel{{left, top}, {left + 1, top}, {left + 1, top + 1}, {left, top + 1}};
    const double along = ux * a.x + uy * a.y, across = -uy * a.x + ux * a.y;
    pixel = cut(pixel, ux, uy, along + length);
    pixel = cut(pixel, -ux, -uy, -along);
    pixel = cut(pixel, -uy, ux, across + width / 2);
    pixel = cut(pixel, uy, -ux, -across + width / 2);
    return areaOf(pixel);
}

void addSmooth(CaseInput& input, const WindowPoint& a, const WindowPoint& b, float width) {
    SceneRecorder record("P07_smooth", "A smooth line, whose coverage becomes alpha.");
    const uint32_t target = record.colorTarget("coverage", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    const std::vector<ClipPosition> positions{clipAt(a, viewportOf(kTarget)), clipAt(b, viewportOf(kTarget))};
    auto pipeline = record
                        .pipeline(record.vertex(kPositionVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)"))
                        .binding(sizeof(ClipPosition))
                        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                        .topology(VK_PRIMITIVE_TOPOLOGY_LINE_LIST)
                        .lineMode(VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT);
    if (width != 1) pipeline.lineWidth(width);
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, 2).vertices(record.vertexBuffer("ends", positions));
    record.output(target);
    judgePixels(input, input.scene(record.finish()), 0, kTarget,
                [=](const PixelReader& pixels, const Declared& declared) -> Verdict {
                    // Snapping moves the outline by up to a sub-unit, over at most the diagonal of a pixel.
                    const double close = 1.0 / 255 + 2 * std::ldexp(1.0, -declared.subPixelBits);
                    Verdict worst;
                    for (uint32_t y = 0; y < kTarget.height; ++y) {
                        for (uint32_t x = 0; x < kTarget.width; ++x) {
                            const double part = coveredPart(a, b, width, x, y),
                                         alpha = static_cast<double>(pixels.code(x, y, 3)) / 255;
                            if (std::abs(alpha - part) <= close) continue;
                            const std::string text = pixelText(x, y) + " has coverage " + std::to_string(alpha) +
                                                     ", the part inside the rectangle is " + std::to_string(part);
                            // Approximations are left to the implementation; what the line does not come near has none.
                            const bool far = coveredPart(a, b, width + 3.0, x, y) == 0 && part == 0;
                            worst = worst.worse(far ? Verdict::wrong(text) : Verdict::allowed(text));
                        }
                    }
                    return worst;
                });
}

// ---- Outlines of clipped triangles ----

struct DeepPoint {
    WindowPoint p;
    double z;
};

WindowPoint between(const DeepPoint& a, const DeepPoint& b, double t) {
    return {a.p.x + (b.p.x - a.p.x) * t, a.p.y + (b.p.y - a.p.y) * t};
}

/// Visible parts of the triangle's own edges, shorter by `shrink` pixels where the near plane cuts them; and the cut.
struct Outline {
    std::vector<std::array<WindowPoint, 2>> own, cuts;
};

Outline outlineOf(const std::array<DeepPoint, 3>& triangle, double shrink) {
    Outline outline;
    std::vector<WindowPoint> cut;
    for (size_t i = 0; i < 3; ++i) {
        const DeepPoint &a = triangle[i], &b = triangle[(i + 1) % 3];
        if (a.z < 0 && b.z < 0) continue;
        double from = 0, to = 1;
        if ((a.z < 0) != (b.z < 0)) {
            const double t = a.z / (a.z - b.z), step = shrink / std::hypot(b.p.x - a.p.x, b.p.y - a.p.y);
            cut.push_back(between(a, b, t));
            (a.z < 0 ? from : to) = a.z < 0 ? t + step : t - step;
        }
        outline.own.push_back({between(a, b, from), between(a, b, to)});
    }
    if (cut.size() == 2) outline.cuts.push_back({cut[0], cut[1]});
    return outline;
}

void addOutline(CaseInput& input, const std::array<DeepPoint, 3>& triangle) {
    std::vector<ClipPosition> positions;
    for (const DeepPoint& d : triangle) {
        positions.push_back(clipAt(d.p, viewportOf(kTarget), static_cast<float>(d.z)));
    }
    CountOptions options;
    options.extent = kTarget;
    options.polygonMode = VK_POLYGON_MODE_LINE;
    const size_t scene = input.scene(countScene("P12", positions, options));
    input.judge({scene}, [triangle](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        if (!counts) return Verdict::wrong(counts.error().message);
        const Outline certain = outlineOf(triangle, 2), reach = outlineOf(triangle, -2);
        const double unit = std::ldexp(1.0, declared.subPixelBits);
        const auto grid = [unit](const std::array<WindowPoint, 2>& ends, double width) {
            const auto snap = [unit](const WindowPoint& p) {
                return exact::GridPoint{std::llround(p.x * unit), std::llround(p.y * unit)};
            };
            return GridLine{snap(ends[0]), snap(ends[1]), exact::rational(width * unit)};
        };
        const auto touches = [&](const auto& list, double width, int64_t slack, Coverage atLeast,
                                 const exact::GridPoint& p) {
            return std::ranges::any_of(list, [&](const std::array<WindowPoint, 2>& ends) {
                return exact::classifyLine(grid(ends, width), p, slack) >= atLeast;
            });
        };
        size_t seen = 0;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                const exact::GridPoint p{std::llround((x + 0.5) * unit), std::llround((y + 0.5) * unit)};
                const bool drawn = (*counts)[size_t{y} * kTarget.width + x] != 0;
                seen += drawn;
                // Ends and corners move by three sub-units; the implementation's own edges lie where it clips.
                if (!drawn && touches(certain.own, 1, 3, Coverage::must, p))
                    return Verdict::wrong(pixelText(x, y) + " on an edge of the triangle is not drawn");
                const bool atBorder = x < 2 || y < 2 || x + 2 >= kTarget.width || y + 2 >= kTarget.height;
                if (drawn && !atBorder && !touches(reach.own, 1, 3, Coverage::may, p) &&
                    !touches(reach.cuts, 3, 3, Coverage::may, p)) {
                    return Verdict::wrong(pixelText(x, y) + " is drawn, away from all edges and cuts");
                }
            }
        }
        return seen < 40 ? Verdict::wrong("only " + std::to_string(seen) + " pixels are drawn") : Verdict{};
    });
}

}  // namespace

void p01(CaseInput& input) {
    addPaths(input, "P01", inOctants({{0.5, 0.5}, {13.5, 4.5}}));
    addPaths(input, "P01_axes", inOctants({{0.5, 0.5}, {12.5, 0.5}}));
    // A line and what continues it draw every pixel once.
    addPaths(input, "P01_connected", inOctants({{-13.5, -2.5}, {0.5, 0.5}, {12.5, 8.5}}));
}

void p02(CaseInput& input) {
    // Corners of diamonds lie half a pixel from the centre along either axis; edges between them.
    addPaths(input, "P02_corners", inOctants({{0, 0.5}, {13, 3.5}}));
    addPaths(input, "P02_tops", inOctants({{0.5, 0}, {12.5, 5}}));
    addPaths(input, "P02_edges", inOctants({{0.25, 0.25}, {12.75, 6.25}}));
    addPaths(input, "P02_connected", inOctants({{-12, -3.5}, {0, 0.5}, {13, 3.5}}));
}

void p03(CaseInput& input) {
    addPaths(input, "P03", inOctants({{0.5, 0.5}, {11.5, 11.5}}));
    addPaths(input, "P03_off", inOctants({{0.25, 0.5}, {11.25, 11.5}}));
}

void p07(CaseInput& input) {
    const std::vector<WindowPoint> list{{3.5, 3.5}, {60.5, 9.5}, {5.5, 60.5}, {20.5, 14.5}, {60.5, 60.5}, {22.5, 44.5}};
    const std::vector<WindowPoint> strip{{4.5, 4.5}, {58.5, 12.5}, {50.5, 58.5}, {8.5, 50.5}, {18.5, 20.5}};
    for (const Stipple& stipple : {Stipple{1, 0x5555}, {1, 0x8001}, {3, 0x0f0f}, {256, 0x0001}}) {
        addStippled(input, list, false, stipple);
        addStippled(input, strip, true, stipple);
    }
    for (const float width : {1.0f, 5.0f}) {
        addSmooth(input, {8.25, 10.5}, {55.5, 31.75}, width);
        addSmooth(input, {20.5, 55.25}, {31.25, 6.5}, width);
    }
}

void p12(CaseInput& input) {
    addOutline(input, {{{{10.25, 12.5}, 0.5}, {{54.75, 20.25}, 0.5}, {{24.5, 56.75}, -0.4}}});
    addOutline(input, {{{{10.25, 12.5}, -0.25}, {{54.75, 20.25}, 0.5}, {{24.5, 56.75}, -0.4}}});
    addOutline(input, {{{{-30, 8.5}, 0.5}, {{50, 14.5}, 0.5}, {{24, 60}, 0.5}}});
}

}  // namespace vernier::conformance::hardcases
