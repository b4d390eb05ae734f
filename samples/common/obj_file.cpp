#include "samples/common/obj_file.h"

#include <tiny_obj_loader.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>

namespace samples {

MeshData loadObj(const std::string& path, bool smooth) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path)) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(),
                     reader.Error().empty() ? "could not be read" : reader.Error().c_str());
        std::exit(1);
    }
    const tinyobj::attrib_t& attributes = reader.GetAttrib();
    MeshData mesh;
    bool normals = true;
    // Corners that agree in all three indices are one vertex; with normals of faces each corner is its own.
    std::map<std::tuple<int, int, int>, uint32_t> known;
    for (const tinyobj::shape_t& shape : reader.GetShapes())
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            const auto key = std::make_tuple(index.vertex_index, index.normal_index, index.texcoord_index);
            if (const auto found = known.find(key); found != known.end() && (smooth || index.normal_index >= 0)) {
                mesh.indices.push_back(found->second);
                continue;
            }
            MeshVertex vertex{};
            for (int c = 0; c < 3; ++c)
                vertex.position[c] = attributes.vertices[static_cast<size_t>(index.vertex_index) * 3 + c];
            if (index.normal_index >= 0)
                for (int c = 0; c < 3; ++c)
                    vertex.normal[c] = attributes.normals[static_cast<size_t>(index.normal_index) * 3 + c];
            else
                normals = false;
            if (index.texcoord_index >= 0) {
                const size_t at = static_cast<size_t>(index.texcoord_index) * 2;
                vertex.uv = {attributes.texcoords[at], 1 - attributes.texcoords[at + 1]};
            }
            known[key] = static_cast<uint32_t>(mesh.vertices.size());
            mesh.indices.push_back(known[key]);
            mesh.vertices.push_back(vertex);
        }
    if (mesh.indices.empty()) {
        std::fprintf(stderr, "%s has no triangles\n", path.c_str());
        std::exit(1);
    }
    if (!normals) computeNormals(mesh);
    return mesh;
}

void fitIntoUnitBall(MeshData& mesh) {
    glm::vec3 low = mesh.vertices[0].position, high = low;
    for (const MeshVertex& vertex : mesh.vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    const float radius = glm::length(high - low) * 0.5f;
    for (MeshVertex& vertex : mesh.vertices)
        vertex.position = (vertex.position - (low + high) * 0.5f) / (radius > 0 ? radius : 1);
}

}  // namespace samples
