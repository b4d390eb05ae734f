// Bounds on the stored depth of each block of a tile, so that blocks of hidden primitives are dropped without being
// read. The bounds are conservative: with and without them, images are the same.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/plan/plan.h"
#include "runtime/raster/coverage.h"

namespace vernier {

class CoarseDepth {
  public:
    /// Nothing is known about the tile.
    void forget();
    /// The whole tile was cleared to this.
    void setCleared(DepthStorage storage, float depth);

    /// Removes the blocks in which no sample of the primitive can pass; returns how many are left, in order. Bit
    /// blockIndex() of `certain`: every sample of the block passes.
    uint32_t reject(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY, uint32_t samples,
                    BlockCoverage* blocks, uint32_t count, uint64_t& certain) const;
    /// After a depth test that wrote where `blocks` have bits.
    void update(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY, uint32_t samples,
                const BlockCoverage* blocks, uint32_t count);

    /// After a depth test that wrote to pixels of these blocks, bit blockIndex() each.
    void updateParts(const DepthPlan& plan, uint64_t blocks);

  private:
    struct Bounds {
        float low, high;
    };
    std::array<Bounds, kBlocksPerTile> blocks_;
    bool known_ = false;  // of any block
};

}  // namespace vernier
