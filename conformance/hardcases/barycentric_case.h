// Barycentric coordinates, and what single vertices have, as inputs of fragment shaders.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void barycentricCase(CaseInput& input);

}  // namespace vernier::conformance::hardcases
