#include "runtime/raster/coarse_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/raster/depth_range.h"

namespace vernier {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr uint32_t kLess = 1, kGreater = 4, kAlways = 7;  // bits of DepthPlan::compare

}  // namespace

void CoarseDepth::forget() {
    known_ = false;
    blocks_.fill({-kInfinity, kInfinity});
}

void CoarseDepth::setCleared(DepthStorage storage, float depth) {
    const DepthRange range = clearedDepths(storage, depth);
    known_ = true;
    blocks_.fill({static_cast<float>(range.low), static_cast<float>(range.high)});
}

uint32_t CoarseDepth::reject(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY,
                             uint32_t samples, BlockCoverage* blocks, uint32_t count, uint64_t& certain) const {
    certain = plan.compare == kAlways ? ~uint64_t{0} : 0;
    if (!known_ || plan.compare == kAlways || plan.compare == 0 || plan.compare == (kLess | kGreater)) return count;
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        const uint32_t index = blockIndex(blocks[b]);
        const Bounds& stored = blocks_[index];
        const DepthRange range = blockDepths(plan.storage, planes, tileX + blocks[b].x, tileY + blocks[b].y);
        const bool above = range.low > double{stored.high}, below = range.high < double{stored.low};
        if (((plan.compare & kGreater) == 0 && above) || ((plan.compare & kLess) == 0 && below)) continue;
        if (above || below) certain |= uint64_t{1} << index;
        moveBlock(blocks, b, kept++, samples);
    }
    return kept;
}

void CoarseDepth::update(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY,
                         uint32_t samples, const BlockCoverage* blocks, uint32_t count) {
    for (uint32_t b = 0; b < count; ++b) {
        Bounds& stored = blocks_[blockIndex(blocks[b])];
        uint64_t all = ~uint64_t{0};
        for (uint32_t s = 0; s < samples; ++s) all &= blocks[b].masks[s];
        if (all == ~uint64_t{0}) {
            const DepthRange range = blockDepths(plan.storage, planes, tileX + blocks[b].x, tileY + blocks[b].y);
            stored = {std::nextafter(static_cast<float>(range.low), -kInfinity),
                      std::nextafter(static_cast<float>(range.high), kInfinity)};
            known_ = true;
        } else {
            updateParts(plan, uint64_t{1} << blockIndex(blocks[b]));
        }
    }
}

void CoarseDepth::updateParts(const DepthPlan& plan, uint64_t blocks) {
    // What passes a less-than test only lowers depths: the upper bound holds, the lower one is lost.
    for (; blocks != 0; blocks &= blocks - 1) {
        Bounds& stored = blocks_[static_cast<uint32_t>(std::countr_zero(blocks))];
        if ((plan.compare & kLess) != 0) stored.low = -kInfinity;
        if ((plan.compare & kGreater) != 0) stored.high = kInfinity;
    }
}

}  // namespace vernier
