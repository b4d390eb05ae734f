// vernier-accuracy: the price of accuracy. For each profile, each axis alone, and other drivers beside: the error
// against the exact oracle and the time per frame, in scenes that are each sensitive to one axis.
#include <unistd.h>

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "bench/accuracy/accuracy_scene.h"
#include "bench/accuracy/chart.h"
#include "bench/accuracy/choose.h"
#include "bench/accuracy/measure.h"
#include "bench/accuracy/page.h"
#include "conformance/drivers/try.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

struct Options {
    DriverPaths paths;
    std::string driver, scene;  // of render
    std::vector<std::string> scenes;
    std::filesystem::path out = "out/accuracy";
    std::vector<std::string> positions;
    uint32_t rounds = 3;
    bool all = false, fresh = false;
    double milliseconds = 0, error = 0;  // of the budget; 0: not asked for
};

int fail(const Error& error) {
    std::fprintf(stderr, "vernier-accuracy: %s\n", error.message.c_str());
    return 2;
}

void showProgress(size_t done, size_t all, const std::string& next) {
    constexpr size_t kWidth = 30;
    if (!isatty(STDERR_FILENO)) return;
    const size_t filled = all ? done * kWidth / all : kWidth;
    std::fprintf(stderr, "\r[%s%s] %zu/%zu %-50.50s%s", std::string(filled, '#').c_str(),
                 std::string(kWidth - filled, ' ').c_str(), done, all, next.c_str(), done == all ? "\n" : "");
}

Result<std::vector<const AccuracyScene*>> chosenScenes(const Options& options) {
    std::vector<const AccuracyScene*> chosen;
    if (options.all || options.scenes.empty())
        for (const AccuracyScene& scene : accuracySceneTable()) chosen.push_back(&scene);
    else
        for (const std::string& name : options.scenes) {
            const auto table = accuracySceneTable();
            const auto found = std::find_if(table.begin(), table.end(),
                                            [&](const AccuracyScene& scene) { return scene.name == name; });
            if (found == table.end()) return invalidArgument("--scene: there is no scene '" + name + "'; see list");
            chosen.push_back(&*found);
        }
    return chosen;
}

void printScene(const AccuracyRun& run, const MeasuredScene& scene) {
    std::printf("\n%s: %s\n", scene.scene->name, scene.scene->description);
    std::printf("  %-22s %10s %12s %12s %8s %10s %6s %8s\n", "position", "ms/frame", "worst /255", "mean /255",
                "outside", "misplaced", "holes", "doubles");
    for (const AccuracyPosition& position : run.positions) {
        const AccuracyFigures& f = scene.figures.at(position.label);
        if (!f.failure.empty()) {
            std::printf("  %-22s failed: %s\n", position.label.c_str(), f.failure.c_str());
            continue;
        }
        std::printf("  %-22s %10.3f %12.3g %12.3g %8llu %10llu %6llu %8llu\n", position.label.c_str(), f.frame, f.worst,
                    f.mean, static_cast<unsigned long long>(f.outside), static_cast<unsigned long long>(f.misplaced),
                    static_cast<unsigned long long>(f.holes), static_cast<unsigned long long>(f.doubles));
    }
}

void printBudget(const AccuracyRun& run, const Options& options) {
    const auto shown = [](const std::string& label) { return label.empty() ? "none" : label.c_str(); };
    for (const MeasuredScene& scene : run.scenes) {
        if (options.milliseconds > 0)
            std::printf("%s: the most exact setting within %g ms: %s\n", scene.scene->name, options.milliseconds,
                        shown(mostExactWithin(run, scene, options.milliseconds)));
        if (options.error > 0)
            std::printf("%s: the fastest setting whose worst error is at most %g/255: %s\n", scene.scene->name,
                        options.error, shown(fastestWithin(run, scene, options.error)));
    }
}

