// The reference renderer's verdict on a scene: for every pixel of every output, the value and the range of
// values that the Vulkan specification permits.
#pragma once

#include "base/result.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vernier::conformance {

/// In decoded component values (linear for sRGB); low..high = what the specification permits.
struct OraclePixel {
    std::array<double, 4> value, low, high;
    uint8_t flags;  // of OracleFlag
};

enum OracleFlag : uint8_t {
    kOracleEdge = 1,     // coverage ambiguous under legal snapping: low..high spans all legal outcomes
    kOracleUnknown = 2,  // could not be decided; never silently accepted: counted and reported
};

struct OracleImage {
    VkFormat format;
    VkExtent2D extent;
    std::vector<OraclePixel> pixels;  // row by row
};

/// What an implementation declares and the specification leaves to it.
struct OracleRules {
    int subPixelBits = 8;  // subPixelPrecisionBits: vertices may be snapped by up to 2^-bits pixel
};

/// One image per Scene::outputs, in that order. An error with code `unsupported` when the scene uses
/// something the oracle does not model.
Result<std::vector<OracleImage>> renderOracle(const Scene& scene, const OracleRules& rules = {});

}  // namespace vernier::conformance
