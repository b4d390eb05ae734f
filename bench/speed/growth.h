// How time grows with the size of the work and with the number of CPUs.
#pragma once

#include "bench/speed/measure.h"

namespace vernier::bench {

/// Measures every axis (options.names: only these) on all drivers, prints a table with fitted exponents, and writes
/// <plots>/growth_<axis>.svg. Returns the exit status.
int runGrowth(const conformance::DriverPaths& paths, const RunOptions& options, const std::filesystem::path& plots);

}  // namespace vernier::bench
