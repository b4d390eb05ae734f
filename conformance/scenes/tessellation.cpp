// Scenes of tessellation. The specification leaves open how patches are cut into triangles, where fractional spacings
// have their shorter segments, and the order of what comes out of a patch. None of it shows here: colours are linear in
// the place on the screen; what is curved has levels that are whole in its spacing; what has fractional levels is not
// curved, or is counted.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <string>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr std::array<float, 4> kDark{0.07f, 0.08f, 0.11f, 1};
constexpr std::array<const char*, 3> kSpacings{"equal_spacing", "fractional_odd_spacing", "fractional_even_spacing"};

/// The first vertex of a patch has its levels.
struct PatchVertex {
    glm::vec2 position;
    glm::vec4 outer{1, 1, 1, 1};
    glm::vec2 inner{1, 1};
};

constexpr const char* kVertexGlsl = R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 outer;
layout(location = 2) in vec2 inner;
layout(location = 0) out vec4 vOuter;
layout(location = 1) out vec2 vInner;
void main() {
    gl_Position = vec4(position, 0.5, 1.0);
    vOuter = outer;
    vInner = inner;
}
)";
constexpr const char* kFragmentGlsl = R"(#version 450
layout(location = 0) in vec3 tint;
layout(location = 0) out vec4 color;
void main() { color = vec4(tint, 1.0); }
)";

constexpr const char* kFacingGlsl = R"(#version 450
layout(location = 0) in vec3 tint;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_FrontFacing ? tint : tint.zyx, 1.0); }
)";
/// A place in a quad that four vertices go around, from the first one along u.
constexpr const char* kBilinearGlsl = R"(mix(mix(gl_in[0].gl_Position, gl_in[1].gl_Position, t.x),
                      mix(gl_in[3].gl_Position, gl_in[2].gl_Position, t.x), t.y))";

/// As many vertices go out as come in.
std::string controlGlsl(uint32_t vertices) {
    return "#version 450\nlayout(vertices = " + std::to_string(vertices) + R"() out;
layout(location = 0) in vec4 vOuter[];
layout(location = 1) in vec2 vInner[];
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    if (gl_InvocationID != 0) return;
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = vOuter[0][i];
    for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = vInner[0][i];
}
)";
}

/// A shader that writes `tint`; the text has main().
std::string evaluationGlsl(const std::string& modes, const std::string& text) {
    return "#version 450\nlayout(" + modes + ") in;\nlayout(location = 0) out vec3 tint;\n" + text;
}

PipelineRecorder patchPipeline(SceneRecorder& record, uint32_t vertices, const std::string& control,
                               const std::string& evaluation, const char* fragment = kFragmentGlsl) {
    return record.pipeline(record.vertex(kVertexGlsl), record.fragment(fragment))
        .binding(sizeof(PatchVertex))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(PatchVertex, position))
        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(PatchVertex, outer))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(PatchVertex, inner))
        .patches(vertices, record.control(control), record.evaluation(evaluation));
}

/// What is covered twice is twice as bright.
VkPipelineColorBlendAttachmentState sum() {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.colorWriteMask = 0xf;
    return state;
}

void drawPatches(SceneRecorder& record, uint32_t pipeline, const std::vector<PatchVertex>& vertices) {
    record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("patches", vertices));
}

/// The place of a cell in a picture of columns and rows, and a place in the cell, both from the upper left.
glm::vec2 inCell(glm::vec2 cells, glm::vec2 cell, glm::vec2 place) {
    return (cell + place) / cells * 2.0f - 1.0f;
}

struct Levels {
    glm::vec4 outer;
    glm::vec2 inner;
};

