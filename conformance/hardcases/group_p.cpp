// P: lines and points.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/line_cases.h"
#include "conformance/oracle/lines.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace vernier::conformance::hardcases {
namespace {

using exact::Coverage;
using exact::GridLine;
using exact::GridPoint;
using exact::GridSquare;
using exact::Rational;

constexpr VkExtent2D kTarget{64, 64};

struct WindowLine {
    WindowPoint a, b;
};
using WindowLines = std::vector<WindowLine>;

CountOptions lines(VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST) {
    CountOptions options;
    options.extent = kTarget;
    options.topology = topology;
    return options;
}

GridPoint gridPoint(const WindowPoint& p, int bits) {
    return {exact::toInt64(exact::snapNearestEven(exact::rational(p.x), bits)),
            exact::toInt64(exact::snapNearestEven(exact::rational(p.y), bits))};
}

GridPoint centre(uint32_t x, uint32_t y, int bits) {
    const int64_t half = int64_t{1} << (bits - 1);
    return {2 * half * x + half, 2 * half * y + half};
}

/// Counts each sample's primitives: between those that must cover it and those that may; exact by `covers`.
template <class Shape>
Verdict judgeShapes(const Drawn& drawn, const std::vector<Shape>& shapes, int bits,
                    Coverage (*classify)(const Shape&, const GridPoint&, int64_t), int64_t slack,
                    bool (*covers)(const Shape&, const GridPoint&), const char* rule) {
    const auto counts = readCounts(drawn, kTarget);
    if (!counts) return Verdict::wrong(counts.error().message);
    Verdict worst;
    for (uint32_t y = 0; y < kTarget.height; ++y) {
        for (uint32_t x = 0; x < kTarget.width; ++x) {
            const GridPoint p = centre(x, y, bits);
            uint32_t low = 0, high = 0, exactly = 0;
            for (const Shape& shape : shapes) {
                const Coverage coverage = classify(shape, p, slack);
                low += coverage == Coverage::must;
                high += coverage != Coverage::mustNot;
                exactly += coverage != Coverage::mustNot && covers(shape, p);
            }
            const uint32_t count = (*counts)[size_t{y} * kTarget.width + x];
            if (count == exactly) continue;
            const std::string text = pixelText(x, y) + " is covered " + std::to_string(count) + " times, exactly " +
                                     std::to_string(exactly) + ", permitted " + std::to_string(low) + ".." +
                                     std::to_string(high) + "; " + rule;
            worst = worst.worse(Verdict::inexact(count >= low && count <= high, text));
        }
    }
    return worst;
}

// Ends are snapped by up to a sub-unit, and so are the corners of an implementation that draws two triangles.
constexpr int64_t kLineSlack = 3;

void judgeLines(CaseInput& input, size_t scene, const WindowLines& list, double width) {
    input.judge({scene}, [=](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const int bits = declared.subPixelBits;
        std::vector<GridLine> shapes;
        for (const WindowLine& l : list) {
            shapes.push_back(
                {gridPoint(l.a, bits), gridPoint(l.b, bits), exact::rational(width) * exact::powerOfTwo(bits)});
        }
        return judgeShapes<GridLine>(*images[0], shapes, bits, exact::classifyLine, kLineSlack, exact::lineCovers,
                                     "the rectangle of the line's width around the segment");
    });
}

std::vector<ClipPosition> positionsOf(const WindowLines& list) {
    std::vector<ClipPosition> positions;
    for (const WindowLine& l : list) {
        for (const WindowPoint& p : {l.a, l.b}) positions.push_back(clipAt(p, viewportOf(kTarget)));
    }
    return positions;
}

void p04(CaseInput& input) {
    const WindowLines empty{{{4.5, 4.5}, {4.5, 4.5}}, {{10, 10}, {10, 10}}, {{20.3, 7.7}, {20.3, 7.7}}};
    judgeEmpty(input, input.scene(countScene("P04", positionsOf(empty), lines())), lines(),
               "a line without length has no area");
}

WindowLines star(double x, double y, double radius) {
    WindowLines result;
    for (int i = 0; i < 13; ++i) {
        const double angle = 6.283185307179586 * (i + 0.25) / 13;
        const auto at = [&](double r) {
            return WindowPoint{std::nearbyint((x + r * std::cos(angle)) * 256) / 256,
                               std::nearbyint((y + r * std::sin(angle)) * 256) / 256};
        };
        result.push_back({at(6), at(radius)});
    }
    return result;
}

void p05(CaseInput& input) {
    for (const double width : {1.0, 1.5, 7.5}) {
        const WindowLines list = star(31.8, 32.2, 28);
        CountOptions options = lines();
        options.lineWidth = static_cast<float>(width);
        judgeLines(input, input.scene(countScene("P05", positionsOf(list), options)), list, width);
    }
    // Off the grid, and along rows and columns of centres.
    const WindowLines along{
        {{3.5, 9.5}, {33.5, 9.5}}, {{40.5, 3.5}, {40.5, 44.5}}, {{5.003, 20.007}, {61.01, 22.2}}, {{8, 60}, {50, 50}}};
    judgeLines(input, input.scene(countScene("P05_along", positionsOf(along), lines())), along, 1);
}

// f at the ends of lines in perspective: along the segment, (1-t) fa/wa + t fb/wb over (1-t)/wa + t/wb.
void p08(CaseInput& input) {
    struct End {
        WindowPoint p;
        float w, f;
    };
    const std::vector<std::array<End, 2>> list{{End{{4.25, 6}, 1, 0}, End{{60, 18.5}, 4, 1}},
                                               {End{{10, 60}, 3, 0.25f}, End{{20.5, 25}, 0.5f, 1}},
                                               {End{{58, 60.25}, 1, 1}, End{{30, 30}, 1, 0}}};
    std::vector<ColorVertex> vertices;
    for (const auto& ends : list) {
        for (const End& e : ends) vertices.push_back({clipAt(e.p, viewportOf(kTarget), 0.5f, e.w), {e.f, 1, 0, 0}});
    }
    const size_t scene = input.scene(
        colorScene("P08", vertices, kTarget, VK_FORMAT_R32G32B32A32_SFLOAT, VK_PRIMITIVE_TOPOLOGY_LINE_LIST));
    judgePixels(input, scene, 0, kTarget, [list](const PixelReader& pixels, const Declared& declared) -> Verdict {
        const double slack = 4 * std::ldexp(1.0, -declared.subPixelBits);
        size_t seen = 0;
        Verdict worst;
        for (uint32_t y = 0; y < kTarget.height; ++y) {
            for (uint32_t x = 0; x < kTarget.width; ++x) {
                if (pixels.number(x, y, 1) != 1.0f) continue;
                ++seen;
                const double observed = pixels.number(x, y, 0);
                bool fits = false;
                for (const auto& ends : list) {
                    const End &a = ends[0], &b = ends[1];
                    const double dx = b.p.x - a.p.x, dy = b.p.y - a.p.y, length = std::hypot(dx, dy);
                    const double px = x + 0.5 - a.p.x, py = y + 0.5 - a.p.y;
                    if (std::abs(dx * py - dy * px) / length > 2) continue;
                    const auto at = [&](double t) {
                        return ((1 - t) * a.f / a.w + t * b.f / b.w) / ((1 - t) / a.w + t / b.w);
                    };
                    // The centre may lie beyond an end by half a pixel and more.
                    const double t = (px * dx + py * dy) / (length * length);
                    const auto [low, high] = std::minmax({at(std::clamp(t - slack / length, -0.05, 1.05)),
                                                          at(std::clamp(t + slack / length, -0.05, 1.05))});
                    fits = fits || (observed >= low - 1e-5 && observed <= high + 1e-5);
                }
                if (fits) continue;
                char text[96];
                std::snprintf(text, sizeof text, " is %.9g, not what lies there on any of the lines", observed);
                worst = worst.worse(Verdict::wrong(pixelText(x, y) + text));
            }
        }
        return seen < 80 ? Verdict::wrong("only " + std::to_string(seen) + " pixels are covered") : worst;
    });
}

// ---- Points ----

struct WindowDot {
    WindowPoint p;
    float size;
};

Result<Scene> pointScene(std::string_view name, const std::vector<WindowDot>& dots, const char* fragment,
                         VkFormat format, bool counting) {
    struct Vertex {
        ClipPosition position;
        float size;
    };
    SceneRecorder record(name, "Points.");
    const uint32_t target = record.colorTarget("counts", format, kTarget);
    std::vector<Vertex> vertices;
    for (const WindowDot& dot : dots) vertices.push_back({clipAt(dot.p, viewportOf(kTarget)), dot.size});
    auto pipeline = record
                        .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in float size;
void main() {
    gl_Position = position;
    gl_PointSize = size;
}
)"),
                                  record.fragment(fragment))
                        .binding(sizeof(Vertex))
                        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                        .attribute(VK_FORMAT_R32_SFLOAT, sizeof(ClipPosition))
                        .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
    if (counting) pipeline.blend(countingBlend());
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    record.output(target);
    return record.finish();
}

