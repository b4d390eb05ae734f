// vernier-bench: every driver on every speed scene, in turn A B C A B C, each in a process of its own; medians and
// ratios.
#include <algorithm>
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/cpu_budget.h"
#include "base/simd.h"
#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/render_bench_scene.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct Measured {
    std::vector<double> frame, startUp;  // ms, one per round; start-up: device to first image, less one steady frame
    std::string driver, failure;
};

class Table {
  public:
    Table(std::vector<std::string> drivers, std::string reference)
        : drivers_(std::move(drivers)), reference_(std::move(reference)) {}

    void printHeader() const {
        std::printf("%-16s", "scene");
        for (const std::string& driver : drivers_) std::printf(" %12s %12s", driver.c_str(), "start-up");
        for (const std::string& driver : drivers_)
            if (driver != reference_) std::printf(" %11s", (driver + "/" + reference_.substr(0, 3)).c_str());
        std::printf("\n%-16s", "");
        for (size_t i = 0; i < drivers_.size(); ++i) std::printf(" %12s %12s", "ms/frame", "ms");
        std::printf("\n");
    }

    void printRow(const std::string& scene, const std::map<std::string, Measured>& row) {
        std::printf("%-16s", scene.c_str());
        for (const std::string& driver : drivers_) {
            const Measured& m = row.at(driver);
            if (m.frame.empty())
                std::printf(" %12s %12s", "failed", "-");
            else
                std::printf(" %12.3f %12.2f", median(m.frame), median(m.startUp));
        }
        const Measured& base = row.at(reference_);
        for (const std::string& driver : drivers_) {
            const Measured& m = row.at(driver);
            if (driver == reference_) continue;
            if (m.frame.empty() || base.frame.empty()) {
                std::printf(" %11s", "-");
                continue;
            }
            const double ratio = median(m.frame) / median(base.frame);
            ratios_[driver].push_back(ratio);
            startRatios_[driver].push_back(median(m.startUp) / median(base.startUp));
            std::printf(" %11.2f", ratio);
        }
        std::printf("\n");
        std::fflush(stdout);
    }

    void printMeans() const {
        for (const auto& [driver, ratios] : ratios_)
            std::printf("%s against %s over %zu scenes: frame time x %.2f, start-up x %.3f (geometric means)\n",
                        driver.c_str(), reference_.c_str(), ratios.size(), geometricMean(ratios),
                        geometricMean(startRatios_.at(driver)));
    }

  private:
    static double geometricMean(const std::vector<double>& values) {
        double sum = 0;
        for (const double value : values) sum += std::log(value);
        return std::exp(sum / static_cast<double>(values.size()));
    }

    std::vector<std::string> drivers_;
    std::string reference_;
    std::map<std::string, std::vector<double>> ratios_, startRatios_;
};

struct RunOptions {
    std::vector<std::string> drivers, scenes;
    uint32_t rounds = 3;
    std::filesystem::path out = "out/bench";
    std::string json;
};

int run(const DriverPaths& paths, const RunOptions& options) {
    std::vector<std::string> drivers;
    for (const DriverChoice& choice : driverChoices(paths)) {
        const bool wanted =
            options.drivers.empty() || std::count(options.drivers.begin(), options.drivers.end(), choice.name);
        if (wanted && choice.present()) drivers.push_back(choice.name);
        if (wanted && !choice.present())
            std::printf("left out: %s (%s)\n", choice.name.c_str(), choice.absence.c_str());
    }
    const std::string reference =
        std::count(drivers.begin(), drivers.end(), "lavapipe") ? std::string("lavapipe") : drivers.back();
    std::printf("%u usable CPUs, %s, %u rounds, medians\n", usableCpuCount(), std::string(isaName(bestIsa())).c_str(),
                options.rounds);
    Table table(drivers, reference);
    table.printHeader();
    nlohmann::json report;
    for (const SceneEntry& entry : speedScenes()) {
        const std::string scene(entry.name);
        if (!options.scenes.empty() && !std::count(options.scenes.begin(), options.scenes.end(), scene)) continue;
        std::map<std::string, Measured> row;
        for (uint32_t round = 0; round < options.rounds; ++round)
            for (const std::string& driver : drivers) {
                Measured& measured = row[driver];
                const Result<Rendering> rendering = renderInChild(paths, driver, scene, options.out / driver, 120);
                if (!rendering) {
                    measured.failure = rendering.error().message;
                    continue;
                }
                measured.driver = rendering->driver + " " + rendering->version;
                measured.frame.push_back(rendering->timing.frame);
                const Timing& timing = rendering->timing;
                measured.startUp.push_back(timing.firstImage - timing.startUp - timing.frame);
            }
        table.printRow(scene, row);
        for (const auto& [driver, measured] : row) {
            if (!measured.failure.empty()) std::printf("  %s: %s\n", driver.c_str(), measured.failure.c_str());
            report[scene][driver] = {{"driver", measured.driver},
                                     {"frame_ms", measured.frame},
                                     {"start_up_ms", measured.startUp},
                                     {"failure", measured.failure}};
        }
    }
    table.printMeans();
    if (!options.json.empty()) std::ofstream(options.json) << report.dump(2) << '\n';
    return 0;
}

int main(int argc, char** argv) {
    CLI::App app("Times Vernier against other Vulkan drivers.");
    app.require_subcommand(1);
    DriverPaths paths;
    addDriverOptions(app, paths);
    CLI::App* renderCommand = app.add_subcommand("render", "Time one scene on one driver (used by run)");
    std::string driver, scene;
    std::filesystem::path out;
    renderCommand->add_option("--driver", driver)->required();
    renderCommand->add_option("--scene", scene)->required();
    renderCommand->add_option("--out", out)->required();
    CLI::App* runCommand = app.add_subcommand("run", "Time all scenes on all drivers");
    RunOptions options;
    runCommand->add_option("--driver", options.drivers, "Only these drivers");
    runCommand->add_option("--scene", options.scenes, "Only these scenes");
    runCommand->add_option("--rounds", options.rounds, "Runs of each driver and scene")->check(CLI::Range(1, 1000));
    runCommand->add_option("--out", options.out, "Folder for what the children write");
    runCommand->add_option("--json", options.json, "File for the figures");
    CLI11_PARSE(app, argc, argv);
    return *renderCommand ? renderBenchScene(paths, driver, scene, out) : run(paths, options);
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    return vernier::bench::main(argc, argv);
}
