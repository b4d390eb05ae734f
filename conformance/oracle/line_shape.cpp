#include "conformance/oracle/line_shape.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vernier::conformance::exact {
namespace {

// Ends move by up to a sub-unit in x and y, and corners computed from them by as much again.
constexpr int64_t kOutlineSlack = 3;
// Of the count along a rectangular line, in pixels: what the slack of its ends does to it, and rounding.
constexpr double kCountSlack = 0x1p-10;
// A point's borders: its centre or its corners may have been snapped.
constexpr int64_t kBorderSlack = 1;

SampleVerdict verdictOf(Coverage coverage, bool nominal) {
    SampleVerdict verdict;
    verdict.possible = coverage != Coverage::mustNot;
    verdict.openAsWhole = coverage == Coverage::may;
    verdict.nominalAsWhole = nominal;
    return verdict;
}

PixelBounds around(const PixelBounds& within, double left, double top, double right, double bottom) {
    return {std::max(within.x0, static_cast<int32_t>(std::floor(left))),
            std::max(within.y0, static_cast<int32_t>(std::floor(top))),
            std::min(within.x1, static_cast<int32_t>(std::ceil(right)) + 1),
            std::min(within.y1, static_cast<int32_t>(std::ceil(bottom)) + 1)};
}

}  // namespace

LineShape::LineShape(const Setup& setup) : setup_(setup) {
    const auto snap = [&](const std::array<double, 2>& p) {
        return GridPoint{toInt64(snapNearestEven(rational(p[0]), setup.subPixelBits)),
                         toInt64(snapNearestEven(rational(p[1]), setup.subPixelBits))};
    };
    const int64_t unit = int64_t{1} << setup.subPixelBits;
    grid_ = {snap(setup.ends[0]), snap(setup.ends[1]), rational(setup.width) * fraction(unit, 1)};
    if (setup.mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) {
        const auto exactly = [&](const GridPoint& p) {
            return std::array<Rational, 2>{fraction(p.x, unit), fraction(p.y, unit)};
        };
        pixels_ = bresenhamPixels(exactly(grid_.a), exactly(grid_.b));
    }
}

double LineShape::distanceInPixels(const GridPoint& sample) const {
    const double unit = std::ldexp(1.0, -setup_.subPixelBits);
    const auto& [a, b] = setup_.ends;
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
    const double px = static_cast<double>(sample.x) * unit - a[0], py = static_cast<double>(sample.y) * unit - a[1];
    if (length == 0) return std::hypot(px, py);
    const double along = std::clamp((px * dx + py * dy) / length, 0.0, length);
    return std::hypot(px - along * dx / length, py - along * dy / length);
}

SampleVerdict LineShape::classify(const GridPoint& sample) const {
    if (setup_.mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) return classifyPixels(sample);
    return classifyRectangle(sample);
}

SampleVerdict LineShape::classifyRectangle(const GridPoint& sample) const {
    // What is far outside is decided without rationals.
    const double distance = distanceInPixels(sample);
    if (distance > setup_.width + 2) return {};
    if (setup_.mode == VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT) {
        // Filters of implementations differ in their reach; a pixel and a half beside the line is generous.
        const bool reaches = distance < setup_.width / 2 + 1.5 && stippleAt(sample).possible;
        return verdictOf(reaches ? Coverage::may : Coverage::mustNot, smoothCoverage(sample).value_or(0) > 0);
    }
    const Coverage coverage = classifyLine(grid_, sample, kOutlineSlack);
    const bool nominal = lineCovers(grid_, sample);
    if (setup_.stippleFactor == 0 || coverage == Coverage::mustNot) return verdictOf(coverage, nominal);
    const Stippled stipple = stippleAt(sample);
    if (!stipple.possible) return {};
    return verdictOf(stipple.certain ? coverage : Coverage::may, nominal && stipple.nominal);
}

