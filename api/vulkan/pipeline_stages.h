// The shaders of pipelines: loaded from modules, and made into programs.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <memory>

#include "api/vulkan/handle.h"
#include "api/vulkan/pipeline_state.h"
#include "runtime/plan/shader_program.h"
#include "spirv_interp/capture.h"
#include "spirv_interp/program.h"
#include "spirv_interp/tessellation.h"

namespace vernier::vulkan {

/// Loads the program of a stage with its specialization, from its module or from code that it brings itself.
Result<ir::Program> loadStage(const VkPipelineShaderStageCreateInfo& stage, ir::Stage kind);

struct LoadedStage {
    ir::Program program;
    CaptureLayout capture;    // of transform feedback
    TessellationModes modes;  // of a tessellation stage
};

inline constexpr size_t kStageCount = 5;
/// Shared between the libraries and pipelines that have them.
struct PipelineShaders {
    /// In the order in which they run; nullptr: not there, or in a part that is not.
    std::array<std::shared_ptr<const LoadedStage>, kStageCount> stages;
    /// What libraries have compiled of them: both sides of the rasteriser by themselves, or the whole.
    std::shared_ptr<const ShaderProgram> before, behind, whole;

    bool hasFragment() const { return stages.back() != nullptr; }
};

/// The stages of these parts; without a fragment stage if nothing gets there.
Result<PipelineShaders> loadStages(const VkGraphicsPipelineCreateInfo& info, PipelineParts parts, bool discards);
/// Adds those of `from`.
void takeShaders(PipelineShaders& to, const PipelineShaders& from);

/// The program of a pipeline: what libraries have compiled of it, joined, unless `optimise` wants it linked.
Result<std::shared_ptr<const ShaderProgram>> programOf(const Device& device, const PipelineShaders& shaders,
                                                       const PipelineState& state, bool optimise);
/// Whether programOf() and precompile() need not compile anything.
bool isCompiled(const PipelineShaders& shaders, const PipelineState& state, bool optimise);
/// Compiles what the parts allow, for the pipelines to be linked from them.
Status precompile(const Device& device, PipelineShaders& shaders, const PipelineState& state, bool optimise);

}  // namespace vernier::vulkan
