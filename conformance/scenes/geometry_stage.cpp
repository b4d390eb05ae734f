// Scenes of geometry shaders.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr std::array<float, 4> kDark{0.07f, 0.08f, 0.11f, 1};

constexpr const char* kVertexGlsl = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = vec4(position, 1.0);
    vColor = color;
}
)";
constexpr const char* kFragmentGlsl = R"(#version 450
layout(location = 0) in vec3 gColor;
layout(location = 1) flat in vec3 gFlat;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PrimitiveID % 2 == 0 ? gColor : gFlat, 1.0); }
)";

glm::vec3 tint(int i) {
    const auto part = [](int n) { return 0.2f + 0.1f * static_cast<float>(n % 8); };
    return {part(3 * i + 1), part(5 * i + 4), part(7 * i + 6)};
}

PipelineRecorder stage(SceneRecorder& record, uint32_t geometry, VkPrimitiveTopology topology) {
    return depthColorPipeline(record, kVertexGlsl, kFragmentGlsl).geometry(geometry).topology(topology);
}

}  // namespace

Result<Scene> geometry_strips() {
    SceneRecorder record("geometry_strips",
                         "A geometry shader puts out two strips of triangles for each point and invocation, of as many "
                         "vertices as its numbers say, with colours that are flat and such that are not; the first "
                         "vertex is the provoking one on the left, the last one on the right.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 160});
    const uint32_t geometry = record.geometry(R"(#version 450
layout(points, invocations = 2) in;
layout(triangle_strip, max_vertices = 14) out;
layout(location = 0) in vec3 vColor[];
layout(location = 0) out vec3 gColor;
layout(location = 1) flat out vec3 gFlat;
void main() {
    int count = 3 + (gl_PrimitiveIDIn + gl_InvocationID) % 5;
    for (int strip = 0; strip < 2; ++strip) {
        for (int v = 0; v < count; ++v) {
            vec2 place = vec2(float(v) * 0.043, float(v & 1) * 0.11 + float(2 * gl_InvocationID + strip) * 0.14);
            gl_Position = vec4(gl_in[0].gl_Position.xy + place, 0.5, 1.0);
            gColor = mix(vColor[0], vec3(1.0), float(v) / 7.0);
            gFlat = vec3(float(v) / 7.0, vColor[0].yz);
            gl_PrimitiveID = strip + gl_InvocationID;
            EmitVertex();
        }
        EndPrimitive();
    }
}
)");
    std::vector<DepthColorVertex> points;
    for (int i = 0; i < 15; ++i)
        points.push_back(
            {{-0.95f + 0.38f * static_cast<float>(i % 5), -0.9f + 0.64f * static_cast<float>(i / 5), 0.5f}, tint(i)});
    const uint32_t buffer = record.vertexBuffer("points", points);
    record.pass({320, 160}).color(target, kDark);
    for (const bool last : {false, true}) {
        PipelineRecorder state = stage(record, geometry, VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
        if (last) state.provokingVertexLast();
        record.draw(state, static_cast<uint32_t>(points.size()))
            .vertices(buffer)
            .viewport(last ? 160.0f : 0.0f, 0, 160, 160)
            .scissor(last ? 160 : 0, 0, 160, 160);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> geometry_adjacency() {
    SceneRecorder record("geometry_adjacency",
                         "Geometry shaders draw the neighbours of triangles, of a list and of strips of one to four "
                         "triangles, each as a thin triangle along the edge it shares, and lines of four vertices with "
                         "the points before and behind them.");
    const uint32_t target = record.colorTarget("color", kRgba8, {192, 192});
    const uint32_t triangles = record.geometry(R"(#version 450
layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 9) out;
layout(location = 0) in vec3 vColor[];
layout(location = 0) out vec3 gColor;
layout(location = 1) flat out vec3 gFlat;
void corner(vec4 place, int v) {
    gl_Position = place;
    gColor = gFlat = vColor[v];
    gl_PrimitiveID = gl_PrimitiveIDIn;
    EmitVertex();
}
void main() {
    for (int side = 0; side < 6; side += 2) {
        vec4 a = gl_in[side].gl_Position, b = gl_in[(side + 2) % 6].gl_Position;
        corner(a, side);
        corner(b, (side + 2) % 6);
        corner(mix((a + b) * 0.5, gl_in[side + 1].gl_Position, 0.35), side + 1);
        EndPrimitive();
    }
}
)");
    const uint32_t lines = record.geometry(R"(#version 450
layout(lines_adjacency) in;
layout(line_strip, max_vertices = 4) out;
layout(location = 0) in vec3 vColor[];
layout(location = 0) out vec3 gColor;
layout(location = 1) flat out vec3 gFlat;
void main() {
    for (int v = 0; v < 4; ++v) {
        gl_Position = gl_in[v].gl_Position + vec4(0.0, float(gl_PrimitiveIDIn) * 0.05, 0.0, 0.0);
        gColor = gFlat = vColor[v];
        gl_PrimitiveID = 0;
        EmitVertex();
    }
}
)");
    // Rows of vertices in a zigzag, the even ones those of strips.
    const auto zigzag = [](int count, float left, float top) {
        std::vector<DepthColorVertex> vertices;
        for (int i = 0; i < count; ++i) {
            const float x = left + 0.11f * static_cast<float>(i / 2) + (i % 2 == 0 ? 0.0f : 0.04f);
            const float y = top + (i % 4 < 2 ? 0.0f : 0.21f) + (i % 2 == 0 ? 0.0f : (i % 4 < 2 ? -0.09f : 0.09f));
            vertices.push_back({{x, y, 0.5f}, tint(i)});
        }
        return vertices;
    };
    record.pass({192, 192}).color(target, kDark);
    const auto draw = [&](uint32_t geometry, VkPrimitiveTopology topology, const std::vector<DepthColorVertex>& list) {
        record.draw(stage(record, geometry, topology), static_cast<uint32_t>(list.size()))
            .vertices(record.vertexBuffer("vertices", list));
    };
    for (int n = 1; n <= 4; ++n)
        draw(
            triangles, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY,
            zigzag(2 * n + 4, -0.92f + (n < 3 ? 0.5f : 0.9f) * static_cast<float>((n - 1) % 2), n < 3 ? -0.8f : -0.4f));
    draw(triangles, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, zigzag(18, -0.9f, 0.05f));
    draw(lines, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, zigzag(9, -0.9f, 0.5f));
    draw(lines, VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, zigzag(12, 0.0f, 0.5f));
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
