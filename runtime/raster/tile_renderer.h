// Renders the primitives of one tile, in order. One per thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/geometry/chunk.h"
#include "runtime/geometry/primitive_setup.h"
#include "runtime/raster/coarse_depth.h"
#include "runtime/raster/fragment_stage.h"

namespace vernier {

/// vkCmdClearAttachments.
struct ClearCommand {
    VkImageAspectFlags aspects = 0;
    uint32_t color = 0;
    VkClearValue value{};
    PixelRect rect;
    uint32_t firstLayer = 0, layers = 1;
    bool clears(uint32_t layer) const { return layer - firstLayer < layers; }
};

/// What a tile has to do, in order: a run of a chunk's entries, or a clear.
struct TileWork {
    const Chunk* chunk = nullptr;
    const ClearCommand* clear = nullptr;
    uint32_t first = 0, count = 0;
    uint32_t segment = 0;  // of the pass: what is counted apart
    bool large = false;    // as in TileRange
};

class TileRenderer {
  public:
    FragmentStage& fragments() { return fragments_; }
    void startPass(const PassTargets& targets);
    /// `rect`: the pixels of the tile inside the render area; `layer`: where it lies. `cleared`: all depth in it was
    /// just cleared by the load operation. `token`: see Assembler::run. Work before entry `firstEntry` of
    /// work[firstItem] is left out. What is counted is added to `counts`, by segment.
    void render(const PixelRect& rect, uint32_t layer, int32_t tileX, int32_t tileY, bool cleared,
                std::span<const PreparedDraw> draws, uint64_t token, std::span<const TileWork> work, size_t firstItem,
                uint32_t firstEntry, std::span<PassStatistics> counts);

  private:
    void draw(const Primitive& primitive, const Chunk& chunk, const PreparedDraw& draw, bool coversTile);
    void flushSmall();
    void finishSegment(PassStatistics& counts);
    void drawSmall(const PreparedDraw& draw, uint32_t count);
    uint32_t rejectEarly(const PreparedDraw& draw, const TrianglePlanes& planes, uint32_t count);
    uint32_t testEarly(const PreparedDraw& draw, const TrianglePlanes& planes, uint32_t count);

    void selectLayer(uint32_t layer);

    const PassTargets* pass_ = nullptr;
    const PassTargets* targets_ = nullptr;  // pass_, or layerTargets_
    PassTargets layerTargets_;              // the attachments from layer_ on, where that is not 0
    uint32_t layer_ = 0;
    int32_t tileX_ = 0, tileY_ = 0;
    FragmentStage fragments_;
    CoarseDepth coarse_;
    std::array<BlockCoverage, kBlocksPerTile> blocks_;
    // Small primitives of one draw that wait for others, and where they come from.
    SmallInput waiting_{};
    std::array<const Chunk*, kSmallGroup> waitingChunks_{};
    const PreparedDraw* waitingDraw_ = nullptr;
    SmallGroup group_;  // those that are drawn
    std::array<SmallFragment, kSmallFragments + kSmallGroup> smallFragments_{};
    std::array<uint64_t, kBlocksPerTile> collected_{};  // pixels in smallFragments_ whose depth is to be tested
    uint64_t blocksCollected_ = 0;                      // blocks that have some
};

/// Applies a clear to the part of it inside `area`, in the first layer of the targets.
void applyClear(const PassTargets& targets, const ClearCommand& clear, const PixelRect& area);

}  // namespace vernier
