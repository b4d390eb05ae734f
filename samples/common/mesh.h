// Indexed triangle meshes and a few solids, made in code. Faces are counter-clockwise seen from outside.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace samples {

struct MeshVertex {
    glm::vec3 position, normal;
    glm::vec2 uv;
};

struct MeshData {
    std::vector<MeshVertex> vertices;
    std::vector<uint32_t> indices;
};

/// A grid of columns x rows quads; `at(u, v)` gives the vertex for u, v in 0..1. Seen with u to the right and v up, it
/// turns counter-clockwise.
MeshData gridMesh(uint32_t columns, uint32_t rows, const std::function<MeshVertex(float u, float v)>& at);

/// From -1 to 1 on every axis, each face with its own normal and the whole texture.
MeshData boxMesh();
MeshData sphereMesh(float radius, uint32_t columns = 32, uint32_t rows = 16);
/// Around the y axis.
MeshData torusMesh(float ringRadius, float tubeRadius, uint32_t columns = 48, uint32_t rows = 20);
/// In the plane y = 0, from -half to half, facing up; the texture repeats `repeats` times.
MeshData planeMesh(float half, float repeats = 1);
/// The (2, 3) torus knot as a tube.
MeshData torusKnotMesh(uint32_t columns = 240, uint32_t rows = 20);

/// Normals from the triangles around each vertex, weighted by their area; vertices are told apart by index.
void computeNormals(MeshData& mesh);

/// Adds `other`, moved.
void append(MeshData& mesh, const MeshData& other, const glm::mat4& transform);

}  // namespace samples
