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

/// Where linear work is lifted, bits change: that belongs to the accuracy in force, and nobody can leave it.
bool liftsLinear(const Accuracy& accuracy) {
    return accuracy.math == MathTier::fast;
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

/// In the order in which they run.
Result<std::vector<ir::Program>> stagesBefore(const ShaderProgramDesc& desc) {
    std::vector<ir::Program> stages{*desc.vertex};
    if (Status status = addTessellation(desc, stages); !status) return status.error();
    if (desc.geometry != nullptr) stages.push_back(*desc.geometry);
    return stages;
}

}  // namespace

std::shared_ptr<const BatchProgram> ShaderProgram::stage(ir::Stage stage) const {
    const auto found = std::find_if(stages_.begin(), stages_.end(),
                                    [&](const StageProgram& program) { return program.stage == stage; });
    return found == stages_.end() ? nullptr : found->program;
}

Status ShaderProgram::compile(ir::Program& ir, uint32_t lanes, std::shared_ptr<const BatchProgram>& to) const {
    BatchOptions options{isa_, accuracy_.math};
    options.verified = true;
    options.lanes = lanes;
    const std::string name(ir::nameOf(ir.stage));
    auto compiled = BatchProgram::compile(std::move(ir), options);
    if (!compiled) return Error{compiled.error().code, name + " shader: " + compiled.error().message};
    to = std::move(compiled).value();
    return {};
}

/// From the end, so that what an output goes without is not asked of the stage before.
Status ShaderProgram::compileStages(std::vector<ir::Program>& stages, const ShaderProgramDesc& desc) {
    ir::LinkFacts facts;
    for (size_t n = stages.size() - 1; n > 0; --n) {
        ir::LinkOptions linking;
        // The rows of patches are as the control stage lays them out, whoever reads them.
        linking.dropUnread = desc.skips.has(Skip::unreadOutputs) && stages[n - 1].stage != ir::Stage::control;
        if (Status status = ir::linkStages(stages[n - 1], stages[n], &facts, linking); !status) return status;
        removedVaryings_ += facts.removedOutputs;
    }
    for (ir::Program& stage : stages) {
        StageProgram& compiled = stages_.emplace_back(StageProgram{stage.stage, nullptr});
        const bool isGeometry = stage.stage == ir::Stage::geometry;
        if (isGeometry) ir::placeVertices(stage);
        if (Status status = compile(stage, isGeometry ? ir::kVertexLanes : 0, compiled.program); !status) return status;
    }
    tessellation_ = desc.tessellation;
    if (desc.capture != nullptr) capture_ = planCapture(*desc.capture, lastIr());
    return {};
}

Status ShaderProgram::compileFragment(ir::Program& fragment) {
    if (auto split = skips_.has(Skip::sharedSamples) ? ir::splitSamples(fragment) : std::nullopt) {
        if (Status status = compile(split->pixel, 0, pixelPart_); !status) return status;
        if (Status status = compile(split->sample, 0, samplePart_); !status) return status;
    }
    return compile(fragment, 0, fragment_);
}

Result<std::shared_ptr<const ShaderProgram>> ShaderProgram::create(const ShaderProgramDesc& desc) {
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram(desc));
    const bool dropUnread = desc.skips.has(Skip::unreadOutputs);
    const bool hasFragment = desc.fragment != nullptr;
    Result<std::vector<ir::Program>> stages = stagesBefore(desc);
    if (!stages) return stages.error();
    ir::Program fragment = hasFragment ? *desc.fragment : emptyFragment();
    if (hasFragment && dropUnread) dropColors(fragment, desc.keptColors);
    ir::LinkFacts facts;
    ir::LinkOptions linking;
    linking.liftLinear = liftsLinear(desc.accuracy);
    linking.lift = linking.liftLinear || desc.skips.has(Skip::perVertexWork);
    linking.dropUnread = !hasFragment || dropUnread;
    std::vector<ir::InterfaceSlot> captured;
    if (desc.capture != nullptr)
        for (const CapturedWord& word : desc.capture->words) captured.push_back(word.output);
    linking.kept = captured;
    if (Status status = ir::linkStages(stages->back(), fragment, &facts, linking); !status) return status.error();
    program->removedVaryings_ = facts.removedOutputs;
    program->lifted_ = facts.lifted;
    if (Status status = program->compileStages(*stages, desc); !status) return status.error();
    if (hasFragment)
        if (Status status = program->compileFragment(fragment); !status) return status.error();
    return std::shared_ptr<const ShaderProgram>(program);
}

Result<std::shared_ptr<const ShaderProgram>> ShaderProgram::createSide(const ShaderProgramDesc& desc, Side side) {
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram(desc));
    if (side == Side::behindRasteriser) {
        ir::Program fragment = *desc.fragment;
        if (Status status = program->compileFragment(fragment); !status) return status.error();
        return std::shared_ptr<const ShaderProgram>(program);
    }
    Result<std::vector<ir::Program>> stages = stagesBefore(desc);
    if (!stages) return stages.error();
    if (Status status = program->compileStages(*stages, desc); !status) return status.error();
    return std::shared_ptr<const ShaderProgram>(program);
}

std::shared_ptr<const ShaderProgram> ShaderProgram::join(const ShaderProgram& before, const ShaderProgram& behind) {
    if (liftsLinear(before.accuracy()) || !ir::writesAll(before.lastIr(), *behind.fragmentIr())) return nullptr;
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram(before));
    program->fragment_ = behind.fragment_;
    program->pixelPart_ = behind.pixelPart_;
    program->samplePart_ = behind.samplePart_;
    return program;
}

}  // namespace vernier
