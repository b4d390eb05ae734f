// C: clipping.
#include "conformance/hardcases/clip_distance_input.h"
#include "conformance/hardcases/geometry_stage_cases.h"
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/homogeneous_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};

// Pairs of triangles (a, b, c) and (b, a, d): the shared edge is opposite vertex 2 in both. Near, far, or the eye plane
// cuts the shared edge.
std::vector<std::vector<ClipTriangle>> clippedPairs() {
    const auto pair = [](ClipPosition a, ClipPosition b, ClipPosition c, ClipPosition d) {
        return std::vector<ClipTriangle>{{a, b, c}, {b, a, d}};
    };
    return {
        pair({-0.7f, -0.8f, -0.3f, 1}, {0.6f, 0.9f, 0.7f, 1}, {0.8f, -0.6f, 0.4f, 1}, {-0.9f, 0.5f, 0.2f, 1}),
        pair({-0.1f, 0.9f, -0.5f, 0.3f}, {0.3f, -1.5f, 1.9f, 2}, {1.7f, 0.2f, 0.9f, 1.9f}, {-1.8f, 0.1f, 0.6f, 1.9f}),
        pair({0.13f, 1.1f, -0.9f, -0.6f}, {0.4f, -3.1f, 3.5f, 4}, {3.3f, 1.2f, 2.1f, 3.7f}, {-3.6f, 1.4f, 2.6f, 3.9f}),
        pair({-0.4f, -0.9f, 0.4f, 1}, {0.35f, 0.95f, 1.6f, 1.1f}, {0.9f, -0.4f, 0.9f, 1}, {-0.8f, 0.7f, 0.3f, 1}),
    };
}

// Samples of a pair whose shared edge, and nothing else, is open count exactly one; others lie between what must and
// what may be covered.
Verdict judgePair(const std::vector<ClipTriangle>& pair, std::span<const uint32_t> counts, int subPixelBits) {
    const VkViewport viewport = viewportOf(kTarget);
    const TriangleSides first(pair[0], viewport, subPixelBits), second(pair[1], viewport, subPixelBits);
    for (uint32_t y = 0; y < kTarget.height; ++y) {
        for (uint32_t x = 0; x < kTarget.width; ++x) {
            const SampleSides a = first.at(x, y), b = second.at(x, y);
            const auto others = [](const SampleSides& s) { return std::max({s.edge[0], s.edge[1], s.clip}); };
            const bool sharedOpen = a.edge[2] == Side::open || b.edge[2] == Side::open;
            const Side inA = std::max(others(a), sharedOpen ? Side::inside : a.edge[2]);
            const Side inB = std::max(others(b), sharedOpen ? Side::inside : b.edge[2]);
            uint32_t low, high;
            if (sharedOpen && others(a) == Side::inside && others(b) == Side::inside) {
                low = high = 1;  // the cut shared edge: exactly one of the two
            } else {
                low = (inA == Side::inside && !sharedOpen) + (inB == Side::inside && !sharedOpen);
                high = (inA != Side::outside) + (inB != Side::outside);
            }
            const uint32_t count = counts[y * kTarget.width + x];
            if (count >= low && count <= high) continue;
            return Verdict::wrong(pixelText(x, y) + " is covered " + std::to_string(count) + " times, exactly " +
                                  std::to_string(low) + ".." + std::to_string(high) +
                                  (sharedOpen ? " (on the clipped shared edge)" : " (clear of the shared edge)"));
        }
    }
    return {};
}

void c02(CaseInput& input) {
    CountOptions options;
    options.extent = kTarget;
    for (const auto& pair : clippedPairs()) {
        const size_t scene = input.scene(countScene("C02", flatten(pair), options));
        input.judge({scene}, [pair](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
            const auto counts = readCounts(*images[0], kTarget);
            if (!counts) return Verdict::wrong(counts.error().message);
            return judgePair(pair, *counts, declared.subPixelBits);
        });
    }
}

CountOptions plainCount() {
    CountOptions options;
    options.extent = kTarget;
    return options;
}

