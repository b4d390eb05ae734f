#include "runtime/raster/fragment_stage.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/raster/sample_positions.h"

namespace vernier {

namespace {

/// The samples of one pixel of a block.
uint32_t coverageOf(const BlockCoverage& block, uint32_t bit, uint32_t samples) {
    uint32_t coverage = 0;
    for (uint32_t s = 0; s < samples; ++s) coverage |= static_cast<uint32_t>(block.masks[s] >> bit & 1) << s;
    return coverage;
}

}  // namespace

FragmentStage::FragmentStage() {
    // Integers and floats alike: 0, and 1.0 for an alpha that the program does not write.
    zeros_.fill(0);
    ones_.fill(1);
    batch_.x.fill(0);
    batch_.y.fill(0);
    batch_.execute.fill(0);
    batch_.store.fill(0);
    batch_.offsetX.fill(0.5f);
    batch_.offsetY.fill(0.5f);
    batch_.coverage.fill(0);
    batch_.sample.fill(0);
    fragZ_.fill(0);
    fragInverseW_.fill(0);
    for (auto& plane : colors_.destination) plane.fill(0);
}

void FragmentStage::startPass(const PassTargets& targets) {
    targets_ = &targets;
    statistics_ = {};
    outOfBudget_ = false;
    draw_ = nullptr;
    contexts_.startPass();
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
    const Isa isa = draw.call.pipeline->isa();
    interpolation_ = interpolationFunctions(isa);
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

    context_ = nullptr;
    if (!plan_->runsFragments) return;
    const std::shared_ptr<const BatchProgram>& program = draw.call.pipeline->fragmentProgram();
    ContextCache::Entry& entry = contexts_.get(program);
    if (entry.begun != token) {
        entry.context.beginDraw(draw.call.fragmentResources);
        entry.context.setInterpolator({this, &FragmentStage::interpolateAt});
        entry.begun = token;
    }
    context_ = &entry.context;
    capacity_ = std::min(program->lanes(), kMaxFragmentLanes);
    varyingPlanes_.clear();
    for (const Varying& varying : plan_->varyings) varyingPlanes_.push_back(context_->input(varying.fragmentSlot));
}

TrianglePlanes& FragmentStage::startPrimitive() {
    // A slot stays as long as a segment refers to it; the last one may be taken again when none does.
    const bool lastUnused =
        batch_.planesCount > 0 &&
        (batch_.segmentCount == 0 || batch_.segments[batch_.segmentCount - 1].planes + 1 != batch_.planesCount);
    if (!lastUnused) ++batch_.planesCount;
    return batch_.planes[batch_.planesCount - 1];
}

void FragmentStage::reserve(uint32_t lanes) {
    if (batch_.count + lanes > capacity_) flush();
}

/// Up to 8 pixels of a row; returns the first lane. Writes whole vectors of 8: what is too much, the next
/// span overwrites.
uint32_t FragmentStage::appendSpan(int32_t x, int32_t y, uint32_t lanes) {
    const uint32_t planes = batch_.planesCount - 1, first = batch_.count;
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
    const auto index = static_cast<size_t>(block.y / kBlockSize * (kTileSize / kBlockSize) + block.x / kBlockSize);
    if (plan_->ordered && (inBatch_[index] & any) != 0) flush();
    if (plan_->perSample) {
        for (uint32_t s = 0; s < samples_; ++s) {
            if (plan_->usesQuads) {
                addQuads(block, block.masks[s], 1, s);
            } else {
                addSamples(block, s);
            }
        }
    } else if (plan_->usesQuads) {
        addQuads(block, any, samples_, 0);
    } else {
        addPixels(block, any);
    }
    if (plan_->ordered) inBatch_[index] |= any;
}

void FragmentStage::addPixels(const BlockCoverage& block, uint64_t any) {
    while (any != 0) {
        if (batch_.count == capacity_) flush();
        // A run of pixels in the first row that has any.
        const auto bit = static_cast<uint32_t>(std::countr_zero(any));
        const uint32_t row = static_cast<uint32_t>(any >> (bit & ~7u)) & 0xFF;
        const auto run = static_cast<uint32_t>(std::countr_zero(~(row >> (bit & 7))));
        const uint32_t lanes = std::min(run, capacity_ - batch_.count);
        const uint32_t first = appendSpan(tileX_ + block.x + static_cast<int32_t>(bit & 7),
                                          tileY_ + block.y + static_cast<int32_t>(bit >> 3), lanes);
        any &= ~(((uint64_t{1} << lanes) - 1) << bit);
        if (samples_ == 1) continue;
        for (uint32_t n = 0; n < lanes; ++n) batch_.coverage[first + n] = coverageOf(block, bit + n, samples_);
    }
}

void FragmentStage::addSamples(const BlockCoverage& block, uint32_t sample) {
    const SamplePosition position = samplePositions(samples_)[sample];
    for (uint64_t mask = block.masks[sample]; mask != 0; mask &= mask - 1) {
        reserve(1);
        const int bit = std::countr_zero(mask);
        const uint32_t lane = appendSpan(tileX_ + block.x + (bit & 7), tileY_ + block.y + (bit >> 3), 1);
        batch_.coverage[lane] = 1u << sample;
        batch_.sample[lane] = sample;
        batch_.offsetX[lane] = position.x();
        batch_.offsetY[lane] = position.y();
    }
}

/// Quads with a covered pixel, four lanes each: upper left, upper right, lower left, lower right.
void FragmentStage::addQuads(const BlockCoverage& block, uint64_t any, uint32_t samples, uint32_t sample) {
    constexpr uint64_t kQuadOrigins = 0x0055005500550055;
    uint64_t quads = any | any >> 1;
    quads = (quads | quads >> 8) & kQuadOrigins;
    const SamplePosition position = samplePositions(samples_)[sample];
    const uint32_t wanted = ((1u << samples) - 1) << sample;
    for (; quads != 0; quads &= quads - 1) {
        reserve(4);
        const auto origin = static_cast<uint32_t>(std::countr_zero(quads));
        for (const uint32_t bit : {origin, origin + 8}) {
            const uint32_t first = appendSpan(tileX_ + block.x + static_cast<int32_t>(bit & 7),
                                              tileY_ + block.y + static_cast<int32_t>(bit >> 3), 2);
            for (uint32_t n = 0; n < 2; ++n) {
                batch_.coverage[first + n] = coverageOf(block, bit + n, samples_) & wanted;
                batch_.store[first + n] = batch_.coverage[first + n] != 0 ? ~0u : 0u;
                batch_.sample[first + n] = sample;
                batch_.offsetX[first + n] = position.x();
                batch_.offsetY[first + n] = position.y();
            }
        }
    }
}

void FragmentStage::flush() {
    if (batch_.count != 0) {
        run();
        batch_.count = 0;
        batch_.segmentCount = 0;
        batch_.spanCount = 0;
        if (plan_->ordered) inBatch_.fill(0);
        // The primitive being added goes on in the next batch.
        if (batch_.planesCount > 1) batch_.planes[0] = batch_.planes[batch_.planesCount - 1];
    }
    batch_.planesCount = std::min(batch_.planesCount, 1u);
}

void FragmentStage::run() {
    const uint32_t count = batch_.count, lanes = (count + 3) / 4 * 4;
    std::fill_n(batch_.execute.begin(), count, ~0u);
    if (!plan_->usesQuads) std::fill_n(batch_.store.begin(), count, ~0u);
    for (uint32_t lane = count; lane < capacity_; ++lane) batch_.execute[lane] = batch_.store[lane] = 0;
    fillInputs();
    if (!context_->run(lanes, batch_.execute.data(), batch_.store.data())) outOfBudget_ = true;
    ++statistics_.batches;
    uint32_t stored = count;
    if (plan_->usesQuads)
        for (uint32_t lane = 0; lane < count; ++lane) stored -= 1 - (batch_.store[lane] & 1);
    statistics_.fragmentInvocations += stored;
    statistics_.helperInvocations += count - stored;
    if (!plan_->keepsCoverage) {
        const uint32_t* live = context_->liveMask();
        for (uint32_t lane = 0; lane < count; ++lane) batch_.coverage[lane] &= live[lane];
        reduceCoverage();
        if (!plan_->depth.early && testsDepth()) testLate();
    }
    if (plan_->coverageIsFull) statistics_.samplesPassed += count;
    for (uint32_t s = 0; s < samples_ && !plan_->coverageIsFull; ++s) {
        uint32_t passed = 0;
        for (uint32_t lane = 0; lane < count; ++lane) passed += batch_.coverage[lane] >> s & 1;
        statistics_.samplesPassed += passed;
    }
    writeColors();
}

void FragmentStage::fillInputs() {
    const bool wantsFragCoord = plan_->usesFragCoord;
    if (plan_->needsBarycentrics || wantsFragCoord) {
        WeightsInput input{&batch_, nullptr, nullptr, plan_->smoothCount > 0, plan_->preciseInterpolation};
        if (plan_->perSample) {
            input.offsetX = batch_.offsetX.data();
            input.offsetY = batch_.offsetY.data();
        }
        const FragCoordOutput fragCoord{wantsFragCoord ? fragZ_.data() : nullptr,
                                        wantsFragCoord ? fragInverseW_.data() : nullptr};
        statistics_.perspectiveDivides += interpolation_.weights(input, weights_, fragCoord);
        if (plan_->needsCentroid && !plan_->perSample) {
            centroidOffsets();
            input.offsetX = centroidX_.data();
            input.offsetY = centroidY_.data();
            statistics_.perspectiveDivides += interpolation_.weights(input, centroidWeights_, {nullptr, nullptr});
        }
    }
    fillBuiltins();
    fillVaryings();
}

/// Where centroid inputs are evaluated: the centre when the pixel is fully covered, else its first covered
/// sample.
void FragmentStage::centroidOffsets() {
    const SamplePosition* positions = samplePositions(samples_);
    const uint32_t full = (1u << samples_) - 1;
    for (uint32_t lane = 0; lane < batch_.count; ++lane) {
        const uint32_t coverage = batch_.coverage[lane];
        const bool centre = coverage == full || coverage == 0;
        const SamplePosition position = centre ? SamplePosition{8, 8} : positions[std::countr_zero(coverage)];
        centroidX_[lane] = position.x();
        centroidY_[lane] = position.y();
    }
}

void FragmentStage::fillVaryings() {
    for (uint32_t k = 0; k < plan_->varyings.size(); ++k) {
        const Varying& varying = plan_->varyings[k];
        float* plane = varyingPlanes_[k];
        if (plane == nullptr) continue;
        if (varying.interpolation == ir::Interpolation::flat) {
            copyFlat(batch_, k, plane);
        } else {
            const bool centroid = varying.sampling == ir::Sampling::centroid && !plan_->perSample;
            evaluateVarying(k, centroid ? centroidWeights_ : weights_, plane);
        }
    }
}

void FragmentStage::evaluateVarying(uint32_t index, const LaneWeights& weights, float* plane) {
    const bool linear = plan_->varyings[index].interpolation == ir::Interpolation::noPerspective;
    if (plan_->preciseInterpolation) {
        interpolatePrecise(batch_, linear ? weights.preciseLinear1.data() : weights.precise1.data(),
                           linear ? weights.preciseLinear2.data() : weights.precise2.data(), index, plane);
        return;
    }
    interpolation_.attribute({&batch_, linear ? weights.linear1.data() : weights.perspective1.data(),
                              linear ? weights.linear2.data() : weights.perspective2.data(), index, capacity_, plane});
}

void FragmentStage::fillBuiltins() {
    for (const BuiltinSlot& builtin : plan_->fragmentBuiltins)
        if (float* plane = context_->input(builtin.slot); plane != nullptr) fillBuiltin(builtin, plane);
}

void FragmentStage::fillBuiltin(const BuiltinSlot& builtin, float* plane) {
    const uint32_t c = builtin.component;
    const auto eachLane = [&](const auto& value) {
        for (uint32_t lane = 0; lane < batch_.count; ++lane) {
            const auto v = value(lane);
            static_assert(sizeof(v) == 4);
            std::memcpy(plane + lane, &v, 4);
        }
    };
    const auto eachSegment = [&](const auto& value) {
        for (uint32_t s = 0; s < batch_.segmentCount; ++s) {
            const FragmentSegment& part = batch_.segments[s];
            const uint32_t bits = value(*batch_.planes[part.planes].primitive);
            for (uint32_t lane = part.first; lane < part.first + part.count; ++lane)
                std::memcpy(plane + lane, &bits, 4);
        }
    };
    const bool perSample = plan_->perSample;
    switch (builtin.builtin) {
        case ir::Builtin::fragCoord:
            if (c == 0)
                eachLane([&](uint32_t n) {
                    return static_cast<float>(batch_.x[n]) + (perSample ? batch_.offsetX[n] : 0.5f);
                });
            if (c == 1)
                eachLane([&](uint32_t n) {
                    return static_cast<float>(batch_.y[n]) + (perSample ? batch_.offsetY[n] : 0.5f);
                });
            if (c == 2) eachLane([&](uint32_t n) { return fragZ_[n]; });
            if (c == 3) eachLane([&](uint32_t n) { return fragInverseW_[n]; });
            return;
        case ir::Builtin::frontFacing:
            eachSegment([](const Primitive& p) { return p.front ? ~0u : 0u; });
            return;
        case ir::Builtin::primitiveId:
            eachSegment([](const Primitive& p) { return p.primitiveId; });
            return;
        case ir::Builtin::sampleId:
            eachLane([&](uint32_t n) { return batch_.sample[n]; });
            return;
        case ir::Builtin::samplePosition:
            eachLane([&](uint32_t n) { return c == 0 ? batch_.offsetX[n] : batch_.offsetY[n]; });
            return;
        case ir::Builtin::sampleMaskIn:
            eachLane([&](uint32_t n) { return c == 0 ? batch_.coverage[n] : 0u; });
            return;
        case ir::Builtin::helperInvocation:
            eachLane([&](uint32_t n) { return ~batch_.store[n]; });
            return;
        case ir::Builtin::pointCoord:
            // s = 1/2 + (x_f - x_p) / size (specification, "Basic Point Rasterization").
            for (uint32_t s = 0; s < batch_.segmentCount; ++s) {
                const FragmentSegment& part = batch_.segments[s];
                const Primitive& p = *batch_.planes[part.planes].primitive;
                for (uint32_t n = part.first; n < part.first + part.count; ++n) {
                    const float at = c == 0 ? static_cast<float>(batch_.x[n]) + (perSample ? batch_.offsetX[n] : 0.5f)
                                            : static_cast<float>(batch_.y[n]) + (perSample ? batch_.offsetY[n] : 0.5f);
                    plane[n] = p.isPoint ? 0.5f + (at - p.point[c == 0 ? 0 : 1]) * p.point[2] : 0.0f;
                }
            }
            return;
        default:
            eachLane([](uint32_t) { return 0u; });
    }
}

/// Coverage after the program: its own sample mask, and alpha to coverage.
void FragmentStage::reduceCoverage() {
    if (plan_->sampleMaskSlot != kNoSlot) {
        const float* plane = context_->output(plan_->sampleMaskSlot);
        for (uint32_t lane = 0; lane < batch_.count; ++lane)
            batch_.coverage[lane] &= std::bit_cast<uint32_t>(plane[lane]);
    }
    if (plan_->alphaToCoverage && plan_->alphaSlot != kNoSlot) {
        const float* alpha = context_->output(plan_->alphaSlot);
        const auto samples = static_cast<float>(samples_);
        for (uint32_t lane = 0; lane < batch_.count; ++lane) {
            const float a = alpha[lane] > 0 ? std::min(alpha[lane], 1.0f) : 0.0f;
            const auto count = static_cast<uint32_t>(a * samples + 0.5f);
            batch_.coverage[lane] &= (1u << count) - 1;
        }
    }
}

void FragmentStage::testLate() {
    const float* fragDepth = plan_->fragDepthSlot != kNoSlot ? context_->output(plan_->fragDepthSlot) : nullptr;
    const SamplePosition* positions = samplePositions(samples_);
    for (uint32_t s = 0; s < batch_.segmentCount; ++s) {
        const FragmentSegment& part = batch_.segments[s];
        const TrianglePlanes& planes = batch_.planes[part.planes];
        for (uint32_t lane = part.first; lane < part.first + part.count; ++lane) {
            const uint32_t covered = batch_.coverage[lane];
            uint32_t passed = 0;
            for (uint32_t rest = covered; rest != 0; rest &= rest - 1) {
                const auto sample = static_cast<uint32_t>(std::countr_zero(rest));
                const float z =
                    fragDepth != nullptr
                        ? (fragDepth[lane] > planes.zLow ? std::min(fragDepth[lane], planes.zHigh) : planes.zLow)
                        : depthAt(planes, batch_.x[lane], batch_.y[lane], positions[sample].x(), positions[sample].y());
                std::byte* texel = depthState_.target.texel(batch_.x[lane], batch_.y[lane], sample);
                ++statistics_.depthReads;
                if (testSample(depthState_, texel, z, planes.primitive->front)) passed |= 1u << sample;
            }
            batch_.coverage[lane] = passed;
        }
    }
}

const float* FragmentStage::outputPlane(uint32_t slot, uint32_t component) const {
    if (component == 3 && plan_->alphaToOne) return ones_.data();
    if (slot != kNoSlot) return context_->output(slot);
    return component == 3 ? ones_.data() : zeros_.data();
}

void FragmentStage::writeColors() {
    for (const ColorPlan& plan : plan_->colors) {
        if (targets_->colors[plan.attachment].data == nullptr) continue;  // VK_ATTACHMENT_UNUSED
        ColorOutputInput input{};
        input.plan = &plan;
        input.target = &targets_->colors[plan.attachment];
        input.batch = &batch_;
        input.blend = blend_;
        input.constants = draw_->call.dynamic->blendConstants.data();
        for (uint32_t c = 0; c < 4; ++c) {
            input.source[c] = outputPlane(plan.slots[c], c);
            input.second[c] = outputPlane(plan.dualSlots[c], c);
        }
        if (plan_->coverageIsFull) {
            statistics_.destinationReads += outputColors(input, colors_);
            continue;
        }
        input.mask = mask_.data();
        for (uint32_t s = 0; s < samples_; ++s) {
            uint32_t any = 0;
            for (uint32_t lane = 0; lane < batch_.count; ++lane) {
                mask_[lane] = (batch_.coverage[lane] >> s & 1) != 0 ? ~0u : 0u;
                any |= mask_[lane];
            }
            if (any == 0) continue;
            input.sample = s;
            statistics_.destinationReads += outputColors(input, colors_);
        }
    }
}

/// interpolateAtCentroid, -Sample, -Offset: one lane at a time.
void FragmentStage::interpolateAt(void* self, uint32_t slot, uint32_t where, uint32_t lanes, const float* a,
                                  const float* b, float* result) {
    auto& stage = *static_cast<FragmentStage*>(self);
    const FragmentBatch& batch = stage.batch_;
    const std::vector<Varying>& varyings = stage.plan_->varyings;
    const auto found =
        std::find_if(varyings.begin(), varyings.end(), [&](const Varying& v) { return v.fragmentSlot == slot; });
    std::fill_n(result, lanes, 0.0f);
    if (found == varyings.end()) return;
    const auto k = static_cast<size_t>(found - varyings.begin());
    const SamplePosition* positions = samplePositions(stage.samples_);
    const uint32_t full = (1u << stage.samples_) - 1;
    for (uint32_t s = 0; s < batch.segmentCount; ++s) {
        const FragmentSegment& part = batch.segments[s];
        const TrianglePlanes& planes = batch.planes[part.planes];
        for (uint32_t n = part.first; n < std::min(part.first + part.count, lanes); ++n) {
            if (found->interpolation == ir::Interpolation::flat) {
                std::memcpy(result + n, planes.flat + k, 4);
                continue;
            }
            SamplePosition position{8, 8};
            float ox = 0, oy = 0;
            if (where == 0 && batch.coverage[n] != full && batch.coverage[n] != 0)
                position = positions[std::countr_zero(batch.coverage[n])];
            if (where == 1) position = positions[std::min(std::bit_cast<uint32_t>(a[n]), stage.samples_ - 1)];
            if (where == 2) {
                ox = a[n];
                oy = b[n];
            }
            const Barycentrics at =
                barycentricsAt(planes, batch.x[n], batch.y[n], position.x() + ox, position.y() + oy);
            const bool linear = found->interpolation == ir::Interpolation::noPerspective;
            const double a0 = double{planes.attributes[0][k]};
            const double d1 = double{planes.attributes[1][k]} - a0, d2 = double{planes.attributes[2][k]} - a0;
            result[n] = static_cast<float>(a0 + ((linear ? at.l1 : at.b1) * d1 + (linear ? at.l2 : at.b2) * d2));
        }
    }
}

}  // namespace vernier
