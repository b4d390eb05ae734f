#include "conformance/hardcases/tessellation_cases.h"

#include "conformance/hardcases/coverage_input.h"
#include "conformance/hardcases/judges.h"
#include "conformance/scenes/recorder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr VkExtent2D kTarget{64, 64};
constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

/// A vertex of a patch; the levels of the patch are those of its first vertex.
struct PatchVertex {
    ClipPosition position;
    std::array<float, 4> outer;
    std::array<float, 4> inner;  // the first two
};

const char* const kPatchVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 outer;
layout(location = 2) in vec4 inner;
layout(location = 0) out vec4 vOuter;
layout(location = 1) out vec4 vInner;
void main() {
    gl_Position = position;
    vOuter = outer;
    vInner = inner;
}
)";

std::string controlGlsl(uint32_t vertices) {
    return "#version 450\nlayout(vertices = " + std::to_string(vertices) + R"() out;
layout(location = 0) in vec4 vOuter[];
layout(location = 1) in vec4 vInner[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = vOuter[0][i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = vInner[0][i];
}
)";
}

/// The place in a quad or a triangle, whose edges do not depend on which patch they are seen from; then `bend`.
std::string evaluationGlsl(uint32_t vertices, const std::string& spacing, const std::string& bend) {
    const bool quad = vertices == 4;
    return std::string("#version 450\nlayout(") + (quad ? "quads, " : "triangles, ") + spacing + R"(, ccw) in;
void main() {
    precise vec4 p;
)" +
           (quad ? R"(    float u = gl_TessCoord.x, v = gl_TessCoord.y;
    precise vec4 top = gl_in[0].gl_Position * (1.0 - u) + gl_in[1].gl_Position * u;
    precise vec4 bottom = gl_in[2].gl_Position * (1.0 - u) + gl_in[3].gl_Position * u;
    p = top * (1.0 - v) + bottom * v;
)"
                 : R"(    p = (gl_in[0].gl_Position * gl_TessCoord.x + gl_in[1].gl_Position * gl_TessCoord.y) +
        gl_in[2].gl_Position * gl_TessCoord.z;
)") + bend +
           "    gl_Position = p;\n}\n";
}

Result<Scene> patchScene(std::string_view name, const std::vector<PatchVertex>& vertices, uint32_t perPatch,
                         const std::string& evaluation) {
    SceneRecorder record(name, "Patches, counted.");
    const uint32_t target = record.colorTarget("counts", VK_FORMAT_R8G8B8A8_UNORM, kTarget);
    PipelineRecorder pipeline =
        record.pipeline(record.vertex(kPatchVertexGlsl), record.fragment(kCountFragmentGlsl))
            .binding(sizeof(PatchVertex))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
            .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 2 * sizeof(ClipPosition))
            .patches(perPatch, record.control(controlGlsl(perPatch)), record.evaluation(evaluation))
            .blend(countingBlend());
    record.pass(kTarget).color(target, {0, 0, 0, 0});
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("patches", vertices));
    record.output(target);
    return record.finish();
}

// ---- E22: edges that patches share ----

/// Every pixel is covered once.
void judgeSheet(CaseInput& input, size_t scene, std::string law) {
    input.judge({scene}, [law](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        if (!counts) return Verdict::wrong(counts.error().message);
        for (uint32_t i = 0; i < kTarget.width * kTarget.height; ++i) {
            if ((*counts)[i] == 1) continue;
            return Verdict::wrong(pixelText(i % kTarget.width, i / kTarget.width) + " is covered " +
                                  std::to_string((*counts)[i]) + " times, exactly 1; " + law);
        }
        return {};
    });
}

// Waves along the edges that are shared, a function of the place alone and less than the distance to the vertices
// within: where the two sides of an edge have different vertices, the target shows through or is covered twice.
const std::string kQuadWaves = R"(    precise float wave = 0.04 * abs(fract(p.y * 5.0) - 0.5);
    if (u == 0.0 || u == 1.0) p.x += wave;
)";
const std::string kTriangleWaves =
    R"(    precise float x = 0.02 * abs(fract(p.y * 5.0) - 0.5), y = 0.02 * abs(fract(p.x * 4.0) - 0.5);
    if (gl_TessCoord.y == 0.0 || gl_TessCoord.z == 0.0) p.xy += vec2(x, y);
)";

