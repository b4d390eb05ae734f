#include "samples/viewer/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "samples/common/obj_file.h"
#include "samples/viewer/gltf_accessor.h"
#include "samples/viewer/gltf_animation.h"
#include "samples/viewer/gltf_file.h"
#include "samples/viewer/gltf_material.h"
#include "samples/viewer/gltf_primitive.h"

namespace samples {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization";
constexpr size_t kNoNode = SIZE_MAX;

/// What vertices are moved by: positions and tangents, and normals.
struct Move {
    explicit Move(const glm::mat4& by)
        : matrix(by),
          linear(by),
          // Without inverse, which a flattening matrix lacks: the cofactors turn normals as well.
          turn(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1])),
          mirrors(glm::determinant(linear) < 0) {}

    void apply(MeshVertex& vertex, VertexExtras* extras) const {
        vertex.position = glm::vec3(matrix * glm::vec4(vertex.position, 1));
        const glm::vec3 normal = turn * vertex.normal;
        if (glm::dot(normal, normal) > 0) vertex.normal = glm::normalize(normal);
        if (mirrors) vertex.normal = -vertex.normal;
        if (!extras) return;
        const glm::vec3 tangent = linear * glm::vec3(extras->tangent);
        const float length = glm::length(tangent);
        if (length > 0 && std::isfinite(length))
            extras->tangent = glm::vec4(tangent / length, mirrors ? -extras->tangent.w : extras->tangent.w);
    }

    glm::mat4 matrix;
    glm::mat3 linear, turn;
    bool mirrors;
};

/// The meshes of a scene where their nodes place them, at rest or at a time of an animation.
class GltfScene : public SceneMotion {
  public:
    bool read(const tinygltf::Model& model, const std::vector<int>& textureSets, Scene& scene, std::string& error) {
        for (const tinygltf::Node& node : model.nodes) places_.push_back(placeOf(node));
        parents_.assign(model.nodes.size(), kNoNode);
        materials_ = &scene.materials;
        textureSets_ = &textureSets;
        if (!readSkins(model, error) || !readNodes(model, error)) return false;
        materials_ = nullptr;
        textureSets_ = nullptr;
        readAnimations(model, scene);
        if (leftOut_ > 0) scene.notes.emplace_back("points and lines are not shown");
        if (morphs_) scene.notes.emplace_back("morph targets are not shown");
        for (const Drawn& drawn : drawn_) scene.parts.push_back(drawn.primitive.part);
        place(places_, scene.parts);
        for (const ScenePart& part : scene.parts)
            if (!positionsAreFinite(part.mesh)) {
                error = "a node moves a position beyond 1e18";
                return false;
            }
        return true;
    }

    size_t animations() const override { return animations_.size(); }
    double seconds(size_t animation) const override { return animations_.at(animation).seconds(); }
    void pose(size_t animation, double seconds, std::vector<ScenePart>& parts) const override {
        std::vector<NodePlace> places = places_;
        const GltfAnimation& chosen = animations_.at(animation);
        if (chosen.seconds() > 0) seconds -= std::floor(seconds / chosen.seconds()) * chosen.seconds();
        chosen.apply(seconds, places);
        for (size_t i = 0; i < drawn_.size(); ++i) parts[i] = drawn_[i].primitive.part;
        place(places, parts);
    }

  private:
    struct Skin {
        std::vector<size_t> joints;       // nodes
        std::vector<glm::mat4> fromMesh;  // into the space of each joint
    };
    struct Drawn {
        GltfPrimitive primitive;
        size_t node = kNoNode, skin = SIZE_MAX;
    };

    bool readSkins(const tinygltf::Model& model, std::string& error) {
        for (size_t i = 0; i < model.skins.size(); ++i) {
            const tinygltf::Skin& from = model.skins[i];
            Skin skin;
            const std::string name = "skin " + std::to_string(i) + ": ";
            for (const int joint : from.joints) {
                if (joint < 0 || static_cast<size_t>(joint) >= model.nodes.size()) {
                    error = name + "there is no node " + std::to_string(joint);
                    return false;
                }
                skin.joints.push_back(static_cast<size_t>(joint));
            }
            std::vector<float> matrices;
            if (from.inverseBindMatrices >= 0 && !readFloats(model, from.inverseBindMatrices, 16, matrices, error)) {
                error = name + error;
                return false;
            }
            if (!matrices.empty() && matrices.size() / 16 < skin.joints.size()) {
                error = name + std::to_string(matrices.size() / 16) + " matrices for " +
                        std::to_string(skin.joints.size()) + " joints";
                return false;
            }
            for (size_t k = 0; k < skin.joints.size(); ++k) {
                glm::mat4 matrix(1);
                for (size_t c = 0; c < 16 && !matrices.empty(); ++c)
                    matrix[static_cast<int>(c / 4)][static_cast<int>(c % 4)] = matrices[k * 16 + c];
                skin.fromMesh.push_back(matrix);
            }
            skins_.push_back(std::move(skin));
        }
        return true;
    }

