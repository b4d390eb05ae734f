#include "conformance/hardcases/page.h"

#include "conformance/report/html.h"

#include <algorithm>

namespace vernier::conformance::hardcases {
namespace {

/// Pixels on the page per pixel of a picture, so that small scenes can be looked at.
uint32_t scaleFor(const Picture& picture) {
    return std::max(1u, 192 / std::max({picture.width, picture.height, 1u}));
}

Picture enlarged(const Picture& picture) {
    const uint32_t scale = scaleFor(picture);
    Picture result(picture.width * scale, picture.height * scale);
    for (uint32_t y = 0; y < result.height; ++y) {
        for (uint32_t x = 0; x < result.width; ++x) result.at(x, y) = picture.at(x / scale, y / scale);
    }
    return result;
}

std::string pictures(const Table& table, size_t row, const TableColumn& column) {
    const auto found = column.pictures.find(row);
    if (found == column.pictures.end()) return {};
    // Beside it what our first driver drew.
    const auto ours = std::ranges::find_if(
        table.columns, [&](const TableColumn& each) { return each.ours && each.pictures.contains(row); });
    std::string result;
    const auto show = [&](const TableColumn& from) {
        for (const RenderedImage& image : from.pictures.at(row)) {
            result += "<figure>" + imageTag(enlarged(pictureOf(image, stretchFor(image))), from.name) + "<figcaption>" +
                      escapeHtml(from.name) + "</figcaption></figure>";
        }
    };
    show(column);
    if (ours != table.columns.end() && &*ours != &column) show(*ours);
    return result;
}

std::string witnesses(const Table& table) {
    std::string result;
    for (size_t row = 0; row < table.rows.size(); ++row) {
        for (const TableColumn& column : table.columns) {
            const Verdict& verdict = column.verdicts[row];
            if (verdict.outcome != Outcome::wrong && verdict.outcome != Outcome::crashed) continue;
            const HardCase& hardCase = *table.rows[row];
            result += "<section id=\"" + std::string(hardCase.id) + "-" + escapeHtml(column.driver) + "\"><h3>" +
                      std::string(hardCase.id) + ", " + escapeHtml(column.name) + ": " +
                      std::string(outcomeName(verdict.outcome)) + "</h3><p>" + escapeHtml(hardCase.title) + ". " +
                      escapeHtml(hardCase.rule) + "</p><p><b>" + escapeHtml(verdict.witness) + "</b></p>" +
                      pictures(table, row, column) + "</section>";
        }
    }
    return result;
}

std::string cell(const TableColumn& column, size_t row, const HardCase& hardCase) {
    const Verdict& verdict = column.verdicts[row];
    const std::string name(outcomeName(verdict.outcome));
    const bool bad = verdict.outcome == Outcome::wrong || verdict.outcome == Outcome::crashed;
    if (!bad) return "<td title=\"" + escapeHtml(verdict.witness) + "\">" + name + "</td>";
    return "<td><a href=\"#" + std::string(hardCase.id) + "-" + escapeHtml(column.driver) + "\"><b>" + name +
           "</b></a></td>";
}

}  // namespace

std::string tablePage(const Table& table) {
    std::string body =
        "<main><header><h1>Numeric hard cases</h1><p>Every case is a few small scenes, drawn by each driver in a "
        "process of its "
        "own and judged by exact arithmetic, never by another driver's picture.</p></header><ul>";
    for (size_t i = 0; i < kOutcomeCount; ++i) {
        body += "<li>" + escapeHtml(outcomeText(static_cast<Outcome>(i))) + "</li>";
    }
    body += "</ul><table><tr><th>Driver</th>";
    for (size_t i = 0; i < kOutcomeCount; ++i)
        body += "<th>" + std::string(outcomeName(static_cast<Outcome>(i))) + "</th>";
    body += "<th>What it is</th></tr>";
    for (const TableColumn& column : table.columns) {
        body += "<tr><td>" + escapeHtml(column.name) + "</td>";
        for (const size_t count : column.counts()) body += "<td>" + std::to_string(count) + "</td>";
        body += "<td>" + escapeHtml(column.device) + "</td></tr>";
    }
    body += "</table><h2>Case by driver</h2><table><tr><th>Case</th><th>Input</th>";
    for (const TableColumn& column : table.columns) body += "<th>" + escapeHtml(column.name) + "</th>";
    body += "</tr>";
    for (size_t row = 0; row < table.rows.size(); ++row) {
        const HardCase& hardCase = *table.rows[row];
        body += "<tr><td>" + std::string(hardCase.id) + "</td><td title=\"" + escapeHtml(hardCase.rule) + " (" +
                escapeHtml(hardCase.source) + ")\">" + escapeHtml(hardCase.title) + "</td>";
        for (const TableColumn& column : table.columns) body += cell(column, row, hardCase);
        body += "</tr>";
    }
    body += "</table><h2>What is wrong, with witnesses</h2>" + witnesses(table) + "<h2>Not run</h2><table>";
    for (const HardCase* hardCase : table.unreachable) {
        body += "<tr><td>" + std::string(hardCase->id) + "</td><td>" + escapeHtml(hardCase->title) + "</td><td>" +
                escapeHtml(hardCase->unreachable) + "</td></tr>";
    }
    return page("Numeric hard cases", body + "</table></main>");
}

}  // namespace vernier::conformance::hardcases