/// Inner levels without shorter segments for waves; others for straight edges, but none whose first segment vanishes:
/// vertices next to an edge can be snapped across it.
std::array<float, 4> innerLevels(const std::string& spacing, uint32_t patch, bool waves) {
    const float whole = (spacing == "fractional_even_spacing" ? 4.0f : 3.0f) + 2 * static_cast<float>(patch);
    const float less = waves ? 0 : 0.6f;
    return {whole - less, whole + 4 - less, 0, 0};
}

/// Two quads side by side, beyond the target on all sides. `turned`: the right one is, by half a turn, so that the edge
/// between them runs backwards and is another one of it.
std::vector<PatchVertex> twoQuads(const std::string& spacing, float shared, bool turned, bool waves) {
    // Outer levels: u = 0, v = 0, u = 1, v = 1.
    const std::array<float, 4> left{3, 2, shared, 5};
    const std::array<float, 4> right =
        turned ? std::array<float, 4>{4, 6, shared, 1} : std::array<float, 4>{shared, 1, 4, 6};
    const ClipPosition top{0.13f, -1.4f, 0.5f, 1}, bottom{-0.21f, 1.4f, 0.5f, 1};
    std::array<ClipPosition, 4> corners{{top, {1.4f, -1.4f, 0.5f, 1}, bottom, {1.4f, 1.4f, 0.5f, 1}}};
    if (turned) std::ranges::reverse(corners);
    std::vector<PatchVertex> vertices;
    for (const ClipPosition& p : {ClipPosition{-1.4f, -1.4f, 0.5f, 1}, top, {-1.4f, 1.4f, 0.5f, 1}, bottom})
        vertices.push_back({p, left, innerLevels(spacing, 0, waves)});
    for (const ClipPosition& p : corners) vertices.push_back({p, right, innerLevels(spacing, 1, waves)});
    return vertices;
}

/// Five triangles around a place, their outer edges beyond the target: every shared edge is v = 0 of one and w = 0 of
/// the next one.
std::vector<PatchVertex> aroundAPlace(const std::string& spacing, const std::vector<float>& levels, bool waves) {
    constexpr uint32_t kSides = 5;
    const ClipPosition hub{0.11f, -0.07f, 0.5f, 1};
    std::array<ClipPosition, kSides> rim{};
    for (uint32_t i = 0; i < kSides; ++i) {
        const double angle = 1.3 + i * 2 * 3.14159265358979 / kSides;
        rim[i] = {static_cast<float>(3.2 * std::cos(angle)), static_cast<float>(3.2 * std::sin(angle)), 0.5f, 1};
    }
    std::vector<PatchVertex> vertices;
    for (uint32_t i = 0; i < kSides; ++i) {
        const uint32_t next = (i + 1) % kSides;
        // Outer levels: u = 0, v = 0, w = 0, opposite the first, second and third vertex.
        const std::array<float, 4> outer{2.0f + static_cast<float>(i), levels[next], levels[i], 0};
        for (const ClipPosition& p : {hub, rim[i], rim[next]})
            vertices.push_back({p, outer, innerLevels(spacing, i, waves)});
    }
    return vertices;
}

// ---- V19: the points of one edge ----

constexpr uint32_t kWide = 4096;
constexpr float kLevels[] = {0.5f, 1,          1.0000001f, 1.5f,       1.9999998f, 2,          2.0000002f, 2.75f,
                             3,    3.0000002f, 5,          3.9999998f, 4,          4.9999995f, 33,         61.999996f,
                             62,   62.000004f, 62.5f,      63,         63.999996f, 64,         65,         kInf};
constexpr uint32_t kLevelCount = std::size(kLevels);

