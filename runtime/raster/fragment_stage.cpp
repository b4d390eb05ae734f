#include "runtime/raster/fragment_stage.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "runtime/geometry/shapes.h"
#include "runtime/raster/bits.h"

namespace vernier {
namespace {

/// A block with so many covered pixels is run at once: what packing would gain is less than what it costs.
constexpr uint32_t kMostOfABlock = 20;
/// Likewise of two rows, which are a batch of their own.
constexpr uint32_t kMostOfTwoRows = 8;

/// Whether the pixels lie in one pair of rows.
bool inTwoRows(uint64_t pixels) {
    return std::countr_zero(pixels) / 16 == (63 - std::countl_zero(pixels)) / 16;
}

/// The samples of one pixel of a block.
uint32_t coverageOf(const SampleMasks& masks, uint32_t bit, uint32_t samples) {
    uint32_t coverage = 0;
    for (uint32_t s = 0; s < samples; ++s) coverage |= static_cast<uint32_t>(masks[s] >> bit & 1) << s;
    return coverage;
}

}  // namespace

FragmentBatch::FragmentBatch() {
    x.fill(0);
    y.fill(0);
    execute.fill(0);
    store.fill(0);
    offsetX.fill(0.5f);
    offsetY.fill(0.5f);
    coverage.fill(0);
    rasterized.fill(0);
    sample.fill(0);
}

FragmentStage::FragmentStage() {
    // Integers and floats alike: 0, and 1.0 for an alpha that the program does not write.
    zeros_.fill(0);
    ones_.fill(1);
    fragZ_.fill(0);
    fragInverseW_.fill(0);
    for (auto& plane : colors_.destination) plane.fill(0);
}

void FragmentStage::startPass(const PassTargets& targets) {
    targets_ = &targets;
    statistics_ = {};
    outOfBudget_ = false;
    draw_ = nullptr;
    contexts_.trim();
}

void FragmentStage::startTile(int32_t tileX, int32_t tileY) {
    tileX_ = tileX;
    tileY_ = tileY;
}

void FragmentStage::bind(const PreparedDraw& draw, uint64_t token) {
    if (draw_ != nullptr && token == token_) return;
    flush();
    draw_ = &draw;
    plan_ = draw.plan;
    token_ = token;
    samples_ = plan_->samples;
    positions_ = draw.positions;
    const Isa isa = draw.call.pipeline->isa();
    interpolate_ = interpolateFunction(isa);
    placeLanes_ = placeLanesFunction(isa);
    spreadPixels_ = spreadPixelsFunction(isa);
    collectPixels_ = collectPixelsFunction(isa);
    gatherSmall_ = gatherSmallFunction(isa);
    shadeSmall_ = shadeSmallFunction(isa);
    blend_ = blendFunction(isa);

    const DynamicState& dynamic = *draw.call.dynamic;
    const RenderTarget& depth = targets_->depthStencil;
    depthState_.plan = &plan_->depth;
    depthState_.target = {depth.data, depth.rowPitch, static_cast<size_t>(depth.samplePitch), 0};
    if (const FormatInfo* info = findFormat(depth.format); info != nullptr)
        depthState_.target.texelBytes = info->bytesPerTexel;
    depthState_.minBounds = dynamic.minDepthBounds;
    depthState_.maxBounds = dynamic.maxDepthBounds;
    depthState_.front = {draw.state->stencilFront, dynamic.stencilFront};
    depthState_.back = {draw.state->stencilBack, dynamic.stencilBack};

    context_ = pixelContext_ = nullptr;
    if (!plan_->runsFragments) return;
    const ShaderProgram& shaders = draw.call.pipeline->program();
    const std::shared_ptr<const BatchProgram>& program =
        plan_->splitSamples ? shaders.samplePart() : shaders.fragment();
    context_ = begin(draw, program);
    capacity_ = std::min(program->lanes(), kMaxFragmentLanes);
    if (plan_->splitSamples) {
        pixelContext_ = begin(draw, shaders.pixelPart());
        capacity_ = std::min(capacity_, shaders.pixelPart()->lanes());
    }
    bindInputs();
    bindInterpolation();
    bindSmall();
    bindColors(isa);
    if (plan_->coarse) bindCoarse();
    readsPixels_ = plan_->smoothLines || !plan_->fragmentBuiltins.empty() || plan_->preciseInterpolation ||
                   plan_->needsCentroid || !plan_->keepsCoverage;

    holdsBlocks_ = samples_ == 1 && !plan_->usesQuads && !plan_->perSample && !plan_->coarse && !plan_->interpolates &&
                   !readsPixels_;

    block_.order = plan_->usesQuads && !plan_->coarse ? LaneOrder::quads : LaneOrder::rows;
    block_.segmentCount = 1;
}

BatchContext* FragmentStage::begin(const PreparedDraw& draw, const std::shared_ptr<const BatchProgram>& program) {
    ContextCache::Entry& entry = contexts_.get(program);
    if (entry.begun != token_) {
        entry.context.beginDraw(draw.call.fragmentResources);
        entry.context.setInterpolator({this, &FragmentStage::interpolateAt});
        entry.begun = token_;
    }
    return &entry.context;
}

TrianglePlanes& FragmentStage::startPrimitive() {
    // A slot stays as long as a segment refers to it; the last one may be taken again when none does.
    uint32_t segments = batch_.segmentCount;
    if (segments != 0 && batch_.segments[segments - 1].planes == nullptr) --segments;  // neighbours of it have planes
    const bool lastUnused =
        planesCount_ > 0 && (segments == 0 || batch_.segments[segments - 1].planes != &planes_[planesCount_ - 1]);
    if (!lastUnused) ++planesCount_;
    return planes_[planesCount_ - 1];
}

void FragmentStage::keepCoverage(const BlockCoverage* blocks, uint32_t count) {
    for (const BlockCoverage& block : std::span(blocks, count)) {
        std::copy_n(block.masks.begin(), samples_, rasterized_[blockIndex(block)].begin());
    }
}

void FragmentStage::reserve(uint32_t lanes) {
    if (batch_.count + lanes > capacity_) flushBatch();
}

/// Up to 8 pixels of a row; returns the first lane. Writes whole vectors of 8: what is too much, the next
/// span overwrites.
uint32_t FragmentStage::appendSpan(int32_t x, int32_t y, uint32_t lanes) {
    const TrianglePlanes* planes = &planes_[planesCount_ - 1];
    const uint32_t first = batch_.count;
    if (batch_.segmentCount == 0 || batch_.segments[batch_.segmentCount - 1].planes != planes)
        batch_.segments[batch_.segmentCount++] = {planes, first, 0};
    batch_.segments[batch_.segmentCount - 1].count += lanes;
    batch_.spans[batch_.spanCount++] = {x, y, first, lanes};
    for (int32_t n = 0; n < kBlockSize; ++n) batch_.x[first + static_cast<uint32_t>(n)] = x + n;
    for (uint32_t n = 0; n < kBlockSize; ++n) batch_.y[first + n] = y;
    if (!plan_->coverageIsFull)
        for (uint32_t n = 0; n < kBlockSize; ++n) batch_.coverage[first + n] = 1;
    batch_.count += lanes;
    return first;
}

void FragmentStage::add(const BlockCoverage& block) {
    uint64_t any = 0;
    for (uint32_t s = 0; s < samples_; ++s) any |= block.masks[s];
    if (plan_->coarse) return addCoarse(block, any);
    const uint32_t index = blockIndex(block);
    const bool atOnce = !plan_->perSample && !plan_->maskBeforeTests &&
                        countBits(any) >= (inTwoRows(any) ? kMostOfTwoRows : kMostOfABlock);
    // What waits for these pixels comes first.
    if ((plan_->ordered || atOnce) && (inBatch_[index] & any) != 0) flushBatch();
    if (isHeld(index)) {
        const HeldBlock& held = held_[index];
        const bool apart = (held.pixels & any) == 0 && !planes_[planesCount_ - 1].precise;
        if (apart && (inBatch_[index] & any) == 0) return runWithHeld(index, any);
        runHeld(index);
    }
    if (atOnce) {
        const TrianglePlanes& planes = planes_[planesCount_ - 1];
        if (holdsBlocks_ && ~any != 0 && planes.shape == nullptr && !planes.precise) return hold(index, any);
        block_.segments[0].planes = &planes;
        std::copy_n(block.masks.begin(), samples_, blockMasks_.begin());
        return runBlock(block.x, block.y, any);
    }
    if (plan_->usesQuads) {
        addQuads(block, any);
    } else {
        addPixels(block, any);
    }
    expect(index, any);
}

void FragmentStage::addPixels(const BlockCoverage& block, uint64_t any) {
    while (any != 0) {
        if (batch_.count == capacity_) flushBatch();
        // A run of pixels in the first row that has any.
        const auto bit = static_cast<uint32_t>(std::countr_zero(any));
        const uint32_t row = static_cast<uint32_t>(any >> (bit & ~7u)) & 0xFF;
        const auto run = static_cast<uint32_t>(std::countr_zero(~(row >> (bit & 7))));
        const uint32_t lanes = std::min(run, capacity_ - batch_.count);
        const uint32_t first = appendSpan(tileX_ + block.x + static_cast<int32_t>(bit & 7),
                                          tileY_ + block.y + static_cast<int32_t>(bit >> 3), lanes);
        any &= ~(((uint64_t{1} << lanes) - 1) << bit);
        if (samples_ == 1) continue;
        for (uint32_t n = 0; n < lanes; ++n) setCoverage(block, bit + n, first + n);
    }
}

void FragmentStage::setCoverage(const BlockCoverage& block, uint32_t bit, uint32_t lane) {
    batch_.coverage[lane] = coverageOf(block.masks, bit, samples_);
    if (plan_->maskBeforeTests) batch_.rasterized[lane] = coverageOf(rasterized_[blockIndex(block)], bit, samples_);
}

/// Quads with a covered pixel, four lanes each: upper left, upper right, lower left, lower right.
void FragmentStage::addQuads(const BlockCoverage& block, uint64_t any) {
    for (uint64_t quads = quadsOf(any); quads != 0; quads &= quads - 1) {
        reserve(4);
        const auto origin = static_cast<uint32_t>(std::countr_zero(quads));
        for (const uint32_t bit : {origin, origin + 8}) {
            const uint32_t first = appendSpan(tileX_ + block.x + static_cast<int32_t>(bit & 7),
                                              tileY_ + block.y + static_cast<int32_t>(bit >> 3), 2);
            for (uint32_t n = 0; n < 2; ++n) {
                setCoverage(block, bit + n, first + n);
                batch_.store[first + n] = batch_.coverage[first + n] != 0 ? ~0u : 0u;
            }
        }
    }
}

void FragmentStage::flush() {
    for (; heldBlocks_ != 0;) runHeld(static_cast<uint32_t>(std::countr_zero(heldBlocks_)));
    flushBatch();
}

void FragmentStage::flushBatch() {
    if (batch_.count != 0) {
        const uint32_t count = batch_.count;
        std::fill_n(batch_.execute.begin(), count, ~0u);
        if (!plan_->usesQuads && !plan_->coarse) std::fill_n(batch_.store.begin(), count, ~0u);
        for (uint32_t lane = count; lane < capacity_; ++lane) batch_.execute[lane] = batch_.store[lane] = 0;
        if (plan_->perSample) {
            runSamples(batch_);
        } else if (plan_->coarse) {
            runCoarse();
        } else {
            run(batch_);
        }
        batch_.count = 0;
        batch_.segmentCount = 0;
        batch_.spanCount = 0;
        batch_.apart = false;
        for (; blocksInBatch_ != 0; blocksInBatch_ &= blocksInBatch_ - 1)
            inBatch_[static_cast<uint32_t>(std::countr_zero(blocksInBatch_))] = 0;
        // The primitive being added goes on in the next batch.
        if (planesCount_ > 1) planes_[0] = planes_[planesCount_ - 1];
    }
    planesCount_ = std::min(planesCount_, 1u);
}

void FragmentStage::run(FragmentBatch& batch) {
    const uint32_t count = batch.count, lanes = (count + 3) / 4 * 4;
    const bool masked = batch.order == LaneOrder::spans || batch.partial;
    current_ = &batch;
    texelsPacked_ = false;
    fillInputs(batch);
    const uint32_t* execute = masked ? batch.execute.data() : nullptr;
    const uint32_t* store = masked ? batch.store.data() : nullptr;
    if (!context_->run(lanes, execute, store)) outOfBudget_ = true;
    ++statistics_.batches;
    uint32_t stored = count;
    if (batch.partial || (masked && (plan_->usesQuads || plan_->perSample)))
        for (uint32_t lane = 0; lane < count; ++lane) stored -= 1 - (batch.store[lane] & 1);
    statistics_.fragmentInvocations += stored;
    statistics_.helperInvocations += (batch.partial ? batch.running : count) - stored;
    if (plan_->smoothLines) smoothAlpha(batch);
    const bool countsNow = plan_->countsEarly && !plan_->keepsCoverage;
    if (countsNow)
        for (uint32_t lane = 0; lane < count; ++lane)
            statistics_.samplesPassed += static_cast<uint32_t>(std::popcount(batch.coverage[lane]));
    if (!plan_->keepsCoverage) {
        const uint32_t* live = context_->liveMask();
        for (uint32_t lane = 0; lane < count; ++lane) batch.coverage[lane] &= live[lane];
        reduceCoverage(batch);
        if (!plan_->depth.early && testsDepth()) testLate(batch);
    } else if (batch.partial) {
        writePartial(batch);
        return;
    }
    if (plan_->keepsCoverage && (plan_->coverageIsFull || !masked)) {
        statistics_.samplesPassed += uint64_t{count} * samples_;
        for (uint32_t s = 0; s < samples_; ++s) writeColors(batch, s, nullptr);
        return;
    }
    for (uint32_t s = 0; s < samples_; ++s) {
        uint32_t passed = 0;
        for (uint32_t lane = 0; lane < count; ++lane) {
            const uint32_t covered = batch.coverage[lane] >> s & 1;
            mask_[lane] = 0 - covered;
            passed += covered;
        }
        if (!countsNow) statistics_.samplesPassed += passed;
        if (passed != 0) writeColors(batch, s, mask_.data());
    }
}

/// Of a block, what it covers: nothing was dropped.
void FragmentStage::writePartial(const FragmentBatch& batch) {
    for (uint32_t s = 0; s < samples_; ++s) {
        const uint64_t pixels = blockPixels(s);
        statistics_.samplesPassed += countBits(pixels);
        if (pixels == 0) continue;
        const uint32_t* mask = nullptr;
        if (samples_ == 1) {
            mask = batch.store.data();
        } else if (pixels != blockRectangle_) {
            spreadPixels_(pixels, batch.order, batch.count, mask_.data());
            mask = mask_.data();
        }
        writeColors(batch, s, mask);
    }
}

/// "this coverage value is multiplied into the color location 0's alpha value after fragment shading" (specification,
/// "Smooth Lines").
void FragmentStage::smoothAlpha(const FragmentBatch& batch) {
    const float* alpha = plan_->alphaSlot != kNoSlot ? context_->output(plan_->alphaSlot) : ones_.data();
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& part = batch.segments[s];
        for (uint32_t n = part.first; n < part.first + part.count; ++n) {
            const double area = coveredArea(*part.planes->shape, batch.x[n], batch.y[n], draw_->subPixelBits);
            smoothAlpha_[n] = static_cast<float>(double{alpha[n]} * area);
        }
    }
}

