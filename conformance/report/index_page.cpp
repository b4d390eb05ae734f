#include "conformance/report/heat_map.h"
#include "conformance/report/html.h"

#include <algorithm>
#include <cstdlib>

namespace vernier::conformance {
namespace {

const ReportRendering* renderingOf(const ReportScene& scene, const std::string& driver) {
    const auto found = scene.renderings.find(driver);
    return found == scene.renderings.end() ? nullptr : &found->second;
}

std::string missing(const std::string& reason, bool bad) {
    // The first line is enough for a thumbnail's place.
    return "<p class=\"missing" + std::string(bad ? " bad" : "") + "\">" +
           escapeHtml(reason.substr(0, std::min<size_t>(reason.find('\n'), 160))) + "</p>";
}

std::string figure(const std::string& picture, const std::string& title, const std::string& detail) {
    return "<figure>" + picture + "<figcaption><b>" + escapeHtml(title) + "</b><br><span>" + detail +
           "</span></figcaption></figure>";
}

std::string thumbnail(const ReportScene& scene, const ReportDriver& driver, const Stretch& stretch) {
    const ReportRendering* rendering = renderingOf(scene, driver.name);
    if (rendering == nullptr) return figure(missing("absent", false), driver.title, "&nbsp;");
    if (!rendering->failure.empty()) return figure(missing(rendering->failure, true), driver.title, "&nbsp;");
    const ReportRendering* reference = renderingOf(scene, "lavapipe");
    const double referenceTime = reference != nullptr && driver.name != "lavapipe" ? reference->timing.frame : 0;
    const Timing& timing = rendering->timing;
    return figure(imageTag(pictureOf(rendering->images[0], stretch), driver.title), driver.title,
                  duration(timing.frame) + " " + ratio(timing.frame, referenceTime) + "<br>first image " +
                      duration(timing.firstImage));
}

/// The comparison whose heat map stands for the scene: the worst one of ours, or the first when none is of
/// ours.
const ReportComparison* headline(const Report& report, const ReportScene& scene) {
    const ReportComparison* chosen = nullptr;
    for (const ReportComparison& each : scene.comparisons) {
        if (chosen == nullptr || (isOurs(report, each.ours) && each.diff.worstClass > chosen->diff.worstClass)) {
            chosen = &each;
        }
    }
    return chosen;
}

std::string comparisonRows(const Report& report, const ReportScene& scene) {
    // One row per pair, its outputs summed.
    std::vector<std::pair<std::pair<std::string, std::string>, std::array<uint64_t, kPixelClassCount>>> rows;
    for (const ReportComparison& each : scene.comparisons) {
        const std::pair key(each.ours, each.other);
        auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& known) { return known.first == key; });
        if (row == rows.end()) row = rows.insert(rows.end(), {key, {}});
        for (size_t i = 0; i < kPixelClassCount; ++i) row->second[i] += each.diff.counts[i];
    }
    std::string ours, others;
    for (const auto& [pair, counts] : rows) {
        const bool judged = isOurs(report, pair.first);
        (judged ? ours : others) += "<div>" + escapeHtml(titleOf(report, pair.first)) + " \u2013 " +
                                    escapeHtml(titleOf(report, pair.second)) + "</div><div>" +
                                    classBar(counts, judged) + "</div>";
    }
    std::string html;
    if (!ours.empty()) html += "<div class=\"compare\">" + ours + "</div>";
    if (!others.empty()) {
        html += "<details" + std::string(ours.empty() ? " open" : "") +
                "><summary>the other drivers among themselves</summary><div class=\"compare\">" + others +
                "</div></details>";
    }
    return html;
}

std::string sceneRow(const Report& report, const ReportScene& scene) {
    std::string html = "<section class=\"scene" + std::string(scene.failed ? " failed" : "") +
                       "\"><div class=\"head\"><a href=\"" + scene.scene.name + ".html\">" + scene.scene.name + "</a>" +
                       verdictPill(scene) + "<p>" + escapeHtml(scene.scene.description) +
                       "</p></div><div class=\"strip\">";
    Stretch stretch;
    for (const auto& [name, rendering] : scene.renderings) {
        if (rendering.failure.empty()) stretch = stretchFor(rendering.images[0]);
    }
    for (const ReportDriver& driver : report.drivers) html += thumbnail(scene, driver, stretch);
    if (scene.oracle.empty()) {
        html += figure(missing(scene.oracleAbsence, false), "oracle", "&nbsp;");
    } else {
        html += figure(imageTag(pictureOf(scene.oracle[0], stretch), "oracle"), "oracle",
                       duration(scene.oracleSeconds * 1000));
    }
    if (const ReportComparison* worst = headline(report, scene)) {
        html +=
            figure(imageTag(heatMap(worst->diff, 1), "signed difference"), "signed difference",
                   escapeHtml(titleOf(report, worst->ours)) + " \u2212 " + escapeHtml(titleOf(report, worst->other)));
    } else {
        html += figure(missing("nothing to compare", false), "signed difference", "&nbsp;");
    }
    html += "</div>" + comparisonRows(report, scene);
    for (const ReportDriver& driver : report.drivers) {
        const auto verdict = scene.verdicts.find(driver.name);
        if (verdict == scene.verdicts.end() || verdict->second.wrong == 0) continue;
        html += "<p class=\"counts\"><span>" + escapeHtml(verdictText(driver, verdict->second)) + "</span></p>";
    }
    return html + "</section>\n";
}

