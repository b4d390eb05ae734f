// Counting bits without an instruction that the baseline lacks.
#pragma once

#include <cstdint>

namespace vernier {

/// Pairs, nibbles, bytes, then all bytes summed by one multiplication.
constexpr uint32_t countBits(uint64_t v) {
    v -= v >> 1 & 0x5555555555555555u;
    v = (v & 0x3333333333333333u) + (v >> 2 & 0x3333333333333333u);
    v = (v + (v >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
    return static_cast<uint32_t>(v * 0x0101010101010101u >> 56);
}
static_assert(countBits(~uint64_t{0}) == 64 && countBits(0x8000000000000001u) == 2);

}  // namespace vernier
