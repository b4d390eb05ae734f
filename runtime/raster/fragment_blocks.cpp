// Blocks that are run at once; and parts of blocks that wait for the rest: the two triangles of a rectangle, and
// neighbours in a mesh, share the blocks along their common edge, and most of these are then run once.
#include <algorithm>
#include <bit>

#include "runtime/raster/bits.h"
#include "runtime/raster/fragment_stage.h"

namespace vernier {
namespace {

/// Lanes of a block that is run at once, at most.
constexpr uint32_t kBlockLanes = kBlockSize * kBlockSize;

constexpr uint32_t kBlocksPerRow = kTileSize / kBlockSize;

int32_t leftOf(uint32_t block) {
    return static_cast<int32_t>(block % kBlocksPerRow) * kBlockSize;
}
int32_t topOf(uint32_t block) {
    return static_cast<int32_t>(block / kBlocksPerRow) * kBlockSize;
}

}  // namespace

void FragmentStage::placeBlock() {
    placeLanes_(block_);
    if (!block_.partial) {
        std::fill_n(block_.store.begin(), block_.count, ~0u);
        std::fill_n(block_.coverage.begin(), block_.count, (1u << samples_) - 1);
        return;
    }
    std::fill_n(block_.coverage.begin(), block_.count, 0);
    for (uint32_t s = 0; s < samples_; ++s) {
        spreadPixels_(blockPixels(s), block_.order, block_.count, mask_.data());
        for (uint32_t lane = 0; lane < block_.count; ++lane) block_.coverage[lane] |= mask_[lane] & 1u << s;
    }
}

/// Pixels of a block, of the primitives in the segments of block_ and with the samples in blockMasks_: shaded and
/// written without being collected. `x` and `y` are in the tile.
void FragmentStage::runBlock(int32_t x, int32_t y, uint64_t pixels) {
    uint64_t running = pixels;
    if (plan_->usesQuads) {
        const uint64_t quads = quadsOf(pixels);
        running = quads | quads << 1 | quads << 8 | quads << 9;
    }
    uint64_t all = ~uint64_t{0};
    for (uint32_t s = 0; s < samples_; ++s) all &= blockMasks_[s];
    block_.originX = tileX_ + x;
    // Pairs of rows that have something covered.
    const uint32_t firstRow = static_cast<uint32_t>(std::countr_zero(pixels)) / 16 * 2;
    const uint32_t endRow = (static_cast<uint32_t>(63 - std::countl_zero(pixels)) / 16 + 1) * 2;
    const uint32_t most = std::min(capacity_, kBlockLanes) / static_cast<uint32_t>(kBlockSize);
    for (uint32_t row = firstRow; row < endRow; row += most) {
        const uint32_t lanes = std::min(most, endRow - row) * static_cast<uint32_t>(kBlockSize);
        block_.originY = tileY_ + y + static_cast<int32_t>(row);
        blockShift_ = 8 * row;
        blockRectangle_ = ~uint64_t{0} >> (64 - lanes);
        const uint64_t stored = pixels >> blockShift_ & blockRectangle_;
        if (stored == 0) continue;
        block_.count = lanes;
        for (uint32_t s = 0; s < block_.segmentCount; ++s) {
            block_.segments[s].first = 0;
            block_.segments[s].count = lanes;
        }
        if (block_.segmentCount > 1)
            spreadPixels_(secondPixels_ >> blockShift_ & blockRectangle_, block_.order, lanes, block_.second.data());
        block_.partial = (all >> blockShift_ & blockRectangle_) != blockRectangle_;
        if (block_.partial) {
            const uint64_t run = running >> blockShift_ & blockRectangle_;
            block_.running = countBits(run);
            spreadPixels_(stored, block_.order, lanes, block_.store.data());
            spreadPixels_(run, block_.order, lanes, block_.execute.data());
        }
        if (readsPixels_) placeBlock();
        run(block_);
    }
}

/// Pixels of the current primitive, in a block of which nothing waits.
void FragmentStage::hold(uint32_t block, uint64_t pixels) {
    held_[block].pixels = pixels;
    held_[block].planes = planes_[planesCount_ - 1];
    heldBlocks_ |= uint64_t{1} << block;
}

void FragmentStage::runHeld(uint32_t block) {
    heldBlocks_ &= ~(uint64_t{1} << block);
    block_.segments[0].planes = &held_[block].planes;
    blockMasks_[0] = held_[block].pixels;
    runBlock(leftOf(block), topOf(block), held_[block].pixels);
}

/// Together with pixels of the current primitive, others than those that wait.
void FragmentStage::runWithHeld(uint32_t block, uint64_t pixels) {
    heldBlocks_ &= ~(uint64_t{1} << block);
    block_.segments[0].planes = &held_[block].planes;
    block_.segments[1].planes = &planes_[planesCount_ - 1];
    block_.segmentCount = 2;
    secondPixels_ = pixels;
    blockMasks_[0] = held_[block].pixels | pixels;
    runBlock(leftOf(block), topOf(block), blockMasks_[0]);
    block_.segmentCount = 1;
}

}  // namespace vernier
