#include "spirv_interp/ir/verify.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

class Verifier {
  public:
    Verifier(const Program& program, LoopForm form) : program_(program), form_(form) {}

    Status run() {
        // Each step relies on what the ones before it have established.
        using Step = void (Verifier::*)();
        for (const Step step : {&Verifier::tables, &Verifier::resources, &Verifier::shape, &Verifier::edges,
                                &Verifier::order, &Verifier::instructions, &Verifier::uses}) {
            (this->*step)();
            if (error_) return invalidArgument("IR of '" + program_.name + "': " + *error_);
        }
        return {};
    }

  private:
    const Program& program_;
    LoopForm form_;
    std::optional<std::string> error_;
    std::vector<BlockId> definedIn_;
    std::vector<uint32_t> definedAt_;  // instruction index in the block

    void fail(const std::string& message) {
        if (!error_) error_ = message;
    }
    void failBlock(BlockId b, const std::string& message) { fail("block " + std::to_string(b) + ": " + message); }
    void failInst(BlockId b, size_t index, const std::string& message) {
        const Inst& inst = program_.blocks[b].insts[index];
        failBlock(b, std::string(opInfo(inst.op).name) + " (instruction " + std::to_string(index) + "): " + message);
    }

    void tables() {
        for (const InterfaceSlot& slot : program_.inputs) slotType(slot, "input");
        for (const InterfaceSlot& slot : program_.outputs) slotType(slot, "output");
        for (size_t i = 0; i < program_.imageOps.size(); ++i) {
            const ImageOp& op = program_.imageOps[i];
            const auto inRange = [&](uint32_t resource) { return resource < program_.resources.size(); };
            if (!inRange(op.imageResource) || (op.samplerResource != kNoIndex && !inRange(op.samplerResource))) {
                fail("image operation " + std::to_string(i) + " names a resource that does not exist");
            }
            if (op.coords > 4 || op.gradients > 6 || op.offsets > 3) {
                fail("image operation " + std::to_string(i) + " has too many coordinates, gradients or offsets");
            }
        }
    }

    void resources() {
        for (size_t r = 0; r < program_.resources.size(); ++r) {
            const Resource& resource = program_.resources[r];
            if (resource.kind != ResourceKind::workgroupMemory) continue;
            const std::string name = "resource " + std::to_string(r) + ", work-group memory, ";
            if (program_.stage != Stage::compute) fail(name + "is in a stage without work-groups");
            if (resource.byteSize > kMaxWorkgroupMemory || resource.arraySize != 1 || resource.readOnly) {
                fail(name + "is too large, an array or marked as only read");
            }
        }
        uint64_t invocations = 1;
        for (const uint32_t size : program_.localSize) {
            invocations *= std::min(size, kMaxWorkgroupInvocations + 1);
            if (size == 0) fail("a local size of 0");
        }
        if (invocations > kMaxWorkgroupInvocations) fail("a work-group of too many invocations");
    }

    void slotType(const InterfaceSlot& slot, const char* what) {
        if (slot.type != Type::b1 && slot.type != Type::i32 && slot.type != Type::f32) {
            fail(std::string(what) + " slot of type " + std::string(typeName(slot.type)));
        }
    }

    void shape() {
        if (program_.blocks.empty()) return fail("no blocks");
        for (BlockId b = 0; b < program_.blocks.size(); ++b) {
            const Block& block = program_.blocks[b];
            if (block.insts.empty()) return failBlock(b, "no instructions");
            bool phisDone = false;
            for (size_t i = 0; i < block.insts.size(); ++i) {
                const Inst& inst = block.insts[i];
                if (static_cast<uint64_t>(inst.firstOperand) + inst.operandCount > program_.operands.size()) {
                    return failInst(b, i, "operands lie outside the pool");
                }
                const bool last = i + 1 == block.insts.size();
                if (isTerminator(inst.op) != last) {
                    return failInst(b, i,
                                    last ? "the last instruction is no terminator" : "a terminator inside a block");
                }
                if (inst.op == Op::phi && phisDone) return failInst(b, i, "phis come first in a block");
                phisDone = phisDone || inst.op != Op::phi;
            }
        }
    }

