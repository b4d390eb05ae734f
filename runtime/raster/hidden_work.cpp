#include "runtime/raster/hidden_work.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "runtime/raster/coverage.h"
#include "runtime/raster/depth_range.h"

namespace vernier {
namespace {

/// What the primitives of a draw do to a tile's attachments.
struct DrawEffect {
    bool tracesOnly = false;  // nothing is left of them but colours, and depths if writesDepth
    bool writesDepth = false;
    bool depthKnown = false;  // the depths written are those of the primitive
    bool replaces = false;    // they replace every colour wherever they cover and pass the depth test
    bool tests = false;       // of what replaces: it must be nearer than what is there
    bool nearIsGreater = false;
};

bool hasDepth(const PassTargets& targets) {
    return targets.depthStencil.data != nullptr;
}

/// Its primitives replace every colour attachment wherever they cover and pass the tests.
bool replacesColors(const PassTargets& targets, const PreparedDraw& draw) {
    const Plan& plan = *draw.plan;
    const ir::Program* fragment = draw.call.pipeline->fragmentIr();
    const uint32_t allSamples = (1u << plan.samples) - 1;
    if (!plan.runsFragments || fragment == nullptr || fragment->canDiscard || fragment->writesSampleMask ||
        plan.alphaToCoverage || (plan.sampleMask & allSamples) != allSamples)
        return false;
    for (uint32_t attachment = 0; attachment < targets.colorCount; ++attachment) {
        if (targets.colors[attachment].data == nullptr) continue;
        if ((draw.call.dynamic->colorWrites >> attachment & 1) == 0) return false;
        const auto color = std::find_if(plan.colors.begin(), plan.colors.end(),
                                        [&](const ColorPlan& each) { return each.attachment == attachment; });
        if (color == plan.colors.end() || color->path != ColorPath::store || color->readsDestination ||
            color->partialMask)
            return false;
    }
    return true;
}

DrawEffect effectOf(const PassTargets& targets, const PreparedDraw& draw) {
    constexpr uint8_t kLess = 1, kGreater = 4, kAlways = 7;  // bits of DepthPlan::compare
    const Plan& plan = *draw.plan;
    const ir::Program* fragment = draw.call.pipeline->fragmentIr();
    const DepthPlan& depth = plan.depth;
    DrawEffect effect;
    effect.tracesOnly = (fragment == nullptr || !fragment->hasSideEffects) && !(hasDepth(targets) && depth.stencil);
    effect.writesDepth = hasDepth(targets) && depth.write;
    effect.depthKnown = plan.fragDepthSlot == kNoSlot;
    if (!plan.skips.has(Skip::hiddenWork) || !effect.tracesOnly || !replacesColors(targets, draw)) return effect;
    effect.replaces = true;
    if (!hasDepth(targets) || !depth.any()) return effect;
    const bool ordered =
        (depth.compare & (kLess | kGreater)) == kLess || (depth.compare & (kLess | kGreater)) == kGreater;
    effect.replaces = effect.depthKnown && !depth.bounds && (depth.compare == kAlways || ordered);
    effect.tests = depth.test && depth.compare != kAlways;
    effect.nearIsGreater = (depth.compare & kGreater) != 0;
    return effect;
}

/// Primitives that cover part of a tile are looked at so often per tile, at most: coverage costs time, too.
constexpr uint32_t kMaxPartialCovers = 8;

/// Which pixels of a tile are replaced, by block.
class ReplacedPixels {
  public:
    explicit ReplacedPixels(const TileInput& tile) : tile_(tile) {
        // Pixels outside the render area need not be replaced.
        const auto bits = [](int32_t from, int32_t to) {
            const auto below = [](int32_t n) { return (1u << std::clamp(n, 0, kBlockSize)) - 1; };
            return uint64_t{below(to) & ~below(from)};
        };
        for (uint32_t b = 0; b < kBlocksPerTile; ++b) {
            const int32_t x = tile.tileX + static_cast<int32_t>(b % kBlocksAcross) * kBlockSize;
            const int32_t y = tile.tileY + static_cast<int32_t>(b / kBlocksAcross) * kBlockSize;
            const uint64_t row = bits(tile.rect.x0 - x, tile.rect.x1 - x);
            const uint64_t rows = bits(tile.rect.y0 - y, tile.rect.y1 - y);
            for (uint32_t n = 0; n < kBlockSize; ++n) missing_[b] |= (rows >> n & 1) * row << (8 * n);
        }
    }

