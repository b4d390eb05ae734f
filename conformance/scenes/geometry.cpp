// Scenes about getting primitives onto the screen: assembly, interpolation, instancing, clipping, shared
// edges.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr double kTau = 6.283185307179586476925;

PipelineRecorder colorPipeline(SceneRecorder& record) {
    return record.pipeline(record.vertex(kColorVertexGlsl), record.fragment(kColorFragmentGlsl))
        .binding(sizeof(ColorVertex))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(ColorVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(ColorVertex, color));
}

glm::vec2 onCircle(double turns, double radius) {
    return glm::vec2(glm::dvec2(std::cos(kTau * turns), std::sin(kTau * turns)) * radius);
}

}  // namespace

Result<Scene> solid() {
    SceneRecorder record("solid", "One triangle of one colour over a cleared target: coverage and nothing else.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec2 position;
void main() { gl_Position = vec4(position, 0.0, 1.0); }
)"),
                                            record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.957, 0.545, 0.196, 1.0); }
)"))
                                  .binding(sizeof(glm::vec2))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, 0);
    const uint32_t vertices =
        record.vertexBuffer("triangle", std::vector<glm::vec2>{{-0.62f, -0.71f}, {0.77f, -0.23f}, {-0.27f, 0.81f}});
    record.pass(kSceneExtent).color(target, {0.09f, 0.11f, 0.2f, 1});
    record.draw(pipeline, 3).vertices(vertices);
    record.output(target);
    return record.finish();
}

