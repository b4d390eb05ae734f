// Fragment programs that run once per sample, a part of them once per pixel perhaps.
#include <algorithm>
#include <cstring>

#include "runtime/raster/fragment_stage.h"

namespace vernier {

/// `batch` holds pixels, with their covered samples in `coverage`.
void FragmentStage::runSamples(FragmentBatch& batch) {
    const uint32_t count = batch.count, lanes = (count + 3) / 4 * 4;
    if (plan_->splitSamples) {
        interpolate(batch, pixelInput_);
        fillBuiltins(batch, plan_->pixelBuiltins, *pixelContext_);
        // Lanes of no sample are the helpers of quads: here too they run.
        if (!pixelContext_->run(lanes, batch.execute.data(), batch.execute.data())) outOfBudget_ = true;
    }
    std::copy_n(batch.coverage.begin(), count, pixelCoverage_.begin());
    for (uint32_t s = 0; s < samples_; ++s) {
        uint32_t covered = 0;
        for (uint32_t lane = 0; lane < count; ++lane) {
            batch.coverage[lane] = pixelCoverage_[lane] & 1u << s;
            batch.store[lane] = 0 - (pixelCoverage_[lane] >> s & 1);
            covered |= batch.store[lane];
        }
        if (covered == 0) continue;
        if (!plan_->usesQuads) std::copy_n(batch.store.begin(), count, batch.execute.begin());
        std::fill_n(batch.sample.begin(), count, s);
        std::fill_n(batch.offsetX.begin(), count, positions_[s].x());
        std::fill_n(batch.offsetY.begin(), count, positions_[s].y());
        for (const CarriedValue& value : plan_->carried)
            if (float* plane = context_->input(value.to); plane != nullptr)
                std::memcpy(plane, pixelContext_->output(value.from), lanes * sizeof(float));
        run(batch);
    }
    // Where samples do not run one by one, they are the pixel.
    std::fill_n(batch.sample.begin(), count, 0);
    std::fill_n(batch.offsetX.begin(), count, 0.5f);
    std::fill_n(batch.offsetY.begin(), count, 0.5f);
}

}  // namespace vernier
