// The scenes that separate the axes of accuracy, as data: a mesh that covers the whole target so many times in every
// pixel, a fragment shader, and what it reads.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "conformance/scene/scene.h"

namespace vernier::bench {

enum class SceneUse : uint8_t {
    judged,   // as small as the exact oracle wants it
    timed,    // as large as a measurement of time wants it
    counted,  // as judged, but every fragment adds 1 to its pixel: holes and doubles show
};

enum class SceneTexture : uint8_t { none, ramp, checker };

struct AccuracyScene {
    const char* name;
    const char* description;
    const char* separates;  // the axis it is sensitive to, in words
    VkExtent2D judged, timed;
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    const char* vertex;       // GLSL behind kMeshGlsl: void main() with gl_Position and location 0
    const char* fragment;     // GLSL behind kFragmentGlsl
    uint32_t cellsX, cellsY;  // of the grid; 6 vertices a cell
    uint32_t instances = 1;
    uint32_t cover = 1;  // how often the mesh covers each pixel
    SceneTexture texture = SceneTexture::none;
    bool blend = false, depth = false;
    float anisotropy = 0;     // of the sampler; 0: off
    uint32_t timedCells = 1;  // times as many cells each way in the timed variant, so that they are as large there
};

std::span<const AccuracyScene> accuracySceneTable();

Result<conformance::Scene> buildAccuracyScene(const AccuracyScene& scene, SceneUse use);

/// "NAME", "NAME:timed" or "NAME:counted".
std::string variantName(const AccuracyScene& scene, SceneUse use);

/// The scene of a name as above; `invalidArgument` when there is none.
Result<conformance::Scene> accuracySceneNamed(std::string_view name);

}  // namespace vernier::bench
