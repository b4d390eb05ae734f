// The standard sample locations.
#pragma once

#include "conformance/oracle/coverage.h"

#include <vector>

namespace vernier::conformance::exact {

/// Offsets from the pixel's corner in 1/16 pixel (Vulkan, Multisampling: standardSampleLocations), by sample index;
/// empty for counts that have none.
std::vector<GridPoint> standardSampleLocations(uint32_t samples);

}  // namespace vernier::conformance::exact