Result<Scene> gouraud() {
    constexpr VkExtent2D kExtent{253, 241};
    SceneRecorder record("gouraud", "Red, green and blue corners interpolated over a triangle; 253 x 241 pixels.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t pipeline = colorPipeline(record);
    const uint32_t vertices =
        record.vertexBuffer("triangle", std::vector<ColorVertex>{{{0.0f, -0.87f}, {1, 0.1f, 0.1f}},
                                                                 {{0.91f, 0.79f}, {0.1f, 1, 0.1f}},
                                                                 {{-0.93f, 0.73f}, {0.1f, 0.1f, 1}}});
    record.pass(kExtent).color(target, {0.07f, 0.07f, 0.09f, 1});
    record.draw(pipeline, 3).vertices(vertices);
    record.output(target);
    return record.finish();
}

Result<Scene> interpolation_modes() {
    SceneRecorder record("interpolation_modes",
                         "The same tilted quad with smooth, noperspective and flat colours, from left to right.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t vertexShader = record.vertex(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 smoothColor;
layout(location = 1) noperspective out vec3 linearColor;
layout(location = 2) flat out vec3 flatColor;
void main() {
    gl_Position = position;
    smoothColor = linearColor = flatColor = color;
}
)");
    constexpr const char* kInputs[] = {"layout(location = 0) in vec3 c;",
                                       "layout(location = 1) noperspective in vec3 c;",
                                       "layout(location = 2) flat in vec3 c;"};
    struct Vertex {
        glm::vec4 position;
        glm::vec3 color;
    };
    // The far edge is at w = 4: a quad leaning back, two triangles of different provoking colours.
    const Vertex a{{-0.85f, 0.9f, 0.1f, 1}, {0.98f, 0.85f, 0.24f}}, b{{0.85f, 0.9f, 0.1f, 1}, {0.9f, 0.2f, 0.35f}};
    const Vertex c{{-2.2f, -3.5f, 2, 4}, {0.15f, 0.3f, 0.7f}}, d{{2.2f, -3.5f, 2, 4}, {0.1f, 0.75f, 0.6f}};
    const uint32_t vertices = record.vertexBuffer("quad", std::vector<Vertex>{a, b, c, d, c, b});
    std::vector<uint32_t> pipelines;
    for (const char* input : kInputs) {
        const uint32_t fragmentShader = record.fragment(std::string("#version 450\n") + input + R"(
layout(location = 0) out vec4 color;
void main() {
    vec3 bands = floor(c * 16.0) * (1.0 / 16.0);
    color = vec4(mix(c, bands, 0.5), 1.0);
}
)");
        pipelines.push_back(record.pipeline(vertexShader, fragmentShader)
                                .binding(sizeof(Vertex))
                                .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, position))
                                .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)));
    }
    record.pass(kSceneExtent).color(target, {0.93f, 0.93f, 0.9f, 1});
    for (size_t i = 0; i < pipelines.size(); ++i) {
        record.draw(pipelines[i], 6).vertices(vertices).viewport(2 + 84 * static_cast<float>(i), 20, 84, 216);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> indexed_strip() {
    constexpr VkExtent2D kExtent{255, 257};
    constexpr uint32_t kColumns = 24, kRibbons = 7;
    constexpr uint16_t kRestart = 0xffff;
    SceneRecorder record(
        "indexed_strip",
        "Ribbons as one triangle strip with 16-bit indices and restarts, below a hexagon as a list with "
        "32-bit indices, a first index and a vertex offset; 255 x 257 pixels.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    std::vector<ColorVertex> vertices;
    std::vector<uint16_t> strip;
    for (uint32_t ribbon = 0; ribbon < kRibbons; ++ribbon) {
        const double v = static_cast<double>(ribbon) / (kRibbons - 1);
        if (ribbon != 0) strip.push_back(kRestart);
        for (uint32_t column = 0; column <= kColumns; ++column) {
            const double u = static_cast<double>(column) / kColumns;
            const double wave = 0.09 * std::sin(kTau * (1.3 * u + 0.55 * v)) * (0.35 + u);
            for (const double edge : {0.0, 0.105}) {
                strip.push_back(static_cast<uint16_t>(vertices.size()));
                const glm::dvec2 position(-0.93 + 1.86 * u, -0.86 + 1.55 * v + wave + edge);
                const glm::dvec3 color(0.18 + 0.75 * u, 0.32 + 0.45 * v + 2 * edge, 0.78 - 0.5 * u * v);
                vertices.push_back({position, color});
            }
        }
    }
    const auto hexagonBase = static_cast<int32_t>(vertices.size());
    vertices.push_back({{0, 0}, {1, 0.98f, 0.9f}});
    for (int corner = 0; corner < 6; ++corner) {
        vertices.push_back({onCircle(corner / 6.0, 0.31), {0.86f, 0.24f, 0.3f + 0.1f * static_cast<float>(corner)}});
    }
    std::vector<uint32_t> list{99999, 99999};  // skipped by the first index
    for (uint32_t corner = 0; corner < 6; ++corner) list.insert(list.end(), {0, corner + 1, (corner + 1) % 6 + 1});

    const uint32_t stripPipeline = colorPipeline(record).topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, true);
    const uint32_t listPipeline = colorPipeline(record);
    const uint32_t vertexBuffer = record.vertexBuffer("vertices", vertices);
    const uint32_t stripBuffer = record.indexBuffer("strip", strip);
    const uint32_t listBuffer = record.indexBuffer("list", list);
    record.pass(kExtent).color(target, {0.06f, 0.08f, 0.12f, 1});
    record.draw(stripPipeline, static_cast<uint32_t>(strip.size()))
        .vertices(vertexBuffer)
        .indices(stripBuffer, VK_INDEX_TYPE_UINT16);
    record.draw(listPipeline, 18)
        .vertices(vertexBuffer)
        .indices(listBuffer, VK_INDEX_TYPE_UINT32)
        .first(2, hexagonBase);
    record.output(target);
    return record.finish();
}

Result<Scene> instancing() {
    constexpr uint32_t kRows = 6, kSkipped = 3;
    SceneRecorder record(
        "instancing",
        "36 darts placed and turned by per-instance attributes, tinted by gl_InstanceIndex, with a first "
        "instance other than 0.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    struct Instance {
        glm::vec2 offset, turn;
        glm::u8vec4 color;
    };
    std::vector<Instance> instances(kSkipped, {{9, 9}, {1, 0}, {255, 0, 255, 255}});
    for (uint32_t i = 0; i < kRows * kRows; ++i) {
        const double x = i % kRows, y = i / kRows;
        const glm::vec2 offset(glm::dvec2(-0.825 + 0.33 * x, -0.825 + 0.33 * y));
        instances.push_back({offset,
                             onCircle(std::sqrt(x * x + y * y) / 9, 0.19),
                             {40 + 40 * i % 200, 90 + 26 * (i / kRows), 230 - 30 * (i % kRows), 255}});
    }
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 offset;
layout(location = 2) in vec2 turn;
layout(location = 3) in vec4 tint;
layout(location = 0) out vec3 vColor;
void main() {
    vec2 turned = vec2(turn.x * position.x - turn.y * position.y, turn.y * position.x + turn.x * position.y);
    gl_Position = vec4(turned + offset, 0.0, 1.0);
    float shade = (gl_InstanceIndex & 1) == 0 ? 1.0 : 0.75;
    vColor = tint.rgb * shade * (0.7 + 0.3 * position.x);
}
)"),
                                            record.fragment(kColorFragmentGlsl))
                                  .binding(sizeof(glm::vec2))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, 0)
                                  .binding(sizeof(Instance), VK_VERTEX_INPUT_RATE_INSTANCE)
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(Instance, offset))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(Instance, turn))
                                  .attribute(VK_FORMAT_R8G8B8A8_UNORM, offsetof(Instance, color));
    const uint32_t dart = record.vertexBuffer(
        "dart", std::vector<glm::vec2>{{0.9f, 0}, {-0.7f, 0.62f}, {-0.3f, 0}, {0.9f, 0}, {-0.3f, 0}, {-0.7f, -0.62f}});
    const uint32_t instanceBuffer = record.vertexBuffer("instances", instances);
    record.pass(kSceneExtent).color(target, {0.95f, 0.94f, 0.91f, 1});
    record.draw(pipeline, 6).vertices(dart, 0).vertices(instanceBuffer, 1).instances(kRows * kRows, kSkipped);
    record.output(target);
    return record.finish();
}

