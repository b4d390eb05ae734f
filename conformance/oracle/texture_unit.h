// Sampling a stored image with everything the specification leaves open: coordinates with 20 bits, weights of
// at least 8 bits, a level of detail of at least 6 fraction bits from any accepted approximation of the scale
// factor.
//
// The result is a box of reachable values per component, found by evaluating the filter, which is linear in
// each variable between texel centres and levels, at the ends of its ranges and at every break between them.
#pragma once

#include "conformance/oracle/image_store.h"

#include <array>
#include <cstdint>
#include <optional>

namespace vernier::conformance::exact {

/// What a shader hands to the sampler; coordinates are normalised.
struct SampleQuery {
    double s = 0, t = 0, r = 0;  // r: of volumes; of cubes all three are the direction
    double layer = 0;
    std::array<double, 3> ddx{}, ddy{};  // of s, t, r along the framebuffer's x and y
    std::optional<double> lod;           // explicit: replaces the derivatives
    double bias = 0;
    double minLod = 0;
    std::array<int32_t, 3> offset{};
    std::optional<double> dref;  // depth comparison; the result is in channel 0
    // What the implementation declares: OracleRules.
    double weightSlack = 0x1p-8, levelSlack = OracleRules().levelSlack;
};

struct SampleResult {
    Color color{};
    OracleFlags flags = 0;  // of OracleFlag, from the texels read

    bool isExact() const;
};

SampleResult sampleImage(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& query);

/// The four texels of a linear filter at level 0 in the order of textureGather, one channel.
SampleResult gatherImage(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& query,
                         uint32_t channel);

/// One texel without a sampler; outside the level it reads as 0.
SampleResult fetchImage(const ImageStore& image, int64_t x, int64_t y, int64_t layer, int64_t mip, uint32_t sample);

/// A texel of an axis-aligned blit: linear or nearest filter at unnormalised coordinates, of which volumes take the
/// third, edges clamped. `truncated`: OracleRules::truncatedBlits.
SampleResult blitTexel(const ImageStore& image, uint32_t mip, uint32_t layer, const std::array<double, 3>& at,
                       VkFilter filter, bool truncated = false);

/// Nominal level of detail with its range, before clamping to the image: -infinity without any derivative.
Interval levelOfDetail(const SampleQuery& query, const SceneSampler& sampler, VkExtent2D extent, uint32_t depth = 1);

/// What OpImageQueryLod computes before the sampler's limits clamp it, on any of the faces that a direction may choose.
/// Nothing for a direction without length.
std::optional<Interval> queriedLevel(const ImageStore& image, const SceneSampler& sampler, const SampleQuery& query);

}  // namespace vernier::conformance::exact
