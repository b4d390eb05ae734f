// Pixel formats: what a VkFormat is made of, what can be done with it, and how its texels become values and
// back.
//
// One table (format_table.cpp) drives everything here. Images are stored as rows of texels in the bytes the
// Vulkan specification gives for the format; a combined depth-stencil texel, which it leaves open, is stored
// as
//   D24_UNORM_S8_UINT   one little-endian uint32: depth in bits 0..23, stencil in bits 24..31
//   D32_SFLOAT_S8_UINT  eight bytes: depth as a float, stencil in byte 4, three bytes of padding
//
// Values travel as VkClearColorValue for one texel, and as four planes (R, G, B, A; one 32-bit value per
// texel) for many. The depth aspect is a format with R = depth, the stencil aspect one with R = stencil
// (uint). Components that a format lacks read as 0, A as 1.
//
// Conversions are exact and the same on every instruction set:
//   unorm, snorm   decoded to the float nearest to c / max; encoded by clamping and rounding the exact
//   product to the
//                  nearest integer, ties to even; NaN encodes as 0; the most negative snorm code decodes as
//                  -1
//   srgb           decoded to the nearest float; encoded to the nearest code of the exact curve; A is plain
//   unorm sfloat 16      encoded by rounding to nearest even, overflow to infinity; NaN stays NaN (quiet)
//   ufloat 11, 10  as above, but negative values encode as 0 and finite overflow as the largest finite value
//   block          compressed formats (block.h) are seen as the texels they decode to, and are never encoded
//   E5B9G9R9       by the specification's algorithm ("Conversion from RGB to shared exponent")
//   uint, sint     clamped to the range of the component; u/sscaled likewise, from floats rounded to nearest
//   even
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "runtime/format/block.h"

namespace vernier {

enum class ComponentKind : uint8_t { none, unorm, snorm, uscaled, sscaled, uint, sint, ufloat, sfloat, srgb };

/// A bit field of a texel seen as one little-endian integer: bits offset .. offset + bits - 1. bits == 0:
/// absent.
struct Component {
    uint8_t bits = 0;
    uint8_t offset = 0;
    ComponentKind kind = ComponentKind::none;
};

/// What a texel is in a shader: the member of VkClearColorValue, and the meaning of the planes' 32-bit
/// values.
enum class ValueType : uint8_t { floating, uint, sint };

/// One aspect of a format, ready for conversion.
struct TexelLayout {
    uint8_t bytes = 0;            // from one texel to the next
    bool sharedExponent = false;  // E5B9G9R9: exponent in bits 27..31
    bool keepOtherBits = false;   // the texel holds another aspect: packing leaves its bits alone
    ValueType type = ValueType::floating;
    Component rgba[4];
};

struct FormatInfo {
    VkFormat format;
    const char* name;            // without VK_FORMAT_
    uint8_t bytesPerTexel;       // of a block-compressed format: bytes per block
    uint8_t componentCount;      // colour components, or depth + stencil
    bool packed;                 // a *_PACK8/16/32 format
    VkImageAspectFlags aspects;  // COLOR, DEPTH, STENCIL
    TexelLayout color;           // meaningful when aspects has COLOR; of a compressed format: what it decodes to
    TexelLayout depth;           // ... DEPTH
    TexelLayout stencil;         // ... STENCIL
    // As vkGetPhysicalDeviceFormatProperties reports them.
    VkFormatFeatureFlags optimalTilingFeatures;
    VkFormatFeatureFlags linearTilingFeatures;
    VkFormatFeatureFlags bufferFeatures;
    const BlockCodec* block = nullptr;  // block compression; nullptr: each texel stands for itself

    // Texels of a block, 1 x 1 without compression; and how many blocks cover `texels`.
    uint32_t blockWidth() const { return block == nullptr ? 1 : block->width; }
    uint32_t blockHeight() const { return block == nullptr ? 1 : block->height; }
    uint32_t columns(uint32_t texels) const { return (texels + blockWidth() - 1) / blockWidth(); }
    uint32_t rows(uint32_t texels) const { return (texels + blockHeight() - 1) / blockHeight(); }

