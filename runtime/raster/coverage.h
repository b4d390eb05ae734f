// Exact coverage of a tile by a primitive, in blocks of 8x8 pixels.
#pragma once

#include <array>
#include <cstdint>

#include "base/simd.h"
#include "runtime/raster/triangle_planes.h"

namespace vernier {

inline constexpr uint32_t kBlocksPerTile = (kTileSize / kBlockSize) * (kTileSize / kBlockSize);

/// Of the samples that the draw has; the others are not set. Bit y * 8 + x of mask s: pixel (x, y) of a block at sample
/// s.
using SampleMasks = std::array<uint64_t, kMaxSamples>;

struct BlockCoverage {
    int32_t x, y;  // first pixel of the block, relative to the tile
    SampleMasks masks;
};

/// The number of a block in its tile, row by row.
inline uint32_t blockIndex(const BlockCoverage& block) {
    return static_cast<uint32_t>(block.y / kBlockSize * (kTileSize / kBlockSize) + block.x / kBlockSize);
}

/// Moves a block forward in its array.
inline void moveBlock(BlockCoverage* blocks, uint32_t from, uint32_t to, uint32_t samples) {
    if (from == to) return;
    blocks[to].x = blocks[from].x;
    blocks[to].y = blocks[from].y;
    for (uint32_t s = 0; s < samples; ++s) blocks[to].masks[s] = blocks[from].masks[s];
}

/// Writes the blocks that have something covered, row by row; returns how many.
using CoverTileFn = uint32_t (*)(const TileEdges& edges, BlockCoverage* blocks);
CoverTileFn coverTileFunction(Isa isa);

/// The same for a primitive that is `tiny`, of a draw with one sample.
struct TinyInput {
    const Primitive* primitive;
    int32_t tileX, tileY;
    uint32_t subPixelBits;  // at most kTinySubPixelBits
    SamplePosition position;
};
using CoverTinyFn = uint32_t (*)(const TinyInput& input, BlockCoverage* blocks);
CoverTinyFn coverTinyFunction(Isa isa);

/// All blocks of a tile, completely covered.
uint32_t coverWholeTile(uint32_t samples, BlockCoverage* blocks);

}  // namespace vernier
