#include "bench/speed/plot.h"

#include <algorithm>
#include <cmath>

#include "bench/svg/svg.h"

namespace vernier::bench {
namespace {

constexpr double kLeft = 64, kRight = 460, kTop = 40, kBottom = 350;

LogAxis axisOver(const Plot& plot, double PlotPoint::*member, double from, double to) {
    double low = 0, high = 0;
    for (const PlotLine& line : plot.lines)
        for (const PlotPoint& point : line.points) {
            low = low == 0 ? point.*member : std::min(low, point.*member);
            high = std::max(high, point.*member);
        }
    if (low <= 0) return {0.1, 10, from, to};
    return {low / 1.15, high * 1.15, from, to};
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
    const LogAxis x = axisOver(plot, &PlotPoint::x, kLeft, kRight), y = axisOver(plot, &PlotPoint::y, kBottom, kTop);
    std::string svg = svgStart(640, 400) + svgGrid(x, y);
    svg += svgLabel(kLeft, kTop - 20, "start", plot.title);
    svg += svgLabel(kLeft, kTop - 6, "start", plot.y);
    svg += svgLabel((kLeft + kRight) / 2, kBottom + 36, "middle", plot.x);
    for (size_t i = 0; i < plot.lines.size(); ++i) {
        const PlotLine& line = plot.lines[i];
        const char* color = kChartColors[i % kChartColors.size()];
        svg += format("<g stroke='%s' fill='none' stroke-width='2'><polyline points='", color);
        for (const PlotPoint& point : line.points) svg += format("%.1f,%.1f ", x.place(point.x), y.place(point.y));
        svg += "'/>";
        for (const PlotPoint& point : line.points)
            svg += format("<circle cx='%.1f' cy='%.1f' r='3' fill='%s'/>", x.place(point.x), y.place(point.y), color);
        const double row = kTop + 10 + 20 * static_cast<double>(i);
        svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/></g>\n", kRight + 12, kRight + 32, row, row);
        svg += svgLabel(kRight + 38, row + 4, "start", line.name);
    }
    return svg + "</svg>\n";
}

}  // namespace vernier::bench
