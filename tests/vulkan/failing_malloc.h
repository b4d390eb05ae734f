// malloc and its relatives, replaced so that they fail when a test wants it.
#pragma once

#include <atomic>
#include <cstdint>

namespace vernier::test {

/// While armed, the allocation after `countdown` others fails: that one alone, or all from it on (`forGood`).
extern std::atomic<bool> armed, forGood;
extern std::atomic<int64_t> countdown;
extern std::atomic<int64_t> live;  // blocks taken and not given back, armed or not

/// The dynamic linker cannot do without memory for thread-local variables, and ends the process: it always gets some.
/// Called before the first failure; false: it was not found.
bool findDynamicLinker();

}  // namespace vernier::test
