// Decoding block-compressed texels as the Khronos Data Format Specification says (1.3, "S3TC", "RGTC", "BPTC", "ETC2",
// "ASTC"), texel by texel: exact where its arithmetic is of integers (BC6H, BC7, ETC2, EAC, ASTC), permitted intervals
// where it leaves the precision of interpolated colours open (BC1 to BC5).
#pragma once

#include "conformance/oracle/interval.h"

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vernier::conformance::exact {

/// Whether decodeBlockTexel() knows the format.
bool isDecodedBlockFormat(VkFormat format);

/// Bytes of a block.
uint32_t blockBytes(VkFormat format);

/// Texels of a block.
VkExtent2D blockExtent(VkFormat format);

/// The texel at (x, y), within blockExtent(), of one block; sRGB formats are decoded to linear light. Channels that the
/// format lacks are 0, alpha is 1. For formats that isDecodedBlockFormat().
Color decodeBlockTexel(VkFormat format, std::span<const std::byte> block, uint32_t x, uint32_t y);

}  // namespace vernier::conformance::exact
