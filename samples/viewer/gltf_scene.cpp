#include "samples/viewer/gltf_scene.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>

#include "samples/common/obj_file.h"
#include "samples/common/transform.h"
#include "samples/viewer/gltf_accessor.h"
#include "samples/viewer/gltf_file.h"

namespace samples {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization";

class Builder {
  public:
    Builder(const tinygltf::Model& model, const std::vector<Picture>& pictures, Scene& scene)
        : model_(model), pictures_(pictures), scene_(scene) {}

    bool build(std::string& error) {
        for (const std::string& extension : model_.extensionsRequired)
            if (extension != kQuantization) {
                error = "needs the extension " + extension + ", which the viewer lacks";
                return false;
            }
        for (const tinygltf::Material& from : model_.materials) addMaterial(from);
        scene_.materials.push_back({"", {0.8f, 0.8f, 0.8f, 1}});
        if (!addNodes(error)) return false;
        const auto note = [&](bool wanted, const char* text) {
            if (wanted) scene_.notes.emplace_back(text);
        };
        note(!model_.animations.empty(), "animations are not played");
        note(!model_.skins.empty(), "skins are shown in the pose of their mesh");
        note(leftOut_ > 0, "points and lines are not shown");
        note(colors_, "colours of vertices are not shown");
        for (const std::string& extension : model_.extensionsUsed)
            note(extension != kQuantization, ("the extension " + extension + " is left out").c_str());
        if (scene_.parts.empty()) error = "has no triangles";
        return !scene_.parts.empty();
    }

  private:
    static glm::vec3 vec3Of(const std::vector<double>& values, const glm::vec3& otherwise) {
        return values.size() == 3 ? glm::vec3(values[0], values[1], values[2]) : otherwise;
    }

    void addMaterial(const tinygltf::Material& from) {
        SceneMaterial material;
        material.name = from.name;
        const tinygltf::PbrMetallicRoughness& surface = from.pbrMetallicRoughness;
        if (const auto& c = surface.baseColorFactor; c.size() == 4) material.color = glm::vec4(c[0], c[1], c[2], c[3]);
        material.metallic = glm::clamp(static_cast<float>(surface.metallicFactor), 0.0f, 1.0f);
        material.roughness = glm::clamp(static_cast<float>(surface.roughnessFactor), 0.05f, 1.0f);
        material.emission = vec3Of(from.emissiveFactor, glm::vec3(0));
        material.twoSided = from.doubleSided;
        material.cutoff = static_cast<float>(from.alphaCutoff);
        if (from.alphaMode == "MASK") material.alpha = Alpha::kMasked;
        if (from.alphaMode == "BLEND") material.alpha = Alpha::kBlended;
        addTexture(surface.baseColorTexture.index, material);
        textureSets_.push_back(surface.baseColorTexture.texCoord);
        scene_.materials.push_back(material);
    }

    static VkSamplerAddressMode addressOf(int wrap) {
        if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                                                             : VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }

    /// A texture that cannot be read becomes a note: the model is worth seeing without.
    void addTexture(int index, SceneMaterial& material) {
        if (index < 0) return;
        if (static_cast<size_t>(index) >= model_.textures.size()) {
            scene_.notes.push_back("there is no texture " + std::to_string(index));
            return;
        }
        const tinygltf::Texture& texture = model_.textures[static_cast<size_t>(index)];
        if (texture.sampler >= 0 && static_cast<size_t>(texture.sampler) < model_.samplers.size()) {
            const tinygltf::Sampler& sampler = model_.samplers[static_cast<size_t>(texture.sampler)];
            material.addressU = addressOf(sampler.wrapS);
            material.addressV = addressOf(sampler.wrapT);
            if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) material.filter = VK_FILTER_NEAREST;
        }
        if (const auto known = textureOfImage_.find(texture.source); known != textureOfImage_.end()) {
            material.texture = known->second;
            return;
        }
        Picture picture;
        std::string error;
        if (pictureOf(model_, pictures_, texture.source, picture, error)) {
            material.texture = static_cast<int>(scene_.textures.size());
            scene_.textures.push_back(std::move(picture));
        } else {
            scene_.notes.push_back(error);
        }
        textureOfImage_[texture.source] = material.texture;
    }

