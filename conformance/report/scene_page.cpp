#include "conformance/report/heat_map.h"
#include "conformance/report/html.h"
#include "conformance/report/not_needed.h"
#include "conformance/scene/scene_format.h"

#include <algorithm>

namespace vernier::conformance {
namespace {

/// Pictures of one output that the reader flips through in place.
class Viewer {
  public:
    void add(const Picture& picture, const std::string& title) {
        buttons_ += "<button>" + escapeHtml(title) + "</button>";
        // Twice the size, so that single pixels can be seen.
        images_ += imageTag(picture, title, "style=\"width:" + std::to_string(picture.width * 2) + "px\"");
    }
    std::string html() const {
        return "<div class=\"viewer\"><div class=\"buttons\">" + buttons_ + "</div>" + images_ + "</div>";
    }

  private:
    std::string buttons_, images_;
};

std::string outputViewers(const Report& report, const ReportScene& scene) {
    std::string html;
    for (size_t output = 0; output < scene.scene.outputs.size(); ++output) {
        const SceneImage& image = scene.scene.images[scene.scene.outputs[output]];
        const SceneFormat* format = sceneFormat(image.format);
        html += "<h2>Output " + std::to_string(output + 1) + ": " + escapeHtml(image.name) + " <small>" +
                std::string(format != nullptr ? format->name : "") + ", " + std::to_string(image.extent.width) +
                " \u00d7 " + std::to_string(image.extent.height) + "</small></h2>";
        Stretch stretch;
        for (const auto& [name, rendering] : scene.renderings) {
            if (rendering.failure.empty()) stretch = stretchFor(rendering.images[output]);
        }
        Viewer pictures;
        bool any = false;
        for (const ReportDriver& driver : report.drivers) {
            const auto found = scene.renderings.find(driver.name);
            if (found == scene.renderings.end() || !found->second.failure.empty()) continue;
            pictures.add(pictureOf(found->second.images[output], stretch), driver.title);
            any = true;
        }
        if (!scene.oracle.empty()) pictures.add(pictureOf(scene.oracle[output], stretch), "oracle");
        if (any || !scene.oracle.empty()) html += pictures.html();
        Viewer differences;
        any = false;
        for (const ReportComparison& each : scene.comparisons) {
            if (each.output != output) continue;
            differences.add(heatMap(each.diff), titleOf(report, each.ours) + " \u2212 " + titleOf(report, each.other));
            any = true;
        }
        if (any) html += differences.html();
        if (stretch.active) {
            html += "<p class=\"counts\"><span>Shown from " + precise(stretch.low) + " (black) to " +
                    precise(stretch.high) + " (white).</span></p>";
        }
    }
    return html;
}

std::string componentRow(const SceneFormat& format, const std::string& title, const RenderedImage& image,
                         size_t pixel) {
    std::string html = "<tr><td>" + escapeHtml(title) + "</td>";
    const auto texel = std::span(image.texels).subspan(pixel * format.texelBytes, format.texelBytes);
    for (size_t i = 0; i < format.componentCount; ++i) {
        const uint32_t code = componentCode(format.components[i], texel);
        html += "<td>" + precise(decodeComponent(format.components[i], code)) + "</td><td>" + std::to_string(code) +
                "</td>";
    }
    return html + "</tr>";
}

std::string valueTable(const Report& report, const ReportScene& scene, const ReportComparison& comparison) {
    const RenderedImage& ours = scene.renderings.at(comparison.ours).images[comparison.output];
    const SceneFormat& format = *sceneFormat(ours.format);
    const ImageDiff& diff = comparison.diff;
    const size_t pixel = size_t{diff.worstY} * diff.extent.width + diff.worstX;
    constexpr std::array kNames{"R", "G", "B", "A"};
    const bool color = format.aspects == VK_IMAGE_ASPECT_COLOR_BIT;
    std::string html = "<table class=\"values\"><tr><th></th>";
    for (size_t i = 0; i < format.componentCount; ++i) {
        html += std::string("<th>") + (color ? kNames[i] : "depth") + "</th><th>code</th>";
    }
    html += "</tr>" + componentRow(format, titleOf(report, comparison.ours), ours, pixel);
    if (comparison.other != "oracle") {
        html += componentRow(format, titleOf(report, comparison.other),
                             scene.renderings.at(comparison.other).images[comparison.output], pixel);
    }
    if (!scene.oracle.empty()) {
        const OraclePixel& judge = scene.oracle[comparison.output].pixels[pixel];
        const auto row = [&](const char* title, const std::array<double, 4>& values) {
            html += std::string("<tr><td>") + title + "</td>";
            for (size_t i = 0; i < format.componentCount; ++i) html += "<td>" + precise(values[i]) + "</td><td></td>";
            html += "</tr>";
        };
        row("oracle", judge.value);
        row("permitted from", judge.low);
        row("permitted to", judge.high);
    }
    html += "<tr><td>worst in the image, codes</td>";
    for (size_t i = 0; i < format.componentCount; ++i) {
        html += "<td></td><td>" + std::to_string(diff.worstError[i]) + "</td>";
    }
    return html + "</tr></table>";
}

std::string comparisonSection(const Report& report, const ReportScene& scene, const ReportComparison& comparison) {
    const ImageDiff& diff = comparison.diff;
    const SceneImage& image = scene.scene.images[scene.scene.outputs[comparison.output]];
    std::string html = "<h2>" + escapeHtml(titleOf(report, comparison.ours)) + " \u2013 " +
                       escapeHtml(titleOf(report, comparison.other)) + " <small>" + escapeHtml(image.name) +
                       "</small></h2>" + classBar(diff.counts, isOurs(report, comparison.ours));
    if (!diff.hasOracle)
        html += "<p class=\"counts\"><span>No oracle: anything beyond one code is unexplained.</span></p>";
    if (diff.nanPixels != 0) html += "<p>" + grouped(diff.nanPixels) + " pixels where only one side is NaN.</p>";
    if (diff.unknownPixels != 0)
        html += "<p>" + grouped(diff.unknownPixels) + " pixels the oracle could not decide.</p>";
    if (diff.worstClass == PixelClass::equal) return html;
    constexpr uint32_t kSize = 17, kScale = 12;
    const RenderedImage& ours = scene.renderings.at(comparison.ours).images[comparison.output];
    const Stretch stretch = stretchFor(ours);
    const auto crop = [&](const Picture& picture, const std::string& title) {
        html += "<figure>" +
                imageTag(magnified(picture, diff.worstX, diff.worstY, kSize, kScale), title, "class=\"pixelated\"") +
                "<figcaption><b>" + escapeHtml(title) + "</b></figcaption></figure>";
    };
    html += "<p>Worst pixel: <b>(" + std::to_string(diff.worstX) + ", " + std::to_string(diff.worstY) + ")</b>, " +
            std::string(pixelClassName(diff.worstClass)) + ": " + escapeHtml(pixelClassText(diff.worstClass)) +
            ".</p><div class=\"row\">";
    crop(pictureOf(ours, stretch), titleOf(report, comparison.ours));
    if (comparison.other != "oracle") {
        crop(pictureOf(scene.renderings.at(comparison.other).images[comparison.output], stretch),
             titleOf(report, comparison.other));
    }
    if (!scene.oracle.empty()) crop(pictureOf(scene.oracle[comparison.output], stretch), "oracle");
    crop(classMap(diff), "classes");
    crop(heatMap(diff), "signed difference");
    return html + "</div>" + valueTable(report, scene, comparison);
}

std::string times(const Report& report, const ReportScene& scene) {
    const auto reference = scene.renderings.find("lavapipe");
    const Timing base = reference != scene.renderings.end() ? reference->second.timing : Timing{};
    std::string html =
        "<h2>Times</h2><table class=\"times\"><tr><th></th><th>start-up</th><th>pipelines</th>"
        "<th>first image</th><th>to lavapipe</th><th>frame (median)</th><th>to "
        "lavapipe</th><th>frames</th></tr>";
    for (const ReportDriver& driver : report.drivers) {
        const auto found = scene.renderings.find(driver.name);
        if (found == scene.renderings.end()) continue;
        html += "<tr><td>" + escapeHtml(driver.title) + "</td>";
        if (!found->second.failure.empty()) {
            html += "<td colspan=\"7\">" + escapeHtml(found->second.failure) + "</td></tr>";
            continue;
        }
        const Timing& timing = found->second.timing;
        html += "<td>" + duration(timing.startUp) + "</td><td>" + duration(timing.pipelines) + "</td><td>" +
                duration(timing.firstImage) + "</td><td>" + ratio(timing.firstImage, base.firstImage) + "</td><td>" +
                duration(timing.frame) + "</td><td>" + ratio(timing.frame, base.frame) + "</td><td>" +
                std::to_string(timing.frames) + "</td></tr>";
    }
    return html + "</table>";
}

std::string shaders(const Scene& scene) {
    std::string html = "<h2>Shaders</h2>";
    for (size_t i = 0; i < scene.shaders.size(); ++i) {
        const SceneShader& shader = scene.shaders[i];
        const bool vertex = shader.stage == VK_SHADER_STAGE_VERTEX_BIT;
        html += "<details" + std::string(vertex ? "" : " open") + "><summary>shader " + std::to_string(i) + ", " +
                (vertex ? "vertex" : "fragment") + ", " + std::to_string(shader.spirv.size()) +
                " words of SPIR-V</summary><pre>" + escapeHtml(shader.glsl) + "</pre></details>";
    }
    return html;
}

}  // namespace

std::string scenePage(const Report& report, const ReportScene& scene) {
    std::string html = "<main><header class=\"top\"><p><a href=\"index.html\">Vernier conformance</a></p><h1>" +
                       scene.scene.name + "<small>" + verdictPill(scene) + "</small></h1><p>" +
                       escapeHtml(scene.scene.description) + "</p></header>";
    html += outputViewers(report, scene) + verdictSection(report, scene);
    for (const ReportComparison& comparison : scene.comparisons) html += comparisonSection(report, scene, comparison);
    html += times(report, scene);
    html += notNeededSection(scene);
    if (scene.oracle.empty()) html += "<p>Oracle: " + escapeHtml(scene.oracleAbsence) + ".</p>";
    html += "<h2>How to read it</h2>" + legend() + shaders(scene.scene);
    return page(scene.scene.name + " \u2013 Vernier conformance", html + "</main>\n");
}

}  // namespace vernier::conformance
