// A plot of lines over two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

namespace vernier::bench {

struct PlotPoint {
    double x, y;  // both above zero
};

struct PlotLine {
    std::string name;
    std::vector<PlotPoint> points;  // in order of x
};

struct Plot {
    std::string title, x, y;  // y: what the vertical axis shows
    std::vector<PlotLine> lines;
};

/// The exponent e of y = c * x^e by least squares over the logarithms; NaN with fewer than two different x.
double fittedExponent(const std::vector<PlotPoint>& points);

/// A whole SVG document of 640 x 400. Lines without points appear in the legend only.
std::string plotSvg(const Plot& plot);

}  // namespace vernier::bench
