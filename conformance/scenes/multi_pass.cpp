// Scenes whose later passes read what earlier ones drew.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

PipelineRecorder& solidVertices(PipelineRecorder& pipeline) {
    return pipeline.binding(sizeof(SolidVertex))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, normal))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(SolidVertex, uv));
}

}  // namespace

Result<Scene> render_to_texture() {
    constexpr VkExtent2D kInner{64, 64};
    SceneRecorder record("render_to_texture", "A small picture is drawn first, then sampled on the faces of a cube.");
    const uint32_t inner =
        record.colorTarget("inner", kRgba8, kInner, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    std::vector<ColorVertex> rays;
    for (int ray = 0; ray < 9; ++ray) {
        const auto at = [&](double turns) {
            const double angle = 6.283185307179586 * turns / 9;
            return glm::vec2(glm::dvec2(std::cos(angle), std::sin(angle)) * 0.92);
        };
        const auto share = static_cast<float>(ray) / 9;
        const glm::vec3 color(0.98f - 0.2f * share, 0.5f + 0.4f * share, 0.25f);
        rays.insert(rays.end(), {{{0, 0}, color * 0.6f}, {at(ray), color}, {at(ray + 0.55), {0.75f, 0.2f, 0.35f}}});
    }
    const uint32_t drawRays = record.pipeline(record.vertex(kColorVertexGlsl), record.fragment(kColorFragmentGlsl))
                                  .binding(sizeof(ColorVertex))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(ColorVertex, position))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(ColorVertex, color));
    const Mesh cube = cubeMesh();
    PipelineRecorder drawCube = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Constants { mat4 camera; } push;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec2 vUv;
layout(location = 1) flat out float shade;
void main() {
    gl_Position = push.camera * vec4(position, 1.0);
    vUv = uv;
    shade = 0.7 + 0.3 * dot(normal, vec3(0.36, 0.8, 0.48));
}
)"),
                                                record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D inner;
layout(location = 0) in vec2 vUv;
layout(location = 1) flat in float shade;
layout(location = 0) out vec4 color;
void main() { color = vec4(texture(inner, vUv).rgb * shade, 1.0); }
)"));
    solidVertices(drawCube)
        .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
        .depth(VK_COMPARE_OP_LESS)
        .pushConstants(sizeof(glm::mat4));
    const uint32_t rayBuffer = record.vertexBuffer("rays", rays);
    const uint32_t cubeBuffer = record.vertexBuffer("cube", cube.vertices);
    const uint32_t cubeIndices = record.indexBuffer("cube indices", cube.indices);
    record.pass(kInner).color(inner, {0.16f, 0.2f, 0.34f, 1});
    record.draw(drawRays, static_cast<uint32_t>(rays.size())).vertices(rayBuffer);
    record.pass(kSceneExtent).color(target, {0.9f, 0.89f, 0.85f, 1}).depthStencil(depth);
    record.draw(drawCube, static_cast<uint32_t>(cube.indices.size()))
        .vertices(cubeBuffer)
        .indices(cubeIndices, VK_INDEX_TYPE_UINT16)
        .texture(0, inner, record.sampler(VK_FILTER_LINEAR))
        .push(cameraMatrix({2.4, 2.1, 3.3}, {0, 0, 0}, 45, 1, 1, 10));
    record.output(target);
    record.output(inner);
    return record.finish();
}