/// The points of a line of isolines in a row of the target, at their places: red the largest coordinate, green what the
/// smallest one lacks to 1, which is exact, alpha their number.
Result<Scene> edgeScene(const std::string& spacing) {
    SceneRecorder record("V19", "The points of isolines.");
    constexpr VkExtent2D kExtent{kWide, kLevelCount};
    const uint32_t target = record.colorTarget("points", VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
    const std::string evaluation = "#version 450\nlayout(isolines, " + spacing + R"(, point_mode) in;
layout(location = 0) out float vU;
void main() {
    float u = gl_TessCoord.x;
    vec2 pixel = vec2(floor(u * 4095.0 + 0.5), float(gl_PrimitiveID)) + 0.5;
    gl_Position = vec4(pixel / vec2(2048.0, )" +
                                   std::to_string(kLevelCount / 2) + R"(.0) - 1.0, 0.5, 1.0);
    gl_PointSize = 1.0;
    vU = u;
}
)";
    std::vector<PatchVertex> vertices;
    for (const float level : kLevels) vertices.push_back({{}, {1, level, 0, 0}, {}});
    VkPipelineColorBlendAttachmentState blend = countingBlend();
    blend.colorBlendOp = VK_BLEND_OP_MAX;
    PipelineRecorder pipeline = record
                                    .pipeline(record.vertex(kPatchVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) in float vU;
layout(location = 0) out vec4 color;
void main() { color = vec4(vU, 1.0 - vU, 0.0, 1.0); }
)"))
                                    .binding(sizeof(PatchVertex))
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, sizeof(ClipPosition))
                                    .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 2 * sizeof(ClipPosition))
                                    .patches(1, record.control(controlGlsl(1)), record.evaluation(evaluation))
                                    .blend(blend);
    record.pass(kExtent).color(target, {0, 0, 0, 0});
    record.draw(pipeline, kLevelCount).vertices(record.vertexBuffer("patches", vertices));
    record.output(target);
    return record.finish();
}

enum class Spacing : uint8_t { equal, odd, even };

/// The clamped level f and the number of segments n (Vulkan, Tessellator Spacing; maxTessellationGenerationLevel is 64
/// for all).
struct Segments {
    double level;
    uint32_t count;
};
Segments segmentsOf(Spacing spacing, float level) {
    const double least = spacing == Spacing::even ? 2 : 1, most = spacing == Spacing::odd ? 63 : 64;
    const double f = std::clamp(static_cast<double>(level), least, most);
    auto n = static_cast<uint32_t>(std::ceil(f));
    if (spacing != Spacing::equal && n % 2 != (spacing == Spacing::odd ? 1u : 0u)) ++n;
    return {f, n};
}

/// The segments of a level so near, by what operations outside of shaders may be off (Vulkan, Floating-Point
/// Computation: about 1 part in 10^5), that there are so many points; otherwise those of the level itself.
Segments nearestSegments(Spacing spacing, float level, size_t points) {
    const Segments exactly = segmentsOf(spacing, level);
    for (const float factor : {1.0f, 0.99999f, 1.00001f}) {
        const Segments near = segmentsOf(spacing, level * factor);
        if (near.count + 1 == points) return near;
    }
    return exactly;
}

/// Coordinates of one row, from 0 to 1, as often as they occur. Of three at one pixel the one between is taken for the
/// middle.
std::vector<double> pointsOf(const PixelReader& pixels, uint32_t row) {
    std::vector<double> points;
    for (uint32_t x = 0; x < kWide; ++x) {
        const auto times = static_cast<uint32_t>(pixels.number(x, row, 3));
        if (times == 0) continue;
        const double most = pixels.number(x, row, 0), least = 1 - static_cast<double>(pixels.number(x, row, 1));
        points.push_back(least);
        if (times > 2) points.insert(points.end(), times - 2, (least + most) / 2);
        if (times > 1) points.push_back(most);
    }
    return points;
}

