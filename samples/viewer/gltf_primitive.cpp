#include "samples/viewer/gltf_primitive.h"

#include <cmath>

#include "samples/common/obj_file.h"
#include "samples/viewer/gltf_accessor.h"

namespace samples {
namespace {

/// Strips and fans as lists (glTF 2.0, 3.7.2.1).
std::vector<uint32_t> trianglesOf(const std::vector<uint32_t>& order, int mode) {
    std::vector<uint32_t> list;
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP || mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (size_t i = 0; i + 2 < order.size(); ++i)
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
                list.insert(list.end(), {order[i + 1], order[i + 2], order[0]});
            else
                list.insert(list.end(), {order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]});
        return list;
    }
    list.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(order.size() / 3 * 3));
    return list;
}

/// A mesh without normals has those of its faces (glTF 2.0, 3.7.2.1).
void makeFlat(GltfPrimitive& primitive) {
    GltfPrimitive flat;
    flat.part.material = primitive.part.material;
    const MeshData& mesh = primitive.part.mesh;
    for (const uint32_t index : mesh.indices) {
        flat.part.mesh.indices.push_back(static_cast<uint32_t>(flat.part.mesh.vertices.size()));
        flat.part.mesh.vertices.push_back(mesh.vertices[index]);
        if (!primitive.part.extras.empty()) flat.part.extras.push_back(primitive.part.extras[index]);
        if (!primitive.joints.empty()) flat.joints.push_back(primitive.joints[index]);
    }
    computeNormals(flat.part.mesh);
    primitive = std::move(flat);
}

/// Tangents along u, from the triangles around each vertex. Normals of a map have y upwards, against v ("+Y is up",
/// glTF 2.0, 3.9.3).
void addTangents(ScenePart& part) {
    MeshData& mesh = part.mesh;
    std::vector<glm::vec3> alongU(mesh.vertices.size(), glm::vec3(0)), alongV = alongU;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* corner = &mesh.indices[i];
        const MeshVertex &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
        const glm::vec3 e1 = b.position - a.position, e2 = c.position - a.position;
        const glm::vec2 d1 = b.uv - a.uv, d2 = c.uv - a.uv;
        // Of which only the sign matters, and that areas in u and v weigh.
        const float side = d1.x * d2.y - d1.y * d2.x < 0 ? -1.0f : 1.0f;
        for (int k = 0; k < 3; ++k) {
            alongU[corner[k]] += (e1 * d2.y - e2 * d1.y) * side;
            alongV[corner[k]] += (e2 * d1.x - e1 * d2.x) * side;
        }
    }
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
        const glm::vec3 normal = mesh.vertices[i].normal;
        const glm::vec3 t = alongU[i] - normal * glm::dot(normal, alongU[i]);
        const float length = glm::length(t);
        // Where nothing says which way u goes, normals are left as they are.
        if (!(length > 0) || !std::isfinite(length)) continue;
        const float side = glm::dot(glm::cross(normal, t), alongV[i]) < 0 ? 1.0f : -1.0f;
        part.extras[i].tangent = glm::vec4(t / length, side);
    }
}

}  // namespace

bool readGltfPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, int set, bool extras,
                       GltfPrimitive& result, std::string& error) {
    ScenePart& part = result.part;
    std::vector<float> positions, normals, coordinates, tangents, colors, weights, joints;
    const auto find = [&](const std::string& name) {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    };
    const auto attribute = [&](const std::string& name, int components, std::vector<float>& values) {
        if (primitive.attributes.count(name) == 0) return true;
        if (readFloats(model, find(name), components, values, error)) return true;
        error = name + ": " + error;
        return false;
    };
    const int colorWidth = componentsOf(model, find("COLOR_0")) == 3 ? 3 : 4;
    if (!attribute("POSITION", 3, positions) || !attribute("NORMAL", 3, normals) ||
        !attribute("TEXCOORD_" + std::to_string(set), 2, coordinates) || !attribute("COLOR_0", colorWidth, colors) ||
        !attribute("JOINTS_0", 4, joints) || !attribute("WEIGHTS_0", 4, weights) ||
        (extras && !attribute("TANGENT", 4, tangents)))
        return false;
    const size_t count = positions.size() / 3;
    if (count == 0) {
        error = "has no POSITION";
        return false;
    }
    const auto fits = [&](const std::vector<float>& values, int width) {
        return values.empty() || values.size() / static_cast<size_t>(width) == count;
    };
    if (!fits(normals, 3) || !fits(coordinates, 2) || !fits(tangents, 4) || !fits(colors, colorWidth) ||
        !fits(joints, 4) || !fits(weights, 4)) {
        error = "its attributes have different counts";
        return false;
    }
    const auto vec3At = [](const std::vector<float>& values, size_t i) {
        return glm::vec3(values[i * 3], values[i * 3 + 1], values[i * 3 + 2]);
    };
    const auto vec4At = [](const std::vector<float>& values, size_t i) {
        return glm::vec4(values[i * 4], values[i * 4 + 1], values[i * 4 + 2], values[i * 4 + 3]);
    };
    const bool skinned = !joints.empty() && !weights.empty();
    for (size_t i = 0; i < count; ++i) {
        MeshVertex vertex{};
        vertex.position = vec3At(positions, i);
        if (!normals.empty()) vertex.normal = vec3At(normals, i);
        if (!coordinates.empty()) vertex.uv = {coordinates[i * 2], coordinates[i * 2 + 1]};
        part.mesh.vertices.push_back(vertex);
        if (extras || !colors.empty()) {
            VertexExtras& more = part.extras.emplace_back();
            if (!colors.empty()) more.color = colorWidth == 3 ? glm::vec4(vec3At(colors, i), 1) : vec4At(colors, i);
            if (!tangents.empty()) more.tangent = vec4At(tangents, i);
        }
        if (!skinned) continue;
        VertexJoints& moved = result.joints.emplace_back();
        float sum = 0;
        for (size_t k = 0; k < 4; ++k) {
            const float joint = joints[i * 4 + k], weight = weights[i * 4 + k];
            if (!(joint >= 0 && joint < 65536) || !(weight >= 0 && weight < 1e9f)) {
                error = "vertex " + std::to_string(i) + " has no joint, or no weight";
                return false;
            }
            moved.joints[k] = static_cast<uint32_t>(joint);
            moved.weights[k] = weight;
            sum += weight;
        }
        for (float& weight : moved.weights) weight = sum > 0 ? weight / sum : 0;
    }
    if (!positionsAreFinite(part.mesh)) {
        error = "a position is not a number below 1e18";
        return false;
    }
    std::vector<uint32_t> order(count);
    for (size_t i = 0; i < count; ++i) order[i] = static_cast<uint32_t>(i);
    if (primitive.indices >= 0 && !readIndices(model, primitive.indices, order, error)) {
        error = "indices: " + error;
        return false;
    }
    for (const uint32_t index : order)
        if (index >= count) {
            error = "index " + std::to_string(index) + ", but there are " + std::to_string(count) + " vertices";
            return false;
        }
    part.mesh.indices = trianglesOf(order, primitive.mode);
    if (normals.empty()) makeFlat(result);
    // Without normals of its own a mesh has no tangents of its own (glTF 2.0, 3.7.2.1).
    if (extras && (tangents.empty() || normals.empty())) addTangents(part);
    return true;
}

}  // namespace samples
