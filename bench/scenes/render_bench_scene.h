// What a benchmark's child process does.
#pragma once

#include <filesystem>
#include <string>

#include "conformance/tool/driver_choice.h"

namespace vernier::bench {

/// Draws one scene on one driver and saves images and timings in `out`. Returns the exit status; tells on stderr what
/// failed.
int renderBenchScene(const conformance::DriverPaths& paths, const std::string& driver, const std::string& scene,
                     const std::filesystem::path& out);

}  // namespace vernier::bench
