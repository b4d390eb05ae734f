#include "samples/viewer/gltf_material.h"

#include <algorithm>
#include <map>
#include <utility>

#include "samples/viewer/gltf_file.h"

namespace samples {
namespace {

VkSamplerAddressMode addressOf(int wrap) {
    if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                                                         : VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

class Materials {
  public:
    Materials(const tinygltf::Model& model, const std::vector<Picture>& pictures, Scene& scene)
        : model_(model), pictures_(pictures), scene_(scene) {}

    /// Returns the set of texture coordinates.
    int add(const tinygltf::Material& from) {
        SceneMaterial material;
        material.name = from.name;
        const tinygltf::PbrMetallicRoughness& surface = from.pbrMetallicRoughness;
        if (const auto& c = surface.baseColorFactor; c.size() == 4) material.color = glm::vec4(c[0], c[1], c[2], c[3]);
        material.metallic = glm::clamp(static_cast<float>(surface.metallicFactor), 0.0f, 1.0f);
        material.roughness = glm::clamp(static_cast<float>(surface.roughnessFactor), 0.05f, 1.0f);
        if (const auto& e = from.emissiveFactor; e.size() == 3) material.emission = glm::vec3(e[0], e[1], e[2]);
        material.twoSided = from.doubleSided;
        material.cutoff = static_cast<float>(from.alphaCutoff);
        if (from.alphaMode == "MASK") material.alpha = Alpha::kMasked;
        if (from.alphaMode == "BLEND") material.alpha = Alpha::kBlended;
        set_ = -1;
        material.texture = texture(surface.baseColorTexture.index, surface.baseColorTexture.texCoord, false);
        material.surfaceTexture =
            texture(surface.metallicRoughnessTexture.index, surface.metallicRoughnessTexture.texCoord, true);
        material.normalTexture = texture(from.normalTexture.index, from.normalTexture.texCoord, true);
        material.normalScale = static_cast<float>(from.normalTexture.scale);
        material.emissionTexture = texture(from.emissiveTexture.index, from.emissiveTexture.texCoord, false);
        occlusion_ |= from.occlusionTexture.index >= 0;
        scene_.materials.push_back(material);
        return std::max(set_, 0);
    }

    void finish() {
        scene_.materials.push_back({"", {0.8f, 0.8f, 0.8f, 1}});
        if (occlusion_) scene_.notes.emplace_back("occlusion textures are not shown");
        if (otherSets_) scene_.notes.emplace_back("textures with coordinates of their own are not shown");
    }

  private:
    /// `linear`: numbers, not colours. A material has one set of coordinates, that of its first texture.
    MaterialTexture texture(int index, int set, bool linear) {
        MaterialTexture result;
        if (index < 0) return result;
        if (static_cast<size_t>(index) >= model_.textures.size()) {
            scene_.notes.push_back("there is no texture " + std::to_string(index));
            return result;
        }
        if (set_ >= 0 && set != set_) {
            otherSets_ = true;
            return result;
        }
        set_ = set;
        const tinygltf::Texture& texture = model_.textures[static_cast<size_t>(index)];
        if (texture.sampler >= 0 && static_cast<size_t>(texture.sampler) < model_.samplers.size()) {
            const tinygltf::Sampler& sampler = model_.samplers[static_cast<size_t>(texture.sampler)];
            result.addressU = addressOf(sampler.wrapS);
            result.addressV = addressOf(sampler.wrapT);
            if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) result.filter = VK_FILTER_NEAREST;
        }
        const std::pair<int, bool> key(texture.source, linear);
        if (const auto known = textures_.find(key); known != textures_.end()) {
            result.texture = known->second;
            return result;
        }
        Picture picture;
        std::string error;
        if (pictureOf(model_, pictures_, texture.source, picture, error)) {
            result.texture = static_cast<int>(scene_.textures.size());
            scene_.textures.push_back({std::move(picture), linear});
        } else {
            scene_.notes.push_back(error);
        }
        textures_[key] = result.texture;
        return result;
    }

    const tinygltf::Model& model_;
    const std::vector<Picture>& pictures_;
    Scene& scene_;
    std::map<std::pair<int, bool>, int> textures_;  // by image and whether it is linear
    int set_ = -1;
    bool occlusion_ = false, otherSets_ = false;
};

}  // namespace

std::vector<int> addGltfMaterials(const tinygltf::Model& model, const std::vector<Picture>& pictures, Scene& scene) {
    Materials materials(model, pictures, scene);
    std::vector<int> sets;
    for (const tinygltf::Material& from : model.materials) sets.push_back(materials.add(from));
    materials.finish();
    return sets;
}

}  // namespace samples
