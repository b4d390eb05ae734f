#include "bench/svg/svg.h"

#include <algorithm>
#include <cmath>

namespace vernier::bench {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return result;
}

}  // namespace

std::string svgLabel(double x, double y, const char* anchor, const std::string& text) {
    return format("<text x='%.1f' y='%.1f' text-anchor='%s'>", x, y, anchor) + escaped(text) + "</text>\n";
}

std::string svgStart(int width, int height) {
    return format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' width='%d' height='%d' "
        "font-family='sans-serif' font-size='12'>\n<rect width='%d' height='%d' fill='white'/>\n",
        width, height, width, height, width, height);
}

double LogAxis::place(double value) const {
    return from + (to - from) * (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

std::vector<double> LogAxis::ticks() const {
    std::vector<double> few, many;
    for (int power = -9; power <= 12; ++power)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double value = step * std::pow(10.0, power);
            if (value < low * 0.999 || value > high * 1.001) continue;
            many.push_back(value);
            if (step < 2) few.push_back(value);
        }
    return few.size() >= 3 ? few : many;
}

std::string tickText(double value) {
    if (value >= 1e6) return format("%gM", value / 1e6);
    if (value >= 1e3) return format("%gk", value / 1e3);
    return format("%g", value);
}

std::string svgGrid(const LogAxis& x, const LogAxis& y) {
    const double left = std::min(x.from, x.to), right = std::max(x.from, x.to);
    const double top = std::min(y.from, y.to), bottom = std::max(y.from, y.to);
    std::string svg = "<g stroke='#ddd'>\n";
    for (const double tick : x.ticks())
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>\n", x.place(tick), x.place(tick), top, bottom);
    for (const double tick : y.ticks())
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>\n", left, right, y.place(tick), y.place(tick));
    svg += "</g>\n";
    for (const double tick : x.ticks()) svg += svgLabel(x.place(tick), bottom + 16, "middle", tickText(tick));
    for (const double tick : y.ticks()) svg += svgLabel(left - 6, y.place(tick) + 4, "end", tickText(tick));
    return svg;
}

}  // namespace vernier::bench
