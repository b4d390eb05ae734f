#include "runtime/plan/shader_program.h"

#include <algorithm>
#include <string>

#include "spirv_interp/ir/limit_vertices.h"
#include "spirv_interp/ir/link.h"
#include "spirv_interp/ir/names.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/place_vertices.h"
#include "spirv_interp/ir/split_samples.h"

namespace vernier {
namespace {

/// Stands in where there is no fragment stage: nobody reads the varyings, so that linking drops them all.
ir::Program emptyFragment() {
    ir::Program program;
    program.stage = ir::Stage::fragment;
    program.blocks.emplace_back();
    program.blocks[0].insts.emplace_back().op = ir::Op::ret;
    return program;
}

/// Outputs that no attachment keeps go, with what only they needed.
void dropColors(ir::Program& fragment, uint32_t kept) {
    const auto dropped = [&](const ir::Inst& inst) {
        if (inst.op != ir::Op::storeOutput) return false;
        const ir::InterfaceSlot& slot = fragment.outputs[inst.imm];
        return slot.builtin == ir::Builtin::user && slot.location < 32 && (kept >> slot.location & 1) == 0;
    };
    size_t count = 0;
    for (ir::Block& block : fragment.blocks) count += std::erase_if(block.insts, dropped);
    if (count != 0) ir::optimise(fragment);
}

Status addTessellation(const ShaderProgramDesc& desc, std::vector<ir::Program>& stages) {
    if (desc.control == nullptr && desc.evaluation == nullptr) return {};
    if (desc.control == nullptr || desc.evaluation == nullptr)
        return invalidArgument(std::string("tessellation: there is no ") +
                               (desc.control == nullptr ? "control" : "evaluation") + " shader");
    if (desc.tessellation.domain == TessellationDomain::none)
        return invalidArgument("tessellation: neither shader says whether patches are triangles, quads or isolines");
    stages.push_back(*desc.control);
    if (desc.patchControlPoints != 0) ir::limitVertices(stages.back(), desc.patchControlPoints);
    stages.push_back(*desc.evaluation);
    ir::limitVertices(stages.back(), desc.tessellation.outputVertices);
    return {};
}

}  // namespace

std::shared_ptr<const BatchProgram> ShaderProgram::stage(ir::Stage stage) const {
    const auto found = std::find_if(stages_.begin(), stages_.end(),
                                    [&](const StageProgram& program) { return program.stage == stage; });
    return found == stages_.end() ? nullptr : found->program;
}

Result<std::shared_ptr<const ShaderProgram>> ShaderProgram::create(const ShaderProgramDesc& desc) {
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram);
    program->accuracy_ = desc.accuracy;
    program->isa_ = desc.isa;
    program->skips_ = desc.skips;
    const bool dropUnread = desc.skips.has(Skip::unreadOutputs);
    const bool hasFragment = desc.fragment != nullptr;
    std::vector<ir::Program> stages{*desc.vertex};
    if (Status status = addTessellation(desc, stages); !status) return status.error();
    program->tessellation_ = desc.tessellation;
    if (desc.geometry != nullptr) stages.push_back(*desc.geometry);
    ir::Program fragmentIr = hasFragment ? *desc.fragment : emptyFragment();
    if (hasFragment && dropUnread) dropColors(fragmentIr, desc.keptColors);
    ir::LinkFacts facts;
    ir::LinkOptions linking;
    // Where linear work is lifted, bits change: that belongs to the accuracy in force, and nobody can leave it.
    linking.liftLinear = desc.accuracy.math == MathTier::fast;
    linking.lift = linking.liftLinear || desc.skips.has(Skip::perVertexWork);
    linking.dropUnread = !hasFragment || dropUnread;
    std::vector<ir::InterfaceSlot> captured;
    if (desc.capture != nullptr)
        for (const CapturedWord& word : desc.capture->words) captured.push_back(word.output);
    linking.kept = captured;
    // From the end, so that what an output goes without is not asked of the stage before.
    if (Status status = ir::linkStages(stages.back(), fragmentIr, &facts, linking); !status) return status.error();
    program->removedVaryings_ = facts.removedOutputs;
    program->lifted_ = facts.lifted;
    linking.kept = {};
    for (size_t n = stages.size() - 1; n > 0; --n) {
        // The rows of patches are as the control stage lays them out, whoever reads them.
        linking.dropUnread = dropUnread && stages[n - 1].stage != ir::Stage::control;
        if (Status status = ir::linkStages(stages[n - 1], stages[n], &facts, linking); !status) return status.error();
        program->removedVaryings_ += facts.removedOutputs;
    }

    BatchOptions options{desc.isa, desc.accuracy.math};
    options.verified = true;
    const auto compile = [&](ir::Program& ir, const char* stage, std::shared_ptr<const BatchProgram>& to) -> Status {
        auto compiled = BatchProgram::compile(std::move(ir), options);
        if (!compiled) return Error{compiled.error().code, std::string(stage) + " shader: " + compiled.error().message};
        to = std::move(compiled).value();
        return {};
    };
    for (ir::Program& stage : stages) {
        StageProgram& compiled = program->stages_.emplace_back(StageProgram{stage.stage, nullptr});
        if (stage.stage == ir::Stage::geometry) ir::placeVertices(stage);
        const std::string name(ir::nameOf(stage.stage));
        options.lanes = stage.stage == ir::Stage::geometry ? ir::kVertexLanes : 0;
        if (Status status = compile(stage, name.c_str(), compiled.program); !status) return status.error();
    }
    options.lanes = 0;
    if (desc.capture != nullptr) program->capture_ = planCapture(*desc.capture, program->lastIr());
    if (auto split = desc.skips.has(Skip::sharedSamples) ? ir::splitSamples(fragmentIr) : std::nullopt) {
        if (Status status = compile(split->pixel, "fragment", program->pixelPart_); !status) return status.error();
        if (Status status = compile(split->sample, "fragment", program->samplePart_); !status) return status.error();
    }
    if (hasFragment)
        if (Status status = compile(fragmentIr, "fragment", program->fragment_); !status) return status.error();
    return std::shared_ptr<const ShaderProgram>(program);
}

}  // namespace vernier
