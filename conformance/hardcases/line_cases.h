// Cases of group P about line modes, stipples and outlines of polygons.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void p01(CaseInput& input);
void p02(CaseInput& input);
void p03(CaseInput& input);
void p07(CaseInput& input);
void p12(CaseInput& input);

}  // namespace vernier::conformance::hardcases
