#include "runtime/plan/shader_program.h"

#include "spirv_interp/ir/link.h"
#include "spirv_interp/ir/optimise.h"
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

}  // namespace

Result<std::shared_ptr<const ShaderProgram>> ShaderProgram::create(const ShaderProgramDesc& desc) {
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram);
    program->accuracy_ = desc.accuracy;
    program->isa_ = desc.isa;
    program->skips_ = desc.skips;
    const bool dropUnread = desc.skips.has(Skip::unreadOutputs);
    const bool hasFragment = desc.fragment != nullptr;
    ir::Program vertexIr = *desc.vertex, fragmentIr = hasFragment ? *desc.fragment : emptyFragment();
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
    if (Status status = ir::linkStages(vertexIr, fragmentIr, &facts, linking); !status) return status.error();
    program->removedVaryings_ = facts.removedOutputs;
    program->lifted_ = facts.lifted;

    BatchOptions options{desc.isa, desc.accuracy.math};
    options.verified = true;
    const auto compile = [&](ir::Program& ir, const char* stage, std::shared_ptr<const BatchProgram>& to) -> Status {
        auto compiled = BatchProgram::compile(std::move(ir), options);
        if (!compiled) return Error{compiled.error().code, std::string(stage) + " shader: " + compiled.error().message};
        to = std::move(compiled).value();
        return {};
    };
    if (Status status = compile(vertexIr, "vertex", program->vertex_); !status) return status.error();
    if (desc.capture != nullptr) program->capture_ = planCapture(*desc.capture, program->vertexIr());
    if (auto split = desc.skips.has(Skip::sharedSamples) ? ir::splitSamples(fragmentIr) : std::nullopt) {
        if (Status status = compile(split->pixel, "fragment", program->pixelPart_); !status) return status.error();
        if (Status status = compile(split->sample, "fragment", program->samplePart_); !status) return status.error();
    }
    if (hasFragment)
        if (Status status = compile(fragmentIr, "fragment", program->fragment_); !status) return status.error();
    return std::shared_ptr<const ShaderProgram>(program);
}

}  // namespace vernier
