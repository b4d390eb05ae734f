// Many primitives and many draws.
#include <array>
#include <vector>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/full_screen.h"
#include "bench/scenes/growth_scenes.h"
#include "conformance/scenes/shapes.h"

namespace vernier::bench::speed {

using namespace conformance;

Result<Scene> small_triangles() {
    return trianglesScene("small_triangles", "196608 triangles of four pixels each, with depth test.",
                          kSpeedExtent.width / 4, kSpeedExtent.height / 2);
}

Result<Scene> tiny_draws() {
    SceneRecorder record("tiny_draws", "4096 draws of one small triangle each, with push constants.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
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
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    for (uint32_t i = 0; i < 4096; ++i)
        record.draw(pipeline, 3)
            .push(std::array<float, 2>{static_cast<float>(i % 64) / 64, static_cast<float>(i / 64) / 64});
    record.output(target);
    return record.finish();
}

Result<Scene> lines() {
    SceneRecorder record("lines", "16384 lines of 2 to 120 pixels in all directions.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    struct Vertex {
        float x, y;
        uint32_t color;
    };
    constexpr uint32_t kLines = 16384;
    SceneRandom random(3);
    std::vector<Vertex> vertices;
    for (uint32_t i = 0; i < kLines; ++i) {
        const float x = random.between(-1, 1), y = random.between(-1, 1), reach = random.between(0.01f, 0.12f);
        const uint32_t color = random.next() | 0xFF404040u;
        vertices.push_back({x, y, color});
        vertices.push_back(
            {x + random.between(-reach, reach), y + random.between(-reach, reach), ~color | 0xFF000000u});
    }
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 shade;
void main() { gl_Position = vec4(position, 0.5, 1.0); shade = color; })"),
                                            record.fragment(R"(#version 450
layout(location = 0) in vec4 shade;
layout(location = 0) out vec4 color;
void main() { color = shade; })"))
                                  .binding(sizeof(Vertex))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, x))
                                  .attribute(kRgba8, offsetof(Vertex, color))
                                  .topology(VK_PRIMITIVE_TOPOLOGY_LINE_LIST);
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, kLines * 2).vertices(record.vertexBuffer("lines", vertices));
    record.output(target);
    return record.finish();
}

Result<Scene> points() {
    SceneRecorder record("points", "65536 points of one pixel and 4096 round ones of 4 to 16 pixels.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSpeedExtent);
    SceneRandom random(5);
    std::vector<std::array<float, 3>> places;  // position, size
    constexpr uint32_t kSmall = 65536, kLarge = 4096;
    for (uint32_t i = 0; i < kSmall + kLarge; ++i)
        places.push_back({random.between(-1, 1), random.between(-1, 1), i < kSmall ? 1 : random.between(4, 16)});
    const uint32_t buffer = record.vertexBuffer("places", places);
    const uint32_t vertex = record.vertex(R"(#version 450
layout(location = 0) in vec3 place;
layout(location = 0) flat out vec3 tint;
void main() {
    gl_Position = vec4(place.xy, 0.5, 1.0);
    gl_PointSize = place.z;
    tint = vec3(place.xy * 0.5 + 0.5, 0.7);
})");
    const uint32_t square = record.fragment(R"(#version 450
layout(location = 0) flat in vec3 tint;
layout(location = 0) out vec4 color;
void main() { color = vec4(tint, 1.0); })");
    const uint32_t round = record.fragment(R"(#version 450
layout(location = 0) flat in vec3 tint;
layout(location = 0) out vec4 color;
void main() {
    vec2 d = gl_PointCoord * 2.0 - 1.0;
    if (dot(d, d) > 1.0) discard;
    color = vec4(tint * (1.0 - 0.5 * dot(d, d)), 1.0);
})");
    record.pass(kSpeedExtent).color(target, {0, 0, 0, 1});
    for (const bool large : {false, true}) {
        const uint32_t pipeline = record.pipeline(vertex, large ? round : square)
                                      .binding(sizeof places[0])
                                      .attribute(VK_FORMAT_R32G32B32_SFLOAT, 0)
                                      .topology(VK_PRIMITIVE_TOPOLOGY_POINT_LIST);
        record.draw(pipeline, large ? kLarge : kSmall).first(large ? kSmall : 0).vertices(buffer);
    }
    record.output(target);
    return record.finish();
}

}  // namespace vernier::bench::speed