/// Patches of these corners in each cell, a row for each spacing, a column for each of its levels.
template <size_t kCorners, size_t kColumns>
void drawRows(SceneRecorder& record, const std::array<glm::vec2, kCorners>& corners,
              const std::array<std::array<Levels, kColumns>, 3>& levels, const std::string& control,
              const std::string& domain, const std::string& text) {
    const glm::vec2 cells{kColumns, kSpacings.size()};
    for (size_t row = 0; row < kSpacings.size(); ++row) {
        const uint32_t pipeline =
            patchPipeline(record, kCorners, control, evaluationGlsl(domain + ", " + kSpacings[row] + ", ccw", text))
                .blend(sum());
        std::vector<PatchVertex> vertices;
        for (size_t column = 0; column < kColumns; ++column) {
            for (const glm::vec2 corner : corners) {
                const Levels& given = levels[row][column];
                vertices.push_back({inCell(cells, {column, row}, corner), given.outer, given.inner});
            }
        }
        vertices.resize(vertices.size() + kCorners - 1);  // a patch that is not whole, and is not drawn
        drawPatches(record, pipeline, vertices);
    }
}

}  // namespace

Result<Scene> tessellation_triangles() {
    SceneRecorder record("tessellation_triangles",
                         "Triangles whose edges bend outwards, so that their segments can be counted: a row for each "
                         "spacing, with levels that are whole in it. Colours add up.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 240});
    record.pass({320, 240}).color(target, {0, 0, 0, 1});
    const std::array<glm::vec2, 3> corners{{{0.5f, 0.06f}, {0.94f, 0.82f}, {0.06f, 0.82f}}};
    const std::array<std::array<Levels, 4>, 3> levels{{
        {{{{1, 1, 1, 1}, {1, 1}}, {{2, 3, 4, 1}, {3, 1}}, {{5, 1, 6, 1}, {4, 7}}, {{3, 6, 2, 9}, {1, 1}}}},
        {{{{1, 1, 1, 1}, {1, 1}}, {{3, 5, 1, 1}, {3, 1}}, {{5, 3, 5, 1}, {5, 7}}, {{3, 1, 1, 9}, {1, 1}}}},
        {{{{2, 2, 2, 1}, {2, 1}}, {{4, 2, 6, 1}, {2, 1}}, {{2, 6, 4, 1}, {4, 7}}, {{6, 6, 6, 9}, {6, 1}}}},
    }};
    drawRows(record, corners, levels, controlGlsl(3), "triangles", R"(void main() {
    vec3 t = gl_TessCoord;
    vec2 a = gl_in[0].gl_Position.xy, b = gl_in[1].gl_Position.xy, c = gl_in[2].gl_Position.xy;
    vec2 center = (a + b + c) / 3.0, from = a * t.x + b * t.y + c * t.z - center;
    if (min(t.x, min(t.y, t.z)) == 0.0) from *= 1.0 + 1.3 * (t.x * t.y + t.y * t.z + t.z * t.x);
    gl_Position = vec4(center + from, 0.5, 1.0);
    tint = vec3(0.3) + vec3(gl_Position.xy, -gl_Position.x) * 0.2;
    tint.z += 0.04 * float(gl_PrimitiveID);
}
)");
    record.output(target);
    return record.finish();
}

