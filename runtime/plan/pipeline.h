// A graphics pipeline: state and shaders, planned once. The plan says which stages run, at what rate and accuracy, and why;
// explain() tells it in words.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/accuracy.h"
#include "runtime/plan/graphics_state.h"
#include "spirv_interp/program.h"

namespace vernier {

struct GraphicsPipelineDesc {
    GraphicsState state;
    ShaderSource vertex;
    ShaderSource fragment;  // no words: no fragment stage (depth only, or rasterizer discard)
    Accuracy accuracy;
    Isa isa = Isa::sse4;
};

struct Plan;  // runtime/plan/plan.h

class GraphicsPipeline {
  public:
    /// Loads and links the shaders, checks them against the state (vertex formats, attachment formats, interfaces), and
    /// plans. Thread-safe.
    static Result<std::shared_ptr<const GraphicsPipeline>> create(const GraphicsPipelineDesc& desc);
    ~GraphicsPipeline();

    const GraphicsState& state() const { return state_; }
    const Accuracy& accuracy() const { return accuracy_; }
    Isa isa() const { return isa_; }
    const ir::Program& vertexIr() const { return vertexIr_; }
    const ir::Program* fragmentIr() const { return hasFragment_ ? &fragmentIr_ : nullptr; }
    const std::shared_ptr<const BatchProgram>& vertexProgram() const { return vertexProgram_; }
    const std::shared_ptr<const BatchProgram>& fragmentProgram() const { return fragmentProgram_; }
    const Plan& plan() const { return *plan_; }

    /// What a draw with this pipeline will run, at what rate and accuracy, what it leaves out and why; one fact a line.
    std::string explain(const DynamicState& dynamic) const;

  private:
    GraphicsPipeline();
    GraphicsState state_;
    Accuracy accuracy_;
    Isa isa_ = Isa::sse4;
    ir::Program vertexIr_, fragmentIr_;
    bool hasFragment_ = false;
    std::shared_ptr<const BatchProgram> vertexProgram_, fragmentProgram_;
    std::unique_ptr<const Plan> plan_;
};

}  // namespace vernier
