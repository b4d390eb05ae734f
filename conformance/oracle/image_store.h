// The oracle's images: every texel of every level, layer and sample as a range of permitted values.
#pragma once

#include "base/result.h"
#include "conformance/oracle/interval.h"
#include "conformance/oracle/oracle.h"
#include "conformance/oracle/pixel_format.h"
#include "conformance/scene/scene.h"

#include <algorithm>
#include <vector>

namespace vernier::conformance::exact {

/// Colour, or depth in channel 0 and stencil in channel 1; flags of OracleFlag.
struct StoredTexel {
    Color channels{};
    OracleFlags flags = 0;
};

/// One level of one layer; samples of a pixel are consecutive.
struct ImageLevel {
    VkExtent2D extent{};
    uint32_t samples = 1;
    std::vector<StoredTexel> texels;

    StoredTexel& at(uint32_t x, uint32_t y, uint32_t sample = 0) {
        return texels[(static_cast<size_t>(y) * extent.width + x) * samples + sample];
    }
    const StoredTexel& at(uint32_t x, uint32_t y, uint32_t sample = 0) const {
        return const_cast<ImageLevel*>(this)->at(x, y, sample);
    }
};

/// What a texture lookup does with an image's layers.
enum class ImageKind : uint8_t { flat, volume, cube };

class ImageStore {
  public:
    /// Takes over the image's initial contents; texels without any are flagged kOracleUnknown.
    static Result<ImageStore> create(const SceneImage& image);

    const PixelFormat& format() const { return *format_; }
    uint32_t mipLevels() const { return mipLevels_; }
    uint32_t arrayLayers() const { return arrayLayers_; }

    ImageKind kind() const { return kind_; }
    /// Of a volume's level; 1 of all others.
    uint32_t depth(uint32_t mip) const { return kind_ == ImageKind::volume ? std::max(1u, depth_ >> mip) : 1; }

    /// Of a volume `layer` is a slice.
    ImageLevel& level(uint32_t mip, uint32_t layer) { return levels_[firstOfMip_[mip] + layer]; }
    const ImageLevel& level(uint32_t mip, uint32_t layer) const { return levels_[firstOfMip_[mip] + layer]; }

  private:
    const PixelFormat* format_ = nullptr;
    ImageKind kind_ = ImageKind::flat;
    uint32_t mipLevels_ = 1, arrayLayers_ = 1, depth_ = 1;
    std::vector<size_t> firstOfMip_;  // into levels_
    std::vector<ImageLevel> levels_;
};

/// Stores a colour: each channel that the format has is quantised, the others read back as 0, alpha as 1.
Color quantiseColor(const PixelFormat& format, const Color& color);

/// Average of the samples of a pixel. sRGB may be averaged in linear or in encoded space, integers may be any
/// one sample.
StoredTexel resolveSamples(const PixelFormat& format, const ImageLevel& source, uint32_t x, uint32_t y);

/// Depth and stencil of a pixel by their modes (Vulkan, VkResolveModeFlagBits); an aspect of mode NONE is unknown.
StoredTexel resolveDepthStencil(const PixelFormat& format, const ImageLevel& source, uint32_t x, uint32_t y,
                                VkResolveModeFlagBits depthMode, VkResolveModeFlagBits stencilMode);

}  // namespace vernier::conformance::exact
