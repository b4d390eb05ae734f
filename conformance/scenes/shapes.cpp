#include "conformance/scenes/shapes.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <string_view>

namespace vernier::conformance {
namespace {

constexpr double kTau = 6.283185307179586476925;

Bytes texels(const std::vector<glm::u8vec4>& picture) {
    const auto bytes = std::as_bytes(std::span(picture));
    return Bytes(bytes.begin(), bytes.end());
}

glm::mat4 vulkanClip(glm::dmat4 projection, const glm::dmat4& view) {
    projection[1] = -projection[1];  // GLM's clip space is y up
    return glm::mat4(projection * view);
}

}  // namespace

glm::mat4 cameraMatrix(glm::dvec3 eye, glm::dvec3 target, double fieldOfView, double aspect, double nearZ,
                       double farZ) {
    return vulkanClip(glm::perspectiveRH_ZO(glm::radians(fieldOfView), aspect, nearZ, farZ),
                      glm::lookAtRH(eye, target, glm::dvec3(0, 1, 0)));
}

glm::mat4 orthographicMatrix(glm::dvec3 eye, glm::dvec3 target, double halfSize, double nearZ, double farZ) {
    return vulkanClip(glm::orthoRH_ZO(-halfSize, halfSize, -halfSize, halfSize, nearZ, farZ),
                      glm::lookAtRH(eye, target, glm::dvec3(0, 1, 0)));
}

uint32_t SceneRandom::next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + 1442695040888963407ull;
    const uint32_t shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const uint32_t rotation = static_cast<uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
}

Mesh cubeMesh() {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 normal(0), u(0), v(0);
            normal[axis] = side;
            u[(axis + 1) % 3] = 1;
            v[(axis + 2) % 3] = side;  // keeps (u, v, normal) right-handed
            const auto base = static_cast<uint16_t>(mesh.vertices.size());
            for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
                const glm::vec3 position = normal + u * (2 * uv.x - 1) + v * (2 * uv.y - 1);
                mesh.vertices.push_back({position, normal, uv});
            }
            for (const int corner : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(static_cast<uint16_t>(base + corner));
        }
    }
    return mesh;
}

Mesh sphereMesh(uint32_t slices, uint32_t stacks) {
    Mesh mesh;
    for (uint32_t stack = 0; stack <= stacks; ++stack) {
        const double polar = kTau / 2 * stack / stacks;
        for (uint32_t slice = 0; slice <= slices; ++slice) {
            const double azimuth = kTau * slice / slices;
            const glm::vec3 normal(
                glm::dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)));
            const glm::vec2 uv(static_cast<float>(slice) / static_cast<float>(slices),
                               static_cast<float>(stack) / static_cast<float>(stacks));
            mesh.vertices.push_back({normal, normal, uv});
        }
    }
    const auto at = [&](uint32_t stack, uint32_t slice) { return static_cast<uint16_t>(stack * (slices + 1) + slice); };
    for (uint32_t stack = 0; stack < stacks; ++stack) {
        for (uint32_t slice = 0; slice < slices; ++slice) {
            const uint16_t a = at(stack, slice), b = at(stack, slice + 1);
            const uint16_t c = at(stack + 1, slice), d = at(stack + 1, slice + 1);
            // At the poles one triangle of each quad has no area.
            if (stack != 0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
            if (stack + 1 != stacks) mesh.indices.insert(mesh.indices.end(), {b, d, c});
        }
    }
    return mesh;
}

