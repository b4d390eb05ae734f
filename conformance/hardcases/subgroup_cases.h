// Cases of group X about subgroups and quads in fragments.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void x15(CaseInput& input);
void x18(CaseInput& input);
void x19(CaseInput& input);
void x20(CaseInput& input);

}  // namespace vernier::conformance::hardcases