// Triangles that leave the viewport on one to four sides, by less and by more than any guard band.
void c01(CaseInput& input) {
    const std::vector<WindowTriangle> triangles{
        {{{-20, 10.25}, {40, 20.5}, {30, 50}}},         {{{-20, -15}, {40, 20.5}, {30, 50}}},
        {{{-30, 20}, {90, -25.75}, {40, 60}}},          {{{-90, 20.5}, {30, -120}, {150, 150.25}}},
        {{{-6000, 20.5}, {40, 20.25}, {30, 50}}},       {{{30.5, -7000}, {7100, 33}, {10.25, 7000.5}}},
        {{{-40000, -300}, {40000, 20.5}, {-300, 500}}}, {{{-60000, -60000}, {60000, -59999}, {0.5, 60000}}},
    };
    CoverageOptions whole;
    whole.extent = kTarget;
    for (const WindowTriangle& t : triangles) addCoverage(input, "C01", {t}, whole);
    // A viewport inside the target: the clip volume ends there, though the scissor does not.
    for (const WindowTriangle& t : triangles) {
        CoverageOptions part = whole;
        part.viewport = VkViewport{16, 8, 32, 32, 0, 1};
        part.visible = VkRect2D{{16, 8}, {32, 32}};
        addCoverage(input, "C01_viewport", {t}, part);
    }
}

WindowTriangles halvedTriangles() {
    WindowTriangles triangles = jitteredTiling(5, 12.5, 3.7, 256, 33);
    triangles.push_back({{{-5, -9}, {90, 3}, {20, 100}}});
    return triangles;
}

// Full-target and small triangles with a clip distance that is `sign` times a function of the place.
std::vector<DistanceVertex> halved(float sign, double angle) {
    std::vector<DistanceVertex> vertices;
    const WindowTriangles triangles = halvedTriangles();
    for (size_t i = 0; i < triangles.size(); ++i) {
        for (const WindowPoint& p : triangles[i]) {
            // Two copies: flat ones and ones in perspective; the distance is linear in clip space.
            const float w = i % 2 == 0 ? 1.0f : 0.75f + static_cast<float>(p.x) / 64;
            const double d = std::cos(angle) * (p.x - 31.37) + std::sin(angle) * (p.y - 29.71);
            const auto distance = static_cast<float>(d) * w * sign;
            vertices.push_back({clipAt(p, viewportOf(kTarget), 0.5f, w), {distance, 0, 0, 0, 0, 0, 0, 0}});
        }
    }
    return vertices;
}

// Whether a sample is so near to an edge of a triangle that the vertices of its pieces, snapped, may decide.
bool nearOutline(const std::vector<exact::GridTriangle>& triangles, const exact::GridPoint& p) {
    return std::ranges::any_of(
        triangles, [&p](const exact::GridTriangle& t) { return exact::classify(t, p) == exact::Coverage::may; });
}

Verdict judgeComplement(std::span<const Drawn* const> images, const std::vector<WindowTriangle>& triangles, int bits) {
    std::array<std::vector<uint32_t>, 3> counts;
    for (size_t i = 0; i < 3; ++i) {
        auto read = readCounts(*images[i], kTarget);
        if (!read) return Verdict::wrong(read.error().message);
        counts[i] = std::move(read).value();
    }
    const std::vector<exact::GridTriangle> grid = snapped(triangles, bits);
    const int64_t half = int64_t{1} << (bits - 1);
    for (uint32_t i = 0; i < counts[0].size(); ++i) {
        if (counts[0][i] + counts[1][i] == counts[2][i]) continue;
        const int64_t x = i % kTarget.width, y = i / kTarget.width;
        if (nearOutline(grid, {2 * half * x + half, 2 * half * y + half})) continue;
        return Verdict::wrong(pixelText(i % kTarget.width, i / kTarget.width) + " is covered " +
                              std::to_string(counts[0][i]) + " times with the distance and " +
                              std::to_string(counts[1][i]) + " times with its negation, exactly " +
                              std::to_string(counts[2][i]) + " together");
    }
    return {};
}

void c03(CaseInput& input) {
    for (const double angle : {0.0, 0.3, 1.1, 1.5708, 2.6}) {
        const std::vector<DistanceVertex> inside = halved(1, angle), outside = halved(-1, angle);
        const size_t plus = input.scene(distanceScene("C03", inside, DistanceKind::clip, 1, kTarget));
        const size_t minus = input.scene(distanceScene("C03_negated", outside, DistanceKind::clip, 1, kTarget));
        std::vector<ClipPosition> positions;
        for (const DistanceVertex& v : inside) positions.push_back(v.position);
        const size_t whole = input.scene(countScene("C03_whole", positions, plainCount()));
        input.judge({plus, minus, whole}, [](std::span<const Drawn* const> images, const Declared& declared) {
            return judgeComplement(images, halvedTriangles(), declared.subPixelBits);
        });
    }
}