void judgePoints(CaseInput& input, std::string_view name, const std::vector<WindowDot>& dots) {
    const size_t scene = input.scene(pointScene(name, dots, kCountFragmentGlsl, VK_FORMAT_R8G8B8A8_UNORM, true));
    input.judge({scene}, [dots](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const Rational unit = exact::powerOfTwo(declared.subPixelBits);
        std::vector<GridSquare> shapes;
        for (const WindowDot& dot : dots) {
            // Sizes below the least one are raised to it; every implementation's least is 1.
            shapes.push_back({exact::rational(dot.p.x) * unit, exact::rational(dot.p.y) * unit,
                              exact::rational(std::max(1.0f, dot.size)) * unit});
        }
        return judgeShapes<GridSquare>(*images[0], shapes, declared.subPixelBits, exact::classifySquare, 1,
                                       exact::squareCovers, "the square of the point's size around its vertex");
    });
}

void p09(CaseInput& input) {
    judgePoints(input, "P09",
                {{{8.5, 8.5}, 1},
                 {{20, 8}, 2},
                 {{30.5, 9.5}, 3},
                 {{12.25, 30.75}, 5.5f},
                 {{40.5, 20.5}, 0.5f},
                 {{50, 10}, 0},
                 {{33, 33}, 63.875f}});
    for (const double offset : {0.0, 0.5, 0.25, 1.0 / 256, 255.0 / 256}) {
        std::vector<WindowDot> dots;
        for (int size = 1; size <= 6; ++size)
            dots.push_back({{9.0 * size + offset, 8.0 * size + offset}, static_cast<float>(size)});
        judgePoints(input, "P09_offset", dots);
    }
    // NaN: anything that does not crash.
    const size_t scene = input.scene(pointScene("P09_nan", {{{32, 32}, std::numeric_limits<float>::quiet_NaN()}},
                                                kCountFragmentGlsl, VK_FORMAT_R8G8B8A8_UNORM, true));
    input.judge({scene}, [](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        return counts ? Verdict{} : Verdict::wrong(counts.error().message);
    });
}

