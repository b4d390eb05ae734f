// Texel selection, filtering and level of detail, exactly: coordinates and weights in rationals, logarithms
// decided by comparing powers or enclosed by MPFR.
#pragma once

#include "conformance/oracle/exact.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

namespace vernier::conformance::exact {

/// The texel that an integer coordinate addresses (Vulkan, Wrapping Operation); nothing for the border.
std::optional<int64_t> wrapTexel(VkSamplerAddressMode mode, int64_t coordinate, int64_t size);

/// One axis of a linear filter: the two neighbours before wrapping, and the weight of the second.
struct AxisTaps {
    int64_t first = 0;
    Rational weight;
};

/// Taps for the unnormalised coordinate u (normalised coordinate times size). With `weightBits` >= 0 the
/// weight is rounded to that many fraction bits, nearest even; a weight that rounds to 1 stays 1.
AxisTaps linearTaps(const Rational& u, int weightBits = -1);

/// Nearest filtering: floor(u).
int64_t nearestTexel(const Rational& u);

/// Bilinear filter of a texel function at unnormalised (u, v).
Rational bilinear(const std::function<Rational(int64_t x, int64_t y)>& texel, const Rational& u, const Rational& v,
                  int weightBits = -1);

/// Smallest and largest value of the bilinear filter when coordinates carry an error of up to `slack` texels
/// and the weights are rounded in any way to `weightBits` fraction bits: the range a conforming filter can
/// reach.
struct FilterRange {
    Rational low, high;
};
FilterRange bilinearRange(const std::function<Rational(int64_t x, int64_t y)>& texel, const Rational& u,
                          const Rational& v, int weightBits, const Rational& slack);

/// Partial derivatives of texel coordinates along the framebuffer's axes.
struct TexelDerivatives {
    Rational ux, vx, uy, vy;
};

/// Squared ideal scale factor: the longer of the two footprint axes (Vulkan, Scale Factor Operation).
Rational squaredScale(const TexelDerivatives& d);

/// Squared bounds of the approximations the specification and the CTS accept for it: the largest single
/// derivative, and the sum over the texture axes of the larger derivative of each.
struct SquaredScaleRange {
    Rational low, high;
};
SquaredScaleRange squaredScaleRange(const TexelDerivatives& d);

/// lambda = log2(rho) + bias from rho^2; nothing for rho = 0 (lambda is minus infinity).
std::optional<Enclosure> levelOfDetail(const Rational& squaredRho, double bias = 0);

/// Levels a nearest mipmap mode may choose for lambda = log2(rho), not clamped to the image: the preferred
/// ceil(lambda + 1/2) - 1 and the alternative floor(lambda + 1/2); they differ at half-integers only. Decided
/// by comparing rho^2 with powers of two.
struct NearestLevel {
    int preferred = 0, alternative = 0;
};
NearestLevel nearestLevel(const Rational& squaredRho);

}  // namespace vernier::conformance::exact