const WindowTriangle kPlainTriangle{{{3.25, 5}, {60, 11.5}, {22, 61.75}}};

std::vector<DistanceVertex> withDistances(const std::array<float, 3>& distances) {
    std::vector<DistanceVertex> vertices;
    for (size_t i = 0; i < 3; ++i) {
        vertices.push_back({clipAt(kPlainTriangle[i], viewportOf(kTarget)), {distances[i], 0, 0, 0, 0, 0, 0, 0}});
    }
    return vertices;
}

CoverageOptions plainTriangleOptions() {
    CoverageOptions options;
    options.extent = kTarget;
    return options;
}

void wholeTriangle(CaseInput& input, std::string_view name, DistanceKind kind, const std::array<float, 3>& distances) {
    const size_t scene = input.scene(distanceScene(name, withDistances(distances), kind, 1, kTarget));
    judgeCoverage(input, scene, {kPlainTriangle}, plainTriangleOptions());
}

void nothing(CaseInput& input, std::string_view name, DistanceKind kind, const std::array<float, 3>& distances,
             std::string why) {
    const size_t scene = input.scene(distanceScene(name, withDistances(distances), kind, 1, kTarget));
    judgeEmpty(input, scene, plainCount(), std::move(why));
}

// Anything, but only inside the triangle; `exactly`, when given, is how often the triangle should be drawn.
void someOfTriangle(CaseInput& input, std::string_view name, DistanceKind kind, const std::array<float, 3>& distances,
                    std::optional<uint32_t> exactly = std::nullopt) {
    const size_t scene = input.scene(distanceScene(name, withDistances(distances), kind, 1, kTarget));
    input.judge({scene}, [exactly](std::span<const Drawn* const> images, const Declared& declared) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        if (!counts) return Verdict::wrong(counts.error().message);
        const exact::GridTriangle grid = snapped({kPlainTriangle}, declared.subPixelBits)[0];
        const int64_t half = int64_t{1} << (declared.subPixelBits - 1);
        Verdict worst;
        for (uint32_t i = 0; i < counts->size(); ++i) {
            const int64_t x = i % kTarget.width, y = i / kTarget.width;
            const exact::GridPoint p{2 * half * x + half, 2 * half * y + half};
            const std::string where = pixelText(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            if ((*counts)[i] > (exact::classify(grid, p) == exact::Coverage::mustNot ? 0u : 1u))
                return Verdict::wrong(where + " is drawn outside the triangle");
            if (exactly && (*counts)[i] != (exact::covers(grid, p) ? *exactly : 0)) {
                worst = worst.worse(Verdict::allowed(where + " is covered " + std::to_string((*counts)[i]) +
                                                     " times; infinities need not be kept"));
            }
        }
        return worst;
    });
}

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

void c04(CaseInput& input) {
    for (const float zero : {0.0f, -0.0f}) {
        wholeTriangle(input, "C04_all", DistanceKind::clip, {zero, zero, zero});
        wholeTriangle(input, "C04_edge", DistanceKind::clip, {zero, zero, 1});
        wholeTriangle(input, "C04_vertex", DistanceKind::clip, {zero, 2, 1});
        someOfTriangle(input, "C04_outside", DistanceKind::clip, {zero, -1, -2});
    }
}

void c05(CaseInput& input) {
    someOfTriangle(input, "C05_in", DistanceKind::clip, {kInf, kInf, kInf}, 1);
    someOfTriangle(input, "C05_out", DistanceKind::clip, {-kInf, -kInf, -kInf}, 0);
    for (const std::array<float, 3> distances : {std::array{kInf, 1.0f, -1.0f},
                                                 {kInf, -kInf, 1.0f},
                                                 {kNan, 1.0f, 1.0f},
                                                 {kNan, -1.0f, kInf},
                                                 {kNan, kNan, kNan}})
        someOfTriangle(input, "C05_mixed", DistanceKind::clip, distances);
}

void c06(CaseInput& input) {
    nothing(input, "C06_all", DistanceKind::cull, {-1, -0.001f, -kInf}, "all cull distances are negative");
    wholeTriangle(input, "C06_mixed", DistanceKind::cull, {-1, -2, 0.001f});
    wholeTriangle(input, "C06_zero", DistanceKind::cull, {-1, -2, 0});
    wholeTriangle(input, "C06_minus_zero", DistanceKind::cull, {-1, -2, -0.0f});
    someOfTriangle(input, "C06_nan", DistanceKind::cull, {kNan, -1, -1});
}