/// What is asked of one edge; `shorter` becomes the length of the two segments of their own, against the others.
Verdict judgeEdge(const std::vector<double>& points, Spacing spacing, const Segments& segments, double& shorter) {
    const uint32_t n = segments.count;
    if (points.size() != n + 1) {
        return Verdict::wrong("has " + std::to_string(points.size()) + " points, exactly " + std::to_string(n + 1));
    }
    if (points.front() != 0 || points.back() != 1) return Verdict::wrong("does not reach from 0 to 1");
    std::vector<double> lengths;
    double lopsided = 0;
    for (uint32_t i = 0; i < n; ++i) {
        lopsided = std::max(lopsided, std::abs(points[i] - (1 - points[n - i])));
        lengths.push_back(points[i + 1] - points[i]);
    }
    std::ranges::sort(lengths);
    const bool fractional = spacing != Spacing::equal && n > 2 && segments.level < n;
    const uint32_t own = fractional ? 2 : 0;
    // No precision is stated. Vernier's coordinates are the nearest in steps of 2^-24; those of a tessellator after
    // Direct3D 11 are sums of up to 64 lengths in steps of 2^-16.
    const double spread = std::max(lengths.back() - lengths[own], fractional ? lengths[1] - lengths[0] : 0.0);
    shorter = fractional ? lengths[0] / lengths.back() : 1;
    char text[160];
    std::snprintf(text, sizeof text, "has segments of %.9g, %.9g to %.9g, its halves differ by %.3g", lengths[0],
                  lengths[own], lengths.back(), lopsided);
    if (lopsided > 0x1p-11 || spread > 0x1p-11) return Verdict::wrong(text);
    return lopsided == 0 && spread <= 0x1p-22 ? Verdict{} : Verdict::allowed(text);
}

void judgeEdges(CaseInput& input, size_t scene, Spacing spacing) {
    judgePixels(input, scene, 0, {kWide, kLevelCount},
                [spacing](const PixelReader& pixels, const Declared&) -> Verdict {
                    Verdict worst;
                    struct Seen {
                        Segments segments;
                        double shorter;
                    };
                    std::vector<Seen> all;
                    for (uint32_t row = 0; row < kLevelCount; ++row) {
                        const std::vector<double> points = pointsOf(pixels, row);
                        const Segments segments = nearestSegments(spacing, kLevels[row], points.size());
                        double shorter = 1;
                        Verdict verdict = judgeEdge(points, spacing, segments, shorter);
                        if (segments.count != segmentsOf(spacing, kLevels[row]).count)
                            verdict = verdict.worse(Verdict::allowed("is that of a level one part in 10^5 away"));
                        verdict.witness = "an edge of level " + std::to_string(kLevels[row]) + " " + verdict.witness;
                        worst = worst.worse(verdict);
                        all.push_back({segments, shorter});
                    }
                    if (worst.outcome == Outcome::wrong) return worst;
                    for (const Seen& a : all) {
                        for (const Seen& b : all) {
                            if (a.segments.count == b.segments.count && a.segments.level < b.segments.level &&
                                a.shorter > b.shorter + 0x1p-5) {
                                return Verdict::wrong("the shorter segments grow from level " +
                                                      std::to_string(b.segments.level) + " down to " +
                                                      std::to_string(a.segments.level));
                            }
                        }
                        const double missing = a.segments.count - a.segments.level;
                        if (spacing != Spacing::equal && a.segments.count > 2 && missing > 1.999 && a.shorter > 0.01)
                            return Verdict::wrong("at level " + std::to_string(a.segments.level) +
                                                  " the shorter segments are not near 0");
                    }
                    return worst;
                });
}

// ---- N09: levels that cull ----

/// What becomes of a patch.
enum class Fate : uint8_t { drawn, culled, either };

struct LevelRow {
    std::array<float, 4> outer;
    std::array<float, 4> inner;
    Fate fate;
};