    /// Returns whether the primitive covers nothing that was replaced before.
    bool add(const PreparedDraw& draw, const Primitive& primitive) {
        const uint32_t samples = draw.plan->samples;
        const TileEdges edges =
            tileEdges(primitive, tile_.tileX, tile_.tileY, draw.subPixelBits, samples, draw.positions);
        std::array<BlockCoverage, kBlocksPerTile> blocks;
        const uint32_t count = coverTileFunction(draw.call.pipeline->isa())(edges, blocks.data());
        bool apart = true;
        for (uint32_t b = 0; b < count; ++b) {
            uint64_t all = ~uint64_t{0}, any = 0;
            for (uint32_t s = 0; s < samples; ++s) {
                all &= blocks[b].masks[s];
                any |= blocks[b].masks[s];
            }
            uint64_t& missing = missing_[blockIndex(blocks[b])];
            apart &= (any & ~missing) == 0;
            missing &= ~all;
        }
        return apart;
    }

    bool complete() const {
        return std::all_of(missing_.begin(), missing_.end(), [](uint64_t block) { return block == 0; });
    }

  private:
    static constexpr uint32_t kBlocksAcross = kTileSize / kBlockSize;
    const TileInput& tile_;
    std::array<uint64_t, kBlocksPerTile> missing_{};
};

/// Looks at a tile's work from the end: first for primitives that together replace it, then at what they hide.
class HiddenWork {
  public:
    HiddenWork(const PassTargets& targets, const TileInput& tile) : targets_(targets), tile_(tile) {}

    VisibleStart find() {
        for (const TileWork& item : tile_.work) before_ += item.count;
        for (size_t item = tile_.work.size(); item-- > 0;) {
            const TileWork& work = tile_.work[item];
            if (work.clear != nullptr) {
                if ((tests_ || start_.replacesColors) && work.clear->aspects != VK_IMAGE_ASPECT_COLOR_BIT) return {};
                continue;
            }
            for (uint32_t n = work.first + work.count; n-- > work.first;)
                if (!visit(item, n)) return {};
        }
        if (!start_.replacesColors || (tests_ && !beatsCleared())) return {};
        return start_;
    }

  private:
    /// Returns false when the primitive's traces may outlive what replaces the tile.
    bool visit(size_t item, uint32_t n) {
        const TileWork& work = tile_.work[item];
        const uint32_t entry = work.chunk->entries[n];
        const Primitive& primitive = work.chunk->primitives[entry & ~kCoversTile];
        const PreparedDraw& draw = tile_.draws[primitive.draw];
        --before_;
        if (&draw != draw_) {
            draw_ = &draw;
            effect_ = effectOf(targets_, draw);
        }
        if (!start_.replacesColors && joins(primitive)) {
            const bool whole = (entry & kCoversTile) != 0;
            if (whole || isWorthCovering(primitive)) {
                const bool first = !replaced_;
                if (!replaced_) replaced_.emplace(tile_);
                const bool apart = whole ? first : replaced_->add(draw, primitive);
                if (tests_ && !apart && !staysBehind(primitive)) return false;
                include(primitive);
                ++partial_;
                if (whole || replaced_->complete()) start_ = {item, n, true};
                return true;
            }
        }
        if (!tests_ && !start_.replacesColors) {
            // What it does besides may depend on the depths that it finds.
            if (replaced_) mayHideDepths_ &= effect_.tracesOnly;
            return true;
        }
        return effect_.tracesOnly && (!start_.replacesColors || !effect_.writesDepth || mayHideDepths_) &&
               (!tests_ || staysBehind(primitive));
    }

