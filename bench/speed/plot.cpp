#include "bench/speed/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace vernier::bench {
namespace {

constexpr double kLeft = 64, kRight = 460, kTop = 40, kBottom = 350;
// Colours that keep apart for the colour-blind (Okabe and Ito, "Color Universal Design", 2008).
constexpr std::array<const char*, 6> kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};

/// printf into a string.
template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), pattern, arguments...);
    return text.data();
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return result;
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
    return format("<text x='%.1f' y='%.1f' text-anchor='%s'>", x, y, anchor) + escaped(text) + "</text>\n";
}

/// A logarithmic axis from `low` to `high`, laid out from `from` to `to`.
struct Axis {
    double low, high, from, to;

    double place(double value) const {
        return from + (to - from) * (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
    }
    /// Powers of ten inside, and their doubles and fivefolds when there would be fewer than three.
    std::vector<double> ticks() const {
        std::vector<double> few, many;
        for (int power = -6; power <= 12; ++power)
            for (const double step : {1.0, 2.0, 5.0}) {
                const double value = step * std::pow(10.0, power);
                if (value < low * 0.999 || value > high * 1.001) continue;
                many.push_back(value);
                if (step < 2) few.push_back(value);
            }
        return few.size() >= 3 ? few : many;
    }
};

Axis axisOver(const Plot& plot, double PlotPoint::*member, double from, double to) {
    double low = 0, high = 0;
    for (const PlotLine& line : plot.lines)
        for (const PlotPoint& point : line.points) {
            low = low == 0 ? point.*member : std::min(low, point.*member);
            high = std::max(high, point.*member);
        }
    if (low <= 0) return {0.1, 10, from, to};
    return {low / 1.15, high * 1.15, from, to};
}

std::string tickText(double value) {
    if (value >= 1e6) return format("%gM", value / 1e6);
    if (value >= 1e3) return format("%gk", value / 1e3);
    return format("%g", value);
}

}  // namespace

double fittedExponent(const std::vector<PlotPoint>& points) {
    double x = 0, y = 0, xx = 0, xy = 0;
    const auto n = static_cast<double>(points.size());
    for (const PlotPoint& point : points) {
        const double a = std::log(point.x), b = std::log(point.y);
        x += a, y += b, xx += a * a, xy += a * b;
    }
    const double spread = n * xx - x * x;
    return spread > 0 ? (n * xy - x * y) / spread : std::nan("");
}

std::string plotSvg(const Plot& plot) {
    const Axis x = axisOver(plot, &PlotPoint::x, kLeft, kRight), y = axisOver(plot, &PlotPoint::y, kBottom, kTop);
    std::string svg =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 640 400' width='640' height='400' "
        "font-family='sans-serif' font-size='12'>\n<rect width='640' height='400' fill='white'/>\n";
    svg += format("<g stroke='#ddd'>\n");
    for (const double tick : x.ticks())
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>\n", x.place(tick), x.place(tick), kTop, kBottom);
    for (const double tick : y.ticks())
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>\n", kLeft, kRight, y.place(tick), y.place(tick));
    svg += "</g>\n";
    for (const double tick : x.ticks()) svg += label(x.place(tick), kBottom + 16, "middle", tickText(tick));
    for (const double tick : y.ticks()) svg += label(kLeft - 6, y.place(tick) + 4, "end", tickText(tick));
    svg += label(kLeft, kTop - 20, "start", plot.title);
    svg += label(kLeft, kTop - 6, "start", plot.y);
    svg += label((kLeft + kRight) / 2, kBottom + 36, "middle", plot.x);
    for (size_t i = 0; i < plot.lines.size(); ++i) {
        const PlotLine& line = plot.lines[i];
        const char* color = kColors[i % kColors.size()];
        svg += format("<g stroke='%s' fill='none' stroke-width='2'><polyline points='", color);
        for (const PlotPoint& point : line.points) svg += format("%.1f,%.1f ", x.place(point.x), y.place(point.y));
        svg += "'/>";
        for (const PlotPoint& point : line.points)
            svg += format("<circle cx='%.1f' cy='%.1f' r='3' fill='%s'/>", x.place(point.x), y.place(point.y), color);
        const double row = kTop + 10 + 20 * static_cast<double>(i);
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/></g>\n", kRight + 12, kRight + 32, row, row);
        svg += label(kRight + 38, row + 4, "start", line.name);
    }
    return svg + "</svg>\n";
}

}  // namespace vernier::bench
