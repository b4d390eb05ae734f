// Textures by filter, upright and to the horizon.
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"

namespace vernier::bench::speed {

using namespace conformance;

namespace {

constexpr uint32_t kSize = 256;

uint32_t checkerTexture(SceneRecorder& record) {
    std::vector<uint32_t> texels(kSize * kSize);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x)
            texels[y * kSize + x] = ((x / 32 + y / 32) % 2 ? 0xFFE0D0C0u : 0xFF305080u) ^ (x * 37 + y * 91) % 16;
    return record.mipmappedTexture("checker", kRgba8, {kSize, kSize}, bytesOf(texels));
}

/// A turned square over the whole target. Level 0 is magnified a little; `spread` > 1 minifies it.
Result<Scene> turned(const char* name, const char* description, VkFilter filter, VkSamplerMipmapMode mips, float maxLod,
                     float spread) {
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t texture = checkerTexture(record);
    SceneSampler sampler;
    sampler.magFilter = sampler.minFilter = filter;
    sampler.mipmapMode = mips;
    sampler.maxLod = maxLod;
    PipelineRecorder pipeline = record.pipeline(record.vertex(R"(#version 450
layout(push_constant) uniform Push { float spread; };
layout(location = 0) out vec2 uv;
void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    uv = mat2(0.921, 0.389, -0.389, 0.921) * corner * vec2(4.0, 3.0) * 0.45 * spread;
    gl_Position = vec4(corner, 0.5, 1.0);
})"),
                                                record.fragment(R"(#version 450
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = texture(image, uv); })"));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP).pushConstants(sizeof(float));
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 4).texture(0, texture, record.sampler(sampler)).push(spread);
    record.output(target);
    return record.finish();
}

}  // namespace

Result<Scene> texture_nearest() {
    return turned("texture_nearest", "A turned texture, nearest texels of level 0.", VK_FILTER_NEAREST,
                  VK_SAMPLER_MIPMAP_MODE_NEAREST, 0, 1);
}

Result<Scene> texture_bilinear() {
    return turned("texture_bilinear", "A turned texture, four texels of level 0.", VK_FILTER_LINEAR,
                  VK_SAMPLER_MIPMAP_MODE_NEAREST, 0, 1);
}

Result<Scene> texture_trilinear() {
    return turned("texture_trilinear", "A turned texture between two levels, eight texels.", VK_FILTER_LINEAR,
                  VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_LOD_CLAMP_NONE, 3);
}

Result<Scene> textured() {
    SceneRecorder record("textured", "A trilinear checkerboard floor to the horizon.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t texture = checkerTexture(record);
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
    record.pass(kSpeedExtent).color(target, {0.2f, 0.3f, 0.5f, 1});
    record.draw(pipeline, 4).texture(0, texture, record.sampler(sampler));
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench::speed
