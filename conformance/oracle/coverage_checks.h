// Judging an observed coverage image against exact geometry, naming the first wrong sample and why it is
// wrong.
//
// An observed image is an additive count: how many of the triangles covered each pixel's sample.
#pragma once

#include "conformance/oracle/coverage.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vernier::conformance::exact {

/// The samples of an image: one per pixel, at `offset` sub-units from the pixel's corner.
struct SampleGrid {
    VkExtent2D extent{};
    int bits = 8;
    GridPoint offset{128, 128};  // the pixel centre on a grid of 8 bits

    GridPoint sample(uint32_t x, uint32_t y) const {
        return {(static_cast<int64_t>(x) << bits) + offset.x, (static_cast<int64_t>(y) << bits) + offset.y};
    }
};

/// How a sample lies to a triangle, in words: on which edge, how near to it, strictly inside or outside.
std::string describeSample(const GridTriangle& triangle, const GridPoint& sample);

/// Declared mode: every sample inside the scissor has exactly the declared count, every other sample 0. Empty
/// text: right.
std::string checkDeclaredCoverage(std::span<const GridTriangle> triangles, const SampleGrid& grid,
                                  const VkRect2D& scissor, std::span<const uint32_t> observed);

/// Nothing outside the scissor is covered.
std::string checkScissor(const SampleGrid& grid, const VkRect2D& scissor, std::span<const uint32_t> observed);

/// Any legal snapping, inside the scissor: counts lie between what must and what may be covered, and pairs of triangles
/// that share the only open edge count exactly one between them.
std::string checkLegalCoverage(std::span<const GridTriangle> triangles, const SampleGrid& grid, const VkRect2D& scissor,
                               std::span<const uint32_t> observed);

/// For triangles that tile a region, inside the scissor: every sample farther than one sub-unit from the region's
/// outline is covered exactly once inside and never outside, under any snapping and any tie rule.
std::string checkPartition(std::span<const GridTriangle> triangles, const SampleGrid& grid, const VkRect2D& scissor,
                           std::span<const uint32_t> observed);

}  // namespace vernier::conformance::exact
