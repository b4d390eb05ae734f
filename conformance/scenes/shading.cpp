// Scenes whose work is in the shaders.
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/scenes.h"
#include "conformance/scenes/shapes.h"

#include <tiny_obj_loader.h>

#include <map>
#include <tuple>

namespace vernier::conformance::scenes {
namespace {

constexpr VkFormat kRgba8 = VK_FORMAT_R8G8B8A8_UNORM;

Result<Mesh> loadObj(const std::string& text) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, "")) return invalidArgument("the OBJ text does not load: " + reader.Error());
    const tinyobj::attrib_t& attributes = reader.GetAttrib();
    Mesh mesh;
    std::map<std::tuple<int, int, int>, uint16_t> known;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            const auto next = static_cast<uint16_t>(mesh.vertices.size());
            const auto [entry, isNew] =
                known.try_emplace({index.vertex_index, index.normal_index, index.texcoord_index}, next);
            if (isNew) {
                const float* position = &attributes.vertices[3 * static_cast<size_t>(index.vertex_index)];
                const float* normal = &attributes.normals[3 * static_cast<size_t>(index.normal_index)];
                const float* uv = &attributes.texcoords[2 * static_cast<size_t>(index.texcoord_index)];
                mesh.vertices.push_back(
                    {{position[0], position[1], position[2]}, {normal[0], normal[1], normal[2]}, {uv[0], uv[1]}});
            }
            mesh.indices.push_back(entry->second);
        }
    }
    return mesh;
}

}  // namespace

Result<Scene> lit_model() {
    SceneRecorder record("lit_model",
                         "A torus knot read from OBJ text, lit by two half-Lambert lights from a uniform buffer.");
    Result<Mesh> loaded = loadObj(torusKnotObj(160, 14));
    if (!loaded) return loaded.error();
    const Mesh& mesh = loaded.value();
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t depth = record.depthTarget("depth", VK_FORMAT_D32_SFLOAT, kSceneExtent);
    struct Frame {
        glm::mat4 camera;
        glm::vec4 direction[2];
        glm::vec4 color[2];
    };
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(R"(#version 450
layout(binding = 0) uniform Frame {
    mat4 camera;
    vec4 direction[2];
    vec4 color[2];
} frame;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec3 vNormal;
layout(location = 1) out vec2 vUv;
void main() {
    gl_Position = frame.camera * vec4(position, 1.0);
    vNormal = normal;
    vUv = uv;
}
)"),
                                            record.fragment(R"(#version 450
layout(binding = 0) uniform Frame {
    mat4 camera;
    vec4 direction[2];
    vec4 color[2];
} frame;
layout(location = 0) in vec3 vNormal;
layout(location = 1) in vec2 vUv;
layout(location = 0) out vec4 color;
void main() {
    vec3 n = normalize(vNormal);
    // A smooth stripe along the knot: a triangle wave through a cubic.
    float wave = abs(fract(vUv.x * 12.0) * 2.0 - 1.0);
    float stripe = wave * wave * (3.0 - 2.0 * wave);
    vec3 albedo = mix(vec3(0.93, 0.42, 0.3), vec3(0.98, 0.86, 0.6), stripe);
    vec3 light = vec3(0.05);
    for (int i = 0; i < 2; ++i) {
        float h = dot(n, frame.direction[i].xyz) * 0.5 + 0.5;
        light += frame.color[i].rgb * (h * h);
    }
    color = vec4(min(albedo * light, vec3(1.0)), 1.0);
}
)"))
                                  .binding(sizeof(SolidVertex))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, position))
                                  .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(SolidVertex, normal))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(SolidVertex, uv))
                                  .cull(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE)
                                  .depth(VK_COMPARE_OP_LESS);
    const uint32_t frame =
        record.uniformBuffer("frame", Frame{cameraMatrix({1.1, 3.3, 3.4}, {0.06, -0.1, 0}, 45, 1, 1, 12),
                                            {{0.36f, 0.8f, 0.48f, 0}, {-0.8f, -0.36f, 0.48f, 0}},
                                            {{0.98f, 0.95f, 0.88f, 0}, {0.12f, 0.22f, 0.42f, 0}}});
    const uint32_t vertices = record.vertexBuffer("knot", mesh.vertices);
    const uint32_t indices = record.indexBuffer("knot indices", mesh.indices);
    record.pass(kSceneExtent).color(target, {0.1f, 0.12f, 0.17f, 1}).depthStencil(depth);
    record.draw(pipeline, static_cast<uint32_t>(mesh.indices.size()))
        .vertices(vertices)
        .indices(indices, VK_INDEX_TYPE_UINT16)
        .uniform(0, frame);
    record.output(target);
    record.output(depth);
    return record.finish();
}

