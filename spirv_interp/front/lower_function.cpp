// Functions: calls are inlined, blocks are lowered in structured order, phis of the module become variables written at
// the end of the predecessors.
#include <algorithm>

#include "spirv_interp/front/lowering.h"

namespace vernier {
namespace {

constexpr size_t kMaxCallDepth = 256;
constexpr uint32_t kMaxCalls = 1u << 16;
constexpr size_t kMaxInstructions = 1u << 20;
constexpr size_t kMaxEdges = 4096;  // into one block; Inst::operandCount has 16 bits

}  // namespace

struct Lowering::Frame {
    struct PhiVariables {
        Instruction inst;
        uint32_t first = 0;  // variable of the first leaf
    };

    const Function* function = nullptr;
    std::vector<ir::BlockId> blocks;              // by index in the function; kNoIndex = unreachable
    std::vector<std::vector<PhiVariables>> phis;  // by index in the function
    uint32_t returnVariables = 0;
    ir::BlockId returnBlock = ir::kNoIndex;  // kNoIndex: the only return falls through to what follows the call
    bool fellThrough = false;
};

void Lowering::lowerEntry(const EntryPoint& entry) {
    const Function* function = module_.function(entry.function);
    if (function == nullptr || function->blocks.empty()) {
        throw LoweringError{invalidArgument("SPIR-V: entry point '" + entry.name + "' has no body")};
    }
    Frame frame;
    frame.function = function;
    const bool putsOutVertices = program_.stage == ir::Stage::geometry;
    if (putsOutVertices) beginVertices();
    lowerFunction(*function, frame);
    emitter_.setLine(0);
    if (putsOutVertices) {
        endVertices();
    } else {
        storeOutputs();
    }
    emitter_.ret();
}

void Lowering::lowerFunction(const Function& function, Frame& frame) {
    if (calls_.size() >= kMaxCallDepth) refuseId(function.id, "is called too deep to be inlined");
    if (std::find(calls_.begin(), calls_.end(), &function) != calls_.end()) refuseId(function.id, "calls itself");
    if (++callCount_ > kMaxCalls)
        refuseId(function.id, "is called when " + std::to_string(kMaxCalls) + " calls are inlined");
    calls_.push_back(&function);
    const std::vector<StructuredBlock> order = structuredOrder(module_, function);
    frame.blocks.assign(function.blocks.size(), ir::kNoIndex);
    frame.phis.resize(function.blocks.size());
    size_t returns = 0;
    bool returnInLoop = false;
    for (size_t at = 0; at < order.size(); ++at) {
        const SpirvBlock& block = function.blocks[order[at].index];
        frame.blocks[order[at].index] = at == 0 ? emitter_.current() : emitter_.newBlock();
        returnInLoop = returnInLoop || order[at].loopEnd == order.size();
        for (uint32_t offset = block.first; offset < block.end;) {
            const Instruction inst = module_.next(offset);
            if (inst.op == spv::Op::OpReturn || inst.op == spv::Op::OpReturnValue) {
                ++returns;
            } else if (inst.op == spv::Op::OpPhi) {
                const auto leaves = static_cast<uint32_t>(leafTypes(inst[1]).size());
                if (leaves == 0) refuse(inst, "a phi of images or of pointers to variables is not supported");
                frame.phis[order[at].index].push_back({inst, emitter_.newVariables(leaves)});
            }
        }
    }
    const Instruction lastTerminator = [&] {
        const SpirvBlock& last = function.blocks[order.back().index];
        Instruction inst;
        for (uint32_t offset = last.first; offset < last.end;) inst = module_.next(offset);
        return inst;
    }();
    const bool lastReturns = lastTerminator.op == spv::Op::OpReturn || lastTerminator.op == spv::Op::OpReturnValue;
    if (returns != 1 || !lastReturns || returnInLoop) frame.returnBlock = emitter_.newBlock();
    if (typeInfo(function.resultType).leaves != 0) {
        frame.returnVariables = emitter_.newVariables(static_cast<uint32_t>(leafTypes(function.resultType).size()));
    }

    std::vector<std::pair<ir::BlockId, uint32_t>> openLoops;  // header, end in the order
    const auto closeLoopsAt = [&](size_t at) {
        while (!openLoops.empty() && openLoops.back().second == at) {
            if (emitter_.reached(openLoops.back().first)) emitter_.endLoop(openLoops.back().first);
            openLoops.pop_back();
        }
    };
    for (size_t at = 0; at < order.size(); ++at) {
        closeLoopsAt(at);
        const ir::BlockId block = frame.blocks[order[at].index];
        if (at != 0) {
            if (!emitter_.reached(block)) continue;
            if (program_.blocks[block].predecessors.size() > kMaxEdges) {
                refuseId(function.blocks[order[at].index].label, "has too many predecessors");
            }
            emitter_.begin(block, order[at].loopEnd != 0);
            if (order[at].loopEnd != 0) openLoops.emplace_back(block, order[at].loopEnd);
        }
        lowerBlock(function.blocks[order[at].index], frame);
    }
    closeLoopsAt(order.size());
    if (frame.returnBlock != ir::kNoIndex) {
        emitter_.begin(frame.returnBlock);
    } else if (!frame.fellThrough) {
        // The return is behind a condition that is constantly false: what follows is unreachable, and removed later.
        emitter_.begin(emitter_.newBlock());
    }
    calls_.pop_back();
}

void Lowering::lowerBlock(const SpirvBlock& block, Frame& frame) {
    const uint32_t index = frame.function->blockOfLabel.at(block.label);
    // A line ends with its block.
    emitter_.setLine(0);
    for (const Frame::PhiVariables& phi : frame.phis[index]) {
        const LeafTypes types = leafTypes(phi.inst[1]);
        const NewScalars leaves = newLeaves(types.size());
        for (uint32_t i = 0; i < types.size(); ++i) leaves[i] = emitter_.read(phi.first + i, types[i]);
        setValue(phi.inst[2], phi.inst[1], leaves);
    }
    for (uint32_t offset = block.first; offset < block.end;) {
        const Instruction inst = module_.next(offset);
        if (lowerTerminator(inst, block, frame)) return;
        lowerInstruction(inst);
        if (emitter_.instructionCount() > kMaxInstructions) {
            refuse(inst, "the program is too large: over " + std::to_string(kMaxInstructions) + " operations");
        }
    }
    refuseId(block.label, "has no end: the block lacks a branch or return");
}

void Lowering::lowerInstruction(const Instruction& inst) {
    switch (inst.op) {
        case spv::Op::OpLine:
        case spv::Op::OpNoLine:
            lowerLine(inst);
            return;
        case spv::Op::OpAssumeTrueKHR:
        case spv::Op::OpNop:
        case spv::Op::OpPhi:
        case spv::Op::OpLoopMerge:
        case spv::Op::OpSelectionMerge:
            return;
        case spv::Op::OpVariable:
            lowerVariable(inst);
            return;
        case spv::Op::OpUndef:
            lowerConstant(inst);
            return;
        case spv::Op::OpFunctionCall:
            lowerCall(inst);
            return;
        case spv::Op::OpDemoteToHelperInvocation:
            emitter_.emit(ir::Op::demote, ir::Type::none, {});
            return;
        case spv::Op::OpIsHelperInvocationEXT:
            setScalar(inst[2], inst[1], emitter_.emit(ir::Op::isHelper, ir::Type::b1, {}));
            return;
        case spv::Op::OpReadClockKHR:
            lowerClock(inst);
            return;
        case spv::Op::OpExtInst:
            if (module_.extendedSet(inst[3]) == "GLSL.std.450") break;
            lowerDebugInstruction(inst);
            return;
        default:
            break;
    }
    bool hasResult = false, hasType = false;
    spv::HasResultAndType(inst.op, &hasResult, &hasType);
    if (hasResult && hasType) {
        emitter_.setFlags(module_.hasDecoration(inst[2], spv::Decoration::NoContraction),
                          module_.hasDecoration(inst[2], spv::Decoration::RelaxedPrecision));
    }
    if (inst.op == spv::Op::OpExtInst) {
        lowerExtended(inst);
    } else if (!lowerMemory(inst) && !lowerComposite(inst) && !lowerArithmetic(inst) && !lowerImage(inst) &&
               !lowerBarrier(inst) && !lowerSubgroup(inst) && !lowerEmission(inst)) {
        refuse(inst, "the instruction is not supported");
    }
    emitter_.setFlags(false, false);
}

bool Lowering::lowerTerminator(const Instruction& inst, const SpirvBlock& block, Frame& frame) {
    switch (inst.op) {
        case spv::Op::OpBranch:
            writePhis(block.label, inst, frame);
            emitter_.jump(blockOf(inst[1], inst, frame));
            return true;
        case spv::Op::OpBranchConditional:
            writePhis(block.label, inst, frame);
            emitter_.branch(scalarOf(inst[1]), blockOf(inst[2], inst, frame), blockOf(inst[3], inst, frame));
            return true;
        case spv::Op::OpSwitch:
            writePhis(block.label, inst, frame);
            lowerSwitch(inst, frame);
            return true;
        case spv::Op::OpReturn:
        case spv::Op::OpReturnValue:
            lowerReturn(inst, frame);
            return true;
        case spv::Op::OpKill:
        case spv::Op::OpTerminateInvocation:
            emitter_.kill();
            return true;
        case spv::Op::OpUnreachable:
            // Never executed by a correct program; a wrong one ends here.
            emitter_.ret();
            return true;
        default:
            return false;
    }
}

ir::BlockId Lowering::blockOf(uint32_t label, const Instruction& inst, Frame& frame) {
    const auto found = frame.function->blockOfLabel.find(label);
    if (found == frame.function->blockOfLabel.end() || frame.blocks[found->second] == ir::kNoIndex) {
        refuse(inst, "goes to " + module_.nameOf(label) + ", which is no block of the function");
    }
    return frame.blocks[found->second];
}

/// A selector of 64 bits chooses among small numbers first, which then choose the block.
void Lowering::lowerSwitch(const Instruction& inst, Frame& frame) {
    const LeafType& type = scalarOfId(inst[1]);
    if (!ir::isInteger(type)) refuse(inst, "the selector is no integer");
    const bool wide = type.bits == 64;
    const uint32_t literalWords = literalWordsOf(module_, inst);
    ir::ValueId selector = scalarOf(inst[1]), chosen = emitter_.constantI32(0);
    std::vector<int32_t> cases;
    std::vector<ir::BlockId> targets;
    for (uint32_t word = 3; word + literalWords < inst.count; word += literalWords + 1) {
        targets.push_back(blockOf(inst[word + literalWords], inst, frame));
        if (!wide) {
            cases.push_back(static_cast<int32_t>(type.isNarrowInteger() ? inst[word] & type.mask() : inst[word]));
            continue;
        }
        cases.push_back(static_cast<int32_t>(targets.size()));
        const uint64_t literal = inst[word] | static_cast<uint64_t>(inst[word + 1]) << 32;
        chosen = emitter_.emit(ir::Op::select, ir::Type::i32,
                               {compare(ir::Op::ieq, selector, emitter_.constant(type, literal)),
                                emitter_.constantI32(static_cast<uint32_t>(targets.size())), chosen});
    }
    emitter_.switchOn(wide ? chosen : selector, blockOf(inst[2], inst, frame), cases, targets);
}

void Lowering::writePhis(uint32_t fromLabel, const Instruction& terminator, Frame& frame) {
    std::vector<uint32_t> labels;
    appendTargets(terminator, terminator.op == spv::Op::OpSwitch ? literalWordsOf(module_, terminator) : 1, labels);
    for (const uint32_t label : labels) {
        const auto found = frame.function->blockOfLabel.find(label);
        if (found == frame.function->blockOfLabel.end()) continue;
        for (const Frame::PhiVariables& phi : frame.phis[found->second]) {
            for (uint32_t word = 3; word + 1 < phi.inst.count; word += 2) {
                if (phi.inst[word + 1] != fromLabel) continue;
                const Leaves leaves = leavesOf(phi.inst[word]);
                require(leaves, phi.inst[1], phi.inst[word]);
                for (uint32_t i = 0; i < leaves.size(); ++i) emitter_.write(phi.first + i, leaves[i]);
                break;
            }
        }
    }
}

void Lowering::lowerCall(const Instruction& inst) {
    const Function* callee = module_.function(inst[3]);
    if (callee == nullptr || callee->blocks.empty()) refuse(inst, "the function has no body");
    for (size_t i = 0; i < callee->parameters.size(); ++i) {
        // Values, pointers and images alike: the parameter is another name for the argument.
        const uint32_t argument = inst[static_cast<uint32_t>(4 + i)];
        if (module_.definition(argument)[1] != module_.definition(callee->parameters[i])[1]) {
            refuseId(argument, "is not of the type of the parameter");
        }
        ids_[callee->parameters[i]] = idValue(argument);
    }
    const uint32_t line = emitter_.line(), file = emitter_.file();
    Frame inner;
    inner.function = callee;
    lowerFunction(*callee, inner);
    emitter_.setLine(line, file);
    if (inst[1] != callee->resultType) refuse(inst, "the result is not of the function's type");
    const SpirvType& type = typeInfo(inst[1]);
    if (type.leaves != 0) {
        const LeafTypes types = leafTypes(inst[1]);
        const NewScalars leaves = newLeaves(types.size());
        for (uint32_t i = 0; i < types.size(); ++i) leaves[i] = emitter_.read(inner.returnVariables + i, types[i]);
        setValue(inst[2], inst[1], leaves);
    } else if (type.kind != SpirvType::Kind::void_) {
        refuse(inst, "functions that return images or pointers to variables are not supported");
    }
}

void Lowering::lowerReturn(const Instruction& inst, Frame& frame) {
    if (inst.op == spv::Op::OpReturnValue && typeInfo(frame.function->resultType).leaves != 0) {
        const Leaves leaves = leavesOf(inst[1]);
        require(leaves, frame.function->resultType, inst[1]);
        for (uint32_t i = 0; i < leaves.size(); ++i) emitter_.write(frame.returnVariables + i, leaves[i]);
    }
    if (frame.returnBlock == ir::kNoIndex) {
        frame.fellThrough = true;
    } else {
        emitter_.jump(frame.returnBlock);
    }
}

}  // namespace vernier
