// Pieces of charts as SVG: text, colours, logarithmic axes.
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace vernier::bench {

// Colours that keep apart for the colour-blind (Okabe and Ito, "Color Universal Design", 2008).
inline constexpr std::array<const char*, 6> kChartColors{"#0072B2", "#D55E00", "#009E73",
                                                         "#CC79A7", "#E69F00", "#56B4E9"};

/// printf into a string; cut after 511 characters.
template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), pattern, arguments...);
    return text.data();
}

/// A <text> element; `anchor`: start, middle or end.
std::string svgLabel(double x, double y, const char* anchor, const std::string& text);

/// The start of a document of that size, white, in a sans-serif font.
std::string svgStart(int width, int height);

/// A logarithmic axis from `low` to `high` (both above zero), laid out from `from` to `to`.
struct LogAxis {
    double low, high, from, to;

    double place(double value) const;
    /// Powers of ten inside, and their doubles and fivefolds when there would be fewer than three.
    std::vector<double> ticks() const;
};

/// "500", "20k", "3M"
std::string tickText(double value);

/// The grid lines and numbers of two axes.
std::string svgGrid(const LogAxis& x, const LogAxis& y);

}  // namespace vernier::bench