std::string list(const std::vector<std::string>& lines, const char* style) {
    std::string html = std::string("<ul class=\"plain ") + style + "\">";
    for (const std::string& line : lines) html += "<li>" + escapeHtml(line) + "</li>";
    return html + "</ul>";
}

std::string tile(const std::string& number, const std::string& text, const char* style = "") {
    return std::string("<div class=\"tile ") + style + "\"><b>" + number + "</b><span>" + escapeHtml(text) +
           "</span></div>";
}

std::string tiles(const Report& report) {
    const auto count = [&](auto condition) {
        return static_cast<size_t>(std::count_if(report.scenes.begin(), report.scenes.end(), condition));
    };
    const size_t failed = count([](const ReportScene& scene) { return scene.failed; });
    const size_t explained = count([](const ReportScene& scene) { return scene.judged && !scene.failed; });
    const size_t withOracle = count([](const ReportScene& scene) { return !scene.oracle.empty(); });
    std::string html = "<div class=\"tiles\">";
    html += tile(std::to_string(report.scenes.size()), "scenes");
    html += tile(std::to_string(explained), "explained to the last pixel", explained != 0 ? "good" : "");
    html += tile(std::to_string(failed), "with unexplained pixels", failed != 0 ? "bad" : "");
    html += tile(std::to_string(withOracle), "judged by the oracle");
    html += tile(std::to_string(report.judgement.covered.size()), "known gaps in use");
    html += tile(std::to_string(report.judgement.stale.size()), "known gaps that pass now",
                 report.judgement.stale.empty() ? "" : "bad");
    return html + "</div>";
}

/// Whether the driver snaps to fewer sub-pixel bits than the 8 that the oracle calls legal.
bool isCoarser(const ReportDriver& driver) {
    constexpr std::string_view kName = "subPixelPrecisionBits ";
    const size_t at = driver.limits.find(kName);
    return at != std::string::npos && std::atoi(driver.limits.c_str() + at + kName.size()) < 8;
}

std::string driverCards(const Report& report) {
    std::string html = "<div class=\"cards\">";
    for (const ReportDriver& driver : report.drivers) {
        html += "<div class=\"card\"><h3>" + escapeHtml(driver.title) + "</h3>";
        if (!driver.absence.empty()) {
            html += "<div class=\"absent\">Skipped: " + escapeHtml(driver.absence) + ".</div>";
        } else if (driver.device.empty()) {
            html += "<div class=\"absent\">Never answered.</div>";
        } else {
            html += escapeHtml(driver.device) + "<br>" + escapeHtml(driver.version) + "<pre>" +
                    escapeHtml(driver.limits) + "</pre>";
            if (isCoarser(driver)) {
                html +=
                    "<p class=\"note\">Declares a coarser sub-pixel grid than the oracle judges by: what is "
                    "called wrong "
                    "along its edges, and in values interpolated from its corners, may be within its own "
                    "promise.</p>";
            }
        }
        html += "</div>";
    }
    return html + "</div>";
}

}  // namespace

std::string indexPage(const Report& report) {
    std::string html =
        "<main><header class=\"top\"><div class=\"marks\"></div><h1>Vernier conformance"
        "<small>one scene, every driver, every pixel accounted for</small></h1>"
        "<p>Each scene is written once and drawn by every driver below. Where two images differ, the "
        "difference is put down to a cause: rounding the format allows, an edge the sub-pixel grid leaves "
        "open, the tolerance of interpolation and filtering, or a fault of one side as judged by an exact "
        "reference. There is no percentage.</p>" +
        tiles(report) + "</header>";
    if (!report.judgement.violations.empty()) {
        html += "<h2>Unexplained</h2>" + list(report.judgement.violations, "bad");
    }
    if (!report.judgement.stale.empty()) html += "<h2>Gaps that pass now</h2>" + list(report.judgement.stale, "bad");
    if (!report.judgement.covered.empty()) html += "<h2>Known gaps</h2>" + list(report.judgement.covered, "");
    if (!report.hardCases.empty()) {
        html += "<p><a href=\"" + escapeHtml(report.hardCases) + "\">Numeric hard cases, case by driver</a></p>";
    }
    html += "<h2>Drivers</h2>" + driverCards(report) + "<h2>Settings</h2><table class=\"facts\">";
    for (const auto& [name, value] : report.facts) {
        html += "<tr><td>" + escapeHtml(name) + "</td><td>" + escapeHtml(value) + "</td></tr>";
    }
    html += "</table><h2>How to read it</h2>" + legend() + "<h2>Scenes</h2>\n";
    for (const ReportScene& scene : report.scenes) html += sceneRow(report, scene);
    return page("Vernier conformance", html + "</main>\n");
}

}  // namespace vernier::conformance
