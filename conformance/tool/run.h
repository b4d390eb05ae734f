// The whole comparison: every scene on every driver in child processes, the oracle, the diff, the report.
#pragma once

#include "base/result.h"
#include "conformance/tool/driver_choice.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vernier::conformance {

struct RunOptions {
    std::filesystem::path out = "out/report";
    std::filesystem::path knownGaps;   // empty: none
    std::vector<std::string> scenes;   // empty: all
    std::vector<std::string> drivers;  // empty: all that are present
    bool validate = false;
    bool oracle = true;
    double timeoutSeconds = 60;                // per scene and driver
    double oracleTimeoutSeconds = 180;         // per scene
    std::vector<std::string> commonArguments;  // handed on to every child
};

/// Returns whether every pixel of ours is explained and no known gap is stale. An error means that the run
/// itself failed.
Result<bool> runComparison(const std::vector<DriverChoice>& choices, const RunOptions& options);

}  // namespace vernier::conformance
