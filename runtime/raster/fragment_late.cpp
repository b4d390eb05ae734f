// What is decided about fragments after their program has run: sample masks, and the late depth and stencil tests.
// These go by blocks, as the early ones do: the pixels of a rectangle, or those that the spans of one primitive have of
// a block.
#include <algorithm>
#include <bit>

#include "runtime/raster/bits.h"
#include "runtime/raster/depth_test.h"
#include "runtime/raster/fragment_stage.h"

namespace vernier {

/// Coverage after the program: its own sample mask, and alpha to coverage.
void FragmentStage::reduceCoverage(FragmentBatch& batch) {
    if (plan_->sampleMaskSlot != kNoSlot) {
        const float* plane = context_->output(plan_->sampleMaskSlot);
        for (uint32_t lane = 0; lane < batch.count; ++lane)
            batch.coverage[lane] &= std::bit_cast<uint32_t>(plane[lane]);
    }
    if (plan_->alphaToCoverage && plan_->alphaSlot != kNoSlot) {
        const float* alpha = plan_->smoothLines ? smoothAlpha_.data() : context_->output(plan_->alphaSlot);
        const auto samples = static_cast<float>(samples_);
        for (uint32_t lane = 0; lane < batch.count; ++lane) {
            const float a = alpha[lane] > 0 ? std::min(alpha[lane], 1.0f) : 0.0f;
            const auto count = static_cast<uint32_t>(a * samples + 0.5f);
            batch.coverage[lane] &= (1u << count) - 1;
        }
    }
}

void FragmentStage::testLate(FragmentBatch& batch) {
    if (plan_->depth.bounds || plan_->stencilRefSlot != kNoSlot) {
        testLateSamples(batch);
    } else if (batch.order == LaneOrder::spans) {
        testLateSpans(batch);
    } else {
        testLateRectangle(batch);
    }
}

/// Clears the bits of samples that fail.
void FragmentStage::testLateBlock(BlockCoverage& block, const TrianglePlanes& planes, const float* exported) {
    for (uint32_t s = 0; s < samples_; ++s) statistics_.depthReads += countBits(block.masks[s]);
    const DepthStencilState& state = depthState_;
    const Isa isa = draw_->call.pipeline->isa();
    const DepthTestFn test = plan_->depth.stencil ? stencilTestFunction(isa) : depthTestFunction(isa);
    const DepthStencilState::Face* face = planes.primitive->front ? &state.front : &state.back;
    test({&plan_->depth, state.target, &planes, tileX_, tileY_, samples_, positions_, face, 0, exported}, &block, 1);
}

/// Of a batch in rows or quads, which is of one primitive.
void FragmentStage::testLateRectangle(FragmentBatch& batch) {
    BlockCoverage block;
    block.x = batch.originX - tileX_;
    block.y = batch.originY - tileY_;
    for (uint32_t s = 0; s < samples_; ++s)
        block.masks[s] = collectPixels_(batch.coverage.data(), 1u << s, batch.order, batch.count);
    const float* exported = plan_->fragDepthSlot != kNoSlot ? context_->output(plan_->fragDepthSlot) : nullptr;
    std::array<float, kBlockSize * kBlockSize> rows;
    if (exported != nullptr && batch.order != LaneOrder::rows) {
        for (uint32_t lane = 0; lane < batch.count; ++lane)
            rows[rowOf(batch.order, lane) * kBlockSize + columnOf(batch.order, lane)] = exported[lane];
        exported = rows.data();
    }
    testLateBlock(block, *batch.segments[0].planes, exported);
    std::fill_n(batch.coverage.begin(), batch.count, 0);
    for (uint32_t s = 0; s < samples_; ++s) {
        spreadPixels_(block.masks[s], batch.order, batch.count, mask_.data());
        for (uint32_t lane = 0; lane < batch.count; ++lane) batch.coverage[lane] |= mask_[lane] & 1u << s;
    }
}

void FragmentStage::testLateSpans(FragmentBatch& batch) {
    const float* exported = plan_->fragDepthSlot != kNoSlot ? context_->output(plan_->fragDepthSlot) : nullptr;
    std::array<float, kBlockSize * kBlockSize> rows{};
    const auto bitOf = [&](const FragmentSpan& span) {
        return static_cast<uint32_t>(((span.y - tileY_) % kBlockSize) * kBlockSize + (span.x - tileX_) % kBlockSize);
    };
    const auto firstOfBlock = [](int32_t place, int32_t tile) { return (place - tile) / kBlockSize * kBlockSize; };
    uint32_t span = 0;
    for (uint32_t n = 0; n < batch.segmentCount; ++n) {
        const FragmentSegment& segment = batch.segments[n];
        const uint32_t end = segment.first + segment.count;
        while (span < batch.spanCount && batch.spans[span].first < end) {
            // The spans that follow each other in one block.
            BlockCoverage block;
            block.x = firstOfBlock(batch.spans[span].x, tileX_);
            block.y = firstOfBlock(batch.spans[span].y, tileY_);
            std::fill_n(block.masks.begin(), samples_, 0);
            uint32_t next = span;
            for (; next < batch.spanCount && batch.spans[next].first < end; ++next) {
                const FragmentSpan& part = batch.spans[next];
                if (firstOfBlock(part.x, tileX_) != block.x || firstOfBlock(part.y, tileY_) != block.y) break;
                for (uint32_t k = 0, bit = bitOf(part); k < part.count; ++k, ++bit) {
                    const uint64_t covered = batch.coverage[part.first + k];
                    for (uint32_t s = 0; s < samples_; ++s) block.masks[s] |= (covered >> s & 1) << bit;
                    if (exported != nullptr) rows[bit] = exported[part.first + k];
                }
            }
            testLateBlock(block, *segment.planes, exported != nullptr ? rows.data() : nullptr);
            for (; span < next; ++span) {
                const FragmentSpan& part = batch.spans[span];
                for (uint32_t k = 0, bit = bitOf(part); k < part.count; ++k, ++bit) {
                    uint32_t& covered = batch.coverage[part.first + k];
                    covered = 0;
                    for (uint32_t s = 0; s < samples_; ++s)
                        covered |= static_cast<uint32_t>(block.masks[s] >> bit & 1) << s;
                }
            }
        }
    }
}

/// One sample after the other, as bounds and references of the program's own ask for.
void FragmentStage::testLateSamples(FragmentBatch& batch) {
    const float* fragDepth = plan_->fragDepthSlot != kNoSlot ? context_->output(plan_->fragDepthSlot) : nullptr;
    const float* stencilRef = plan_->stencilRefSlot != kNoSlot ? context_->output(plan_->stencilRefSlot) : nullptr;
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& part = batch.segments[s];
        const TrianglePlanes& planes = *part.planes;
        for (uint32_t lane = part.first; lane < part.first + part.count; ++lane) {
            const uint32_t covered = batch.coverage[lane];
            uint32_t passed = 0, reference = 0;
            if (stencilRef != nullptr) reference = std::bit_cast<uint32_t>(stencilRef[lane]);
            for (uint32_t rest = covered; rest != 0; rest &= rest - 1) {
                const auto sample = static_cast<uint32_t>(std::countr_zero(rest));
                const float z =
                    fragDepth != nullptr
                        ? (fragDepth[lane] > planes.zLow ? std::min(fragDepth[lane], planes.zHigh) : planes.zLow)
                        : depthAt(planes, batch.x[lane], batch.y[lane], positions_[sample].x(), positions_[sample].y());
                std::byte* texel = depthState_.target.texel(batch.x[lane], batch.y[lane], sample);
                ++statistics_.depthReads;
                if (testSample(depthState_, texel, z, planes.primitive->front,
                               stencilRef != nullptr ? &reference : nullptr))
                    passed |= 1u << sample;
            }
            batch.coverage[lane] = passed;
        }
    }
}

}  // namespace vernier
