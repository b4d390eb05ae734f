#include <algorithm>
#include <cstdlib>
#include <new>

#include "spirv_interp/batch/compiled.h"
#include "spirv_interp/program.h"

namespace vernier {
namespace {

/// Zeroed 64-byte aligned words.
class Rows {
  public:
    explicit Rows(size_t words)
        : data_(static_cast<uint32_t*>(::operator new[](std::max<size_t>(words, 1) * sizeof(uint32_t), kAlign))) {
        std::fill_n(data_.get(), words, 0u);
    }
    uint32_t* get() const { return data_.get(); }

  private:
    static constexpr std::align_val_t kAlign{64};
    struct Free {
        void operator()(uint32_t* data) const { ::operator delete[](data, kAlign); }
    };
    std::unique_ptr<uint32_t, Free> data_;
};

}  // namespace

struct BatchContext::Impl {
    explicit Impl(std::shared_ptr<const BatchProgram> p)
        : program(std::move(p)),
          compiled(static_cast<const batch::CompiledProgram&>(*program)),
          batchRows(size_t{compiled.batch().rows} * compiled.batch().lanes),
          drawRows(size_t{compiled.draw().rows} * compiled.draw().lanes),
          local(size_t{compiled.source().localWords} * compiled.batch().lanes),
          imageScratch(size_t{batch::kImageScratchRows} * batch::kMaxLanes),
          live(batch::kMaxLanes),
          scalars(compiled.scalars()),
          masks(std::max(compiled.batch().masks, compiled.draw().masks)),
          batchFrame(frameFor(compiled.batch(), batchRows)) {}

    /// Everything about a frame but its lanes; `code` is one of the program's pieces.
    batch::Frame frameFor(const batch::Code& code, const Rows& rows) {
        batch::Frame frame;
        frame.rows = reinterpret_cast<std::byte*>(rows.get());
        frame.scalars = scalars.data();
        frame.rowBytes = code.lanes * static_cast<uint32_t>(sizeof(uint32_t));
        frame.masks = masks.data();
        frame.bindings = &bindings;
        frame.program = &compiled.source();
        frame.imageSites = code.imageSites.data();
        frame.indexedRows = code.indexedRows.data();
        frame.local = local.get();
        frame.localStride = compiled.batch().lanes;
        frame.imageScratch = imageScratch.get();
        return frame;
    }

    std::shared_ptr<const BatchProgram> program;
    const batch::CompiledProgram& compiled;
    Rows batchRows, drawRows, local, imageScratch, live;
    std::vector<uint32_t> scalars;
    std::vector<batch::LaneMask> masks;
    ResourceBindings bindings;
    batch::Frame batchFrame;
};

BatchContext::BatchContext(std::shared_ptr<const BatchProgram> program)
    : impl_(std::make_unique<Impl>(std::move(program))) {}
BatchContext::~BatchContext() = default;
BatchContext::BatchContext(BatchContext&&) noexcept = default;
BatchContext& BatchContext::operator=(BatchContext&&) noexcept = default;

void BatchContext::beginDraw(const ResourceBindings& bindings) {
    impl_->bindings = bindings;
    const batch::Code& code = impl_->compiled.draw();
    if (code.instructions <= 1) return;
    batch::Frame frame = impl_->frameFor(code, impl_->drawRows);
    frame.lanes = batch::kLaneGroup;
    frame.exec = frame.live = batch::LaneMask::first(batch::kLaneGroup);
    frame.masks[batch::kCurrentMask] = frame.exec;
    batch::execute(frame, code.insts.data());
}

float* BatchContext::input(uint32_t slot) {
    const auto& inputs = impl_->compiled.batch().inputs;
    if (slot >= inputs.size() || inputs[slot] == batch::kNone) return nullptr;
    return reinterpret_cast<float*>(reinterpret_cast<std::byte*>(impl_->batchRows.get()) + inputs[slot]);
}

const float* BatchContext::output(uint32_t slot) const {
    const auto& outputs = impl_->compiled.batch().outputs;
    if (slot >= outputs.size() || outputs[slot] == batch::kNone) return nullptr;
    return reinterpret_cast<const float*>(reinterpret_cast<const std::byte*>(impl_->batchRows.get()) + outputs[slot]);
}

bool BatchContext::run(uint32_t lanes, const uint32_t* execMask, const uint32_t* storeMask) {
    const batch::Code& code = impl_->compiled.batch();
    lanes = std::min(lanes, code.lanes);
    batch::Frame& frame = impl_->batchFrame;
    frame.lanes = (lanes + batch::kLaneGroup - 1) / batch::kLaneGroup * batch::kLaneGroup;
    frame.backEdges = 0;
    frame.lost = false;
    const batch::MaskFunctions& maskWords = impl_->compiled.masks();
    frame.exec = maskWords.pack(execMask, frame.lanes) & batch::LaneMask::first(lanes);
    frame.live = maskWords.pack(storeMask, frame.lanes) & frame.exec;
    frame.masks[batch::kCurrentMask] = frame.exec;
    // A variable that is read before it is written holds zero, not what an earlier batch left there.
    const size_t localWords = impl_->compiled.source().localWords;
    if (localWords != 0) std::fill_n(frame.local, localWords * code.lanes, 0u);
    if (!frame.exec.empty()) batch::execute(frame, code.insts.data());
    // Every lane that enters a block's mask leaves it again, unless the run was cut short.
    if (frame.lost) std::fill(impl_->masks.begin(), impl_->masks.end(), batch::LaneMask{});
    maskWords.spread(frame.live, impl_->live.get(), code.lanes);
    return !frame.lost;
}

const uint32_t* BatchContext::liveMask() const {
    return impl_->live.get();
}

void BatchContext::setInterpolator(const Interpolator& interpolator) {
    impl_->batchFrame.interpolator = interpolator;
}

}  // namespace vernier
