// What a scene does not call for, and what leaving it out saves: a part of the scene's page.
#pragma once

#include <string>

#include "conformance/report/report.h"

namespace vernier::conformance {

/// Empty where Vernier's API did not draw the scene.
std::string notNeededSection(const ReportScene& scene);

}  // namespace vernier::conformance
