#include "bench/effects/effects_page.h"

#include <algorithm>

#include "bench/svg/svg.h"

namespace vernier::bench {
namespace {

constexpr const char* kIntroduction = R"(# Effects

What an effect of the pipeline state costs where it is not there, where it is in the state but nothing needs it, and where the
scene needs it. A scene differs from the one without the effect in nothing else. Idle must cost nothing:
`unused_effects_cost_nothing` (a slow test) fails when an idle effect takes more than 2 % more instructions, when it changes the
picture, or when the needed one does not.

This page is written by

```sh
build/release/bench/vernier-bench effects --page docs/effects.md --chart docs/pictures/effects.svg
```

)";

std::string cell(bool there, const char* pattern, double value) {
    return there ? format(pattern, value) : "";
}

}  // namespace

std::string effectsPage(std::span<const EffectRow> rows, const std::string& machine, double noise) {
    std::string page = kIntroduction + machine +
                       format(
                           "; a frame of 160 x 160 on one thread with AVX2. Instructions as Callgrind counts them, in "
                           "millions without the effect, else as ratios to that; times likewise, the best of three "
                           "rounds of medians, which differ by %.0f %% between rounds of one and the same scene.\n\n",
                           noise * 100);
    page +=
        "| Effect | Idle: in the state, not needed | instructions without, 1e6 | idle | needed | time without, ms | "
        "idle "
        "| needed |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const EffectRow& row : rows) {
        const SceneCost& off = row.costs[Effect::kOff];
        const bool needed = row.has(Effect::kNeeded);
        page += "| " + row.effect->name + " | " + row.effect->idle + " | " +
                format("%.3f | %.3f | ", static_cast<double>(off.instructions) * 1e-6, row.ratio(Effect::kIdle)) +
                cell(needed, "%.2f", row.ratio(Effect::kNeeded)) +
                format(" | %.3f | %.2f | ", off.milliseconds, row.timeRatio(Effect::kIdle)) +
                cell(needed, "%.2f", row.timeRatio(Effect::kNeeded)) + " |\n";
    }
    return page +
           "\nA ratio below 1 where an effect is needed: it leaves fewer pixels to be drawn. Where the last column of "
           "a "
           "kind is empty, the effect has no use that could be told apart.\n";
}

std::string effectsChart(std::span<const EffectRow> rows) {
    constexpr double kLeft = 130, kUnit = 110, kRow = 17, kTop = 44, kMost = 4;
    std::vector<const EffectRow*> shown;
    for (const EffectRow& row : rows)
        if (row.has(Effect::kNeeded)) shown.push_back(&row);
    const double bottom = kTop + kRow * static_cast<double>(shown.size());
    std::string svg = svgStart(640, static_cast<int>(bottom + 12));
    svg += svgLabel(8, 16, "start", "Instructions of a frame against those without the effect:");
    svg += format("<rect x='8' y='24' width='10' height='10' fill='%s'/>", kChartColors[0]) +
           svgLabel(22, 33, "start", "in the state, not needed") +
           format("<rect x='190' y='24' width='10' height='10' fill='%s'/>", kChartColors[4]) +
           svgLabel(204, 33, "start", "needed");
    for (double ratio = 1; ratio <= kMost; ++ratio)
        svg += format("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'/>\n", kLeft + ratio * kUnit, kTop,
                      kLeft + ratio * kUnit, bottom, ratio == 1 ? "#888" : "#ddd");
    double y = kTop;
    for (const EffectRow* row : shown) {
        const auto bar = [&](size_t scene, double top, const char* color) {
            svg += format("<rect x='%.1f' y='%.1f' width='%.1f' height='6' fill='%s'/>\n", kLeft, top,
                          std::min(row->ratio(scene), kMost) * kUnit, color);
        };
        svg += svgLabel(kLeft - 6, y + 11, "end", row->effect->name);
        bar(Effect::kIdle, y + 2, kChartColors[0]);
        bar(Effect::kNeeded, y + 8, kChartColors[4]);
        const double longest = std::max(row->ratio(Effect::kNeeded), row->ratio(Effect::kIdle));
        svg += svgLabel(kLeft + std::min(longest, kMost) * kUnit + 5, y + 14, "start",
                        format("%.2f", row->ratio(Effect::kNeeded)));
        y += kRow;
    }
    return svg + "</svg>\n";
}

}  // namespace vernier::bench
