#include "bench/accuracy/chart.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "bench/accuracy/choose.h"
#include "bench/svg/svg.h"

namespace vernier::bench {
namespace {

constexpr double kLeastError = 1e-7;  // of 1/255: below the noise of doubles in the oracle

struct Dot {
    const AccuracyPosition* position;
    double time, error;
    bool onFront;
};

std::vector<Dot> dotsOf(const AccuracyRun& run, const MeasuredScene& scene) {
    const std::vector<std::string> front = paretoFront(run, scene);
    std::vector<Dot> dots;
    for (const AccuracyPosition& position : run.positions) {
        const AccuracyFigures& figures = scene.figures.at(position.label);
        if (!figures.failure.empty()) continue;
        dots.push_back({&position, figures.frame, std::clamp(rankedError(scene, figures), kLeastError, 255.0),
                        std::find(front.begin(), front.end(), position.label) != front.end()});
    }
    return dots;
}

LogAxis around(const std::vector<Dot>& dots, double Dot::*member, double from, double to) {
    double low = 1e300, high = 0;
    for (const Dot& dot : dots) low = std::min(low, dot.*member), high = std::max(high, dot.*member);
    if (high <= 0) return {0.1, 10, from, to};
    return {low / 1.4, high * 1.4, from, to};
}

const char* colorOf(const AccuracyPosition& position) {
    return kChartColors[position.driver != "api" ? 1 : position.isProfile() ? 0 : 2];
}

std::string dotShape(const Dot& dot, double x, double y) {
    const char* const color = colorOf(*dot.position);
    if (dot.position->driver != "api")
        return format("<rect x='%.1f' y='%.1f' width='8' height='8' fill='%s'/>\n", x - 4, y - 4, color);
    return format("<circle cx='%.1f' cy='%.1f' r='4.5' stroke='%s' stroke-width='2' fill='%s'/>\n", x, y, color,
                  dot.onFront ? color : "white");
}

/// What shapes and colours stand for, in two lines.
std::string legendSvg(double left, double top) {
    constexpr std::pair<const char*, double> kKinds[] = {
        {"profiles", 0}, {"other drivers", 90}, {"standard with one axis moved", 205}};
    std::string svg;
    for (size_t kind = 0; kind < std::size(kKinds); ++kind) {
        const double x = left + kKinds[kind].second;
        if (kind == 1)
            svg += format("<rect x='%.1f' y='%.1f' width='8' height='8' fill='%s'/>\n", x - 4, top - 8,
                          kChartColors[kind]);
        else
            svg += format("<circle cx='%.1f' cy='%.1f' r='4.5' stroke='%s' stroke-width='2' fill='%s'/>\n", x, top - 4,
                          kChartColors[kind], kChartColors[kind]);
        svg += svgLabel(x + 10, top, "start", kKinds[kind].first);
    }
    return svg +
           svgLabel(left - 4, top + 18, "start",
                    "filled: on the front; error: mean of values, and all of it for a misplaced pixel; 1e-07: none");
}

/// Where labels go so that none covers another: beside their dots where there is room, else below each other, and all
/// above `bottom`. They come in the order of their dots' heights.
class LabelColumn {
  public:
    LabelColumn(double x, double top, double bottom, size_t count) : x_(x), next_(top), bottom_(bottom), left_(count) {}
    std::string add(double fromX, double fromY, const std::string& text) {
        constexpr double kStep = 15;
        const double latest = bottom_ - kStep * static_cast<double>(left_--);
        const double y = std::max(next_, std::min(fromY, latest));
        next_ = y + kStep;
        return format("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#bbb'/>", fromX + 6, fromY, x_ - 3, y) +
               svgLabel(x_, y + 4, "start", text);
    }

