// Cube maps: which face a direction meets and where, and which texel lies behind the edge of a face (Vulkan, Cube Map
// Face Selection, Coordinate Transformation, Derivative Transformation, Edge Handling).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {

/// A direction's place on one face: s and t in 0..1, with their derivatives along the framebuffer's axes.
struct CubePlace {
    uint32_t face = 0;  // +x -x +y -y +z -z
    double s = 0, t = 0;
    std::array<double, 2> ddx{}, ddy{};
};

/// Places on all faces that may be chosen: the declared one first (z before y before x at ties), then those whose axis
/// is within `slack`, relative, of the largest. None for a direction without length.
std::vector<CubePlace> cubePlaces(const std::array<double, 3>& direction, const std::array<double, 3>& ddx,
                                  const std::array<double, 3>& ddy, double slack);

struct CubeTexel {
    uint32_t face = 0;
    int64_t x = 0, y = 0;
};

/// The texel at (x, y) of a face of n x n texels, at most one outside in x or in y: that of the neighbouring face which
/// meets it there. Nothing beyond a corner, where three faces meet.
std::optional<CubeTexel> cubeTexel(uint32_t face, int64_t x, int64_t y, int64_t n);

}  // namespace vernier::conformance::exact
