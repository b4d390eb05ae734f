#include "samples/viewer/legend.h"

#include <cstdarg>
#include <cstdio>

namespace samples {
namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
    char text[256];
    va_list list;
    va_start(list, pattern);
    std::vsnprintf(text, sizeof text, pattern, list);
    va_end(list);
    return text;
}

struct Words {
    std::string title, unit;  // of the bar
};

Words wordsOf(const ViewSettings& settings, const Dial& dial, const ViewReport& report) {
    switch (settings.kind()) {
        case ViewKind::kError:
            return {format("%s against reference: worst %.4g, mean %.3g, %.2f %% of the pixels differ",
                           dial.text().c_str(), report.worst, report.mean, report.differing * 100),
                    "/255"};
        case ViewKind::kDepth:
            return {"distance from the eye", " radii of the model"};
        case ViewKind::kOverdraw:
            return {format("surfaces over a pixel: at most %.4g, %.2f where there are any", report.most, report.usual),
                    " surfaces"};
        case ViewKind::kRate:
            return {format("runs of fragment programs per pixel: at most %.4g, %.2f where there are any", report.most,
                           report.usual),
                    " runs"};
        case ViewKind::kTiles:
            return {format("cost of the fragment programs by tile: at most %.0f, %.0f where there are any", report.most,
                           report.usual),
                    " thousand additions"};
        default:
            return {};
    }
}

}  // namespace

glm::vec4 legendBar(ViewKind view, VkExtent2D size, float unit) {
    const bool wanted = view != ViewKind::kShaded && view != ViewKind::kSplit && view != ViewKind::kWireframe;
    if (!wanted) return glm::vec4(0);
    const float bottom = static_cast<float>(size.height) - unit * 1.7f;
    return {unit, bottom - unit, unit + glm::min(unit * 20, static_cast<float>(size.width) - unit * 2), bottom};
}

std::vector<LegendText> legendTexts(const ViewSettings& settings, const Dial& dial, const ViewReport& report,
                                    VkExtent2D size, float unit) {
    std::vector<LegendText> texts;
    const ViewKind view = settings.kind();
    if (view == ViewKind::kSplit) {
        const float divide = static_cast<float>(settings.divide) * static_cast<float>(size.width);
        texts.push_back({{divide - unit * 0.6f, unit * 0.6f}, dial.text(), true});
        texts.push_back({{divide + unit * 0.6f, unit * 0.6f}, "reference"});
        return texts;
    }
    const glm::vec4 bar = legendBar(view, size, unit);
    if (bar.z == 0) return texts;
    const Words words = wordsOf(settings, dial, report);
    const bool isSigned = view == ViewKind::kError && settings.sign != 0;
    texts.push_back({{bar.x, bar.y - unit * 1.3f}, words.title});
    const float below = bar.w + unit * 0.2f;
    texts.push_back({{bar.x, below}, isSigned ? format("-%g", report.scale) : "0"});
    if (isSigned) texts.push_back({{(bar.x + bar.z) / 2, below}, "0"});
    texts.push_back({{bar.z, below}, format("%g%s", report.scale, words.unit.c_str()), true});
    // A number in every tile that has a cost, but those below the legend.
    for (size_t i = 0; i < report.tiles.size(); ++i) {
        const glm::vec2 place(i % report.tileColumns * 64 + 4, i / report.tileColumns * 64 + 4);
        if (report.tiles[i] >= 0.5f && place.y < bar.y - unit * 3)
            texts.push_back({place, format("%.0f", double{report.tiles[i]})});
    }
    return texts;
}

}  // namespace samples
