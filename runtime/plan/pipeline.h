// A graphics pipeline: state and shaders, planned once. The plan says which stages run, at what rate and accuracy, and
// why; explain() tells it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "runtime/plan/fact.h"
#include "runtime/plan/graphics_state.h"
#include "runtime/plan/shader_program.h"

namespace vernier {

struct GraphicsPipelineDesc {
    GraphicsState state;
    std::shared_ptr<const ShaderProgram> program;
};

struct Plan;  // runtime/plan/plan.h

class GraphicsPipeline {
  public:
    /// Checks the program against the state (vertex formats, attachment formats, interfaces), and plans. Thread-safe.
    static Result<std::shared_ptr<const GraphicsPipeline>> create(const GraphicsPipelineDesc& desc);
    ~GraphicsPipeline();

    const GraphicsState& state() const { return state_; }
    const ShaderProgram& program() const { return *program_; }
    const Accuracy& accuracy() const { return program_->accuracy(); }
    Isa isa() const { return program_->isa(); }
    const ir::Program& vertexIr() const { return program_->vertexIr(); }
    const ir::Program* fragmentIr() const { return program_->fragmentIr(); }
    const std::shared_ptr<const BatchProgram>& vertexProgram() const { return program_->vertex(); }
    /// nullptr without tessellation stages.
    const std::shared_ptr<const BatchProgram>& controlProgram() const { return control_; }
    const std::shared_ptr<const BatchProgram>& evaluationProgram() const { return evaluation_; }
    /// nullptr without a geometry stage.
    const std::shared_ptr<const BatchProgram>& geometryProgram() const { return geometry_; }
    const std::shared_ptr<const BatchProgram>& fragmentProgram() const { return program_->fragment(); }
    const Plan& plan() const { return *plan_; }
    /// For draws whose images need no level of detail; nullptr if that makes no difference.
    const Plan* planWithoutQuads() const { return planWithoutQuads_.get(); }

    /// What a draw with this pipeline will run, at what rate and accuracy, what it leaves out and why.
    std::vector<Fact> explain(const DynamicState& dynamic) const;

  private:
    GraphicsPipeline();
    GraphicsState state_;
    std::shared_ptr<const ShaderProgram> program_;
    std::shared_ptr<const BatchProgram> control_, evaluation_, geometry_;
    std::unique_ptr<const Plan> plan_, planWithoutQuads_;
};

}  // namespace vernier
