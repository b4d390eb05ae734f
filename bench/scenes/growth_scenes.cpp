#include "bench/scenes/growth_scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "bench/scenes/full_screen.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench {

using namespace conformance;

Result<Scene> trianglesScene(const char* name, const char* description, uint32_t columns, uint32_t rows) {
    SceneRecorder record(name, description);
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSpeedExtent);
    struct Vertex {
        float x, y, z;
        uint32_t color;
    };
    std::vector<Vertex> vertices;
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x)
            vertices.push_back({static_cast<float>(x) * 2 / static_cast<float>(columns) - 1,
                                static_cast<float>(y) * 2 / static_cast<float>(rows) - 1, 0.5f,
                                (x * 2654435761u ^ y * 40503u) | 0xFF000000u});
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
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
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1}).depthStencil(depth);
    record.draw(pipeline, static_cast<uint32_t>(indices.size()))
        .vertices(record.vertexBuffer("grid", vertices))
        .indices(record.indexBuffer("grid indices", indices), VK_INDEX_TYPE_UINT32);
    record.output(target);
    return record.finish();
}

namespace {

constexpr const char* kGrowthName = "growth";

Result<Scene> triangles(uint32_t amount) {
    // Cells of the target's shape: 2 n^2 triangles.
    const auto side = static_cast<uint32_t>(std::lround(std::sqrt(amount / 2.0)));
    return trianglesScene(kGrowthName, "A grid of triangles.", std::max(side, 1u), std::max(side, 1u));
}

Result<Scene> pixels(uint32_t amount) {
    const auto side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(amount))));
    return fullScreen(kGrowthName, "One quad.", kGradientFragment, 1, false, {std::max(side, 1u), std::max(side, 1u)});
}

Result<Scene> overdraw(uint32_t amount) {
    return fullScreen(kGrowthName, "Translucent quads.", R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(uv, 0.5, 0.25); })",
                      amount, true, {512, 512});
}

Result<Scene> lights(uint32_t amount) {
    SceneRecorder record(kGrowthName, "A quad lit by points of light.");
    constexpr VkExtent2D kExtent{512, 512};
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    SceneRandom random(11);
    std::vector<std::array<float, 8>> list(amount);  // place, reach; colour
    for (auto& light : list)
        light = {random.between(-1, 1),
                 random.between(-1, 1),
                 random.between(0.1f, 0.5f),
                 0,
                 random.unit(),
                 random.unit(),
                 random.unit(),
                 0};
    PipelineRecorder pipeline = record.pipeline(record.vertex(kQuadVertex), record.fragment(R"(#version 450
struct Light { vec4 place, color; };
layout(set = 0, binding = 0) uniform Lights { Light lights[256]; };
layout(push_constant) uniform Push { int count; };
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    vec3 sum = vec3(0.0), here = vec3(uv * 2.0 - 1.0, 0.0);
    for (int i = 0; i < count; ++i) {
        vec3 to = lights[i].place.xyz - here;
        float near = 1.0 / (1.0 + 40.0 * dot(to, to));
        sum += lights[i].color.rgb * (near * max(normalize(to).z, 0.0));
    }
    color = vec4(sum, 1.0);
})"));
    pipeline.topology(VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP).pushConstants(sizeof(int32_t));
    list.resize(256);
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 4)
        .uniform(0, record.buffer("lights", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, list))
        .push(static_cast<int32_t>(amount));
    record.output(target);
    return record.finish();
}

constexpr uint32_t kTriangleAmounts[] = {2048, 8192, 32768, 131072, 524288};
constexpr uint32_t kPixelAmounts[] = {256 * 256, 512 * 512, 1024 * 1024, 2048 * 2048, 4096 * 4096};
constexpr uint32_t kOverdrawAmounts[] = {4, 8, 16, 32, 64};
constexpr uint32_t kLightAmounts[] = {4, 16, 64, 128, 256};

constexpr GrowthAxis kAxes[] = {
    {"triangles", "triangles of a grid over 1024 x 768", triangles, kTriangleAmounts},
    {"pixels", "pixels of a quad with interpolated colours", pixels, kPixelAmounts},
    {"overdraw", "translucent quads of 512 x 512, one over the other", overdraw, kOverdrawAmounts},
    {"lights", "points of light per pixel of 512 x 512", lights, kLightAmounts},
};

}  // namespace

std::span<const GrowthAxis> growthAxes() {
    return kAxes;
}

Result<Scene> growthScene(std::string_view name) {
    const size_t colon = name.find(':');
    uint32_t amount = 0;
    if (colon != std::string_view::npos) {
        const std::string_view digits = name.substr(colon + 1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), amount);
        if (error != std::errc() || end != digits.data() + digits.size()) amount = 0;
    }
    for (const GrowthAxis& axis : kAxes) {
        if (amount == 0 || axis.name != name.substr(0, colon)) continue;
        const auto [least, most] = std::minmax_element(axis.amounts.begin(), axis.amounts.end());
        if (amount < *least / 4 || amount > *most) break;
        Result<Scene> scene = axis.build(amount);
        if (scene) scene->name = name;
        return scene;
    }
    return invalidArgument("--scene: no scene is called '" + std::string(name) + "'");
}

}  // namespace vernier::bench
