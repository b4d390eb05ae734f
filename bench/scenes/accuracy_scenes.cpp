#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "conformance/scenes/recorder.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkFormat kFloat = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Interpolation: small triangles far from the framebuffer's origin, a float target so that nothing is hidden.
Result<Scene> farTriangles() {
    SceneRecorder record("far_triangles",
                         "A strip of 8-pixel triangles around x = 4000: interpolation far from the origin.");
    constexpr VkExtent2D kExtent{4096, 16};
    const uint32_t target = record.colorTarget("color", kFloat, kExtent);
    const uint32_t pipeline = record.pipeline(record.vertex(R"(#version 450
layout(location = 0) out vec3 value;
void main() {
    int cell = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    // Eight pixels a cell, sheared so that no edge is aligned with the grid.
    vec2 place = vec2(3840.0 + float(cell) * 8.0, 4.0) + vec2(corner == 1 ? 7.3 : 0.4, corner == 2 ? 9.7 : corner == 1 ? 1.9 : 0.3);
    value = vec3(corner == 0, corner == 1, corner == 2);
    gl_Position = vec4(place / vec2(2048.0, 8.0) - 1.0, 0.5, 1.0);
})"),
                                              record.fragment(R"(#version 450
layout(location = 0) in vec3 value;
layout(location = 0) out vec4 color;
void main() { color = vec4(value, 1.0); })"));
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 30 * 3);
    record.output(target);
    return record.finish();
}

/// Filter weights: a ramp of four texels over 256 pixels.
Result<Scene> magnifiedRamp() {
    SceneRecorder record("magnified_ramp", "A four-texel ramp magnified 64 times: filter weights.");
    constexpr VkExtent2D kExtent{256, 64};
    const uint32_t target = record.colorTarget("color", kFloat, kExtent);
    const std::vector<uint32_t> texels{0xFF000000u, 0xFF40FF20u, 0xFFC02080u, 0xFFFFFFFFu};
    const uint32_t texture = record.texture("ramp", VK_FORMAT_R8G8B8A8_UNORM, {4, 1}, {bytesOf(texels)});
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})"),
                                            record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })"))
                                  .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 4).texture(0, texture, record.sampler(VK_FILTER_LINEAR));
    record.output(target);
    return record.finish();
}

/// Transcendental functions: waves, powers and logarithms that add up visibly.
Result<Scene> transcendental() {
    SceneRecorder record("transcendental", "Sines of large arguments, powers and logarithms per pixel.");
    constexpr VkExtent2D kExtent{128, 128};
    const uint32_t target = record.colorTarget("color", kFloat, kExtent);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})"),
                                            record.fragment(R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    float wave = sin(floor(uv.x * 128.0) * 12.9898 + floor(uv.y * 128.0) * 78.233);
    float gloss = pow(0.25 + 0.75 * uv.x, 8.0 * uv.y + 1.0);
    float decay = exp(-4.0 * uv.x) + log2(1.0 + uv.y);
    color = vec4(wave * 0.5 + 0.5, gloss, decay * 0.5, 1.0);
})"))
                                  .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 4);
    record.output(target);
    return record.finish();
}

constexpr SceneEntry kAccuracyScenes[] = {
    {"far_triangles", farTriangles}, {"magnified_ramp", magnifiedRamp}, {"transcendental", transcendental}};

}  // namespace

std::span<const SceneEntry> accuracyScenes() {
    return kAccuracyScenes;
}

}  // namespace vernier::bench
