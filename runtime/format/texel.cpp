// One texel at a time, and copies of single aspects.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "runtime/format/convert.h"
#include "runtime/format/format.h"

namespace vernier {
namespace {

/// A texel as little-endian 32-bit words. No component crosses a word.
using Words = std::array<uint32_t, 4>;

Words loadWords(const TexelLayout& layout, const void* texel) {
    Words words{};
    std::memcpy(words.data(), texel, layout.bytes);
    return words;
}

uint32_t extract(const Words& words, const Component& component) {
    return words[component.offset / 32] >> component.offset % 32 & lowBits(component.bits);
}

void insert(Words& words, const Component& component, uint32_t code) {
    uint32_t& word = words[component.offset / 32];
    const uint32_t mask = lowBits(component.bits) << component.offset % 32;
    word = (word & ~mask) | (code << component.offset % 32 & mask);
}

/// The 32 bits of a plane's value.
uint32_t decode(const Component& component, uint32_t code) {
    const uint32_t bits = component.bits;
    switch (component.kind) {
        case ComponentKind::unorm:
            return std::bit_cast<uint32_t>(decodeUnorm(code, bits));
        case ComponentKind::snorm:
            return std::bit_cast<uint32_t>(decodeSnorm(code, bits));
        case ComponentKind::uscaled:
            return std::bit_cast<uint32_t>(static_cast<float>(code));
        case ComponentKind::sscaled:
            return std::bit_cast<uint32_t>(static_cast<float>(signExtend(code, bits)));
        case ComponentKind::uint:
            return code;
        case ComponentKind::sint:
            return static_cast<uint32_t>(signExtend(code, bits));
        case ComponentKind::ufloat:
            return std::bit_cast<uint32_t>(decodeUfloat(code, bits));
        case ComponentKind::sfloat:
            return bits == 32 ? code : std::bit_cast<uint32_t>(decodeHalf(code));
        case ComponentKind::srgb:
            return std::bit_cast<uint32_t>(kSrgbToLinear[code]);
        case ComponentKind::none:
            break;
    }
    return 0;
}

uint32_t encode(const Component& component, uint32_t value) {
    const uint32_t bits = component.bits;
    const auto real = std::bit_cast<float>(value);
    switch (component.kind) {
        case ComponentKind::unorm:
            return encodeUnorm(real, bits);
        case ComponentKind::snorm:
            return encodeSnorm(real, bits);
        case ComponentKind::uscaled:
            return encodeUscaled(real, bits);
        case ComponentKind::sscaled:
            return encodeSscaled(real, bits);
        case ComponentKind::uint:
            return encodeUint(value, bits);
        case ComponentKind::sint:
            return encodeSint(static_cast<int32_t>(value), bits);
        case ComponentKind::ufloat:
            return encodeUfloat(real, bits);
        case ComponentKind::sfloat:
            return bits == 32 ? value : encodeHalf(real);
        case ComponentKind::srgb:
            return encodeSrgb8(real);
        case ComponentKind::none:
            break;
    }
    return 0;
}

// "Conversion from RGB to shared exponent" of the Vulkan specification: N = 9 mantissa bits, B = 15.
constexpr int kSharedMantissa = 9, kSharedBias = 15;
constexpr float kSharedMax = 65408.0f;  // (2^N - 1) / 2^N * 2^(31 - B)

/// 2^exponent for exponents of normal floats.
float exp2i(int exponent) {
    return std::bit_cast<float>(static_cast<uint32_t>(exponent + 127) << 23);
}

uint32_t encodeSharedExponent(const float (&rgb)[4]) {
    float clamped[3];
    for (int c = 0; c < 3; ++c) clamped[c] = clampOrLow(rgb[c], 0.0f, kSharedMax);
    const float largest = std::max({clamped[0], clamped[1], clamped[2]});
    const int log2Floor = static_cast<int>(std::bit_cast<uint32_t>(largest) >> 23) - 127;  // denormals end far below
    int exponent = std::max(-kSharedBias - 1, log2Floor) + 1 + kSharedBias;
    // floor(x / 2^(exponent - B - N) + 0.5), exact in double; the cast truncates.
    const auto scaled = [&](float x) {
        return static_cast<uint32_t>(double{x} * double{exp2i(kSharedBias + kSharedMantissa - exponent)} + 0.5);
    };
    if (scaled(largest) == 1u << kSharedMantissa) ++exponent;
    return scaled(clamped[0]) | scaled(clamped[1]) << 9 | scaled(clamped[2]) << 18 |
           static_cast<uint32_t>(exponent) << 27;
}

float decodeSharedExponent(uint32_t fraction, uint32_t word) {
    return static_cast<float>(fraction) * exp2i(static_cast<int>(word >> 27) - kSharedBias - kSharedMantissa);
}

}  // namespace

VkClearColorValue unpackTexel(const TexelLayout& layout, const void* texel) {
    const Words words = loadWords(layout, texel);
    VkClearColorValue value{};
    if (layout.type == ValueType::floating) {
        value.float32[3] = 1.0f;
    } else {
        value.uint32[3] = 1;
    }
    for (int c = 0; c < 4; ++c) {
        const Component& component = layout.rgba[c];
        if (component.bits == 0) continue;
        const uint32_t code = extract(words, component);
        if (layout.sharedExponent) {
            value.float32[c] = decodeSharedExponent(code, words[0]);
        } else {
            value.uint32[c] = decode(component, code);
        }
    }
    return value;
}

void packTexel(const TexelLayout& layout, const VkClearColorValue& value, void* texel) {
    Words words = layout.keepOtherBits ? loadWords(layout, texel) : Words{};
    if (layout.sharedExponent) {
        words[0] = encodeSharedExponent(value.float32);
    } else {
        for (int c = 0; c < 4; ++c) {
            const Component& component = layout.rgba[c];
            if (component.bits != 0) insert(words, component, encode(component, value.uint32[c]));
        }
    }
    std::memcpy(texel, words.data(), layout.bytes);
}

void packClear(const FormatInfo& info, VkImageAspectFlags aspects, const VkClearValue& value, void* texel) {
    if ((info.aspects & aspects & VK_IMAGE_ASPECT_COLOR_BIT) != 0) packTexel(info.color, value.color, texel);
    VkClearColorValue part{};
    if ((info.aspects & aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0) {
        part.float32[0] = value.depthStencil.depth;
        packTexel(info.depth, part, texel);
    }
    if ((info.aspects & aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) {
        // "The s least significant bits", not a clamp.
        part.uint32[0] = value.depthStencil.stencil & lowBits(info.stencil.rgba[0].bits);
        packTexel(info.stencil, part, texel);
    }
}

void componentBits(const FormatInfo& info, VkColorComponentFlags mask, void* bits) {
    Words words{};
    for (int c = 0; c < 4; ++c) {
        const Component& component = info.color.rgba[c];
        if (component.bits != 0 && (mask & VK_COLOR_COMPONENT_R_BIT << c) != 0) insert(words, component, ~0u);
    }
    if (info.color.sharedExponent && mask != 0) words[0] |= 31u << 27;
    std::memcpy(bits, words.data(), info.bytesPerTexel);
}

void FormatOps::unpackEach(const std::byte* const* texels, size_t n, void* const planes[4]) const {
    constexpr size_t kChunk = 64;
    std::byte packed[kChunk * 16];
    const size_t bytes = layout.bytes;
    for (size_t first = 0; first < n; first += kChunk) {
        const size_t count = std::min(kChunk, n - first);
        const auto collect = [&]<size_t kBytes>(std::integral_constant<size_t, kBytes>) {
            for (size_t i = 0; i < count; ++i) std::memcpy(packed + i * kBytes, texels[first + i], kBytes);
        };
        switch (bytes) {
            case 1:
                collect(std::integral_constant<size_t, 1>{});
                break;
            case 2:
                collect(std::integral_constant<size_t, 2>{});
                break;
            case 3:
                collect(std::integral_constant<size_t, 3>{});
                break;
            case 4:
                collect(std::integral_constant<size_t, 4>{});
                break;
            case 6:
                collect(std::integral_constant<size_t, 6>{});
                break;
            case 8:
                collect(std::integral_constant<size_t, 8>{});
                break;
            case 12:
                collect(std::integral_constant<size_t, 12>{});
                break;
            default:
                collect(std::integral_constant<size_t, 16>{});
                break;
        }
        void* part[4];
        for (int c = 0; c < 4; ++c) {
            part[c] = planes[c] == nullptr ? nullptr : static_cast<std::byte*>(planes[c]) + first * sizeof(uint32_t);
        }
        unpack(packed, count, part);
    }
}

uint32_t bufferTexelBytes(const FormatInfo& info, VkImageAspectFlags aspect) {
    if (aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return 1;
    if (aspect == VK_IMAGE_ASPECT_DEPTH_BIT) return info.depth.rgba[0].bits == 16 ? 2 : 4;
    return info.bytesPerTexel;
}

void copyTexelsToBuffer(const FormatInfo& info, VkImageAspectFlags aspect, const void* texels, size_t n, void* buffer) {
    const TexelLayout& layout = info.layout(aspect);
    const uint32_t bufferBytes = bufferTexelBytes(info, aspect);
    const bool partOfTexel = layout.keepOtherBits || info.format == VK_FORMAT_X8_D24_UNORM_PACK32;
    if (!partOfTexel) {
        std::memcpy(buffer, texels, n * bufferBytes);
        return;
    }
    for (size_t i = 0; i < n; ++i) {
        const uint32_t code =
            extract(loadWords(layout, static_cast<const std::byte*>(texels) + i * layout.bytes), layout.rgba[0]);
        std::memcpy(static_cast<std::byte*>(buffer) + i * bufferBytes, &code, bufferBytes);
    }
}

void copyTexelsFromBuffer(const FormatInfo& info, VkImageAspectFlags aspect, const void* buffer, size_t n,
                          void* texels) {
    const TexelLayout& layout = info.layout(aspect);
    const uint32_t bufferBytes = bufferTexelBytes(info, aspect);
    if (!layout.keepOtherBits) {
        std::memcpy(texels, buffer, n * bufferBytes);
        return;
    }
    for (size_t i = 0; i < n; ++i) {
        std::byte* const texel = static_cast<std::byte*>(texels) + i * layout.bytes;
        uint32_t code = 0;
        std::memcpy(&code, static_cast<const std::byte*>(buffer) + i * bufferBytes, bufferBytes);
        Words words = loadWords(layout, texel);
        insert(words, layout.rgba[0], code);
        std::memcpy(texel, words.data(), layout.bytes);
    }
}

}  // namespace vernier
