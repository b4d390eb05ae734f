// What is written how often: fill, overdraw, blending, particles, stencil.
#include <array>
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench::speed {

using namespace conformance;

namespace {

/// 16 opaque quads in their own planes; `nearestFirst` decides in which order they are drawn.
Result<Scene> layers(const char* name, const char* description, bool nearestFirst) {
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSpeedExtent);
    PipelineRecorder pipeline = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Push { float depth; };
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, depth, 1.0);
})"),
                                                record.fragment(R"(#version 450
layout(push_constant) uniform Push { float depth; };
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, depth, 1.0); })"));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP).depth(VK_COMPARE_OP_LESS).pushConstants(sizeof(float));
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1}).depthStencil(depth);
    constexpr int kLayers = 16;
    for (int i = 0; i < kLayers; ++i)
        record.draw(pipeline, 4).push(static_cast<float>(nearestFirst ? i + 1 : kLayers - i) / (kLayers + 1));
    record.output(target);
    return record.finish();
}

}  // namespace

Result<Scene> fill() {
    return fullScreen("fill", "One full-screen quad with interpolated colours.", kGradientFragment, 1);
}

Result<Scene> overdraw() {
    return fullScreen("overdraw", "16 opaque full-screen quads, one over the other.", kGradientFragment, 16);
}

Result<Scene> blending() {
    return fullScreen("blending", "16 translucent full-screen quads.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.5, 0.25); })",
                      16, true);
}

Result<Scene> overdraw_front_to_back() {
    return layers("overdraw_front_to_back", "16 opaque quads with depth test, the nearest first.", true);
}

Result<Scene> overdraw_back_to_front() {
    return layers("overdraw_back_to_front", "16 opaque quads with depth test, the nearest last.", false);
}

Result<Scene> particles() {
    SceneRecorder record("particles", "4096 soft translucent squares of 8 to 40 pixels, textured and blended.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    constexpr uint32_t kParticles = 4096, kSize = 32;
    SceneRandom random(7);
    std::vector<std::array<float, 4>> places(kParticles);  // centre in clip space, half size in pixels, hue
    for (auto& place : places)
        place = {random.between(-1, 1), random.between(-1, 1), random.between(4, 20), random.unit()};
    std::vector<uint32_t> texels(kSize * kSize);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x) {
            const float dx = (static_cast<float>(x) + 0.5f) / 16 - 1, dy = (static_cast<float>(y) + 0.5f) / 16 - 1;
            const float distance = dx * dx + dy * dy, glow = distance < 1 ? (1 - distance) * (1 - distance) : 0;
            texels[y * kSize + x] = static_cast<uint32_t>(glow * 160) << 24 | 0xFFFFFFu;
        }
    const uint32_t texture = record.texture("glow", kRgba8, {kSize, kSize}, {bytesOf(texels)});
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec4 place;
layout(location = 0) out vec2 uv;
layout(location = 1) flat out vec3 tint;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    tint = vec3(1.0, 0.4 + 0.6 * place.w, 0.9 - 0.7 * place.w);
    gl_Position = vec4(place.xy + (uv * 2.0 - 1.0) * place.z / vec2(512.0, 384.0), 0.5, 1.0);
})"),
                                            record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D glow;
layout(location = 0) in vec2 uv;
layout(location = 1) flat in vec3 tint;
layout(location = 0) out vec4 color;
void main() { color = texture(glow, uv) * vec4(tint, 1.0); })"))
                                  .binding(sizeof places[0], VK_VERTEX_INPUT_RATE_INSTANCE)
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, 0)
                                  .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP)
                                  .blend(alphaBlending());
    record.pass(kSpeedExtent).color(target, {0.02f, 0.02f, 0.06f, 1});
    record.draw(pipeline, 4)
        .instances(kParticles)
        .vertices(record.vertexBuffer("places", places))
        .texture(0, texture, record.sampler(VK_FILTER_LINEAR));
    record.output(target);
    return record.finish();
}

Result<Scene> stencil() {
    SceneRecorder record(
        "stencil", "A star of 64 triangles that flips the stencil buffer seven times, then shading where it is odd.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT_S8_UINT, kSpeedExtent);
    VkStencilOpState count{};
    count.failOp = count.depthFailOp = VK_STENCIL_OP_KEEP;
    count.passOp = VK_STENCIL_OP_INVERT;
    count.compareOp = VK_COMPARE_OP_ALWAYS;
    count.compareMask = count.writeMask = 1;
    VkStencilOpState odd = count;
    odd.passOp = VK_STENCIL_OP_KEEP;
    odd.compareOp = VK_COMPARE_OP_EQUAL;
    odd.reference = 1;
    constexpr const char* kNothing = R"(#version 450
void main() {})";
    const uint32_t mark = record
                              .pipeline(record.vertex(R"(#version 450
void main() {
    int ray = gl_VertexIndex / 3, corner = gl_VertexIndex % 3;
    float angle = (float(ray) * 5.0 + (corner == 1 ? 0.0 : 9.0)) * 0.0981748 + float(gl_InstanceIndex) * 0.01;
    gl_Position = vec4(corner == 0 ? vec2(0.0) : vec2(cos(angle), sin(angle)) * 0.98, 0.5, 1.0);
})"),
                                        record.fragment(kNothing))
                              .writeMask(0)
                              .stencil(count, count);
    const uint32_t shade = record.pipeline(record.vertex(kQuadVertex), record.fragment(kGradientFragment))
                               .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP)
                               .stencil(odd, odd);
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1}).depthStencil(depth);
    record.draw(mark, 64 * 3).instances(7);
    record.draw(shade, 4);
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench::speed
