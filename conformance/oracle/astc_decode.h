// ASTC texels as the Khronos Data Format Specification (1.3, "ASTC Compressed Texture Image Formats") decodes them in
// LDR mode: integers all the way to the 16 bits that "Weight Application" ends with. Error blocks, HDR end points and
// HDR void extents are opaque magenta.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vernier::conformance::exact {

/// The texel at (x, y) of a block of `width` x `height` texels, stored in 16 bytes: RGBA as UNORM16 before the last
/// conversion. `srgb` chooses how R, G and B of end points become 16 bits.
std::array<uint32_t, 4> astcTexel(std::span<const std::byte> block, uint32_t width, uint32_t height, uint32_t x,
                                  uint32_t y, bool srgb);

/// What becomes of a UNORM16 component in the decoding mode decode_float16: C / 65536 rounded towards zero to a half
/// float, and 1 for 65535.
double astcHalf(uint32_t component);

}  // namespace vernier::conformance::exact
