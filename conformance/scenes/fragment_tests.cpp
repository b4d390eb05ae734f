// Scenes about what keeps a fragment from the target: scissor, viewport, depth, stencil, discard, sample
// coverage.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr double kTau = 6.283185307179586476925;

glm::vec2 onCircle(double turns, double radius) {
    return glm::vec2(glm::dvec2(std::cos(kTau * turns), std::sin(kTau * turns)) * radius);
}

/// Triangles around the middle, `count` sails of two colours, reaching a little beyond the viewport.
std::vector<DepthColorVertex> pinwheel(int count, double radius, float z) {
    std::vector<DepthColorVertex> vertices;
    for (int i = 0; i < count; ++i) {
        const double turns = (i + 0.11) / count;
        const auto share = static_cast<float>(i) / static_cast<float>(count);
        const glm::vec3 color(0.95f - 0.7f * share, 0.35f + 0.3f * share, 0.3f + 0.55f * share);
        vertices.push_back({{0.02f, -0.03f, z}, color * 0.35f});
        vertices.push_back({{onCircle(turns, radius), z}, color});
        vertices.push_back({{onCircle(turns + 0.62 / count, radius), z}, color * 0.8f});
    }
    return vertices;
}

}  // namespace

Result<Scene> scissor_viewport() {
    constexpr VkExtent2D kExtent{251, 255};
    SceneRecorder record("scissor_viewport",
                         "One pinwheel in nine views: small and fractional viewports, negative height, a "
                         "reversed depth range, "
                         "and scissors down to one pixel and to nothing; 251 x 255 pixels.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent);
    std::vector<DepthColorVertex> vertices = pinwheel(7, 1.25, 0.5f);
    // A mark that tells up from down.
    const glm::vec3 mark(0.98f, 0.97f, 0.9f);
    vertices.insert(vertices.end(),
                    {{{-0.2f, -0.5f, 0.4f}, mark}, {{0.2f, -0.5f, 0.4f}, mark}, {{0, -0.9f, 0.4f}, mark}});
    const auto count = static_cast<uint32_t>(vertices.size());
    const uint32_t buffer = record.vertexBuffer("pinwheel", vertices);
    const uint32_t less = depthColorPipeline(record).depth(VK_COMPARE_OP_LESS);
    const uint32_t always = depthColorPipeline(record).depth(VK_COMPARE_OP_ALWAYS);
    record.pass(kExtent).color(target, {0.13f, 0.14f, 0.17f, 1}).depthStencil(depth);
    const auto view = [&](uint32_t which) { return record.draw(which, count).vertices(buffer); };
    view(less).viewport(0, 0, 83, 85).scissor(0, 0, 83, 85);
    view(less).viewport(84, 0, 83, 85, 0.2f, 0.6f).scissor(94, 10, 63, 65);
    view(less).viewport(168, 85, 83, -85).scissor(168, 0, 83, 85);  // upside down
    view(less).viewport(0.5f, 85.25f, 82.3f, 84.9f).scissor(0, 85, 83, 85);
    view(always).viewport(84, 85, 83, 85, 1, 0).scissor(84, 85, 83, 85);  // near is 1, far is 0
    view(less).viewport(168, 85, 83, 85).scissor(209, 120, 1, 50);
    view(less).viewport(168, 85, 83, 85).scissor(180, 127, 60, 1);
    view(less).viewport(168, 85, 83, 85).scissor(200, 100, 0, 0);
    view(less).viewport(0, 170, 40, 85).scissor(0, 170, 83, 85);       // cut at the view volume, not by the scissor
    view(less).viewport(-40, 200, 250, 250).scissor(84, 170, 83, 85);  // partly off the target
    view(less).viewport(168, 170, 83, 42.5f).scissor(168, 170, 83, 42);
    view(less).viewport(168, 255, 83, -42.5f).scissor(168, 213, 83, 42);
    record.output(target);
    record.output(depth);
    return record.finish();
}

Result<Scene> depth_intersect() {
    SceneRecorder record("depth_intersect",
                         "Three leaning sheets cut through one another; the depth test decides every pixel, then a "
                         "GREATER pass without depth writes tints what lies behind a fourth.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    std::vector<DepthColorVertex> vertices;
    const std::array<glm::vec3, 3> colors{{{0.95f, 0.4f, 0.3f}, {0.98f, 0.8f, 0.3f}, {0.25f, 0.6f, 0.85f}}};
    for (int sheet = 0; sheet < 3; ++sheet) {
        const double turns = sheet / 3.0 + 0.03;
        const glm::vec2 along = onCircle(turns, 0.95), across = onCircle(turns + 0.25, 0.3);
        const glm::vec3 color = colors[static_cast<size_t>(sheet)];
        const DepthColorVertex a{{-along - across, 0.13f}, color}, b{{-along + across, 0.17f}, color * 0.85f};
        const DepthColorVertex c{{along - across, 0.91f}, color * 0.4f}, d{{along + across, 0.87f}, color * 0.3f};
        vertices.insert(vertices.end(), {a, b, c, c, b, d});
    }
    const glm::vec3 tint(0.85f, 0.95f, 0.9f);
    vertices.insert(vertices.end(),
                    {{{-0.6f, -0.6f, 0.35f}, tint}, {{0.9f, 0.0f, 0.6f}, tint}, {{-0.4f, 0.8f, 0.45f}, tint}});
    const uint32_t less = depthColorPipeline(record).depth(VK_COMPARE_OP_LESS);
    VkPipelineColorBlendAttachmentState half{};
    half.blendEnable = VK_TRUE;
    half.srcColorBlendFactor = VK_BLEND_FACTOR_CONSTANT_COLOR;
    half.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR;
    half.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    half.colorWriteMask = 0xf;
    const uint32_t greater = depthColorPipeline(record)
                                 .depth(VK_COMPARE_OP_GREATER, false)
                                 .blend(half)
                                 .blendConstants({0.5f, 0.5f, 0.5f, 0.5f});
    const uint32_t buffer = record.vertexBuffer("sheets", vertices);
    record.pass(kSceneExtent).color(target, {0.08f, 0.09f, 0.13f, 1}).depthStencil(depth);
    record.draw(less, 18).vertices(buffer);
    record.draw(greater, 3).first(18).vertices(buffer);
    record.output(target);
    record.output(depth);
    return record.finish();
}

Result<Scene> stencil_winding() {
    SceneRecorder record(
        "stencil_winding",
        "Two-sided stencil operations count how often a self-crossing star winds around each pixel; further "
        "passes paint by count, with compare and write masks.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t stencil = record.depthTarget("stencil", VK_FORMAT_D32_SFLOAT_S8_UINT, kSceneExtent);
    const auto op = [](VkCompareOp compare, VkStencilOp pass, uint32_t reference, uint32_t compareMask,
                       uint32_t writeMask) {
        return VkStencilOpState{VK_STENCIL_OP_KEEP, pass,      VK_STENCIL_OP_KEEP, compare,
                                compareMask,        writeMask, reference};
    };
    // A {7/3} star and a ring wound the other way, as fans from a point outside: only the winding matters.
    std::vector<DepthColorVertex> star;
    const glm::vec3 anchor(-0.97f, -0.91f, 0.5f), none(0);
    const auto fan = [&](auto pointAt, int count) {
        for (int i = 0; i < count; ++i) {
            star.push_back({anchor, none});
            star.push_back({{pointAt(i), 0.5f}, none});
            star.push_back({{pointAt(i + 1), 0.5f}, none});
        }
    };
    fan([](int i) { return onCircle(-3.0 * i / 7 - 0.25, 0.94); }, 7);
    fan([](int i) { return onCircle(i / 24.0, 0.17); }, 24);
    std::vector<DepthColorVertex> cover;
    const std::array<glm::vec3, 4> palette{
        {{0.95f, 0.75f, 0.25f}, {0.93f, 0.45f, 0.3f}, {0.72f, 0.2f, 0.4f}, {0.25f, 0.65f, 0.7f}}};
    for (const glm::vec3 color : palette) {
        cover.insert(cover.end(), {{{-1, -1, 0}, color}, {{3, -1, 0}, color * 0.6f}, {{-1, 3, 0}, color * 0.8f}});
    }
    constexpr uint32_t kCountBits = 0x0f, kMarkBit = 0x80;
    const uint32_t count = depthColorPipeline(record)
                               .stencil(op(VK_COMPARE_OP_ALWAYS, VK_STENCIL_OP_INCREMENT_AND_WRAP, 0, 0xff, kCountBits),
                                        op(VK_COMPARE_OP_ALWAYS, VK_STENCIL_OP_DECREMENT_AND_WRAP, 0, 0xff, kCountBits))
                               .writeMask(0);
    const uint32_t starBuffer = record.vertexBuffer("star", star);
    const uint32_t coverBuffer = record.vertexBuffer("cover", cover);
    std::vector<uint32_t> paints;
    for (const uint32_t winding : {1u, 2u, 3u}) {
        const VkStencilOpState equal = op(VK_COMPARE_OP_EQUAL, VK_STENCIL_OP_INVERT, winding, kCountBits, kMarkBit);
        paints.push_back(depthColorPipeline(record).stencil(equal, equal));
    }
    // Whatever was not marked by the passes before, in a lower half only.
    const VkStencilOpState unmarked = op(VK_COMPARE_OP_NOT_EQUAL, VK_STENCIL_OP_KEEP, kMarkBit, kMarkBit, 0);
    const uint32_t rest = depthColorPipeline(record).stencil(unmarked, unmarked);
    record.pass(kSceneExtent).color(target, {0.1f, 0.12f, 0.16f, 1}).depthStencil(stencil);
    record.draw(count, static_cast<uint32_t>(star.size())).vertices(starBuffer);
    for (uint32_t i = 0; i < paints.size(); ++i) record.draw(paints[i], 3).first(3 * i).vertices(coverBuffer);
    record.draw(rest, 3).first(9).vertices(coverBuffer).scissor(0, 176, 256, 64);
    record.output(target);
    return record.finish();
}

Result<Scene> alpha_test() {
    SceneRecorder record("alpha_test",
                         "Three tilted sheets of leaves in front of one another: discard cuts them out, and what is "
                         "discarded writes no depth.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D16_UNORM, kSceneExtent);
    struct LeafVertex {
        glm::vec4 position;
        glm::vec2 uv;
        glm::vec3 color;
    };
    std::vector<LeafVertex> vertices;
    const std::array<glm::vec3, 3> colors{{{0.86f, 0.42f, 0.2f}, {0.45f, 0.65f, 0.28f}, {0.16f, 0.4f, 0.36f}}};
    for (int sheet = 0; sheet < 3; ++sheet) {  // front to back
        const auto i = static_cast<float>(sheet);
        const glm::vec2 shift(0.13f * i - 0.1f, 0.1f - 0.09f * i);
        const glm::vec3 color = colors[static_cast<size_t>(sheet)];
        const auto corner = [&](float x, float y, float w, float z) {
            const glm::vec2 uv = glm::vec2(x, y) * (2.4f + i) + shift * 7.0f;
            return LeafVertex{{(glm::vec2(x, y) * 0.9f + shift) * w, z * w, w}, uv, color};
        };
        const LeafVertex a = corner(-1, -1, 1.6f, 0.5f + 0.2f * i), b = corner(1, -1, 1.9f, 0.55f + 0.2f * i);
        const LeafVertex c = corner(-1, 1, 1, 0.25f + 0.2f * i), d = corner(1, 1, 1.1f, 0.3f + 0.2f * i);
        vertices.insert(vertices.end(), {a, b, c, c, b, d});
    }
    const uint32_t leaves = record
                                .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec3 color;
layout(location = 0) out vec2 vUv;
layout(location = 1) out vec3 vColor;
void main() {
    gl_Position = position;
    vUv = uv;
    vColor = color;
}
)"),
                                          record.fragment(R"(#version 450
layout(location = 0) in vec2 vUv;
layout(location = 1) in vec3 vColor;
layout(location = 0) out vec4 color;
void main() {
    vec2 p = fract(vUv) * 2.0 - 1.0;
    float edge = 0.85 - p.y * p.y - 1.5 * abs(p.x);
    if (edge < 0.0) discard;
    float vein = abs(p.x) < 0.05 ? 0.72 : 1.0;
    color = vec4(vColor * vein * (0.62 + 0.48 * edge), 1.0);
}
)"))
                                .binding(sizeof(LeafVertex))
                                .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(LeafVertex, position))
                                .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(LeafVertex, uv))
                                .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(LeafVertex, color))
                                .depth(VK_COMPARE_OP_LESS);
    const uint32_t buffer = record.vertexBuffer("sheets", vertices);
    record.pass(kSceneExtent).color(target, {0.93f, 0.92f, 0.86f, 1}).depthStencil(depth);
    record.draw(leaves, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(target);
    return record.finish();
}

Result<Scene> msaa_resolve() {
    constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT;
    SceneRecorder record(
        "msaa_resolve",
        "Thin spokes and a depth-tested disc with four samples a pixel at the standard positions, resolved "
        "by averaging.");
    const uint32_t multisampled = record.colorTarget("multisampled", kRgba8, kSceneExtent, kSamples);
    const uint32_t resolved = record.colorTarget("resolved", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent, kSamples);
    std::vector<DepthColorVertex> vertices;
    constexpr int kSpokes = 23;
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
        const double turns = (spoke + 0.37) / kSpokes;
        const glm::vec3 color = spoke % 2 == 0 ? glm::vec3(0.96f, 0.66f, 0.24f) : glm::vec3(0.3f, 0.7f, 0.83f);
        vertices.push_back({{0.013f, -0.021f, 0.3f}, color});
        vertices.push_back({{onCircle(turns - 0.004, 0.96), 0.5f}, color});
        vertices.push_back({{onCircle(turns + 0.004, 0.96), 0.5f}, color});
    }
    constexpr int kRim = 40;
    for (int i = 0; i < kRim; ++i) {  // a disc that leans through the spokes
        const auto rim = [&](int at) {
            const glm::vec2 p = onCircle(static_cast<double>(at % kRim) / kRim, 0.55);
            return DepthColorVertex{{p, 0.4f + 0.3f * p.x}, {0.35f + 0.3f * p.y, 0.16f, 0.34f}};
        };
        const DepthColorVertex center{{0, 0, 0.4f}, {0.62f, 0.2f, 0.4f}};
        vertices.insert(vertices.end(), {center, rim(i), rim(i + 1)});
    }
    const uint32_t state = depthColorPipeline(record).depth(VK_COMPARE_OP_LESS).samples(kSamples);
    const uint32_t buffer = record.vertexBuffer("wheel", vertices);
    record.pass(kSceneExtent).color(multisampled, {0.05f, 0.07f, 0.11f, 1}, resolved).depthStencil(depth);
    record.draw(state, static_cast<uint32_t>(vertices.size())).vertices(buffer);
    record.output(resolved);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
