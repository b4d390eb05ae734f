// Scenes about how vertices become primitives and where these go: provoking vertices, restart, depth bias, clamping and
// clip depths, viewports, layers and views.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>
#include <functional>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkExtent2D kExtent{160, 160};
constexpr std::array<float, 4> kDark{0.07f, 0.08f, 0.11f, 1};

constexpr const char* kFlatVertexGlsl = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) flat out vec3 vColor;
void main() {
    gl_Position = vec4(position, 1.0);
    vColor = color;
}
)";
constexpr const char* kFlatFragmentGlsl = R"(#version 450
layout(location = 0) flat in vec3 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(vColor, 1.0); }
)";

glm::vec3 hue(int i) {
    const std::array<glm::vec3, 7> colors{{{0.9f, 0.3f, 0.25f},
                                           {0.95f, 0.7f, 0.25f},
                                           {0.6f, 0.85f, 0.3f},
                                           {0.25f, 0.75f, 0.6f},
                                           {0.25f, 0.5f, 0.9f},
                                           {0.6f, 0.4f, 0.9f},
                                           {0.9f, 0.4f, 0.7f}}};
    return colors[static_cast<size_t>(i) % colors.size()];
}

/// A band of triangles for strips: `count` vertices, alternately above and below.
std::vector<DepthColorVertex> band(int count, float top) {
    std::vector<DepthColorVertex> vertices;
    for (int i = 0; i < count; ++i) {
        const float x = -0.9f + 1.8f * static_cast<float>(i) / static_cast<float>(count - 1);
        vertices.push_back({{x, i % 2 == 0 ? top : top + 0.42f, 0.5f}, hue(i)});
    }
    return vertices;
}

/// A half wheel for fans, the hub first.
std::vector<DepthColorVertex> wheel(int rim, float top) {
    std::vector<DepthColorVertex> vertices{{{0.01f, top, 0.5f}, hue(rim)}};
    for (int i = 0; i < rim; ++i) {
        const double angle = 0.08 + 2.98 * i / (rim - 1);
        vertices.push_back(
            {{static_cast<float>(0.85 * std::cos(angle)), top + static_cast<float>(0.5 * std::sin(angle)), 0.5f},
             hue(i)});
    }
    return vertices;
}

void addQuad(std::vector<DepthColorVertex>& list, glm::vec2 low, glm::vec2 high, const std::array<float, 4>& depths,
             glm::vec3 color) {
    const DepthColorVertex a{{low, depths[0]}, color}, b{{high.x, low.y, depths[1]}, color};
    const DepthColorVertex c{{low.x, high.y, depths[2]}, color}, d{{high, depths[3]}, color};
    list.insert(list.end(), {a, b, c, c, b, d});
}

}  // namespace

Result<Scene> provoking_vertex() {
    SceneRecorder record(
        "provoking_vertex",
        "Flat colours of strips, fans and lists with the first vertex as the provoking one on the left "
        "and the last one on the right.");
    const uint32_t target = record.colorTarget("color", kRgba8, {320, 160});
    const auto strip = band(9, -0.95f), list = band(9, -0.45f), fan = wheel(7, 0.2f);
    const uint32_t stripBuffer = record.vertexBuffer("strip", strip), listBuffer = record.vertexBuffer("list", list),
                   fanBuffer = record.vertexBuffer("fan", fan);
    record.pass({320, 160}).color(target, kDark);
    for (const bool last : {false, true}) {
        const auto draw = [&](VkPrimitiveTopology topology, uint32_t buffer, size_t count) {
            PipelineRecorder flat = depthColorPipeline(record, kFlatVertexGlsl, kFlatFragmentGlsl).topology(topology);
            if (last) flat.provokingVertexLast();
            record.draw(flat, static_cast<uint32_t>(count))
                .vertices(buffer)
                .viewport(last ? 160.0f : 0.0f, 0, 160, 160)
                .scissor(last ? 160 : 0, 0, 160, 160);
        };
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, stripBuffer, strip.size());
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, listBuffer, list.size());
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, fanBuffer, fan.size());
    }
    record.output(target);
    return record.finish();
}

