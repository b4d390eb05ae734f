// Triangles with user clip and cull distances, drawn to be counted.
#pragma once

#include "conformance/hardcases/coverage_input.h"

namespace vernier::conformance::hardcases {

/// A vertex: where it is, and what the shader writes to gl_ClipDistance and gl_CullDistance.
struct DistanceVertex {
    ClipPosition position;
    std::array<float, 8> distance;
};

enum class DistanceKind : uint8_t { clip, cull };

/// Counts as countScene() does; `distances` of the eight are used. Bit patterns of distances are handed through
/// unchanged.
Result<Scene> distanceScene(std::string_view name, const std::vector<DistanceVertex>& vertices, DistanceKind kind,
                            uint32_t distances, VkExtent2D extent);

}  // namespace vernier::conformance::hardcases
