// The report of a run: what was drawn, by whom, how it compares, how long it took.
#pragma once

#include "base/result.h"
#include "conformance/arbiter/arbiter.h"
#include "conformance/differ/classify.h"
#include "conformance/differ/known_gaps.h"
#include "conformance/drivers/driver.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vernier::conformance {

struct ReportDriver {
    std::string name, title;  // "lavapipe"; how to call it in a headline
    bool ours = false;
    std::string device, version, limits;  // as the implementation names itself; empty when it never answered
    std::string absence;                  // why it was not tried; empty: it was
};

/// One driver's rendering of one scene.
struct ReportRendering {
    std::vector<RenderedImage> images;
    Timing timing;
    std::string failure;                 // why there are no images; empty: there are
    std::vector<std::string> notNeeded;  // Driver::notNeeded()
};

/// How a driver stands to the oracle in one scene.
struct ReportVerdict {
    uint64_t wrong = 0;                      // pixels of all outputs that the specification does not permit
    std::optional<Explanation> explanation;  // what it does instead
};

/// One of our renderings against another driver's, or against the oracle, in one output.
struct ReportComparison {
    std::string ours, other;  // driver names; other may be "oracle"
    size_t output = 0;
    ImageDiff diff;
};

struct ReportScene {
    Scene scene;
    std::map<std::string, ReportRendering> renderings;  // by driver name
    std::vector<OracleImage> oracle;                    // empty: none
    std::string oracleAbsence;
    double oracleSeconds = 0;
    std::optional<ReportRendering> everything;  // by Vernier's API with nothing left out; images are not kept
    std::vector<ReportComparison> comparisons;
    std::map<std::string, ReportVerdict> verdicts;  // by driver name; empty without an oracle
    bool judged = false;                            // at least one driver of ours was tried
    bool failed = false;                            // a finding that no known gap covers
};

struct Report {
    std::vector<std::pair<std::string, std::string>> facts;  // machine, date, settings: name and value
    std::vector<ReportDriver> drivers;
    std::vector<ReportScene> scenes;
    GapJudgement judgement;
    std::string hardCases;  // the page of the numeric hard cases beside the index; empty: none
};

/// Fills in ReportScene::comparisons: every driver of ours against every other one that drew the scene, and
/// every driver against the oracle. An error means images that cannot be compared.
Status compareScene(ReportScene& scene, const std::vector<ReportDriver>& drivers);

/// What of a scene's comparisons, renderings and verdicts counts as failed: other drivers' wrong pixels do when nothing
/// explains them.
std::vector<Finding> findingsOf(const ReportScene& scene, const std::vector<ReportDriver>& drivers);

/// Writes index.html, a page per scene, and report.json. All pages carry their pictures inside.
Status writeReport(const Report& report, const std::filesystem::path& directory);

}  // namespace vernier::conformance