Result<Scene> barycentrics() {
    SceneRecorder record(
        "barycentrics",
        "Barycentric coordinates of strips, lists, fans and lines, and colours mixed by them from the "
        "values of single vertices; the first vertex is the provoking one on the left, the last one on "
        "the right.");
    const uint32_t weights = record.colorTarget("weights", kRgba8, {320, 160});
    const uint32_t mixed = record.colorTarget("mixed", kRgba8, {320, 160});
    const auto strip = band(9, -0.95f), list = band(9, -0.45f), fan = wheel(7, 0.2f), line = band(6, 0.85f);
    constexpr const char* kFragment = R"(#version 450
#extension GL_EXT_fragment_shader_barycentric : require
layout(location = 0) pervertexEXT in vec3 corners[];
layout(location = 0) out vec4 weights;
layout(location = 1) out vec4 mixed;
void main() {
    weights = vec4(gl_BaryCoordEXT, 1.0);
    mixed = vec4(corners[0] * gl_BaryCoordNoPerspEXT.x + corners[1].bgr * gl_BaryCoordNoPerspEXT.y, 1.0);
}
)";
    record.pass({320, 160}).color(weights, kDark).color(mixed, kDark);
    for (const bool last : {false, true}) {
        const auto draw = [&](VkPrimitiveTopology topology, const std::vector<DepthColorVertex>& vertices) {
            PipelineRecorder state =
                depthColorPipeline(record, kFlatVertexGlsl, kFragment).topology(topology).targets(2);
            if (last) state.provokingVertexLast();
            record.draw(state, static_cast<uint32_t>(vertices.size()))
                .vertices(record.vertexBuffer("vertices", vertices))
                .viewport(last ? 160.0f : 0.0f, 0, 160, 160)
                .scissor(last ? 160 : 0, 0, 160, 160);
        };
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, strip);
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, list);
        draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, fan);
        draw(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, line);
    }
    record.output(weights);
    record.output(mixed);
    return record.finish();
}

Result<Scene> primitive_restart() {
    SceneRecorder record("primitive_restart",
                         "A strip and a fan cut by restart indices of 16 and 32 bits, twice in a row and after too few "
                         "vertices; the base vertex is added after the comparison.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    auto vertices = band(12, -0.9f);
    const auto fan = wheel(9, 0.05f);
    const auto base = static_cast<int32_t>(vertices.size());
    vertices.insert(vertices.end(), fan.begin(), fan.end());
    constexpr uint16_t kCut = 0xffff;
    constexpr uint32_t kWideCut = ~0u;
    const std::array<uint16_t, 17> stripIndices{0, 1, 2, 3, kCut, kCut, 4, 5, kCut, 5, 6, 7, kCut, 8, 9, 10, 11};
    const std::array<uint32_t, 13> fanIndices{kWideCut, 0, 1, 2, 3, kWideCut, 0, 4, 5, kWideCut, 0, 7, 9};
    const uint32_t buffer = record.vertexBuffer("vertices", vertices);
    const uint32_t narrow = record.indexBuffer("strip", stripIndices), wide = record.indexBuffer("fan", fanIndices);
    const auto flat = [&](VkPrimitiveTopology topology) {
        return depthColorPipeline(record, kFlatVertexGlsl, kFlatFragmentGlsl).topology(topology, true);
    };
    const uint32_t strips = flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP), fans = flat(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN);
    record.pass(kExtent).color(target, kDark);
    record.draw(strips, stripIndices.size()).vertices(buffer).indices(narrow, VK_INDEX_TYPE_UINT16);
    record.draw(fans, fanIndices.size()).vertices(buffer).indices(wide, VK_INDEX_TYPE_UINT32).first(0, base);
    record.output(target);
    return record.finish();
}

Result<Scene> adjacency() {
    SceneRecorder record("adjacency",
                         "Lists and strips of lines and triangles with adjacency, whose adjacent vertices lie far off: "
                         "without a geometry shader nothing reads them.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const DepthColorVertex adjacent{{7.5f, -9.25f, 0.5f}, {1, 0, 0}};
    // Every kind takes the vertices of one band in order, with the adjacent ones where its pattern has them.
    const auto draw = [&](VkPrimitiveTopology topology, float top, size_t step, size_t first,
                          const std::vector<DepthColorVertex>& own) {
        std::vector<DepthColorVertex> vertices(first, adjacent);
        for (const DepthColorVertex& vertex : own) {
            vertices.push_back(vertex);
            vertices.back().position.y += top;
            vertices.insert(vertices.end(), step - 1, adjacent);
        }
        vertices.insert(vertices.end(), first, adjacent);
        const uint32_t state = depthColorPipeline(record, kFlatVertexGlsl, kFlatFragmentGlsl).topology(topology);
        record.draw(state, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("vertices", vertices));
    };
    record.pass(kExtent).color(target, kDark);
    draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, -0.9f, 2, 0, band(8, 0));
    draw(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, -0.4f, 2, 0, band(9, 0));
    draw(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, 0.1f, 1, 1, band(11, 0));
    // A list of lines has one adjacent vertex before and one behind each pair.
    const auto pairs = band(8, 0.52f);
    std::vector<DepthColorVertex> list;
    for (size_t i = 0; i < pairs.size(); i += 2) list.insert(list.end(), {adjacent, pairs[i], pairs[i + 1], adjacent});
    const uint32_t state = depthColorPipeline(record, kFlatVertexGlsl, kFlatFragmentGlsl)
                               .topology(VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY);
    record.draw(state, static_cast<uint32_t>(list.size())).vertices(record.vertexBuffer("list", list));
    record.output(target);
    return record.finish();
}

