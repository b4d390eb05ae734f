// Several passes and several samples: shadow map, deferred shading, multisampling.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench::speed {

using namespace conformance;

namespace {

constexpr double kAspect = 1024.0 / 768.0;
constexpr uint32_t kBalls = 49;

PipelineRecorder& meshInput(PipelineRecorder& pipeline) {
    return pipeline.binding(sizeof(SolidVertex))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, normal));
}

/// Balls on a floor, drawn as 49 instances of one mesh and one quad far below; `place` is common to all passes.
constexpr const char* kPlace = R"(#version 450
layout(push_constant) uniform Push { mat4 camera; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
vec3 place(vec3 at) {
    int i = gl_InstanceIndex;
    if (i == 49) return vec3(at.x * 12.0, at.y * 0.05 - 0.05, at.z * 12.0);
    float size = 0.35 + 0.15 * float((i * 7) % 5) / 4.0;
    return at * size + vec3(float(i % 7) - 3.0, size, float(i / 7) - 3.0) * vec3(1.3, 1.0, 1.3);
}
)";

struct Model {
    uint32_t vertices, indices, count;
};

Model ballModel(SceneRecorder& record) {
    const Mesh mesh = sphereMesh(40, 24);
    return {record.vertexBuffer("ball", mesh.vertices), record.indexBuffer("ball indices", mesh.indices),
            static_cast<uint32_t>(mesh.indices.size())};
}

Model floorModel(SceneRecorder& record) {
    const Mesh mesh = cubeMesh();
    return {record.vertexBuffer("floor", mesh.vertices), record.indexBuffer("floor indices", mesh.indices),
            static_cast<uint32_t>(mesh.indices.size())};
}

glm::mat4 eye() {
    return cameraMatrix({2.5, 4.5, 8.5}, {0, 0, 0}, 45, kAspect, 1, 40);
}

glm::mat4 light() {
    return orthographicMatrix({5, 8, 3}, {0, 0, 0}, 7, 1, 20);
}

/// Draws balls and floor with one pipeline.
template <class Finish>
void drawModels(SceneRecorder& record, uint32_t pipeline, const Model& ball, const Model& floor, Finish finish) {
    finish(record.draw(pipeline, ball.count)
               .instances(kBalls)
               .vertices(ball.vertices)
               .indices(ball.indices, VK_INDEX_TYPE_UINT16));
    finish(record.draw(pipeline, floor.count)
               .instances(1, kBalls)
               .vertices(floor.vertices)
               .indices(floor.indices, VK_INDEX_TYPE_UINT16));
}

}  // namespace