// PointCoord is 1/2 + (p - v) / s with the vertex where it is, not where it is snapped to.
void p10(CaseInput& input) {
    for (const double offset : {0.0, 1.0 / 256, 0.3, 0.7109375}) {
        const WindowDot dot{{32 + offset, 30 - offset}, 37.5f};
        const size_t scene = input.scene(pointScene("P10", {dot}, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PointCoord, 1.0, 1.0); }
)",
                                                    VK_FORMAT_R32G32B32A32_SFLOAT, false));
        judgePixels(input, scene, 0, kTarget, [dot](const PixelReader& pixels, const Declared& declared) -> Verdict {
            Verdict worst;
            size_t seen = 0;
            for (uint32_t y = 0; y < kTarget.height; ++y) {
                for (uint32_t x = 0; x < kTarget.width; ++x) {
                    if (pixels.number(x, y, 2) != 1.0f) continue;
                    ++seen;
                    const ClipPosition clip = clipAt(dot.p, viewportOf(kTarget));
                    const double vx = static_cast<double>(clip[0]) * 32 + 32,
                                 vy = static_cast<double>(clip[1]) * 32 + 32;
                    const double u = 0.5 + (x + 0.5 - vx) / dot.size, v = 0.5 + (y + 0.5 - vy) / dot.size;
                    const double error =
                        std::max(std::abs(pixels.number(x, y, 0) - u), std::abs(pixels.number(x, y, 1) - v));
                    if (error <= 0x1p-22) continue;
                    char text[120];
                    std::snprintf(text, sizeof text, ": PointCoord is off by %.3g, exactly (%.9g, %.9g)", error, u, v);
                    const bool legal = error <= std::ldexp(1.0, -declared.subPixelBits) / dot.size + 1e-5;
                    worst = worst.worse(Verdict::inexact(legal, pixelText(x, y) + text));
                }
            }
            return seen < 1000 ? Verdict::wrong("only " + std::to_string(seen) + " pixels are covered") : worst;
        });
    }
}