namespace {

/// Tiles over a leaning sheet, in its plane, each with a bias that decides whether it shows.
Result<Scene> biasedTiles(SceneRecorder& record, VkFormat depthFormat) {
    // A power of two, so that corners, and with them depths, are exact: only the bias parts sheet and tiles.
    constexpr VkExtent2D kTileExtent{128, 128};
    const uint32_t target = record.colorTarget("color", kRgba8, kTileExtent);
    const uint32_t depth = record.depthTarget("depth", depthFormat, kTileExtent);
    const auto depthAt = [](glm::vec2 p) { return 0.5f + 0.25f * p.x + 0.125f * p.y; };
    const auto depthsOf = [&](glm::vec2 low, glm::vec2 high) {
        return std::array<float, 4>{depthAt(low), depthAt({high.x, low.y}), depthAt({low.x, high.y}), depthAt(high)};
    };
    std::vector<DepthColorVertex> vertices;
    addQuad(vertices, {-1, -1}, {1, 1}, depthsOf({-1, -1}, {1, 1}), {0.25f, 0.3f, 0.4f});
    struct Bias {
        float constant, slope, clamp;
    };
    constexpr std::array<Bias, 9> kBiases{{{-8, 0, 0},
                                           {8, 0, 0},
                                           {0, -2, 0},
                                           {0, 2, 0},
                                           {-4, -1, 0},
                                           {0, -40, -0.001f},
                                           {3000, 0, 0.0005f},
                                           {-2000, 0, -0.25f},
                                           {-100, 1, 0}}};
    for (int i = 0; i < 9; ++i) {
        const glm::vec2 low{-0.9375f + 0.625f * static_cast<float>(i % 3),
                            -0.9375f + 0.625f * static_cast<float>(i / 3)};
        const glm::vec2 high = low + 0.59375f;
        addQuad(vertices, low, high, depthsOf(low, high), hue(i));
    }
    const uint32_t buffer = record.vertexBuffer("tiles", vertices);
    record.pass(kTileExtent).color(target, kDark).depthStencil(depth);
    record.draw(depthColorPipeline(record).depth(VK_COMPARE_OP_LESS), 6).vertices(buffer);
    for (size_t i = 0; i < kBiases.size(); ++i) {
        const Bias& bias = kBiases[i];
        const uint32_t state =
            depthColorPipeline(record).depth(VK_COMPARE_OP_LESS).depthBias(bias.constant, bias.slope, bias.clamp);
        record.draw(state, 6).vertices(buffer).first(static_cast<uint32_t>(6 + 6 * i));
    }
    record.output(target);
    record.output(depth);
    return record.finish();
}

}  // namespace

Result<Scene> depth_bias() {
    SceneRecorder record("depth_bias",
                         "Nine tiles in the plane of a leaning sheet, pulled out of it or pushed behind it by constant "
                         "and slope biases, with and without clamps; 32-bit float depth.");
    return biasedTiles(record, VK_FORMAT_D32_SFLOAT);
}

Result<Scene> depth_bias_fixed() {
    SceneRecorder record("depth_bias_fixed", "The tiles of depth_bias on 16-bit fixed-point depth.");
    return biasedTiles(record, VK_FORMAT_D16_UNORM);
}

namespace {

/// Blades that reach through the near and the far plane.
std::vector<DepthColorVertex> bladeVertices(float near) {
    std::vector<DepthColorVertex> vertices;
    const float span = 1 - near;
    for (int i = 0; i < 7; ++i) {
        const float x = -0.93f + 0.27f * static_cast<float>(i);
        const float from = near - 0.4f * span + 0.08f * span * static_cast<float>(i),
                    to = 1.35f - 0.07f * static_cast<float>(i);
        addQuad(vertices, {x, -0.9f}, {x + 0.22f, 0.9f}, {from, from + 0.1f, to, to + 0.05f}, hue(i));
        addQuad(vertices, {-0.9f, x}, {0.9f, x + 0.1f}, {to, from, to, from}, hue(i + 3) * 0.7f);
    }
    return vertices;
}

Result<Scene> blades(SceneRecorder& record, const std::function<void(PipelineRecorder&)>& state, float near) {
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent);
    const auto vertices = bladeVertices(near);
    PipelineRecorder pipe = depthColorPipeline(record).depth(VK_COMPARE_OP_LESS);
    state(pipe);
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    record.pass(kExtent).color(target, kDark).depthStencil(depth);
    record.draw(pipe, static_cast<uint32_t>(vertices.size())).vertices(buffer).viewport(0, 0, 160, 160, 0.125f, 0.75f);
    record.output(target);
    record.output(depth);
    return record.finish();
}

}  // namespace

