// Changes to a SPIR-V module that leave it a stream of instructions, and often a valid module.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace vernier::proof {

/// Changes one to four places: operands for others of the same type, opcodes for others of the same form, literals;
/// instructions are deleted, doubled or moved. `words` that are no module are left as they are.
void mutateModule(std::vector<uint32_t>& words, std::mt19937& random);

}  // namespace vernier::proof
