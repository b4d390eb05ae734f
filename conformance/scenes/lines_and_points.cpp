// Scenes about primitives without an area: lines in every mode, stipples, points, and polygons drawn as either.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <array>
#include <cmath>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkExtent2D kExtent{160, 160};
constexpr double kTau = 6.283185307179586476925;
constexpr std::array<float, 4> kDark{0.07f, 0.08f, 0.11f, 1};

glm::vec2 onCircle(glm::vec2 center, double turns, double radius) {
    return center + glm::vec2(glm::dvec2(std::cos(kTau * turns), std::sin(kTau * turns)) * radius);
}

/// Rays around a centre through all octants, every other one from the outside inwards.
std::vector<ColorVertex> rays(int count, glm::vec2 center, double inner, double outer) {
    std::vector<ColorVertex> vertices;
    for (int i = 0; i < count; ++i) {
        const double turns = (i + 0.17) / count;
        const float share = static_cast<float>(i) / static_cast<float>(count);
        const ColorVertex near{onCircle(center, turns, inner), {1, 0.9f - 0.5f * share, 0.35f}};
        const ColorVertex far{onCircle(center, turns, outer), {0.2f + 0.5f * share, 0.5f, 1}};
        vertices.push_back(i % 2 == 0 ? near : far);
        vertices.push_back(i % 2 == 0 ? far : near);
    }
    return vertices;
}

/// A star drawn in one stroke, as a strip that ends where it began.
std::vector<ColorVertex> star(glm::vec2 center, double radius, int points, int step) {
    std::vector<ColorVertex> vertices;
    for (int i = 0; i <= points; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(points);
        vertices.push_back({onCircle(center, (i * step % points + 0.03) / points, radius),
                            {0.35f + 0.6f * share, 0.95f - 0.5f * share, 0.55f}});
    }
    return vertices;
}

PipelineRecorder linePipeline(SceneRecorder& record, VkPrimitiveTopology topology) {
    return record.pipeline(record.vertex(kColorVertexGlsl), record.fragment(kColorFragmentGlsl))
        .binding(sizeof(ColorVertex))
        .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(ColorVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(ColorVertex, color))
        .topology(topology);
}

/// Rays as a list and a star as a strip, in the same line mode.
Result<Scene> raysAndStar(SceneRecorder& record, VkLineRasterizationModeEXT mode) {
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const auto list = rays(32, {-0.31f, -0.27f}, 0.12, 0.62);
    const auto strip = star({0.47f, 0.49f}, 0.45, 7, 3);
    const uint32_t lists = linePipeline(record, VK_PRIMITIVE_TOPOLOGY_LINE_LIST).lineMode(mode);
    const uint32_t strips = linePipeline(record, VK_PRIMITIVE_TOPOLOGY_LINE_STRIP).lineMode(mode);
    const uint32_t listBuffer = record.vertexBuffer("rays", list), stripBuffer = record.vertexBuffer("star", strip);
    record.pass(kExtent).color(target, kDark);
    record.draw(lists, static_cast<uint32_t>(list.size())).vertices(listBuffer);
    record.draw(strips, static_cast<uint32_t>(strip.size())).vertices(stripBuffer);
    record.output(target);
    return record.finish();
}

}  // namespace

Result<Scene> lines() {
    SceneRecorder record("lines", "Rays through all octants and a star, as rectangles one pixel wide.");
    return raysAndStar(record, VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT);
}

Result<Scene> lines_bresenham() {
    SceneRecorder record("lines_bresenham", "Rays through all octants and a star, by Bresenham's rule.");
    return raysAndStar(record, VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT);
}