// Points whose vertices are in the view volume and whose squares leave it.
void p11(CaseInput& input) {
    judgePoints(input, "P11", {{{1.25, 2.5}, 20}, {{62.5, 32}, 31}, {{32.5, 63.75}, 24.5f}, {{0, 40}, 9}});
}

// A strip is its segments: no joins.
void p13(CaseInput& input) {
    const std::vector<WindowPoint> path{{5, 5}, {50.5, 9}, {12, 40.25}, {60, 60}, {60, 20}, {33, 33}};
    std::vector<ClipPosition> strip, list;
    for (size_t i = 0; i < path.size(); ++i) {
        strip.push_back(clipAt(path[i], viewportOf(kTarget)));
        if (i == 0) continue;
        list.push_back(strip[i - 1]);
        list.push_back(strip[i]);
    }
    for (const float width : {1.0f, 5.0f}) {
        CountOptions asList = lines(), asStrip = lines(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP);
        asList.lineWidth = asStrip.lineWidth = width;
        const size_t separate = input.scene(countScene("P13_list", list, asList));
        judgeSame(input, input.scene(countScene("P13_strip", strip, asStrip)), separate,
                  "a strip is its segments, without joins");
    }
}

constexpr std::string_view kLines = "Vulkan, Basic Line Segment Rasterization (strict lines)";
constexpr std::string_view kPoints = "Vulkan, Basic Point Rasterization";
constexpr std::string_view kBresenham = "Vulkan, Bresenham Line Segment Rasterization";

const std::vector<HardCase> kCases{
    {"P01", "Bresenham lines between centres in 8 octants, and connected ones",
     "Half-open by the diamond-exit rule, ends moved by (-e, -e^2); four conditions else.", kBresenham, p01},
    {"P02", "Bresenham lines that end on corners and edges of diamonds", "As the perturbed line.", kBresenham, p02},
    {"P03", "Bresenham lines of slope 1", "x is the major axis: one fragment per column.", kBresenham, p03},
    {"P04", "Lines without length", "No fragments.", kLines, p04},
    {"P05", "Rectangular lines of width 1, 1.5 and 7.5 in all directions",
     "The exact rectangle; corners are irrational, squares decide.", kLines, p05},
    {.id = "P06",
     .title = "Parallelograms of lines that are not strict",
     .rule = "The major axis decides.",
     .source = "Vulkan, Basic Line Segment Rasterization",
     .unreachable = "Vernier's driver, lavapipe and SwiftShader all declare strictLines: none draws such lines"},
    {"P07",
     "Smooth lines; stippled lists and strips",
     "Alpha is the part of the pixel inside, or near it; bits count fragments.",
     "Vulkan, Line Stipple; Smooth Lines",
     p07,
     {},
     {{"lavapipe", "its CI lists stippled lines that pass at times"}}},
    {"P08", "Attributes along lines in perspective", "Interpolated by the projection on the segment, in perspective.",
     kLines, p08},
    {"P09", "Points of size 0 to 63.875 and NaN, at and off centres",
     "The samples in the square; sizes below 1 are raised to 1.", kPoints, p09},
    {"P10", "PointCoord of points that are off the sub-pixel grid", "1/2 + (p - v) / s.", kPoints, p10},
    {"P11", "Large points at the border of the view volume",
     "Clipped by their vertex alone: what is inside the target is drawn.", kPoints, p11},
    {"P12",
     "Polygon mode line of triangles that the near plane and the view volume cut",
     "The triangle's own edges are drawn; edges that clipping makes may be drawn or not.",
     "Vulkan, Polygon Mode",
     p12,
     {},
     {{"lavapipe", "its CI lists failures of the facing and offset of polygons drawn as lines"}}},
    {"P13", "Strips of thin and wide lines", "The segments, without joins.", kLines, p13},
};

}  // namespace

std::span<const HardCase> lineAndPointCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
