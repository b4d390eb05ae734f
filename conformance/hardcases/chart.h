// The table case by driver as a picture: one small square per case and driver.
#pragma once

#include <string>

#include "conformance/hardcases/table.h"

namespace vernier::conformance::hardcases {

/// In SVG.
std::string tableChart(const Table& table);

}  // namespace vernier::conformance::hardcases
