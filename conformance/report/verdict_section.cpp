// The part of a scene's page that says who is right where drivers disagree.
#include "conformance/report/html.h"
#include "conformance/scene/scene_format.h"

namespace vernier::conformance {
namespace {

std::string pairRow(const Report& report, const ReportComparison& comparison, const std::string& image) {
    uint64_t differing = 0, legal = 0;
    std::string causes;
    for (size_t i = 1; i < kPixelClassCount; ++i) {
        const auto pixelClass = static_cast<PixelClass>(i);
        const uint64_t count = comparison.diff.counts[i];
        if (count == 0) continue;
        differing += count;
        if (pixelClass < PixelClass::otherWrong) {
            legal += count;
            causes += (causes.empty() ? "" : ", ") + std::string(pixelClassName(pixelClass)) + " " + grouped(count);
        }
    }
    if (differing == 0) return {};
    const auto number = [&](PixelClass pixelClass) {
        const uint64_t count = comparison.diff.count(pixelClass);
        return "<td>" + (count == 0 ? std::string("&ndash;") : grouped(count)) + "</td>";
    };
    return "<tr><td>" + escapeHtml(titleOf(report, comparison.ours)) + " \u2013 " +
           escapeHtml(titleOf(report, comparison.other)) + " <small>" + escapeHtml(image) + "</small></td><td>" +
           grouped(differing) + "</td><td>" + (legal == 0 ? "&ndash;" : grouped(legal) + ": " + causes) + "</td>" +
           number(PixelClass::oursWrong) + number(PixelClass::otherWrong) + number(PixelClass::unexplained) + "</tr>";
}

}  // namespace

std::string verdictText(const ReportDriver& driver, const ReportVerdict& verdict) {
    if (verdict.wrong == 0) return driver.title + " is right everywhere.";
    if (!verdict.explanation)
        return driver.title + " has " + grouped(verdict.wrong) + " wrong pixels; no hypothesis explains them.";
    const std::string text = driver.title + ": " + describe(*verdict.explanation);
    return text + (verdict.explanation->hypotheses == declaredBy(driver.limits)
                       ? ", as it declares: legal by its own promise."
                       : ".");
}

std::string verdictSection(const Report& report, const ReportScene& scene) {
    if (scene.oracle.empty() || scene.verdicts.empty()) return {};
    std::string html = "<h2>Who is right</h2><ul class=\"plain\">";
    for (const ReportDriver& driver : report.drivers) {
        const auto found = scene.verdicts.find(driver.name);
        if (found != scene.verdicts.end()) html += "<li>" + escapeHtml(verdictText(driver, found->second)) + "</li>";
    }
    std::string rows;
    for (const ReportComparison& each : scene.comparisons) {
        if (each.other == "oracle") continue;
        rows += pairRow(report, each, scene.scene.images[scene.scene.outputs[each.output]].name);
    }
    html += "</ul>";
    if (rows.empty()) return html + "<p>All drivers agree.</p>";
    return html +
           "<table class=\"values\"><tr><th></th><th>differ</th><th>both right, and why they may differ</th><th>first "
           "wrong</th><th>second wrong</th><th>both wrong</th></tr>" +
           rows + "</table>";
}

}  // namespace vernier::conformance
