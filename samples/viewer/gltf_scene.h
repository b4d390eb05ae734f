// glTF 2.0, as .gltf with buffers beside or inside, and as .glb. Read by tinygltf; whatever tinygltf takes on trust is
// checked here.
#pragma once

#include <string>

#include "samples/viewer/scene.h"

namespace samples {

/// Adds the default scene: meshes of triangles, moved by their nodes and skins, with colours of vertices, base colour,
/// metal, roughness, normals, emission, the textures of these, and alpha modes; and its animations. What else there is
/// becomes a note. False with what is wrong.
bool readGltfScene(const std::string& path, Scene& scene, std::string& error);

}  // namespace samples
