// The pixel formats scenes may use: how a texel is laid out, how codes and values convert.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace vernier::conformance {

/// How the bits of a component are read (Vulkan specification, "Numeric Format").
enum class ComponentKind : uint8_t { unorm, snorm, srgb, uint, sint, sfloat, ufloat };

struct FormatComponent {
    ComponentKind kind = ComponentKind::unorm;
    uint8_t bit = 0;  // first bit in the little-endian texel
    uint8_t bits = 0;
};

struct SceneFormat {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::string_view name;   // of the VkFormat, without the prefix
    uint8_t texelBytes = 0;  // as copied to a buffer; for combined formats those of the depth aspect
    uint8_t componentCount = 0;
    VkImageAspectFlags aspects = VK_IMAGE_ASPECT_COLOR_BIT;
    std::array<FormatComponent, 4> components{};  // in the order R, G, B, A (or D)
    // Block-compressed formats: the footprint; texelBytes are those of a block. They have no components, nor have
    // formats whose components share bits: such images are sampled, never put out.
    uint8_t blockWidth = 1, blockHeight = 1;

    bool isCompressed() const { return blockWidth > 1; }
    /// Bytes of an image of so many texels.
    size_t imageBytes(uint32_t width, uint32_t height) const {
        return size_t{(width + blockWidth - 1) / blockWidth} * ((height + blockHeight - 1) / blockHeight) * texelBytes;
    }
};

/// The description of `format`, or nullptr when scenes may not use it.
const SceneFormat* sceneFormat(VkFormat format);

/// All described formats.
std::span<const SceneFormat> sceneFormats();

/// The bits of a component of a texel, unsigned.
uint32_t componentCode(const FormatComponent& component, std::span<const std::byte> texel);

/// The value a component's bits stand for; linear for sRGB.
double decodeComponent(const FormatComponent& component, uint32_t code);

/// The codes of a component in the order of their values, as consecutive integers: two codes whose places
/// differ by one are neighbours. -0 and +0 of floats share a place; NaN codes have none and must not be asked
/// for.
int64_t codePlace(const FormatComponent& component, uint32_t code);

/// The code at a place, +0 for the place of zero; nothing beyond the lowest and highest value (infinities are
/// values).
std::optional<uint32_t> codeAtPlace(const FormatComponent& component, int64_t place);

bool isNan(const FormatComponent& component, uint32_t code);

}  // namespace vernier::conformance