LineShape::Stippled LineShape::stippleAt(const GridPoint& sample) const {
    const auto dx = static_cast<double>(grid_.b.x - grid_.a.x), dy = static_cast<double>(grid_.b.y - grid_.a.y);
    const double length = std::hypot(dx, dy), unit = std::ldexp(1.0, -setup_.subPixelBits);
    if (length == 0) return {};
    const double along =
        (static_cast<double>(sample.x - grid_.a.x) * dx + static_cast<double>(sample.y - grid_.a.y) * dy) / length *
        unit;
    const double count = setup_.stippleStart + std::clamp(along, 0.0, length * unit);
    const double reach = static_cast<double>(setup_.stippleFreedom) + kOutlineSlack * unit + kCountSlack;
    Stippled result{stipplePasses(static_cast<int64_t>(count)), false, true};
    for (double at = std::floor(std::max(0.0, count - reach)); at <= count + reach; ++at) {
        const bool drawn = stipplePasses(static_cast<int64_t>(at));
        result.possible = result.possible || drawn;
        result.certain = result.certain && drawn;
    }
    return result;
}

double LineShape::stippleCount() const {
    if (setup_.mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) return static_cast<double>(pixels_.size());
    return std::hypot(static_cast<double>(grid_.b.x - grid_.a.x), static_cast<double>(grid_.b.y - grid_.a.y)) *
           std::ldexp(1.0, -setup_.subPixelBits);
}

bool LineShape::stipplePasses(int64_t count) const {
    if (setup_.stippleFactor == 0) return true;
    const int64_t bit = (count / setup_.stippleFactor % 16 + 16) % 16;
    return (setup_.stipplePattern >> bit & 1) != 0;
}

SampleVerdict LineShape::classifyPixels(const GridPoint& sample) const {
    const PixelIndex pixel{sample.x >> setup_.subPixelBits, sample.y >> setup_.subPixelBits};
    bool nominal = false, possible = false;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        // "May not deviate by more than one unit in either x or y"; ends may have one fragment more or less.
        if (std::abs(pixel.x - pixels_[i].x) > 1 || std::abs(pixel.y - pixels_[i].y) > 1) continue;
        const int64_t fragment = static_cast<int64_t>(i) + static_cast<int64_t>(setup_.stippleStart);
        for (int64_t shift = -setup_.stippleFreedom; shift <= setup_.stippleFreedom; ++shift) {
            possible = possible || stipplePasses(fragment + shift);
        }
        nominal = nominal || (pixel == pixels_[i] && stipplePasses(fragment));
    }
    return verdictOf(possible ? Coverage::may : Coverage::mustNot, nominal);
}

std::optional<double> LineShape::smoothCoverage(const GridPoint& sample) const {
    if (setup_.mode != VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT) return std::nullopt;
    return std::clamp(setup_.width / 2 + 0.5 - distanceInPixels(sample), 0.0, 1.0);
}

PixelBounds LineShape::bounds(const PixelBounds& within) const {
    const auto& [a, b] = setup_.ends;
    const double reach = setup_.width + 2;
    return around(within, std::min(a[0], b[0]) - reach, std::min(a[1], b[1]) - reach, std::max(a[0], b[0]) + reach,
                  std::max(a[1], b[1]) + reach);
}

PointShape::PointShape(const Setup& setup) : setup_(setup) {
    const Rational unit = fraction(int64_t{1} << setup.subPixelBits, 1);
    square_ = {rational(setup.center[0]) * unit, rational(setup.center[1]) * unit, rational(setup.size) * unit};
}

SampleVerdict PointShape::classify(const GridPoint& sample) const {
    return verdictOf(classifySquare(square_, sample, kBorderSlack), squareCovers(square_, sample));
}

PixelBounds PointShape::bounds(const PixelBounds& within) const {
    const double reach = setup_.size / 2 + 1;
    return around(within, setup_.center[0] - reach, setup_.center[1] - reach, setup_.center[0] + reach,
                  setup_.center[1] + reach);
}

std::array<double, 2> PointShape::coordinate(double x, double y) const {
    return {0.5 + (x - setup_.center[0]) / setup_.size, 0.5 + (y - setup_.center[1]) / setup_.size};
}

}  // namespace vernier::conformance::exact
