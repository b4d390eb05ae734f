#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "conformance/scenes/recorder.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkExtent2D kExtent{1024, 768};
constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

/// Two triangles over the whole target; `uv` runs from 0 to 1.
constexpr const char* kQuadVertex = R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})";

/// A full-screen strip with a fragment shader, drawn `times` times.
Result<Scene> fullScreen(const char* name, const char* description, const char* fragment, uint32_t times,
                         bool blend = false) {
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    PipelineRecorder pipeline = record.pipeline(record.vertex(kQuadVertex), record.fragment(fragment));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    if (blend) {
        VkPipelineColorBlendAttachmentState state{};
        state.blendEnable = VK_TRUE;
        state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        state.colorWriteMask = 0xF;
        pipeline.blend(state);
    }
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    for (uint32_t i = 0; i < times; ++i) record.draw(pipeline, 4);
    record.output(target);
    return record.finish();
}

constexpr const char* kGradient = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.5, 1.0); })";

Result<Scene> fill() {
    return fullScreen("fill", "One full-screen quad with interpolated colours.", kGradient, 1);
}

Result<Scene> overdraw() {
    return fullScreen("overdraw", "16 opaque full-screen quads, one over the other.", kGradient, 16);
}

Result<Scene> blending() {
    return fullScreen("blending", "16 translucent full-screen quads.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.5, 0.25); })",
                      16, true);
}

Result<Scene> arithmetic() {
    return fullScreen("arithmetic", "64 rounds of dependent float arithmetic per pixel.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec4 a = vec4(uv, uv.yx), b = vec4(0.3, 0.5, 0.7, 0.9);
    for (int i = 0; i < 64; ++i) {
        a = a * b + vec4(0.125);
        b = fract(a.wxyz * 1.7 + b * 0.25);
    }
    color = vec4(a.xyz * 0.25 + b.xyz * 0.5, 1.0);
})",
                      1);
}

Result<Scene> divergent() {
    return fullScreen("divergent", "A Julia set: loops of different length in neighbouring pixels.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec2 z = uv * vec2(3.2, 2.4) - vec2(1.6, 1.2);
    int i = 0;
    while (i < 96 && dot(z, z) < 4.0) {
        z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + vec2(-0.79, 0.15);
        ++i;
    }
    float t = float(i) / 96.0;
    color = vec4(t, t * t, sqrt(t), 1.0);
})",
                      1);
}

Result<Scene> lighting() {
    return fullScreen("lighting", "Normalise, three lights with specular powers per pixel.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(vec3(uv * 2.0 - 1.0, 1.0)), eye = vec3(0, 0, 1), sum = vec3(0.05);
    for (int i = 0; i < 3; ++i) {
        vec3 light = normalize(vec3(float(i) - 1.0, 0.5, 1.0));
        vec3 halfway = normalize(light + eye);
        sum += vec3(0.3, 0.25, 0.2) * max(dot(n, light), 0.0) + pow(max(dot(n, halfway), 0.0), 32.0) * 0.3;
    }
    color = vec4(sum, 1.0);
})",
                      1);
}

