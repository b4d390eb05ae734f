// Scenes about what becomes of a colour: blending, sRGB, several targets of several formats.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkColorComponentFlags kAllComponents = 0xf;

struct RgbaVertex {
    glm::vec2 position;
    glm::vec4 color;
};

constexpr const char* kRgbaVertexGlsl = R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 vColor;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    vColor = color;
}
)";
constexpr const char* kRgbaFragmentGlsl = R"(#version 450
layout(location = 0) in vec4 vColor;
layout(location = 0) out vec4 color;
void main() { color = vColor; }
)";

PipelineRecorder rgbaPipeline(SceneRecorder& record, uint32_t vertexShader, uint32_t fragmentShader) {
    return record.pipeline(vertexShader, fragmentShader)
        .binding(sizeof(RgbaVertex))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(RgbaVertex, position))
        .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(RgbaVertex, color));
}

void addQuad(std::vector<RgbaVertex>& list, glm::vec2 low, glm::vec2 high, const std::array<glm::vec4, 4>& corners) {
    const RgbaVertex a{low, corners[0]}, b{{high.x, low.y}, corners[1]};
    const RgbaVertex c{{low.x, high.y}, corners[2]}, d{high, corners[3]};
    list.insert(list.end(), {a, b, c, c, b, d});
}

}  // namespace

Result<Scene> blend_modes() {
    SceneRecorder record("blend_modes",
                         "Twenty-five cells, each a gradient blended over the same background with other factors, "
                         "operations or write masks.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    struct Mode {
        VkBlendFactor source, destination;
        VkBlendOp op;
        VkBlendFactor alphaSource, alphaDestination;
        VkBlendOp alphaOp;
        VkColorComponentFlags mask = kAllComponents;
    };
    constexpr auto kZero = VK_BLEND_FACTOR_ZERO, kOne = VK_BLEND_FACTOR_ONE;
    constexpr std::array<Mode, 25> kModes{{
        {VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, kOne,
         VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD},
        {kOne, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD},
        {kOne, kOne, VK_BLEND_OP_ADD, kOne, kOne, VK_BLEND_OP_ADD},
        {kOne, kOne, VK_BLEND_OP_SUBTRACT, kOne, kZero, VK_BLEND_OP_ADD},
        {kOne, kOne, VK_BLEND_OP_REVERSE_SUBTRACT, kZero, kOne, VK_BLEND_OP_ADD},
        {kOne, kOne, VK_BLEND_OP_MIN, kOne, kOne, VK_BLEND_OP_MAX},
        {kOne, kOne, VK_BLEND_OP_MAX, kOne, kOne, VK_BLEND_OP_MIN},
        {VK_BLEND_FACTOR_DST_COLOR, kZero, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD},
        {kZero, VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_OP_ADD, kZero, kOne, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR, kOne, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD},
        {kOne, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA, VK_BLEND_OP_ADD, kOne, kOne,
         VK_BLEND_OP_SUBTRACT},
        {VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA, VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_OP_ADD, VK_BLEND_FACTOR_DST_ALPHA,
         kZero, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_CONSTANT_COLOR, VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR, VK_BLEND_OP_ADD, kOne, kZero,
         VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_CONSTANT_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA, VK_BLEND_OP_ADD,
         VK_BLEND_FACTOR_CONSTANT_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_SRC_ALPHA_SATURATE, kOne, VK_BLEND_OP_ADD, VK_BLEND_FACTOR_SRC_ALPHA_SATURATE, kOne,
         VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_FACTOR_DST_COLOR, VK_BLEND_OP_ADD, VK_BLEND_FACTOR_SRC_COLOR,
         VK_BLEND_FACTOR_DST_COLOR, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_OP_REVERSE_SUBTRACT, kOne, kZero,
         VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_OP_ADD, kZero, kOne, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_DST_COLOR, VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD},
        {kOne, kZero, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD, VK_COLOR_COMPONENT_R_BIT},
        {VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, kOne, kZero, VK_BLEND_OP_ADD,
         VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT},
        {VK_BLEND_FACTOR_CONSTANT_COLOR, kOne, VK_BLEND_OP_SUBTRACT, kOne, kZero, VK_BLEND_OP_ADD},
        {VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR, VK_BLEND_OP_ADD, kZero, kZero,
         VK_BLEND_OP_ADD},
        {kZero, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD, kZero, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
         VK_BLEND_OP_ADD},
    }};
    std::vector<RgbaVertex> vertices;
    addQuad(
        vertices, {-1, -1}, {1, 1},
        {{{0.1f, 0.25f, 0.45f, 0.9f}, {0.2f, 0.6f, 0.55f, 0.2f}, {0.85f, 0.4f, 0.3f, 0.6f}, {0.95f, 0.85f, 0.5f, 1}}});
    addQuad(
        vertices, {-0.84f, -0.84f}, {0.84f, 0.84f},
        {{{0.95f, 0.3f, 0.2f, 0.05f}, {0.2f, 0.85f, 0.3f, 0.95f}, {0.2f, 0.4f, 0.9f, 0.5f}, {0.9f, 0.8f, 0.2f, 0.7f}}});
    const uint32_t vertexShader = record.vertex(kRgbaVertexGlsl);
    const uint32_t fragmentShader = record.fragment(kRgbaFragmentGlsl);
    const uint32_t background = rgbaPipeline(record, vertexShader, fragmentShader);
    const uint32_t buffer = record.vertexBuffer("quads", vertices);
    std::vector<uint32_t> pipelines;
    for (const Mode& mode : kModes) {
        pipelines.push_back(rgbaPipeline(record, vertexShader, fragmentShader)
                                .blend({VK_TRUE, mode.source, mode.destination, mode.op, mode.alphaSource,
                                        mode.alphaDestination, mode.alphaOp, mode.mask})
                                .blendConstants({0.75f, 0.25f, 0.5f, 0.375f}));
    }
    record.pass(kSceneExtent).color(target, {0.5f, 0.25f, 0.125f, 0.5f});
    record.draw(background, 6).vertices(buffer);
    for (size_t i = 0; i < pipelines.size(); ++i) {
        const auto x = static_cast<float>(i % 5), y = static_cast<float>(i / 5);
        record.draw(pipelines[i], 6).first(6).vertices(buffer).viewport(3 + 50 * x, 3 + 50 * y, 50, 50);
    }
    record.output(target);
    return record.finish();
}

