// What the tiers of mathematics promise of elementary functions: measured by vernier-precision, and what the hard cases
// are judged by.
#pragma once

#include <array>

namespace vernier::precision {

/// What a tier promises: an error of at most `ulp` ULP, or of at most `absolute`, whichever is more. Negative: nothing
/// beyond what Vulkan demands.
struct Promise {
    double ulp = -1, absolute = 0;
};

/// By tier: fast, standard, fine, reference.
using Promises = std::array<Promise, 4>;

/// Within what Vulkan demands of standard and with room to spare; fast has 11 bits.
inline constexpr Promises kUsual = {{{4096, 0}, {4, 0}, {1, 0}, {0.5001, 0}}};
/// Sine and cosine have zeros everywhere: absolute errors count.
inline constexpr Promises kAngles = {{{4, 0x1p-11}, {4, 0x1p-22}, {1, 0}, {0.5001, 0}}};

inline constexpr Promises kRounded = {{{0.5, 0}, {0.5, 0}, {0.5, 0}, {0.5, 0}}};
/// The same operations in every tier: what their formula gives.
inline constexpr Promises kInherited = {};

}  // namespace vernier::precision