Result<Scene> derivatives() {
    SceneRecorder record("derivatives",
                         "A grid on a plane in perspective, its lines kept one pixel wide by dFdx and dFdy.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const glm::mat4 camera = cameraMatrix({0.4, 1.2, 3}, {-0.2, 0.1, -1}, 55, 1, 0.2, 60);
    const auto at = [&](float x, float z) {
        return TexturedVertex{camera * glm::vec4(x, 0, z, 1), {x * 2.0f, z * 2.0f}};
    };
    const std::vector<TexturedVertex> floor{at(-9, 2.9f), at(9, 2.9f), at(-9, -22),
                                            at(-9, -22),  at(9, 2.9f), at(9, -22)};
    const uint32_t pipeline = record
                                  .pipeline(record.vertex(kTexturedVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) in vec2 vUv;
layout(location = 0) out vec4 color;
void main() {
    vec2 width = abs(dFdx(vUv)) + abs(dFdy(vUv));
    vec2 away = abs(fract(vUv - 0.5) - 0.5);          // distance to the nearest line, in cells
    vec2 line = 1.0 - clamp(away / max(width, vec2(1e-4)), 0.0, 1.0);
    float fade = clamp(1.0 - max(width.x, width.y) * 1.5, 0.0, 1.0);
    float ink = max(line.x, line.y) * fade;
    vec3 ground = mix(vec3(0.87, 0.88, 0.85), vec3(0.16, 0.25, 0.35), 0.12 + 0.8 * clamp(width.y, 0.0, 1.0));
    color = vec4(mix(ground, vec3(0.85, 0.3, 0.25), ink), 1.0);
}
)"))
                                  .binding(sizeof(TexturedVertex))
                                  .attribute(VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(TexturedVertex, position))
                                  .attribute(VK_FORMAT_R32G32_SFLOAT, offsetof(TexturedVertex, uv));
    const uint32_t buffer = record.vertexBuffer("floor", floor);
    record.pass(kSceneExtent).color(target, {0.11f, 0.16f, 0.23f, 1});
    record.draw(pipeline, 6).vertices(buffer);
    record.output(target);
    return record.finish();
}

Result<Scene> julia() {
    SceneRecorder record("julia",
                         "Escape times of a quadratic map: up to 96 turns of a loop that every pixel leaves "
                         "at another time. All "
                         "arithmetic is precise, so every driver must count alike.");
    const uint32_t target = record.colorTarget("color", kRgba8, kSceneExtent);
    const uint32_t fragmentShader = record.fragment(R"(#version 450
layout(constant_id = 3) const int kMaxTurns = 4;
layout(location = 0) out vec4 color;
vec3 palette(float t) {
    // Cubic ramps with exact ends.
    float u = 1.0 - t;
    return vec3(1.0 - u * u * u, t * t * (3.0 - 2.0 * t) * 0.9, 0.25 + 0.6 * t * u * 2.0);
}
void main() {
    precise float x = (gl_FragCoord.x - 128.0) * (1.0 / 80.0);
    precise float y = (gl_FragCoord.y - 128.0) * (1.0 / 80.0);
    int turns = 0;
    while (turns < kMaxTurns) {
        precise float xx = x * x;
        precise float yy = y * y;
        if (xx + yy > 16.0) break;
        precise float next = xx - yy;
        precise float product = x * y;
        x = next + -0.8125;
        y = product + product + 0.171875;
        ++turns;
    }
    color = turns == kMaxTurns ? vec4(0.05, 0.04, 0.09, 1.0) : vec4(palette(float(turns % 32) * (1.0 / 32.0)), 1.0);
}
)");
    record.specialize(fragmentShader, 3, 96);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), fragmentShader);
    record.pass(kSceneExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 3);
    record.output(target);
    return record.finish();
}

Result<Scene> integer_noise() {
    constexpr VkExtent2D kExtent{239, 211};
    SceneRecorder record(
        "integer_noise",
        "Five octaves of value noise from an integer hash, banded like a map: integer arithmetic, shifts and "
        "switches; 239 x 211 pixels.");
    const uint32_t target = record.colorTarget("color", kRgba8, kExtent);
    const uint32_t pipeline = record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out vec4 color;
uint hash(uvec2 p) {
    uint h = p.x * 0x9E3779B1u ^ p.y * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    return h ^ (h >> 15);
}
// Fixed point with 8 fraction bits throughout: the same on every driver.
int corner(uvec2 p) { return int(hash(p) & 0xffffu); }
int noise(uvec2 p) {
    uvec2 cell = p >> 8;
    int fx = int(p.x & 255u);
    int fy = int(p.y & 255u);
    fx = (fx * fx * (768 - 2 * fx)) >> 16;
    fy = (fy * fy * (768 - 2 * fy)) >> 16;
    int top = corner(cell) * (256 - fx) + corner(cell + uvec2(1, 0)) * fx;
    int bottom = corner(cell + uvec2(0, 1)) * (256 - fx) + corner(cell + uvec2(1, 1)) * fx;
    return ((top >> 8) * (256 - fy) + (bottom >> 8) * fy) >> 8;
}
void main() {
    uvec2 p = uvec2(gl_FragCoord.xy) * 4u + 4096u;
    int height = 0;
    for (int octave = 0; octave < 5; ++octave) {
        height += noise((p << octave) + uint(octave) * 7919u) >> (octave + 1);
    }
    int band = height >> 11;
    vec3 base;
    switch (band) {
        case 0: case 1: case 2: case 3: case 4: case 5: case 6: case 7: case 8: case 9: case 10: case 11: case 12:
            base = vec3(0.13, 0.32, 0.52); break;
        case 13: base = vec3(0.24, 0.5, 0.66); break;
        case 14: base = vec3(0.91, 0.85, 0.64); break;
        case 15: case 16: base = vec3(0.49, 0.67, 0.36); break;
        case 17: case 18: base = vec3(0.3, 0.52, 0.3); break;
        case 19: base = vec3(0.5, 0.45, 0.38); break;
        default: base = vec3(0.95, 0.95, 0.96); break;
    }
    // Every band darkens towards its lower border, like the contours of a map.
    float shade = float(height & 2047) * (1.0 / 2048.0);
    color = vec4(base * (0.82 + 0.18 * shade), 1.0);
}
)"));
    record.pass(kExtent).color(target, {0, 0, 0, 1});
    record.draw(pipeline, 3);
    record.output(target);
    return record.finish();
}

}  // namespace vernier::conformance::scenes