    /// The nodes of the scene form trees (glTF 2.0, 3.5.2): none is met twice.
    bool readNodes(const tinygltf::Model& model, std::string& error) {
        if (model.scenes.empty()) {
            // A library of meshes: each as it is.
            for (const tinygltf::Mesh& mesh : model.meshes)
                if (!addMesh(model, mesh, {}, error)) return false;
            return true;
        }
        const int first = std::max(model.defaultScene, 0);
        if (static_cast<size_t>(first) >= model.scenes.size()) {
            error = "there is no scene " + std::to_string(first);
            return false;
        }
        std::vector<std::pair<int, size_t>> stack;
        const std::vector<int>& roots = model.scenes[static_cast<size_t>(first)].nodes;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, kNoNode);
        std::set<int> met;
        while (!stack.empty()) {
            const auto [number, parent] = stack.back();
            stack.pop_back();
            if (number < 0 || static_cast<size_t>(number) >= model.nodes.size()) {
                error = "there is no node " + std::to_string(number);
                return false;
            }
            if (!met.insert(number).second) {
                error = "node " + std::to_string(number) + " is the child of two nodes, or of itself";
                return false;
            }
            const auto index = static_cast<size_t>(number);
            order_.push_back(index);
            parents_[index] = parent;
            const tinygltf::Node& node = model.nodes[index];
            if (!addMeshOf(model, node, index, error)) {
                return false;
            }
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                stack.emplace_back(*child, index);
        }
        for (const Drawn& drawn : drawn_)
            if (drawn.skin != SIZE_MAX)
                for (const size_t joint : skins_[drawn.skin].joints)
                    if (met.count(static_cast<int>(joint)) == 0) {
                        error = "skin " + std::to_string(drawn.skin) + ": node " + std::to_string(joint) +
                                " is not in the scene";
                        return false;
                    }
        return true;
    }

    bool addMeshOf(const tinygltf::Model& model, const tinygltf::Node& node, size_t index, std::string& error) {
        if (node.mesh < 0) return true;
        const std::string name = "node " + std::to_string(index) + ": ";
        if (static_cast<size_t>(node.mesh) >= model.meshes.size()) {
            error = name + "there is no mesh " + std::to_string(node.mesh);
            return false;
        }
        Drawn drawn;
        drawn.node = index;
        if (node.skin >= 0) {
            drawn.skin = static_cast<size_t>(node.skin);
            if (drawn.skin >= skins_.size()) {
                error = name + "there is no skin " + std::to_string(node.skin);
                return false;
            }
        }
        return addMesh(model, model.meshes[static_cast<size_t>(node.mesh)], drawn, error);
    }

    bool addMesh(const tinygltf::Model& model, const tinygltf::Mesh& mesh, const Drawn& where, std::string& error) {
        for (size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                ++leftOut_;
                continue;
            }
            morphs_ |= !primitive.targets.empty();
            Drawn drawn = where;
            if (!readPrimitive(model, primitive, drawn, error)) {
                error = "mesh \"" + mesh.name + "\", primitive " + std::to_string(i) + ": " + error;
                return false;
            }
            if (!drawn.primitive.part.mesh.indices.empty()) drawn_.push_back(std::move(drawn));
        }
        return true;
    }

    bool readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, Drawn& drawn,
                       std::string& error) {
        ScenePart& part = drawn.primitive.part;
        // The last one is that of meshes without material.
        part.material = textureSets_->size();
        if (primitive.material >= 0) part.material = static_cast<size_t>(primitive.material);
        if (part.material > textureSets_->size()) {
            error = "there is no material " + std::to_string(primitive.material);
            return false;
        }
        const int set = part.material < textureSets_->size() ? (*textureSets_)[part.material] : 0;
        const SceneMaterial& material = (*materials_)[part.material];
        const bool extras = material.surfaceTexture.texture >= 0 || material.normalTexture.texture >= 0 ||
                            material.emissionTexture.texture >= 0;
        if (!readGltfPrimitive(model, primitive, set, extras, drawn.primitive, error)) return false;
        if (drawn.skin == SIZE_MAX) return true;
        const size_t joints = skins_[drawn.skin].joints.size();
        for (const VertexJoints& vertex : drawn.primitive.joints)
            for (size_t k = 0; k < 4; ++k)
                if (vertex.weights[k] > 0 && vertex.joints[k] >= joints) {
                    error =
                        "joint " + std::to_string(vertex.joints[k]) + ", but its skin has " + std::to_string(joints);
                    return false;
                }
        return true;
    }

    /// An animation that cannot be read becomes a note: the model is worth seeing at rest.
    void readAnimations(const tinygltf::Model& model, Scene& scene) {
        for (size_t i = 0; i < model.animations.size(); ++i) {
            GltfAnimation animation;
            std::string error;
            if (animation.read(model, model.animations[i], morphs_, error)) {
                if (animation.seconds() > 0) animations_.push_back(std::move(animation));
            } else {
                scene.notes.push_back("animation " + std::to_string(i) + ": " + error);
            }
        }
    }

    /// Moves what is drawn, whose copies `parts` are.
    void place(const std::vector<NodePlace>& places, std::vector<ScenePart>& parts) const {
        std::vector<glm::mat4> global(places.size(), glm::mat4(1));
        for (const size_t node : order_) {
            const glm::mat4 local = places[node].local();
            global[node] = parents_[node] == kNoNode ? local : global[parents_[node]] * local;
        }
        for (size_t i = 0; i < drawn_.size(); ++i) {
            const Drawn& drawn = drawn_[i];
            if (drawn.skin != SIZE_MAX && !drawn.primitive.joints.empty()) {
                placeSkinned(drawn, global, parts[i]);
            } else if (drawn.node != kNoNode) {
                placeWhole(Move(global[drawn.node]), parts[i]);
            }
        }
    }

    static void placeWhole(const Move& move, ScenePart& part) {
        for (size_t v = 0; v < part.mesh.vertices.size(); ++v)
            move.apply(part.mesh.vertices[v], part.extras.empty() ? nullptr : &part.extras[v]);
        // A mirrored mesh shows its triangles the other way round.
        if (!move.mirrors) return;
        std::vector<uint32_t>& indices = part.mesh.indices;
        for (size_t i = 0; i + 2 < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    }

    /// Where the mesh's own node is does not matter (glTF 2.0, 3.7.3.3).
    void placeSkinned(const Drawn& drawn, const std::vector<glm::mat4>& global, ScenePart& part) const {
        const Skin& skin = skins_[drawn.skin];
        std::vector<glm::mat4> joints;
        for (size_t k = 0; k < skin.joints.size(); ++k) joints.push_back(global[skin.joints[k]] * skin.fromMesh[k]);
        for (size_t v = 0; v < part.mesh.vertices.size(); ++v) {
            const VertexJoints& vertex = drawn.primitive.joints[v];
            glm::mat4 sum(0);
            for (size_t k = 0; k < 4; ++k)
                if (vertex.weights[k] > 0) sum += joints[vertex.joints[k]] * vertex.weights[k];
            Move(sum).apply(part.mesh.vertices[v], part.extras.empty() ? nullptr : &part.extras[v]);
        }
    }

    std::vector<NodePlace> places_;  // of all nodes, at rest
    std::vector<size_t> parents_, order_;
    std::vector<Skin> skins_;
    std::vector<Drawn> drawn_;
    std::vector<GltfAnimation> animations_;
    size_t leftOut_ = 0;
    bool morphs_ = false;
    // While it is read.
    const std::vector<SceneMaterial>* materials_ = nullptr;
    const std::vector<int>* textureSets_ = nullptr;
};

bool build(const tinygltf::Model& model, const std::vector<Picture>& pictures, Scene& scene, std::string& error) {
    for (const std::string& extension : model.extensionsRequired)
        if (extension != kQuantization) {
            error = "needs the extension " + extension + ", which the viewer lacks";
            return false;
        }
    const std::vector<int> textureSets = addGltfMaterials(model, pictures, scene);
    const auto read = std::make_shared<GltfScene>();
    if (!read->read(model, textureSets, scene, error)) return false;
    for (const std::string& extension : model.extensionsUsed)
        if (extension != kQuantization) scene.notes.push_back("the extension " + extension + " is left out");
    if (read->animations() > 0) scene.motion = read;
    if (scene.parts.empty()) error = "has no triangles";
    return !scene.parts.empty();
}

}  // namespace

bool readGltfScene(const std::string& path, Scene& scene, std::string& error) {
    tinygltf::Model model;
    std::vector<Picture> pictures;
    if (!readGltfFile(path, model, pictures, error)) return false;
    if (build(model, pictures, scene, error)) return true;
    error = path + ": " + error;
    return false;
}

}  // namespace samples