    /// It may be one of the primitives that replace the tile together.
    bool joins(const Primitive& primitive) const {
        return effect_.replaces && primitive.shape == kNoShape &&
               draw_->viewport(primitive.viewport).sampleAreas.empty() &&
               (!effect_.tests || (tile_.cleared && (!tests_ || nearIsGreater_ == effect_.nearIsGreater)));
    }

    /// Only large parts of a tile with work before them.
    bool isWorthCovering(const Primitive& primitive) const {
        const int32_t width = std::min<int32_t>(primitive.bounds[2] + 1, tile_.rect.x1) -
                              std::max<int32_t>(primitive.bounds[0], tile_.rect.x0);
        const int32_t height = std::min<int32_t>(primitive.bounds[3] + 1, tile_.rect.y1) -
                               std::max<int32_t>(primitive.bounds[1], tile_.rect.y0);
        return partial_ < kMaxPartialCovers && before_ + partial_ != 0 && isLargePart(width, height);
    }

    /// Depths of the primitive, the near ones least.
    DepthRange depthsOf(const Primitive& primitive) const {
        const ViewportSetup& viewport = draw_->viewport(primitive.viewport);
        return oriented(primitiveDepths(draw_->plan->depth.storage, primitive, viewport.depthLow, viewport.depthHigh));
    }
    DepthRange oriented(const DepthRange& range) const {
        return nearIsGreater_ ? DepthRange{-range.high, -range.low} : range;
    }

    void include(const Primitive& primitive) {
        mayHideDepths_ &= effect_.writesDepth;
        if (!effect_.tests) return;
        tests_ = true;
        nearIsGreater_ = effect_.nearIsGreater;
        const double farthest = depthsOf(primitive).high;
        // NaN stays: nothing compares with it.
        if (farthest_ == farthest_ && !(farthest <= farthest_)) farthest_ = farthest;
    }

    /// Whatever it writes, all that replaces the tile passes the depth test.
    bool staysBehind(const Primitive& primitive) const {
        return !effect_.writesDepth || (effect_.depthKnown && depthsOf(primitive).low > farthest_);
    }

    bool beatsCleared() const {
        const RenderTarget& depth = targets_.depthStencil;
        return oriented(clearedDepths(depthStorage(depth.format), depth.clear.depthStencil.depth)).low > farthest_;
    }

    const PassTargets& targets_;
    const TileInput& tile_;
    uint64_t before_ = 0;  // entries not yet looked at
    const PreparedDraw* draw_ = nullptr;
    DrawEffect effect_;  // of draw_
    // Of the primitives that replace the tile.
    VisibleStart start_;
    std::optional<ReplacedPixels> replaced_;
    uint32_t partial_ = 0;
    bool mayHideDepths_ = true;                   // they replace depths, too
    bool tests_ = false, nearIsGreater_ = false;  // some have to be nearer than what is there
    double farthest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

bool mayHideWork(const PassTargets& targets, std::span<const PreparedDraw> draws) {
    const bool seen =
        std::any_of(draws.begin(), draws.end(), [](const PreparedDraw& draw) { return draw.plan->readsAttachments; });
    return !seen && std::any_of(draws.begin(), draws.end(),
                                [&](const PreparedDraw& draw) { return effectOf(targets, draw).replaces; });
}

VisibleStart visibleStart(const PassTargets& targets, const TileInput& tile) {
    const bool large = std::any_of(tile.work.begin(), tile.work.end(), [](const TileWork& work) { return work.large; });
    return large ? HiddenWork(targets, tile).find() : VisibleStart{};
}

}  // namespace vernier
