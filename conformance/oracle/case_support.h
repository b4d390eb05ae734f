// What the numeric cases share: drawing triangles given on the sub-pixel grid so that their coverage can be
// counted, and reading images back as codes.
#pragma once

#include "conformance/oracle/cases.h"
#include "conformance/oracle/coverage.h"
#include "conformance/oracle/pixel_format.h"

#include <array>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace vernier::conformance::cases {

using exact::GridPoint;
using exact::GridTriangle;

using ClipPosition = std::array<float, 4>;

/// Clip coordinates of a point on the grid of 8 sub-pixel bits. Exact in float, and through the viewport
/// transform, when the viewport is a power of two of at most 8192 pixels at integer offsets.
ClipPosition clipOnGrid(const GridPoint& p, const VkViewport& viewport);

/// One draw of `positions` (three per triangle) into RGBA8, every covering triangle adding kCountStep to red.
inline constexpr uint32_t kCountStep = 16;
Result<Scene> coverageScene(std::string_view name, std::span<const ClipPosition> positions, VkExtent2D extent,
                            const VkViewport& viewport);
Result<Scene> coverageScene(std::string_view name, std::span<const GridTriangle> triangles, VkExtent2D extent);

/// The counts of such an image; an error if a code is no count or another channel was touched.
Result<std::vector<uint32_t>> coverageCounts(const RenderedImage& image, VkExtent2D extent);

/// The code of a channel; 0 for a channel that the format lacks.
uint64_t codeAt(const RenderedImage& image, const exact::PixelFormat& format, uint32_t x, uint32_t y, uint8_t channel);

/// Checks that there are `scenes` results of `outputs` images each, of the given extent.
Status checkShape(const CaseImages& images, size_t scenes, size_t outputs, VkExtent2D extent);

/// An error for a non-empty text.
Status verdict(std::string_view name, const std::string& wrong);

std::string pixelText(uint32_t x, uint32_t y);

/// A jittered grid of vertices and its triangles: a planar tiling.
struct Tiling {
    std::vector<std::array<double, 2>> points;  // pixels
    std::vector<std::array<size_t, 3>> triangles;
};
Tiling jitteredTiling(uint32_t cells, double cellPixels, double jitterPixels, double resolution, uint32_t seed);

}  // namespace vernier::conformance::cases
