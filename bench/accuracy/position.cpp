#include "bench/accuracy/position.h"

#include <vernier/vernier_accuracy.h>

namespace vernier::bench {
namespace {

using conformance::DriverChoice;

uint32_t positionIn(uint32_t axis, VnProfile profile) {
    uint32_t position = 0;
    vnGetAxisPosition(axis, profile, &position);
    return position;
}

void addProfiles(std::vector<AccuracyPosition>& positions) {
    for (int profile = VN_PROFILE_DRAFT; profile <= VN_PROFILE_REFERENCE; ++profile) {
        AccuracyPosition& position = positions.emplace_back();
        position.label = position.profile = kProfileNames[profile - VN_PROFILE_DRAFT];
        position.driver = "api";
        VnAxisInfo axis{};
        for (uint32_t index = 0; vnGetAxis(index, &axis) == VN_SUCCESS; ++index)
            if (positionIn(index, static_cast<VnProfile>(profile)) < axis.lowestForVulkan) position.belowVulkan = true;
    }
}

void addAxes(std::vector<AccuracyPosition>& positions) {
    VnAxisInfo axis{};
    for (uint32_t index = 0; vnGetAxis(index, &axis) == VN_SUCCESS; ++index) {
        for (uint32_t p = 0; p < axis.positionCount; ++p) {
            if (p == positionIn(index, VN_PROFILE_STANDARD)) continue;
            AccuracyPosition& position = positions.emplace_back();
            position.label = position.axes = std::string(axis.name) + "=" + axis.positions[p];
            position.driver = "api";
            position.profile = kBaseProfile;
            position.axis = axis.name;
            position.exactest = p + 1 == axis.positionCount;
            position.belowVulkan = p < axis.lowestForVulkan;
        }
    }
}

}  // namespace

std::vector<AccuracyPosition> accuracyPositions(const std::vector<DriverChoice>& drivers) {
    std::vector<AccuracyPosition> positions;
    for (const DriverChoice& driver : drivers) {
        if (!driver.present()) continue;
        if (driver.name == "api") {
            addProfiles(positions);
            addAxes(positions);
        } else if (!driver.ours) {  // our Vulkan driver runs the same backend as the API
            AccuracyPosition& position = positions.emplace_back();
            position.label = position.driver = driver.name;
            position.profile = kBaseProfile;
        }
    }
    return positions;
}

}  // namespace vernier::bench