/// One patch in a cell of 8 x 8 pixels for each row.
void addLevels(CaseInput& input, uint32_t perPatch, const std::vector<LevelRow>& rows) {
    std::vector<PatchVertex> vertices;
    for (uint32_t i = 0; i < rows.size(); ++i) {
        const double x = i % 8 * 8, y = i / 8 * 8;
        const std::array<WindowPoint, 4> corners{{{x, y}, {x + 8, y}, {x, y + 8}, {x + 8, y + 8}}};
        for (uint32_t k = 0; k < perPatch; ++k)
            vertices.push_back({clipAt(corners[k], viewportOf(kTarget)), rows[i].outer, rows[i].inner});
    }
    const size_t scene =
        input.scene(patchScene("N09", vertices, perPatch, evaluationGlsl(perPatch, "equal_spacing", "")));
    input.judge({scene}, [rows](std::span<const Drawn* const> images, const Declared&) -> Verdict {
        const auto counts = readCounts(*images[0], kTarget);
        if (!counts) return Verdict::wrong(counts.error().message);
        Verdict worst;
        for (uint32_t i = 0; i < 64; ++i) {
            const uint32_t x = i % 8 * 8 + 2, y = i / 8 * 8 + 2, seen = (*counts)[y * kTarget.width + x];
            const Fate fate = i < rows.size() ? rows[i].fate : Fate::culled;
            if (seen == (fate == Fate::culled ? 0u : 1u)) continue;
            const std::string text =
                pixelText(x, y) + ", patch " + std::to_string(i) + " is covered " + std::to_string(seen) + " times";
            worst = worst.worse(Verdict::inexact(fate == Fate::either && seen == 0, text));
        }
        return worst;
    });
}

}  // namespace

void e22(CaseInput& input) {
    const std::vector<float> whole{1, 2, 3, 4, 5}, between{1.5f, 2.0000002f, 63.999996f, 3.3f, 17.7f};
    for (const std::string spacing : {"equal_spacing", "fractional_odd_spacing", "fractional_even_spacing"}) {
        for (const bool waves : {false, true}) {
            for (const float level : {1.0f, 1.9999998f, 2.3f, 7.0000005f, 31.4f, 64.0f}) {
                for (const bool turned : {false, true}) {
                    const size_t quads = input.scene(patchScene("E22_quads", twoQuads(spacing, level, turned, waves), 4,
                                                                evaluationGlsl(4, spacing, waves ? kQuadWaves : "")));
                    judgeSheet(
                        input, quads,
                        spacing + ", level " + std::to_string(level) + (turned ? ", of a patch that is turned" : ""));
                }
            }
            for (const std::vector<float>& levels : {whole, between}) {
                const size_t triangles =
                    input.scene(patchScene("E22_triangles", aroundAPlace(spacing, levels, waves), 3,
                                           evaluationGlsl(3, spacing, waves ? kTriangleWaves : "")));
                judgeSheet(input, triangles, spacing + ", triangles around a place");
            }
        }
    }
}

void v19(CaseInput& input) {
    judgeEdges(input, input.scene(edgeScene("equal_spacing")), Spacing::equal);
    judgeEdges(input, input.scene(edgeScene("fractional_odd_spacing")), Spacing::odd);
    judgeEdges(input, input.scene(edgeScene("fractional_even_spacing")), Spacing::even);
}

void n09(CaseInput& input) {
    constexpr std::array<float, 4> kOnes{1, 1, 1, 1};
    for (const uint32_t perPatch : {4u, 3u}) {
        std::vector<LevelRow> rows{{kOnes, kOnes, Fate::drawn}};
        // Outer levels that count, and one that does not.
        for (size_t edge = 0; edge < 4; ++edge) {
            const Fate culled = edge < perPatch ? Fate::culled : Fate::drawn;
            for (const auto& [level, fate] : {std::pair{kNan, culled},
                                              {0.0f, culled},
                                              {-0.0f, culled},
                                              {-3.0f, culled},
                                              {-kInf, culled},
                                              {-0x1p-149f, culled},
                                              {kInf, Fate::drawn},
                                              {0x1p-126f, Fate::drawn},
                                              {0x1p-149f, Fate::either}}) {
                LevelRow row{kOnes, {3, 3, 0, 0}, fate};
                row.outer[edge] = level;
                rows.push_back(row);
            }
        }
        // Inner levels cull nothing: they are clamped.
        for (size_t k = 0; k < 2; ++k) {
            for (const float level : {0.0f, -5.0f, -kInf, kInf, kNan}) {
                LevelRow row{
                    {2, 2, 2, 2}, {3, 3, 0, 0}, std::isnan(level) && k < perPatch - 2 ? Fate::either : Fate::drawn};
                row.inner[k] = level;
                rows.push_back(row);
            }
        }
        addLevels(input, perPatch, rows);
    }
}

}  // namespace vernier::conformance::hardcases
