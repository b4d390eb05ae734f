#include "conformance/precision/report.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace vernier::precision {
namespace {

std::string format(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

/// Rounded up in the last digit shown, so that what is stated holds.
std::string errorText(double value) {
    if (value == 0) return "0";
    if (value >= 1e6 || value < 1e-3) return format("%.3g", value * 1.005);
    const double unit = std::pow(10, std::floor(std::log10(value)) - 3);
    return format("%.4g", std::ceil(value / unit - 1e-9) * unit);
}

std::string worstText(const Function& function, const Worst& worst) {
    std::string text;
    for (uint32_t k = 0; k < function.operands; ++k) {
        if (k > 0) text += ", ";
        switch (function.operand) {
            case Word::int64:
                text += std::to_string(static_cast<int64_t>(worst.operands[k]));
                break;
            case Word::uint64:
                text += std::to_string(worst.operands[k]);
                break;
            default:
                text += format("%a", operandValue(function.operand, worst.operands[k]));
        }
    }
    return text;
}

std::string promiseText(const Function& function, const Promise& promise) {
    if (promise.ulp < 0) return "the formula's";
    std::string text = format("%g ULP", promise.ulp);
    if (promise.absolute > 0) text += " or 2^" + format("%g", std::log2(promise.absolute));
    return function.scaleText.empty() ? text : text + ", times " + function.scaleText;
}

std::string shareText(const Figures& figures) {
    if (figures.limit.value == 0) return "0";
    return figures.limit.value > 1 ? "**" + format("%.3g", figures.limit.value) + "**"
                                   : format("%.2g", figures.limit.value);
}

const char* const kIntroduction = R"(# Precision

Made by `vernier-precision --markdown docs/precision.md`; the test `precision_sample` measures a part of the same
operands again and holds it against this page.

How accurate functions are follows the math tier of the device or program (`vernier.h`: accuracy profiles).

| Tier | What it promises | How |
| --- | --- | --- |
| fast | about 11 bits (4096 ULP, 2^-11 for sine and cosine) | float, short polynomials |
| standard | what Vulkan demands, with room to spare: 4 ULP for most, 2^-22 for sine and cosine | float, fused multiply-add |
| fine | 1 ULP | double, polynomials good to 2^-28, one rounding |
| reference | correctly rounded but for ties that only more than 2^-13 of an ULP decides | double, polynomials as good as doubles are, one rounding |

Addition, subtraction, multiplication, division, square root, `fma` and conversions are correctly rounded in every tier (to
nearest, ties to even), and the same on every instruction set: no estimate instructions, no library functions. Functions
that the specification describes by a formula (`mix`, `length`, `reflect`...) are that formula, every operation rounded.
Sine, cosine and tangent are right for every float: angles beyond 2^19 are reduced in integers with as many bits of 1/(2π) as
their exponent asks for (Payne and Hanek 1983), one lane at a time, at 10 to 30 ns per lane. On SSE4, which lacks a fused
multiply-add, fast and standard compute it in double with a check, and cost several times what they cost on AVX2.

Errors are against MPFR (128 bits); operands whose error in double cannot be the greatest are left to double, so that means
are right to 2^-22 ULP. An ULP is the distance between the two numbers of the result's format around the exact result;
denormal results count in units of 2^-149 (halves: 2^-24, doubles: 2^-1074). Conversions to integers truncate, exactly. Functions of halves
(16-bit floats) are those of floats, rounded once more. Of doubles Vulkan demands no more than of floats; they are correctly
rounded but for `inversesqrt`, the quotient 1 / sqrt(x), and formulas.

## Special operands

| Operation | Result |
| --- | --- |
| any function of NaN | NaN, but pow(NaN, 0) = 1 and pow(1, NaN) = 1; min, max and clamp take the other operand |
| sin, cos, tan of ±inf | NaN |
| asin, acos outside [-1, 1]; acosh below 1; atanh outside [-1, 1]; log, log2 below 0; sqrt, inversesqrt below 0 | NaN |
| log, log2 of ±0 | -inf |
| inversesqrt of +0, of -0, of inf | inf, -inf, 0 |
| atanh of ±1 | ±inf |
| exp, exp2, sinh, cosh beyond the range | inf (denormal results, then 0, below) |
| pow(x, 0), pow(1, y) | 1, whatever the other operand (the specification leaves pow(0, 0) open) |
| pow(0, y) | 0 for y > 0, inf for y < 0 |
| pow(x, y) for x < 0 | NaN but for y = 0 (left open by the specification) |
| atan2(±0, ±0), atan2(±inf, ±inf) | as in C: ±0, ±π; ±π/4, ±3π/4 |
| x / 0, 0 / 0 | ±inf, NaN |
| denormal operands and results | kept |
)";

constexpr const char* kFull = "## In full";

std::string rowStart(const Function& function) {
    return "| `" + function.name + "` |";
}

/// The lines about a function in a part of an earlier page.
std::string earlierRows(const std::string& part, const Function& function) {
    std::string rows;
    std::istringstream lines(part);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(rowStart(function))) rows += line + "\n";
    return rows;
}

}  // namespace