Result<Scene> depth_clamp() {
    SceneRecorder record(
        "depth_clamp", "Blades through the near and the far plane, not clipped but clamped to the viewport's depths.");
    return blades(
        record, [](PipelineRecorder& state) { state.depthClamp(); }, 0);
}

Result<Scene> depth_clip_control() {
    SceneRecorder record("depth_clip_control", "Blades clipped at depths -w and w, as in OpenGL.");
    return blades(
        record, [](PipelineRecorder& state) { state.depthNegativeOneToOne(); }, -1);
}

Result<Scene> depth_clip_enable() {
    SceneRecorder record("depth_clip_enable",
                         "Blades through the near and the far plane, clipped and clamped in every combination: neither "
                         "without a depth test, whose depths would be open.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent);
    const auto vertices = bladeVertices(0);
    const uint32_t buffer = record.vertexBuffer("blades", vertices);
    record.pass(kExtent).color(target, kDark).depthStencil(depth);
    for (uint32_t part = 0; part < 4; ++part) {
        const bool clip = (part & 1) != 0, clamp = (part & 2) != 0;
        PipelineRecorder pipe = depthColorPipeline(record).depthClip(clip);
        if (clamp) pipe.depthClamp();
        if (clip || clamp) pipe.depth(VK_COMPARE_OP_LESS);
        const uint32_t x = part % 2 * 80, y = part / 2 * 80;
        record.draw(pipe, static_cast<uint32_t>(vertices.size()))
            .vertices(buffer)
            .viewport(static_cast<float>(x), static_cast<float>(y), 80, 80, 0.125f, 0.75f)
            .scissor(static_cast<int32_t>(x), static_cast<int32_t>(y), 80, 80);
    }
    record.output(target);
    record.output(depth);
    return record.finish();
}

Result<Scene> depth_bounds() {
    SceneRecorder record("depth_bounds", "A tint only where the depth stored lies within bounds, its own depth aside.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kExtent);
    std::vector<DepthColorVertex> vertices;
    addQuad(vertices, {-0.9f, -0.9f}, {0.9f, 0.8f}, {0.1f, 0.6f, 0.4f, 0.95f}, {0.3f, 0.45f, 0.6f});
    addQuad(vertices, {-1, -1}, {1, 1}, {0.05f, 0.05f, 0.05f, 0.05f}, {0.95f, 0.8f, 0.35f});
    const uint32_t sheet = depthColorPipeline(record).depth(VK_COMPARE_OP_LESS);
    const uint32_t tint = depthColorPipeline(record).depthBounds(0.375f, 0.5625f).targets(1);
    const uint32_t buffer = record.vertexBuffer("sheets", vertices);
    record.pass(kExtent).color(target, kDark).depthStencil(depth);
    record.draw(sheet, 6).vertices(buffer);
    record.draw(tint, 6).vertices(buffer).first(6);
    record.output(target);
    record.output(depth);
    return record.finish();
}

Result<Scene> viewports_indexed() {
    SceneRecorder record("viewports_indexed",
                         "Four instances of a wheel, each in a viewport and scissor of its own that the vertex shader "
                         "chooses; one viewport stands on its head.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const auto fan = wheel(9, -0.2f);
    const uint32_t buffer = record.vertexBuffer("fan", fan);
    const uint32_t state = depthColorPipeline(record, R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : enable
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = vec4(position, 1.0);
    gl_ViewportIndex = gl_InstanceIndex;
    vColor = color * (1.0 - 0.15 * float(gl_InstanceIndex));
}
)")
                               .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN);
    record.pass(kExtent).color(target, kDark);
    record.draw(state, static_cast<uint32_t>(fan.size()))
        .vertices(buffer)
        .instances(4)
        .viewport(0, 0, 80, 80)
        .scissor(0, 0, 80, 80)
        .view({{80, 80, 80, -80, 0, 1}, {{80, 0}, {80, 70}}})
        .view({{-20, 90, 120, 60, 0, 1}, {{5, 85}, {70, 70}}})
        .view({{90, 85, 50, 75, 0, 1}, {{80, 80}, {80, 80}}});
    record.output(target);
    return record.finish();
}

namespace {

/// A wheel drawn into four layers of 80 x 80 by `draw`, which are put side by side where they can be seen.
struct WheelDraw {
    uint32_t target, state, buffer, count;
};
Result<Scene> layeredWheel(SceneRecorder& record, const char* vertexGlsl, const char* fragmentGlsl,
                           const std::function<void(const WheelDraw&)>& draw, uint32_t geometry = kNone) {
    const uint32_t target = record.layeredTarget("layers", kRgba8, {80, 80}, 4);
    const uint32_t flat = record.colorTarget("side by side", kRgba8, kExtent);
    const auto fan = wheel(9, -0.2f);
    const uint32_t buffer = record.vertexBuffer("fan", fan);
    const uint32_t state = depthColorPipeline(record, vertexGlsl, fragmentGlsl)
                               .topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN)
                               .geometry(geometry);
    record.pass({80, 80}).color(target, kDark).layers(4);
    draw({target, state, buffer, static_cast<uint32_t>(fan.size())});
    record.pass(kExtent).color(flat, {});
    for (uint32_t layer = 0; layer < 4; ++layer) {
        SceneCopyImage copy{target, flat, {}};
        copy.region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        copy.region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.region.dstOffset = {static_cast<int32_t>(layer % 2 * 80), static_cast<int32_t>(layer / 2 * 80), 0};
        copy.region.extent = {80, 80, 1};
        record.copy(copy);
    }
    record.output(flat);
    return record.finish();
}

}  // namespace

