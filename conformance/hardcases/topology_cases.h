// Cases of group V about lists, strips and fans, their restart, and the numbers of vertices, primitives and instances.
#pragma once

#include "conformance/hardcases/hard_case.h"

namespace vernier::conformance::hardcases {

void v08(CaseInput& input);
void v09(CaseInput& input);
void v11(CaseInput& input);
void v15(CaseInput& input);
void v18(CaseInput& input);

/// The number that a pixel of the first output has.
struct Spot {
    uint32_t x = 0, y = 0;
    uint64_t number = 0;
};
/// Adds the judge of these pixels; `law` says where the numbers come from.
void judgeSpots(CaseInput& input, size_t scene, VkExtent2D extent, std::vector<Spot> spots, std::string law);

}  // namespace vernier::conformance::hardcases