const float* FragmentStage::outputPlane(uint32_t slot, uint32_t component) const {
    if (component == 3 && plan_->alphaToOne) return ones_.data();
    if (slot != kNoSlot) return context_->output(slot);
    return component == 3 ? ones_.data() : zeros_.data();
}

void FragmentStage::bindColors(Isa isa) {
    boundColorCount_ = 0;
    for (const ColorPlan& plan : plan_->colors) {
        const RenderTarget& target = targets_->colors[plan.attachment];
        if (target.data == nullptr) continue;  // VK_ATTACHMENT_UNUSED
        if ((draw_->call.dynamic->colorWrites >> plan.attachment & 1) == 0) continue;
        BoundColor& color = boundColors_[boundColorCount_++];
        color = {};
        color.general.plan = color.block.plan = &plan;
        color.general.target = &target;
        color.general.blend = blend_;
        color.general.constants = draw_->call.dynamic->blendConstants.data();
        for (uint32_t c = 0; c < 4; ++c) {
            color.general.source[c] = color.block.source[c] = outputPlane(plan.slots[c], c);
            color.general.second[c] = outputPlane(plan.dualSlots[c], c);
        }
        if (plan_->smoothLines && plan.attachment == 0 && !plan_->alphaToOne)
            color.general.source[3] = color.block.source[3] = smoothAlpha_.data();
        color.block.rowPitch = target.rowPitch;
        color.blockRoutine = blockColorFunction(plan, isa);
    }
}

