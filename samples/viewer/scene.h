// What the viewer shows: triangles by material, and textures. Plain data, from a file or from code.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>
#include <vector>

#include "samples/common/mesh.h"
#include "samples/common/picture_file.h"

namespace samples {

enum class Alpha { kOpaque, kMasked, kBlended };

struct SceneMaterial {
    std::string name;
    glm::vec4 color{1};
    glm::vec3 emission{0};
    float metallic = 0, roughness = 0.6f;
    Alpha alpha = Alpha::kOpaque;
    float cutoff = 0.5f;   // masked: texels with less alpha are left out
    bool twoSided = true;  // else triangles that are clockwise on the screen are not drawn
    int texture = -1;      // of Scene::textures; -1: none
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode addressU = VK_SAMPLER_ADDRESS_MODE_REPEAT, addressV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
};

struct ScenePart {
    MeshData mesh;
    size_t material = 0;
};

struct Scene {
    std::string name;
    std::vector<Picture> textures;
    std::vector<SceneMaterial> materials;
    std::vector<ScenePart> parts;    // inside the ball of radius 1 around the origin
    std::vector<std::string> notes;  // what the file has that is not shown
};

/// .obj, .gltf or .glb, told by the end of the name. False with what is wrong, naming the file; `scene` is then as it
/// was.
bool loadScene(const std::string& path, Scene& scene, std::string& error);

/// A knot, a ball, a box and a pane of glass on a checkered floor.
Scene builtInScene();

size_t triangleCount(const Scene& scene);

}  // namespace samples
