#include "samples/common/obj_file.h"

#include <tiny_obj_loader.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>

namespace samples {
namespace {

/// Adds corners to a part; those that agree in all three indices are one vertex.
class PartBuilder {
  public:
    PartBuilder(const tinyobj::attrib_t& attributes, bool smooth, MeshData& mesh)
        : attributes_(attributes), smooth_(smooth), mesh_(mesh) {}

    /// False where the file has no such vertex, normal or texture coordinate.
    bool add(const tinyobj::index_t& index) {
        const auto key = std::make_tuple(index.vertex_index, index.normal_index, index.texcoord_index);
        // With normals of faces each corner is its own.
        if (const auto found = known_.find(key); found != known_.end() && (smooth_ || index.normal_index >= 0)) {
            mesh_.indices.push_back(found->second);
            return true;
        }
        MeshVertex vertex{};
        float uv[2] = {0, 1};
        if (index.vertex_index < 0 || !read(attributes_.vertices, index.vertex_index, 3, &vertex.position[0]) ||
            !read(attributes_.normals, index.normal_index, 3, &vertex.normal[0]) ||
            !read(attributes_.texcoords, index.texcoord_index, 2, uv))
            return false;
        if (index.normal_index < 0) normals_ = false;
        vertex.uv = {uv[0], 1 - uv[1]};
        known_[key] = static_cast<uint32_t>(mesh_.vertices.size());
        mesh_.indices.push_back(known_[key]);
        mesh_.vertices.push_back(vertex);
        return true;
    }
    void finish() {
        if (!normals_) computeNormals(mesh_);
    }

  private:
    /// An index below 0 stands for nothing: `to` stays.
    static bool read(const std::vector<tinyobj::real_t>& from, int index, size_t count, float* to) {
        if (index < 0) return true;
        const size_t first = static_cast<size_t>(index) * count;
        if (first + count > from.size()) return false;
        for (size_t c = 0; c < count; ++c) to[c] = static_cast<float>(from[first + c]);
        return true;
    }

    const tinyobj::attrib_t& attributes_;
    bool smooth_, normals_ = true;
    MeshData& mesh_;
    std::map<std::tuple<int, int, int>, uint32_t> known_;
};

}  // namespace

bool readObj(const std::string& path, bool smooth, ObjModel& model, std::string& error) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path)) {
        error = path + ": " + (reader.Error().empty() ? "could not be read" : reader.Error());
        return false;
    }
    model = {};
    model.warning = reader.Warning();
    for (const tinyobj::material_t& from : reader.GetMaterials())
        model.materials.push_back({from.name,
                                   {from.diffuse[0], from.diffuse[1], from.diffuse[2]},
                                   from.shininess,
                                   from.dissolve,
                                   from.diffuse_texname});
    model.parts.resize(model.materials.size() + 1);
    std::vector<PartBuilder> builders;
    for (MeshData& part : model.parts) builders.emplace_back(reader.GetAttrib(), smooth, part);
    for (const tinyobj::shape_t& shape : reader.GetShapes())
        for (size_t i = 0; i < shape.mesh.indices.size(); ++i) {
            const int material = i / 3 < shape.mesh.material_ids.size() ? shape.mesh.material_ids[i / 3] : -1;
            const bool known = material >= 0 && static_cast<size_t>(material) < model.materials.size();
            if (!builders[known ? static_cast<size_t>(material) : model.materials.size()].add(shape.mesh.indices[i])) {
                error = path + ": triangle " + std::to_string(i / 3) + " of \"" + shape.name +
                        "\" has an index that the file has no vertex, normal or texture coordinate for";
                return false;
            }
        }
    for (PartBuilder& builder : builders) builder.finish();
    bool empty = true;
    for (const MeshData& part : model.parts) {
        empty = empty && part.indices.empty();
        if (!positionsAreFinite(part)) {
            error = path + ": a position is not a number below 1e18";
            return false;
        }
    }
    if (empty) error = path + " has no triangles";
    return !empty;
}

MeshData loadObj(const std::string& path, bool smooth) {
    ObjModel model;
    std::string error;
    if (!readObj(path, smooth, model, error)) {
        std::fprintf(stderr, "%s\n", error.c_str());
        std::exit(1);
    }
    MeshData mesh;
    for (const MeshData& part : model.parts) {
        const auto first = static_cast<uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const uint32_t index : part.indices) mesh.indices.push_back(first + index);
    }
    return mesh;
}

Ball ballAround(const std::vector<MeshData*>& meshes) {
    glm::vec3 low(0), high(0);
    bool first = true;
    for (const MeshData* mesh : meshes)
        for (const MeshVertex& vertex : mesh->vertices) {
            low = first ? vertex.position : glm::min(low, vertex.position);
            high = first ? vertex.position : glm::max(high, vertex.position);
            first = false;
        }
    const float radius = glm::length(high - low) * 0.5f;
    return {(low + high) * 0.5f, radius > 0 ? radius : 1};
}

void moveIntoUnitBall(const Ball& ball, MeshData& mesh) {
    for (MeshVertex& vertex : mesh.vertices) vertex.position = (vertex.position - ball.center) / ball.radius;
}

void fitIntoUnitBall(const std::vector<MeshData*>& meshes) {
    const Ball ball = ballAround(meshes);
    for (MeshData* mesh : meshes) moveIntoUnitBall(ball, *mesh);
}

void fitIntoUnitBall(MeshData& mesh) {
    fitIntoUnitBall(std::vector<MeshData*>{&mesh});
}

bool positionsAreFinite(const MeshData& mesh) {
    for (const MeshVertex& vertex : mesh.vertices)
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(vertex.position[c]) < 1e18f)) return false;
    return true;
}

}  // namespace samples
