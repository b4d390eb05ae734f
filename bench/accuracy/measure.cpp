#include "bench/accuracy/measure.h"

#include <dlfcn.h>
#include <vernier/vernier.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

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

Result<AccuracyFigures> measure(const MeasureOptions& options, const AccuracyScene& scene,
                                const AccuracyPosition& position, const Oracles& oracles) {
    AccuracyFigures figures;
    const Result<Rendering> judged = render(options, scene, position, SceneUse::judged);
    const Result<Rendering> counted = judged ? render(options, scene, position, SceneUse::counted) : judged.error();
    const Result<Rendering> timed = counted ? render(options, scene, position, SceneUse::timed) : counted.error();
    if (!timed) {
        figures.failure = timed.error().message;
        return figures;
    }
    judgeImage(judged->images[0], oracles.declared, oracles.exact, figures);
    countCover(counted->images[0], scene.cover, figures);
    figures.frame = timed->timing.frame;
    return figures;
}

Json loadKept(const MeasureOptions& options, const std::filesystem::path& file) {
    if (options.fresh) return Json::object();
    std::ifstream stream(file);
    Json kept = Json::parse(stream, nullptr, false);
    if (!kept.is_object() || kept.value("program", "") != programStamp()) return Json::object();
    return kept;
}

}  // namespace

Result<AccuracyRun> measureAccuracy(const MeasureOptions& options) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) return invalidArgument("cannot create " + options.out.string() + ": " + failed.message());
    AccuracyRun run;
    run.positions = accuracyPositions(driverChoices(options.paths));
    run.machine = machineText();
    const std::filesystem::path file = options.out / "kept.json";
    Json kept = loadKept(options, file);
    kept["program"] = programStamp();
    size_t done = 0;
    const size_t all = options.scenes.size() * run.positions.size();
    for (const AccuracyScene* scene : options.scenes) {
        if (options.progress) options.progress(done, all, std::string(scene->name) + ": exact values");
        Result<Oracles> oracles = judge(*scene);
        if (!oracles) return oracles.error();
        MeasuredScene& measured = run.scenes.emplace_back();
        measured.scene = scene;
        for (const AccuracyPosition& position : run.positions) {
            if (options.progress) options.progress(done, all, std::string(scene->name) + ": " + position.label);
            Json& entry = kept["scenes"][scene->name][position.label];
            Result<AccuracyFigures> figures =
                entry.is_null() ? measure(options, *scene, position, *oracles) : figuresFromJson(entry);
            if (!figures) return figures.error();
            entry = figuresJson(*figures);
            std::ofstream(file) << kept.dump(1) << '\n';
            if (figures->failure.empty()) {
                Result<Rendering> rendering = loadRendering(folderOf(options, position), scene->name);
                if (!rendering) return rendering.error();
                measured.images[position.label] = std::move(rendering->images[0]);
            }
            measured.figures[position.label] = std::move(figures).value();
            ++done;
        }
        measured.oracle = std::move(oracles->declared);
    }
    if (options.progress) options.progress(done, all, "done");
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
                                   {"verdict", position.verdict}});
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
