// One level of a stored image through a filter, with everything the specification leaves open: the box of values that
// coordinates and weights within their ranges reach. The filter is linear in each coordinate between texel centres, so
// that the ends of the ranges and the breaks between them are enough.
#pragma once

#include "conformance/oracle/image_store.h"
#include "conformance/oracle/texture_unit.h"

#include <array>
#include <cstdint>
#include <optional>

namespace vernier::conformance::exact {

// CTS "high quality": 20 bits of coordinate.
inline constexpr double kCoordinateSlack = 0x1p-20;

/// A sampler joined to one layer, slice range or face of an image.
struct Sampler {
    const ImageStore& image;
    const SceneSampler& state;
    uint32_t layer = 0;
    std::array<int32_t, 3> offset{};
    std::optional<Interval> dref;
    double weightSlack = 0;
    bool truncated = false;  // coordinates of linear filters go to the texel towards zero
};

/// Of texels, or of other units where it says so; of volumes with its third coordinate.
struct Place {
    double u = 0, v = 0, w = 0.5;
};

/// Accumulates the box over several evaluations; the first one is the nominal value.
class Box {
  public:
    void add(const SampleResult& r) {
        if (first_) {
            result_ = r;
            first_ = false;
            return;
        }
        for (size_t c = 0; c < 4; ++c) result_.color[c] = result_.color[c].united(r.color[c]);
        result_.flags |= r.flags;
    }
    const SampleResult& result() const { return result_; }

  private:
    SampleResult result_;
    bool first_ = true;
};

/// The texel at integer coordinates after wrapping, compared if the sampler compares.
SampleResult tap(const Sampler& s, uint32_t mip, int64_t x, int64_t y, int64_t z);

/// Two texels, or filtered values, of which the second has weight t: mixed, or the smaller or larger one
/// (VK_EXT_sampler_filter_minmax), among those that have a weight at all.
SampleResult mix(const Sampler& s, const SampleResult& a, const SampleResult& b, double t);

/// A level at a place in shares of its size.
SampleResult filterLevel(const Sampler& s, uint32_t mip, VkFilter filter, const Place& at);

}  // namespace vernier::conformance::exact
