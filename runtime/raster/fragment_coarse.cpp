// Fragments that stand for 2x2 pixels, where the accuracy asks for them. Coverage and tests are those of the pixels;
// the program runs at the point where the four meet, whether they are covered or not, so that its colours depend on
// nothing but the primitive. Derivatives are over neighbouring fragments, which are two pixels apart ("Fragment Shading
// Rates").
#include <algorithm>
#include <cstring>

#include "runtime/raster/bits.h"
#include "runtime/raster/fragment_stage.h"

namespace vernier {
namespace {

constexpr uint32_t kQuadsPerBlock = 4;
constexpr uint32_t kPixelsPerBlock = kBlockSize * kBlockSize;

/// The pixels of a block that lie in a quad of fragments: 4x4 of them.
constexpr uint64_t quadPixels(uint32_t quad) {
    return uint64_t{0x0F0F0F0F} << (quad % 2 * 4 + quad / 2 * 32);
}

/// The pixels of a fragment of a quad.
constexpr uint64_t fragmentPixels(uint32_t quad, uint32_t lane) {
    return uint64_t{0x0303} << (quad % 2 * 4 + quad / 2 * 32 + lane % 2 * 2 + lane / 2 * 16);
}

/// The four fragments of a quad to its pixels, in rows of a block.
void spreadQuad(const float* fragments, float* pixels) {
    for (uint32_t row = 0; row < 2; ++row) {
        const float left = fragments[2 * row], right = fragments[2 * row + 1];
        const float four[] = {left, left, right, right};
        std::memcpy(pixels + 2 * row * kBlockSize, four, sizeof four);
        std::memcpy(pixels + (2 * row + 1) * kBlockSize, four, sizeof four);
    }
}

}  // namespace

/// Colours are taken from planes of pixels; runCoarse() fills them from the outputs of the program.
void FragmentStage::bindCoarse() {
    coarseOutputs_.clear();
    coarsePlanes_.resize(boundColorCount_ * 8);  // before any of them is pointed to
    const auto spread = [&](const float*& plane) {
        if (plane == zeros_.data() || plane == ones_.data()) return;
        const auto found = std::find_if(coarseOutputs_.begin(), coarseOutputs_.end(),
                                        [&](const CoarseOutput& output) { return output.fragments == plane; });
        if (found == coarseOutputs_.end()) {
            float* const pixels = coarsePlanes_[coarseOutputs_.size()].data();
            coarseOutputs_.push_back({plane, pixels});
            plane = pixels;
        } else {
            plane = found->pixels;
        }
    };
    for (size_t k = 0; k < boundColorCount_; ++k) {
        BoundColor& color = boundColors_[k];
        for (uint32_t c = 0; c < 4; ++c) {
            spread(color.general.source[c]);
            color.block.source[c] = color.general.source[c];
            spread(color.general.second[c]);
        }
    }
}

void FragmentStage::addCoarse(const BlockCoverage& block, uint64_t pixels) {
    uint32_t quads = 0;
    for (uint32_t quad = 0; quad < kQuadsPerBlock; ++quad) quads += (pixels & quadPixels(quad)) != 0;
    reserve(4 * quads);
    CoarseBlock& entry = coarseBlocks_[coarseCount_++];
    entry = {tileX_ + block.x, tileY_ + block.y, pixels, {}};
    const TrianglePlanes* planes = &planes_[planesCount_ - 1];
    if (batch_.segmentCount == 0 || batch_.segments[batch_.segmentCount - 1].planes != planes)
        batch_.segments[batch_.segmentCount++] = {planes, batch_.count, 0};
    batch_.segments[batch_.segmentCount - 1].count += 4 * quads;
    for (uint32_t quad = 0; quad < kQuadsPerBlock; ++quad) {
        entry.quads[quad] = CoarseBlock::kNone;
        if ((pixels & quadPixels(quad)) == 0) continue;
        entry.quads[quad] = batch_.count;
        for (uint32_t lane = 0; lane < 4; ++lane) {
            const uint32_t n = batch_.count++;
            batch_.x[n] = entry.x + static_cast<int32_t>(quad % 2 * 4 + lane % 2 * 2);
            batch_.y[n] = entry.y + static_cast<int32_t>(quad / 2 * 4 + lane / 2 * 2);
            batch_.coverage[n] = (pixels & fragmentPixels(quad, lane)) != 0 ? 1 : 0;
            batch_.store[n] = 0 - batch_.coverage[n];
        }
    }
}

/// Shades the fragments that wait and writes their pixels, block by block in the order of the primitives: what is
/// blended with is what the blocks before have left.
void FragmentStage::runCoarse() {
    const uint32_t count = batch_.count;
    current_ = &batch_;
    fillInputs(batch_);
    if (!context_->run(count, batch_.execute.data(), batch_.store.data())) outOfBudget_ = true;
    ++statistics_.batches;
    const auto stored = static_cast<uint32_t>(std::count(batch_.coverage.begin(), batch_.coverage.begin() + count, 1u));
    statistics_.fragmentInvocations += stored;
    statistics_.helperInvocations += count - stored;
    block_.count = kPixelsPerBlock;
    for (uint32_t b = 0; b < coarseCount_; ++b) {
        const CoarseBlock& block = coarseBlocks_[b];
        for (const CoarseOutput& output : coarseOutputs_)
            for (uint32_t quad = 0; quad < kQuadsPerBlock; ++quad)
                if (block.quads[quad] != CoarseBlock::kNone)
                    spreadQuad(output.fragments + block.quads[quad],
                               output.pixels + quad / 2 * 4 * kBlockSize + quad % 2 * 4);
        block_.originX = block.x;
        block_.originY = block.y;
        texelsPacked_ = false;
        statistics_.samplesPassed += countBits(block.pixels);
        if (block.pixels == ~uint64_t{0}) {
            writeColors(block_, 0, nullptr);
        } else {
            spreadPixels_(block.pixels, LaneOrder::rows, kPixelsPerBlock, mask_.data());
            writeColors(block_, 0, mask_.data());
        }
    }
    coarseCount_ = 0;
}

}  // namespace vernier
