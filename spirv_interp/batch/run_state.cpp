#include "spirv_interp/batch/run_state.h"

#include <algorithm>
#include <new>

namespace vernier::batch {
namespace {

constexpr std::align_val_t kAlign{64};

}  // namespace

Words::Words(size_t count)
    : data_(static_cast<uint32_t*>(::operator new[](std::max<size_t>(count, 1) * sizeof(uint32_t), kAlign))) {
    std::fill_n(data_.get(), count, 0u);
}

void Words::Free::operator()(uint32_t* data) const {
    ::operator delete[](data, kAlign);
}

SharedState::SharedState(std::shared_ptr<const BatchProgram> p)
    : program(std::move(p)),
      compiled(static_cast<const CompiledProgram&>(*program)),
      scalars(compiled.scalars()),
      imageScratch(size_t{kImageScratchRows} * kMaxLanes) {}

RunState::RunState(SharedState& shared, const Code& code)
    : shared_(&shared),
      code_(&code),
      rows_(size_t{code.rows} * code.rowLanes),
      local_(size_t{shared.compiled.source().localWords} * code.lanes),
      localWords_(size_t{shared.compiled.source().localWords} * code.lanes),
      masks_(code.masks) {
    frame.rows = reinterpret_cast<std::byte*>(rows_.get());
    frame.scalars = shared.scalars.data();
    frame.rowBytes = code.rowLanes * static_cast<uint32_t>(sizeof(uint32_t));
    frame.masks = masks_.data();
    frame.bindings = &shared.bindings;
    frame.program = &shared.compiled.source();
    frame.imageSites = code.imageSites.data();
    frame.indexedRows = code.indexedRows.data();
    frame.local = local_.get();
    frame.localStride = code.lanes;
    frame.imageScratch = shared.imageScratch.get();
    frame.blockRuns = shared.compiled.blockRuns();
}

void RunState::begin(uint32_t lanes, const LaneMask& exec, const LaneMask& live) {
    if (frame.suspends) {
        scalars_ = shared_->scalars;
        frame.scalars = scalars_.data();
    }
    frame.lanes = (lanes + kLaneGroup - 1) / kLaneGroup * kLaneGroup;
    frame.backEdgesLeft = shared_->compiled.options().backEdges;
    frame.lost = false;
    frame.exec = exec;
    frame.live = live;
    frame.masks[kCurrentMask] = exec;
    frame.resume = exec.empty() ? nullptr : CompiledProgram::beginning(frame, *code_);
    if (localWords_ != 0) std::fill_n(frame.local, localWords_, 0u);
}

bool RunState::run() {
    const Inst* at = frame.resume;
    frame.resume = nullptr;
    shared_->compiled.execute(frame, at);
    if (frame.lost) abandon();
    return !frame.lost;
}

void RunState::abandon() {
    // Every lane that enters a block's mask leaves it again, unless the run was cut short.
    std::fill(masks_.begin(), masks_.end(), LaneMask{});
    frame.resume = nullptr;
}

void RunState::runStraight() {
    if (code_->instructions <= 1) return;
    const LaneMask all = LaneMask::first(kLaneGroup);
    frame.lanes = kLaneGroup;
    frame.exec = frame.live = frame.masks[kCurrentMask] = all;
    shared_->compiled.execute(frame, CompiledProgram::beginning(frame, *code_));
}

}  // namespace vernier::batch
