// Runs a fragment shader with the interface of front_snippets.h on made-up inputs, by the IR or by the reference
// interpreter, and compares what comes out.
#pragma once

#include <map>
#include <string>

#include "tests/spirv_interp/front_support.h"

namespace vernier::test {

/// What an invocation leaves behind.
struct Ending {
    std::map<uint32_t, uint32_t> floats, ints;  // outputs by location * 4 + component; those not written are missing
    std::vector<uint32_t> storage;              // the storage buffer's words
    bool discarded = false;
    bool ended = true;  // false: it took too long
};

Ending runProgram(const ir::Program& program, uint32_t seed);
Ending runReference(const Words& words, uint32_t seed);

/// Fails the test where the endings differ by more than `tolerance` (relative for large values, absolute for small
/// ones; 0: the bits, except that all NaNs are one). Outputs of a discarded invocation do not matter.
void compare(const Ending& expected, const Ending& got, double tolerance, const std::string& what);

}  // namespace vernier::test
