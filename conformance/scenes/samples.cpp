// Scenes about several samples a pixel: counts, positions of one's own, shading of samples, centroids, and alpha as
// coverage.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>
#include <functional>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkExtent2D kExtent{128, 128};
constexpr VkSampleCountFlagBits kFour = VK_SAMPLE_COUNT_4_BIT;
constexpr double kTau = 6.283185307179586476925;
constexpr std::array<float, 4> kDark{0.07f, 0.08f, 0.11f, 1};

/// Thin blades around the middle.
std::vector<ColorVertex> blades(int count) {
    const auto at = [](double turns, double radius) {
        return glm::vec2(glm::dvec2(std::cos(kTau * turns), std::sin(kTau * turns)) * radius);
    };
    std::vector<ColorVertex> vertices;
    for (int i = 0; i < count; ++i) {
        const double turns = (i + 0.29) / count;
        const float share = static_cast<float>(i) / static_cast<float>(count);
        vertices.push_back({{0.02f, -0.01f}, {0.98f, 0.95f, 0.8f}});
        vertices.push_back({at(turns, 0.97), {0.9f - 0.6f * share, 0.5f, 0.35f + 0.5f * share}});
        vertices.push_back({at(turns + 0.5 / count, 0.95), {0.3f, 0.9f - 0.4f * share, 0.6f}});
    }
    return vertices;
}

PipelineRecorder bladePipeline(SceneRecorder& record, VkSampleCountFlagBits samples,
                               const char* vertexGlsl = kColorVertexGlsl,
                               const char* fragmentGlsl = kColorFragmentGlsl) {
    return record.pipeline(record.vertex(vertexGlsl), record.fragment(fragmentGlsl))
        .binding(sizeof(ColorVertex))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(ColorVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(ColorVertex, color))
        .samples(samples);
}

/// The blades through one pipeline into samples, resolved.
Result<Scene> resolvedBlades(SceneRecorder& record, VkSampleCountFlagBits samples, int count,
                             const std::function<void(PipelineRecorder&)>& change,
                             const char* vertexGlsl = kColorVertexGlsl, const char* fragmentGlsl = kColorFragmentGlsl) {
    const uint32_t multisampled = record.colorTarget("samples", kRgba8, kExtent, samples);
    const uint32_t resolved = record.colorTarget("resolved", kRgba8, kExtent);
    const auto vertices = blades(count);
    PipelineRecorder state = bladePipeline(record, samples, vertexGlsl, fragmentGlsl);
    change(state);
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    record.pass(kExtent).color(multisampled, kDark, resolved);
    record.draw(state, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(resolved);
    return record.finish();
}

}  // namespace

Result<Scene> sample_counts() {
    SceneRecorder record("sample_counts", "Blades with 2, 8 and 16 samples a pixel, each resolved into its picture.");
    const auto vertices = blades(19);
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    for (const VkSampleCountFlagBits samples : {VK_SAMPLE_COUNT_2_BIT, VK_SAMPLE_COUNT_8_BIT, VK_SAMPLE_COUNT_16_BIT}) {
        const uint32_t multisampled = record.colorTarget("samples", kRgba8, kExtent, samples);
        const uint32_t resolved = record.colorTarget("resolved", kRgba8, kExtent);
        const uint32_t state = bladePipeline(record, samples);
        record.pass(kExtent).color(multisampled, kDark, resolved);
        record.draw(state, static_cast<uint32_t>(vertices.size())).vertices(buffer);
        record.output(resolved);
    }
    return record.finish();
}

Result<Scene> sample_locations() {
    SceneRecorder record("sample_locations", "Blades with four samples at positions of the application's choice.");
    return resolvedBlades(record, kFour, 19, [](PipelineRecorder& state) {
        state.sampleLocations({{0, 0}, {15, 1}, {3, 9}, {8, 15}});
    });
}

namespace {

/// Blades whose colour has stripes finer than a pixel.
constexpr const char* kStripesVertexGlsl = R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
layout(location = 1) out float vStripe;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    vColor = color;
    vStripe = position.x * 90.0 + position.y * 37.0;
}
)";
constexpr const char* kStripesFragmentGlsl = R"(#version 450
layout(location = 0) in vec3 vColor;
layout(location = 1) in float vStripe;
layout(location = 0) out vec4 color;
void main() { color = vec4(vColor * (0.35 + abs(fract(vStripe) - 0.5)), 1.0); }
)";

}  // namespace

Result<Scene> sample_shading() {
    SceneRecorder record(
        "sample_shading",
        "Blades whose colour has stripes finer than a pixel: the fragment shader runs for each of four "
        "samples.");
    return resolvedBlades(
        record, kFour, 9, [](PipelineRecorder& state) { state.sampleShading(1); }, kStripesVertexGlsl,
        R"(#version 450
layout(location = 0) in vec3 vColor;
layout(location = 1) in float vStripe;
layout(location = 0) out vec4 color;
void main() {
    float stripe = abs(fract(vStripe) - 0.5);
    float mark = gl_SampleID == 2 ? 0.8 : 1.0;
    color = vec4(vColor * (0.35 + stripe) * mark, 1.0);
}
)");
}

Result<Scene> sample_shading_partial() {
    SceneRecorder record("sample_shading_partial",
                         "The same stripes, half of four samples asked for: two fragments a pixel, three or four.");
    return resolvedBlades(
        record, kFour, 9, [](PipelineRecorder& state) { state.sampleShading(0.5f); }, kStripesVertexGlsl,
        kStripesFragmentGlsl);
}

