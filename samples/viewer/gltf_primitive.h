// One primitive of a glTF mesh as triangles, where its own coordinates are.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "samples/viewer/scene.h"

namespace samples {

/// What moves a vertex of a skin: joints of the skin, and how much of each, 1 in all.
struct VertexJoints {
    std::array<uint32_t, 4> joints{};
    std::array<float, 4> weights{};
};

struct GltfPrimitive {
    ScenePart part;
    std::vector<VertexJoints> joints;  // one per vertex, if the primitive has joints
};

/// Of a primitive of triangles. `set`: of texture coordinates; `extras`: the material wants tangents. False with what
/// is wrong.
bool readGltfPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, int set, bool extras,
                       GltfPrimitive& result, std::string& error);

}  // namespace samples
