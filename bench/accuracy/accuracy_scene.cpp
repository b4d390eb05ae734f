#include "bench/accuracy/accuracy_scene.h"

#include <vector>

#include "conformance/scenes/recorder.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr VkFormat kCountFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Corners of the cells of a grid over [0, 1]^2. Inner corners are moved, so that no edge lies on the pixel grid, all
/// cells that meet at a corner by the same amount: the mesh stays a partition. All numbers are multiples of 2^-14: they
/// are exact in float, whatever an implementation does.
constexpr const char* kMeshGlsl = R"(#version 450
layout(push_constant) uniform Push { vec2 size; ivec2 cells; };  // of the target in pixels; of the grid
const ivec2 kCorners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
int cornerHash(ivec2 c) { return ((c.x * 7919 + c.y * 104729) ^ (c.x * c.y * 31)) & 1023; }
ivec2 cornerCell() { int cell = gl_VertexIndex / 6; return ivec2(cell % cells.x, cell / cells.x) + kCorners[gl_VertexIndex % 6]; }
bool isInner(ivec2 c) { return c.x > 0 && c.y > 0 && c.x < cells.x && c.y < cells.y; }
// cells.x and cells.y are powers of two up to 1024; moves by up to 1/4 of a cell: by more, triangles turn over.
vec2 cornerPlace(ivec2 c) {
    vec2 place = vec2(c);
    if (isInner(c)) place += (vec2(cornerHash(c) & 31, cornerHash(c) >> 5) - 15.5) / 64.0;
    return place / vec2(cells) * 2.0 - 1.0;
}
)";
constexpr const char* kFragmentGlsl = R"(#version 450
layout(push_constant) uniform Push { vec2 size; ivec2 cells; };
)";
constexpr const char* kCountFragment = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0); }
)";

struct Push {
    float size[2];
    int32_t cells[2];
};

uint32_t addTexture(SceneRecorder& record, SceneTexture texture) {
    if (texture == SceneTexture::ramp) {
        const std::vector<uint32_t> texels{0xFF000000u, 0xFF40FF20u, 0xFFC02080u, 0xFFFFFFFFu};
        return record.texture("ramp", VK_FORMAT_R8G8B8A8_UNORM, {4, 1}, {bytesOf(texels)});
    }
    constexpr uint32_t kSize = 64;
    std::vector<uint32_t> texels(size_t{kSize} * kSize);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x)
            texels[y * kSize + x] = ((x / 8 + y / 8) % 2 ? 0xFFE0D0C0u : 0xFF305080u) ^ (x * 37 + y * 91) % 16;
    return record.mipmappedTexture("checker", VK_FORMAT_R8G8B8A8_UNORM, {kSize, kSize}, bytesOf(texels));
}

VkPipelineColorBlendAttachmentState blending(VkBlendFactor source, VkBlendFactor destination) {
    return {VK_TRUE,
            source,
            destination,
            VK_BLEND_OP_ADD,
            source,
            destination,
            VK_BLEND_OP_ADD,
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
}

}  // namespace

std::string variantName(const AccuracyScene& scene, SceneUse use) {
    constexpr const char* kSuffixes[] = {"", ":timed", ":counted"};
    return std::string(scene.name) + kSuffixes[static_cast<size_t>(use)];
}

Result<Scene> accuracySceneNamed(std::string_view name) {
    for (const AccuracyScene& scene : accuracySceneTable())
        for (const SceneUse use : {SceneUse::judged, SceneUse::timed, SceneUse::counted})
            if (variantName(scene, use) == name) return buildAccuracyScene(scene, use);
    return invalidArgument("no accuracy scene is called '" + std::string(name) + "'");
}

Result<Scene> buildAccuracyScene(const AccuracyScene& scene, SceneUse use) {
    const bool counted = use == SceneUse::counted;
    const VkExtent2D extent = use == SceneUse::timed ? scene.timed : scene.judged;
    const uint32_t more = use == SceneUse::timed ? scene.timedCells : 1;
    const uint32_t cellsX = scene.cellsX * more, cellsY = scene.cellsY * more;
    SceneRecorder record(variantName(scene, use), scene.description);
    const uint32_t target = record.colorTarget("color", counted ? kCountFormat : scene.format, extent);
    const bool depth = scene.depth && !counted, textured = scene.texture != SceneTexture::none && !counted;
    const uint32_t depthTarget = depth ? record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, extent) : kNone;
    const uint32_t texture = textured ? addTexture(record, scene.texture) : kNone;
    PipelineRecorder pipeline =
        record.pipeline(record.vertex(std::string(kMeshGlsl) + scene.vertex),
                        record.fragment(counted ? kCountFragment : std::string(kFragmentGlsl) + scene.fragment));
    pipeline.pushConstants(sizeof(Push));
    if (counted)
        pipeline.blend(blending(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE));
    else if (scene.blend)
        pipeline.blend(blending(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA));
    if (depth) pipeline.depth(VK_COMPARE_OP_GREATER);
    PassRecorder pass = record.pass(extent);
    pass.color(target, {0, 0, 0, counted ? 0.0f : 1.0f});
    if (depth) pass.depthStencil(depthTarget, 0);
    const Push push{{static_cast<float>(extent.width), static_cast<float>(extent.height)},
                    {static_cast<int32_t>(cellsX), static_cast<int32_t>(cellsY)}};
    DrawRecorder draw = record.draw(pipeline, cellsX * cellsY * 6);
    draw.instances(scene.instances).push(push);
    if (textured) {
        SceneSampler sampler;
        sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
        sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        sampler.maxAnisotropy = scene.anisotropy;
        if (scene.texture == SceneTexture::ramp)
            sampler.addressModeU = sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        draw.texture(0, texture, record.sampler(sampler));
    }
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench
