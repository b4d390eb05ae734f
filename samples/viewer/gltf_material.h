// Materials and textures of a glTF model.
#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "samples/viewer/scene.h"

namespace samples {

/// Adds them to a scene, and behind them the material of meshes without one. What cannot be read or is not shown
/// becomes a note: the model is worth seeing without. Gets the set of texture coordinates of each (TEXCOORD_n).
std::vector<int> addGltfMaterials(const tinygltf::Model& model, const std::vector<Picture>& pictures, Scene& scene);

}  // namespace samples