    void edges() {
        const auto count = static_cast<BlockId>(program_.blocks.size());
        for (BlockId b = 0; b < count; ++b) {
            const Block& block = program_.blocks[b];
            const Op terminator = block.insts.back().op;
            size_t wanted = 0;
            if (terminator == Op::jump) wanted = 1;
            if (terminator == Op::branch) wanted = 2;
            if (terminator == Op::switchOn) wanted = block.cases.size() + 1;
            if (block.successors.size() != wanted) {
                return failBlock(b, std::to_string(block.successors.size()) + " successors, the terminator wants " +
                                        std::to_string(wanted));
            }
            if (terminator != Op::switchOn && !block.cases.empty()) return failBlock(b, "cases without switchOn");
            for (const BlockId s : block.successors) {
                if (s >= count) return failBlock(b, "a successor does not exist");
            }
            for (const BlockId p : block.predecessors) {
                if (p >= count) return failBlock(b, "a predecessor does not exist");
            }
        }
        for (BlockId b = 0; b < count; ++b) {
            const Block& block = program_.blocks[b];
            for (const BlockId s : block.successors) {
                const auto& back = program_.blocks[s].predecessors;
                if (std::count(back.begin(), back.end(), b) !=
                    std::count(block.successors.begin(), block.successors.end(), s)) {
                    return failBlock(b, "the edges to block " + std::to_string(s) + " are not its predecessors");
                }
            }
            for (const BlockId p : block.predecessors) {
                const auto& forward = program_.blocks[p].successors;
                if (std::find(forward.begin(), forward.end(), b) == forward.end()) {
                    return failBlock(b, "predecessor " + std::to_string(p) + " does not go there");
                }
            }
            if (b == 0 && !block.predecessors.empty()) return failBlock(b, "the entry has predecessors");
            if (b != 0 && block.predecessors.empty()) return failBlock(b, "unreachable");
        }
    }

    void order() {
        const auto count = static_cast<BlockId>(program_.blocks.size());
        std::vector<BlockId> open;
        for (BlockId b = 0; b < count; ++b) {
            const Block& block = program_.blocks[b];
            while (!open.empty() && program_.blocks[open.back()].loopEnd <= b) open.pop_back();
            if (block.loopHeader) {
                if (block.loopEnd <= b || block.loopEnd > count) return failBlock(b, "the loop ends before it begins");
                if (!open.empty() && block.loopEnd > program_.blocks[open.back()].loopEnd) {
                    return failBlock(b, "the loop reaches out of the loop around it");
                }
                open.push_back(b);
            } else if (block.loopEnd != 0) {
                return failBlock(b, "a loop end without a loop header");
            }
            for (const BlockId p : block.predecessors) {
                if (p >= b) {
                    if (!block.loopHeader) return failBlock(b, "a back edge to a block that is no loop header");
                    if (p >= block.loopEnd) return failBlock(b, "a back edge from outside the loop");
                    continue;
                }
                // Into a loop only through its header.
                for (const BlockId header : open) {
                    if (header != b && p < header) return failBlock(b, "an edge into the middle of a loop");
                }
            }
        }
        for (BlockId b = 1; b < count; ++b) {
            const auto& p = program_.blocks[b].predecessors;
            if (std::all_of(p.begin(), p.end(), [b](BlockId from) { return from >= b; })) {
                return failBlock(b, "no edge into the block comes from before it");
            }
        }
    }

    void instructions() {
        definedIn_.assign(program_.valueTypes.size(), kNoIndex);
        definedAt_.assign(program_.valueTypes.size(), 0);
        for (BlockId b = 0; b < program_.blocks.size(); ++b) {
            const Block& block = program_.blocks[b];
            for (size_t i = 0; i < block.insts.size() && !error_; ++i) instruction(b, i);
        }
    }

    void instruction(BlockId b, size_t i) {
        const Inst& inst = program_.blocks[b].insts[i];
        if (const char* reason = badFact(inst)) return failInst(b, i, reason);
        if (const char* reason = badImmediate(inst)) return failInst(b, i, reason);
        const uint32_t count = inst.op == Op::phi ? static_cast<uint32_t>(program_.blocks[b].predecessors.size())
                                                  : operandCountOf(program_, inst);
        if (inst.operandCount != count) {
            return failInst(b, i, std::to_string(inst.operandCount) + " operands instead of " + std::to_string(count));
        }
        if (inst.op == Op::atomicBuffer || inst.op == Op::atomicAddress) {
            if (isFloatAtomic(static_cast<AtomicOp>(immHigh(inst))) ? !isFloat(inst.type) : !isInteger(inst.type)) {
                return failInst(b, i, "the type does not fit the atomic operation");
            }
        } else if ((resultTypes(inst.op) >> static_cast<uint32_t>(inst.type) & 1) == 0) {
            return failInst(b, i, "a result of type " + std::string(typeName(inst.type)));
        }
        for (uint32_t r = 0; r < opInfo(inst.op).results; ++r) {
            const uint64_t value = static_cast<uint64_t>(inst.result) + r;
            if (value >= program_.valueTypes.size()) return failInst(b, i, "the result is no value of the program");
            if (program_.valueTypes[value] != inst.type) return failInst(b, i, "the result has another type");
            if (definedIn_[value] != kNoIndex) {
                return failInst(b, i, "value %" + std::to_string(value) + " is defined twice");
            }
            definedIn_[value] = b;
            definedAt_[value] = static_cast<uint32_t>(i);
        }
        uint32_t index = 0;
        for (const ValueId operand : program_.operandsOf(inst)) {
            if (operand >= program_.valueTypes.size()) return failInst(b, i, "an operand is no value of the program");
            const Type type = program_.valueTypes[operand];
            if ((operandTypes(program_, inst, index) >> static_cast<uint32_t>(type) & 1) == 0) {
                return failInst(b, i,
                                "operand %" + std::to_string(operand) + " has type " + std::string(typeName(type)));
            }
            ++index;
        }
    }

