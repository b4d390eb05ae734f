#include "spirv_interp/ir/analyse.h"

#include <algorithm>

#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

/// Keeps the used slots; renumbered[i] = new index of slot i.
std::vector<uint32_t> dropUnused(std::vector<InterfaceSlot>& slots, const std::vector<bool>& used) {
    std::vector<uint32_t> renumbered(slots.size());
    uint32_t next = 0;
    for (size_t i = 0; i < slots.size(); ++i) {
        renumbered[i] = next;
        if (used[i]) slots[next++] = slots[i];
    }
    slots.resize(next);
    return renumbered;
}

void dropUnusedSlots(Program& program) {
    std::vector<bool> inputs(program.inputs.size()), outputs(program.outputs.size());
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            const ImmKind kind = immKind(inst.op);
            if (kind == ImmKind::input) inputs[inst.imm] = true;
            if (kind == ImmKind::output) outputs[inst.imm] = true;
            if (inst.op != Op::inputIndexed) continue;
            for (uint32_t i = 0; i < immHigh(inst); ++i) inputs[immLow(inst) + i] = true;
        }
    }
    // Where outputs have places in memory, they tell what lies there.
    const bool placed = std::any_of(program.resources.begin(), program.resources.end(), [](const Resource& resource) {
        return resource.kind == ResourceKind::stageMemory;
    });
    if (placed) outputs.assign(outputs.size(), true);
    const std::vector<uint32_t> newInput = dropUnused(program.inputs, inputs);
    const std::vector<uint32_t> newOutput = dropUnused(program.outputs, outputs);
    for (Block& block : program.blocks) {
        for (Inst& inst : block.insts) {
            const ImmKind kind = immKind(inst.op);
            if (kind == ImmKind::input) inst.imm = newInput[inst.imm];
            if (kind == ImmKind::output) inst.imm = newOutput[inst.imm];
            if (inst.op == Op::inputIndexed) inst.imm = immPair(newInput[immLow(inst)], immHigh(inst));
        }
    }
}

/// A store to a resource; kNoIndex: to any that can be written.
void markWritten(const Program& program, uint32_t resource, std::vector<bool>& written) {
    if (resource != kNoIndex) {
        written[resource] = true;
        return;
    }
    for (size_t r = 0; r < written.size(); ++r) {
        if (isWritable(program.resources[r].kind)) written[r] = true;
    }
}

/// What is written through one of the resources that share memory is written for all of them.
void spreadAliases(const Program& program, std::vector<bool>& written) {
    bool any = false;
    for (size_t r = 0; r < written.size(); ++r) any = any || (written[r] && program.resources[r].aliased);
    for (size_t r = 0; any && r < written.size(); ++r) written[r] = written[r] || program.resources[r].aliased;
}

}  // namespace

void analyse(Program& program) {
    dropUnusedSlots(program);
    program.usesQuads = program.canDiscard = program.hasSideEffects = false;
    program.hasBarriers = program.usesSubgroups = false;
    std::vector<bool> written(program.resources.size());
    for (const Block& block : program.blocks) {
        for (const Inst& inst : block.insts) {
            switch (inst.op) {
                case Op::ddxFine:
                case Op::ddyFine:
                case Op::ddxCoarse:
                case Op::ddyCoarse:
                    program.usesQuads = true;
                    break;
                case Op::kill:
                case Op::demote:
                    program.canDiscard = true;
                    break;
                case Op::quadShuffle:
                    program.usesQuads = program.usesSubgroups = true;
                    break;
                case Op::subgroupInvocation:
                case Op::subgroupBallot:
                case Op::subgroupShuffle:
                case Op::subgroupReduce:
                    program.usesSubgroups = true;
                    break;
                case Op::controlBarrier:
                    program.hasBarriers = true;
                    break;
                case Op::storeBuffer:
                    markWritten(program, resourceOf(inst), written);
                    break;
                case Op::atomicBuffer:
                    if (static_cast<AtomicOp>(immHigh(inst)) != AtomicOp::load) {
                        markWritten(program, resourceOf(inst), written);
                    }
                    break;
                case Op::storeAddress:
                case Op::atomicAddress:
                    // An address may lie in any buffer.
                    markWritten(program, kNoIndex, written);
                    program.hasSideEffects = true;
                    break;
                case Op::image:
                case Op::imageStore: {
                    const ImageOp& op = program.imageOps[inst.imm];
                    if (op.kind == ImageKind::sampleImplicit || op.kind == ImageKind::queryLod)
                        program.usesQuads = true;
                    if (op.kind == ImageKind::store || op.kind == ImageKind::atomic) written[op.imageResource] = true;
                    break;
                }
                default:
                    break;
            }
        }
    }
    spreadAliases(program, written);
    program.usesQuads = program.usesQuads && program.stage == Stage::fragment;
    for (size_t r = 0; r < written.size(); ++r) {
        // Memory of the runner is no memory of the draw, whoever writes it; nor does it outlive what runs.
        const bool own = isOfRunner(program.resources[r].kind);
        program.resources[r].readOnly = !written[r] && !own;
        program.hasSideEffects = program.hasSideEffects || (written[r] && !own);
    }
    program.writesDepth = program.writesSampleMask = program.perSample = false;
    for (const InterfaceSlot& slot : program.outputs) {
        if (slot.builtin == Builtin::fragDepth) program.writesDepth = true;
        if (slot.builtin == Builtin::sampleMask) program.writesSampleMask = true;
    }
    for (const InterfaceSlot& slot : program.inputs) {
        if (slot.builtin == Builtin::sampleId || slot.builtin == Builtin::samplePosition ||
            slot.sampling == Sampling::sample) {
            program.perSample = true;
        }
    }
}

}  // namespace vernier::ir
