// Counting what one frame of a scene costs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/effects/effects.h"
#include "conformance/tool/driver_choice.h"

namespace vernier::bench {

struct SceneCost {
    double milliseconds = 0;    // of a frame
    uint64_t instructions = 0;  // of a frame, by all threads; 0: not counted
    conformance::Bytes picture;
};

/// The scenes of an effect on Vernier's Vulkan driver in this process. When the process runs under Callgrind with
/// --instr-atstart=no, one frame of each scene is instrumented and dumped as "<effect> <scene>".
Result<std::vector<SceneCost>> drawEffect(const conformance::DriverPaths& paths, const Effect& effect);

/// Whether this process runs under Valgrind.
bool underValgrind();

/// The instructions of the dump called `name` among Callgrind's files in `folder`; 0: there is none.
uint64_t dumpedInstructions(const std::filesystem::path& folder, const std::string& name);

}  // namespace vernier::bench
