#include "samples/common/mesh.h"

#include "samples/common/trigonometry.h"

namespace samples {

MeshData gridMesh(uint32_t columns, uint32_t rows, const std::function<MeshVertex(float, float)>& at) {
    MeshData mesh;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column)
            mesh.vertices.push_back(at(static_cast<float>(column) / static_cast<float>(columns),
                                       static_cast<float>(row) / static_cast<float>(rows)));
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * (columns + 1) + column, b = a + 1, c = a + columns + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
        }
    return mesh;
}

MeshData boxMesh() {
    MeshData mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto first = static_cast<uint32_t>(mesh.vertices.size());
            for (int corner = 0; corner < 4; ++corner) {
                const glm::vec2 uv(corner & 1, corner >> 1);
                MeshVertex vertex{glm::vec3(0), glm::vec3(0), uv};
                vertex.normal[axis] = vertex.position[axis] = side;
                vertex.position[(axis + 1) % 3] = (uv.x * 2 - 1) * side;
                vertex.position[(axis + 2) % 3] = uv.y * 2 - 1;
                mesh.vertices.push_back(vertex);
            }
            for (const uint32_t index : {0u, 1u, 2u, 2u, 1u, 3u}) mesh.indices.push_back(first + index);
        }
    return mesh;
}

MeshData sphereMesh(float radius, uint32_t columns, uint32_t rows) {
    return gridMesh(columns, rows, [&](float u, float v) {
        const double longitude = 2 * kPi * u, latitude = kPi * (v - 0.5);
        const float across = cosineF(latitude);
        const glm::vec3 normal(across * cosineF(longitude), sineF(latitude), -across * sineF(longitude));
        return MeshVertex{normal * radius, normal, {u, 1 - v}};
    });
}

MeshData torusMesh(float ringRadius, float tubeRadius, uint32_t columns, uint32_t rows) {
    return gridMesh(columns, rows, [&](float u, float v) {
        const double around = 2 * kPi * u, tube = 2 * kPi * v;
        const glm::vec3 out(cosineF(around), 0, -sineF(around));
        const glm::vec3 normal = out * cosineF(tube) + glm::vec3(0, sineF(tube), 0);
        return MeshVertex{out * ringRadius + normal * tubeRadius, normal, {u * 4, v}};
    });
}

MeshData planeMesh(float half, float repeats) {
    return gridMesh(1, 1, [&](float u, float v) {
        return MeshVertex{{(u * 2 - 1) * half, 0, (1 - v * 2) * half}, {0, 1, 0}, {u * repeats, v * repeats}};
    });
}

MeshData torusKnotMesh(uint32_t columns, uint32_t rows) {
    const auto center = [](double t) {
        const double r = 2 + cosine(3 * t);
        return glm::vec3(static_cast<float>(r * cosine(2 * t)), static_cast<float>(r * sine(2 * t)), -sineF(3 * t));
    };
    return gridMesh(columns, rows, [&](float u, float v) {
        const double t = 2 * kPi * u, a = 2 * kPi * v;
        const glm::vec3 tangent = glm::normalize(center(t + 0.01) - center(t - 0.01));
        const glm::vec3 across = glm::normalize(glm::cross(tangent, glm::normalize(center(t))));
        const glm::vec3 normal = across * cosineF(a) + glm::cross(tangent, across) * sineF(a);
        return MeshVertex{center(t) + normal * 0.45f, normal, {u * 24, v * 2}};
    });
}

void computeNormals(MeshData& mesh) {
    for (MeshVertex& vertex : mesh.vertices) vertex.normal = glm::vec3(0);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        MeshVertex* corners[3];
        for (size_t k = 0; k < 3; ++k) corners[k] = &mesh.vertices[mesh.indices[i + k]];
        const glm::vec3 twiceArea =
            glm::cross(corners[1]->position - corners[0]->position, corners[2]->position - corners[0]->position);
        for (MeshVertex* corner : corners) corner->normal += twiceArea;
    }
    for (MeshVertex& vertex : mesh.vertices)
        if (glm::dot(vertex.normal, vertex.normal) > 0) vertex.normal = glm::normalize(vertex.normal);
}

void append(MeshData& mesh, const MeshData& other, const glm::mat4& transform) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    const glm::mat3 turn = glm::transpose(glm::inverse(glm::mat3(transform)));
    for (const MeshVertex& vertex : other.vertices)
        mesh.vertices.push_back(
            {glm::vec3(transform * glm::vec4(vertex.position, 1)), glm::normalize(turn * vertex.normal), vertex.uv});
    for (const uint32_t index : other.indices) mesh.indices.push_back(first + index);
}

}  // namespace samples
