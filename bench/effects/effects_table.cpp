#include "bench/effects/effects_table.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/effects/effects_page.h"
#include "bench/speed/measure.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;

/// Runs this command again under Callgrind. 0, or what went wrong.
int countInValgrind(const DriverPaths& paths, const EffectsOptions& options) {
    std::vector<std::string> words{"valgrind",
                                   "--tool=callgrind",
                                   "--instr-atstart=no",
                                   "--quiet",
                                   "--callgrind-out-file=" + (options.out / "callgrind.out").string(),
                                   std::filesystem::canonical("/proc/self/exe").string()};
    for (const std::string& word : driverArguments(paths)) words.push_back(word);
    words.insert(words.end(), {"effects", "--counted"});
    for (const std::string& name : options.names) words.insert(words.end(), {"--effect", name});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = -1;
    int status = 0;
    if (posix_spawnp(&child, "valgrind", nullptr, nullptr, argv.data(), environ) != 0) return kCannotCount;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return 2;
    return WEXITSTATUS(status) == 127 ? kCannotCount : WEXITSTATUS(status);
}

/// The same scenes again: of their times the least count. Returns by what fraction that of the first scene differed.
double timeAgain(const DriverPaths& paths, EffectRow& row) {
    constexpr int kMoreRounds = 2;
    const double first = row.costs[Effect::kOff].milliseconds;
    double least = first, most = first;
    for (int round = 0; round < kMoreRounds; ++round) {
        const Result<std::vector<SceneCost>> again = drawEffect(paths, *row.effect);
        if (!again) continue;
        least = std::min(least, (*again)[Effect::kOff].milliseconds);
        most = std::max(most, (*again)[Effect::kOff].milliseconds);
        for (size_t i = 0; i < row.costs.size(); ++i)
            row.costs[i].milliseconds = std::min(row.costs[i].milliseconds, (*again)[i].milliseconds);
    }
    return least > 0 ? most / least - 1 : 0;
}

void print(const EffectRow& row) {
    const auto& costs = row.costs;
    const auto million = [](uint64_t instructions) { return static_cast<double>(instructions) * 1e-6; };
    std::printf("%-18s %8.3f %8.3f ", row.effect->name.c_str(), million(costs[Effect::kOff].instructions),
                row.ratio(Effect::kIdle));
    if (costs.size() > Effect::kNeeded)
        std::printf("%8.3f ", row.ratio(Effect::kNeeded));
    else
        std::printf("%8s ", "-");
    std::printf("%8.3f %8.3f ", costs[Effect::kOff].milliseconds, costs[Effect::kIdle].milliseconds);
    if (costs.size() > Effect::kNeeded)
        std::printf("%8.3f", costs[Effect::kNeeded].milliseconds);
    else
        std::printf("%8s", "-");
    const std::string complaint = row.complaint();
    std::printf("  %s%s%s\n", row.effect->idle.c_str(), complaint.empty() ? "" : "  <- ", complaint.c_str());
}

nlohmann::json report(const EffectRow& row) {
    nlohmann::json entry{{"idle_state", row.effect->idle}};
    constexpr const char* kNames[] = {"off", "idle", "needed"};
    for (size_t i = 0; i < row.costs.size(); ++i)
        entry[kNames[i]] = {{"instructions", row.costs[i].instructions},
                            {"ratio", row.ratio(i)},
                            {"milliseconds", row.costs[i].milliseconds}};
    return entry;
}

/// What the process under Valgrind does: every frame is dumped.
int drawAll(const DriverPaths& paths, const std::vector<Effect>& effects) {
    for (const Effect& effect : effects) {
        const Result<std::vector<SceneCost>> costs = drawEffect(paths, effect);
        if (costs || costs.error().code == ErrorCode::unsupported) continue;
        std::fprintf(stderr, "%s: %s\n", effect.name.c_str(), costs.error().message.c_str());
        return 2;
    }
    return 0;
}

}  // namespace

int runEffects(const DriverPaths& paths, const EffectsOptions& options) {
    // Both processes run the same code: one thread, so that the count does not depend on who takes what.
    ::setenv("VERNIER_ISA", "avx2", 1);
    ::setenv("VERNIER_THREADS", "1", 1);
    Result<std::vector<Effect>> effects = makeEffects();
    if (!effects) return std::fprintf(stderr, "%s\n", effects.error().message.c_str()), 2;
    std::erase_if(*effects, [&](const Effect& effect) {
        return !options.names.empty() && !std::count(options.names.begin(), options.names.end(), effect.name);
    });
    if (options.counted) return drawAll(paths, *effects);
    std::error_code error;
    std::filesystem::remove_all(options.out, error);
    std::filesystem::create_directories(options.out, error);
    if (error) return std::fprintf(stderr, "cannot create %s\n", options.out.c_str()), 2;
    if (const int status = countInValgrind(paths, options); status != 0) {
        if (status == kCannotCount) std::fprintf(stderr, "valgrind is not there\n");
        return status;
    }
    std::printf(
        "%s; instructions of a frame of 160 x 160 on one thread with AVX2, and ratios to those without the "
        "effect\n%-18s %8s %8s %8s %8s %8s %8s  idle: in the state, not needed\n%-18s %8s %8s %8s %8s %8s "
        "%8s\n",
        machineText().c_str(), "effect", "off", "idle", "needed", "off", "idle", "needed", "", "1e6", "ratio", "ratio",
        "ms", "ms", "ms");
    nlohmann::json document;
    std::vector<EffectRow> rows;
    std::vector<double> noise;
    bool sound = true;
    for (const Effect& effect : *effects) {
        Result<std::vector<SceneCost>> costs = drawEffect(paths, effect);
        if (!costs) {
            std::printf("%-18s %s\n", effect.name.c_str(), costs.error().message.c_str());
            sound = sound && costs.error().code == ErrorCode::unsupported;  // left out, and said
            continue;
        }
        EffectRow& row = rows.emplace_back(EffectRow{&effect, std::move(*costs)});
        noise.push_back(timeAgain(paths, row));
        for (size_t i = 0; i < row.costs.size(); ++i)
            row.costs[i].instructions = dumpedInstructions(options.out, effect.scenes[i].name);
        print(row);
        document[effect.name] = report(row);
        sound = sound && row.complaint().empty() && row.costs[Effect::kOff].instructions > 0;
    }
    if (!options.json.empty()) std::ofstream(options.json) << document.dump(2) << '\n';
    if (!rows.empty()) {
        std::nth_element(noise.begin(), noise.begin() + static_cast<ptrdiff_t>(noise.size() / 2), noise.end());
        if (!options.page.empty())
            std::ofstream(options.page) << effectsPage(rows, machineText(), noise[noise.size() / 2]);
        if (!options.chart.empty()) std::ofstream(options.chart) << effectsChart(rows);
    }
    return sound ? 0 : 1;
}

}  // namespace vernier::bench
