// Shows a Wavefront OBJ file with half-Lambert light: obj_viewer [FILE.obj]. Without a file it shows a torus knot of
// its own. Normals are computed where the file has none.
#include <tiny_obj_loader.h>

#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "samples/common/app.h"

namespace {

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { mat4 transform; mat4 model; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldNormal;
void main() {
    worldNormal = mat3(model) * normal;
    gl_Position = transform * vec4(position, 1);
})";

// Half-Lambert: the cosine is moved from -1..1 to 0..1 and squared, so that the side turned away is not flat.
constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec3 worldNormal;
layout(location = 0) out vec4 color;
void main() {
    float cosine = dot(normalize(worldNormal), normalize(vec3(0.5, 0.8, 0.6)));
    float light = cosine * 0.5 + 0.5;
    color = vec4(vec3(0.9, 0.75, 0.55) * light * light + 0.02, 1);
})";

struct Vertex {
    glm::vec3 position, normal;
};

/// Three vertices per triangle, normals as in the file or of the face.
std::vector<Vertex> loadObj(const std::string& path) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path)) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), reader.Error().c_str());
        std::exit(1);
    }
    const tinyobj::attrib_t& attributes = reader.GetAttrib();
    std::vector<Vertex> vertices;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        const auto& indices = shape.mesh.indices;
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            glm::vec3 corner[3];
            for (size_t k = 0; k < 3; ++k)
                for (int c = 0; c < 3; ++c)
                    corner[k][c] = attributes.vertices[static_cast<size_t>(indices[i + k].vertex_index) * 3 + c];
            const glm::vec3 face = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            for (size_t k = 0; k < 3; ++k) {
                glm::vec3 normal = face;
                if (const int n = indices[i + k].normal_index; n >= 0)
                    for (int c = 0; c < 3; ++c) normal[c] = attributes.normals[static_cast<size_t>(n) * 3 + c];
                vertices.push_back({corner[k], normal});
            }
        }
    }
    return vertices;
}

/// A (2, 3) torus knot as a tube.
std::vector<Vertex> torusKnot() {
    constexpr int kSegments = 240, kSides = 20;
    const auto center = [](float t) {
        const float r = 2 + std::cos(3 * t);
        return glm::vec3(r * std::cos(2 * t), r * std::sin(2 * t), -std::sin(3 * t));
    };
    const auto at = [&](int segment, int side) -> Vertex {
        const float t = 6.2831853f * static_cast<float>(segment % kSegments) / kSegments;
        const float a = 6.2831853f * static_cast<float>(side % kSides) / kSides;
        const glm::vec3 tangent = glm::normalize(center(t + 0.01f) - center(t - 0.01f));
        const glm::vec3 across = glm::normalize(glm::cross(tangent, glm::normalize(center(t))));
        const glm::vec3 normal = across * std::cos(a) + glm::cross(tangent, across) * std::sin(a);
        return {center(t) + normal * 0.45f, normal};
    };
    std::vector<Vertex> vertices;
    for (int s = 0; s < kSegments; ++s)
        for (int k = 0; k < kSides; ++k) {
            const Vertex a = at(s, k), b = at(s + 1, k), c = at(s, k + 1), d = at(s + 1, k + 1);
            vertices.insert(vertices.end(), {a, b, c, c, b, d});
        }
    return vertices;
}

}  // namespace

int main(int argc, char** argv) {
    // A first argument that is no option is the file.
    std::string file;
    if (argc > 1 && argv[1][0] != '-') {
        file = argv[1];
        argv[1] = argv[0];
        --argc;
        ++argv;
    }
    samples::App app(samples::parseOptions(argc, argv, "OBJ viewer"));
    const std::vector<Vertex> vertices = file.empty() ? torusKnot() : loadObj(file);
    if (vertices.empty()) {
        std::fprintf(stderr, "%s has no triangles\n", file.c_str());
        return 1;
    }
    glm::vec3 low = vertices[0].position, high = low;
    for (const Vertex& vertex : vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    const glm::vec3 middle = (low + high) * 0.5f;
    const float radius = glm::length(high - low) * 0.5f;

    const VnProgram program = app.program(kVertex, kFragment);
    const VnBuffer buffer = app.buffer(vertices);
    const VnVertexAttribute attributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                                            {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)}};
    const VnVertexBinding binding{sizeof(Vertex), 0};
    VnVertexLayoutDesc layoutDesc{};
    layoutDesc.attributes = attributes;
    layoutDesc.attributeCount = 2;
    layoutDesc.bindings = &binding;
    layoutDesc.bindingCount = 1;
    VnVertexLayout layout{};
    vnCreateVertexLayout(app.device(), &layoutDesc, &layout);
    VnDepthStencilStateDesc depthDesc{};
    depthDesc.depthTest = depthDesc.depthWrite = 1;
    VnDepthStencilState depth{};
    vnCreateDepthStencilState(app.device(), &depthDesc, &depth);

    return app.run({0.04f, 0.05f, 0.07f, 1}, [&](double seconds) {
        struct {
            glm::mat4 transform, model;
        } push;
        push.model = glm::rotate(glm::mat4(1), static_cast<float>(seconds * 0.7), glm::vec3(0, 1, 0)) *
                     glm::translate(glm::mat4(1), -middle);
        const glm::mat4 view = glm::lookAt(glm::vec3(0, 0.4f, 2.2f) * radius, glm::vec3(0), glm::vec3(0, 1, 0));
        push.transform = samples::perspective(0.9f, app.aspect(), radius * 0.1f, radius * 10) * view * push.model;
        VnContext context = app.context();
        vnBindProgram(context, program);
        vnBindVertexLayout(context, layout);
        vnBindVertexBuffer(context, 0, buffer, 0);
        vnBindDepthStencilState(context, depth);
        vnPushConstants(context, 0, &push, sizeof push);
        vnDraw(context, static_cast<uint32_t>(vertices.size()), 1, 0, 0);
    });
}
