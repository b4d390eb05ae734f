// vernier-accuracy: the price of accuracy. For each profile, and for lavapipe and SwiftShader beside, the error against
// the exact oracle and the time per frame, in scenes that are each sensitive to one axis.
#include <algorithm>
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/render_bench_scene.h"
#include "conformance/scene/scene_format.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

int fail(const Error& error) {
    std::fprintf(stderr, "vernier-accuracy: %s\n", error.message.c_str());
    return 2;
}

struct ErrorFigures {
    double worst = 0, mean = 0;  // absolute, in units of 1/255 of the full range
    uint64_t outside = 0;        // pixels outside what the specification permits
    uint64_t judged = 0, undecided = 0;
};

/// Edge pixels, whose coverage may legally differ, are left out of the error: it is the values that are measured.
ErrorFigures compare(const RenderedImage& image, const OracleImage& oracle) {
    const SceneFormat& format = *sceneFormat(image.format);
    ErrorFigures figures;
    double sum = 0;
    uint64_t values = 0;
    for (size_t i = 0; i < oracle.pixels.size(); ++i) {
        const OraclePixel& pixel = oracle.pixels[i];
        if (pixel.flags & kOracleUnknown) ++figures.undecided;
        if (pixel.flags) continue;
        ++figures.judged;
        const std::span<const std::byte> texel(image.texels.data() + i * format.texelBytes, format.texelBytes);
        bool inside = true;
        for (size_t c = 0; c < format.componentCount; ++c) {
            const double value = decodeComponent(format.components[c], componentCode(format.components[c], texel));
            const double error = std::isnan(value) ? INFINITY : std::abs(value - pixel.value[c]) * 255;
            figures.worst = std::max(figures.worst, error);
            sum += error;
            ++values;
            inside = inside && value >= pixel.low[c] && value <= pixel.high[c];
        }
        if (!inside) ++figures.outside;
    }
    figures.mean = values ? sum / static_cast<double>(values) : 0;
    return figures;
}

struct Position {
    std::string label, driver, profile;
};

std::vector<Position> positions(const std::vector<DriverChoice>& choices) {
    std::vector<Position> result;
    for (const DriverChoice& choice : choices) {
        if (!choice.present() || choice.name == "icd") continue;  // the driver runs the same backend as the API
        if (choice.name != "api") {
            result.push_back({choice.name, choice.name, "standard"});
            continue;
        }
        for (const char* profile : {"draft", "fast", "standard", "fine", "reference"})
            result.push_back({profile, "api", profile});
    }
    return result;
}

int run(const DriverPaths& paths, const std::filesystem::path& out, const std::string& json) {
    nlohmann::json report;
    bool complete = true;
    for (const SceneEntry& entry : accuracyScenes()) {
        const Result<Scene> scene = entry.build();
        if (!scene) return fail(scene.error());
        const Result<std::vector<OracleImage>> oracle = judgeScene(*scene);
        if (!oracle) return fail(oracle.error());
        std::printf("\n%s: %s\n", scene->name.c_str(), scene->description.c_str());
        std::printf("  %-12s %10s %14s %14s %10s %10s\n", "position", "ms/frame", "worst /255", "mean /255", "outside",
                    "judged");
        for (const Position& position : positions(driverChoices(paths))) {
            DriverPaths positionPaths = paths;
            positionPaths.profile = position.profile;
            const Result<Rendering> rendering =
                renderInChild(positionPaths, position.driver, scene->name, out / position.label, 120);
            if (!rendering) {
                std::printf("  %-12s failed: %s\n", position.label.c_str(), rendering.error().message.c_str());
                complete = complete && position.driver != "api";
                continue;
            }
            const ErrorFigures figures = compare(rendering->images[0], (*oracle)[0]);
            std::printf("  %-12s %10.3f %14.3g %14.3g %10llu %10llu\n", position.label.c_str(), rendering->timing.frame,
                        figures.worst, figures.mean, static_cast<unsigned long long>(figures.outside),
                        static_cast<unsigned long long>(figures.judged));
            report[scene->name][position.label] = {
                {"frame_ms", rendering->timing.frame}, {"worst_255", figures.worst}, {"mean_255", figures.mean},
                {"outside", figures.outside},          {"judged", figures.judged},   {"undecided", figures.undecided}};
        }
    }
    if (!json.empty()) std::ofstream(json) << report.dump(2) << '\n';
    return complete ? 0 : 1;
}

int main(int argc, char** argv) {
    CLI::App app("Shows what accuracy costs: error against the exact oracle beside time per frame.");
    app.require_subcommand(1);
    DriverPaths paths;
    addDriverOptions(app, paths);
    CLI::App* renderCommand = app.add_subcommand("render", "Draw one scene at one position (used by run)");
    std::string driver, scene, json;
    std::filesystem::path renderOut, runOut = "out/accuracy";
    renderCommand->add_option("--driver", driver)->required();
    renderCommand->add_option("--scene", scene)->required();
    renderCommand->add_option("--out", renderOut)->required();
    CLI::App* runCommand = app.add_subcommand("run", "Measure every profile and every other driver");
    runCommand->add_option("--out", runOut, "Folder for what the children write");
    runCommand->add_option("--json", json, "File for the figures");
    CLI11_PARSE(app, argc, argv);
    return *renderCommand ? renderBenchScene(paths, driver, scene, renderOut) : run(paths, runOut, json);
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    return vernier::bench::main(argc, argv);
}
