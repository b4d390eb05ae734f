// vernier-bench: every driver on every speed scene or compute kernel, in turn A B C A B C, each in a process of its
// own; medians, ratios and growth.
#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/compute/run_kernel.h"
#include "bench/effects/effects_table.h"
#include "bench/scenes/bench_scenes.h"
#include "bench/scenes/render_bench_scene.h"
#include "bench/speed/growth.h"
#include "bench/speed/measure.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

/// What the drivers made of a kernel, compared with the reference's; one line each.
nlohmann::json compareKernel(const Kernel& kernel, const std::map<std::string, Rendering>& last,
                             const std::string& reference) {
    nlohmann::json report;
    const auto base = last.find(reference);
    for (const auto& [driver, rendering] : last) {
        if (driver == reference || base == last.end()) continue;
        const KernelDifference difference = compareOutputs(kernel, rendering, base->second);
        std::printf("  %s %s %s: worst difference %.3g, %.3g%% beyond %.3g (allowed: %.3g%%)\n", driver.c_str(),
                    difference.agrees ? "agrees with" : "DIFFERS from", reference.c_str(), difference.worst,
                    100 * difference.share, kernel.tolerance, 100 * kernel.share);
        report[driver] = {
            {"worst", difference.worst}, {"share_beyond", difference.share}, {"agrees", difference.agrees}};
    }
    return report;
}

int run(const DriverPaths& paths, const RunOptions& options, const std::vector<std::string>& names, bool compute) {
    const std::vector<std::string> drivers = presentDrivers(paths, options, compute);
    if (drivers.empty()) return std::fprintf(stderr, "no driver to run\n"), 2;
    const std::string reference =
        std::count(drivers.begin(), drivers.end(), "lavapipe") ? std::string("lavapipe") : drivers.back();
    std::printf("%s, %u rounds, medians\n", machineText().c_str(), options.rounds);
    std::printf(
        "start-up: creating pipelines and the first run%s, less a steady run; modules: creating shader modules\n",
        compute ? " (of one work-group)" : "");
    Table table(drivers, reference);
    table.printHeader(compute ? "kernel" : "scene");
    nlohmann::json report;
    bool agree = true;
    for (const std::string& name : names) {
        if (!options.names.empty() && !std::count(options.names.begin(), options.names.end(), name)) continue;
        const Row row = measureRow(paths, options, drivers, name);
        table.printRow(name, row.measured);
        for (const auto& [driver, measured] : row.measured)
            if (!measured.failure.empty()) std::printf("  %s: %s\n", driver.c_str(), measured.failure.c_str());
        report[name] = rowReport(row);
        if (!compute) continue;
        const nlohmann::json comparison = compareKernel(*findKernel(name), row.last, reference);
        for (const auto& [driver, entry] : comparison.items()) {
            report[name][driver]["against_" + reference] = entry;
            agree = agree && entry["agrees"].get<bool>();
        }
    }
    table.printSummary();
    if (!options.json.empty()) std::ofstream(options.json) << report.dump(2) << '\n';
    return agree ? 0 : 1;
}

/// What a child does: one scene or kernel on one driver.
int renderOne(const DriverPaths& paths, const std::string& driver, const std::string& name,
              const std::filesystem::path& out) {
    const Kernel* kernel = findKernel(name);
    if (!kernel) return renderBenchScene(paths, driver, name, out);
    const Result<Rendering> rendering = runKernel(paths, driver, *kernel);
    const Status status = rendering ? saveRendering(*rendering, out) : Status(rendering.error());
    if (!status) std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return status ? 0 : 2;
}

void addRunOptions(CLI::App& command, RunOptions& options, const char* nameOption) {
    command.add_option("--driver", options.drivers, "Only these drivers");
    command.add_option(nameOption, options.names, "Only these");
    command.add_option("--rounds", options.rounds, "Runs of each driver and row")->check(CLI::Range(1, 1000));
    command.add_option("--out", options.out, "Folder for what the children write");
    command.add_option("--json", options.json, "File for the figures");
}

int main(int argc, char** argv) {
    CLI::App app("Times Vernier against other Vulkan drivers.");
    app.require_subcommand(1);
    DriverPaths paths;
    addDriverOptions(app, paths);
    CLI::App* renderCommand =
        app.add_subcommand("render", "Time one scene or kernel on one driver (used by the others)");
    std::string driver, scene;
    std::filesystem::path out;
    renderCommand->add_option("--driver", driver)->required();
    renderCommand->add_option("--scene", scene)->required();
    renderCommand->add_option("--out", out)->required();
    RunOptions options;
    CLI::App* runCommand = app.add_subcommand("run", "Time all scenes on all drivers");
    addRunOptions(*runCommand, options, "--scene");
    CLI::App* transferCommand =
        app.add_subcommand("transfer", "Time copies, blits, clears and resolves on all drivers");
    addRunOptions(*transferCommand, options, "--scene");
    CLI::App* computeCommand =
        app.add_subcommand("compute", "Time all compute kernels on all Vulkan drivers and compare what they compute");
    addRunOptions(*computeCommand, options, "--kernel");
    CLI::App* growthCommand =
        app.add_subcommand("growth", "Time all Vulkan drivers as triangles, pixels, overdraw, lights and CPUs grow");
    addRunOptions(*growthCommand, options, "--axis");
    std::filesystem::path plots = "out/bench";
    growthCommand->add_option("--plots", plots, "Folder for the plots (SVG)");
    EffectsOptions effects;
    CLI::App* effectsCommand =
        app.add_subcommand("effects", "Count the instructions that effects cost: unused, in the state, needed");
    effectsCommand->add_option("--effect", effects.names, "Only these");
    effectsCommand->add_option("--out", effects.out, "Folder for what Valgrind writes");
    effectsCommand->add_option("--json", effects.json, "File for the figures");
    effectsCommand->add_option("--page", effects.page, "File for the table as a page in Markdown");
    effectsCommand->add_option("--chart", effects.chart, "File for the ratios as a chart in SVG");
    effectsCommand->add_flag("--counted", effects.counted, "Used by the command itself, under Valgrind");
    CLI11_PARSE(app, argc, argv);
    if (*renderCommand) return renderOne(paths, driver, scene, out);
    if (*effectsCommand) return runEffects(paths, effects);
    if (*growthCommand) return runGrowth(paths, options, plots);
    std::vector<std::string> names;
    if (*computeCommand)
        for (const Kernel& kernel : kernels()) names.emplace_back(kernel.name);
    else
        for (const SceneEntry& entry : *transferCommand ? transferScenes() : speedScenes())
            names.emplace_back(entry.name);
    return run(paths, options, names, computeCommand->parsed());
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
    return vernier::bench::main(argc, argv);
}
