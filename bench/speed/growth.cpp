#include "bench/speed/growth.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/cpu_budget.h"
#include "bench/scenes/growth_scenes.h"
#include "bench/speed/plot.h"

namespace vernier::bench {
namespace {

using namespace conformance;

/// The scene whose time is measured against the number of CPUs.
constexpr const char* kThreadsScene = "lights:128";

/// One axis: its points by driver, printed and plotted.
class AxisRun {
  public:
    AxisRun(std::string name, std::string what, const std::vector<std::string>& drivers)
        : drivers_(drivers), plot_{std::move(name), std::move(what), "ms per frame", {}} {
        for (const std::string& driver : drivers) plot_.lines.push_back({driver, {}});
        std::printf("\n%s: %s\n%12s", plot_.title.c_str(), plot_.x.c_str(), "amount");
        for (const std::string& driver : drivers) std::printf(" %12s", driver.c_str());
        std::printf("   ms per frame\n");
    }

    void add(uint32_t amount, const Row& row) {
        std::printf("%12u", amount);
        nlohmann::json& entry = report_["amounts"][std::to_string(amount)];
        for (size_t i = 0; i < drivers_.size(); ++i) {
            const Measured& measured = row.measured.at(drivers_[i]);
            if (measured.frame.empty()) {
                std::printf(" %12s", "failed");
                continue;
            }
            const double time = median(measured.frame);
            std::printf(" %12.3f", time);
            plot_.lines[i].points.push_back({static_cast<double>(amount), std::max(time, 1e-4)});
            entry[drivers_[i]] = time;
        }
        std::printf("\n");
        std::fflush(stdout);
    }

    nlohmann::json finish(const std::filesystem::path& plots) {
        std::printf("%12s", "exponent");
        for (PlotLine& line : plot_.lines) {
            const double exponent = fittedExponent(line.points);
            std::printf(" %12.2f", exponent);
            report_["exponents"][line.name] = exponent;
            char text[32];
            std::snprintf(text, sizeof text, " (%.2f)", exponent);
            line.name += text;
        }
        std::printf("\n");
        std::ofstream(plots / ("growth_" + plot_.title + ".svg")) << plotSvg(plot_);
        return report_;
    }

  private:
    const std::vector<std::string>& drivers_;
    Plot plot_;
    nlohmann::json report_;
};

}  // namespace

int runGrowth(const DriverPaths& paths, const RunOptions& options, const std::filesystem::path& plots) {
    const std::vector<std::string> drivers = presentDrivers(paths, options, true);
    if (drivers.empty()) return std::fprintf(stderr, "no driver to run\n"), 2;
    std::error_code error;
    std::filesystem::create_directories(plots, error);
    if (error) return std::fprintf(stderr, "cannot create %s\n", plots.c_str()), 2;
    const auto wanted = [&](std::string_view name) {
        return options.names.empty() || std::count(options.names.begin(), options.names.end(), name);
    };
    std::printf("%s, %u rounds, medians\n", machineText().c_str(), options.rounds);
    nlohmann::json report;
    Table table(drivers, drivers.back());
    for (const GrowthAxis& axis : growthAxes()) {
        if (!wanted(axis.name)) continue;
        AxisRun run(std::string(axis.name), std::string(axis.what), drivers);
        for (const uint32_t amount : axis.amounts) {
            const Row row = measureRow(paths, options, drivers, std::string(axis.name) + ":" + std::to_string(amount));
            table.note(row.measured);
            run.add(amount, row);
        }
        report[std::string(axis.name)] = run.finish(plots);
    }
    if (wanted("threads")) {
        AxisRun run("threads", std::string("CPUs of the process, ") + kThreadsScene, drivers);
        const uint32_t all = usableCpuCount();
        for (uint32_t cpus = 1; cpus <= all; cpus = cpus < all ? std::min(cpus * 2, all) : all + 1) {
            DriverPaths limited = paths;
            limited.cpus = cpus;
            const Row row = measureRow(limited, options, drivers, kThreadsScene);
            table.note(row.measured);
            run.add(cpus, row);
        }
        report["threads"] = run.finish(plots);
    }
    std::printf("\n");
    table.printDrivers();
    if (!options.json.empty()) std::ofstream(options.json) << report.dump(2) << '\n';
    return 0;
}

}  // namespace vernier::bench