Result<Scene> shadow_map() {
    constexpr VkExtent2D kMap{1024, 1024};
    SceneRecorder record("shadow_map", "49 balls: a depth pass of 1024 x 1024, then shading with 3 x 3 comparisons.");
    const uint32_t map =
        record.depthTarget("map", VK_FORMAT_D32_SFLOAT, kMap, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSpeedExtent);
    PipelineRecorder fill = record.pipeline(
        record.vertex(std::string(kPlace) + "void main() { gl_Position = camera * vec4(place(position), 1.0); }"),
        kNone);
    meshInput(fill).depth(VK_COMPARE_OP_LESS).depthBias(2, 2.5f).pushConstants(sizeof(glm::mat4));
    PipelineRecorder shade = record.pipeline(record.vertex(std::string(kPlace) + R"(
layout(set = 0, binding = 0) uniform Light { mat4 light; };
layout(location = 0) out vec3 vNormal;
layout(location = 1) out vec3 vShadow;
void main() {
    vec3 world = place(position);
    gl_Position = camera * vec4(world, 1.0);
    vec3 lit = (light * vec4(world, 1.0)).xyz;
    vShadow = vec3(lit.xy * 0.5 + 0.5, lit.z);
    vNormal = normal;
})"),
                                             record.fragment(R"(#version 450
layout(set = 0, binding = 1) uniform sampler2DShadow map;
layout(location = 0) in vec3 vNormal;
layout(location = 1) in vec3 vShadow;
layout(location = 0) out vec4 color;
void main() {
    float lit = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) lit += texture(map, vShadow + vec3(vec2(x, y) / 1024.0, 0.0));
    float facing = max(dot(normalize(vNormal), vec3(0.505, 0.808, 0.303)), 0.0);
    color = vec4(vec3(0.9, 0.7, 0.5) * (0.25 + facing * lit / 12.0), 1.0);
})"));
    meshInput(shade)
        .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
        .depth(VK_COMPARE_OP_LESS)
        .pushConstants(sizeof(glm::mat4));
    SceneSampler compare;
    compare.magFilter = compare.minFilter = VK_FILTER_LINEAR;
    compare.addressModeU = compare.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    compare.maxLod = 0;
    compare.compareEnable = true;
    compare.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    const uint32_t sampler = record.sampler(compare);
    const uint32_t lightBuffer = record.uniformBuffer("light", light());
    const Model ball = ballModel(record), floor = floorModel(record);
    record.pass(kMap).depthStencil(map);
    drawModels(record, fill, ball, floor, [](DrawRecorder draw) { draw.push(light()); });
    record.pass(kSpeedExtent).color(target, {0.6f, 0.7f, 0.8f, 1}).depthStencil(depth);
    drawModels(record, shade, ball, floor,
               [&](DrawRecorder draw) { draw.push(eye()).uniform(0, lightBuffer).texture(1, map, sampler); });
    record.output(target);
    return record.finish();
}

Result<Scene> deferred() {
    SceneRecorder record("deferred", "49 balls into three targets, then 16 lights per pixel from these.");
    const auto sampled = [&](const char* name, VkFormat format) {
        return record.colorTarget(name, format, kSpeedExtent, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    };
    const std::array targets{sampled("albedo", kRgba8), sampled("normal", VK_FORMAT_R16G16B16A16_SFLOAT),
                             sampled("place", VK_FORMAT_R32G32B32A32_SFLOAT)};
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSpeedExtent);
    PipelineRecorder fill = record.pipeline(record.vertex(std::string(kPlace) + R"(
layout(location = 0) out vec3 vNormal;
layout(location = 1) out vec3 vPlace;
void main() {
    vPlace = place(position);
    vNormal = normal;
    gl_Position = camera * vec4(vPlace, 1.0);
})"),
                                            record.fragment(R"(#version 450
layout(location = 0) in vec3 vNormal;
layout(location = 1) in vec3 vPlace;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 where;
void main() {
    albedo = vec4(fract(vPlace * 0.37) * 0.5 + 0.4, 1.0);
    normal = vec4(normalize(vNormal), 0.0);
    where = vec4(vPlace, 1.0);
})"));
    meshInput(fill)
        .targets(3)
        .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
        .depth(VK_COMPARE_OP_LESS)
        .pushConstants(sizeof(glm::mat4));
    PipelineRecorder lit = record.pipeline(record.vertex(kQuadVertex), record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D albedo;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform sampler2D where;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(where, at, 0);
    vec3 sum = vec3(0.05), n = texelFetch(normal, at, 0).xyz;
    for (int i = 0; i < 16; ++i) {
        vec3 to = vec3(float(i % 4) * 2.6 - 3.9, 1.2, float(i / 4) * 2.6 - 3.9) - here.xyz;
        float square = dot(to, to);
        sum += vec3(0.7, 0.6, 0.5) * (max(dot(n, to), 0.0) * inversesqrt(square) / (0.5 + square));
    }
    color = vec4(texelFetch(albedo, at, 0).rgb * sum * here.w, 1.0);
})"));
    lit.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    const Model ball = ballModel(record), floor = floorModel(record);
    PassRecorder pass = record.pass(kSpeedExtent);
    for (const uint32_t each : targets) pass.color(each, {0, 0, 0, 0});
    pass.depthStencil(depth);
    drawModels(record, fill, ball, floor, [](DrawRecorder draw) { draw.push(eye()); });
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    DrawRecorder draw = record.draw(lit, 4);
    const uint32_t sampler = record.sampler(VK_FILTER_NEAREST);
    for (uint32_t i = 0; i < targets.size(); ++i) draw.texture(i, targets[i], sampler);
    record.output(target);
    return record.finish();
}

