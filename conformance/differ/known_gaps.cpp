#include "conformance/differ/known_gaps.h"

#include "conformance/differ/classify.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vernier::conformance {
namespace {

bool isKind(std::string_view name) {
    if (name == kNotRendered) return true;
    for (size_t i = 0; i < kPixelClassCount; ++i) {
        const auto pixelClass = static_cast<PixelClass>(i);
        if (isFailure(pixelClass) && pixelClassName(pixelClass) == name) return true;
    }
    return false;
}

bool matches(const KnownGap& gap, const Finding& finding) {
    return gap.scene == finding.scene && gap.driver == finding.driver && gap.kind == finding.kind &&
           (gap.against.empty() || gap.against == finding.against);
}

std::string describe(const Finding& finding) {
    return finding.scene + ", " + finding.driver + (finding.against.empty() ? "" : " against " + finding.against) +
           ": " + std::to_string(finding.count) + " " + finding.kind;
}

bool contains(const std::vector<std::string>& list, const std::string& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

Result<std::vector<KnownGap>> parseKnownGaps(std::string_view json) {
    try {
        const nlohmann::json document = nlohmann::json::parse(json);
        std::vector<KnownGap> gaps;
        for (const nlohmann::json& entry : document.at("gaps")) {
            KnownGap gap;
            gap.scene = entry.at("scene").get<std::string>();
            gap.driver = entry.at("driver").get<std::string>();
            gap.against = entry.value("against", std::string());
            gap.kind = entry.at("class").get<std::string>();
            gap.maxCount = entry.at("max").get<uint64_t>();
            gap.reason = entry.at("reason").get<std::string>();
            const std::string where = "known gap " + std::to_string(gaps.size()) + " (" + gap.scene + "): ";
            if (!isKind(gap.kind)) return invalidArgument(where + "class is '" + gap.kind + "', not one that fails");
            if (gap.maxCount == 0) return invalidArgument(where + "max is 0: that is no gap");
            if (gap.reason.empty()) return invalidArgument(where + "reason is empty");
            gaps.push_back(std::move(gap));
        }
        return gaps;
    } catch (const nlohmann::json::exception& problem) {
        return invalidArgument(std::string("known gaps: ") + problem.what());
    }
}

GapJudgement judgeFindings(std::span<const Finding> findings, std::span<const KnownGap> gaps, const RunExtent& run) {
    GapJudgement judgement;
    std::vector<bool> needed(gaps.size());
    for (const Finding& finding : findings) {
        if (finding.count == 0) continue;
        bool covered = false;
        for (size_t i = 0; i < gaps.size(); ++i) {
            if (!matches(gaps[i], finding)) continue;
            needed[i] = true;  // also when it has grown beyond the gap: it does not pass
            if (finding.count > gaps[i].maxCount) continue;
            covered = true;
            judgement.covered.push_back(describe(finding) + " (known: " + gaps[i].reason + ")");
            break;
        }
        if (!covered) judgement.violations.push_back(describe(finding));
    }
    for (size_t i = 0; i < gaps.size(); ++i) {
        const KnownGap& gap = gaps[i];
        if (needed[i] || !contains(run.scenes, gap.scene) || !contains(run.drivers, gap.driver) ||
            (!gap.against.empty() && !contains(run.drivers, gap.against))) {
            continue;
        }
        judgement.stale.push_back(gap.scene + ", " + gap.driver + ": the known gap '" + gap.kind +
                                  "' passes now; take it off the list");
    }
    return judgement;
}

}  // namespace vernier::conformance
