// Depth bias (specification, "Depth Bias").
#pragma once

#include <span>

#include "runtime/geometry/primitive_setup.h"

namespace vernier {

/// o = clamp(m * slope + r * constant), added to the depth of every fragment. `polygon` has all vertices of
/// the primitive (for the largest exponent of a float attachment); a, b, c span its plane.
float depthBias(const PreparedDraw& draw, std::span<const WindowVertex> polygon, const WindowVertex& a,
                const WindowVertex& b, const WindowVertex& c);

}  // namespace vernier