Result<Scene> smallTriangles() {
    SceneRecorder record("small_triangles", "196608 triangles of two pixels each, with depth test.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent);
    // A grid of cells of 2 x 4 pixels, drawn as one strip per row through an index buffer of triangles.
    constexpr uint32_t kColumns = kExtent.width / 4, kRows = kExtent.height / 2;
    struct Vertex {
        float x, y, z;
        uint32_t color;
    };
    std::vector<Vertex> vertices;
    for (uint32_t y = 0; y <= kRows; ++y)
        for (uint32_t x = 0; x <= kColumns; ++x)
            vertices.push_back({static_cast<float>(x) * 2 / kColumns - 1, static_cast<float>(y) * 2 / kRows - 1, 0.5f,
                                (x * 2654435761u ^ y * 40503u) | 0xFF000000u});
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y < kRows; ++y)
        for (uint32_t x = 0; x < kColumns; ++x) {
            const uint32_t a = y * (kColumns + 1) + x, b = a + kColumns + 1;
            indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 shade;
void main() { gl_Position = vec4(position, 1.0); shade = color; })"),
                                            record.fragment(R"(#version 450
layout(location = 0) in vec4 shade;
layout(location = 0) out vec4 color;
void main() { color = shade; })"))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, x))
                                  .attribute(kRgba8, offsetof(Vertex, color))
                                  .depth(VK_COMPARE_OP_LESS);
    record.pass(kExtent).color(target, {0, 0, 0, 1}).depthStencil(depth);
    record.draw(pipeline, static_cast<uint32_t>(indices.size()))
        .vertices(record.vertexBuffer("grid", vertices))
        .indices(record.indexBuffer("grid indices", indices), VK_INDEX_TYPE_UINT32);
    record.output(target);
    return record.finish();
}

Result<Scene> textured() {
    SceneRecorder record("textured", "A trilinear checkerboard floor to the horizon.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    constexpr uint32_t kSize = 256;
    std::vector<uint32_t> texels(kSize * kSize);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x)
            texels[y * kSize + x] = ((x / 32 + y / 32) % 2 ? 0xFFE0D0C0u : 0xFF305080u) ^ (x * 37 + y * 91) % 16;
    const uint32_t texture = record.mipmappedTexture("checker", kRgba8, {kSize, kSize}, bytesOf(texels));
    SceneSampler sampler;
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) out vec2 uv;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    uv = corner * vec2(40.0, 60.0);
    float w = corner.y < 0.5 ? 1.0 : 30.0;
    gl_Position = vec4((corner.x - 0.5) * 40.0, corner.y < 0.5 ? 1.0 : -0.99 * w, 0.5 * w, w);
})"),
                                            record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })"))
                                  .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP);
    record.pass(kExtent).color(target, {0.2f, 0.3f, 0.5f, 1});
    record.draw(pipeline, 4).texture(0, texture, record.sampler(sampler));
    record.output(target);
    return record.finish();
}

Result<Scene> tinyDraws() {
    SceneRecorder record("tiny_draws", "4096 draws of one small triangle each, with push constants.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    PipelineRecorder pipeline = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Push { vec2 place; };
layout(location = 0) out vec2 shade;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    shade = place;
    gl_Position = vec4(place * 2.0 - 1.0 + corner * 0.02, 0.5, 1.0);
})"),
                                                record.fragment(R"(#version 450
layout(location = 0) in vec2 shade;
layout(location = 0) out vec4 color;
void main() { color = vec4(shade, 0.5, 1.0); })"));
    pipeline.pushConstants(8);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    for (uint32_t i = 0; i < 4096; ++i)
        record.draw(pipeline, 3)
            .push(std::array<float, 2>{static_cast<float>(i % 64) / 64, static_cast<float>(i / 64) / 64});
    record.output(target);
    return record.finish();
}

constexpr SceneEntry kSpeedScenes[] = {
    {"fill", fill},
    {"overdraw", overdraw},
    {"blending", blending},
    {"small_triangles", smallTriangles},
    {"textured", textured},
    {"lighting", lighting},
    {"arithmetic", arithmetic},
    {"divergent", divergent},
    {"tiny_draws", tinyDraws},
    {"raymarch_fragment", raymarchScene},
    {"noise_fragment", noiseScene},
    {"uniform_fragment", uniformScene},
};

}  // namespace

std::span<const SceneEntry> speedScenes() {
    return kSpeedScenes;
}

const SceneEntry* findBenchScene(std::string_view name) {
    for (const std::span<const SceneEntry> list : {speedScenes(), accuracyScenes()})
        for (const SceneEntry& entry : list)
            if (entry.name == name) return &entry;
    return nullptr;
}

}  // namespace vernier::bench