    static glm::mat4 matrixOf(const tinygltf::Node& node) {
        glm::mat4 matrix(1);
        if (node.matrix.size() == 16) {
            for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<float>(node.matrix[static_cast<size_t>(i)]);
            return matrix;
        }
        matrix = glm::translate(matrix, vec3Of(node.translation, glm::vec3(0)));
        if (const auto& r = node.rotation; r.size() == 4)
            matrix *= glm::mat4_cast(glm::quat(static_cast<float>(r[3]), static_cast<float>(r[0]),
                                               static_cast<float>(r[1]), static_cast<float>(r[2])));
        return glm::scale(matrix, vec3Of(node.scale, glm::vec3(1)));
    }

    /// The nodes of the scene form trees (glTF 2.0, 3.5.2): none is met twice.
    bool addNodes(std::string& error) {
        std::vector<std::pair<int, glm::mat4>> stack;
        if (model_.scenes.empty()) {
            // A library of meshes: each as it is.
            for (const tinygltf::Mesh& mesh : model_.meshes)
                if (!addMesh(mesh, glm::mat4(1), error)) return false;
            return true;
        }
        const int first = std::max(model_.defaultScene, 0);
        if (static_cast<size_t>(first) >= model_.scenes.size()) {
            error = "there is no scene " + std::to_string(first);
            return false;
        }
        const std::vector<int>& roots = model_.scenes[static_cast<size_t>(first)].nodes;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, glm::mat4(1));
        std::set<int> met;
        while (!stack.empty()) {
            const auto [index, parent] = stack.back();
            stack.pop_back();
            if (index < 0 || static_cast<size_t>(index) >= model_.nodes.size()) {
                error = "there is no node " + std::to_string(index);
                return false;
            }
            if (!met.insert(index).second) {
                error = "node " + std::to_string(index) + " is the child of two nodes, or of itself";
                return false;
            }
            const tinygltf::Node& node = model_.nodes[static_cast<size_t>(index)];
            const glm::mat4 matrix = parent * matrixOf(node);
            if (node.mesh >= 0) {
                if (static_cast<size_t>(node.mesh) >= model_.meshes.size()) {
                    error = "node " + std::to_string(index) + ": there is no mesh " + std::to_string(node.mesh);
                    return false;
                }
                if (!addMesh(model_.meshes[static_cast<size_t>(node.mesh)], matrix, error)) return false;
            }
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                stack.emplace_back(*child, matrix);
        }
        return true;
    }

    bool addMesh(const tinygltf::Mesh& mesh, const glm::mat4& matrix, std::string& error) {
        for (size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                ++leftOut_;
                continue;
            }
            ScenePart part;
            if (!readPrimitive(primitive, part, error) || !moveTo(matrix, part.mesh, error)) {
                error = "mesh \"" + mesh.name + "\", primitive " + std::to_string(i) + ": " + error;
                return false;
            }
            if (!part.mesh.indices.empty()) scene_.parts.push_back(std::move(part));
        }
        return true;
    }

    bool readPrimitive(const tinygltf::Primitive& primitive, ScenePart& part, std::string& error) {
        part.material = model_.materials.size();
        if (primitive.material >= 0) part.material = static_cast<size_t>(primitive.material);
        if (part.material > model_.materials.size()) {
            error = "there is no material " + std::to_string(primitive.material);
            return false;
        }
        std::vector<float> positions, normals, coordinates;
        const int set = part.material < textureSets_.size() ? textureSets_[part.material] : 0;
        const auto attribute = [&](const std::string& name, int components, std::vector<float>& values) {
            const auto found = primitive.attributes.find(name);
            if (found == primitive.attributes.end()) return true;
            if (readFloats(model_, found->second, components, values, error)) return true;
            error = name + ": " + error;
            return false;
        };
        if (!attribute("POSITION", 3, positions) || !attribute("NORMAL", 3, normals) ||
            !attribute("TEXCOORD_" + std::to_string(set), 2, coordinates))
            return false;
        colors_ = colors_ || primitive.attributes.count("COLOR_0") != 0;
        const size_t count = positions.size() / 3;
        if (count == 0) {
            error = "has no POSITION";
            return false;
        }
        if ((!normals.empty() && normals.size() / 3 != count) ||
            (!coordinates.empty() && coordinates.size() / 2 != count)) {
            error = "its attributes have different counts";
            return false;
        }
        for (size_t i = 0; i < count; ++i) {
            MeshVertex vertex{};
            for (int c = 0; c < 3; ++c) vertex.position[c] = positions[i * 3 + static_cast<size_t>(c)];
            for (int c = 0; c < 3 && !normals.empty(); ++c) vertex.normal[c] = normals[i * 3 + static_cast<size_t>(c)];
            if (!coordinates.empty()) vertex.uv = {coordinates[i * 2], coordinates[i * 2 + 1]};
            part.mesh.vertices.push_back(vertex);
        }
        if (!positionsAreFinite(part.mesh)) {
            error = "a position is not a number below 1e18";
            return false;
        }
        std::vector<uint32_t> order(count);
        for (size_t i = 0; i < count; ++i) order[i] = static_cast<uint32_t>(i);
        if (primitive.indices >= 0 && !readIndices(model_, primitive.indices, order, error)) {
            error = "indices: " + error;
            return false;
        }
        for (const uint32_t index : order)
            if (index >= count) {
                error = "index " + std::to_string(index) + ", but there are " + std::to_string(count) + " vertices";
                return false;
            }
        part.mesh.indices = trianglesOf(order, primitive.mode);
        if (normals.empty()) makeFlat(part.mesh);
        return true;
    }

    /// Strips and fans as lists (glTF 2.0, 3.7.2.1).
    static std::vector<uint32_t> trianglesOf(const std::vector<uint32_t>& order, int mode) {
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
    static void makeFlat(MeshData& mesh) {
        MeshData flat;
        for (const uint32_t index : mesh.indices) {
            flat.indices.push_back(static_cast<uint32_t>(flat.vertices.size()));
            flat.vertices.push_back(mesh.vertices[index]);
        }
        computeNormals(flat);
        mesh = std::move(flat);
    }

    static bool moveTo(const glm::mat4& matrix, MeshData& mesh, std::string& error) {
        const glm::mat3 linear(matrix);
        // Without inverse, which a flattening matrix lacks: the cofactors turn normals as well.
        const glm::mat3 turn(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
        for (MeshVertex& vertex : mesh.vertices) {
            vertex.position = glm::vec3(matrix * glm::vec4(vertex.position, 1));
            const glm::vec3 normal = turn * vertex.normal;
            if (glm::dot(normal, normal) > 0) vertex.normal = glm::normalize(normal);
        }
        // A mirrored mesh shows its triangles the other way round.
        if (glm::determinant(linear) < 0) {
            for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
            for (MeshVertex& vertex : mesh.vertices) vertex.normal = -vertex.normal;
        }
        if (positionsAreFinite(mesh)) return true;
        error = "its node moves a position beyond 1e18";
        return false;
    }

    const tinygltf::Model& model_;
    const std::vector<Picture>& pictures_;
    Scene& scene_;
    std::map<int, int> textureOfImage_;
    std::vector<int> textureSets_;  // TEXCOORD_n, by material
    size_t leftOut_ = 0;
    bool colors_ = false;
};

}  // namespace

bool readGltfScene(const std::string& path, Scene& scene, std::string& error) {
    tinygltf::Model model;
    std::vector<Picture> pictures;
    if (!readGltfFile(path, model, pictures, error)) return false;
    if (Builder(model, pictures, scene).build(error)) return true;
    error = path + ": " + error;
    return false;
}

}  // namespace samples
