#include "spirv_interp/front/emitter.h"

#include <algorithm>
#include <bit>

#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/fold.h"
#include "spirv_interp/ir/ops.h"

namespace vernier {

using ir::BlockId;
using ir::Inst;
using ir::kNoValue;
using ir::Op;
using ir::Type;
using ir::ValueId;

namespace {

[[noreturn]] void refuseModule(const std::string& reason) {
    throw LoweringError{Error{ErrorCode::invalidArgument, "SPIR-V: " + reason}};
}

}  // namespace

// --- values
// -------------------------------------------------------------------------------------------------------------

ValueId Emitter::constant(Type type, uint64_t bits) {
    const auto [found, added] = constants_[static_cast<size_t>(type)].try_emplace(bits, kNoValue);
    if (!added) return found->second;
    Inst inst;
    inst.op = Op::constant;
    inst.type = type;
    inst.imm = bits;
    inst.result = program_.newValue(type);
    leafOf_[inst.result] = static_cast<uint32_t>(leaves_.size());
    leaves_.push_back(inst);
    found->second = inst.result;
    return inst.result;
}

ValueId Emitter::constantFloat(Type type, double value) {
    if (type == Type::f64) return constant(type, std::bit_cast<uint64_t>(value));
    return constant(type, std::bit_cast<uint32_t>(static_cast<float>(value)));
}

ValueId Emitter::undef(Type type) {
    ValueId& value = undefs_[static_cast<size_t>(type)];
    if (value == kNoValue) {
        Inst inst;
        inst.op = Op::undef;
        inst.type = type;
        inst.result = value = program_.newValue(type);
        leafOf_[value] = static_cast<uint32_t>(leaves_.size());
        leaves_.push_back(inst);
    }
    return value;
}

ValueId Emitter::resolved(ValueId value) {
    return ir::resolve(replacement_, value);
}

std::optional<uint64_t> Emitter::constantBits(ValueId value) {
    const auto found = leafOf_.find(resolved(value));
    if (found == leafOf_.end() || leaves_[found->second].op != Op::constant) return std::nullopt;
    return leaves_[found->second].imm;
}

bool Emitter::isUndef(ValueId value) {
    const auto found = leafOf_.find(resolved(value));
    return found != leafOf_.end() && leaves_[found->second].op == Op::undef;
}

ValueId Emitter::simplified(Op op, Type type, std::span<const ValueId> operands) {
    // Offset arithmetic and conditions made of specialisation constants; the rest is for the passes.
    switch (op) {
        case Op::copy:
            return operands[0];
        case Op::iadd:
            if (constantBits(operands[0]) == 0u) return operands[1];
            return constantBits(operands[1]) == 0u ? operands[0] : kNoValue;
        case Op::imul:
            for (size_t i = 0; i < 2; ++i) {
                const std::optional<uint64_t> bits = constantBits(operands[i]);
                if (bits == 0u) return constant(type, 0);
                if (bits == 1u) return operands[1 - i];
            }
            return kNoValue;
        case Op::select: {
            const std::optional<uint64_t> bits = constantBits(operands[0]);
            return bits ? operands[*bits != 0 ? 1 : 2] : kNoValue;
        }
        default:
            return kNoValue;
    }
}

ValueId Emitter::defined(ValueId value) const {
    if (value >= program_.valueTypes.size()) refuseModule("an operand has no value");
    return value;
}

void Emitter::check(Op op, Type type, std::span<const ValueId> operands, uint64_t imm) const {
    Inst inst;
    inst.op = op;
    inst.type = type;
    inst.imm = imm;
    const auto allows = [](uint32_t types, Type given) { return (types >> static_cast<uint32_t>(given) & 1) != 0; };
    const bool typed = op == Op::image || op == Op::imageStore || allows(ir::resultTypes(op), type);
    bool fits = typed && operands.size() == ir::operandCountOf(program_, inst);
    for (uint32_t k = 0; fits && k < operands.size(); ++k) {
        fits = allows(ir::operandTypes(program_, inst, k), typeOf(operands[k]));
    }
    if (!fits) refuseModule("the operands of " + std::string(ir::opInfo(op).name) + " are not of its types");
}

ValueId Emitter::emit(Op op, Type type, std::span<const ValueId> operands, uint64_t imm) {
    check(op, type, operands, imm);
    if (ir::opInfo(op).kind == 'P' && !operands.empty() && operands.size() <= 4) {
        uint64_t bits[4] = {};
        size_t known = 0;
        for (const ValueId operand : operands) {
            const std::optional<uint64_t> constantOperand = constantBits(operand);
            if (!constantOperand) break;
            bits[known++] = *constantOperand;
        }
        if (known == operands.size()) {
            if (const auto folded = ir::foldConstant(op, type, imm, {bits, known})) return constant(type, *folded);
        }
        const ValueId simple = simplified(op, type, operands);
        if (simple != kNoValue) return simple;
    }
    return append(op, type, operands, imm).result;
}

Inst& Emitter::append(Op op, Type type, std::span<const ValueId> operands, uint64_t imm) {
    Inst inst;
    inst.op = op;
    inst.type = type;
    inst.noContraction = noContraction_;
    inst.relaxed = relaxed_;
    inst.line = line_;
    inst.file = file_;
    inst.imm = imm;
    inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
    inst.operandCount = static_cast<uint16_t>(operands.size());
    for (const ValueId operand : operands) program_.operands.push_back(operand);
    if (ir::opInfo(op).results != 0) inst.result = program_.newValue(type, ir::opInfo(op).results);
    ++instructionCount_;
    return program_.blocks[current_].insts.emplace_back(inst);
}

// --- blocks
// -------------------------------------------------------------------------------------------------------------

BlockId Emitter::newBlock() {
    program_.blocks.emplace_back();
    states_.emplace_back();
    return static_cast<BlockId>(program_.blocks.size() - 1);
}

void Emitter::begin(BlockId block, bool loopHeader) {
    current_ = block;
    states_[block].position = static_cast<uint32_t>(order_.size());
    order_.push_back(block);
    states_[block].placed = true;
    states_[block].sealed = !loopHeader;
    terminated_ = false;
}

void Emitter::endLoop(BlockId header) {
    State& state = states_[header];
    if (!state.placed) return;
    state.sealed = true;
    const auto& predecessors = program_.blocks[header].predecessors;
    const auto isBack = [&](BlockId p) { return states_[p].position >= state.position; };
    if (std::any_of(predecessors.begin(), predecessors.end(), isBack)) {
        state.loopEnd = static_cast<uint32_t>(order_.size());
    }
    pending_.insert(pending_.end(), state.incomplete.begin(), state.incomplete.end());
    state.incomplete.clear();
    drain();
}

void Emitter::addEdge(BlockId to) {
    // Back into a loop that is open, or on to what is still to come.
    if (states_[to].placed && states_[to].sealed) refuseModule("a branch goes back to a block that is no loop header");
    program_.blocks[current_].successors.push_back(to);
    program_.blocks[to].predecessors.push_back(current_);
}

void Emitter::terminate(Op op, std::initializer_list<ValueId> operands) {
    const bool noContraction = noContraction_, relaxed = relaxed_;
    setFlags(false, false);
    append(op, Type::none, std::span<const ValueId>(operands.begin(), operands.size()), 0);
    setFlags(noContraction, relaxed);
    terminated_ = true;
}

void Emitter::jump(BlockId to) {
    terminate(Op::jump, {});
    addEdge(to);
}

void Emitter::branch(ValueId condition, BlockId ifTrue, BlockId ifFalse) {
    if (!hasType(condition, Type::b1)) refuseModule("a condition is no boolean");
    const std::optional<uint64_t> bits = constantBits(condition);
    if (bits || ifTrue == ifFalse) return jump(bits == 0u ? ifFalse : ifTrue);
    terminate(Op::branch, {condition});
    addEdge(ifTrue);
    addEdge(ifFalse);
}

void Emitter::switchOn(ValueId selector, BlockId otherwise, std::span<const int32_t> cases,
                       std::span<const BlockId> targets) {
    if (!hasType(selector, Type::i32)) refuseModule("a selector is no integer");
    if (const std::optional<uint64_t> bits = constantBits(selector)) {
        for (size_t i = 0; i < cases.size(); ++i) {
            if (static_cast<uint32_t>(cases[i]) == *bits) return jump(targets[i]);
        }
        return jump(otherwise);
    }
    if (cases.empty()) return jump(otherwise);
    terminate(Op::switchOn, {selector});
    program_.blocks[current_].cases.assign(cases.begin(), cases.end());
    addEdge(otherwise);
    for (const BlockId target : targets) addEdge(target);
}

void Emitter::ret() {
    terminate(Op::ret, {});
}
void Emitter::kill() {
    terminate(Op::kill, {});
}

// --- variables
// ----------------------------------------------------------------------------------------------------------

uint32_t Emitter::newVariables(uint32_t count) {
    const uint32_t first = variableCount_;
    variableCount_ += count;
    return first;
}

ValueId Emitter::read(uint32_t variable, Type type) {
    const ValueId value = readAt(current_, variable, type);
    drain();
    return resolved(value);
}

ValueId Emitter::readAt(BlockId block, uint32_t variable, Type type) {
    // Up through blocks with one predecessor to a definition or to a place that needs a phi; the phi stands in for what
    // is above it, so nothing recurses.
    BlockId at = block;
    ValueId value = kNoValue;
    while (value == kNoValue) {
        if (const ValueId* found = definitions_.find(key(at, variable))) {
            value = *found;
        } else if (!states_[at].sealed || program_.blocks[at].predecessors.size() > 1) {
            value = newPhi(at, variable, type);
        } else if (program_.blocks[at].predecessors.empty()) {
            value = undef(type);
        } else {
            at = program_.blocks[at].predecessors[0];
        }
    }
    value = resolved(value);
    for (BlockId b = block; b != at; b = program_.blocks[b].predecessors[0]) define(b, variable, value);
    return value;
}

ValueId Emitter::newPhi(BlockId block, uint32_t variable, Type type) {
    Inst inst;
    inst.op = Op::phi;
    inst.type = type;
    inst.line = line_;
    inst.file = file_;
    inst.result = program_.newValue(type);
    State& state = states_[block];
    const Phi phi{block, static_cast<uint32_t>(state.phis.size()), variable};
    state.phis.push_back(inst);
    ++instructionCount_;
    define(block, variable, inst.result);
    (state.sealed ? pending_ : state.incomplete).push_back(phi);
    return inst.result;
}

void Emitter::drain() {
    while (!pending_.empty()) {
        const Phi phi = pending_.back();
        pending_.pop_back();
        complete(phi);
    }
}

void Emitter::complete(const Phi& phi) {
    const Type type = states_[phi.block].phis[phi.index].type;
    const ValueId result = states_[phi.block].phis[phi.index].result;
    std::vector<ValueId> operands;
    ValueId same = kNoValue;
    bool trivial = true;
    for (const BlockId p : program_.blocks[phi.block].predecessors) {
        const ValueId value = readAt(p, phi.variable, type);
        operands.push_back(value);
        if (value == result || value == same) continue;
        trivial = trivial && same == kNoValue;
        same = value;
    }
    Inst& inst = states_[phi.block].phis[phi.index];
    inst.firstOperand = static_cast<uint32_t>(program_.operands.size());
    inst.operandCount = static_cast<uint16_t>(operands.size());
    program_.operands.insert(program_.operands.end(), operands.begin(), operands.end());
    if (!trivial) return;
    if (same == kNoValue) same = undef(type);
    replacement_.resize(program_.valueTypes.size(), kNoValue);
    replacement_[result] = same;
}

// --- end
// ----------------------------------------------------------------------------------------------------------------

void Emitter::finish() {
    replacement_.resize(program_.valueTypes.size(), kNoValue);
    std::vector<BlockId> place(program_.blocks.size(), ir::kNoIndex);
    for (BlockId i = 0; i < order_.size(); ++i) place[order_[i]] = i;
    std::vector<ir::Block> blocks;
    blocks.reserve(order_.size());
    for (const BlockId b : order_) {
        State& state = states_[b];
        ir::Block& block = blocks.emplace_back(std::move(program_.blocks[b]));
        const auto replaced = [this](const Inst& phi) { return replacement_[phi.result] != kNoValue; };
        state.phis.erase(std::remove_if(state.phis.begin(), state.phis.end(), replaced), state.phis.end());
        block.insts.insert(block.insts.begin(), state.phis.begin(), state.phis.end());
        for (BlockId& p : block.predecessors) p = place[p];
        for (BlockId& s : block.successors) {
            s = place[s];
            if (s == ir::kNoIndex) refuseModule("a branch goes to a block outside of the structure");
        }
        block.loopHeader = state.loopEnd != 0;
        block.loopEnd = state.loopEnd;
    }
    program_.blocks = std::move(blocks);
    auto& entry = program_.blocks[0].insts;
    entry.insert(entry.begin(), leaves_.begin(), leaves_.end());
    ir::replaceUses(program_, replacement_);
}

// --- map
// ----------------------------------------------------------------------------------------------------------------

ValueId* Emitter::Definitions::find(uint64_t key) {
    if (slots_.empty()) return nullptr;
    const size_t mask = slots_.size() - 1;
    for (size_t at = (key * 0x9E3779B97F4A7C15ull) >> 32 & mask;; at = (at + 1) & mask) {
        if (slots_[at].key == key) return &slots_[at].value;
        if (slots_[at].key == kEmpty) return nullptr;
    }
}

void Emitter::Definitions::set(uint64_t key, ValueId value) {
    if ((used_ + 1) * 2 > slots_.size()) grow();
    const size_t mask = slots_.size() - 1;
    size_t at = (key * 0x9E3779B97F4A7C15ull) >> 32 & mask;
    while (slots_[at].key != key && slots_[at].key != kEmpty) at = (at + 1) & mask;
    if (slots_[at].key == kEmpty) ++used_;
    slots_[at] = {key, value};
}

void Emitter::Definitions::grow() {
    std::vector<Slot> old(slots_.empty() ? 256 : slots_.size() * 2);
    old.swap(slots_);
    used_ = 0;
    for (const Slot& slot : old) {
        if (slot.key != kEmpty) set(slot.key, slot.value);
    }
}

}  // namespace vernier