Result<Scene> lines_wide() {
    SceneRecorder record("lines_wide", "Rays as rectangles 1.5, 3 and 7.5 pixels wide.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    record.pass(kExtent).color(target, kDark);
    struct Fan {
        glm::vec2 center;
        float width;
    };
    for (const Fan& fan : {Fan{{-0.45f, -0.47f}, 1.5f}, Fan{{0.48f, -0.43f}, 3}, Fan{{0.02f, 0.45f}, 7.5f}}) {
        const auto list = rays(fan.width > 5 ? 9 : 17, fan.center, 0.14, 0.46);
        const uint32_t pipeline = linePipeline(record, VK_PRIMITIVE_TOPOLOGY_LINE_LIST).lineWidth(fan.width);
        record.draw(pipeline, static_cast<uint32_t>(list.size())).vertices(record.vertexBuffer("rays", list));
    }
    record.output(target);
    return record.finish();
}

Result<Scene> lines_smooth() {
    SceneRecorder record("lines_smooth", "Smooth lines, whose coverage becomes alpha and is blended.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const auto list = rays(24, {0.03f, -0.02f}, 0.2, 0.93);
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = VK_TRUE;
    over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    over.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
    over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    over.colorWriteMask = 0xf;
    const uint32_t pipeline = linePipeline(record, VK_PRIMITIVE_TOPOLOGY_LINE_LIST)
                                  .lineMode(VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT)
                                  .blend(over);
    const uint32_t buffer = record.vertexBuffer("rays", list);
    record.pass(kExtent).color(target, kDark);
    record.draw(pipeline, static_cast<uint32_t>(list.size())).vertices(buffer);
    record.output(target);
    return record.finish();
}

Result<Scene> lines_stippled() {
    SceneRecorder record("lines_stippled",
                         "Stippled Bresenham lines: rays, which begin the pattern anew each, and a star, through whose "
                         "corners the pattern runs on.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const auto list = rays(16, {-0.35f, -0.31f}, 0.1, 0.58);
    const auto strip = star({0.43f, 0.45f}, 0.5, 5, 2);
    const auto stippled = [&](VkPrimitiveTopology topology, uint32_t factor, uint16_t pattern) {
        return linePipeline(record, topology)
            .lineMode(VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT)
            .stipple(factor, pattern);
    };
    const uint32_t lists = stippled(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, 1, 0x3f1d);
    const uint32_t strips = stippled(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, 3, 0x0f35);
    const uint32_t listBuffer = record.vertexBuffer("rays", list), stripBuffer = record.vertexBuffer("star", strip);
    record.pass(kExtent).color(target, kDark);
    record.draw(lists, static_cast<uint32_t>(list.size())).vertices(listBuffer);
    record.draw(strips, static_cast<uint32_t>(strip.size())).vertices(stripBuffer);
    record.output(target);
    return record.finish();
}

Result<Scene> lines_stippled_wide() {
    SceneRecorder record(
        "lines_stippled_wide",
        "Stippled rectangles: rays one pixel wide and four, cut into pieces of unit length, and an open "
        "polygon through whose corners the pattern runs on.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    record.pass(kExtent).color(target, kDark);
    const auto draw = [&](VkPrimitiveTopology topology, const std::vector<ColorVertex>& vertices, float width,
                          uint32_t factor, uint16_t pattern) {
        const uint32_t pipeline = linePipeline(record, topology).lineWidth(width).stipple(factor, pattern);
        record.draw(pipeline, static_cast<uint32_t>(vertices.size())).vertices(record.vertexBuffer("lines", vertices));
    };
    draw(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, rays(16, {-0.42f, -0.4f}, 0.12, 0.52), 1, 2, 0x3f1d);
    draw(VK_PRIMITIVE_TOPOLOGY_LINE_LIST, rays(9, {0.5f, -0.42f}, 0.15, 0.44), 4, 3, 0x5f07);
    draw(VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, star({0.05f, 0.55f}, 0.4, 3, 1), 2.5f, 8, 0x33cd);
    record.output(target);
    return record.finish();
}

Result<Scene> points() {
    SceneRecorder record("points",
                         "Points of one pixel to 41, on and off the grid, partly outside of the target; their colour "
                         "is PointCoord.");
    struct Point {
        glm::vec2 position;
        float size;
    };
    std::vector<Point> list;
    for (int i = 0; i < 28; ++i) {  // small ones along a wave
        const float x = -0.93f + 0.067f * static_cast<float>(i);
        list.push_back({{x, -0.72f + 0.11f * std::sin(7 * x)}, 1 + 0.25f * static_cast<float>(i % 9)});
    }
    for (int i = 0; i < 8; ++i) {
        const float share = static_cast<float>(i) / 8;
        list.push_back({onCircle({0.02f, 0.22f}, share + 0.03, 0.55), 6 + 5 * static_cast<float>(i)});
    }
    list.push_back({{-0.97f, 0.95f}, 23.5f});
    list.push_back({{0.99f, 0.05f}, 19.25f});
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in float size;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    gl_PointSize = size;
}
)"),
                                            record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PointCoord, 0.45, 1.0); }
)"))
                                  .binding(sizeof(Point))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(Point, position))
                                  .attribute(VK_FORMAT_R32_SFLOAT, offsetof(Point, size))
                                  .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
    const uint32_t buffer = record.vertexBuffer("points", list);
    record.pass(kExtent).color(target, kDark);
    record.draw(pipeline, static_cast<uint32_t>(list.size())).vertices(buffer);
    record.output(target);
    return record.finish();
}

Result<Scene> polygon_modes() {
    SceneRecorder record(
        "polygon_modes",
        "A fan of triangles of both windings, filled, as lines and as points, with and without culling.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    std::vector<ColorVertex> vertices;
    for (int i = 0; i < 6; ++i) {
        const double turns = (i + 0.07) / 6;
        const float share = static_cast<float>(i) / 6;
        const ColorVertex hub{onCircle({0.01f, -0.02f}, turns + 0.07, 0.12), {0.9f, 0.85f, 0.6f}};
        const ColorVertex a{onCircle({0, 0}, turns, 0.9), {0.95f - share * 0.6f, 0.4f, 0.3f + 0.6f * share}};
        const ColorVertex b{onCircle({0, 0}, turns + 0.13, 0.83), {0.3f, 0.9f - share * 0.5f, 0.4f}};
        vertices.insert(vertices.end(), {hub, i % 3 == 0 ? b : a, i % 3 == 0 ? a : b});
    }
    const uint32_t buffer = record.vertexBuffer("fan", vertices);
    record.pass(kExtent).color(target, kDark);
    const auto cell = [&](int column, int row, const PipelineRecorder& pipeline) {
        record.draw(pipeline, static_cast<uint32_t>(vertices.size()))
            .vertices(buffer)
            .viewport(static_cast<float>(column * 80), static_cast<float>(row * 80), 80, 80)
            .scissor(column * 80, row * 80, 80, 80);
    };
    const auto pipeline = [&] { return linePipeline(record, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST); };
    cell(0, 0, pipeline().cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_CLOCKWISE));
    cell(1, 0, pipeline().polygonMode(VK_POLYGON_MODE_LINE));
    cell(0, 1, pipeline().polygonMode(VK_POLYGON_MODE_POINT));
    cell(1, 1, pipeline().polygonMode(VK_POLYGON_MODE_LINE).cull(VK_CULL_MODE_FRONT_BIT, VK_FRONT_FACE_CLOCKWISE));
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
