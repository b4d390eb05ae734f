// Cases of group B about conversions of single formats.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void b05(CaseInput& input);
void b12(CaseInput& input);
void b13(CaseInput& input);

}  // namespace vernier::conformance::hardcases
