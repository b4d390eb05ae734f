// Masks of the pixels of a block: counting bits without an instruction that the baseline lacks, and rectangles.
#pragma once

#include <algorithm>
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

/// Bit y * 8 + x for the pixels [x0, x1) x [y0, y1) of a block of 8x8; parts outside are left out.
inline uint64_t rectangleBits(int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
    x0 = std::max(x0, 0);
    y0 = std::max(y0, 0);
    x1 = std::min(x1, 8);
    y1 = std::min(y1, 8);
    if (x0 >= x1 || y0 >= y1) return 0;
    const uint64_t row = (0xFFu >> (8 - x1)) & (0xFFu << x0);
    const uint64_t rows = (~uint64_t{0} >> (8 * (8 - y1))) & (~uint64_t{0} << (8 * y0));
    return rows & (row * 0x0101010101010101u);
}

/// The upper left pixels of the quads of a block that have some of `pixels`.
inline uint64_t quadsOf(uint64_t pixels) {
    constexpr uint64_t kQuadOrigins = 0x0055005500550055;
    const uint64_t pairs = pixels | pixels >> 1;
    return (pairs | pairs >> 8) & kQuadOrigins;
}

}  // namespace vernier
