// From a draw to triangles: index and vertex fetch, the vertex shader, primitive assembly.
#pragma once

#include "base/result.h"
#include "conformance/oracle/homogeneous.h"
#include "conformance/oracle/shader_resources.h"
#include "conformance/scene/scene.h"
#include "spirv_interp/reference/interpreter.h"

#include <array>
#include <map>
#include <vector>

namespace vernier::conformance::exact {

/// What the vertex shader left for one vertex.
struct ShadedVertex {
    Clip<double> position{};
    std::vector<double> clipDistances;
    std::map<reference::Location, reference::Texel<double>> varyings;
};

/// Indices into DrawGeometry::vertices in the order of Vulkan's topology definitions; the first is the
/// provoking vertex.
using AssembledTriangle = std::array<uint32_t, 3>;

struct DrawGeometry {
    std::vector<ShadedVertex> vertices;
    std::vector<AssembledTriangle> triangles;
    std::vector<uint32_t> primitiveIds;
};

/// Parses a scene's shader with its specialisation.
Result<reference::Module> parseShader(const SceneShader& shader);

/// All triangles of all instances of a draw. Points and lines are refused.
Result<DrawGeometry> assembleDraw(const Scene& scene, const SceneDraw& draw, ShaderResources& resources);

/// The vertex numbers of each triangle within `count` vertices that follow each other (no restart inside).
std::vector<std::array<uint32_t, 3>> trianglesOf(VkPrimitiveTopology topology, uint32_t count);

}  // namespace vernier::conformance::exact