Result<Scene> layers() {
    SceneRecorder record("layers",
                         "Four instances of a wheel, each in a layer of its own that the vertex shader chooses.");
    const char* const vertex = R"(#version 450
#extension GL_ARB_shader_viewport_layer_array : enable
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    float turn = 0.4 * float(gl_InstanceIndex);
    gl_Position = vec4(mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * position.xy, 0.5, 1.0);
    gl_Layer = 3 - gl_InstanceIndex;
    vColor = color;
}
)";
    return layeredWheel(record, vertex, kColorFragmentGlsl, [&record](const WheelDraw& wheel) {
        record.draw(wheel.state, wheel.count).vertices(wheel.buffer).instances(4);
    });
}

Result<Scene> geometry_layers() {
    SceneRecorder record(
        "geometry_layers",
        "A wheel in four layers, into which a geometry shader puts each of its triangles, turned by the "
        "number of the invocation and shrunk towards its middle.");
    const uint32_t geometry = record.geometry(R"(#version 450
layout(triangles, invocations = 4) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec3 vColor[];
layout(location = 0) out vec3 gColor;
void main() {
    float turn = 0.4 * float(gl_InvocationID);
    mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
    vec2 middle = (gl_in[0].gl_Position.xy + gl_in[1].gl_Position.xy + gl_in[2].gl_Position.xy) / 3.0;
    for (int v = 0; v < 3; ++v) {
        vec2 place = mix(gl_in[v].gl_Position.xy, middle, 0.08 * float(gl_InvocationID));
        gl_Position = vec4(turned * place, 0.5, 1.0);
        gl_Layer = gl_InvocationID;
        gColor = vColor[v];
        EmitVertex();
    }
}
)");
    const auto draw = [&record](const WheelDraw& wheel) {
        record.draw(wheel.state, wheel.count).vertices(wheel.buffer);
    };
    return layeredWheel(record, kDepthColorVertexGlsl, kColorFragmentGlsl, draw, geometry);
}

Result<Scene> multiview() {
    SceneRecorder record("multiview",
                         "One draw in three views of four, which shift and tint by ViewIndex; the fourth layer is only "
                         "cleared.");
    const char* const vertex = R"(#version 450
#extension GL_EXT_multiview : enable
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = vec4(position.x + 0.2 * float(gl_ViewIndex) - 0.3, position.yz, 1.0);
    vColor = color;
}
)";
    const char* const fragment = R"(#version 450
#extension GL_EXT_multiview : enable
layout(location = 0) in vec3 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_ViewIndex == 1 ? vColor.bgr : vColor, 1.0); }
)";
    // Every layer has its background by now: those that no view draws to are not cleared by a pass of views.
    return layeredWheel(record, vertex, fragment, [&record](const WheelDraw& wheel) {
        record.pass({80, 80}).loadColor(wheel.target).views(0b1011);
        record.draw(wheel.state, wheel.count).vertices(wheel.buffer);
    });
}

}  // namespace vernier::conformance::scenes
