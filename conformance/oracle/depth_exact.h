// Depth: the codes a depth value may be stored as, and depth bias.
#pragma once

#include "conformance/oracle/encode.h"

#include <vulkan/vulkan_core.h>

#include <array>

namespace vernier::conformance::exact {

/// Codes for a window depth in a depth format (D16, D24, D32F with or without stencil); fixed-point formats
/// clamp to [0,1].
CodeSet encodeDepth(VkFormat format, const Rational& depth);

/// The exact value of a depth code.
Rational decodeDepth(VkFormat format, uint64_t code);

/// The minimum resolvable difference r (Vulkan, Depth Bias): between 2^-n and 2 * 2^-n for n-bit fixed point;
/// 2^(e-23) for D32F, e being the exponent of the largest depth magnitude in the primitive.
struct BiasUnit {
    Rational low, high;
};
BiasUnit biasUnit(VkFormat format, const std::array<Rational, 3>& vertexDepths);

/// m * slopeFactor + r * constantFactor, clamped, as a range: m is between max(|dz/dx|, |dz/dy|) and the root
/// of the sum of squares.
struct BiasRange {
    double low, high;
};
BiasRange depthBias(VkFormat format, const std::array<Rational, 3>& vertexDepths, const Rational& slopeX,
                    const Rational& slopeY, float constantFactor, float clamp, float slopeFactor);

}  // namespace vernier::conformance::exact
