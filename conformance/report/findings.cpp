#include "conformance/report/report.h"

#include <algorithm>

namespace vernier::conformance {
namespace {

const ReportRendering* drawn(const ReportScene& scene, const ReportDriver& driver) {
    const auto found = scene.renderings.find(driver.name);
    return found != scene.renderings.end() && found->second.failure.empty() ? &found->second : nullptr;
}

}  // namespace

Status compareScene(ReportScene& scene, const std::vector<ReportDriver>& drivers) {
    const auto add = [&](const ReportDriver& ours, const std::string& other, size_t output,
                         Result<ImageDiff> diff) -> Status {
        if (!diff) {
            return invalidArgument(scene.scene.name + ", " + ours.name + " against " + other + ": " +
                                   diff.error().message);
        }
        scene.comparisons.push_back({ours.name, other, output, std::move(diff).value()});
        return {};
    };
    const size_t outputs = scene.scene.outputs.size();
    for (size_t i = 0; i < drivers.size(); ++i) {
        const ReportRendering* left = drawn(scene, drivers[i]);
        if (left == nullptr) continue;
        if (left->images.size() != outputs) {
            return invalidArgument(scene.scene.name + ", " + drivers[i].name + ": " +
                                   std::to_string(left->images.size()) + " images, not " + std::to_string(outputs));
        }
        for (size_t output = 0; output < outputs && !scene.oracle.empty(); ++output) {
            Status status =
                add(drivers[i], "oracle", output, compareWithOracle(left->images[output], scene.oracle[output]));
            if (!status) return status;
        }
        for (size_t j = i + 1; j < drivers.size(); ++j) {
            const ReportRendering* right = drawn(scene, drivers[j]);
            if (right == nullptr || right->images.size() != outputs) continue;
            for (size_t output = 0; output < outputs; ++output) {
                const OracleImage* oracle = scene.oracle.empty() ? nullptr : &scene.oracle[output];
                Status status = add(drivers[i], drivers[j].name, output,
                                    compareImages(left->images[output], right->images[output], oracle));
                if (!status) return status;
            }
        }
    }
    return {};
}

std::vector<Finding> findingsOf(const ReportScene& scene, const std::vector<ReportDriver>& drivers) {
    const auto ours = [&](const std::string& name) {
        return std::any_of(drivers.begin(), drivers.end(),
                           [&](const ReportDriver& driver) { return driver.ours && driver.name == name; });
    };
    std::vector<Finding> findings;
    for (const auto& [name, rendering] : scene.renderings) {
        if (!rendering.failure.empty() && ours(name)) {
            findings.push_back({scene.scene.name, name, {}, std::string(kNotRendered), 1});
        }
    }
    if (scene.everything && !scene.everything->failure.empty())
        findings.push_back({scene.scene.name, "api", "everything", std::string(kLeavingOutChangesBits), 1});
    // What another driver does wrong must have a cause. What ours do wrong is a finding as it is, below.
    for (const auto& [name, verdict] : scene.verdicts) {
        const uint64_t explained = verdict.explanation && verdict.explanation->convinces() ? verdict.wrong : 0;
        if (ours(name) || verdict.wrong == explained) continue;
        const uint64_t left = verdict.explanation ? verdict.wrong - verdict.explanation->explained : verdict.wrong;
        findings.push_back({scene.scene.name, name, "oracle", std::string(pixelClassName(PixelClass::unexplained)),
                            std::max<uint64_t>(left, 1)});
    }
    for (const ReportComparison& comparison : scene.comparisons) {
        if (!ours(comparison.ours)) continue;  // how others stand to each other is shown, not judged
        for (size_t i = 0; i < kPixelClassCount; ++i) {
            const auto pixelClass = static_cast<PixelClass>(i);
            if (!isFailure(pixelClass) || comparison.diff.counts[i] == 0) continue;
            const auto known = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
                return finding.driver == comparison.ours && finding.against == comparison.other &&
                       finding.kind == pixelClassName(pixelClass);
            });
            if (known != findings.end()) {
                known->count += comparison.diff.counts[i];  // several outputs of a scene count together
            } else {
                findings.push_back({scene.scene.name, comparison.ours, comparison.other,
                                    std::string(pixelClassName(pixelClass)), comparison.diff.counts[i]});
            }
        }
    }
    return findings;
}

}  // namespace vernier::conformance