    /// `aspect` is one bit of `aspects`.
    const TexelLayout& layout(VkImageAspectFlags aspect) const {
        return aspect == VK_IMAGE_ASPECT_STENCIL_BIT ? stencil : aspect == VK_IMAGE_ASPECT_DEPTH_BIT ? depth : color;
    }
};

/// nullptr: not a format Vernier knows.
const FormatInfo* findFormat(VkFormat format);

/// The formats of the table, for loops over all of them.
struct FormatRange {
    const FormatInfo* first;
    const FormatInfo* last;
    const FormatInfo* begin() const { return first; }
    const FormatInfo* end() const { return last; }
};
FormatRange allFormats();

/// The one aspect of a format that has one; depth for a combined one.
VkImageAspectFlags defaultAspect(const FormatInfo& info);

// --- One texel at a time: the definition, and what clears and tests use. `texel` needs no alignment.

VkClearColorValue unpackTexel(const TexelLayout& layout, const void* texel);
void packTexel(const TexelLayout& layout, const VkClearColorValue& value, void* texel);

/// A VkClearValue for the given aspects of a texel: colour, or depth and/or stencil.
void packClear(const FormatInfo& info, VkImageAspectFlags aspects, const VkClearValue& value, void* texel);

/// Sets to 1 the bits of a texel that the components of `mask` occupy, the rest to 0: for merging a packed
/// texel into memory under a colour write mask. `bits` has bytesPerTexel bytes.
void componentBits(const FormatInfo& info, VkColorComponentFlags mask, void* bits);

// --- Many texels: the same bits, faster.

/// Conversions between n texels in memory and planes of n values. Plain data, valid forever; no alignment is
/// required.
struct FormatOps {
    using UnpackFn = void (*)(const TexelLayout&, const void* texels, size_t n, void* const planes[4]);
    using PackFn = void (*)(const TexelLayout&, const void* const planes[4], size_t n, void* texels);

    TexelLayout layout;
    UnpackFn unpackFn = nullptr;
    PackFn packFn = nullptr;

    /// planes[c] receives n floats, uint32s or int32s (layout.type); a null plane is skipped.
    void unpack(const void* texels, size_t n, void* const planes[4]) const { unpackFn(layout, texels, n, planes); }
    /// Planes of components that the format lacks may be null and are not read. A layout with keepOtherBits
    /// reads and rewrites the texels' other bits.
    void pack(const void* const planes[4], size_t n, void* texels) const { packFn(layout, planes, n, texels); }
    /// As unpack, from one pointer per texel: vertices with a stride, texels of a footprint.
    void unpackEach(const std::byte* const* texels, size_t n, void* const planes[4]) const;
    /// Depth or stencil of n texels: the R plane alone.
    void unpackOne(const void* texels, size_t n, void* plane) const {
        void* const planes[4] = {plane, nullptr, nullptr, nullptr};
        unpackFn(layout, texels, n, planes);
    }
    void packOne(const void* plane, size_t n, void* texels) const {
        const void* const planes[4] = {plane, nullptr, nullptr, nullptr};
        packFn(layout, planes, n, texels);
    }
};

/// `format` must be in the table and `aspect` be one of its aspects. Cheap; choose once per pipeline or view.
FormatOps formatOps(VkFormat format, VkImageAspectFlags aspect, Isa isa);
/// With the default aspect.
FormatOps formatOps(VkFormat format, Isa isa);

// --- Copies between images and buffers (vkCmdCopyBufferToImage: "depth/stencil aspects").

/// Bytes per texel (or block) in a buffer that receives one aspect: colour as in the image, D16 2, D24 4 (depth in the
/// low 24 bits, the rest zero), D32 4, stencil 1.
uint32_t bufferTexelBytes(const FormatInfo& info, VkImageAspectFlags aspect);
void copyTexelsToBuffer(const FormatInfo& info, VkImageAspectFlags aspect, const void* texels, size_t n, void* buffer);
/// Leaves the other aspect of the texels alone.
void copyTexelsFromBuffer(const FormatInfo& info, VkImageAspectFlags aspect, const void* buffer, size_t n,
                          void* texels);

}  // namespace vernier
