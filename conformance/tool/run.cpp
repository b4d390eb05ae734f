#include "conformance/tool/run.h"

#include "conformance/drivers/stopwatch.h"
#include "conformance/drivers/try.h"
#include "conformance/report/report.h"
#include "conformance/scenes/scenes.h"
#include "conformance/tool/child_process.h"
#include "conformance/tool/oracle_file.h"
#include "conformance/tool/rendering.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>
#include <thread>

namespace vernier::conformance {
namespace {

/// One line that is drawn over itself on a terminal, and nothing elsewhere.
class Progress {
  public:
    explicit Progress(size_t total) : total_(total), terminal_(isatty(STDERR_FILENO) == 1) {}
    ~Progress() {
        if (terminal_) std::fprintf(stderr, "\r\033[K");
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void step(const std::string& what) {
        constexpr size_t kWidth = 30;
        if (terminal_) {
            const size_t filled = kWidth * done_ / std::max<size_t>(total_, 1);
            std::fprintf(stderr, "\r\033[K[%s%s] %zu/%zu %s", std::string(filled, '=').c_str(),
                         std::string(kWidth - filled, ' ').c_str(), done_, total_, what.c_str());
        }
        ++done_;
    }

  private:
    size_t total_, done_ = 0;
    bool terminal_;
};

std::string cpuModel() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
    }
    return "unknown";
}

std::vector<std::pair<std::string, std::string>> facts(const RunOptions& options) {
    utsname system{};
    uname(&system);
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y-%m-%d %H:%M UTC", &utc);
    return {
        {"Date", date.data()},
        {"Machine", cpuModel() + ", " + std::to_string(std::thread::hardware_concurrency()) + " CPUs"},
        {"System", std::string(system.sysname) + " " + system.release + " " + system.machine},
        {"Processes", "one per scene and driver; shader caches off"},
        {"Oracle", "exact arithmetic; for every driver, snapping to 8 sub-pixel bits is what is legal"},
        {"Start-up", "instance and device creation"},
        {"First image", "from before start-up until the pixels are in host memory"},
        {"Frame", "median of 5 to 60 runs of the recorded commands, each waited for; copies to the host not included"},
        {"Validation", options.validate ? "VK_LAYER_KHRONOS_validation on: its times count" : "off"}};
}

/// Draws one scene with one driver in a child process, which works in `folder` of the report.
ReportRendering renderInChild(const DriverChoice& choice, const std::string& scene, const RunOptions& options,
                              const std::string& folderName, ReportDriver& driver) {
    const std::filesystem::path folder = options.out / "work" / folderName;
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    std::filesystem::remove(folder / (scene + ".json"),
                            ignored);  // an old one must not stand in for a failure
    std::vector<std::string> arguments = options.commonArguments;
    arguments.insert(arguments.end(), {"render", "--driver", choice.name, "--scene", scene, "--out", folder.string()});
    if (options.validate) arguments.push_back("--validate");
    const ChildResult child = runChild(arguments, folder / (scene + ".log"), options.timeoutSeconds);
    ReportRendering rendering;
    rendering.failure = child.failure;
    if (!child.ok) return rendering;
    Result<Rendering> loaded = loadRendering(folder, scene);
    if (!loaded) {
        rendering.failure = loaded.error().message;
        return rendering;
    }
    driver.device = loaded->driver;
    driver.version = loaded->version;
    driver.limits = loaded->limits;
    rendering.images = std::move(loaded->images);
    rendering.timing = loaded->timing;
    rendering.notNeeded = std::move(loaded->notNeeded);
    return rendering;
}

/// Vernier's API once more, with nothing left out: that must change no bit.
ReportRendering renderEverything(const DriverChoice& api, const ReportScene& scene, RunOptions options) {
    const auto skips = std::find(options.commonArguments.begin(), options.commonArguments.end(), "--skips");
    if (skips != options.commonArguments.end()) *(skips + 1) = "off";
    ReportDriver driver;
    ReportRendering rendering = renderInChild(api, scene.scene.name, options, "everything", driver);
    const auto same = [](const RenderedImage& a, const RenderedImage& b) { return a.texels == b.texels; };
    const std::vector<RenderedImage>& images = scene.renderings.at(api.name).images;
    if (rendering.failure.empty() &&
        !std::equal(images.begin(), images.end(), rendering.images.begin(), rendering.images.end(), same))
        rendering.failure = "the pictures differ";
    rendering.images.clear();
    return rendering;
}

/// The oracle's images of a scene, or of what hypotheses make of it, from a child process; otherwise why there are
/// none.
Result<std::vector<OracleImage>> oracleInChild(const RunOptions& options, const std::string& scene,
                                               const Hypotheses& hypotheses) {
    const std::filesystem::path folder = options.out / "work" / "oracle";
    const std::string name = hypotheses.empty() ? scene : scene + "-" + namesOf(hypotheses);
    const std::filesystem::path file = folder / (name + ".bin");
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    std::filesystem::remove(file, ignored);
    std::vector<std::string> arguments{"oracle", "--scene", scene, "--out", file.string()};
    for (const Hypothesis* each : hypotheses)
        arguments.insert(arguments.end(), {"--hypothesis", std::string(each->name)});
    const ChildResult child = runChild(arguments, folder / (name + ".log"), options.oracleTimeoutSeconds);
    if (!child.ok) return unsupported(child.failure);
    return loadOracle(file);
}

void askOracle(const RunOptions& options, ReportScene& scene) {
    const Stopwatch watch;
    Result<std::vector<OracleImage>> images = oracleInChild(options, scene.scene.name, {});
    scene.oracleSeconds = watch.milliseconds() / 1000;
    if (!images) {
        scene.oracleAbsence = images.error().message;
    } else if (images->size() != scene.scene.outputs.size()) {
        scene.oracleAbsence = "the oracle made " + std::to_string(images->size()) + " images, not " +
                              std::to_string(scene.scene.outputs.size());
    } else {
        scene.oracle = std::move(images).value();
        scene.oracleAbsence.clear();
    }
}

/// How every driver stands to the oracle, and what is behind what is wrong. Hypotheses are computed once for a scene.
Status findVerdicts(const RunOptions& options, const std::vector<ReportDriver>& drivers, ReportScene& scene) {
    if (scene.oracle.empty()) return {};
    std::map<std::string, std::optional<std::vector<OracleImage>>> known;
    const AskOracle ask = [&](const Hypotheses& hypotheses) {
        const auto [entry, fresh] = known.try_emplace(namesOf(hypotheses));
        if (fresh) {
            Result<std::vector<OracleImage>> images = oracleInChild(options, scene.scene.name, hypotheses);
            if (images) entry->second = std::move(images).value();
        }
        return entry->second;
    };
    for (const ReportDriver& driver : drivers) {
        const auto found = scene.renderings.find(driver.name);
        if (found == scene.renderings.end()) continue;
        const auto& [name, rendering] = *found;
        if (!rendering.failure.empty() || rendering.images.size() != scene.oracle.size()) continue;
        const Result<uint64_t> wrong = wrongPixels(rendering.images, scene.oracle);
        if (!wrong) return wrong.error();
        Result<std::optional<Explanation>> why =
            explainWrong(scene.scene, rendering.images, scene.oracle, ask, declaredBy(driver.limits));
        if (!why) return why.error();
        scene.verdicts[name] = {*wrong, std::move(why).value()};
    }
    return {};
}

Result<std::vector<const SceneEntry*>> chosenScenes(const RunOptions& options) {
    std::vector<const SceneEntry*> chosen;
    for (const SceneEntry& entry : allScenes()) {
        if (options.scenes.empty()) chosen.push_back(&entry);
    }
    for (const std::string& name : options.scenes) {
        const SceneEntry* entry = findScene(name);
        if (entry == nullptr) return invalidArgument("no scene is called '" + name + "'");
        chosen.push_back(entry);
    }
    return chosen;
}

Result<std::vector<KnownGap>> loadGaps(const std::filesystem::path& path) {
    if (path.empty()) return std::vector<KnownGap>{};
    const Result<std::string> text = readFile(path);
    if (!text) return text.error();
    return parseKnownGaps(text.value());
}

bool wanted(const RunOptions& options, const std::string& driver) {
    return options.drivers.empty() ||
           std::find(options.drivers.begin(), options.drivers.end(), driver) != options.drivers.end();
}

void printVerdict(const Report& report, const std::filesystem::path& out) {
    for (const ReportDriver& driver : report.drivers) {
        if (!driver.absence.empty()) std::printf("skipped %s: %s\n", driver.name.c_str(), driver.absence.c_str());
    }
    for (const std::string& line : report.judgement.covered) std::printf("known gap: %s\n", line.c_str());
    for (const std::string& line : report.judgement.stale) std::printf("stale gap: %s\n", line.c_str());
    for (const std::string& line : report.judgement.violations) std::printf("UNEXPLAINED: %s\n", line.c_str());
    std::printf("%s: %zu scenes, report in %s\n", report.judgement.passed() ? "passed" : "FAILED", report.scenes.size(),
                (out / "index.html").c_str());
}

}  // namespace