Status save(const AccuracyRun& run, const std::filesystem::path& out) {
    const auto store = [&](const std::string& name, const std::string& text) {
        return writeFile(out / name, text.data(), text.size());
    };
    const Result<std::string> html = accuracyPage(run);
    if (!html) return html.error();
    VERNIER_TRY(store("accuracy.html", *html));
    VERNIER_TRY(store("accuracy.json", runJson(run)));
    VERNIER_TRY(store("accuracy.csv", runCsv(run)));
    for (const MeasuredScene& scene : run.scenes)
        VERNIER_TRY(store(std::string(scene.scene->name) + ".svg", paretoSvg(run, scene)));
    return {};
}

/// Robustness is no axis: a hole, a double or a failure of ours at any position is an error.
bool isSound(const AccuracyRun& run) {
    for (const MeasuredScene& scene : run.scenes)
        for (const AccuracyPosition& position : run.positions) {
            const AccuracyFigures& f = scene.figures.at(position.label);
            if (position.driver == "api" && (!f.failure.empty() || f.holes || f.doubles)) return false;
        }
    return true;
}

int run(const Options& options) {
    const Result<std::vector<const AccuracyScene*>> scenes = chosenScenes(options);
    if (!scenes) return fail(scenes.error());
    const Result<AccuracyRun> measured = measureAccuracy(
        {options.paths, *scenes, options.out, options.positions, options.rounds, options.fresh, showProgress});
    if (!measured) return fail(measured.error());
    for (const MeasuredScene& scene : measured->scenes) printScene(*measured, scene);
    std::printf("\n%s", standingsText(*measured).c_str());
    printBudget(*measured, options);
    if (Status status = save(*measured, options.out); !status) return fail(status.error());
    std::printf("\n%s\n", (options.out / "accuracy.html").c_str());
    if (isSound(*measured)) return 0;
    std::fprintf(stderr, "vernier-accuracy: Vernier failed, or left a hole or a double; see above\n");
    return 1;
}

int render(const Options& options) {
    const Result<Scene> scene = accuracySceneNamed(options.scene);
    const Result<Rendering> rendering =
        scene ? renderScene(options.paths, options.driver, *scene, false) : Result<Rendering>(scene.error());
    const Status status = rendering ? saveRendering(*rendering, options.out) : Status(rendering.error());
    if (!status) return fail(status.error());
    return 0;
}

int list() {
    for (const AccuracyScene& scene : accuracySceneTable())
        std::printf("%-18s %s (%s)\n", scene.name, scene.description, scene.separates);
    return 0;
}

int main(int argc, char** argv) {
    CLI::App app("Shows what accuracy costs: error against the exact oracle beside time per frame.");
    Options options;
    addDriverOptions(app, options.paths);
    app.add_flag("--all", options.all, "All scenes, which is what happens without --scene, too");
    app.add_option("--scene", options.scenes, "Scenes to measure");
    app.add_option("--position", options.positions,
                   "Positions to measure beside standard: a profile, AXIS=POSITION, or a driver; all without this");
    app.add_option("--rounds", options.rounds, "How often each position is timed; the fastest round counts")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_option("--out", options.out, "Folder for the page, figures and what children write")->capture_default_str();
    app.add_flag("--fresh", options.fresh, "Measure again what an earlier run of this build has measured");
    app.add_option("--within-ms", options.milliseconds, "Name the most exact setting that takes at most so long");
    app.add_option("--within-error", options.error,
                   "Name the fastest setting whose worst error is at most so many 1/255");
    CLI::App* listCommand = app.add_subcommand("list", "Name the scenes");
    CLI::App* renderCommand = app.add_subcommand("render", "Draw one scene at one position (used by this program)");
    renderCommand->add_option("--driver", options.driver)->required();
    renderCommand->add_option("--scene", options.scene)->required();
    renderCommand->add_option("--out", options.out)->required();
    CLI11_PARSE(app, argc, argv);
    if (*listCommand) return list();
    return *renderCommand ? render(options) : run(options);
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    return vernier::bench::main(argc, argv);
}