Result<Scene> tessellation_quads() {
    SceneRecorder record("tessellation_quads",
                         "Quads whose control shader makes eight points of four corners, and a colour of what its "
                         "other invocations have made; the edges bend outwards. A row for each spacing, with levels "
                         "that are whole in it. Colours add up.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 240});
    record.pass({320, 240}).color(target, {0, 0, 0, 1});
    const std::array<glm::vec2, 4> corners{{{0.12f, 0.1f}, {0.88f, 0.16f}, {0.84f, 0.9f}, {0.16f, 0.86f}}};
    const std::array<std::array<Levels, 4>, 3> levels{{
        {{{{1, 1, 1, 1}, {1, 1}}, {{2, 3, 4, 5}, {3, 2}}, {{1, 6, 1, 3}, {4, 5}}, {{4, 4, 4, 4}, {1, 6}}}},
        {{{{1, 1, 1, 1}, {1, 1}}, {{3, 1, 5, 3}, {3, 5}}, {{5, 3, 1, 1}, {5, 3}}, {{5, 5, 3, 3}, {3, 3}}}},
        {{{{2, 2, 2, 2}, {2, 2}}, {{2, 4, 6, 2}, {4, 2}}, {{4, 2, 2, 6}, {2, 6}}, {{4, 6, 4, 6}, {4, 4}}}},
    }};
    const std::string control = R"(#version 450
layout(vertices = 8) out;
layout(location = 0) in vec4 vOuter[];
layout(location = 1) in vec2 vInner[];
layout(location = 0) patch out vec3 patchTint;
void main() {
    int n = gl_InvocationID;
    vec4 center = (gl_in[0].gl_Position + gl_in[1].gl_Position + gl_in[2].gl_Position + gl_in[3].gl_Position) * 0.25;
    vec4 made = gl_in[n % 4].gl_Position;
    if (n >= gl_PatchVerticesIn) {
        vec4 middle = (made + gl_in[(n + 1) % 4].gl_Position) * 0.5;
        made = middle + (middle - center) * (0.1 + 0.05 * float(n - 4));
    }
    gl_out[gl_InvocationID].gl_Position = made;
    barrier();
    if (n == 7) {
        vec2 across = gl_out[4].gl_Position.xy - gl_out[6].gl_Position.xy;
        patchTint = vec3(0.3 + 0.1 * abs(across.y), 0.3 + 0.1 * float(gl_PrimitiveID), 0.45);
        for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = vOuter[0][i];
        for (int i = 0; i < 2; ++i) gl_TessLevelInner[i] = vInner[0][i];
    }
}
)";
    // Edges are the parabolas of the quadratic element of eight nodes.
    drawRows(record, corners, levels, control, "quads", R"(layout(location = 0) patch in vec3 patchTint;
void main() {
    vec2 t = gl_TessCoord.xy, s = 1.0 - t;
    vec4 w = vec4(s.x * s.y, t.x * s.y, t.x * t.y, s.x * t.y);
    vec2 p = vec2(0.0);
    for (int i = 0; i < 4; ++i) p += gl_in[i].gl_Position.xy * w[i];
    if (t.x * s.x * t.y * s.y == 0.0) {
        vec4 bends = vec4(s.y * t.x * s.x, t.x * t.y * s.y, t.y * t.x * s.x, s.x * t.y * s.y) * 4.0;
        for (int i = 0; i < 4; ++i) {
            vec2 middle = (gl_in[i].gl_Position.xy + gl_in[(i + 1) % 4].gl_Position.xy) * 0.5;
            p += (gl_in[i + 4].gl_Position.xy - middle) * bends[i];
        }
    }
    gl_Position = vec4(p, 0.5, 1.0);
    tint = patchTint + vec3(p, -p.x) * 0.15;
}
)");
    record.output(target);
    return record.finish();
}

namespace {

/// The fractional level of an edge, by its number: the same for both patches that share it.
float fractionalLevel(int edge) {
    return 1.2f + 0.85f * static_cast<float>(edge * 5 % 9);
}

/// A grid of quads below `top`.
void drawGrid(SceneRecorder& record, const std::string& spacing, float top) {
    const uint32_t quads = patchPipeline(record, 4, controlGlsl(4), evaluationGlsl("quads, ccw, " + spacing, R"(
void main() {
    vec2 t = gl_TessCoord.xy, s = 1.0 - t;
    precise vec2 low = gl_in[0].gl_Position.xy * s.x + gl_in[1].gl_Position.xy * t.x;
    precise vec2 high = gl_in[3].gl_Position.xy * s.x + gl_in[2].gl_Position.xy * t.x;
    precise vec2 p = low * s.y + high * t.y;
    gl_Position = vec4(p, 0.5, 1.0);
    tint = vec3(0.35) + vec3(p, -p.x) * 0.25;
}
)"))
                               .blend(sum());
    constexpr int kColumns = 4, kRows = 2;
    std::vector<PatchVertex> vertices;
    const auto node = [top](int column, int row) {
        const glm::vec2 at{static_cast<float>(column), static_cast<float>(row)};
        return glm::vec2(-0.9f + 0.29f * at.x + 0.045f * at.y, top + 0.07f + 0.055f * at.x + 0.31f * at.y);
    };
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const auto upright = [row](int line) { return fractionalLevel(7 * line + row); };
            const auto level = [column](int line) { return fractionalLevel(4 * line + column + 2); };
            const glm::vec4 outer{upright(column), level(row), upright(column + 1), level(row + 1)};
            const glm::vec2 inner{fractionalLevel(column + 3 * row), fractionalLevel(2 * column + row + 1)};
            for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
                vertices.push_back({node(column + corner.x, row + corner.y), outer, inner});
        }
    }
    drawPatches(record, quads, vertices);
}