Result<Scene> push_constants() {
    SceneRecorder record("push_constants",
                         "Eighteen hexagons, each with its own transform and colours in push constants.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    struct Constants {
        glm::vec4 transform;  // column-major 2x2
        glm::vec4 inner, outer;
        glm::vec2 offset;
    };
    constexpr const char* kBlock = R"(#version 450
layout(push_constant) uniform Constants {
    vec4 transform;
    vec4 inner;
    vec4 outer;
    vec2 offset;
} push;
)";
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(std::string(kBlock) + R"(
layout(location = 0) in vec3 corner;
layout(location = 0) out float rim;
void main() {
    gl_Position = vec4(mat2(push.transform) * corner.xy + push.offset, 0.0, 1.0);
    rim = corner.z;
}
)"),
                                            record.fragment(std::string(kBlock) + R"(
layout(location = 0) in float rim;
layout(location = 0) out vec4 color;
void main() { color = mix(push.inner, push.outer, rim); }
)"))
                                  .binding(sizeof(glm::vec3))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, 0)
                                  .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN)
                                  .pushConstants(sizeof(Constants));
    std::vector<glm::vec3> fan{{0, 0, 0}};
    for (int corner = 0; corner <= 6; ++corner) fan.push_back({onCircle((corner % 6) / 6.0, 1), 1});
    const uint32_t vertices = record.vertexBuffer("hexagon", fan);
    record.pass(kSceneExtent).color(target, {0.1f, 0.09f, 0.14f, 1});
    for (int ring = 0; ring < 2; ++ring) {
        const int count = ring == 0 ? 6 : 12;
        for (int i = 0; i < count; ++i) {
            const double turns = (i + 0.5 * ring) / count;
            const glm::vec2 axis = onCircle(turns * 0.5, ring == 0 ? 0.17 : 0.14);
            const auto share = static_cast<float>(i) / static_cast<float>(count);
            Constants constants{};
            constants.transform = {axis.x, axis.y, -axis.y, axis.x};
            constants.inner = {1 - share * 0.6f, 0.85f, 0.35f + share * 0.6f, 1};
            constants.outer = {0.75f - share * 0.5f, 0.2f + 0.3f * share, 0.5f + 0.2f * share, 1};
            constants.offset = onCircle(turns, ring == 0 ? 0.36 : 0.76);
            record.draw(pipeline, static_cast<uint32_t>(fan.size())).vertices(vertices).push(constants);
        }
    }
    record.output(target);
    return record.finish();
}

Result<Scene> shared_edges() {
    constexpr int kSpokes = 96, kRings = 6;
    SceneRecorder record("shared_edges",
                         "A fan of thin cells in six rings: its cells share every edge and cover the target "
                         "beyond its borders, adding 1 to a count each. "
                         "Every count must be 1: black is a hole, magenta a pixel hit twice.");
    const uint32_t counts =
        record.colorTarget("counts", kRgba8, kSceneExtent, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    SceneRandom random(2024);
    const glm::vec2 center(0.13f, -0.09f);
    std::vector<ColorVertex> vertices;
    // Little enough jitter that no quad folds over.
    std::vector<glm::vec2> points;
    for (int ring = 0; ring <= kRings; ++ring) {
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            if (ring == 0) {
                points.push_back(center);
                continue;
            }
            const double jitter = ring == kRings ? 0 : 0.2 * (random.unit() - 0.5);
            const double radius = 2.1 * std::pow((ring + jitter) / kRings, 2);
            points.push_back(center + onCircle((spoke + 0.35 * random.unit()) / kSpokes, radius));
        }
    }
    for (int ring = 0; ring < kRings; ++ring) {
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const auto at = [&](int r, int s) { return points[static_cast<size_t>(r * kSpokes + s % kSpokes)]; };
            // Multiples of 1/255 add up without rounding: red counts, green and blue are the cell's colour.
            const glm::vec3 color(1.0f / 255, static_cast<float>(60 + random.next() % 120) / 255,
                                  static_cast<float>(90 + ring * 20) / 255);
            for (const glm::vec2 position : {at(ring, spoke), at(ring + 1, spoke), at(ring + 1, spoke + 1)}) {
                vertices.push_back({position, color});
            }
            if (ring == 0) continue;
            for (const glm::vec2 position : {at(ring, spoke), at(ring + 1, spoke + 1), at(ring, spoke + 1)}) {
                vertices.push_back({position, color});
            }
        }
    }
    VkPipelineColorBlendAttachmentState add{};
    add.blendEnable = VK_TRUE;
    add.srcColorBlendFactor = add.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    add.srcAlphaBlendFactor = add.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    add.colorWriteMask = 0xf;
    const uint32_t countPipeline = record
                                       .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 color;
