#include "bench/accuracy/measure.h"

#include <dlfcn.h>
#include <vernier/vernier.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/accuracy/choose.h"
#include "bench/accuracy/removed.h"
#include "bench/speed/machine.h"
#include "conformance/drivers/try.h"
#include "conformance/tool/render_scene.h"

namespace vernier::bench {
namespace {

using namespace conformance;
using Json = nlohmann::json;

constexpr double kTimeoutSeconds = 120;

/// Tells builds of this program and of the library that draws apart: figures of one build say nothing about another.
std::string programStamp() {
    Dl_info library{};
    ::dladdr(reinterpret_cast<const void*>(&vnCreateDevice), &library);
    std::string stamp;
    for (const std::filesystem::path file : {"/proc/self/exe", library.dli_fname != nullptr ? library.dli_fname : ""}) {
        std::error_code error;
        const std::filesystem::path real = std::filesystem::canonical(file, error);
        const auto size = std::filesystem::file_size(real, error);
        const auto time = std::filesystem::last_write_time(real, error);
        stamp += std::to_string(size) + "-" + std::to_string(time.time_since_epoch().count()) + " ";
    }
    return stamp;
}

std::filesystem::path folderOf(const MeasureOptions& options, const AccuracyPosition& position) {
    std::string name = position.label;
    for (char& c : name)
        if (c == '=') c = '-';
    return options.out / "runs" / name;
}

Result<Rendering> render(const MeasureOptions& options, const AccuracyScene& scene, const AccuracyPosition& position,
                         SceneUse use) {
    DriverPaths paths = options.paths;
    paths.profile = position.profile;
    paths.axes = position.axes;
    return renderInChild(paths, position.driver, variantName(scene, use), folderOf(options, position), kTimeoutSeconds);
}

struct Oracles {
    OracleImage declared;  // as the specification allows at Vulkan's usual 8 sub-pixel bits
    OracleImage exact;     // of vertices that are not snapped
};

Result<Oracles> judge(const AccuracyScene& scene) {
    constexpr int kLowestBits = 4, kUnsnappedBits = 24;
    const Result<Scene> built = buildAccuracyScene(scene, SceneUse::judged);
    if (!built) return built.error();
    // The lowest position decides which pixels count as edges: the same ones at every position.
    Result<std::vector<OracleImage>> declared = judgeScene(*built, {kLowestBits});
    if (!declared) return declared.error();
    Result<std::vector<OracleImage>> exact = judgeScene(*built, {kUnsnappedBits});
    if (!exact) return exact.error();
    return Oracles{std::move((*declared)[0]), std::move((*exact)[0])};
}

/// Everything but time.
AccuracyFigures drawForErrors(const MeasureOptions& options, const AccuracyScene& scene,
                              const AccuracyPosition& position, const Oracles& oracles) {
    AccuracyFigures figures;
    const Result<Rendering> judged = render(options, scene, position, SceneUse::judged);
    const Result<Rendering> counted = judged ? render(options, scene, position, SceneUse::counted) : judged.error();
    if (!counted) {
        figures.failure = counted.error().message;
        return figures;
    }
    judgeImage(judged->images[0], oracles.declared, oracles.exact, figures);
    countCover(counted->images[0], scene.cover, figures);
    return figures;
}

void drawForTime(const MeasureOptions& options, const AccuracyScene& scene, const AccuracyPosition& position,
                 AccuracyFigures& figures) {
    const Result<Rendering> timed = render(options, scene, position, SceneUse::timed);
    if (timed)
        addRound(timed->timing.frame, figures);
    else
        figures.failure = timed.error().message;
}

Json loadKept(const MeasureOptions& options, const std::filesystem::path& file) {
    if (options.fresh) return Json::object();
    std::ifstream stream(file);
    Json kept = Json::parse(stream, nullptr, false);
    if (!kept.is_object() || kept.value("program", "") != programStamp()) return Json::object();
    return kept;
}

/// The figures that are there so far, in memory and in a file that is whole whenever the program is stopped.
class Keeper {
  public:
    explicit Keeper(const MeasureOptions& options) : file_(options.out / "kept.json"), kept_(loadKept(options, file_)) {
        kept_["program"] = programStamp();
    }

    /// Nothing when there are none of that position yet.
    Result<std::optional<AccuracyFigures>> find(const AccuracyScene& scene, const AccuracyPosition& position) const {
        const Json::json_pointer place("/scenes/" + std::string(scene.name) + "/" + position.label);
        if (!kept_.contains(place)) return std::optional<AccuracyFigures>();
        Result<AccuracyFigures> figures = figuresFromJson(kept_.at(place));
        if (!figures) return figures.error();
        return std::optional(std::move(figures).value());
    }

    Status keep(const AccuracyScene& scene, const AccuracyPosition& position, const AccuracyFigures& figures) {
        kept_["scenes"][scene.name][position.label] = figuresJson(figures);
        const std::string text = kept_.dump(1) + "\n";
        std::filesystem::path fresh = file_;
        fresh += ".new";
        VERNIER_TRY(writeFile(fresh, text.data(), text.size()));
        std::error_code failed;
        std::filesystem::rename(fresh, file_, failed);
        return failed ? invalidArgument("cannot write " + file_.string() + ": " + failed.message()) : Status();
    }

  private:
    std::filesystem::path file_;
    Json kept_;
};

/// Calls step(position, figures) for all positions of a scene, and shows and keeps what comes of it.
class Steps {
  public:
    Steps(const MeasureOptions& options, Keeper& keeper, size_t all) : options_(options), keeper_(keeper), all_(all) {}

    void show(const std::string& next) const {
        if (options_.progress) options_.progress(done_, all_, next);
    }