    /// How a program is run follows from these facts.
    const char* badFact(const Inst& inst) const {
        if (inst.op == Op::controlBarrier) {
            if (program_.stage != Stage::compute) return "in a stage without work-groups";
            if (!program_.hasBarriers) return "the program does not tell that it has barriers";
        }
        if (inst.op == Op::storeVertex && program_.stage != Stage::geometry) return "in a stage without such vertices";
        const bool subgroup = inst.op >= Op::subgroupInvocation && inst.op <= Op::subgroupReduce;
        if (subgroup && !program_.usesSubgroups) return "the program does not tell that it uses subgroups";
        return nullptr;
    }

    const char* badImmediate(const Inst& inst) const {
        switch (immKind(inst.op)) {
            case ImmKind::none:
                return inst.imm != 0 ? "an immediate where there is none" : nullptr;
            case ImmKind::bits: {
                if (inst.type == Type::b1 && inst.imm != 0 && inst.imm != kTrueBits) {
                    return "a boolean constant that is neither all zeros nor all ones";
                }
                if (!isWide(inst.type) && inst.imm > 0xFFFFFFFFu) return "a 32-bit constant with more bits";
                return nullptr;
            }
            case ImmKind::type:
                return badOperandType(inst);
            case ImmKind::input:
                if (inst.imm >= program_.inputs.size()) return "an input that does not exist";
                return inst.type != program_.inputs[inst.imm].type ? "the input has another type" : nullptr;
            case ImmKind::output:
                return inst.imm >= program_.outputs.size() ? "an output that does not exist" : nullptr;
            case ImmKind::resource: {
                if (immHigh(inst) > 2) return "an access of a width there is none of";
                if (immHigh(inst) != 0 && inst.op == Op::loadBuffer && inst.type != Type::i32) {
                    return "a part of a word that is no i32";
                }
                if (resourceOf(inst) == kNoIndex) return nullptr;
                if (resourceOf(inst) >= program_.resources.size()) return "a resource that does not exist";
                return badBuffer(program_.resources[resourceOf(inst)], inst.op == Op::storeBuffer);
            }
            case ImmKind::imageOp: {
                if (inst.imm >= program_.imageOps.size()) return "an image operation that does not exist";
                const bool store = program_.imageOps[inst.imm].kind == ImageKind::store;
                return store != (inst.op == Op::imageStore) ? "the kind of image operation does not fit" : nullptr;
            }
            case ImmKind::pair:
                return badPair(inst);
        }
        return nullptr;
    }

    static const char* badOperandType(const Inst& inst) {
        if (inst.imm < 1 || inst.imm > static_cast<uint64_t>(Type::f64)) return "the operand type is none";
        const auto type = static_cast<Type>(inst.imm);
        const bool floatCompare = inst.op >= Op::foeq && inst.op <= Op::fisinf;
        const bool fromFloat = inst.op == Op::ftos || inst.op == Op::ftou || inst.op == Op::ftof ||
                               inst.op == Op::ftoh || inst.op == Op::ftohZero;
        if (floatCompare || fromFloat || inst.op == Op::ffrexpExponent) {
            return isFloat(type) ? nullptr : "the operand type is not a float";
        }
        const bool intCompare = inst.op >= Op::ieq && inst.op <= Op::ule;
        if (intCompare || inst.op == Op::stof || inst.op == Op::utof) {
            return isInteger(type) ? nullptr : "the operand type is not an integer";
        }
        if (inst.op == Op::itrunc) return type == Type::i64 ? nullptr : "the operand type is not i64";
        if (inst.op == Op::sext) return type == Type::i32 ? nullptr : "the operand type is not i32";
        if (inst.op == Op::zext) return type == Type::i32 || type == Type::b1 ? nullptr : "the operand type is wide";
        if (inst.op == Op::bitcast) {
            return type != Type::b1 && isWide(type) == isWide(inst.type) ? nullptr : "the widths differ";
        }
        return nullptr;
    }

