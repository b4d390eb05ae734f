// The drivers of the comparison, where they are found, and how a process is made to use one.
#pragma once

#include "base/result.h"
#include "conformance/drivers/driver.h"
#include "conformance/oracle/oracle.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::conformance {

struct DriverChoice {
    std::string name;                // as on the command line: "api", "icd", "lavapipe", "swiftshader"
    std::string title;               // for the report
    std::filesystem::path manifest;  // of the Vulkan driver; empty: Vernier's own API
    bool ours = false;

    /// Whether it can be tried here; otherwise the reason is in `absence`.
    bool present() const { return absence.empty(); }
    std::string absence;
};

struct DriverPaths {
    std::filesystem::path icd;  // Vernier's manifest; by default that of this build, empty without one
    std::filesystem::path lavapipe = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
    std::filesystem::path swiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";
    std::string profile = "standard";  // of Vernier's API: draft, fast, standard, fine, reference
    std::string axes;                  // of Vernier's API: VnDeviceDesc::axes
    std::string skips;                 // of Vernier's API: VnDeviceDesc::skips
    bool robustBufferAccess = false;   // of Vulkan drivers: VulkanOptions::robustBufferAccess
    uint32_t cpus = 0;                 // that a driver's process may use; 0: all

    DriverPaths();
};

/// All drivers in the order of the report, present or not.
std::vector<DriverChoice> driverChoices(const DriverPaths& paths);

/// Makes the Vulkan loader find this driver alone, by its environment variables: before the process's first Vulkan
/// call.
Status selectVulkanDriver(const DriverChoice& choice);

/// Creates the driver in this process, which can use one Vulkan driver only (see above).
Result<std::unique_ptr<Driver>> createDriver(const DriverChoice& choice, const DriverPaths& paths, bool validate);

/// The oracle's images of a scene; `unsupported` in a build without the oracle.
Result<std::vector<OracleImage>> judgeScene(const Scene& scene, const OracleRules& rules = {});

}  // namespace vernier::conformance
