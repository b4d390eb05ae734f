// vernier-conformance: draws the conformance scenes, compares what the drivers made of them, and writes the
// report.
#include "conformance/arbiter/hypotheses.h"
#include "conformance/report/picture.h"
#include "conformance/scenes/scenes.h"
#include "conformance/tool/driver_choice.h"
#include "conformance/tool/oracle_file.h"
#include "conformance/tool/render_scene.h"
#include "conformance/tool/rendering.h"
#include "conformance/tool/run.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>

namespace vernier::conformance {
namespace {

int fail(const Error& error) {
    std::fprintf(stderr, "vernier-conformance: %s\n", error.message.c_str());
    return 2;
}

int list(const std::vector<DriverChoice>& choices) {
    std::printf("drivers:\n");
    for (const DriverChoice& choice : choices) {
        std::printf("  %-12s %s%s%s\n", choice.name.c_str(), choice.title.c_str(),
                    choice.present() ? "" : " - absent: ", choice.absence.c_str());
    }
    std::printf("scenes:\n");
    for (const SceneEntry& entry : allScenes()) {
        const Result<Scene> scene = entry.build();
        if (!scene) return fail(scene.error());
        std::printf("  %-20s %s\n", std::string(entry.name).c_str(), scene.value().description.c_str());
    }
    return 0;
}

struct RenderOptions {
    std::string driver, scene;
    std::filesystem::path out;
    bool validate = false;
    bool png = false;
};

Status writePictures(const Rendering& rendering, const std::filesystem::path& directory) {
    for (size_t i = 0; i < rendering.images.size(); ++i) {
        const RenderedImage& image = rendering.images[i];
        const Result<std::string> png = encodePng(pictureOf(image, stretchFor(image)));
        if (!png) return png.error();
        Status status = writeFile(directory / (rendering.scene + "." + std::to_string(i) + ".png"), png.value().data(),
                                  png.value().size());
        if (!status) return status;
    }
    return {};
}

int render(const DriverPaths& paths, const RenderOptions& options) {
    const SceneEntry* entry = findScene(options.scene);
    if (entry == nullptr) return fail(invalidArgument("--scene: no scene is called '" + options.scene + "'"));
    const Result<Scene> scene = entry->build();
    if (!scene) return fail(scene.error());
    const Result<Rendering> rendering = renderScene(paths, options.driver, *scene, options.validate);
    if (!rendering) return fail(rendering.error());
    if (const Status status = saveRendering(*rendering, options.out); !status) return fail(status.error());
    if (!options.png) return 0;
    if (const Status status = writePictures(*rendering, options.out); !status) return fail(status.error());
    return 0;
}

/// The oracle's verdict on one scene, or on what hypotheses make of it, into a file.
int judge(const std::string& name, const std::vector<std::string>& hypotheses, const std::filesystem::path& out) {
    const SceneEntry* entry = findScene(name);
    if (entry == nullptr) return fail(invalidArgument("--scene: no scene is called '" + name + "'"));
    Result<Scene> scene = entry->build();
    if (!scene) return fail(scene.error());
    OracleRules rules;
    for (const std::string& hypothesisName : hypotheses) {
        const Hypothesis* hypothesis = findHypothesis(hypothesisName);
        if (hypothesis == nullptr) return fail(invalidArgument("--hypothesis: there is no '" + hypothesisName + "'"));
        hypothesis->apply(*scene, rules);
    }
    const Result<std::vector<OracleImage>> images = judgeScene(scene.value(), rules);
    if (!images) return fail(images.error());
    if (const Status status = saveOracle(images.value(), out); !status) return fail(status.error());
    return 0;
}

int run(int argc, char** argv) {
    CLI::App app("Draws Vernier's conformance scenes and compares what drivers made of them.");
    app.require_subcommand(1);
    DriverPaths paths;
    addDriverOptions(app, paths);

    RenderOptions renderOptions;
    CLI::App* listCommand = app.add_subcommand("list", "Name the drivers and the scenes");
    CLI::App* renderCommand = app.add_subcommand("render", "Draw one scene with one driver");
    renderCommand->add_option("--driver", renderOptions.driver, "api, icd, lavapipe or swiftshader")->required();
    renderCommand->add_option("--scene", renderOptions.scene, "Name of the scene")->required();
    renderCommand->add_option("--out", renderOptions.out, "Folder for the raw images and the timings")->required();
    renderCommand->add_flag("--validate", renderOptions.validate, "Fail on any error of VK_LAYER_KHRONOS_validation");
    renderCommand->add_flag("--png", renderOptions.png, "Write a PNG file beside each raw image");

    CLI::App* oracleCommand = app.add_subcommand("oracle", "Compute what the specification permits in one scene");
    std::string oracleScene;
    std::vector<std::string> oracleHypotheses;
    std::filesystem::path oracleOut;
    oracleCommand->add_option("--scene", oracleScene, "Name of the scene")->required();
    oracleCommand->add_option("--hypothesis", oracleHypotheses, "What an implementation might do instead");
    oracleCommand->add_option("--out", oracleOut, "File for the result")->required();

    CLI::App* runCommand = app.add_subcommand("run", "Draw all scenes with all drivers, compare, and write the report");
    RunOptions runOptions;
    bool withoutOracle = false;
    runCommand->add_option("--out", runOptions.out, "Folder for the report")->capture_default_str();
    runCommand->add_option("--known-gaps", runOptions.knownGaps, "JSON file of known gaps");
    runCommand->add_option("--scene", runOptions.scenes, "Only these scenes");
    runCommand->add_option("--driver", runOptions.drivers, "Only these drivers");
    runCommand->add_option("--timeout", runOptions.timeoutSeconds, "Seconds per scene and driver")
        ->capture_default_str();
    runCommand->add_option("--oracle-timeout", runOptions.oracleTimeoutSeconds, "Seconds per scene")
        ->capture_default_str();
    runCommand->add_flag("--validate", runOptions.validate, "Run with VK_LAYER_KHRONOS_validation");
    runCommand->add_flag("--no-oracle", withoutOracle, "Compare drivers with one another only");
    CLI11_PARSE(app, argc, argv);

    const std::vector<DriverChoice> choices = driverChoices(paths);
    if (*listCommand) return list(choices);
    if (*renderCommand) return render(paths, renderOptions);
    if (*oracleCommand) return judge(oracleScene, oracleHypotheses, oracleOut);
    runOptions.oracle = !withoutOracle;
    runOptions.commonArguments = driverArguments(paths);
    const Result<bool> passed = runComparison(choices, runOptions);
    if (!passed) return fail(passed.error());
    return passed.value() ? 0 : 1;
}

}  // namespace
}  // namespace vernier::conformance

int main(int argc, char** argv) {
    return vernier::conformance::run(argc, argv);
}
