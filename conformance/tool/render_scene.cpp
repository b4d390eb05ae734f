#include "conformance/tool/render_scene.h"

#include <link.h>
#include <sched.h>

#include <algorithm>
#include <system_error>

#include "conformance/drivers/try.h"
#include "conformance/tool/child_process.h"

namespace vernier::conformance {

void addDriverOptions(CLI::App& app, DriverPaths& paths) {
    app.add_option("--icd", paths.icd, "Manifest (JSON) of Vernier's Vulkan driver");
    app.add_option("--lavapipe", paths.lavapipe, "Manifest of lavapipe")->capture_default_str();
    app.add_option("--swiftshader", paths.swiftShader, "Manifest of SwiftShader")->capture_default_str();
    app.add_option("--profile", paths.profile, "Accuracy of the api driver: draft, fast, standard, fine or reference");
    app.add_option("--axes", paths.axes, "Axes of accuracy of the api driver: \"axis=position ...\"");
    app.add_option("--skips", paths.skips, "What the api driver leaves out: on, off, or \"rule=off ...\"");
    app.add_option("--cpus", paths.cpus, "CPUs a driver's process may use (0: all)");
}

std::vector<std::string> driverArguments(const DriverPaths& paths) {
    return {"--icd",         paths.icd.string(),
            "--lavapipe",    paths.lavapipe.string(),
            "--swiftshader", paths.swiftShader.string(),
            "--profile",     paths.profile,
            "--axes",        paths.axes,
            "--skips",       paths.skips,
            "--cpus",        std::to_string(paths.cpus)};
}

uint64_t loadedLibraryBytes() {
    uint64_t bytes = 0;
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void* sum) {
            std::error_code error;
            const uint64_t size = std::filesystem::file_size(info->dlpi_name, error);
            if (!error) *static_cast<uint64_t*>(sum) += size;
            return 0;
        },
        &bytes);
    return bytes;
}

Status limitCpus(uint32_t count) {
    cpu_set_t all, some;
    CPU_ZERO(&some);
    if (count == 0) return {};
    if (sched_getaffinity(0, sizeof all, &all) != 0) return unsupported("--cpus: the process's CPUs are not known");
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&some) < static_cast<int>(count); ++cpu)
        if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &some);
    if (CPU_COUNT(&some) < static_cast<int>(count) || sched_setaffinity(0, sizeof some, &some) != 0)
        return invalidArgument("--cpus: there are not " + std::to_string(count) + " CPUs");
    return {};
}

Result<Rendering> renderScene(const DriverPaths& paths, const std::string& driver, const Scene& scene, bool validate) {
    const std::vector<DriverChoice> choices = driverChoices(paths);
    const auto choice =
        std::find_if(choices.begin(), choices.end(), [&](const DriverChoice& each) { return each.name == driver; });
    if (choice == choices.end()) return invalidArgument("--driver: no driver is called '" + driver + "'");
    VERNIER_TRY(limitCpus(paths.cpus));
    const uint64_t librariesBefore = loadedLibraryBytes();
    const Result<std::unique_ptr<Driver>> made = createDriver(*choice, paths, validate);
    if (!made) return made.error();
    Rendering rendering;
    rendering.scene = scene.name;
    rendering.driver = made.value()->name();
    rendering.version = made.value()->version();
    rendering.limits = made.value()->limits();
    Result<std::vector<RenderedImage>> images = made.value()->render(scene, &rendering.timing);
    if (!images) return images.error();
    rendering.libraries = loadedLibraryBytes() - librariesBefore;
    rendering.notNeeded = made.value()->notNeeded();
    rendering.images = std::move(images).value();
    return rendering;
}

Result<Rendering> renderInChild(const DriverPaths& paths, const std::string& driver, const std::string& scene,
                                const std::filesystem::path& folder, double timeoutSeconds) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return invalidArgument("cannot create " + folder.string() + ": " + error.message());
    std::vector<std::string> arguments = driverArguments(paths);
    for (const std::string& argument : {std::string("render"), std::string("--driver"), driver, std::string("--scene"),
                                        scene, std::string("--out"), folder.string()})
        arguments.push_back(argument);
    const ChildResult child = runChild(arguments, folder / (scene + ".log"), timeoutSeconds);
    if (!child.ok) return invalidArgument(child.failure);
    Result<Rendering> rendering = loadRendering(folder, scene);
    if (rendering) rendering->peakMemory = child.peakMemory;
    return rendering;
}

}  // namespace vernier::conformance