Result<Scene> srgb() {
    constexpr VkFormat kSrgb8 = VK_FORMAT_R8G8B8A8_SRGB;
    SceneRecorder record(
        "srgb",
        "An sRGB texture read, a linear ramp written and translucent discs blended in linear light into an "
        "sRGB target.");
    const uint32_t target = record.colorTarget("color", kSrgb8, kSceneExtent);
    // Every sRGB code once: reading and writing it back must give the code itself.
    std::vector<glm::u8vec4> codes;
    for (uint32_t i = 0; i < 256; ++i) codes.push_back({i, 255 - i, (i * 7) & 255, 255});
    const uint32_t texture = record.texture("codes", kSrgb8, {256, 1}, {bytesOf(codes)});
    const uint32_t nearest = record.sampler(VK_FILTER_NEAREST);
    const uint32_t cover = record.vertex(kCoverVertexGlsl);
    const uint32_t copyCodes = record.pipeline(cover, record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D codes;
layout(location = 0) out vec4 color;
void main() { color = texelFetch(codes, ivec2(int(gl_FragCoord.x), 0), 0); }
)"));
    const uint32_t ramp = record.pipeline(cover, record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() {
    // Multiples of 1/256 and their squares are exact: only the encoding rounds.
    float t = floor(gl_FragCoord.x) * (1.0 / 256.0);
    color = vec4(t, t * t, 1.0 - t, 1.0);
}
)"));
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = VK_TRUE;
    over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    over.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.colorWriteMask = kAllComponents;
    struct Disc {
        glm::vec4 color;
        glm::vec2 center;
        float radiusSquared;
    };
    const uint32_t disc = record
                              .pipeline(cover, record.fragment(R"(#version 450
layout(push_constant) uniform Disc {
    vec4 color;
    vec2 center;
    float radiusSquared;
} disc;
layout(location = 0) out vec4 color;
void main() {
    vec2 d = gl_FragCoord.xy - disc.center;
    if (d.x * d.x + d.y * d.y > disc.radiusSquared) discard;
    color = disc.color;
}
)"))
                              .blend(over)
                              .pushConstants(sizeof(Disc));
    record.pass(kSceneExtent).color(target, {0.2f, 0.2f, 0.2f, 1});
    record.draw(copyCodes, 3).texture(0, texture, nearest).scissor(0, 0, 256, 96);
    record.draw(ramp, 3).scissor(0, 160, 256, 96);
    const std::array<Disc, 4> discs{{{{1, 0.1f, 0.05f, 0.5f}, {76, 112}, 3600},
                                     {{0.1f, 0.9f, 0.2f, 0.5f}, {112, 144}, 3600},
                                     {{0.1f, 0.2f, 1, 0.5f}, {148, 112}, 3600},
                                     {{1, 1, 1, 0.25f}, {184, 144}, 3600}}};
    for (const Disc& each : discs) record.draw(disc, 3).push(each);
    record.output(target);
    return record.finish();
}

Result<Scene> multiple_targets() {
    SceneRecorder record(
        "multiple_targets",
        "One pass writes colour to RGBA8, the normal to RGBA16F and the distance to R32F, each with its own "
        "clear value; a second lights the result from the three.");
    constexpr VkImageUsageFlags kSampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    constexpr VkSampleCountFlagBits kOnce = VK_SAMPLE_COUNT_1_BIT;
    const uint32_t albedo = record.colorTarget("albedo", kRgba8, kSceneExtent, kOnce, kSampled);
    const uint32_t normal = record.colorTarget("normal", VK_FORMAT_R16G16B16A16_SFLOAT, kSceneExtent, kOnce, kSampled);
    const uint32_t distance = record.colorTarget("distance", VK_FORMAT_R32_SFLOAT, kSceneExtent, kOnce, kSampled);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    const uint32_t lit = record.colorTarget("lit", kRgba8, kSceneExtent);
    const Mesh ball = sphereMesh(36, 18);
    struct Placement {
        glm::mat4 camera;
        glm::vec4 placement;  // centre and radius
        glm::vec4 color;
    };
    constexpr const char* kBlock = R"(#version 450
layout(push_constant) uniform Placement {
    mat4 camera;
    vec4 placement;
    vec4 color;
} push;
)";
    const uint32_t fill = record
                              .pipeline(record.vertex(std::string(kBlock) + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 vNormal;
layout(location = 1) out float vDistance;
void main() {
    vec4 clip = push.camera * vec4(position * push.placement.w + push.placement.xyz, 1.0);
    gl_Position = clip;
    vNormal = normal;
    vDistance = clip.w;
}
)"),
                                        record.fragment(std::string(kBlock) + R"(
layout(location = 0) in vec3 vNormal;
layout(location = 1) in float vDistance;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
layout(location = 2) out float distanceOut;
void main() {
    albedo = push.color;
    normal = vec4(vNormal, 0.0);
    distanceOut = vDistance;
}
)"))
                              .binding(sizeof(SolidVertex))
                              .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, position))
                              .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, normal))
                              .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
                              .depth(VK_COMPARE_OP_LESS)
                              .targets(3)
                              .pushConstants(sizeof(Placement));
    const uint32_t light = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(binding = 0) uniform sampler2D albedo;
