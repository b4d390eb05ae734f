#include "runtime/raster/hidden_work.h"

#include <algorithm>

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

/// The last primitive that replaces the whole tile.
VisibleStart lastReplacement(const PassTargets& targets, std::span<const PreparedDraw> draws,
                             std::span<const TileWork> work) {
    for (size_t item = work.size(); item-- > 0;) {
        if (work[item].clear != nullptr) continue;
        for (uint32_t entry = work[item].first + work[item].count; entry-- > work[item].first;)
            if ((work[item].chunk->entries[entry] & kCoversTile) != 0 &&
                replacesEverything(targets, drawOf(work[item], entry, draws)))
                return {item, entry, true};
    }
    return {};
}

}  // namespace

VisibleStart visibleStart(const PassTargets& targets, std::span<const PreparedDraw> draws,
                          std::span<const TileWork> work) {
    const VisibleStart start = lastReplacement(targets, draws, work);
    if (!start.replacesColors) return {};
    for (size_t item = 0; item <= start.item; ++item) {
        if (const ClearCommand* clear = work[item].clear; clear != nullptr) {
            if (clear->aspects != VK_IMAGE_ASPECT_COLOR_BIT || clear->layers != 1 || clear->firstLayer != 0) return {};
            continue;
        }
        const uint32_t end = item == start.item ? start.entry : work[item].first + work[item].count;
        for (uint32_t entry = work[item].first; entry < end; ++entry)
            if (!touchesColorsOnly(drawOf(work[item], entry, draws))) return {};
    }
    return start;
}

}  // namespace vernier
