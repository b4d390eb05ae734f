#include "runtime/raster/hidden_work.h"

#include <algorithm>
#include <array>
#include <optional>

#include "runtime/raster/coverage.h"

namespace vernier {
namespace {

/// Its primitives leave no trace but colours.
bool touchesColorsOnly(const PreparedDraw& draw) {
    const ir::Program* fragment = draw.call.pipeline->fragmentIr();
    const DepthPlan& depth = draw.plan->depth;
    return !depth.any() && !depth.write && (fragment == nullptr || !fragment->hasSideEffects);
}

/// Its primitives replace every colour attachment wherever they cover.
bool replacesEverything(const PassTargets& targets, const PreparedDraw& draw) {
    const Plan& plan = *draw.plan;
    const ir::Program* fragment = draw.call.pipeline->fragmentIr();
    const uint32_t allSamples = (1u << plan.samples) - 1;
    if (!plan.runsFragments || fragment == nullptr || fragment->canDiscard || fragment->writesSampleMask ||
        plan.alphaToCoverage || (plan.sampleMask & allSamples) != allSamples || !touchesColorsOnly(draw))
        return false;
    for (uint32_t attachment = 0; attachment < targets.colorCount; ++attachment) {
        if (targets.colors[attachment].data == nullptr) continue;
        const auto color = std::find_if(plan.colors.begin(), plan.colors.end(),
                                        [&](const ColorPlan& each) { return each.attachment == attachment; });
        if (color == plan.colors.end() || color->path != ColorPath::store || color->readsDestination ||
            color->partialMask)
            return false;
    }
    return true;
}

const PreparedDraw& drawOf(const TileWork& item, uint32_t entry, std::span<const PreparedDraw> draws) {
    return draws[item.chunk->primitives[item.chunk->entries[entry] & ~kCoversTile].draw];
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

    void add(const PreparedDraw& draw, const Primitive& primitive) {
        const uint32_t samples = draw.plan->samples;
        const TileEdges edges =
            tileEdges(primitive, tile_.tileX, tile_.tileY, draw.subPixelBits, samples, draw.positions);
        std::array<BlockCoverage, kBlocksPerTile> blocks;
        const uint32_t count = coverTileFunction(draw.call.pipeline->isa())(edges, blocks.data());
        for (uint32_t b = 0; b < count; ++b) {
            uint64_t all = ~uint64_t{0};
            for (uint32_t s = 0; s < samples; ++s) all &= blocks[b].masks[s];
            missing_[static_cast<uint32_t>(blocks[b].y / kBlockSize) * kBlocksAcross +
                     static_cast<uint32_t>(blocks[b].x / kBlockSize)] &= ~all;
        }
    }

    bool complete() const {
        return std::all_of(missing_.begin(), missing_.end(), [](uint64_t block) { return block == 0; });
    }

  private:
    static constexpr uint32_t kBlocksAcross = kTileSize / kBlockSize;
    const TileInput& tile_;
    std::array<uint64_t, kBlocksPerTile> missing_{};
};

/// The last primitive from which on the whole tile is replaced.
VisibleStart lastReplacement(const PassTargets& targets, const TileInput& tile) {
    uint64_t before = 0;  // entries not yet looked at
    for (const TileWork& item : tile.work) before += item.count;
    std::optional<ReplacedPixels> replaced;
    const PreparedDraw* known = nullptr;  // of which it is known whether it replaces everything
    bool replaces = false;
    uint32_t partial = 0;
    for (size_t item = tile.work.size(); item-- > 0;) {
        const TileWork& work = tile.work[item];
        if (work.clear != nullptr) continue;
        for (uint32_t n = work.first + work.count; n-- > work.first;) {
            const uint32_t entry = work.chunk->entries[n];
            const Primitive& primitive = work.chunk->primitives[entry & ~kCoversTile];
            const PreparedDraw& draw = tile.draws[primitive.draw];
            --before;
            if (&draw != known) {
                known = &draw;
                replaces = replacesEverything(targets, draw);
            }
            if (!replaces || primitive.shape != kNoShape || !draw.viewport(primitive.viewport).sampleAreas.empty())
                continue;
            if ((entry & kCoversTile) != 0) return {item, n, true};
            // Worth the while only for large parts of a tile with work before them.
            const int32_t width = std::min<int32_t>(primitive.bounds[2] + 1, tile.rect.x1) -
                                  std::max<int32_t>(primitive.bounds[0], tile.rect.x0);
            const int32_t height = std::min<int32_t>(primitive.bounds[3] + 1, tile.rect.y1) -
                                   std::max<int32_t>(primitive.bounds[1], tile.rect.y0);
            if (partial == kMaxPartialCovers || before + partial == 0 || width * height < kTileSize * kTileSize / 8)
                continue;
            if (!replaced) replaced.emplace(tile);
            replaced->add(draw, primitive);
            ++partial;
            if (replaced->complete()) return {item, n, true};
        }
    }
    return {};
}

}  // namespace

bool mayHideWork(const PassTargets& targets, std::span<const PreparedDraw> draws) {
    return std::any_of(draws.begin(), draws.end(),
                       [&](const PreparedDraw& draw) { return replacesEverything(targets, draw); });
}

VisibleStart visibleStart(const PassTargets& targets, const TileInput& tile) {
    const std::span<const TileWork> work = tile.work;
    const VisibleStart start = lastReplacement(targets, tile);
    if (!start.replacesColors) return {};
    for (size_t item = 0; item <= start.item; ++item) {
        if (const ClearCommand* clear = work[item].clear; clear != nullptr) {
            if (clear->aspects != VK_IMAGE_ASPECT_COLOR_BIT) return {};
            continue;
        }
        const uint32_t end = item == start.item ? start.entry : work[item].first + work[item].count;
        for (uint32_t entry = work[item].first; entry < end; ++entry)
            if (!touchesColorsOnly(drawOf(work[item], entry, tile.draws))) return {};
    }
    return start;
}

}  // namespace vernier