  private:
    double x_, next_, bottom_;
    size_t left_;
};

}  // namespace

std::string paretoSvg(const AccuracyRun& run, const MeasuredScene& scene) {
    constexpr double kLeft = 64, kRight = 440, kTop = 40, kBottom = 350;
    std::vector<Dot> dots = dotsOf(run, scene);
    const LogAxis x = around(dots, &Dot::time, kLeft, kRight), y = around(dots, &Dot::error, kBottom, kTop);
    std::string svg = svgStart(640, 440) + svgGrid(x, y);
    svg += svgLabel(kLeft, kTop - 22, "start", std::string(scene.scene->name) + ": error (1/255) over time");
    svg += svgLabel((kLeft + kRight) / 2, kBottom + 36, "middle", "milliseconds per frame");
    svg += legendSvg(kLeft, kBottom + 58);
    std::vector<Dot> front;
    std::copy_if(dots.begin(), dots.end(), std::back_inserter(front), [](const Dot& dot) { return dot.onFront; });
    std::sort(front.begin(), front.end(), [](const Dot& a, const Dot& b) { return a.time < b.time; });
    svg += format("<polyline fill='none' stroke='%s' stroke-width='1.5' points='", kChartColors[0]);
    for (const Dot& dot : front) svg += format("%.1f,%.1f ", x.place(dot.time), y.place(dot.error));
    svg += "'/>\n";
    std::sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.error > b.error; });
    LabelColumn labels(kRight + 24, kTop, kBottom + 30, dots.size());
    for (const Dot& dot : dots) {
        const double dotX = x.place(dot.time), dotY = y.place(dot.error);
        svg += labels.add(dotX, dotY, dot.position->label) + dotShape(dot, dotX, dotY);
    }
    return svg + "</svg>\n";
}

std::string axesSvg(const AccuracyRun& run, const MeasuredScene& scene) {
    constexpr double kWidth = 234, kTop = 36, kRow = 20, kBar = 60, kNames = 70;
    const AccuracyFigures& base = scene.figures.at(kBaseProfile);
    std::vector<std::string> axes;
    for (const AccuracyPosition& position : run.positions)
        if (!position.axis.empty() && std::find(axes.begin(), axes.end(), position.axis) == axes.end())
            axes.push_back(position.axis);
    if (!base.failure.empty() || axes.empty()) return svgStart(1, 1) + "</svg>\n";
    std::string svg = svgStart(static_cast<int>(kWidth * static_cast<double>(axes.size())), 170);
    for (size_t a = 0; a < axes.size(); ++a) {
        const double left = kWidth * static_cast<double>(a) + 8;
        svg += svgLabel(left, 16, "start", axes[a] + ": time, error");
        double top = kTop;
        const auto row = [&](const std::string& name, const AccuracyFigures& figures) {
            const double relative = base.frame > 0 ? figures.frame / base.frame : 1;
            svg += svgLabel(left + kNames - 6, top + 12, "end", name);
            svg += format("<rect x='%.1f' y='%.1f' width='%.1f' height='14' fill='%s'/>\n", left + kNames, top + 1,
                          std::min(relative, 2.0) / 2 * kBar, kChartColors[5]);
            svg += svgLabel(left + kNames + kBar + 4, top + 12, "start",
                            format("%.2f, %.2g", relative, rankedError(scene, figures)));
            top += kRow;
        };
        row(kBaseProfile, base);
        for (const AccuracyPosition& position : run.positions)
            if (position.axis == axes[a] && scene.figures.at(position.label).failure.empty())
                row(position.axes.substr(axes[a].size() + 1), scene.figures.at(position.label));
    }
    return svg + "</svg>\n";
}

std::string errorBarSvg(const AccuracyRun& run, const MeasuredScene& scene) {
    constexpr double kWidth = 400;
    std::string svg = svgStart(640, 62);
    svg += svgLabel(4, 14, "start", "the error of standard, by the axis that takes it away");
    const AccuracyFigures& base = scene.figures.at(kBaseProfile);
    const double total = base.failure.empty() ? rankedError(scene, base) : 0;
    if (total <= 0) return svg + svgLabel(4, 34, "start", "none") + "</svg>\n";
    double left = 4, rest = total;
    size_t color = 0;
    std::string legend;
    for (const auto& [axis, removed] : errorByAxis(run, scene)) {
        if (axis == "all") continue;
        const double part = std::clamp(removed, 0.0, rest);
        const double width = part / total * kWidth;
        svg += format("<rect x='%.1f' y='22' width='%.1f' height='16' fill='%s'/>\n", left, width,
                      kChartColors[color % kChartColors.size()]);
        legend += format("<tspan fill='%s'>", kChartColors[color++ % kChartColors.size()]) + axis +
                  format(" %.0f %%</tspan>  ", 100 * part / total);
        left += width;
        rest -= part;
    }
    svg += format("<rect x='%.1f' y='22' width='%.1f' height='16' fill='#bbb'/>\n", left, rest / total * kWidth);
    svg +=
        "<text x='4' y='54'>" + legend + format("format and what no axis changes %.0f %%</text>\n", 100 * rest / total);
    return svg + "</svg>\n";
}

}  // namespace vernier::bench
