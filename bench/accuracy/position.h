// The positions that are measured: the profiles of the dial, every axis alone, and other drivers.
#pragma once

#include <string>
#include <vector>

#include "conformance/tool/driver_choice.h"

namespace vernier::bench {

struct AccuracyPosition {
    std::string label;         // "standard", "math=fine", "lavapipe"
    std::string driver;        // as in --driver
    std::string profile;       // of Vernier
    std::string axes;          // changed in that profile: at most one
    std::string axis;          // the name of the changed axis; empty for profiles and other drivers
    bool exactest = false;     // of the axis: its last position
    bool belowVulkan = false;  // some axis is below what Vulkan asks for

    bool isProfile() const { return driver == "api" && axis.empty(); }
};

/// The profile whose axes are moved one at a time.
inline constexpr const char* kBaseProfile = "standard";
/// In the order of the dial.
inline constexpr const char* kProfileNames[] = {"draft", "fast", kBaseProfile, "fine", "reference"};

/// Profiles in the order of the dial; then, for each axis, its positions that `standard` does not have, from cheap to
/// exact; then the other drivers that are present.
std::vector<AccuracyPosition> accuracyPositions(const std::vector<conformance::DriverChoice>& drivers);

}  // namespace vernier::bench
