// The shaders of a pipeline: linked and compiled once, shared by every pipeline that draws with them whatever its
// other state.
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "base/simd.h"
#include "runtime/accuracy.h"
#include "runtime/plan/capture_plan.h"
#include "runtime/skips.h"
#include "spirv_interp/ir/lift.h"
#include "spirv_interp/program.h"
#include "spirv_interp/tessellation.h"

namespace vernier {

struct ShaderProgramDesc {
    const ir::Program* vertex = nullptr;  // as loadShader gives it
    // nullptr, both of them: no tessellation stages.
    const ir::Program* control = nullptr;
    const ir::Program* evaluation = nullptr;
    TessellationModes tessellation;          // of both, joined
    uint32_t patchControlPoints = 0;         // 0: the program is used with patches of any number of vertices
    const ir::Program* geometry = nullptr;   // nullptr: no geometry stage
    const ir::Program* fragment = nullptr;   // nullptr: no fragment stage (depth only, or rasterizer discard)
    const CaptureLayout* capture = nullptr;  // of the last program before the rasteriser; nullptr: nothing is captured
    // A bit per location whose colours some attachment keeps; what is behind the others is not computed. A program that
    // is used with any attachments keeps all.
    uint32_t keptColors = ~0u;
    Accuracy accuracy;
    Isa isa = kLowestIsa;
    Skips skips;
};

/// A stage of a pipeline that is compiled.
struct StageProgram {
    ir::Stage stage = ir::Stage::vertex;
    std::shared_ptr<const BatchProgram> program;
};

/// Immutable; shared between threads.
class ShaderProgram {
  public:
    /// Links (what the stage behind does not read is not computed) and compiles. Thread-safe.
    static Result<std::shared_ptr<const ShaderProgram>> create(const ShaderProgramDesc& desc);

    /// What runs before the rasteriser, or behind it.
    enum class Side : uint8_t { beforeRasteriser, behindRasteriser };
    /// Links and compiles the programs of one side by themselves, for join(): nothing is left out because the other
    /// side does not read or keep it. Of the others the description is ignored. Thread-safe.
    static Result<std::shared_ptr<const ShaderProgram>> createSide(const ShaderProgramDesc& desc, Side side);
    /// The program of two sides, without compiling anything; it gives the same bits as one that is linked. nullptr
    /// where they must be linked: the fragment program reads what the other side does not write, or the accuracy in
    /// force asks for work to be moved between them.
    static std::shared_ptr<const ShaderProgram> join(const ShaderProgram& before, const ShaderProgram& behind);

    const Accuracy& accuracy() const { return accuracy_; }
    Isa isa() const { return isa_; }
    const Skips& skips() const { return skips_; }
    const ir::Program& vertexIr() const { return vertex()->source(); }
    /// nullptr without a fragment stage.
    const ir::Program* fragmentIr() const { return fragment_ ? &fragment_->source() : nullptr; }
    const std::shared_ptr<const BatchProgram>& vertex() const { return stages_.front().program; }
    /// Those before the rasteriser, in the order in which they run; the first is the vertex stage.
    const std::vector<StageProgram>& stages() const { return stages_; }
    /// nullptr: the pipeline has no such stage.
    std::shared_ptr<const BatchProgram> stage(ir::Stage stage) const;
    /// Of its control and evaluation stages.
    const TessellationModes& tessellation() const { return tessellation_; }
    /// The program whose vertices the rasteriser gets.
    const ir::Program& lastIr() const { return stages_.back().program->source(); }
    const std::shared_ptr<const BatchProgram>& fragment() const { return fragment_; }
    /// The fragment program in two (ir/split_samples.h); nullptr where it is not worth it.
    const std::shared_ptr<const BatchProgram>& pixelPart() const { return pixelPart_; }
    const std::shared_ptr<const BatchProgram>& samplePart() const { return samplePart_; }
    /// What draws capture while transform feedback is active.
    const CapturePlan& capture() const { return capture_; }
    /// Outputs before the rasteriser that linking removed because nobody reads them, for explain().
    uint32_t removedVaryings() const { return removedVaryings_; }
    /// Operations of the fragment shader that linking moved into the vertex program, for explain().
    const ir::LiftFacts& lifted() const { return lifted_; }

  private:
    explicit ShaderProgram(const ShaderProgramDesc& desc)
        : accuracy_(desc.accuracy), isa_(desc.isa), skips_(desc.skips) {}
    Status compileStages(std::vector<ir::Program>& stages, const ShaderProgramDesc& desc);
    Status compileFragment(ir::Program& fragment);
    Status compile(ir::Program& ir, uint32_t lanes, std::shared_ptr<const BatchProgram>& to) const;

    Accuracy accuracy_;
    Isa isa_ = kLowestIsa;
    Skips skips_;
    std::vector<StageProgram> stages_;
    std::shared_ptr<const BatchProgram> fragment_, pixelPart_, samplePart_;
    TessellationModes tessellation_;
    CapturePlan capture_;
    uint32_t removedVaryings_ = 0;
    ir::LiftFacts lifted_;
};

}  // namespace vernier
