// The memory that running code works in, for the contexts of program.h.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "spirv_interp/batch/compiled.h"

namespace vernier::batch {

/// Zeroed 64-byte aligned words.
class Words {
  public:
    explicit Words(size_t count);
    uint32_t* get() const { return data_.get(); }

  private:
    struct Free {
        void operator()(uint32_t* data) const;
    };
    std::unique_ptr<uint32_t, Free> data_;
};

/// What the pieces of one program share in one context. Frames point into it: it does not move.
struct SharedState {
    explicit SharedState(std::shared_ptr<const BatchProgram> p);
    SharedState(const SharedState&) = delete;
    SharedState& operator=(const SharedState&) = delete;

    std::shared_ptr<const BatchProgram> program;
    const CompiledProgram& compiled;
    std::vector<uint32_t> scalars;
    Words imageScratch;
    ResourceBindings bindings;
};

/// The registers, masks and local memory of one piece of code, and the frame that points at them.
class RunState {
  public:
    RunState(SharedState& shared, const Code& code);

    /// Sets up a run from the beginning on the first `lanes` lanes, of which `exec` run and `live` have effects. Local
    /// memory becomes zero: a variable that is read before it is written does not hold what an earlier run left.
    void begin(uint32_t lanes, const LaneMask& exec, const LaneMask& live);
    /// Runs on from the beginning or from where the last call stopped at a barrier. Returns false if a loop passed the
    /// back-edge budget; the run is then over.
    bool run();
    bool ended() const { return frame.resume == nullptr; }
    /// Forgets a run that did not come to its end.
    void abandon();
    /// Runs code without control flow on one lane group, for its scalars.
    void runStraight();

    /// The row of an input or output; nullptr if there is none.
    uint32_t* row(uint32_t offset) const { return offset == kNone ? nullptr : frame.row<uint32_t>(offset); }

    Frame frame;

  private:
    const SharedState* shared_;
    const Code* code_;
    Words rows_, local_;
    size_t localWords_;
    std::vector<LaneMask> masks_;
    std::vector<uint32_t> scalars_;  // of a batch that others run beside: it changes them
};

}  // namespace vernier::batch
