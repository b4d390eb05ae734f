#include "runtime/plan/pipeline.h"

#include "runtime/plan/check_state.h"
#include "runtime/plan/plan.h"

namespace vernier {

GraphicsPipeline::GraphicsPipeline() = default;
GraphicsPipeline::~GraphicsPipeline() = default;

Result<std::shared_ptr<const GraphicsPipeline>> GraphicsPipeline::create(const GraphicsPipelineDesc& desc) {
    if (desc.program == nullptr) return invalidArgument("GraphicsPipelineDesc::program is null");
    const ShaderProgram& program = *desc.program;
    if (Status status = checkGraphicsState(desc.state, program.accuracy()); !status) return status.error();
    if (Status status = checkInterfaces(desc.state, program.vertexIr()); !status) return status.error();
    std::shared_ptr<GraphicsPipeline> pipeline(new GraphicsPipeline());
    pipeline->state_ = desc.state;
    pipeline->program_ = desc.program;
    pipeline->plan_ = std::make_unique<const Plan>(makePlan(desc.state, program));
    return std::shared_ptr<const GraphicsPipeline>(std::move(pipeline));
}

std::string GraphicsPipeline::explain(const DynamicState& dynamic) const {
    std::string text;
    const auto line = [&](const char* verb, const std::string& what, const std::string& why) {
        text += verb + what + ": " + why + "\n";
    };
    for (const PlanFact& fact : plan_->facts)
        line(fact.kind == PlanFact::Kind::runs ? "runs      " : "left out  ", fact.what, fact.why);
    const auto& viewport = dynamic.viewports[0];
    if (viewport.width == 0 || viewport.height == 0) line("left out  ", "rasterisation", "the viewport is empty");
    const auto& scissor = dynamic.scissors[0];
    if (scissor.extent.width == 0 || scissor.extent.height == 0)
        line("left out  ", "rasterisation", "the scissor is empty");
    if (state_.depthBiasEnable && dynamic.depthBiasConstant == 0 && dynamic.depthBiasSlope == 0)
        line("left out  ", "depth bias", "both factors are zero");
    return text;
}

}  // namespace vernier
