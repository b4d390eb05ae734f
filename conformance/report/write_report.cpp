#include "conformance/report/html.h"
#include "conformance/scene/scene_format.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <system_error>

namespace vernier::conformance {
namespace {

Status store(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) return invalidArgument("cannot write " + path.string());
    return {};
}

nlohmann::json comparisonJson(const ReportComparison& comparison) {
    nlohmann::json counts = nlohmann::json::object();
    for (size_t i = 0; i < kPixelClassCount; ++i) {
        counts[std::string(pixelClassName(static_cast<PixelClass>(i)))] = comparison.diff.counts[i];
    }
    const ImageDiff& diff = comparison.diff;
    return {{"ours", comparison.ours},
            {"other", comparison.other},
            {"output", comparison.output},
            {"oracle", diff.hasOracle},
            {"counts", counts},
            {"nanPixels", diff.nanPixels},
            {"unknownPixels", diff.unknownPixels},
            {"worstErrorCodes", diff.worstError},
            {"worstPixel", {{"x", diff.worstX}, {"y", diff.worstY}, {"class", pixelClassName(diff.worstClass)}}}};
}

}  // namespace

std::string reportJson(const Report& report) {
    nlohmann::json document;
    for (const auto& [name, value] : report.facts) document["facts"][name] = value;
    for (const ReportDriver& driver : report.drivers) {
        document["drivers"].push_back({{"name", driver.name},
                                       {"title", driver.title},
                                       {"ours", driver.ours},
                                       {"device", driver.device},
                                       {"version", driver.version},
                                       {"limits", driver.limits},
                                       {"absence", driver.absence}});
    }
    for (const ReportScene& scene : report.scenes) {
        nlohmann::json entry = {{"name", scene.scene.name},
                                {"failed", scene.failed},
                                {"oracle", scene.oracle.empty() ? scene.oracleAbsence : "present"},
                                {"oracleSeconds", scene.oracleSeconds}};
        for (const auto& [name, rendering] : scene.renderings) {
            const Timing& timing = rendering.timing;
            entry["renderings"][name] = {{"failure", rendering.failure},    {"startUpMs", timing.startUp},
                                         {"pipelinesMs", timing.pipelines}, {"firstImageMs", timing.firstImage},
                                         {"frameMs", timing.frame},         {"frames", timing.frames}};
        }
        entry["comparisons"] = nlohmann::json::array();
        for (const auto& [driver, verdict] : scene.verdicts) {
            entry["verdicts"][driver] = {{"wrong", verdict.wrong}};
            if (!verdict.explanation) continue;
            const Explanation& why = *verdict.explanation;
            entry["verdicts"][driver]["explanation"] = {{"hypothesis", namesOf(why.hypotheses)},
                                                        {"explained", why.explained},
                                                        {"broken", why.broken},
                                                        {"text", describe(why)}};
        }
        for (const ReportComparison& each : scene.comparisons) entry["comparisons"].push_back(comparisonJson(each));
        document["scenes"].push_back(std::move(entry));
    }
    document["passed"] = report.judgement.passed();
    document["violations"] = report.judgement.violations;
    document["staleGaps"] = report.judgement.stale;
    document["knownGaps"] = report.judgement.covered;
    // Messages of drivers may hold anything.
    return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Status writeReport(const Report& report, const std::filesystem::path& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) return invalidArgument("cannot create " + directory.string() + ": " + error.message());
    for (const ReportScene& scene : report.scenes) {
        Status status = store(directory / (scene.scene.name + ".html"), scenePage(report, scene));
        if (!status) return status;
    }
    if (Status status = store(directory / "report.json", reportJson(report)); !status) return status;
    return store(directory / "index.html", indexPage(report));
}

}  // namespace vernier::conformance
