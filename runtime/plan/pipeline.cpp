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
    if (Status status = checkInterfaces(desc.state, program); !status) return status.error();
    std::shared_ptr<GraphicsPipeline> pipeline(new GraphicsPipeline());
    pipeline->state_ = desc.state;
    pipeline->program_ = desc.program;
    pipeline->control_ = program.stage(ir::Stage::control);
    pipeline->evaluation_ = program.stage(ir::Stage::evaluation);
    pipeline->geometry_ = program.stage(ir::Stage::geometry);
    pipeline->plan_ = std::make_unique<const Plan>(makePlan(desc.state, program));
    if (pipeline->plan_->quadsForLevels)
        pipeline->planWithoutQuads_ = std::make_unique<const Plan>(vernier::planWithoutQuads(*pipeline->plan_));
    return std::shared_ptr<const GraphicsPipeline>(std::move(pipeline));
}

std::vector<Fact> GraphicsPipeline::explain(const DynamicState& dynamic) const {
    std::vector<Fact> facts = plan_->facts;
    const auto leftOut = [](const char* what, const char* why) {
        return Fact{.runs = false, .what = what, .why = why, .rates = {}};
    };
    const auto& viewport = dynamic.viewports[0];
    if (viewport.width == 0 || viewport.height == 0) facts.push_back(leftOut("rasterisation", "the viewport is empty"));
    const auto& scissor = dynamic.scissors[0];
    if (scissor.extent.width == 0 || scissor.extent.height == 0)
        facts.push_back(leftOut("rasterisation", "the scissor is empty"));
    if (state_.depthBiasEnable && dynamic.depthBiasConstant == 0 && dynamic.depthBiasSlope == 0)
        for (Fact& fact : facts)
            if (fact.what == "depth bias") fact = leftOut("depth bias", "both factors are zero");
    return facts;
}

}  // namespace vernier
