#include "conformance/hardcases/chart.h"

#include <array>

namespace vernier::conformance::hardcases {
namespace {

// Colours that keep apart for the colour-blind (Okabe and Ito, "Color Universal Design", 2008), by Outcome.
constexpr std::array<const char*, kOutcomeCount> kColors{"#009E73", "#0072B2", "#56B4E9",
                                                         "#cccccc", "#D55E00", "#000000"};

constexpr int kWidth = 860, kNames = 120, kRow = 20, kSquare = 3;

std::string rectangle(size_t x, size_t y, int width, int height, const char* color) {
    return "<rect x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' width='" + std::to_string(width) +
           "' height='" + std::to_string(height) + "' fill='" + color + "'/>\n";
}

std::string label(size_t x, size_t y, const char* anchor, const std::string& text) {
    return "<text x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' text-anchor='" + anchor + "'>" + text +
           "</text>\n";
}

}  // namespace

std::string tableChart(const Table& table) {
    const size_t height = 52 + table.columns.size() * kRow;
    std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='" + std::to_string(kWidth) + "' height='" +
                      std::to_string(height) +
                      "' font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n";
    svg += label(8, 18, "start", std::to_string(table.rows.size()) + " numeric hard cases, a line each, by driver:");
    size_t x = 300;
    for (size_t outcome = 0; outcome < kOutcomeCount; ++outcome, x += 94) {
        svg += rectangle(x, 9, 10, 10, kColors[outcome]);
        svg += label(x + 14, 18, "start", std::string(outcomeName(static_cast<Outcome>(outcome))));
    }
    size_t y = 32;
    for (const TableColumn& column : table.columns) {
        svg += label(kNames - 8, y + 14, "end", column.name);
        for (size_t row = 0; row < column.verdicts.size(); ++row)
            svg += rectangle(kNames + row * kSquare, y + 2, kSquare, kRow - 4,
                             kColors[static_cast<size_t>(column.verdicts[row].outcome)]);
        const auto counts = column.counts();
        const size_t wrong =
            counts[static_cast<size_t>(Outcome::wrong)] + counts[static_cast<size_t>(Outcome::crashed)];
        svg += label(kNames + column.verdicts.size() * kSquare + 8, y + 14, "start", std::to_string(wrong) + " wrong");
        y += kRow;
    }
    return svg + "</svg>\n";
}

}  // namespace vernier::conformance::hardcases
