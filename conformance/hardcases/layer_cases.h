// Cases of group V about views, layers and viewports.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void v13(CaseInput& input);
void v17(CaseInput& input);

}  // namespace vernier::conformance::hardcases
