#include "conformance/report/not_needed.h"

#include "conformance/report/html.h"

namespace vernier::conformance {

std::string notNeededSection(const ReportScene& scene) {
    const auto api = scene.renderings.find("api");
    if (api == scene.renderings.end() || api->second.notNeeded.empty()) return {};
    std::string html = "<h2>What this scene did not need</h2><ul>";
    for (const std::string& line : api->second.notNeeded) html += "<li>" + escapeHtml(line) + "</li>";
    html += "</ul>";
    if (!scene.everything) return html;
    if (!scene.everything->failure.empty())
        return html + "<p>With nothing left out: " + escapeHtml(scene.everything->failure) + "</p>";
    const double with = api->second.timing.frame, without = scene.everything->timing.frame;
    return html + "<p>With nothing left out the pictures have the same bits, and a frame takes " + duration(without) +
           " instead of " + duration(with) + ": leaving out saves " +
           (without > with ? duration(without - with) : "nothing that can be measured") + ".</p>";
}

}  // namespace vernier::conformance
