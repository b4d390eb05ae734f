// Decoding texels of BC6H and BC7 as the Khronos Data Format Specification says (1.3, "BPTC"): its arithmetic is of
// integers, and every result is exact.
#pragma once

#include "conformance/oracle/interval.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vernier::conformance::exact {

/// The texel `texel`, 0..15 by rows, of a block of BC7 of 16 bytes, in UNORM codes of eight bits over 255.
Color bc7Texel(std::span<const std::byte> block, uint32_t texel);

/// The same of BC6H: half floats, alpha 1.
Color bc6hTexel(std::span<const std::byte> block, uint32_t texel, bool isSigned);

}  // namespace vernier::conformance::exact
