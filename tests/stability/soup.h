// Triangles in clip coordinates, as property tests make, shrink and keep them.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace vernier::stability {

using Position = std::array<float, 4>;  // x, y, z, w as the vertex shader writes them
using Triangle = std::array<Position, 3>;
using Soup = std::vector<Triangle>;

/// Pixels on a side of what soups are drawn to.
inline constexpr uint32_t kSize = 64;

/// Clip coordinates of a window point: exact for points on a grid of 1/256 pixel.
inline Position atWindow(double x, double y, float z = 0.5f) {
    return {static_cast<float>(x / 32 - 1), static_cast<float>(y / 32 - 1), z, 1};
}

/// A C++ expression of type Soup that stands for the same bits: `Soup{{{{x, y, z, w}, ...}}, ...}`, finite numbers as
/// hexadecimal floats.
std::string literal(const Soup& soup);

}  // namespace vernier::stability
