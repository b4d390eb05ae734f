// Cases about what geometry shaders put out: its order, its strips, and what clipping makes of it.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void c13(CaseInput& input);
void e21(CaseInput& input);
void v16(CaseInput& input);

}  // namespace vernier::conformance::hardcases
