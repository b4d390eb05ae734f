// How many threads this process may usefully run.
#pragma once

#include <cstdint>

namespace vernier {

/// At least 1: the number of CPUs in the process's affinity mask, lowered to the cgroup's CPU quota (rounded up) where
/// one is set. Thread-safe; reads /proc and /sys on each call.
uint32_t usableCpuCount();

}  // namespace vernier