// The same triangle at one depth.
Result<Scene> atDepth(std::string_view name, float z, float w, bool clamp) {
    std::vector<ClipPosition> positions;
    for (const WindowPoint& p : kPlainTriangle) {
        ClipPosition clip = clipAt(p, viewportOf(kTarget), 0, w);
        clip[2] = z;
        positions.push_back(clip);
    }
    CountOptions options = plainCount();
    options.depthClamp = clamp;
    return countScene(name, positions, options);
}

void c07(CaseInput& input) {
    for (const float w : {1.0f, 4.0f}) {
        for (const float z : {0.0f, -0.0f, w, 0x1p-149f, std::nextafter(w, 0.0f)}) {
            judgeCoverage(input, input.scene(atDepth("C07_inside", z, w, false)), {kPlainTriangle},
                          plainTriangleOptions());
        }
        for (const float z : {-0x1p-126f, -0.001f, std::nextafter(w, 8.0f)}) {
            judgeEmpty(input, input.scene(atDepth("C07_outside", z, w, false)), plainCount(),
                       "z is outside [0, w] by an ULP or more");
            judgeCoverage(input, input.scene(atDepth("C07_clamped", z, w, true)), {kPlainTriangle},
                          plainTriangleOptions());
        }
    }
}

// A slope through near and far with depth written, with clipping or clamping, under a narrowed depth range.
void c08(CaseInput& input) {
    for (const bool clamp : {false, true}) {
        for (const auto& [nearest, farthest] : {std::pair{0.0f, 1.0f}, {0.25f, 0.75f}, {0.75f, 0.25f}}) {
            SceneRecorder record("C08", "Depth through near and far.");
            const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kTarget);
            const std::vector<ClipPosition> data{
                {-0.9f, -0.8f, -0.7f, 1}, {0.95f, -0.6f, 0.6f, 1}, {0.1f, 0.9f, 1.9f, 1}};
            const uint32_t vertices = record.vertexBuffer("vertices", data);
            auto pipeline = record.pipeline(record.vertex(kPositionVertexGlsl), kNone)
                                .binding(sizeof(ClipPosition))
                                .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                .depth(VK_COMPARE_OP_ALWAYS);
            if (clamp) pipeline.depthClamp();
            record.pass(kTarget).depthStencil(depth, 0.5f);
            record.draw(pipeline, 3).vertices(vertices).viewport(0, 0, 64, 64, nearest, farthest);
            record.output(depth);
            addForOracle(input, record.finish());
        }
    }
}

// All six planes of the view volume and eight clip distances cut one triangle.
void c09(CaseInput& input) {
    std::vector<DistanceVertex> vertices;
    const std::array<ClipPosition, 3> corners{
        {{-3.1f, -2.3f, -0.4f, 1}, {2.9f, -1.7f, 1.2f, 1}, {0.2f, 3.3f, 0.6f, 1}}};
    for (const ClipPosition& p : corners) {
        DistanceVertex v{p, {}};
        for (size_t i = 0; i < 8; ++i) {
            const double angle = 0.3 + static_cast<double>(i) * 0.7853981633974483;
            v.distance[i] = static_cast<float>(0.83 - std::cos(angle) * p[0] - std::sin(angle) * p[1]);
        }
        vertices.push_back(v);
    }
    addForOracle(input, distanceScene("C09", vertices, DistanceKind::clip, 8, kTarget));
}

// Smooth and noperspective colours over triangles that near and far cut.
void c10(CaseInput& input) {
    const std::vector<ColorVertex> vertices{
        {{-0.7f, -0.8f, -0.6f, 0.5f}, {1, 0, 0.25f, 1}}, {{1.6f, -1.9f, 1.3f, 2}, {0, 1, 0.5f, 1}},
        {{-0.3f, 2.7f, 2.0f, 3}, {0.25f, 0.5f, 1, 1}},   {{0.9f, 0.95f, 0.9f, 1}, {1, 1, 0, 1}},
        {{0.2f, 0.97f, -0.2f, 1}, {0, 1, 1, 1}},         {{2.9f, -0.3f, 4, 3.5f}, {1, 0, 1, 0.5f}},
    };
    addForOracle(input, interpolationScene("C10", vertices, kTarget));
}

