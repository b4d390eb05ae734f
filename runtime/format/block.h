// Block compression: formats whose texels are stored in blocks, each decoded by itself (Khronos Data Format
// Specification 1.3, chapters 18 to 24).
//
// A decoder turns a block into texels of an uncompressed format that holds its results exactly, so that everything
// behind it (conversion, sRGB, filtering) is that of ordinary texels:
//   BC1, BC2, BC3    floats: the nearest to the real-valued formulas of the specification; sRGB is decoded from the
//                    interpolated real values
//   BC4, BC5         floats, likewise
//   BC6H             half floats, to the bit; reserved modes give (0, 0, 0, 1)
//   BC7              8-bit codes, to the bit; the reserved mode gives (0, 0, 0, 0)
//   ETC2             8-bit codes, to the bit
//   EAC R11, RG11    floats: the nearest to the 11-bit codes divided by 2047 (1023 if signed)
//   ASTC LDR         half floats rounded towards zero, as the specification asks for; sRGB: floats decoded from 8-bit
//                    codes, A as without sRGB; error blocks, HDR endpoints and HDR void extents give opaque magenta
// Every sequence of bits decodes to something; nothing outside the block is read.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>

namespace vernier {

inline constexpr uint32_t kMaxBlockTexels = 12 * 12;
inline constexpr uint32_t kMaxDecodedBytes = 16;  // of one texel

/// Plain data, valid forever.
struct BlockCodec {
    uint8_t width, height;  // texels
    uint8_t bytes;          // of a block
    VkFormat decoded;       // an uncompressed format of the table
    /// Writes width * height texels of the format `decoded`, row by row, tightly packed.
    void (*decode)(const std::byte* block, void* texels);
};

#define VERNIER_DECODER(name) void name(const std::byte* block, void* texels)
VERNIER_DECODER(decodeBc1Rgb);
VERNIER_DECODER(decodeBc1RgbSrgb);
VERNIER_DECODER(decodeBc1Rgba);
VERNIER_DECODER(decodeBc1RgbaSrgb);
VERNIER_DECODER(decodeBc2);
VERNIER_DECODER(decodeBc2Srgb);
VERNIER_DECODER(decodeBc3);
VERNIER_DECODER(decodeBc3Srgb);
VERNIER_DECODER(decodeBc4Unorm);
VERNIER_DECODER(decodeBc4Snorm);
VERNIER_DECODER(decodeBc5Unorm);
VERNIER_DECODER(decodeBc5Snorm);
VERNIER_DECODER(decodeBc6Ufloat);
VERNIER_DECODER(decodeBc6Sfloat);
VERNIER_DECODER(decodeBc7);
VERNIER_DECODER(decodeEtc2Rgb);
VERNIER_DECODER(decodeEtc2RgbA1);
VERNIER_DECODER(decodeEtc2Rgba);
VERNIER_DECODER(decodeEacR11Unorm);
VERNIER_DECODER(decodeEacR11Snorm);
VERNIER_DECODER(decodeEacRg11Unorm);
VERNIER_DECODER(decodeEacRg11Snorm);
#undef VERNIER_DECODER

/// `texels`: half floats, or with kSrgb floats, of R, G, B, A.
template <int kWidth, int kHeight, bool kSrgb>
void decodeAstc(const std::byte* block, void* texels);

/// The footprints of ASTC in the order of the format numbers: X(width, height).
#define VERNIER_ASTC_FOOTPRINTS(X) \
    X(4, 4)                        \
    X(5, 4)                        \
    X(5, 5)                        \
    X(6, 5)                        \
    X(6, 6)                        \
    X(8, 5)                        \
    X(8, 6)                        \
    X(8, 8)                        \
    X(10, 5)                       \
    X(10, 6)                       \
    X(10, 8)                       \
    X(10, 10)                      \
    X(12, 10)                      \
    X(12, 12)

}  // namespace vernier
