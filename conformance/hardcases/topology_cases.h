// Cases of group V about lists, strips and fans, their restart, and the numbers of vertices and instances.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void v08(CaseInput& input);
void v09(CaseInput& input);
void v11(CaseInput& input);

}  // namespace vernier::conformance::hardcases
