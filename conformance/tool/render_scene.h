// Drawing one scene on one driver, in this process or in a child: what the comparison and the benchmarks share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "conformance/scenes/scenes.h"
#include "conformance/tool/driver_choice.h"
#include "conformance/tool/rendering.h"

namespace vernier::conformance {

/// Adds --icd, --lavapipe, --swiftshader, --profile and --cpus.
void addDriverOptions(CLI::App& app, DriverPaths& paths);

/// The same options as arguments for a child.
std::vector<std::string> driverArguments(const DriverPaths& paths);

/// Draws the scene on the driver of that name, with timings. Takes CPUs from the process if `paths` says so.
Result<Rendering> renderScene(const DriverPaths& paths, const std::string& driver, const Scene& scene, bool validate);

/// Bytes of all shared libraries in the process, by their files.
uint64_t loadedLibraryBytes();

/// Leaves the process `count` of its CPUs, for libraries that count them later; 0: all.
Status limitCpus(uint32_t count);

/// Runs this program again as "<driver arguments> render --driver D --scene S --out FOLDER", which must save a
/// Rendering there, and loads it. FOLDER is created; the child's output goes to FOLDER/S.log.
Result<Rendering> renderInChild(const DriverPaths& paths, const std::string& driver, const std::string& scene,
                                const std::filesystem::path& folder, double timeoutSeconds);

}  // namespace vernier::conformance
