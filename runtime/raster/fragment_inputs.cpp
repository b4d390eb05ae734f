// The inputs of a batch of fragments: varyings and built-ins.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "runtime/raster/bits.h"
#include "runtime/raster/fragment_stage.h"

namespace vernier {

/// Sorts the varyings that the program reads by how they get their values.
void FragmentStage::bindInputs() {
    for (VaryingTargets* targets : {&centreTargets_, &centroidTargets_, &sampleTargets_, &pixelTargets_}) *targets = {};
    const auto add = [](VaryingTargets& targets, const Varying& varying, const VaryingTarget& target) {
        if (target.plane == nullptr) return;
        (varying.interpolation == ir::Interpolation::flat            ? targets.flat
         : varying.interpolation == ir::Interpolation::noPerspective ? targets.linear
                                                                     : targets.smooth)
            .push_back(target);
    };
    for (uint32_t k = 0; k < plan_->varyings.size(); ++k) {
        const Varying& varying = plan_->varyings[k];
        if (varying.pixelSlot != kNoSlot) add(pixelTargets_, varying, {k, pixelContext_->input(varying.pixelSlot)});
        if (varying.fragmentSlot == kNoSlot) continue;
        const bool centre =
            varying.sampling == ir::Sampling::center || varying.interpolation == ir::Interpolation::flat;
        const bool centroid = varying.sampling == ir::Sampling::centroid && plan_->needsCentroid;
        VaryingTargets& targets = plan_->perSample && (plan_->allAtSample || !centre) ? sampleTargets_
                                  : centroid && !centre                               ? centroidTargets_
                                                                                      : centreTargets_;
        add(targets, varying, {k, context_->input(varying.fragmentSlot)});
    }
}

/// What interpolation needs besides the batch. Filled once per draw: clearing it costs more than a block's colours.
void FragmentStage::bindInterpolation() {
    const auto bindTo = [&](InterpolationInput& input, const VaryingTargets& targets, const float* x, const float* y) {
        input = {};
        input.capacity = capacity_;
        input.perspective = !targets.smooth.empty();
        input.smooth = targets.smooth;
        input.linear = targets.linear;
        input.flat = targets.flat;
        input.offsetX = x;
        input.offsetY = y;
    };
    const float* const centre = plan_->coarse ? ones_.data() : nullptr;  // of 2x2 pixels: one pixel further
    bindTo(centreInput_, centreTargets_, centre, centre);
    bindTo(centroidInput_, centroidTargets_, centroidX_.data(), centroidY_.data());
    bindTo(sampleInput_, sampleTargets_, batch_.offsetX.data(), batch_.offsetY.data());
    if (!plan_->perSample) centreInput_.perspective = plan_->smoothCount > 0;
    bindTo(pixelInput_, pixelTargets_, nullptr, nullptr);
    if (plan_->usesFragCoord) {
        InterpolationInput& first = plan_->perSample ? sampleInput_ : centreInput_;
        first.fragZ = fragZ_.data();
        first.fragInverseW = fragInverseW_.data();
    }
}

void FragmentStage::interpolate(const FragmentBatch& batch, InterpolationInput& input) {
    input.batch = &batch;
    const bool precise = plan_->preciseInterpolation;
    InterpolationInput others;
    if (precise) {
        // The weights in float serve gl_FragCoord alone.
        others = input;
        others.smooth = others.linear = {};
    }
    const uint32_t divided = interpolate_(precise ? others : input);
    const uint32_t pixels = batch.partial ? batch.running : batch.count;
    if (batch.order != LaneOrder::spans && batch.segmentCount > 1) {  // each divides for pixels of its own
        const uint32_t second = countBits(secondPixels_ >> blockShift_ & blockRectangle_);
        const uint32_t own[] = {pixels - second, second};
        for (uint32_t s = 0; s < batch.segmentCount; ++s)
            if (input.perspective && !batch.segments[s].planes->affine) statistics_.perspectiveDivides += own[s];
    } else {
        statistics_.perspectiveDivides += std::min(divided, pixels);
    }
    if (precise) interpolatePrecise(input);
}

void FragmentStage::fillInputs(const FragmentBatch& batch) {
    if (plan_->perSample && (!sampleTargets_.empty() || plan_->usesFragCoord)) interpolate(batch, sampleInput_);
    if (!plan_->perSample || !centreTargets_.empty()) interpolate(batch, centreInput_);
    if (!centroidTargets_.empty()) {
        centroidOffsets(batch);
        interpolate(batch, centroidInput_);
    }
    if (batch.order == LaneOrder::spans && batch.apart) takeSmallInputs(batch);
    fillBuiltins(batch, plan_->fragmentBuiltins, *context_);
}

/// Where centroid inputs are evaluated: the centre when the pixel is fully covered, else its first covered
/// sample.
void FragmentStage::centroidOffsets(const FragmentBatch& batch) {
    const uint32_t full = (1u << samples_) - 1;
    for (uint32_t lane = 0; lane < batch.count; ++lane) {
        const uint32_t coverage = batch.coverage[lane];
        const bool centre = coverage == full || coverage == 0;
        const SamplePosition position = centre ? SamplePosition{8, 8} : positions_[std::countr_zero(coverage)];
        centroidX_[lane] = position.x();
        centroidY_[lane] = position.y();
    }
}

void FragmentStage::fillBuiltins(const FragmentBatch& batch, std::span<const BuiltinSlot> builtins,
                                 BatchContext& context) {
    for (const BuiltinSlot& builtin : builtins)
        if (float* plane = context.input(builtin.slot); plane != nullptr) fillBuiltin(batch, builtin, plane);
}

void FragmentStage::fillBuiltin(const FragmentBatch& batch, const BuiltinSlot& builtin, float* plane) {
    const uint32_t c = builtin.component;
    const auto eachLane = [&](const auto& value) {
        for (uint32_t lane = 0; lane < batch.count; ++lane) {
            const auto v = value(lane);
            static_assert(sizeof(v) == 4);
            std::memcpy(plane + lane, &v, 4);
        }
    };
    const auto eachSegment = [&](const auto& value) {
        for (uint32_t s = 0; s < batch.segmentCount; ++s) {
            const FragmentSegment& part = batch.segments[s];
            const uint32_t bits = value(*part.planes->primitive);
            for (uint32_t lane = part.first; lane < part.first + part.count; ++lane)
                std::memcpy(plane + lane, &bits, 4);
        }
    };
    const bool perSample = plan_->perSample;
    const float centre = plan_->coarse ? 1.0f : 0.5f;
    switch (builtin.builtin) {
        case ir::Builtin::fragCoord:
            if (c == 0)
                eachLane([&](uint32_t n) {
                    return static_cast<float>(batch.x[n]) + (perSample ? batch.offsetX[n] : centre);
                });
            if (c == 1)
                eachLane([&](uint32_t n) {
                    return static_cast<float>(batch.y[n]) + (perSample ? batch.offsetY[n] : centre);
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
        case ir::Builtin::layer:
        case ir::Builtin::viewIndex:  // with multiview, views go to the layers of the same number
            eachSegment([](const Primitive& p) { return uint32_t{p.layer}; });
            return;
        case ir::Builtin::viewportIndex:
            eachSegment([](const Primitive& p) { return uint32_t{p.viewport}; });
            return;
        case ir::Builtin::sampleId:
            eachLane([&](uint32_t n) { return batch.sample[n]; });
            return;
        case ir::Builtin::samplePosition:
            eachLane([&](uint32_t n) { return c == 0 ? batch.offsetX[n] : batch.offsetY[n]; });
            return;
        case ir::Builtin::sampleMaskIn:
            eachLane([&](uint32_t n) {
                return c != 0 ? 0u : plan_->maskBeforeTests ? batch.rasterized[n] : batch.coverage[n];
            });
            return;
        case ir::Builtin::helperInvocation:
            eachLane([&](uint32_t n) { return ~batch.store[n]; });
            return;
        case ir::Builtin::pointCoord:
            // s = 1/2 + (x_f - x_p) / size (specification, "Basic Point Rasterization").
            for (uint32_t s = 0; s < batch.segmentCount; ++s) {
                const FragmentSegment& part = batch.segments[s];
                const Primitive& p = *part.planes->primitive;
                for (uint32_t n = part.first; n < part.first + part.count; ++n) {
                    const float at = c == 0 ? static_cast<float>(batch.x[n]) + (perSample ? batch.offsetX[n] : 0.5f)
                                            : static_cast<float>(batch.y[n]) + (perSample ? batch.offsetY[n] : 0.5f);
                    plane[n] = p.isPoint ? 0.5f + (at - p.point[c == 0 ? 0 : 1]) * p.point[2] : 0.0f;
                }
            }
            return;
        default:
            eachLane([](uint32_t) { return 0u; });
    }
}

/// interpolateAtCentroid, -Sample, -Offset: by the operations that the inputs themselves have, so that the same place
/// gives the same value.
void FragmentStage::interpolateAt(void* self, uint32_t slot, uint32_t where, uint32_t lanes, const float* a,
                                  const float* b, float* result) {
    auto& stage = *static_cast<FragmentStage*>(self);
    if (stage.current_ == &stage.block_) stage.placeBlock();
    const FragmentBatch& batch = *stage.current_;
    const std::vector<Varying>& varyings = stage.plan_->varyings;
    const auto found =
        std::find_if(varyings.begin(), varyings.end(), [&](const Varying& v) { return v.fragmentSlot == slot; });
    std::fill_n(result, lanes, 0.0f);
    if (found == varyings.end()) return;
    alignas(64) std::array<float, kLaneRoom> x{}, y{}, value{};
    const uint32_t full = (1u << stage.samples_) - 1;
    for (uint32_t n = 0; n < std::min(batch.count, lanes); ++n) {
        SamplePosition position{8, 8};
        if (where == 0 && batch.coverage[n] != full && batch.coverage[n] != 0)
            position = stage.positions_[std::countr_zero(batch.coverage[n])];
        if (where == 1) position = stage.positions_[std::min(std::bit_cast<uint32_t>(a[n]), stage.samples_ - 1)];
        x[n] = position.x() + (where == 2 ? a[n] : 0.0f);
        y[n] = position.y() + (where == 2 ? b[n] : 0.0f);
    }
    const VaryingTarget target{static_cast<uint32_t>(found - varyings.begin()), value.data()};
    InterpolationInput input{};
    input.batch = &batch;
    input.offsetX = x.data();
    input.offsetY = y.data();
    input.capacity = kLaneRoom;
    const bool flat = found->interpolation == ir::Interpolation::flat;
    input.perspective = !flat && found->interpolation != ir::Interpolation::noPerspective;
    (flat ? input.flat : input.perspective ? input.smooth : input.linear) = {&target, 1};
    if (stage.plan_->preciseInterpolation && !flat)
        interpolatePrecise(input);
    else
        stage.interpolate_(input);
    std::copy_n(value.begin(), std::min(batch.count, lanes), result);
}

}  // namespace vernier