layout(binding = 1) uniform sampler2D normal;
layout(binding = 2) uniform sampler2D distances;
layout(location = 0) out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 n = texelFetch(normal, at, 0).xyz;
    float wrapped = dot(n, vec3(-0.48, 0.64, 0.6)) * 0.5 + 0.5;
    float fog = clamp((texelFetch(distances, at, 0).x - 3.0) * 0.16, 0.0, 1.0);
    vec3 surface = texelFetch(albedo, at, 0).rgb;
    color = vec4(mix(surface * wrapped * wrapped, vec3(0.78, 0.84, 0.88), fog), 1.0);
}
)"));
    const uint32_t vertexBuffer = record.vertexBuffer("ball", ball.vertices);
    const uint32_t indexBuffer = record.indexBuffer("ball indices", ball.indices);
    const uint32_t nearest = record.sampler(VK_FILTER_NEAREST);
    const glm::mat4 camera = cameraMatrix({0, 1.1, 4.4}, {0, 0, -0.6}, 42, 1, 0.5, 20);
    record.pass(kSceneExtent)
        .color(albedo, {0.7f, 0.75f, 0.8f, 0})
        .color(normal, {0, 0, 0, 0})
        .color(distance, {1000, 0, 0, 0})
        .depthStencil(depth);
    const std::array<std::pair<glm::vec4, glm::vec4>, 5> balls{{{{-1.05f, -0.1f, 0.5f, 0.75f}, {0.9f, 0.42f, 0.25f, 1}},
                                                                {{0.35f, -0.3f, 0.9f, 0.55f}, {0.95f, 0.8f, 0.35f, 1}},
                                                                {{0.9f, 0.25f, -0.9f, 1.0f}, {0.3f, 0.55f, 0.75f, 1}},
                                                                {{-0.5f, 0.6f, -2.2f, 0.9f}, {0.4f, 0.7f, 0.45f, 1}},
                                                                {{1.5f, -0.5f, 0.4f, 0.35f}, {0.7f, 0.35f, 0.6f, 1}}}};
    for (const auto& [placement, color] : balls) {
        record.draw(fill, static_cast<uint32_t>(ball.indices.size()))
            .vertices(vertexBuffer)
            .indices(indexBuffer, VK_INDEX_TYPE_UINT16)
            .push(Placement{camera, placement, color});
    }
    record.pass(kSceneExtent).color(lit, {0, 0, 0, 1});
    record.draw(light, 3).texture(0, albedo, nearest).texture(1, normal, nearest).texture(2, distance, nearest);
    record.output(lit);
    record.output(albedo);
    record.output(normal);
    record.output(distance);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
