#include "runtime/plan/shader_program.h"

#include "spirv_interp/ir/link.h"

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

/// Linking, which optimises, then removes what only these outputs needed.
void dropColors(ir::Program& fragment, uint32_t kept) {
    const auto dropped = [&](const ir::Inst& inst) {
        if (inst.op != ir::Op::storeOutput) return false;
        const ir::InterfaceSlot& slot = fragment.outputs[inst.imm];
        return slot.builtin == ir::Builtin::user && slot.location < 32 && (kept >> slot.location & 1) == 0;
    };
    for (ir::Block& block : fragment.blocks) std::erase_if(block.insts, dropped);
}

}  // namespace

Result<std::shared_ptr<const ShaderProgram>> ShaderProgram::create(const ShaderProgramDesc& desc) {
    const std::shared_ptr<ShaderProgram> program(new ShaderProgram);
    program->accuracy_ = desc.accuracy;
    program->isa_ = desc.isa;
    const bool hasFragment = desc.fragment != nullptr;
    ir::Program vertexIr = *desc.vertex, fragmentIr = hasFragment ? *desc.fragment : emptyFragment();
    if (hasFragment) dropColors(fragmentIr, desc.keptColors);
    ir::LinkFacts facts;
    ir::LinkOptions linking;
    linking.liftLinear = desc.accuracy.math == MathTier::fast;
    if (Status status = ir::linkStages(vertexIr, fragmentIr, &facts, linking); !status) return status.error();
    program->removedVaryings_ = facts.removedOutputs;
    program->lifted_ = facts.lifted;

    BatchOptions options{desc.isa, desc.accuracy.math};
    options.verified = true;
    auto compiled = BatchProgram::compile(std::move(vertexIr), options);
    if (!compiled) return Error{compiled.error().code, "vertex shader: " + compiled.error().message};
    program->vertex_ = std::move(compiled).value();
    if (hasFragment) {
        auto fragment = BatchProgram::compile(std::move(fragmentIr), options);
        if (!fragment) return Error{fragment.error().code, "fragment shader: " + fragment.error().message};
        program->fragment_ = std::move(fragment).value();
    }
    return std::shared_ptr<const ShaderProgram>(program);
}

}  // namespace vernier
