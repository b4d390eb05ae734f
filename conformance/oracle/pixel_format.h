// The oracle's own table of pixel formats: where each component's bits are and how they encode a number. Read
// straight from the specification's "Identification of Formats"; nothing is shared with the renderer's
// tables.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vernier::conformance::exact {

enum class Encoding : uint8_t { unorm, snorm, uint, sint, sfloat, ufloat, srgb, sharedExponent };

/// `bits` bits from `offset` of the texel seen as one little-endian integer.
struct Component {
    uint8_t channel = 0;  // 0..3 = R, G, B, A; depth is 0, stencil is 1
    uint8_t offset = 0;
    uint8_t bits = 0;
    Encoding encoding = Encoding::unorm;
};

struct PixelFormat {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint8_t bytes = 0;  // per texel, in the packing of vkCmdCopyImageToBuffer (depth aspect)
    uint8_t componentCount = 0;
    std::array<Component, 4> components{};
    bool depth = false, stencil = false;

    std::span<const Component> all() const { return {components.data(), componentCount}; }
    /// The component of a channel, or nullptr when the format has none.
    const Component* channel(uint8_t index) const;
    bool isInteger() const;
};

/// nullptr for formats that the oracle does not know.
const PixelFormat* findPixelFormat(VkFormat format);

/// Exponent and mantissa bits of a floating-point component of 32, 16, 11, 10 (unsigned) bits.
struct FloatLayout {
    int exponentBits, mantissaBits;
    int minExponent() const { return 2 - (1 << (exponentBits - 1)); }
    int maxExponent() const { return (1 << (exponentBits - 1)) - 1; }
};
FloatLayout floatLayout(int bits);

/// The component's bits in a texel.
uint64_t extractBits(const std::byte* texel, unsigned offset, unsigned bits);
/// Replaces them.
void insertBits(std::byte* texel, unsigned offset, unsigned bits, uint64_t value);

}  // namespace vernier::conformance::exact