std::string writeReport(std::span<const Measurement> measurements, const ReportText& text, const std::string& earlier) {
    const auto measured = [&](const Function& function) {
        const auto found = std::ranges::find(measurements, &function, &Measurement::function);
        return found == measurements.end() ? nullptr : &*found;
    };
    const size_t fullStart = std::min(earlier.find(kFull), earlier.size());
    const std::string earlierSummary = earlier.substr(0, fullStart), earlierFull = earlier.substr(fullStart);
    std::ostringstream out;
    out << kIntroduction << "\n## Greatest errors\n\nOperands: " << text.sample
        << ".\n\nIn ULP; in brackets the greatest share of what Vulkan permits for the operands at hand, where it "
           "permits a finite error: 1 is the limit.";
    if (!text.driver.empty()) {
        out << " Last column: " << text.driver << ", the same functions as a compute shader, without denormals.";
    }
    out << "\n\n| Function | Vulkan's limit | Fast | Standard | Fine | Reference |";
    if (!text.driver.empty()) out << " Lavapipe |";
    out << "\n| --- | --- | --- | --- | --- | --- |" << (text.driver.empty() ? "" : " --- |") << "\n";
    for (const Function& function : functions()) {
        const Measurement* m = measured(function);
        if (m == nullptr) {
            out << earlierRows(earlierSummary, function);
            continue;
        }
        out << rowStart(function) << " " << function.limitText << " |";
        const auto cell = [&](const Figures& figures) {
            out << " " << errorText(figures.ulp.value) << " (" << shareText(figures) << ")";
            if (figures.wrongNaNs > 0) out << " **" << figures.wrongNaNs << " NaN**";
            out << " |";
        };
        for (const Figures& figures : m->tiers) cell(figures);
        if (m->driver) cell(*m->driver);
        if (!m->driver && !text.driver.empty()) out << " |";
        out << "\n";
    }
    out << "\n"
        << kFull
        << "\n\nPromise: the tier's own bound. Mean in ULP; correct: share of results that are correctly rounded; "
           "worst: "
           "operands of the greatest error in ULP.\n\n"
           "| Function | Tier | Promise | Greatest ULP | Greatest absolute | Mean | Correct | Worst | Calls |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Function& function : functions()) {
        const Measurement* m = measured(function);
        if (m == nullptr) {
            out << earlierRows(earlierFull, function);
            continue;
        }
        const auto row = [&](const std::string& name, const std::string& promise, const Figures& figures) {
            out << rowStart(function) << " " << name << " | " << promise << " | " << errorText(figures.ulp.value)
                << " | " << errorText(figures.absolute.value) << " | " << format("%.3g", figures.mean()) << " | "
                << format("%.2f %%", figures.correctShare() * 100) << " | " << worstText(function, figures.ulp) << " | "
                << figures.calls << " |\n";
        };
        for (size_t tier = 0; tier < kTiers.size(); ++tier) {
            row(kTierNames[tier], promiseText(function, function.promises[tier]), m->tiers[tier]);
        }
        if (m->driver) row("lavapipe", "", *m->driver);
    }
    return out.str();
}

StatedErrors readReport(const std::string& markdown) {
    StatedErrors stated;
    std::istringstream lines(markdown.substr(std::min(markdown.find(kFull), markdown.size())));
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> cells;
        std::istringstream split(line);
        for (std::string cell; std::getline(split, cell, '|');) {
            const size_t first = cell.find_first_not_of(" `"), last = cell.find_last_not_of(" `");
            cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
        }
        if (cells.size() < 5 || line.find('`') == std::string::npos) continue;
        stated[{cells[1], cells[2]}] = std::strtod(cells[4].c_str(), nullptr);
    }
    return stated;
}

std::vector<std::string> violations(const Measurement& measurement) {
    constexpr double kRoundOff = 1e-6;  // of the shares themselves
    std::vector<std::string> found;
    const Function& function = *measurement.function;
    for (size_t tier = 0; tier < kTiers.size(); ++tier) {
        const Figures& figures = measurement.tiers[tier];
        const std::string name = function.name + ", " + kTierNames[tier] + ": ";
        const auto check = [&](const Worst& worst, const char* bound) {
            if (!(worst.value <= 1 + kRoundOff)) {
                found.push_back(name + format("%.6g", worst.value) + " times " + bound + " at " +
                                worstText(function, worst));
            }
        };
        check(figures.promise, "the tier's bound");
        // Fast is below Vulkan's demands, and says so.
        if (kTiers[tier] != MathTier::fast) check(figures.limit, "Vulkan's limit");
        if (figures.wrongNaNs > 0) found.push_back(name + std::to_string(figures.wrongNaNs) + " NaN results");
        if (figures.calls == 0) found.push_back(name + "nothing was measured");
    }
    return found;
}

}  // namespace vernier::precision