    static const char* badBuffer(const Resource& resource, bool written) {
        if (!isBuffer(resource.kind)) return "the resource is no buffer";
        if (!written) return nullptr;
        if (!isWritable(resource.kind)) return "a store to a buffer that cannot be written";
        return resource.readOnly ? "a store to a buffer marked as only read" : nullptr;
    }

    static const char* badReduction(const Inst& inst) {
        const Reduction reduction = reductionOf(inst);
        if (inst.imm != immOf(reduction) || reduction.op > ReduceOp::hmul || reduction.mode > ReduceMode::exclusive) {
            return "an unknown reduction";
        }
        const uint32_t cluster = reduction.cluster;
        if (cluster == 0 || cluster > kSubgroupSize || (cluster & (cluster - 1)) != 0) {
            return "clusters that are no power of two in a subgroup";
        }
        const bool logic =
            reduction.op == ReduceOp::iand || reduction.op == ReduceOp::ior || reduction.op == ReduceOp::ixor;
        const bool floating = reduction.op == ReduceOp::fadd || reduction.op == ReduceOp::fmul ||
                              reduction.op == ReduceOp::fmin || reduction.op == ReduceOp::fmax;
        const bool ofHalves = reduction.op == ReduceOp::hadd || reduction.op == ReduceOp::hmul;
        const bool fits = ofHalves                ? inst.type == Type::f32
                          : inst.type == Type::b1 ? logic
                                                  : isFloat(inst.type) == floating;
        return fits ? nullptr : "a reduction that is not defined for the type";
    }

    const char* badPair(const Inst& inst) const {
        const uint64_t end = static_cast<uint64_t>(immLow(inst)) + immHigh(inst);
        switch (inst.op) {
            case Op::inputIndexed:
                return immHigh(inst) == 0 || end > program_.inputs.size() ? "inputs that do not exist" : nullptr;
            case Op::subgroupReduce:
                return badReduction(inst);
            case Op::loadLocal:
            case Op::storeLocal:
                return immHigh(inst) == 0 || end > program_.localWords ? "outside the local memory" : nullptr;
            case Op::loadAddress:
            case Op::storeAddress:
                if (immLow(inst) > 8 || !std::has_single_bit(immLow(inst))) return "an access of another width";
                if (inst.op == Op::loadAddress && isWide(inst.type) != (immLow(inst) == 8)) {
                    return "the type does not have the width of the access";
                }
                if (immLow(inst) < 4 && inst.op == Op::loadAddress && inst.type != Type::i32) {
                    return "a part of a word that is no i32";
                }
                return immHigh(inst) != 0 ? "an atomic operation where there is none" : nullptr;
            default:
                if (immHigh(inst) > static_cast<uint32_t>(AtomicOp::fmax)) return "an unknown atomic operation";
                if (inst.op == Op::atomicAddress || resourceOf(inst) == kNoIndex) return nullptr;
                if (resourceOf(inst) >= program_.resources.size()) return "a resource that does not exist";
                return badBuffer(program_.resources[immLow(inst)],
                                 static_cast<AtomicOp>(immHigh(inst)) != AtomicOp::load);
        }
    }

    void uses() {
        const Cfg cfg(program_);
        for (BlockId b = 0; b < program_.blocks.size(); ++b) {
            const Block& block = program_.blocks[b];
            for (size_t i = 0; i < block.insts.size() && !error_; ++i) {
                const Inst& inst = block.insts[i];
                uint32_t index = 0;
                for (const ValueId operand : program_.operandsOf(inst)) {
                    const bool phi = inst.op == Op::phi;
                    const BlockId where = phi ? block.predecessors[index] : b;
                    const BlockId home = definedIn_[operand];
                    ++index;
                    const std::string name = "%" + std::to_string(operand);
                    if (home == kNoIndex) {
                        failInst(b, i, name + " is not defined");
                    } else if (home == where && !phi ? definedAt_[operand] >= i : !cfg.dominates(home, where)) {
                        failInst(b, i, "the definition of " + name + " does not dominate the use");
                    } else if (form_ == LoopForm::closed && !cfg.loopsContain(program_, home, where)) {
                        failInst(b, i, name + " is defined in a loop and used outside it without a phi");
                    }
                }
            }
        }
    }
};

}  // namespace

Status verify(const Program& program, LoopForm form) {
    return Verifier(program, form).run();
}

}  // namespace vernier::ir