/// A fan of triangles beside it.
void drawFan(SceneRecorder& record, const std::string& spacing, float top) {
    const uint32_t triangles = patchPipeline(record, 3, controlGlsl(3), evaluationGlsl("triangles, ccw, " + spacing, R"(
void main() {
    vec3 t = gl_TessCoord;
    precise vec2 outside = gl_in[1].gl_Position.xy * t.y + gl_in[2].gl_Position.xy * t.z;
    precise vec2 p = gl_in[0].gl_Position.xy * t.x + outside;
    gl_Position = vec4(p, 0.5, 1.0);
    tint = vec3(0.35) + vec3(p, -p.x) * 0.25;
}
)"))
                                   .blend(sum());
    constexpr int kSpokes = 6;
    const glm::vec2 hub{0.66f, top + 0.47f};
    const auto rim = [hub](int spoke) {
        constexpr std::array<glm::vec2, kSpokes> kRim{
            {{0.27f, 0.05f}, {0.12f, 0.38f}, {-0.14f, 0.36f}, {-0.25f, -0.03f}, {-0.11f, -0.4f}, {0.16f, -0.37f}}};
        return hub + kRim[static_cast<size_t>(spoke % kSpokes)];
    };
    std::vector<PatchVertex> fan;
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
        const glm::vec4 outer{fractionalLevel(spoke + 4), fractionalLevel((spoke + 1) % kSpokes),
                              fractionalLevel(spoke), 1};
        const glm::vec2 inner{fractionalLevel(3 * spoke + 1), 1};
        for (const glm::vec2 place : {hub, rim(spoke), rim(spoke + 1)}) fan.push_back({place, outer, inner});
    }
    drawPatches(record, triangles, fan);
}

}  // namespace