Result<Scene> small_passes() {
    constexpr VkExtent2D kSmall{64, 64};
    constexpr uint32_t kPasses = 96;
    SceneRecorder record("small_passes", "96 passes of one ball each to targets of 64 x 64, then all of them on one.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    PipelineRecorder fill = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Push { mat4 camera; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 vNormal;
void main() {
    gl_Position = camera * vec4(position, 1.0);
    vNormal = normal;
})"),
                                            record.fragment(R"(#version 450
layout(location = 0) in vec3 vNormal;
layout(location = 0) out vec4 color;
void main() { color = vec4(normalize(vNormal) * 0.5 + 0.5, 1.0); })"));
    meshInput(fill).cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE).pushConstants(sizeof(glm::mat4));
    PipelineRecorder show = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Push { vec2 place; };
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(place + uv * vec2(2.0 / 12.0, 2.0 / 8.0) - 1.0, 0.5, 1.0);
})"),
                                            record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })"));
    show.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP).pushConstants(8);
    const Model ball = ballModel(record);
    std::vector<uint32_t> images;
    for (uint32_t n = 0; n < kPasses; ++n) {
        const float angle = static_cast<float>(n) * 0.3f;
        images.push_back(record.colorTarget("small " + std::to_string(n), kRgba8, kSmall, VK_SAMPLE_COUNT_1_BIT,
                                            VK_IMAGE_USAGE_SAMPLED_BIT));
        record.pass(kSmall).color(images.back(), {0.1f, 0.1f, 0.1f, 1});
        record.draw(fill, ball.count)
            .vertices(ball.vertices)
            .indices(ball.indices, VK_INDEX_TYPE_UINT16)
            .push(cameraMatrix({std::sin(angle) * 3, 1, std::cos(angle) * 3}, {0, 0, 0}, 45, 1, 1, 10));
    }
    const uint32_t sampler = record.sampler(VK_FILTER_LINEAR);
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    for (uint32_t n = 0; n < kPasses; ++n)
        record.draw(show, 4)
            .push(std::array<float, 2>{static_cast<float>(n % 12) / 6, static_cast<float>(n / 12) / 4})
            .texture(0, images[n], sampler);
    record.output(target);
    return record.finish();
}

Result<Scene> msaa4() {
    SceneRecorder record("msaa4", "49 balls with four samples per pixel, resolved.");
    const uint32_t many = record.colorTarget("samples", kRgba8, kSpeedExtent, VK_SAMPLE_COUNT_4_BIT);
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSpeedExtent, VK_SAMPLE_COUNT_4_BIT);
    PipelineRecorder pipeline = record.pipeline(record.vertex(std::string(kPlace) + R"(
layout(location = 0) out vec3 vNormal;
void main() {
    vNormal = normal;
    gl_Position = camera * vec4(place(position), 1.0);
})"),
                                                record.fragment(R"(#version 450
layout(location = 0) in vec3 vNormal;
layout(location = 0) out vec4 color;
void main() {
    float facing = max(dot(normalize(vNormal), vec3(0.505, 0.808, 0.303)), 0.0);
    color = vec4(vec3(0.9, 0.7, 0.5) * (0.25 + 0.75 * facing), 1.0);
})"));
    meshInput(pipeline)
        .samples(VK_SAMPLE_COUNT_4_BIT)
        .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
        .depth(VK_COMPARE_OP_LESS)
        .pushConstants(sizeof(glm::mat4));
    const Model ball = ballModel(record), floor = floorModel(record);
    record.pass(kSpeedExtent).color(many, {0.6f, 0.7f, 0.8f, 1}, target).depthStencil(depth);
    drawModels(record, pipeline, ball, floor, [](DrawRecorder draw) { draw.push(eye()); });
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench::speed
