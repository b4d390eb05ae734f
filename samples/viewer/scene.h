// What the viewer shows: triangles by material, and textures. Plain data, from a file or from code.
#pragma once

#include <vulkan/vulkan_core.h>

#include <memory>
#include <string>
#include <vector>

#include "samples/common/mesh.h"
#include "samples/common/obj_file.h"
#include "samples/common/picture_file.h"

namespace samples {

enum class Alpha { kOpaque, kMasked, kBlended };

struct MaterialTexture {
    int texture = -1;  // of Scene::textures; -1: none
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode addressU = VK_SAMPLER_ADDRESS_MODE_REPEAT, addressV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
};

struct SceneTexture {
    Picture picture;
    bool linear = false;  // numbers, not colours
};

struct SceneMaterial {
    std::string name;
    glm::vec4 color{1};
    glm::vec3 emission{0};
    float metallic = 0, roughness = 0.6f;
    Alpha alpha = Alpha::kOpaque;
    float cutoff = 0.5f;   // masked: texels with less alpha are left out
    bool twoSided = true;  // else triangles that are clockwise on the screen are not drawn
    MaterialTexture texture{};
    // Multiplied with metallic (blue) and roughness (green), with the emission, and normals in the space of the
    // surface. Only of parts that have VertexExtras.
    MaterialTexture surfaceTexture{}, emissionTexture{}, normalTexture{};
    float normalScale = 1;
};

/// What few vertices have.
struct VertexExtras {
    glm::vec4 color{1};  // linear, multiplied with the material's
    // Along u; w: 1 or -1, the side that y of a map of normals lies on (glTF 2.0, 3.7.2.1).
    glm::vec4 tangent{0, 0, 0, 1};
};

struct ScenePart {
    MeshData mesh;
    size_t material = 0;
    std::vector<VertexExtras> extras;  // one per vertex; or none
};

/// Parts that move. Plain data behind it, so that scenes can be copied.
class SceneMotion {
  public:
    virtual ~SceneMotion() = default;
    virtual size_t animations() const = 0;
    /// How long an animation is.
    virtual double seconds(size_t animation) const = 0;
    /// Moves the parts, those that were read, to where they are at a time, which starts anew at the end.
    virtual void pose(size_t animation, double seconds, std::vector<ScenePart>& parts) const = 0;
};

struct Scene {
    std::string name;
    std::vector<SceneTexture> textures;
    std::vector<SceneMaterial> materials;
    std::vector<ScenePart> parts;               // inside the ball of radius 1 around the origin
    Ball ball;                                  // that they were in before
    std::vector<std::string> notes;             // what the file has that is not shown
    std::shared_ptr<const SceneMotion> motion;  // if the file has animations
};

/// .obj, .gltf or .glb, told by the end of the name. False with what is wrong, naming the file; `scene` is then as it
/// was.
bool loadScene(const std::string& path, Scene& scene, std::string& error);

/// Moves the parts of a scene with motion to where they are at a time.
void poseScene(Scene& scene, size_t animation, double seconds);

/// A knot, a ball, a box and a pane of glass on a checkered floor.
Scene builtInScene();

size_t triangleCount(const Scene& scene);

}  // namespace samples
