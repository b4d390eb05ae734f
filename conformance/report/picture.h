// Pictures for people: any scene format as 8-bit sRGB, magnified crops, heat maps, PNG files.
#pragma once

#include "base/result.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/scene.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::conformance {

struct Rgb8 {
    uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb8&) const = default;
};

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<Rgb8> pixels;

    Picture() = default;
    Picture(uint32_t w, uint32_t h, Rgb8 fill = {}) : width(w), height(h), pixels(size_t{w} * h, fill) {}
    Rgb8& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
    const Rgb8& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

/// How values become brightness. Stored codes of 8-bit colour are shown as they are; floats and depth are
/// stretched from the lowest to the highest value, the same way for all pictures that share a Stretch.
struct Stretch {
    bool active = false;
    double low = 0, high = 1;
};

/// The stretch that suits an image of one driver; to be used for all drivers' images of that output.
Stretch stretchFor(const RenderedImage& image);

Picture pictureOf(const RenderedImage& image, const Stretch& stretch);
Picture pictureOf(const OracleImage& image, const Stretch& stretch);

/// The square of `size` pixels around (x, y), each drawn as `scale` x `scale`, the middle one framed; outside
/// the image is grey.
Picture magnified(const Picture& picture, uint32_t x, uint32_t y, uint32_t size, uint32_t scale);

/// A PNG file in memory. `text` goes into its "Comment".
Result<std::string> encodePng(const Picture& picture, const std::string& text = {});

}  // namespace vernier::conformance