Result<Scene> shadow_map() {
    constexpr VkExtent2D kMap{256, 256};
    SceneRecorder record(
        "shadow_map",
        "A depth-only pass with a slope-scaled depth bias from the light; the second compares against it "
        "through a comparison sampler.");
    const uint32_t map =
        record.depthTarget("map", VK_FORMAT_D32_SFLOAT, kMap, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    Mesh mesh = cubeMesh();
    const auto cubeCount = static_cast<uint32_t>(mesh.indices.size());
    const auto floorBase = static_cast<uint16_t>(mesh.vertices.size());
    for (const glm::vec2 corner : {glm::vec2(-6, 6), glm::vec2(6, 6), glm::vec2(6, -6), glm::vec2(-6, -6)}) {
        mesh.vertices.push_back({{corner.x, 0, corner.y}, {0, 1, 0}, corner});
    }
    for (const int corner : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(static_cast<uint16_t>(floorBase + corner));
    struct Constants {
        glm::vec4 placement;  // centre and half size
        glm::vec4 color;      // alpha: how far the object is turned, as the sine of the angle
    };
    struct Frame {
        glm::mat4 camera, light;
        glm::vec4 toLight;
    };
    constexpr const char* kShared = R"(#version 450
layout(binding = 0) uniform Frame {
    mat4 camera;
    mat4 light;
    vec4 toLight;
} frame;
layout(push_constant) uniform Constants {
    vec4 placement;
    vec4 color;
} push;
vec3 turn(vec3 v) {
    float s = push.color.a;
    float c = sqrt(1.0 - s * s);
    return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}
vec3 place(vec3 position) { return turn(position) * push.placement.w + push.placement.xyz; }
)";
    PipelineRecorder fillMap = record.pipeline(record.vertex(std::string(kShared) + R"(
layout(location = 0) in vec3 position;
void main() { gl_Position = frame.light * vec4(place(position), 1.0); }
)"),
                                               kNone);
    solidVertices(fillMap).depth(VK_COMPARE_OP_LESS).depthBias(2, 2.5f).pushConstants(sizeof(Constants));
    PipelineRecorder draw = record.pipeline(record.vertex(std::string(kShared) + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 vNormal;
layout(location = 1) out vec3 vShadow;
void main() {
    vec3 world = place(position);
    gl_Position = frame.camera * vec4(world, 1.0);
    vec4 lit = frame.light * vec4(world, 1.0);
    vShadow = vec3(lit.xy * 0.5 + 0.5, lit.z);
    vNormal = turn(normal);
}
)"),
                                            record.fragment(std::string(kShared) + R"(
layout(binding = 1) uniform sampler2DShadow map;
layout(location = 0) in vec3 vNormal;
layout(location = 1) in vec3 vShadow;
layout(location = 0) out vec4 color;
void main() {
    float facing = max(dot(vNormal, frame.toLight.xyz), 0.0);
    float lit = texture(map, vShadow) * facing;
    color = vec4(push.color.rgb * (0.28 + 0.72 * lit), 1.0);
}
)"));
    solidVertices(draw)
        .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
        .depth(VK_COMPARE_OP_LESS)
        .pushConstants(sizeof(Constants));
    SceneSampler compare;
    compare.addressModeU = compare.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    compare.maxLod = 0;
    compare.compareEnable = true;
    compare.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    const uint32_t sampler = record.sampler(compare);
    const glm::dvec3 light(3.2, 5.1, 2.3);
    const uint32_t frame = record.uniformBuffer("frame", Frame{cameraMatrix({1.2, 3.4, 6.2}, {0, 0.5, 0}, 42, 1, 1, 20),
                                                               orthographicMatrix(light, {0, 0, 0}, 4.2, 0.5, 14),
                                                               glm::vec4(glm::vec3(glm::normalize(light)), 0)});
    const uint32_t vertices = record.vertexBuffer("cube and floor", mesh.vertices);
    const uint32_t indices = record.indexBuffer("indices", mesh.indices);
    const std::array<Constants, 4> cubes{{{{-1.1f, 0.7f, 0.3f, 0.7f}, {0.9f, 0.45f, 0.27f, 0.31f}},
                                          {{0.9f, 0.45f, 1.2f, 0.45f}, {0.96f, 0.78f, 0.35f, -0.2f}},
                                          {{0.7f, 1.0f, -1.2f, 1.0f}, {0.3f, 0.55f, 0.72f, 0.55f}},
                                          {{-1.1f, 1.75f, 0.3f, 0.35f}, {0.45f, 0.68f, 0.42f, -0.5f}}}};
    const Constants floor{{0, 0, 0, 1}, {0.88f, 0.86f, 0.8f, 0}};
    const auto drawAll = [&](uint32_t pipeline, bool shadowed) {
        const auto one = [&](const Constants& constants, uint32_t first, uint32_t count) {
            DrawRecorder each = record.draw(pipeline, count);
            each.first(first)
                .vertices(vertices)
                .indices(indices, VK_INDEX_TYPE_UINT16)
                .uniform(0, frame)
                .push(constants);
            if (shadowed) each.texture(1, map, sampler);
        };
        for (const Constants& cube : cubes) one(cube, 0, cubeCount);
        one(floor, cubeCount, 6);
    };
    record.pass(kMap).depthStencil(map);
    drawAll(fillMap, false);
    record.pass(kSceneExtent).color(target, {0.67f, 0.78f, 0.86f, 1}).depthStencil(depth);
    drawAll(draw, true);
    record.output(target);
    record.output(map);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