std::string torusKnotObj(uint32_t segments, uint32_t sides) {
    constexpr double kTube = 0.36;
    const auto center = [](double t) {
        const double radius = 2 + std::cos(3 * t);
        return glm::dvec3(radius * std::cos(2 * t), std::sin(3 * t), radius * std::sin(2 * t)) * 0.5;
    };
    std::string text = "# (2, 3) torus knot\no knot\n";
    std::array<char, 160> line{};
    const auto add = [&](const char* format, auto... values) {
        const int length = std::snprintf(line.data(), line.size(), format, values...);
        text.append(line.data(), static_cast<size_t>(length));
    };
    for (uint32_t i = 0; i < segments; ++i) {
        const double t = kTau * i / segments;
        const glm::dvec3 here = center(t);
        const glm::dvec3 tangent = glm::normalize(center(t + 1e-4) - center(t - 1e-4));
        const glm::dvec3 side = glm::normalize(glm::cross(tangent, glm::dvec3(here.x, 3, here.z)));
        const glm::dvec3 up = glm::cross(side, tangent);
        for (uint32_t j = 0; j < sides; ++j) {
            const double angle = kTau * j / sides;
            const glm::dvec3 normal = side * std::cos(angle) + up * std::sin(angle);
            const glm::dvec3 position = here + normal * kTube;
            add("v %.6f %.6f %.6f\n", position.x, position.y, position.z);
            add("vn %.6f %.6f %.6f\n", normal.x, normal.y, normal.z);
            add("vt %.6f %.6f\n", static_cast<double>(i) / segments, static_cast<double>(j) / sides);
        }
    }
    const auto at = [&](uint32_t i, uint32_t j) { return (i % segments) * sides + j % sides + 1; };
    for (uint32_t i = 0; i < segments; ++i) {
        for (uint32_t j = 0; j < sides; ++j) {
            const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            add("f %u/%u/%u %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c, d, d, d);
        }
    }
    return text;
}

Bytes checkerPicture(VkExtent2D extent, uint32_t cell, glm::u8vec4 first, glm::u8vec4 second) {
    std::vector<glm::u8vec4> picture;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            picture.push_back((x / cell + y / cell) % 2 == 0 ? first : second);
        }
    }
    return texels(picture);
}

Bytes noisePicture(VkExtent2D extent, uint64_t seed) {
    SceneRandom random(seed);
    std::vector<glm::u8vec4> picture(size_t{extent.width} * extent.height);
    for (glm::u8vec4& texel : picture) {
        const uint32_t bits = random.next();
        texel = {bits & 255, (bits >> 8) & 255, (bits >> 16) & 255, 255};
    }
    return texels(picture);
}

Bytes spritePicture() {
    constexpr std::string_view kRows =
        "...oooo....."
        "..ossssoo..."
        ".osswwssso.."
        ".oswkkwsso.b"
        "osswkkwssobb"
        "osssssssobbo"
        "orrrsssobbo."
        "orrrrssbbo.."
        ".orrsssbo..."
        "..osssso...."
        "..ogo.ogo..."
        ".oggooggo...";
    std::vector<glm::u8vec4> picture;
    for (const char code : kRows) {
        switch (code) {
            case 'o':
                picture.push_back({27, 31, 59, 255});
                break;
            case 's':
                picture.push_back({242, 193, 78, 255});
                break;
            case 'w':
                picture.push_back({252, 252, 247, 255});
                break;
            case 'k':
                picture.push_back({20, 20, 24, 255});
                break;
            case 'r':
                picture.push_back({218, 65, 103, 255});
                break;
            case 'b':
                picture.push_back({63, 136, 197, 255});
                break;
            case 'g':
                picture.push_back({95, 173, 86, 255});
                break;
            default:
                picture.push_back({219, 235, 240, 255});
                break;
        }
    }
    return texels(picture);
}

const char* const kColorVertexGlsl = R"(#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = vec4(position, 0.0, 1.0);
    vColor = color;
}
)";

const char* const kDepthColorVertexGlsl = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 vColor;
void main() {
    gl_Position = vec4(position, 1.0);
    vColor = color;
}
)";

const char* const kColorFragmentGlsl = R"(#version 450
layout(location = 0) in vec3 vColor;
layout(location = 0) out vec4 color;
void main() { color = vec4(vColor, 1.0); }
)";

const char* const kTexturedVertexGlsl = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec2 vUv;
void main() {
    gl_Position = position;
    vUv = uv;
}
)";

const char* const kTexturedFragmentGlsl = R"(#version 450
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) in vec2 vUv;
layout(location = 0) out vec4 color;
void main() { color = texture(picture, vUv); }
)";

const char* const kCoverVertexGlsl = R"(#version 450
void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

PipelineRecorder depthColorPipeline(SceneRecorder& record, const char* vertexGlsl, const char* fragmentGlsl) {
    return record.pipeline(record.vertex(vertexGlsl), record.fragment(fragmentGlsl))
        .binding(sizeof(DepthColorVertex))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(DepthColorVertex, position))
        .attribute(VK_FORMAT_R32G32B32_SFLOAT, offsetof(DepthColorVertex, color));
}

}  // namespace vernier::conformance
