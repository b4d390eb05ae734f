// What lines and points cover: the declared answer at a sample, and whether the specification leaves it open.
//
// Rectangular lines (Vulkan, Basic Line Segment Rasterization, strict lines): the rectangle's outline may move by what
// snapping moves ends and corners. Bresenham lines (Vulkan, Bresenham Line Segment Rasterization): an implementation's
// fragments may be one pixel beside those of the diamond-exit rule. Smooth lines: coverage is "a value", no more.
// Stipples (Vulkan, Line Stipple) count fragments of Bresenham lines, and pieces of unit length of rectangular ones,
// from the start of a list's segment or of a strip; where an implementation may have counted one more or less, the
// pattern may be shifted by it. Whether the shorter piece at the end of a segment counts as one for the next is left
// open.
#pragma once

#include "conformance/oracle/lines.h"
#include "conformance/oracle/triangle.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {

class LineShape {
  public:
    struct Setup {
        std::array<std::array<double, 2>, 2> ends;  // pixels
        double width = 1;                           // pixels
        VkLineRasterizationModeEXT mode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;
        uint32_t stippleFactor = 0;  // 0: not stippled
        uint16_t stipplePattern = 0;
        double stippleStart = 0;     // the count of the strip before this segment
        int64_t stippleFreedom = 0;  // by how many an implementation's count may differ there
        int subPixelBits = 8;
    };
    /// Bresenham lines are one pixel wide.
    explicit LineShape(const Setup& setup);

    /// `openAsWhole` where implementations may differ.
    SampleVerdict classify(const GridPoint& sample) const;
    PixelBounds bounds(const PixelBounds& within) const;

    /// Of smooth lines: the share of a pixel that is covered, anything from 0 to 1 being legal.
    std::optional<double> smoothCoverage(const GridPoint& sample) const;
    /// By how much the line takes the stipple's count on: fragments, or pixels of length.
    double stippleCount() const;

  private:
    SampleVerdict classifyRectangle(const GridPoint& sample) const;
    SampleVerdict classifyPixels(const GridPoint& sample) const;
    double distanceInPixels(const GridPoint& sample) const;
    bool stipplePasses(int64_t count) const;
    /// Whether the pattern draws a rectangular line where the sample is: by the declared rule, and by any.
    struct Stippled {
        bool nominal = true, possible = true, certain = true;
    };
    Stippled stippleAt(const GridPoint& sample) const;

    Setup setup_;
    GridLine grid_;
    std::vector<PixelIndex> pixels_;  // of a Bresenham line
};

class PointShape {
  public:
    struct Setup {
        std::array<double, 2> center;  // pixels
        double size = 1;
        int subPixelBits = 8;
    };
    explicit PointShape(const Setup& setup);

    SampleVerdict classify(const GridPoint& sample) const;
    PixelBounds bounds(const PixelBounds& within) const;
    /// PointCoord at a place in pixels (Vulkan, Basic Point Rasterization).
    std::array<double, 2> coordinate(double x, double y) const;

  private:
    Setup setup_;
    GridSquare square_;
};

}  // namespace vernier::conformance::exact
