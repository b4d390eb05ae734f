#include "bench/accuracy/page.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/chart.h"
#include "bench/accuracy/choose.h"
#include "bench/accuracy/removed.h"
#include "bench/svg/svg.h"
#include "conformance/report/html.h"
#include "conformance/report/picture.h"

namespace vernier::bench {
namespace {

using namespace conformance;

constexpr double kFirstDecade = -7, kDecades = 6;
constexpr Rgb8 kNotJudged{84, 88, 96};

/// Red above the exact value, blue below it, on a logarithmic scale that is the same everywhere: from 1e-7 to 1e-1 of
/// the full range.
Rgb8 errorColor(double codes) {
    if (codes == 0) return {14, 16, 22};
    const double decade = std::isinf(codes) ? 0 : std::log10(std::abs(codes) / 255);
    const double strength = 0.15 + 0.85 * std::clamp((decade - kFirstDecade) / kDecades, 0.0, 1.0);
    const auto scaled = [&](double full) { return static_cast<uint8_t>(std::lround(full * strength)); };
    return codes > 0 ? Rgb8{scaled(255), scaled(84), scaled(56)} : Rgb8{scaled(70), scaled(150), scaled(255)};
}

Picture errorMap(const RenderedImage& image, const OracleImage& oracle) {
    Picture picture(image.extent.width, image.extent.height);
    const std::vector<double> errors = signedErrors(image, oracle);
    std::transform(errors.begin(), errors.end(), picture.pixels.begin(), errorColor);
    for (size_t i = 0; i < errors.size(); ++i)
        if ((oracle.pixels[i].flags & kOracleOpen) != 0) picture.pixels[i] = kNotJudged;
    return picture;
}

std::string swatch(Rgb8 color) {
    return format(
        "<i style='display:inline-block;width:14px;height:14px;margin:0 3px;vertical-align:-2px;background:"
        "rgb(%d,%d,%d)'></i>",
        color.r, color.g, color.b);
}

/// The scale of errorColor(), from the least to the largest decade.
std::string mapLegend() {
    std::string above, below;
    for (double decade = kFirstDecade; decade <= kFirstDecade + kDecades; decade += 2) {
        above += swatch(errorColor(255 * std::pow(10, decade)));
        below += swatch(errorColor(-255 * std::pow(10, decade)));
    }
    return "<p>Errors by pixel, of the component that is most wrong; beside each map the worst pixel magnified. " +
           swatch(errorColor(0)) + " exact; above the exact value " + above + ", below it " + below +
           " by 1e-7, 1e-5, 1e-3 and 1e-1 of the full range, on one scale everywhere; " + swatch(kNotJudged) +
           " not judged, as the specification leaves open what is seen there.</p>\n";
}

std::string number(double value) {
    return std::isinf(value) ? "NaN" : format("%.3g", value);
}

std::string vector4(const std::array<double, 4>& values) {
    return precise(values[0]) + ", " + precise(values[1]) + ", " + precise(values[2]) + ", " + precise(values[3]);
}

std::string figuresTable(const AccuracyRun& run, const MeasuredScene& scene) {
    const AccuracyFigures& base = scene.figures.at(kBaseProfile);
    const std::vector<std::string> front = paretoFront(run, scene);
    std::string html =
        "<table class=values><tr><th>position<th>ms<th>of standard<th>mean error<th>worst error<th>outside<th>misplaced"
        "<th>holes<th>doubles<th></tr>";
    for (const AccuracyPosition& position : run.positions) {
        const AccuracyFigures& f = scene.figures.at(position.label);
        html += "<tr><td>" + escapeHtml(position.label);
        if (!f.failure.empty()) {
            html += "<td colspan=9>" + escapeHtml(f.failure) + "</tr>";
            continue;
        }
        html +=
            "<td>" + format("%.3f", f.frame) + "<td>" + (base.frame > 0 ? format("%.2f", f.frame / base.frame) : "");
        html += "<td>" + number(f.mean) + "<td>" + number(f.worst);
        for (const uint64_t count : {f.outside, f.misplaced, f.holes, f.doubles}) html += "<td>" + grouped(count);
        const bool onFront = std::find(front.begin(), front.end(), position.label) != front.end();
        html += std::string("<td>") + (onFront ? "on the front" : "") + (onFront && position.belowVulkan ? ", " : "") +
                (position.belowVulkan ? "below what Vulkan asks for" : "") + "</tr>";
    }
    return html + "</table>\n";
}

/// Error maps of the profiles and drivers, and the worst pixel of each magnified.
std::string maps(const AccuracyRun& run, const MeasuredScene& scene) {
    constexpr uint32_t kSquare = 9, kScale = 16, kWidth = 192;
    std::string html = mapLegend() + "<div class=row>";
    for (const AccuracyPosition& position : run.positions) {
        const auto image = scene.images.find(position.label);
        if (image == scene.images.end() || !position.axis.empty()) continue;
        const AccuracyFigures& f = scene.figures.at(position.label);
        const Picture map = errorMap(image->second, scene.oracle);
        // Small maps are shown enlarged by a whole number.
        const uint32_t shown = map.width * std::max(1u, kWidth / map.width);
        html += "<figure style='max-width:400px'><div style='display:flex;gap:6px;align-items:flex-start'>" +
                imageTag(map, "error of " + position.label, format("class=pixelated style='width:%upx'", shown));
        if (f.worst > 0)
            html += imageTag(magnified(map, f.worstX, f.worstY, kSquare, kScale), "its worst pixel", "class=pixelated");
        html += "</div><figcaption><b>" + escapeHtml(position.label) + "</b>: ";
        if (f.worst > 0)
            html += "worst at " + std::to_string(f.worstX) + ", " + std::to_string(f.worstY) + ": " +
                    vector4(f.worstGot) + "; exactly " + vector4(f.worstExact);
        else
            html += "every judged pixel is exact";
        html += "</figcaption></figure>";
    }
    return html + "</div>\n";
}

/// Rows: scenes; columns: profiles and drivers; cells: time ratio, worst error, holes and doubles.
std::string overview(const AccuracyRun& run) {
    std::string html = "<table class=values><tr><th>scene<th>separates";
    for (const AccuracyPosition& position : run.positions)
        if (position.axis.empty()) html += "<th>" + escapeHtml(position.label);
    html += "</tr>";
    for (const MeasuredScene& scene : run.scenes) {
        const AccuracyFigures& base = scene.figures.at(kBaseProfile);
        html += "<tr><td><a href='#" + std::string(scene.scene->name) + "'>" + scene.scene->name + "</a><td>" +
                escapeHtml(scene.scene->separates);
        for (const AccuracyPosition& position : run.positions) {
            if (!position.axis.empty()) continue;
            const AccuracyFigures& f = scene.figures.at(position.label);
            html += "<td>";
            if (!f.failure.empty())
                html += "failed";
            else
                html += format("%.2f / ", base.frame > 0 ? f.frame / base.frame : 1) + number(f.worst) + " / " +
                        grouped(f.holes) + " / " + grouped(f.doubles);
        }
        html += "</tr>";
    }
    return html + "</table>\n";
}

/// Which positions are worth having, and where.
std::string standingsTable(const AccuracyRun& run) {
    std::string html =
        "<h2>Where each position is needed</h2><p>Each axis by itself, the others as in standard; and the profiles. "
        "Alone "
        "on the front: every other position is slower or less exact there. With others: none beats it, but another one "
        "is "
        "as fast and as exact. Times are equal when they differ by less than two rounds of one position do in that "
        "scene.</p><table class=values><tr><th>axis<th>position<th>alone on the front<th>scenes<th>with others</tr>";
    for (const Standing& standing : standings(run)) {
        std::string scenes;
        for (const std::string& name : standing.alone) scenes += (scenes.empty() ? "" : ", ") + escapeHtml(name);
        html += "<tr><td>" + escapeHtml(standing.axis) + "<td>" + escapeHtml(standing.position) +
                (standing.isStandard ? " (standard)" : "") + "<td>" + std::to_string(standing.alone.size()) +
                "<td style='text-align:left'>" + scenes + "<td>" + std::to_string(standing.shared.size()) + "</tr>";
    }
    return html + "</table>\n";
}

/// What the dial does not have, with the figures that decided it.
std::string removed() {
    std::string html =
        "<h2>What the dial does not have</h2><table class=values><tr><th>axis<th>position<th>would "
        "save<th>error<th>verdict<th>known from</tr>";
    for (const RemovedPosition& position : removedPositions()) {
        html += "<tr>";
        for (const char* text :
             {position.axis, position.position, position.saved, position.error, position.verdict, position.known})
            html += "<td style='text-align:left'>" + escapeHtml(text);
        html += "</tr>";
    }
    return html + "</table>\n";
}

}  // namespace

Result<std::string> accuracyPage(const AccuracyRun& run) {
    std::string body =
        "<main><h1>What accuracy costs</h1><p>Each scene is drawn at every position of the dial, with each "
        "axis alone, and by other drivers. Errors are absolute, against the exact values, in units of "
        "1/255 of the full range; pixels whose coverage may legally differ are left out. Misplaced: "
        "pixels that show another surface than the exact geometry, which is not snapped to any grid. "
        "Holes and doubles: pixels that the mesh covers too seldom or too often. Time is the median of "
        "steady frames of the same scene drawn larger, in the fastest of several rounds; each round of each position "
        "is a process of its own.</p><p>" +
        escapeHtml(run.machine) +
        "</p>\n<h2>Scenes by positions</h2><p>time against standard / worst "
        "error / holes / doubles</p>" +
        overview(run) + standingsTable(run);
    for (const MeasuredScene& scene : run.scenes) {
        const AccuracyScene& about = *scene.scene;
        body += "<h2 id='" + std::string(about.name) + "'>" + about.name + "</h2><p>" + escapeHtml(about.description) +
                " Separates: " + escapeHtml(about.separates) +
                format(". Judged at %u x %u, timed at %u x %u; times that differ by less than %.1f %% are equal.</p>",
                       about.judged.width, about.judged.height, about.timed.width, about.timed.height,
                       100 * timeNoise(run, scene));
        body += paretoSvg(run, scene) + axesSvg(run, scene) + errorBarSvg(run, scene) + figuresTable(run, scene) +
                maps(run, scene);
    }
    return page("What accuracy costs", body + removed() + "</main>");
}

}  // namespace vernier::bench
