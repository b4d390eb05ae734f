// Drawing soups through vernier.h, at one position of the accuracy dial.
#pragma once

#include <vernier/vernier.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/stability/soup.h"

namespace vernier::stability {

/// kSize x kSize pixels, row by row.
using Counts = std::vector<float>;
/// The bits of four floats per pixel.
using Image = std::vector<uint32_t>;

/// What a soup's vertices carry beside their position: four numbers that follow from the triangle's number and the
/// vertex's position, so that they stay when vertices are rotated; or the same for all.
enum class Attributes : uint8_t { own, constant };
inline constexpr std::array<float, 4> kConstant{0.1f, 1.0f / 3.0f, 16777213.0f, -0x1.8p-40f};

class Canvas {
  public:
    Canvas(VnProfile profile, uint32_t threads);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    int subPixelBits() const { return subPixelBits_; }

    /// How many triangles cover each pixel's centre.
    Counts count(const Soup& soup);
    /// The attributes of the last triangle at each pixel, in order; -1 where there is none. `drawEach`: a draw for
    /// every triangle.
    Image paint(const Soup& soup, Attributes attributes = Attributes::own, bool drawEach = false);
    /// Draws with a LESS depth test, then again with EQUAL: how often the second time passes.
    Counts countEqual(const Soup& soup);

    /// Empty unless a call of the API failed.
    const std::string& error() const { return error_; }

  private:
    void check(VnResult result, const char* call);
    VnImage makeImage(VkFormat format);
    VnProgram makeProgram(const char* fragment);
    VnDepthStencilState makeDepth(VkCompareOp compare, bool write);
    void begin(VnImage color, const std::array<float, 4>& clear);
    VnBuffer upload(const Soup& soup, Attributes attributes);
    void read(VnImage image, void* data, size_t bytes);

    VnDevice device_ = nullptr;
    VnContext context_ = nullptr;
    VnProgram count_{}, paint_{};
    VnVertexLayout layout_{};
    VnBlendState add_{};
    VnDepthStencilState less_{}, equal_{};
    VnImage counts_{}, colors_{}, depth_{};
    int subPixelBits_ = 8;
    std::string error_;
};

}  // namespace vernier::stability