Result<Scene> centroid_inputs() {
    SceneRecorder record("centroid_inputs",
                         "A steep input taken at the centroid: at the rims of blades it stays inside of them.");
    return resolvedBlades(
        record, kFour, 15, [](PipelineRecorder&) {}, R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 color;
layout(location = 0) centroid out vec3 vColor;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    vColor = color;
}
)",
        R"(#version 450
layout(location = 0) centroid in vec3 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(vColor, 1.0); }
)");
}

namespace {

constexpr const char* kAlphaFragmentGlsl = R"(#version 450
layout(location = 0) in vec3 vColor;
layout(location = 0) out vec4 color;
void main() {
    float x = gl_FragCoord.x;
    color = vec4(vColor, x < 48.0 ? 0.0 : x > 80.0 ? 1.0 : 0.5);
}
)";

}  // namespace

Result<Scene> alpha_to_coverage() {
    SceneRecorder record(
        "alpha_to_coverage",
        "Blades with alpha 0, a half and 1 from left to right, which become none, some and all of four "
        "samples.");
    return resolvedBlades(
        record, kFour, 9, [](PipelineRecorder& state) { state.alphaToCoverage(); }, kColorVertexGlsl,
        kAlphaFragmentGlsl);
}

Result<Scene> alpha_to_one() {
    SceneRecorder record("alpha_to_one", "Blades whose alpha becomes 1 before they are blended.");
    return resolvedBlades(
        record, kFour, 9,
        [](PipelineRecorder& state) {
            VkPipelineColorBlendAttachmentState over{};
            over.blendEnable = VK_TRUE;
            over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
            over.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
            over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
            over.colorWriteMask = 0xf;
            state.alphaToOne().blend(over);
        },
        kColorVertexGlsl, kAlphaFragmentGlsl);
}

namespace {

/// Blades leaning through depth, which leave their number in the stencil of the samples they win.
void drawLeaning(SceneRecorder& record, const std::vector<DepthColorVertex>& vertices, uint32_t buffer) {
    for (uint32_t first = 0; first < vertices.size(); first += 3) {
        VkStencilOpState replace{};
        replace.passOp = VK_STENCIL_OP_REPLACE;
        replace.compareOp = VK_COMPARE_OP_ALWAYS;
        replace.compareMask = replace.writeMask = 0xff;
        replace.reference = 1 + first / 3;
        const uint32_t state =
            depthColorPipeline(record).samples(kFour).depth(VK_COMPARE_OP_LESS).stencil(replace, replace);
        record.draw(state, 3).vertices(buffer).first(first);
    }
}

std::vector<DepthColorVertex> leaningBlades() {
    std::vector<DepthColorVertex> vertices;
    for (const ColorVertex& vertex : blades(5)) {
        const float depth = 0.5f + 0.4f * std::sin(3.0f * vertex.position.x + 5.0f * vertex.position.y);
        vertices.push_back({{vertex.position * 1.2f, depth}, vertex.color});
    }
    return vertices;
}

constexpr VkFormat kDepthStencil = VK_FORMAT_D32_SFLOAT_S8_UINT;

}  // namespace

Result<Scene> depth_stencil_resolve() {
    SceneRecorder record("depth_stencil_resolve",
                         "Depth and stencil of four samples resolved to their first one; a second pass shows where the "
                         "stencil holds odd numbers.");
    const uint32_t samples = record.colorTarget("samples", kRgba8, kExtent, kFour);
    const uint32_t color = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t deep = record.depthTarget("depth of samples", kDepthStencil, kExtent, kFour);
    const uint32_t resolved = record.depthTarget("depth", kDepthStencil, kExtent);
    const auto vertices = leaningBlades();
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    record.pass(kExtent)
        .color(samples, kDark, color)
        .depthStencil(deep)
        .resolveDepthStencil(resolved, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT);
    drawLeaning(record, vertices, buffer);
    VkStencilOpState odd{};
    odd.compareOp = VK_COMPARE_OP_EQUAL;
    odd.compareMask = 1;
    odd.reference = 1;
    const uint32_t tint = record
                              .pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.95, 0.85, 0.2, 1.0); }
)"))
                              .stencil(odd, odd);
    record.pass(kExtent).loadColor(color).loadDepthStencil(resolved);
    record.draw(tint, 3);
    record.output(color);
    record.output(resolved);
    return record.finish();
}

Result<Scene> depth_resolve_modes() {
    SceneRecorder record("depth_resolve_modes",
                         "Depth of four samples resolved to the smallest, the largest and their average, with stencils "
                         "to the smallest, the largest and the first.");
    const uint32_t samples = record.colorTarget("samples", kRgba8, kExtent, kFour);
    const uint32_t color = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t deep = record.depthTarget("depth of samples", kDepthStencil, kExtent, kFour);
    const auto vertices = leaningBlades();
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    const std::array<std::pair<VkResolveModeFlagBits, VkResolveModeFlagBits>, 3> modes{
        {{VK_RESOLVE_MODE_MIN_BIT, VK_RESOLVE_MODE_MIN_BIT},
         {VK_RESOLVE_MODE_MAX_BIT, VK_RESOLVE_MODE_MAX_BIT},
         {VK_RESOLVE_MODE_AVERAGE_BIT, VK_RESOLVE_MODE_SAMPLE_ZERO_BIT}}};
    std::vector<uint32_t> outputs{color};
    for (const auto& [depthMode, stencilMode] : modes) {
        outputs.push_back(record.depthTarget("depth", kDepthStencil, kExtent));
        record.pass(kExtent)
            .color(samples, kDark, color)
            .depthStencil(deep)
            .resolveDepthStencil(outputs.back(), depthMode, stencilMode);
        drawLeaning(record, vertices, buffer);
    }
    for (const uint32_t output : outputs) record.output(output);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
