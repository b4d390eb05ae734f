#include "conformance/tool/driver_choice.h"

#include "conformance/drivers/try.h"
#include "conformance/drivers/vulkan_driver.h"
#if VERNIER_HAS_API
#include "conformance/drivers/api_driver.h"
#endif

#include <array>
#include <cstdlib>
#include <system_error>

namespace vernier::conformance {

DriverPaths::DriverPaths() : icd(VERNIER_ICD_MANIFEST) {}

std::vector<DriverChoice> driverChoices(const DriverPaths& paths) {
    std::vector<DriverChoice> choices{{"api", "Vernier API", {}, true, {}},
                                      {"icd", "Vernier ICD", paths.icd, true, {}},
                                      {"lavapipe", "lavapipe", paths.lavapipe, false, {}},
                                      {"swiftshader", "SwiftShader", paths.swiftShader, false, {}}};
    for (DriverChoice& choice : choices) {
        std::error_code error;
        if (choice.name == "api") {
            if (!VERNIER_HAS_API) choice.absence = "not in this build";
        } else if (choice.manifest.empty()) {
            choice.absence = "no manifest was given";
        } else if (!std::filesystem::exists(choice.manifest, error)) {
            choice.absence = choice.manifest.string() + " does not exist";
        }
    }
    return choices;
}

#if VERNIER_HAS_API
namespace {

Result<std::unique_ptr<Driver>> createApiDriver(const DriverPaths& paths) {
    constexpr std::array<std::pair<std::string_view, VnProfile>, 5> kProfiles{{{"draft", VN_PROFILE_DRAFT},
                                                                               {"fast", VN_PROFILE_FAST},
                                                                               {"standard", VN_PROFILE_STANDARD},
                                                                               {"fine", VN_PROFILE_FINE},
                                                                               {"reference", VN_PROFILE_REFERENCE}}};
    for (const auto& [name, value] : kProfiles) {
        if (name != paths.profile) continue;
        Result<std::unique_ptr<ApiDriver>> driver =
            ApiDriver::create({value, 0, nullptr, paths.axes.c_str(), paths.skips.c_str()});
        if (!driver) return driver.error();
        return std::unique_ptr<Driver>(std::move(driver).value());
    }
    return invalidArgument("--profile is '" + paths.profile + "', not draft, fast, standard, fine or reference");
}

}  // namespace
#endif

Status selectVulkanDriver(const DriverChoice& choice) {
    if (!choice.present()) return unsupported("driver '" + choice.name + "': " + choice.absence);
    if (choice.manifest.empty()) return invalidArgument("driver '" + choice.name + "' is no Vulkan driver");
    // Older loaders read the second name only. The shader cache would hide what compiling costs.
    ::setenv("VK_DRIVER_FILES", choice.manifest.c_str(), 1);
    ::setenv("VK_ICD_FILENAMES", choice.manifest.c_str(), 1);
    ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    return {};
}

Result<std::unique_ptr<Driver>> createDriver(const DriverChoice& choice, const DriverPaths& paths, bool validate) {
    if (!choice.present()) return unsupported("driver '" + choice.name + "': " + choice.absence);
#if VERNIER_HAS_API
    if (choice.manifest.empty()) return createApiDriver(paths);
#endif
    VERNIER_TRY(selectVulkanDriver(choice));
    VulkanOptions options;
    options.validate = validate;
    options.robustBufferAccess = paths.robustBufferAccess;
    Result<std::unique_ptr<VulkanDriver>> driver = VulkanDriver::create(options);
    if (!driver) return driver.error();
    return std::unique_ptr<Driver>(std::move(driver).value());
}

Result<std::vector<OracleImage>> judgeScene(const Scene& scene, const OracleRules& rules) {
#if VERNIER_HAS_ORACLE
    return renderOracle(scene, rules);
#else
    (void)rules;
    return unsupported("scene '" + scene.name + "': the oracle is not in this build");
#endif
}

}  // namespace vernier::conformance
