#include <algorithm>

#include "spirv_interp/batch/own_memory.h"
#include "spirv_interp/program.h"

namespace vernier {

struct BatchContext::Impl {
    explicit Impl(std::shared_ptr<const BatchProgram> p)
        : shared(std::move(p)),
          draw(shared, shared.compiled.draw()),
          batch(shared, shared.compiled.batch()),
          live(batch::kMaxLanes),
          memory(shared.compiled.source()) {}

    batch::SharedState shared;
    batch::RunState draw, batch;
    batch::Words live;  // what liveMask() was last asked for
    batch::OwnMemory memory;
    uint32_t groups = 0;  // of the last run: its lanes in whole groups
};

BatchContext::BatchContext(std::shared_ptr<const BatchProgram> program)
    : impl_(std::make_unique<Impl>(std::move(program))) {}
BatchContext::~BatchContext() = default;
BatchContext::BatchContext(BatchContext&&) noexcept = default;
BatchContext& BatchContext::operator=(BatchContext&&) noexcept = default;

void BatchContext::beginDraw(const ResourceBindings& bindings) {
    impl_->shared.bindings = impl_->memory.bind(bindings);
    impl_->draw.runStraight();
}

float* BatchContext::input(uint32_t slot) {
    const auto& inputs = impl_->shared.compiled.batch().inputs;
    return slot >= inputs.size() ? nullptr : reinterpret_cast<float*>(impl_->batch.row(inputs[slot]));
}

const float* BatchContext::output(uint32_t slot) const {
    const auto& outputs = impl_->shared.compiled.batch().outputs;
    return slot >= outputs.size() ? nullptr : reinterpret_cast<const float*>(impl_->batch.row(outputs[slot]));
}

uint32_t* BatchContext::stageMemory() {
    return impl_->memory.words();
}

const uint32_t* BatchContext::stageMemory() const {
    return impl_->memory.words();
}

bool BatchContext::run(uint32_t lanes, const uint32_t* execMask, const uint32_t* storeMask) {
    const batch::CompiledProgram& compiled = impl_->shared.compiled;
    lanes = std::min(lanes, compiled.batch().lanes);
    const uint32_t groups = (lanes + batch::kLaneGroup - 1) / batch::kLaneGroup * batch::kLaneGroup;
    const batch::MaskFunctions& maskWords = compiled.masks();
    const auto lanesOf = [&](const uint32_t* mask) {
        const batch::LaneMask first = batch::LaneMask::first(lanes);
        return mask == nullptr ? first : maskWords.pack(mask, groups) & first;
    };
    const batch::LaneMask exec = lanesOf(execMask);
    impl_->batch.begin(lanes, exec, lanesOf(storeMask) & exec);
    impl_->groups = groups;
    return impl_->batch.ended() || impl_->batch.run();
}

const uint32_t* BatchContext::liveMask() const {
    impl_->shared.compiled.masks().spread(impl_->batch.frame.live, impl_->live.get(), impl_->groups);
    return impl_->live.get();
}

void BatchContext::setInterpolator(const Interpolator& interpolator) {
    impl_->batch.frame.interpolator = interpolator;
}

}  // namespace vernier
