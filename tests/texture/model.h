// A plain model of the specification's image operations: one lane at a time, in double precision, sharing
// with the code under test only the conversion of single texels. Plus images and requests to run both on.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/texture/texture.h"

namespace vernier::texture_test {

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Each slice of each level has a heap block of its own exact size behind it, so that ASan sees any access
/// outside.
class Image {
  public:
    Image(VkImageViewType type, VkFormat format, uint32_t width, uint32_t height, uint32_t depth, uint32_t layers,
          uint32_t levels, VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

    const FormatInfo& info() const { return *findFormat(format_); }
    TextureView view(Isa isa) const;
    std::byte* texel(uint32_t level, uint32_t x, uint32_t y, uint32_t slice);
    void set(uint32_t level, uint32_t x, uint32_t y, uint32_t slice, const VkClearColorValue& value);
    void setAll(const VkClearColorValue& value);
    /// Finite values between -2 and 2 for floats (0..1 for depth), all bit patterns otherwise.
    void randomize(uint32_t seed);

    VkComponentMapping swizzle{};

  private:
    VkImageViewType type_;
    VkFormat format_;
    VkImageAspectFlags aspect_;
    uint32_t layers_;
    std::vector<TextureLevel> shapes_;
    std::vector<std::vector<std::byte>> data_;  // per level
};

using Rgba = std::array<double, 4>;

/// What one lane asks for; the level of detail lambda prime is given.
struct Point {
    double s = 0, t = 0, r = 0, layer = 0, dref = 0, lambda = 0;
    std::array<int32_t, 3> offset{};
};

/// The expected sample. Integer formats come as exact doubles.
Rgba modelSample(const TextureView& view, const SamplerState& sampler, const Point& at);
/// The distance in texels to the nearest place where nearest filtering jumps, in the level that is chosen.
double distanceToJump(const TextureView& view, const SamplerState& sampler, const Point& at);

/// One request's worth of lanes, with storage for everything.
struct Batch {
    explicit Batch(uint32_t laneCount);

    uint32_t lanes;
    std::array<std::vector<float>, 4> coord;
    std::vector<float> dref, lod;
    std::vector<uint32_t> mask;
    std::array<std::vector<float>, 4> out;
    SampleRequest request;

    Rgba result(const TextureView& view, uint32_t lane) const;
    void run(SampleFn fn, const TextureView& view, const SamplerState& sampler) { fn(view, sampler, request); }
};

SamplerState makeSampler(VkFilter filter, VkSamplerAddressMode mode,
                         VkSamplerMipmapMode mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST);

/// Samples s, t in one quad-shaped batch of four equal lanes at lambda 0.
Rgba sampleOne(const Image& image, const SamplerState& sampler, float s, float t, float r = 0, float layer = 0,
               float dref = 0, Isa isa = bestIsa());

}  // namespace vernier::texture_test
