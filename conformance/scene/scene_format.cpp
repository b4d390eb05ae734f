#include "conformance/scene/scene_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vernier::conformance {
namespace {

using enum ComponentKind;

/// `count` components of `bits` bits each, one after the other.
constexpr std::array<FormatComponent, 4> uniform(ComponentKind kind, uint8_t bits, int count) {
    std::array<FormatComponent, 4> components{};
    for (int i = 0; i < count; ++i) {
        components[static_cast<size_t>(i)] = {kind, static_cast<uint8_t>(i * bits), bits};
    }
    return components;
}

/// Eight bits each, stored B, G, R, A; alpha is never sRGB-encoded.
constexpr std::array<FormatComponent, 4> eightBits(ComponentKind kind, bool blueFirst) {
    const uint8_t red = blueFirst ? 16 : 0, blue = blueFirst ? 0 : 16;
    return {{{kind, red, 8}, {kind, 8, 8}, {kind, blue, 8}, {kind == srgb ? unorm : kind, 24, 8}}};
}

constexpr VkImageAspectFlags kColor = VK_IMAGE_ASPECT_COLOR_BIT, kDepth = VK_IMAGE_ASPECT_DEPTH_BIT;
constexpr VkImageAspectFlags kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;

#define VERNIER_FORMAT(name) VK_FORMAT_##name, #name
constexpr auto kFormats = std::to_array<SceneFormat>({
    {VERNIER_FORMAT(R8_UNORM), 1, 1, kColor, uniform(unorm, 8, 1)},
    {VERNIER_FORMAT(R8G8_UNORM), 2, 2, kColor, uniform(unorm, 8, 2)},
    {VERNIER_FORMAT(R8G8B8A8_UNORM), 4, 4, kColor, eightBits(unorm, false)},
    {VERNIER_FORMAT(R8G8B8A8_SNORM), 4, 4, kColor, eightBits(snorm, false)},
    {VERNIER_FORMAT(R8G8B8A8_UINT), 4, 4, kColor, eightBits(uint, false)},
    {VERNIER_FORMAT(R8G8B8A8_SRGB), 4, 4, kColor, eightBits(srgb, false)},
    {VERNIER_FORMAT(B8G8R8A8_UNORM), 4, 4, kColor, eightBits(unorm, true)},
    {VERNIER_FORMAT(B8G8R8A8_SRGB), 4, 4, kColor, eightBits(srgb, true)},
    {VERNIER_FORMAT(A2B10G10R10_UNORM_PACK32),
     4,
     4,
     kColor,
     {{{unorm, 0, 10}, {unorm, 10, 10}, {unorm, 20, 10}, {unorm, 30, 2}}}},
    {VERNIER_FORMAT(R5G6B5_UNORM_PACK16), 2, 3, kColor, {{{unorm, 11, 5}, {unorm, 5, 6}, {unorm, 0, 5}, {}}}},
    {VERNIER_FORMAT(R16_UNORM), 2, 1, kColor, uniform(unorm, 16, 1)},
    {VERNIER_FORMAT(R16_SFLOAT), 2, 1, kColor, uniform(sfloat, 16, 1)},
    {VERNIER_FORMAT(R16G16B16A16_UNORM), 8, 4, kColor, uniform(unorm, 16, 4)},
    {VERNIER_FORMAT(R16G16B16A16_SFLOAT), 8, 4, kColor, uniform(sfloat, 16, 4)},
    {VERNIER_FORMAT(R32_UINT), 4, 1, kColor, uniform(uint, 32, 1)},
    {VERNIER_FORMAT(R32_SINT), 4, 1, kColor, uniform(sint, 32, 1)},
    {VERNIER_FORMAT(R32_SFLOAT), 4, 1, kColor, uniform(sfloat, 32, 1)},
    {VERNIER_FORMAT(R32G32B32A32_UINT), 16, 4, kColor, uniform(uint, 32, 4)},
    {VERNIER_FORMAT(R32G32B32A32_SFLOAT), 16, 4, kColor, uniform(sfloat, 32, 4)},
    {VERNIER_FORMAT(B10G11R11_UFLOAT_PACK32),
     4,
     3,
     kColor,
     {{{ufloat, 0, 11}, {ufloat, 11, 11}, {ufloat, 22, 10}, {}}}},
    {VERNIER_FORMAT(E5B9G9R9_UFLOAT_PACK32), 4, 0, kColor, {}},
    {VERNIER_FORMAT(D16_UNORM), 2, 1, kDepth, uniform(unorm, 16, 1)},
    {VERNIER_FORMAT(X8_D24_UNORM_PACK32), 4, 1, kDepth, uniform(unorm, 24, 1)},
    {VERNIER_FORMAT(D32_SFLOAT), 4, 1, kDepth, uniform(sfloat, 32, 1)},
    {VERNIER_FORMAT(D24_UNORM_S8_UINT), 4, 1, kDepthStencil, uniform(unorm, 24, 1)},
    {VERNIER_FORMAT(D32_SFLOAT_S8_UINT), 4, 1, kDepthStencil, uniform(sfloat, 32, 1)},
    {VERNIER_FORMAT(BC1_RGB_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC1_RGBA_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC2_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC3_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC3_SRGB_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC4_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC4_SNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC5_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC5_SNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC6H_UFLOAT_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC6H_SFLOAT_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC7_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(BC7_SRGB_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ETC2_R8G8B8_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ETC2_R8G8B8A1_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ETC2_R8G8B8A8_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(EAC_R11_UNORM_BLOCK), 8, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(EAC_R11G11_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ASTC_4x4_UNORM_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ASTC_4x4_SRGB_BLOCK), 16, 0, kColor, {}, 4, 4},
    {VERNIER_FORMAT(ASTC_5x4_UNORM_BLOCK), 16, 0, kColor, {}, 5, 4},
    {VERNIER_FORMAT(ASTC_5x5_UNORM_BLOCK), 16, 0, kColor, {}, 5, 5},
    {VERNIER_FORMAT(ASTC_6x5_UNORM_BLOCK), 16, 0, kColor, {}, 6, 5},
    {VERNIER_FORMAT(ASTC_6x5_SRGB_BLOCK), 16, 0, kColor, {}, 6, 5},
    {VERNIER_FORMAT(ASTC_6x6_UNORM_BLOCK), 16, 0, kColor, {}, 6, 6},
    {VERNIER_FORMAT(ASTC_8x5_UNORM_BLOCK), 16, 0, kColor, {}, 8, 5},
    {VERNIER_FORMAT(ASTC_8x6_UNORM_BLOCK), 16, 0, kColor, {}, 8, 6},
    {VERNIER_FORMAT(ASTC_8x8_UNORM_BLOCK), 16, 0, kColor, {}, 8, 8},
    {VERNIER_FORMAT(ASTC_8x8_SRGB_BLOCK), 16, 0, kColor, {}, 8, 8},
    {VERNIER_FORMAT(ASTC_10x5_UNORM_BLOCK), 16, 0, kColor, {}, 10, 5},
    {VERNIER_FORMAT(ASTC_10x6_UNORM_BLOCK), 16, 0, kColor, {}, 10, 6},
    {VERNIER_FORMAT(ASTC_10x8_UNORM_BLOCK), 16, 0, kColor, {}, 10, 8},
    {VERNIER_FORMAT(ASTC_10x10_UNORM_BLOCK), 16, 0, kColor, {}, 10, 10},
    {VERNIER_FORMAT(ASTC_12x10_UNORM_BLOCK), 16, 0, kColor, {}, 12, 10},
    {VERNIER_FORMAT(ASTC_12x12_UNORM_BLOCK), 16, 0, kColor, {}, 12, 12},
    {VERNIER_FORMAT(ASTC_12x12_SRGB_BLOCK), 16, 0, kColor, {}, 12, 12},
});
#undef VERNIER_FORMAT

/// The bits as a two's complement number.
int64_t signedCode(uint32_t code, uint8_t bits) {
    const int64_t value = code;
    return code >> (bits - 1) != 0 ? value - (int64_t{1} << bits) : value;
}

/// A float without sign, of five bits of exponent over `mantissaBits` of mantissa (Vulkan, Unsigned 11-Bit and 10-Bit
/// Floating-Point Numbers; halves without their sign are the same with ten bits).
double unsignedFloatValue(uint32_t code, int mantissaBits) {
    const int exponent = static_cast<int>(code >> mantissaBits & 31);
    const double hidden = static_cast<double>(1u << mantissaBits),
                 mantissa = static_cast<double>(code & ((1u << mantissaBits) - 1));
    if (exponent == 31) {
        return mantissa != 0 ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
    }
    // Subnormals have no hidden bit and the exponent of the smallest normal.
    return exponent == 0 ? std::ldexp(mantissa, -14 - mantissaBits)
                         : std::ldexp(mantissa + hidden, exponent - 15 - mantissaBits);
}

double halfValue(uint32_t code) {
    return ((code & 0x8000) != 0 ? -1 : 1) * unsignedFloatValue(code & 0x7fff, 10);
}

/// Khronos Data Format Specification 1.3, 13.3 "sRGB transfer functions", from the code to linear light.
double srgbValue(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

const SceneFormat* sceneFormat(VkFormat format) {
    const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                    [format](const SceneFormat& entry) { return entry.format == format; });
    return found == kFormats.end() ? nullptr : &*found;
}

std::span<const SceneFormat> sceneFormats() {
    return kFormats;
}

uint32_t componentCode(const FormatComponent& component, std::span<const std::byte> texel) {
    // No component crosses more than four bytes: at most 32 bits, and those start at a byte.
    const size_t firstByte = component.bit / 8;
    uint64_t bits = 0;
    for (size_t i = 0; i < 5 && firstByte + i < texel.size(); ++i) {
        bits |= std::to_integer<uint64_t>(texel[firstByte + i]) << (8 * i);
    }
    return static_cast<uint32_t>(bits >> (component.bit % 8) & ((uint64_t{1} << component.bits) - 1));
}

double decodeComponent(const FormatComponent& component, uint32_t code) {
    const double unormMax = static_cast<double>((uint64_t{1} << component.bits) - 1);
    switch (component.kind) {
        case unorm:
            return code / unormMax;
        case srgb:
            return srgbValue(code / unormMax);
        case snorm: {
            const double max = static_cast<double>((uint64_t{1} << (component.bits - 1)) - 1);
            return std::max(-1.0, static_cast<double>(signedCode(code, component.bits)) / max);
        }
        case uint:
            return code;
        case sint:
            return static_cast<double>(signedCode(code, component.bits));
        case sfloat:
            return component.bits == 16 ? halfValue(code) : std::bit_cast<float>(code);
        case ufloat:
            return unsignedFloatValue(code, component.bits - 5);
    }
    return 0;
}

int64_t codePlace(const FormatComponent& component, uint32_t code) {
    switch (component.kind) {
        case unorm:
        case srgb:
        case uint:
        case ufloat:
            return code;
        case snorm: {
            // The two lowest codes both mean -1.
            const int64_t lowest = -((int64_t{1} << (component.bits - 1)) - 1);
            return std::max(lowest, signedCode(code, component.bits));
        }
        case sint:
            return signedCode(code, component.bits);
        case sfloat: {
            const uint32_t signBit = 1u << (component.bits - 1);
            const int64_t magnitude = code & (signBit - 1);
            return (code & signBit) != 0 ? -magnitude : magnitude;
        }
    }
    return 0;
}

std::optional<uint32_t> codeAtPlace(const FormatComponent& component, int64_t place) {
    const int64_t all = int64_t{1} << component.bits, half = all / 2;
    const auto within = [place](int64_t low, int64_t high) { return place >= low && place <= high; };
    switch (component.kind) {
        case unorm:
        case srgb:
        case uint:
            return within(0, all - 1) ? std::optional(static_cast<uint32_t>(place)) : std::nullopt;
        case snorm:
        case sint: {
            const int64_t lowest = component.kind == snorm ? 1 - half : -half;
            if (!within(lowest, half - 1)) return std::nullopt;
            return static_cast<uint32_t>(static_cast<uint64_t>(place) & static_cast<uint64_t>(all - 1));
        }
        case sfloat: {
            const int64_t infinity = component.bits == 16 ? 0x7c00 : 0x7f800000;
            if (!within(-infinity, infinity)) return std::nullopt;
            return static_cast<uint32_t>(place < 0 ? half - place : place);
        }
        case ufloat:
            return within(0, int64_t{31} << (component.bits - 5)) ? std::optional(static_cast<uint32_t>(place))
                                                                  : std::nullopt;
    }
    return std::nullopt;
}

bool isNan(const FormatComponent& component, uint32_t code) {
    return (component.kind == sfloat || component.kind == ufloat) && std::isnan(decodeComponent(component, code));
}

}  // namespace vernier::conformance