Result<Scene> tessellation_spacing() {
    SceneRecorder record("tessellation_spacing",
                         "Flat quads and triangles of fractional levels, odd above and even below, which differ on "
                         "every edge but are the same for two patches that share it. Colours add up: nothing shows of "
                         "where patches and their parts meet.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 240});
    record.pass({320, 240}).color(target, {0, 0, 0, 1});
    for (const auto draw : {drawGrid, drawFan}) {
        draw(record, kSpacings[1], -0.98f);
        draw(record, kSpacings[2], 0.02f);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> tessellation_isolines() {
    SceneRecorder record("tessellation_isolines",
                         "Isolines, a row for each spacing: bent ones of as many segments as their levels say, and "
                         "straight ones of fractional levels. How much they bend is told by a level that has no other "
                         "effect.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 240});
    record.pass({320, 240}).color(target, kDark);
    const std::array<std::array<glm::vec2, 4>, 3> levels{{
        {{{1, 1}, {3, 5}, {7, 4}, {4.5f, 6.5f}}},
        {{{2, 3}, {4, 1}, {6, 5}, {2.3f, 4.2f}}},
        {{{3, 2}, {5, 6}, {8, 4}, {5.7f, 3.1f}}},
    }};
    for (size_t row = 0; row < kSpacings.size(); ++row) {
        const std::string modes = std::string("isolines, ") + kSpacings[row];
        const uint32_t pipeline = patchPipeline(record, 1, controlGlsl(1), evaluationGlsl(modes, R"(
void main() {
    vec2 t = gl_TessCoord.xy;
    vec2 place = vec2(t.x * 0.42, t.y * 0.45 + gl_TessLevelInner[0] * t.x * (1.0 - t.x));
    gl_Position = vec4(gl_in[0].gl_Position.xy + place, 0.5, 1.0);
    tint = vec3(0.35 + 0.6 * t.y, 0.9 - 0.5 * t.y, 0.3 + 0.2 * float(gl_PrimitiveID));
}
)"));
        std::vector<PatchVertex> vertices;
        for (size_t column = 0; column < 4; ++column) {
            const glm::vec2 given = levels[row][column];
            const bool whole = given == glm::floor(given);
            vertices.push_back({inCell({4, 3}, {column, row}, {0.083f, 0.071f}),
                                {given.x, given.y, 0, -1},
                                {whole ? 0.62f : 0.0f, 0}});
        }
        drawPatches(record, pipeline, vertices);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> tessellation_points() {
    SceneRecorder record("tessellation_points",
                         "Every point of triangles, quads and isolines, one row for each spacing, with levels that are "
                         "whole in it; the colour is TessCoord.");
    const uint32_t target = record.colorTarget("color", kRgba8, {360, 180});
    record.pass({360, 180}).color(target, kDark);
    const std::array<std::pair<const char*, const char*>, 3> domains{{
        {"triangles", "gl_in[0].gl_Position * t.x + gl_in[1].gl_Position * t.y + gl_in[3].gl_Position * t.z"},
        {"quads", kBilinearGlsl},
        {"isolines", kBilinearGlsl},
    }};
    const std::array<std::array<Levels, 2>, 3> levels{{
        {{{{2, 3, 4, 5}, {3, 4}}, {{5, 4, 2, 3}, {5, 2}}}},
        {{{{1, 3, 5, 3}, {3, 5}}, {{5, 5, 3, 1}, {5, 3}}}},
        {{{{2, 4, 6, 4}, {4, 2}}, {{4, 6, 2, 2}, {2, 6}}}},
    }};
    const std::array<glm::vec2, 4> corners{{{0.11f, 0.13f}, {0.87f, 0.16f}, {0.9f, 0.88f}, {0.14f, 0.83f}}};
    for (size_t row = 0; row < kSpacings.size(); ++row) {
        for (size_t domain = 0; domain < domains.size(); ++domain) {
            const std::string modes = std::string(domains[domain].first) + ", point_mode, " + kSpacings[row];
            const uint32_t pipeline = patchPipeline(record, 4, controlGlsl(4), evaluationGlsl(modes, R"(void main() {
    vec3 t = gl_TessCoord;
    gl_Position = )" + std::string(domains[domain].second) + R"(;
    gl_PointSize = 3.0;
    tint = vec3(0.25) + t * 0.7;
}
)"));
            std::vector<PatchVertex> vertices;
            for (size_t column = 0; column < 2; ++column) {
                const Levels& given = levels[row][column];
                for (const glm::vec2 corner : corners)
                    vertices.push_back({inCell({6, 3}, {2 * domain + column, row}, corner), given.outer, given.inner});
            }
            drawPatches(record, pipeline, vertices);
        }
    }
    record.output(target);
    return record.finish();
}

namespace {

/// Counts what a geometry shader gets: it puts a point in the place of each.
constexpr const char* kCountGlsl = R"( in;
layout(points, max_vertices = 1) out;
layout(location = 0) in vec3 tint[];
layout(location = 0) out vec3 pointTint;
void main() {
    gl_Position = gl_in[0].gl_Position;
    gl_PointSize = 2.0;
    pointTint = tint[0];
    EmitVertex();
}
)";

/// Patches that count their points, or their lines or triangles, by levels: all alike, or the outer ones 3.
std::vector<PatchVertex> countedPatches(const std::string& domain, const std::string& spacing, bool alike,
                                        glm::vec2 cells, glm::vec2 first) {
    const std::array kLevels{-1.0f, 0.0f, 0.25f, 1.0f, 1.25f, 2.0f, 2.5f, 3.0f,
                             3.25f, 4.0f, 4.75f, 5.0f, 6.0f,  7.5f, 8.0f, 9.0f};
    std::vector<PatchVertex> vertices;
    for (size_t n = 0; n < kLevels.size(); ++n) {
        float level = kLevels[n];
        PatchVertex vertex{inCell(cells, first + glm::vec2(n, 0), {0.25f, 0.25f})};
        if (alike) {
            vertex.outer = glm::vec4(level);
        } else if (domain == "isolines") {
            vertex.outer = {3, level, -1, -1};
        } else {
            // An inner level of 1 beside greater ones counts as a little more: with odd spacing it may be told whether
            // points on the edge are of the inside.
            if (spacing == kSpacings[1]) level = std::max(level, 1.25f);
            vertex.outer = glm::vec4(3);
        }
        vertex.inner = glm::vec2(level);
        vertices.push_back(vertex);
    }
    return vertices;
}

}  // namespace

Result<Scene> tessellation_counts() {
    SceneRecorder record("tessellation_counts",
                         "How many points, at the left, and lines or triangles, at the right, come out of patches of "
                         "16 levels, by domain and spacing: each adds 1/255 in the same place.");
    const VkExtent2D extent{128, 72};
    const uint32_t target = record.colorTarget("counts", kRgba8, extent);
    record.pass(extent).color(target, {0, 0, 0, 1});
    const glm::vec2 cells{extent.width / 4, extent.height / 4};
    for (const bool points : {true, false}) {
        glm::vec2 first{points ? 0 : 16, 0};
        for (const std::string domain : {"triangles", "quads", "isolines"}) {
            for (const std::string spacing : kSpacings) {
                const std::string modes = domain + ", " + spacing + (points ? ", point_mode" : "");
                const std::string size = points ? "    gl_PointSize = 2.0;\n" : "";
                PipelineRecorder pipeline =
                    patchPipeline(record, 1, controlGlsl(1), evaluationGlsl(modes, R"(void main() {
    gl_Position = gl_in[0].gl_Position;
    tint = vec3(1.0 / 255.0);
)" + size + "}\n"));
                pipeline.blend(sum());
                if (!points) {
                    const std::string input = domain == "isolines" ? "lines" : "triangles";
                    pipeline.geometry(record.geometry("#version 450\nlayout(" + input + ")" + kCountGlsl));
                }
                for (const bool alike : {true, false}) {
                    drawPatches(record, pipeline, countedPatches(domain, spacing, alike, cells, first));
                    first.y += 1;
                }
            }
        }
    }
    record.output(target);
    return record.finish();
}

Result<Scene> tessellation_winding() {
    SceneRecorder record("tessellation_winding",
                         "Triangles and quads of either order, for domains with their origin at the upper left (first "
                         "and second row) and at the lower left; in every other row back faces are culled.");
    const uint32_t target = record.colorTarget("color", kRgba8, {192, 192});
    record.pass({192, 192}).color(target, kDark);
    const std::array<glm::vec2, 4> corners{{{0.1f, 0.15f}, {0.9f, 0.1f}, {0.85f, 0.9f}, {0.12f, 0.8f}}};
    for (size_t row = 0; row < 4; ++row) {
        for (size_t column = 0; column < 4; ++column) {
            const std::string order = column % 2 == 0 ? "cw" : "ccw";
            const bool quad = column >= 2;
            const std::string domain = quad ? "quads" : "triangles";
            const std::string place = quad ? kBilinearGlsl
                                           : "gl_in[1].gl_Position * t.x + gl_in[3].gl_Position * t.y + "
                                             "gl_in[0].gl_Position * t.z";
            PipelineRecorder pipeline = patchPipeline(
                record, 4, controlGlsl(4), evaluationGlsl(domain + ", equal_spacing, " + order, R"(void main() {
    vec3 t = gl_TessCoord;
    gl_Position = )" + place + R"(;
    tint = vec3(0.9, 0.6, 0.2);
}
)"),
                kFacingGlsl);
            if (row % 2 == 1) pipeline.cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE);
            if (row >= 2) pipeline.domainLowerLeft();
            std::vector<PatchVertex> vertices;
            for (const glm::vec2 corner : corners)
                vertices.push_back({inCell({4, 4}, {column, row}, corner), {3, 2, 4, 3}, {3, 4}});
            drawPatches(record, pipeline, vertices);
        }
    }
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
