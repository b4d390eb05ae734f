// Fragments of small primitives: lanes of a batch whose attributes are interpolated before the batch is full.
#include <algorithm>
#include <cstring>

#include "runtime/raster/fragment_stage.h"

namespace vernier {

void FragmentStage::bindSmall() {
    smallTargets_.clear();
    if (!draw_->packsSmall) return;
    for (const auto* targets : {&centreTargets_.smooth, &centreTargets_.linear, &centreTargets_.flat})
        smallTargets_.insert(smallTargets_.end(), targets->begin(), targets->end());
    smallAttributes_.resize(smallTargets_.size());
    smallPlanes_.resize(smallTargets_.size());
    smallPlaces_.resize(smallTargets_.size());
}

void FragmentStage::addSmall(const SmallGroup& group, const SmallFragment* fragments, uint32_t count) {
    if (count == 0) return;
    const size_t smooth = centreTargets_.smooth.size(), linear = centreTargets_.linear.size();
    gatherSmall_({&group, smallTargets_, smooth + linear, smallAttributes_.data()});
    while (count != 0) {
        if (batch_.count == capacity_) {
            flushBatch();
            // What is expected was forgotten with the batch.
            for (uint32_t n = 0; n < count; ++n) {
                const uint32_t x = fragments[n] & 63, y = fragments[n] >> 6 & 63;
                expect(y / kBlockSize * (kTileSize / kBlockSize) + x / kBlockSize,
                       uint64_t{1} << (y % kBlockSize * kBlockSize + x % kBlockSize));
            }
        }
        const uint32_t first = batch_.count, lanes = std::min(count, capacity_ - first);
        if (batch_.segmentCount == 0 || batch_.segments[batch_.segmentCount - 1].planes != nullptr)
            batch_.segments[batch_.segmentCount++] = {nullptr, first, 0};
        batch_.segments[batch_.segmentCount - 1].count += lanes;
        batch_.apart = true;
        for (size_t k = 0; k < smallPlaces_.size(); ++k) smallPlaces_[k] = smallPlanes_[k].data() + first;
        statistics_.perspectiveDivides +=
            shadeSmall_({&group, fragments, lanes, tileX_, tileY_, batch_.x.data() + first, batch_.y.data() + first,
                         smallAttributes_, smallPlaces_, smooth, linear});
        batch_.count += lanes;
        fragments += lanes;
        count -= lanes;
    }
}

/// The lanes of small primitives, to where the program reads them.
void FragmentStage::takeSmallInputs(const FragmentBatch& batch) {
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& part = batch.segments[s];
        if (part.planes != nullptr) continue;
        for (size_t k = 0; k < smallTargets_.size(); ++k)
            std::memcpy(smallTargets_[k].plane + part.first, smallPlanes_[k].data() + part.first,
                        part.count * sizeof(float));
    }
}

}  // namespace vernier
