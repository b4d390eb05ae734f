// Cases of groups G and V that reach outside of buffers (robustBufferAccess).
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void g08(CaseInput& input);
void v10(CaseInput& input);

}  // namespace vernier::conformance::hardcases
