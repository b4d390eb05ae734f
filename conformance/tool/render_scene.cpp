#include "conformance/tool/render_scene.h"

#include <algorithm>
#include <system_error>

#include "conformance/tool/child_process.h"

namespace vernier::conformance {

void addDriverOptions(CLI::App& app, DriverPaths& paths) {
    app.add_option("--icd", paths.icd, "Manifest (JSON) of Vernier's Vulkan driver");
    app.add_option("--lavapipe", paths.lavapipe, "Manifest of lavapipe")->capture_default_str();
    app.add_option("--swiftshader", paths.swiftShader, "Manifest of SwiftShader")->capture_default_str();
    app.add_option("--profile", paths.profile, "Accuracy of the api driver: draft, fast, standard, fine or reference");
}

std::vector<std::string> driverArguments(const DriverPaths& paths) {
    return {"--icd",         paths.icd.string(),         "--lavapipe", paths.lavapipe.string(),
            "--swiftshader", paths.swiftShader.string(), "--profile",  paths.profile};
}

Result<Rendering> renderScene(const DriverPaths& paths, const std::string& driver, const SceneEntry& entry,
                              bool validate) {
    const std::vector<DriverChoice> choices = driverChoices(paths);
    const auto choice =
        std::find_if(choices.begin(), choices.end(), [&](const DriverChoice& each) { return each.name == driver; });
    if (choice == choices.end()) return invalidArgument("--driver: no driver is called '" + driver + "'");
    const Result<Scene> scene = entry.build();
    if (!scene) return scene.error();
    const Result<std::unique_ptr<Driver>> made = createDriver(*choice, paths, validate);
    if (!made) return made.error();
    Rendering rendering;
    rendering.scene = entry.name;
    rendering.driver = made.value()->name();
    rendering.version = made.value()->version();
    rendering.limits = made.value()->limits();
    Result<std::vector<RenderedImage>> images = made.value()->render(scene.value(), &rendering.timing);
    if (!images) return images.error();
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
    return loadRendering(folder, scene);
}

}  // namespace vernier::conformance