    /// `isDone`: an earlier run has taken this step; it is not taken again.
    template <class Step>
    Status take(const AccuracyScene& scene, const AccuracyPosition& position, bool isDone, AccuracyFigures& figures,
                Step step) {
        show(std::string(scene.name) + ": " + position.label);
        if (!isDone) {
            step(figures);
            VERNIER_TRY(keeper_.keep(scene, position, figures));
        }
        ++done_;
        return {};
    }

  private:
    const MeasureOptions& options_;
    Keeper& keeper_;
    size_t done_ = 0;
    const size_t all_;
};

Status measureScene(const MeasureOptions& options, const std::vector<AccuracyPosition>& positions,
                    const Oracles& oracles, const Keeper& keeper, Steps& steps, MeasuredScene& measured) {
    const AccuracyScene& scene = *measured.scene;
    for (const AccuracyPosition& position : positions) {
        const Result<std::optional<AccuracyFigures>> kept = keeper.find(scene, position);
        if (!kept) return kept.error();
        AccuracyFigures& figures = measured.figures[position.label];
        if (*kept) figures = **kept;
        VERNIER_TRY(steps.take(scene, position, kept->has_value(), figures,
                               [&](AccuracyFigures& f) { f = drawForErrors(options, scene, position, oracles); }));
        if (!figures.failure.empty()) continue;
        Result<Rendering> rendering = loadRendering(folderOf(options, position), scene.name);
        if (!rendering) return rendering.error();
        measured.images[position.label] = std::move(rendering->images[0]);
    }
    for (uint32_t round = 0; round < options.rounds; ++round)
        for (const AccuracyPosition& position : positions) {
            AccuracyFigures& figures = measured.figures[position.label];
            const bool isDone = !figures.failure.empty() || figures.rounds.size() > round;
            VERNIER_TRY(steps.take(scene, position, isDone, figures,
                                   [&](AccuracyFigures& f) { drawForTime(options, scene, position, f); }));
        }
    return {};
}

Result<std::vector<AccuracyPosition>> chosenPositions(const MeasureOptions& options) {
    const std::vector<AccuracyPosition> all = accuracyPositions(driverChoices(options.paths));
    if (options.positions.empty()) return all;
    for (const std::string& label : options.positions)
        if (std::none_of(all.begin(), all.end(), [&](const AccuracyPosition& one) { return one.label == label; }))
            return invalidArgument("there is no position '" + label + "' here");
    std::vector<AccuracyPosition> chosen;
    for (const AccuracyPosition& position : all)
        if (position.label == kBaseProfile ||
            std::find(options.positions.begin(), options.positions.end(), position.label) != options.positions.end())
            chosen.push_back(position);
    return chosen;
}

}  // namespace

Result<AccuracyRun> measureAccuracy(const MeasureOptions& options) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) return invalidArgument("cannot create " + options.out.string() + ": " + failed.message());
    AccuracyRun run;
    Result<std::vector<AccuracyPosition>> positions = chosenPositions(options);
    if (!positions) return positions.error();
    run.positions = std::move(positions).value();
    run.machine = machineText();
    Keeper keeper(options);
    Steps steps(options, keeper, options.scenes.size() * run.positions.size() * (1 + options.rounds));
    for (const AccuracyScene* scene : options.scenes) {
        steps.show(std::string(scene->name) + ": exact values");
        Result<Oracles> oracles = judge(*scene);
        if (!oracles) return oracles.error();
        MeasuredScene& measured = run.scenes.emplace_back();
        measured.scene = scene;
        VERNIER_TRY(measureScene(options, run.positions, *oracles, keeper, steps, measured));
        measured.oracle = std::move(oracles->declared);
    }
    steps.show("done");
    return run;
}

std::string runJson(const AccuracyRun& run) {
    Json json;
    json["machine"] = run.machine;
    for (const AccuracyPosition& position : run.positions)
        json["positions"].push_back({{"label", position.label},
                                     {"driver", position.driver},
                                     {"profile", position.profile},
                                     {"axes", position.axes},
                                     {"below_vulkan", position.belowVulkan}});
    for (const MeasuredScene& scene : run.scenes)
        for (const auto& [label, figures] : scene.figures)
            json["scenes"][scene.scene->name][label] = figuresJson(figures);
    for (const RemovedPosition& position : removedPositions())
        json["removed"].push_back({{"axis", position.axis},
                                   {"position", position.position},
                                   {"saved", position.saved},
                                   {"error", position.error},
                                   {"verdict", position.verdict},
                                   {"known_from", position.known}});
    for (const Standing& standing : standings(run))
        json["standings"].push_back({{"axis", standing.axis},
                                     {"position", standing.position},
                                     {"standard", standing.isStandard},
                                     {"alone", standing.alone},
                                     {"shared", standing.shared}});
    return json.dump(2) + "\n";
}

std::string runCsv(const AccuracyRun& run) {
    std::string csv =
        "scene,position,driver,frame_ms,worst_255,mean_255,outside,misplaced,holes,doubles,judged,undecided\n";
    for (const MeasuredScene& scene : run.scenes)
        for (const AccuracyPosition& position : run.positions) {
            const AccuracyFigures& f = scene.figures.at(position.label);
            if (!f.failure.empty()) continue;
            csv += std::string(scene.scene->name) + "," + position.label + "," + position.driver;
            for (const double value : {f.frame, f.worst, f.mean}) csv += "," + Json(value).dump();
            for (const uint64_t value : {f.outside, f.misplaced, f.holes, f.doubles, f.judged, f.undecided})
                csv += "," + std::to_string(value);
            csv += "\n";
        }
    return csv;
}

}  // namespace vernier::bench
