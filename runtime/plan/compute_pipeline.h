// A compute pipeline: one program, compiled once. What varies between dispatches (resources, group counts) is no part
// of it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/accuracy.h"
#include "runtime/plan/fact.h"
#include "spirv_interp/program.h"

namespace vernier {

struct ComputePipelineDesc {
    const ir::Program* program = nullptr;  // of the compute stage, as loadShader gives it
    Accuracy accuracy;
    Isa isa = kLowestIsa;
};

/// Immutable; shared between threads.
class ComputePipeline {
  public:
    /// Checks the work-group against runtime/limits.h and compiles. Thread-safe.
    static Result<std::shared_ptr<const ComputePipeline>> create(const ComputePipelineDesc& desc);

    const Accuracy& accuracy() const { return accuracy_; }
    Isa isa() const { return isa_; }
    const ir::Program& ir() const { return program_->source(); }
    const std::shared_ptr<const BatchProgram>& program() const { return program_; }
    const std::array<uint32_t, 3>& localSize() const { return ir().localSize; }
    uint32_t invocations() const { return localSize()[0] * localSize()[1] * localSize()[2]; }  // of a work-group

    /// What a dispatch with this pipeline will run, at what rate and accuracy, and why.
    std::vector<Fact> explain() const;

  private:
    ComputePipeline() = default;
    Accuracy accuracy_;
    Isa isa_ = kLowestIsa;
    std::shared_ptr<const BatchProgram> program_;
};

/// Empty if a dispatch may have these counts; otherwise which of them is above kMaxWorkGroupCount.
Status checkGroupCounts(const std::array<uint32_t, 3>& counts);

}  // namespace vernier
