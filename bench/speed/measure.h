// What all measurements share: which drivers run, and one row of rounds.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/speed/machine.h"
#include "bench/speed/table.h"
#include "conformance/tool/driver_choice.h"
#include "conformance/tool/rendering.h"

namespace vernier::bench {

struct RunOptions {
    std::vector<std::string> drivers, names;  // empty: all
    uint32_t rounds = 3;
    std::filesystem::path out = "out/bench";
    std::string json;
};

/// The drivers that were asked for and are present; `needsVulkan` leaves out Vernier's own API. Tells what is left out.
std::vector<std::string> presentDrivers(const conformance::DriverPaths& paths, const RunOptions& options,
                                        bool needsVulkan);

struct Row {
    std::map<std::string, Measured> measured;            // by driver
    std::map<std::string, conformance::Rendering> last;  // the renderings of the last round
};

/// Runs `name` on the drivers in turn, A B C A B C, each in a process of its own.
Row measureRow(const conformance::DriverPaths& paths, const RunOptions& options,
               const std::vector<std::string>& drivers, const std::string& name);

/// A row for machines; failures too.
nlohmann::json rowReport(const Row& row);

}  // namespace vernier::bench