layout(location = 0) flat out vec3 vColor;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    vColor = color;
}
)"),
                                                 record.fragment(R"(#version 450
layout(location = 0) flat in vec3 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(vColor, 0.0); }
)"))
                                       .binding(sizeof(ColorVertex))
                                       .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(ColorVertex, position))
                                       .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(ColorVertex, color))
                                       .blend(add);
    const uint32_t showPipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D counts;
layout(location = 0) out vec4 color;
void main() {
    vec4 texel = texelFetch(counts, ivec2(gl_FragCoord.xy), 0);
    int count = int(texel.r * 255.0 + 0.5);
    if (count == 1) color = vec4(0.1, texel.g, texel.b, 1.0);
    else if (count == 0) color = vec4(0.0, 0.0, 0.0, 1.0);
    else color = vec4(1.0, 0.0, 1.0, 1.0);
}
)"));
    const uint32_t vertexBuffer = record.vertexBuffer("mesh", vertices);
    record.pass(kSceneExtent).color(counts, {0, 0, 0, 1});
    record.draw(countPipeline, static_cast<uint32_t>(vertices.size())).vertices(vertexBuffer);
    record.pass(kSceneExtent).color(target, {0, 0, 0, 1});
    record.draw(showPipeline, 3).texture(0, counts, record.sampler(VK_FILTER_NEAREST));
    record.output(target);
    record.output(counts);
    return record.finish();
}

Result<Scene> near_plane() {
    SceneRecorder record(
        "near_plane",
        "A corridor whose walls run from far ahead to behind the eye: every polygon crosses the near plane, "
        "some have vertices with negative w.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    struct Vertex {
        glm::vec3 position, color;
    };
    std::vector<Vertex> vertices;
    constexpr int kPanels = 8;
    for (int panel = 0; panel < kPanels; ++panel) {
        const double a = (panel + 0.5) / kPanels, b = (panel + 1.5) / kPanels;
        const glm::vec3 left(onCircle(a, 1.3), 0), right(onCircle(b, 1.3), 0);
        const glm::vec3 ahead(0, 0, -14), behind(0, 0, 5);
        const bool even = panel % 2 == 0;
        const glm::vec3 nearColor = even ? glm::vec3(0.97f, 0.63f, 0.18f) : glm::vec3(0.2f, 0.55f, 0.83f);
        const glm::vec3 farColor = even ? glm::vec3(0.35f, 0.08f, 0.25f) : glm::vec3(0.05f, 0.1f, 0.3f);
        const Vertex v0{left + behind, nearColor}, v1{right + behind, nearColor * 0.8f};
        const Vertex v2{left + ahead, farColor}, v3{right + ahead, farColor};
        vertices.insert(vertices.end(), {v0, v1, v2, v2, v1, v3});
    }
    // A blade that starts behind the eye and pierces the corridor.
    vertices.insert(vertices.end(), {{{-1.1f, -0.4f, 1.5f}, {0.9f, 0.95f, 0.6f}},
                                     {{0.4f, -0.8f, -2.2f}, {0.2f, 0.8f, 0.5f}},
                                     {{1.5f, 0.2f, -5.0f}, {0.95f, 0.3f, 0.4f}}});
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Constants { mat4 camera; } push;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = push.camera * vec4(position, 1.0);
    vColor = color;
}
)"),
                                            record.fragment(kColorFragmentGlsl))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color))
                                  .depth(VK_COMPARE_OP_LESS)
                                  .pushConstants(sizeof(glm::mat4));
    const uint32_t vertexBuffer = record.vertexBuffer("corridor", vertices);
    record.pass(kSceneExtent).color(target, {0.02f, 0.02f, 0.04f, 1}).depthStencil(depth);
    record.draw(pipeline, static_cast<uint32_t>(vertices.size()))
        .vertices(vertexBuffer)
        .push(cameraMatrix({0.1, 0.15, 0}, {0.25, -0.1, -4}, 75, 1, 0.25, 40));
    record.output(target);
    record.output(depth);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
