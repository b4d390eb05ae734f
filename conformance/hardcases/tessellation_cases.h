// Cases about tessellation: edges that patches share, fractional spacing, levels that cull patches.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void e22(CaseInput& input);
void n09(CaseInput& input);
void v19(CaseInput& input);

}  // namespace vernier::conformance::hardcases
