// Judges for any scene: exact invariants between images, values and codes known for every pixel, and the whole-scene
// oracle.
#pragma once

#include "conformance/hardcases/hard_case.h"
#include "conformance/oracle/pixel_format.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vernier::conformance::hardcases {

/// All images of both scenes have the same bytes. `law` says why they must, e.g. "the order of triangles that do not
/// overlap changes nothing".
void judgeSame(CaseInput& input, size_t scene, size_t reference, std::string law);

/// Every pixel of one output lies in what the oracle permits: exact where every code is the nearest one of the exact
/// value.
void judgeByOracle(CaseInput& input, size_t scene);

/// Adds the scene and has the oracle judge it. Returns the scene.
size_t addForOracle(CaseInput& input, Result<Scene> scene);

/// A pixel of an image, one channel at a time.
class PixelReader {
  public:
    explicit PixelReader(const RenderedImage& image);
    bool valid() const { return format_ != nullptr; }
    const exact::PixelFormat& format() const { return *format_; }
    VkExtent2D extent() const { return image_->extent; }
    /// The code of a channel; 0 for a channel that the format lacks.
    uint64_t code(uint32_t x, uint32_t y, uint8_t channel) const;
    /// The float with the code's bits, for 32-bit channels.
    float number(uint32_t x, uint32_t y, uint8_t channel) const;

  private:
    const RenderedImage* image_;
    const exact::PixelFormat* format_ = nullptr;
};

/// Asks `check` for a verdict on output `output` of a scene, having checked that the image has this extent and a known
/// format.
void judgePixels(CaseInput& input, size_t scene, size_t output, VkExtent2D extent,
                 std::function<Verdict(const PixelReader& pixels, const Declared& declared)> check);

/// All of a scene's pixels have these codes in the channels that the format has.
void judgeCodes(CaseInput& input, size_t scene, size_t output, VkExtent2D extent, std::vector<uint64_t> codes,
                std::string law);

}  // namespace vernier::conformance::hardcases
