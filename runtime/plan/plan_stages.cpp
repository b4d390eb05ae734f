#include "runtime/plan/plan_stages.h"

#include "runtime/plan/check_state.h"

namespace vernier {
namespace {

StagePlan planStage(const ir::Program& producer, const ir::Program& stage) {
    StagePlan plan;
    for (uint32_t slot = 0; slot < stage.inputs.size(); ++slot) {
        const ir::InterfaceSlot& input = stage.inputs[slot];
        if (input.index == 0) {
            plan.builtins.push_back({input.builtin, input.component, slot});
            continue;
        }
        StageInput from{slot, kNoSlot, input.index - 1u};
        for (uint32_t out = 0; out < producer.outputs.size(); ++out) {
            const ir::InterfaceSlot& output = producer.outputs[out];
            if (output.builtin == input.builtin && output.location == input.location &&
                output.component == input.component)
                from.from = out;
        }
        plan.inputs.push_back(from);
    }
    return plan;
}

StagePlan planEvaluation(const ir::Program& control, const ir::Program& evaluation) {
    StagePlan plan;
    for (uint32_t slot = 0; slot < evaluation.inputs.size(); ++slot) {
        const ir::InterfaceSlot& input = evaluation.inputs[slot];
        const bool level = input.builtin == ir::Builtin::tessLevelOuter || input.builtin == ir::Builtin::tessLevelInner;
        if (input.index == 0 && input.builtin != ir::Builtin::user && !level) {
            plan.builtins.push_back({input.builtin, input.component, slot});
            continue;
        }
        StageInput from{slot, kNoSlot, 0};
        for (uint32_t word = 0; word < control.outputs.size(); ++word) {
            const ir::InterfaceSlot& output = control.outputs[word];
            if (output.builtin == input.builtin && output.location == input.location &&
                output.component == input.component && output.index == input.index)
                from.from = word;
        }
        plan.inputs.push_back(from);
    }
    return plan;
}

void planTessellation(const GraphicsState& state, const ShaderProgram& program, const ir::Program& control,
                      Plan& plan) {
    plan.inputVertices = state.patchControlPoints;
    plan.tessellation = program.tessellation();
    TessellationOrder& order = plan.tessellation.order;
    // The domain's picture has v downwards unless the state says otherwise: the one way round is then the other.
    if (order == TessellationOrder::none) order = TessellationOrder::counterClockwise;
    if (!state.domainLowerLeft)
        order =
            order == TessellationOrder::clockwise ? TessellationOrder::counterClockwise : TessellationOrder::clockwise;
    for (uint32_t word = 0; word < control.outputs.size(); ++word) {
        const ir::InterfaceSlot& output = control.outputs[word];
        if (output.builtin == ir::Builtin::tessLevelOuter && output.component < plan.outerLevelWords.size())
            plan.outerLevelWords[output.component] = word;
        if (output.builtin == ir::Builtin::tessLevelInner && output.component < plan.innerLevelWords.size())
            plan.innerLevelWords[output.component] = word;
    }
    plan.rasterTopology = topologyOf(program.tessellation());
}

}  // namespace

void planStages(const GraphicsState& state, const ShaderProgram& program, Plan& plan) {
    const std::vector<StageProgram>& stages = program.stages();
    plan.stages = stages.size() > 1;
    plan.rasterTopology = state.topology;
    for (size_t n = 1; n < stages.size(); ++n) {
        const ir::Program &producer = stages[n - 1].program->source(), &stage = stages[n].program->source();
        if (stage.stage == ir::Stage::control) {
            plan.control = planStage(producer, stage);
            planTessellation(state, program, stage, plan);
        }
        if (stage.stage == ir::Stage::evaluation) plan.evaluation = planEvaluation(producer, stage);
        if (stage.stage != ir::Stage::geometry) continue;
        plan.geometry = planStage(producer, stage);
        if (n == 1) plan.inputVertices = ir::verticesOf(stage.geometry.input);
        plan.rasterTopology = topologyOf(stage.geometry.output);
    }
}

}  // namespace vernier