Result<bool> runComparison(const std::vector<DriverChoice>& choices, const RunOptions& options) {
    const Result<std::vector<const SceneEntry*>> scenes = chosenScenes(options);
    if (!scenes) return scenes.error();
    const Result<std::vector<KnownGap>> gaps = loadGaps(options.knownGaps);
    if (!gaps) return gaps.error();

    Report report;
    // What vernier-hardcases --html left there.
    constexpr const char* kHardCases = "hardcases.html";
    if (std::filesystem::exists(options.out / kHardCases)) report.hardCases = kHardCases;
    report.facts = facts(options);
    RunExtent extent;
    for (const DriverChoice& choice : choices) {
        const std::string absence = !wanted(options, choice.name) ? "not asked for" : choice.absence;
        report.drivers.push_back({choice.name, choice.title, choice.ours, {}, {}, {}, absence});
        if (absence.empty()) extent.drivers.push_back(choice.name);
    }
    std::vector<Finding> findings;
    Progress progress(scenes.value().size() * (extent.drivers.size() + (options.oracle ? 1 : 0)));
    for (const SceneEntry* entry : scenes.value()) {
        Result<Scene> built = entry->build();
        if (!built) return built.error();
        ReportScene scene;
        scene.scene = std::move(built).value();
        extent.scenes.push_back(scene.scene.name);
        for (size_t i = 0; i < choices.size(); ++i) {
            if (!report.drivers[i].absence.empty()) continue;
            progress.step(choices[i].name + " " + scene.scene.name);
            ReportRendering& rendering = scene.renderings[choices[i].name];
            rendering = renderInChild(choices[i], scene.scene.name, options, choices[i].name, report.drivers[i]);
            if (choices[i].manifest.empty() && rendering.failure.empty())
                scene.everything = renderEverything(choices[i], scene, options);
        }
        scene.oracleAbsence = "not asked for";
        if (options.oracle) {
            progress.step("oracle " + scene.scene.name);
            askOracle(options, scene);
        }
        if (!scene.oracle.empty()) extent.drivers.push_back("oracle");
        VERNIER_TRY(compareScene(scene, report.drivers));
        VERNIER_TRY(findVerdicts(options, report.drivers, scene));
        const std::vector<Finding> found = findingsOf(scene, report.drivers);
        scene.judged = std::any_of(report.drivers.begin(), report.drivers.end(),
                                   [](const ReportDriver& driver) { return driver.ours && driver.absence.empty(); });
        scene.failed = !judgeFindings(found, gaps.value(), {}).violations.empty();
        findings.insert(findings.end(), found.begin(), found.end());
        report.scenes.push_back(std::move(scene));
    }
    report.judgement = judgeFindings(findings, gaps.value(), extent);
    const bool judged =
        std::any_of(report.scenes.begin(), report.scenes.end(), [](const ReportScene& scene) { return scene.judged; });
    if (!judged) report.judgement.violations.push_back("no driver of Vernier's took part: nothing was judged");
    VERNIER_TRY(writeReport(report, options.out));
    printVerdict(report, options.out);
    return report.judgement.passed();
}

}  // namespace vernier::conformance
