#include "bench/speed/measure.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "conformance/tool/render_scene.h"

namespace vernier::bench {

using namespace conformance;

std::vector<std::string> presentDrivers(const DriverPaths& paths, const RunOptions& options, bool needsVulkan) {
    std::vector<std::string> drivers;
    for (const DriverChoice& choice : driverChoices(paths)) {
        const bool wanted =
            options.drivers.empty() || std::count(options.drivers.begin(), options.drivers.end(), choice.name);
        if (!wanted || (needsVulkan && choice.name == "api")) continue;
        if (choice.present())
            drivers.push_back(choice.name);
        else
            std::printf("left out: %s (%s)\n", choice.name.c_str(), choice.absence.c_str());
    }
    return drivers;
}

Row measureRow(const DriverPaths& paths, const RunOptions& options, const std::vector<std::string>& drivers,
               const std::string& name) {
    Row row;
    for (uint32_t round = 0; round < options.rounds; ++round)
        for (const std::string& driver : drivers) {
            Measured& measured = row.measured[driver];
            Result<Rendering> rendering = renderInChild(paths, driver, name, options.out / driver, 120);
            if (!rendering) {
                measured.failure = rendering.error().message;
                continue;
            }
            const Timing& timing = rendering->timing;
            measured.driver = rendering->driver + ", " + rendering->version;
            measured.libraries = rendering->libraries;
            measured.frame.push_back(timing.frame);
            measured.startUp.push_back(timing.toFirstResult());
            measured.modules.push_back(timing.modules);
            measured.firstImage.push_back(timing.firstImage);
            measured.peakMemory.push_back(static_cast<double>(rendering->peakMemory));
            row.last.insert_or_assign(driver, std::move(rendering).value());
        }
    return row;
}

nlohmann::json rowReport(const Row& row) {
    nlohmann::json report;
    for (const auto& [driver, measured] : row.measured)
        report[driver] = {{"driver", measured.driver},         {"library_bytes", measured.libraries},
                          {"frame_ms", measured.frame},        {"start_up_ms", measured.startUp},
                          {"modules_ms", measured.modules},    {"first_image_ms", measured.firstImage},
                          {"peak_bytes", measured.peakMemory}, {"failure", measured.failure}};
    return report;
}

}  // namespace vernier::bench