/// Colours of spans through a block routine: their texels are put side by side for it.
void FragmentStage::writeSpans(BoundColor& color, const FragmentBatch& batch) {
    std::byte* texels = colors_.after.data();
    const bool reads = color.general.plan->readsDestination;
    if (reads) {
        gatherTexels(color.general, texels);
        statistics_.destinationReads += writtenLanes(color.general);
    }
    if (reads || !texelsPacked_) {
        BlockColorInput packed = color.block;
        packed.texels = texels;
        packed.rowPitch = size_t{kBlockSize} * color.general.plan->texelBytes;
        packed.order = LaneOrder::rows;
        packed.lanes = (batch.count + 15) / 16 * 16;
        packed.mask = nullptr;
        color.blockRoutine(packed);
    }
    // The samples of a pixel have one colour.
    texelsPacked_ = boundColorCount_ == 1 && !reads;
    scatterTexels(color.general, texels);
}

/// `mask`: the lanes that are written; nullptr: all.
void FragmentStage::writeColors(const FragmentBatch& batch, uint32_t sample, const uint32_t* mask) {
    for (size_t k = 0; k < boundColorCount_; ++k) {
        BoundColor& color = boundColors_[k];
        color.general.batch = &batch;
        color.general.mask = color.block.mask = mask;
        color.general.sample = sample;
        if (color.blockRoutine == nullptr) {
            const ColorPlan& plan = *color.general.plan;
            color.general.packed = texelsPacked_;
            statistics_.destinationReads += outputColors(color.general, colors_);
            // The samples of a pixel have one colour.
            texelsPacked_ = boundColorCount_ == 1 && plan.path == ColorPath::store && !plan.partialMask;
            continue;
        }
        if (batch.order == LaneOrder::spans) {
            writeSpans(color, batch);
            continue;
        }
        color.block.texels = texelAddress(color.general, batch.originX, batch.originY);
        color.block.order = batch.order;
        color.block.lanes = batch.count;
        color.blockRoutine(color.block);
        if (color.general.plan->readsDestination) statistics_.destinationReads += writtenLanes(color.general);
    }
}

}  // namespace vernier
