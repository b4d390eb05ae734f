// What several scenes share: vertex layouts, cameras, geometry and pictures made in code, and small shaders.
#pragma once

#include "conformance/scene/scene.h"
#include "conformance/scenes/recorder.h"

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace vernier::conformance {

inline constexpr VkExtent2D kSceneExtent{256, 256};

struct ColorVertex {
    glm::vec2 position;
    glm::vec3 color;
};

struct TexturedVertex {
    glm::vec4 position;
    glm::vec2 uv;
};

struct SolidVertex {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 uv;
};

struct Mesh {
    std::vector<SolidVertex> vertices;
    std::vector<uint16_t> indices;
};

/// World to Vulkan clip space (y down, depth 0..1); the field of view is vertical, in degrees. Computed in
/// double.
glm::mat4 cameraMatrix(glm::dvec3 eye, glm::dvec3 target, double fieldOfView, double aspect, double nearZ, double farZ);
glm::mat4 orthographicMatrix(glm::dvec3 eye, glm::dvec3 target, double halfSize, double nearZ, double farZ);

/// A pseudo-random sequence, the same everywhere (PCG-XSH-RR; O'Neill, "PCG", 2014).
class SceneRandom {
  public:
    explicit SceneRandom(uint64_t seed) : state_(seed) { next(); }
    uint32_t next();
    /// In [0, 1).
    float unit() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * unit(); }

  private:
    uint64_t state_;
};

/// A cube of edge 2 around the origin, outward faces counter-clockwise seen from outside in a right-handed
/// world.
Mesh cubeMesh();
/// A ball of radius 1 around the origin.
Mesh sphereMesh(uint32_t slices, uint32_t stacks);
/// A (2, 3) torus knot as the text of a Wavefront OBJ file with normals and texture coordinates.
std::string torusKnotObj(uint32_t segments, uint32_t sides);

/// RGBA8 pictures, rows tightly packed.
Bytes checkerPicture(VkExtent2D extent, uint32_t cell, glm::u8vec4 first, glm::u8vec4 second);
Bytes noisePicture(VkExtent2D extent, uint64_t seed);
/// A small figure that shows every flip and rotation, from a palette; 12 x 12.
Bytes spritePicture();
inline constexpr VkExtent2D kSpriteExtent{12, 12};

/// Position (vec2) and colour (vec3) straight through.
extern const char* const kColorVertexGlsl;
extern const char* const kColorFragmentGlsl;
/// Position (vec3, depth included) and colour (vec3) straight through.
extern const char* const kDepthColorVertexGlsl;
/// Clip position (vec4) and texture coordinate (vec2) straight through; one combined image sampler at binding
/// 0.
extern const char* const kTexturedVertexGlsl;
extern const char* const kTexturedFragmentGlsl;
/// One triangle over the whole viewport from gl_VertexIndex, without inputs or outputs.
extern const char* const kCoverVertexGlsl;

/// What kDepthColorVertexGlsl reads.
struct DepthColorVertex {
    glm::vec3 position, color;
};
/// A pipeline that reads DepthColorVertex from binding 0.
PipelineRecorder depthColorPipeline(SceneRecorder& record, const char* vertexGlsl = kDepthColorVertexGlsl,
                                    const char* fragmentGlsl = kColorFragmentGlsl);

}  // namespace vernier::conformance