// One clip distance in perspective: the cut is a line on the screen.
void c12(CaseInput& input) {
    for (const double angle : {0.2, 1.9}) {
        std::vector<DistanceVertex> vertices;
        const std::array<ClipPosition, 3> corners{
            {{-0.9f, -0.8f, 0.4f, 1}, {2.7f, -1.7f, 1.2f, 3}, {0.2f, 1.8f, 0.6f, 2}}};
        for (const ClipPosition& p : corners) {
            DistanceVertex v{p, {}};
            v.distance[0] = static_cast<float>(std::cos(angle) * p[0] + std::sin(angle) * p[1] + 0.17 * p[3] - 0.2);
            vertices.push_back(v);
        }
        addForOracle(input, distanceScene("C12", vertices, DistanceKind::clip, 1, kTarget));
    }
}

// Points of one pixel and lines around the view volume: a point outside is gone, a line is cut.
void c11(CaseInput& input) {
    const std::vector<WindowPoint> outside{{-0.75, 20}, {64.5, 30}, {20, -0.25}, {33, 65}};
    std::vector<ClipPosition> positions;
    for (const WindowPoint& p : outside) positions.push_back(clipAt(p, viewportOf(kTarget)));
    positions.push_back({0, 0, -0.01f, 1});
    positions.push_back({0, 0, 1.01f, 1});
    positions.push_back({0, 0, 0.5f, -1});
    CountOptions points = plainCount();
    points.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    judgeEmpty(input, input.scene(countScene("C11_points", positions, points)), points,
               "a point is clipped by its vertex");
    const std::vector<ClipPosition> behind{
        {-0.5f, -0.5f, -0.5f, 1}, {0.5f, 0.5f, -0.1f, 1}, {-3, 0, 0.5f, 1}, {-1.5f, 0.5f, 0.5f, 1}};
    CountOptions lines = plainCount();
    lines.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    judgeEmpty(input, input.scene(countScene("C11_lines", behind, lines)), lines,
               "the lines are outside the view volume");
}

constexpr std::string_view kClipping = "Vulkan, Primitive Clipping";

const std::vector<HardCase> kCases{
    {"C01", "Triangles that leave the viewport on one to four sides, by up to 60000 pixels",
     "Clipping at the sides is invisible: the unclipped coverage inside the viewport, nothing outside.", kClipping,
     c01},
    {"C02", "Triangles sharing an edge that near, far or the eye plane cuts",
     "The new vertex on the shared edge is the same from both sides: a partition across the clip.", kClipping, c02},
    {"C03", "A clip distance and its negation", "Complementarity: no pixel is missing, none is drawn twice where cut.",
     "Vulkan, Primitive Clipping: complementarity criterion", c03},
    {"C04", "Clip distances that are exactly 0 and -0", "Points with a distance of at least 0 are inside.", kClipping,
     c04},
    {"C05", "Clip distances that are infinite or NaN",
     "Infinite: wholly in or out, where infinities are kept. NaN: anything, but nothing outside the triangle.",
     "Vulkan, Primitive Clipping; Floating-Point Computation", c05},
    {"C06", "Cull distances: all negative, mixed, zero, NaN", "Discarded only if negative at all vertices.",
     "Vulkan, Primitive Culling", c06},
    {"C07", "z at 0, at w, and an ULP outside", "z in [0, w] is inside, planes included; with clamping all is drawn.",
     kClipping, c07},
    {"C08", "Depth through near and far, clipped and clamped, in narrowed and reversed depth ranges",
     "Clamped depths lie within the viewport's range; clipped fragments are gone.",
     "Vulkan, Depth Clamping; Controlling the Viewport", c08},
    {"C09",
     "A triangle cut by six planes of the view volume and eight clip distances",
     "The half-spaces' intersection; no more than a sub-unit off.",
     kClipping,
     c09,
     {},
     {{"swiftshader", "has room for 16 edges of a clipped polygon: an overrun"}}},
    {"C10", "Smooth and noperspective attributes of clipped triangles",
     "What is left has the values that the unclipped triangle has there.", "Vulkan, Clipping Shader Outputs", c10},
    {"C11", "Points and lines whose vertices are outside the view volume",
     "A point is clipped by its vertex; a line by the view volume.", kClipping, c11},
    {"C12", "A clip distance in perspective, against the rational line", "The cut is within a sub-unit of c(P) = 0.",
     kClipping, c12},
    {"C13", "Triangles through near plane and eye, handed on by a geometry shader",
     "What is left has the unclipped triangle's values. Declared: the same bits as without the shader.",
     "Vulkan, Primitive Clipping; Vernier: same bits", c13},
};

}  // namespace

std::span<const HardCase> clippingCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
