// Cases of groups L and T about images that are not plain: arrays, cubes, unnormalised coordinates.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void l13(CaseInput& input);
void t14(CaseInput& input);
void t15(CaseInput& input);
void t16(CaseInput& input);
void t17(CaseInput& input);

}  // namespace vernier::conformance::hardcases
