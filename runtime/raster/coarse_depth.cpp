#include "runtime/raster/coarse_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vernier {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

size_t indexOf(const BlockCoverage& block) {
    return static_cast<size_t>(block.y / kBlockSize * (kTileSize / kBlockSize) + block.x / kBlockSize);
}

/// What conversion to the format may move a depth by.
double quantum(DepthStorage storage) {
    switch (storage) {
        case DepthStorage::d16:
            return 1.0 / 65535;
        case DepthStorage::d24:
            return 1.0 / 16777215;
        default:
            return 0;
    }
}

struct Range {
    double low, high;
};

/// The depths that the primitive can have in a block, stored: the plane at the block's corners, widened by the rounding
/// of its evaluation (three float operations on terms of this size, with room to spare) and of the format.
Range depthRange(const DepthPlan& plan, const TrianglePlanes& p, int32_t x, int32_t y) {
    const double dx0 = static_cast<double>(x - p.anchorX) - double{p.fractionX}, dx1 = dx0 + kBlockSize;
    const double dy0 = static_cast<double>(y - p.anchorY) - double{p.fractionY}, dy1 = dy0 + kBlockSize;
    const double x0 = p.d.zx * dx0, x1 = p.d.zx * dx1, y0 = p.d.zy * dy0, y1 = p.d.zy * dy1;
    const double size =
        std::fabs(p.d.z0) + std::max(std::fabs(x0), std::fabs(x1)) + std::max(std::fabs(y0), std::fabs(y1));
    const double margin = size * 0x1p-20 + quantum(plan.storage);
    const auto clamped = [&](double z) { return std::clamp(z, double{p.zLow}, double{p.zHigh}); };
    // Clamping comes before rounding to the format.
    return {clamped(p.d.z0 + std::min(x0, x1) + std::min(y0, y1) - margin) - quantum(plan.storage),
            clamped(p.d.z0 + std::max(x0, x1) + std::max(y0, y1) + margin) + quantum(plan.storage)};
}

constexpr uint32_t kLess = 1, kGreater = 4;  // bits of DepthPlan::compare

}  // namespace

void CoarseDepth::forget() {
    known_ = false;
    blocks_.fill({-kInfinity, kInfinity});
}

void CoarseDepth::setCleared(DepthStorage storage, float depth) {
    const auto step = static_cast<float>(quantum(storage));
    known_ = true;
    blocks_.fill({depth - step, depth + step});
}

uint32_t CoarseDepth::reject(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY,
                             uint32_t samples, BlockCoverage* blocks, uint32_t count) const {
    if (!known_ || plan.compare == 7 || plan.compare == 0 || plan.compare == (kLess | kGreater)) return count;
    uint32_t kept = 0;
    for (uint32_t b = 0; b < count; ++b) {
        const Bounds& stored = blocks_[indexOf(blocks[b])];
        const Range range = depthRange(plan, planes, tileX + blocks[b].x, tileY + blocks[b].y);
        const bool hidden = ((plan.compare & kGreater) == 0 && range.low > double{stored.high}) ||
                            ((plan.compare & kLess) == 0 && range.high < double{stored.low});
        if (hidden) continue;
        moveBlock(blocks, b, kept++, samples);
    }
    return kept;
}

void CoarseDepth::update(const DepthPlan& plan, const TrianglePlanes& planes, int32_t tileX, int32_t tileY,
                         uint32_t samples, const BlockCoverage* blocks, uint32_t count) {
    for (uint32_t b = 0; b < count; ++b) {
        Bounds& stored = blocks_[indexOf(blocks[b])];
        uint64_t all = ~uint64_t{0};
        for (uint32_t s = 0; s < samples; ++s) all &= blocks[b].masks[s];
        if (all == ~uint64_t{0}) {
            const Range range = depthRange(plan, planes, tileX + blocks[b].x, tileY + blocks[b].y);
            stored = {std::nextafter(static_cast<float>(range.low), -kInfinity),
                      std::nextafter(static_cast<float>(range.high), kInfinity)};
            known_ = true;
        } else {
            // What passes a less-than test only lowers depths: the upper bound holds, the lower one is lost.
            if ((plan.compare & kLess) != 0) stored.low = -kInfinity;
            if ((plan.compare & kGreater) != 0) stored.high = kInfinity;
        }
    }
}

}  // namespace vernier
