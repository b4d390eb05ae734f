#include "conformance/report/html.h"

#include "conformance/report/heat_map.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

namespace vernier::conformance {
namespace {

std::string base64(std::string_view data) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((data.size() + 2) / 3 * 4);
    for (size_t at = 0; at < data.size(); at += 3) {
        uint32_t group = 0;
        for (size_t i = 0; i < 3; ++i) {
            group = group << 8 | (at + i < data.size() ? static_cast<unsigned char>(data[at + i]) : 0u);
        }
        for (size_t i = 0; i < 4; ++i) {
            text += at + i <= data.size() ? kDigits[group >> (18 - 6 * i) & 63] : '=';
        }
    }
    return text;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

std::string shownName(PixelClass pixelClass, bool ours) {
    if (!ours && pixelClass == PixelClass::oursWrong) return "first wrong";
    if (!ours && pixelClass == PixelClass::otherWrong) return "second wrong";
    return std::string(pixelClassName(pixelClass));
}

std::string cssColor(Rgb8 color) {
    return format("#%02x%02x%02x", color.r, color.g, color.b);
}

}  // namespace

std::string escapeHtml(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
                break;
        }
    }
    return result;
}

std::string imageTag(const Picture& picture, std::string_view alternative, std::string_view attributes) {
    const Result<std::string> png = encodePng(picture);
    if (!png) return "<p class=\"missing\">" + escapeHtml(png.error().message) + "</p>";
    return "<img width=\"" + std::to_string(picture.width) + "\" height=\"" + std::to_string(picture.height) +
           "\" alt=\"" + escapeHtml(alternative) + "\" title=\"" + escapeHtml(alternative) + "\" " +
           std::string(attributes) + " src=\"data:image/png;base64," + base64(png.value()) + "\">";
}

std::string grouped(uint64_t number) {
    std::string text = std::to_string(number);
    for (size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, "\u2009");
    return text;
}

std::string duration(double milliseconds) {
    if (milliseconds >= 1000) return format("%.2f s", milliseconds / 1000);
    if (milliseconds >= 100) return format("%.0f ms", milliseconds);
    if (milliseconds >= 10) return format("%.1f ms", milliseconds);
    return format(milliseconds >= 1 ? "%.2f ms" : "%.3f ms", milliseconds);
}

std::string ratio(double time, double reference) {
    if (!(time > 0) || !(reference > 0)) return {};
    return format("\u00d7\u2009%.2f", time / reference);
}

std::string precise(double value) {
    return format("%.9g", value);
}

std::string page(std::string_view title, std::string_view body) {
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>";
    html += escapeHtml(title);
    html += "</title>\n<style>";
    html += kReportStyle;
    html += "</style>\n</head>\n<body>\n";
    html += body;
    html += "<script>";
    html += kReportScript;
    html += "</script>\n</body>\n</html>\n";
    return html;
}

std::string classBar(const std::array<uint64_t, kPixelClassCount>& counts, bool ours) {
    const uint64_t total = std::accumulate(counts.begin(), counts.end(), uint64_t{0});
    if (total == 0) return {};
    std::string bar = "<div class=\"bar\">", words;
    for (size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        const auto pixelClass = static_cast<PixelClass>(i);
        const std::string name = shownName(pixelClass, ours);
        // A class of one pixel must be seen too.
        const double share = 100.0 * static_cast<double>(counts[i]) / static_cast<double>(total);
        bar += "<i style=\"flex:" + format("%.4f", share) + " 0 auto;background:" + cssColor(classColor(pixelClass)) +
               "\" title=\"" + name + ": " + grouped(counts[i]) + "\"></i>";
        words += "<span class=\"" + std::string(ours && isFailure(pixelClass) ? "bad" : "fine") + "\">" + name +
                 "\u00a0<b>" + grouped(counts[i]) + "</b></span> ";
    }
    return bar + "</div><div class=\"counts\">" + words + "</div>";
}

std::string legend() {
    std::string html = "<div class=\"legend\"><div><h3>Why pixels agree or differ</h3><ul class=\"swatches\">";
    for (size_t i = 0; i < kPixelClassCount; ++i) {
        const auto pixelClass = static_cast<PixelClass>(i);
        html += "<li><i style=\"background:" + cssColor(classColor(pixelClass)) + "\"></i><b>" +
                std::string(pixelClassName(pixelClass)) + "</b> " + escapeHtml(pixelClassText(pixelClass)) + "</li>";
    }
    html +=
        "</ul></div><div><h3>Heat maps: ours minus other, in codes (ULP of float formats)</h3>"
        "<div class=\"scale\">";
    const auto step = [&](int32_t codes, const std::string& label) {
        html += "<span><i style=\"background:" + cssColor(heatColor(codes, false)) + "\"></i>" + label + "</span>";
    };
    for (int exponent = 7; exponent >= 0; --exponent) {
        step(-(1 << exponent), (exponent == 7 ? "\u2264\u2009\u2212" : "\u2212") + std::to_string(1 << exponent));
    }
    step(0, "0");
    for (int exponent = 0; exponent < 8; ++exponent) {
        step(1 << exponent, (exponent == 7 ? "\u2265\u2009" : "+") + std::to_string(1 << exponent));
    }
    html +=
        "</div><p>The scale is the same for every scene. Each pixel shows its component that is furthest "
        "off; pixels "
        "where coverage is legally ambiguous are drawn at a third of their strength.</p></div></div>";
    return html;
}

std::string titleOf(const Report& report, std::string_view driver) {
    for (const ReportDriver& each : report.drivers) {
        if (each.name == driver) return each.title;
    }
    return std::string(driver);
}

bool isOurs(const Report& report, std::string_view driver) {
    return std::any_of(report.drivers.begin(), report.drivers.end(),
                       [driver](const ReportDriver& each) { return each.ours && each.name == driver; });
}

std::string verdictPill(const ReportScene& scene) {
    if (!scene.judged) return "<span class=\"pill\">not judged</span>";
    return scene.failed ? "<span class=\"pill bad\">unexplained</span>" : "<span class=\"pill good\">explained</span>";
}

}  // namespace vernier::conformance
