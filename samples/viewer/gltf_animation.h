// Animations of a glTF model: where nodes are at a time.
#pragma once

#include <tiny_gltf.h>

#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "samples/common/transform.h"

namespace samples {

/// How a node lies in its parent: moved, turned and scaled, or a matrix, which no animation touches.
struct NodePlace {
    glm::vec3 translation{0}, scale{1};
    glm::quat rotation{1, 0, 0, 0};
    bool isMatrix = false;
    glm::mat4 matrix{1};

    glm::mat4 local() const;
};

NodePlace placeOf(const tinygltf::Node& node);

class GltfAnimation {
  public:
    /// False with what is wrong. `morphs`: some channel changes weights of morph targets, which is left out.
    bool read(const tinygltf::Model& model, const tinygltf::Animation& animation, bool& morphs, std::string& error);

    /// The time of the last key.
    double seconds() const { return seconds_; }
    /// Changes the places of the nodes that it moves; before the first key and behind the last they stand still.
    void apply(double seconds, std::vector<NodePlace>& places) const;

  private:
    enum class Path { kTranslation, kRotation, kScale };
    enum class Way { kStep, kLinear, kCubic };
    struct Channel {
        size_t node = 0;
        Path path = Path::kTranslation;
        Way way = Way::kLinear;
        std::vector<float> times, values;
    };
    static bool readKeys(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler, Channel& channel,
                         std::string& error);
    static glm::vec4 valueAt(const Channel& channel, float seconds);

    std::vector<Channel> channels_;
    double seconds_ = 0;
};

}  // namespace samples
