// Cases of group X about halves and RelaxedPrecision.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void x14(CaseInput& input);
void x16(CaseInput& input);
void x17(CaseInput& input);

}  // namespace vernier::conformance::hardcases
