// Cases of group T about block-compressed images: every texel, fetched, against the oracle's decoders.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void t20(CaseInput& input);
void t22(CaseInput& input);
void t23(CaseInput& input);
void t24(CaseInput& input);

}  // namespace vernier::conformance::hardcases
