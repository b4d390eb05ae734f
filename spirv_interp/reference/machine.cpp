// The machine's control flow, operands and derivatives.
#include "spirv_interp/reference/machine.h"

#include <algorithm>

#include "spirv_interp/reference/integer_ops.h"

namespace vernier::reference {
namespace {

constexpr size_t kMaxCallDepth = 128;

}  // namespace

template <class Number>
Machine<Number>::Machine(const Program<Number>& program, const InterfaceValues<Number>& inputs,
                         Resources<Number>& resources, uint32_t invocation, bool helper, SharedObjects<Number>* shared)
    : program_(program),
      module_(*program.module),
      resources_(resources),
      invocation_(invocation),
      helper_(helper),
      variables_(module_.variables.size()),
      shared_(shared) {
    createInterface(inputs);
    const Id entry = module_.entryPointData[program.entryPoint].function;
    call(module_.functions[module_.info(entry).index], 0, {});
}

template <class Number>
typename Machine<Number>::Status Machine<Number>::run() {
    while (status_ == Status::running) {
        Frame& frame = frames_.back();
        if (frame.next >= frame.function->instructions.size()) fail("control runs out of a function");
        const Instruction& instruction = frame.function->instructions[frame.next++];
        charge(1);
        execute(instruction);
        // A call's result is there when it returns, and who waits executes the instruction again.
        if (program_.options.observer == nullptr || status_ == Status::waiting) continue;
        if (instruction.op != spv::OpFunctionCall) observe(instruction);
    }
    return status_;
}

template <class Number>
void Machine<Number>::observe(const Instruction& i) const {
    Step step;
    step.invocation = invocation_;
    step.op = i.op;
    step.result = i.result;
    step.type = i.type;
    step.operands = i.operands;
    step.line = i.line;
    const Id shown = i.op == spv::OpStore ? i.operand(1) : i.result;
    const IdKind kind = shown == 0 || frames_.empty() ? IdKind::none : module_.info(shown).kind;
    // Instructions of sets that are ignored have ids without values.
    const bool hasValue =
        kind == IdKind::constant || (kind == IdKind::local && frames_.back().values[module_.info(shown).index].defined);
    if (hasValue) {
        const Value<Number>& v = value(shown);
        const Type& type = module_.valueType(shown);
        const bool flat = type.isScalar() || type.kind == TypeKind::vector || type.kind == TypeKind::matrix;
        step.isFloat = flat && module_.scalarType(type).kind == TypeKind::floating;
        for (size_t k = 0; flat && k < v.scalars.size(); ++k) {
            step.numbers.push_back(static_cast<double>(v.scalars[k].number));
            step.bits.push_back(v.scalars[k].bits);
        }
    }
    program_.options.observer->executed(step);
}

template <class Number>
void Machine<Number>::charge(uint64_t steps) {
    steps_ += steps;
    if (steps_ > program_.options.stepBudget)
        fail("the invocation has not ended after " + std::to_string(program_.options.stepBudget) + " steps");
}

template <class Number>
void Machine<Number>::execute(const Instruction& i) {
    const bool known = executeArithmetic(i) || executeComposite(i) || executeMemory(i) || executeControl(i) ||
                       executeConversion(i) || executeImage(i) || executeAtomic(i) || executeSubgroup(i);
    if (!known) failUnsupported(name(i.op));
}

template <class Number>
bool Machine<Number>::executeControl(const Instruction& i) {
    switch (i.op) {
        case spv::OpBranch:
            enterBlock(i.operand(0));
            return true;
        case spv::OpBranchConditional:
            enterBlock(bits(i.operand(0)) != 0 ? i.operand(1) : i.operand(2));
            return true;
        case spv::OpSwitch: {
            const uint64_t selector = bits(i.operand(0));
            const size_t literalWords = module_.valueType(i.operand(0)).width == 64 ? 2 : 1;
            Id target = i.operand(1);
            for (size_t k = 2; k < i.operands.size(); k += literalWords + 1) {
                uint64_t literal = i.operand(k);
                if (literalWords == 2) literal |= uint64_t{i.operand(k + 1)} << 32;
                literal &= widthMask(module_.valueType(i.operand(0)).width);
                const Id label = i.operand(k + literalWords);
                if (literal != selector) continue;
                target = label;
                break;
            }
            enterBlock(target);
            return true;
        }
        case spv::OpReturn:
            returnFrom(nullptr);
            return true;
        case spv::OpReturnValue: {
            const Value<Number> result = value(i.operand(0));
            returnFrom(&result);
            return true;
        }
        case spv::OpKill:
        case spv::OpTerminateInvocation:
            discarded_ = true;
            status_ = Status::done;
            return true;
        case spv::OpDemoteToHelperInvocationEXT:
            demote();
            return true;
        case spv::OpIsHelperInvocationEXT:
            setResult(i, Scalar<Number>::ofBits(helper_ ? 1 : 0));
            return true;
        case spv::OpReadClockKHR: {
            // A clock that ticks when it is looked at.
            ++clock_;
            const bool words = resultCount(i) == 2;
            Scalars<Number> now{Scalar<Number>::ofBits(words ? clock_ & 0xFFFFFFFFu : clock_)};
            if (words) now.push_back(Scalar<Number>::ofBits(clock_ >> 32));
            setResult(i, std::move(now));
            return true;
        }
        case spv::OpEmitVertex:
            emitVertex(0);
            return true;
        case spv::OpEmitStreamVertex:
            emitVertex(static_cast<uint32_t>(bits(i.operand(0))));
            return true;
        case spv::OpEndPrimitive:
        case spv::OpEndStreamPrimitive:
            startsStrip_ = true;
            return true;
        case spv::OpUnreachable:
            fail("OpUnreachable was reached");
        case spv::OpPhi:
            fail("OpPhi is not at the start of a block with predecessors");
        case spv::OpFunctionCall: {
            const IdInfo& info = module_.info(i.operand(0));
            if (info.kind != IdKind::function) fail(name(i.operand(0)) + " is no function");
            std::vector<Value<Number>> arguments;
            for (const Id id : i.operands.subspan(1)) arguments.push_back(value(id));
            call(module_.functions[info.index], i.result, arguments);
            return true;
        }
        case spv::OpExtInst:
            executeGlsl(i);
            return true;
        case spv::OpDPdx:
        case spv::OpDPdy:
        case spv::OpFwidth:
        case spv::OpDPdxFine:
        case spv::OpDPdyFine:
        case spv::OpFwidthFine:
        case spv::OpDPdxCoarse:
        case spv::OpDPdyCoarse:
        case spv::OpFwidthCoarse:
            derivative(i);
            return true;
        default:
            return false;
    }
}

template <class Number>
void Machine<Number>::call(const Function& function, Id result, const std::vector<Value<Number>>& arguments) {
    if (frames_.size() >= kMaxCallDepth) fail("calls are nested more than " + std::to_string(kMaxCallDepth) + " deep");
    if (function.blocks.empty()) fail("function " + name(function.id) + " has no body");
    if (arguments.size() != function.parameters.size())
        fail("function " + name(function.id) + " takes " + std::to_string(function.parameters.size()) + " arguments");
    charge(1 + function.slots / kScalarsPerStep);
    Frame frame;
    frame.function = &function;
    frame.next = function.blocks[0].begin;
    frame.block = function.blocks[0].label;
    frame.blockRank = function.blocks[0].rank;
    frame.values.resize(function.slots);
    frame.caller = result;
    for (size_t p = 0; p < arguments.size(); ++p) {
        const auto& [id, typeIndex] = function.parameters[p];
        const Type& type = module_.types[typeIndex];
        if (!arguments[p].pointer && !arguments[p].image && arguments[p].scalars.size() != module_.valueScalars(type))
            fail("argument " + std::to_string(p) + " of function " + name(function.id) + " does not fit its type");
        frame.values[module_.info(id).index] = arguments[p];
    }
    frames_.push_back(std::move(frame));
}

template <class Number>
void Machine<Number>::returnFrom(const Value<Number>* result) {
    const Id caller = frames_.back().caller;
    frames_.pop_back();
    if (frames_.empty()) {
        status_ = Status::done;
        return;
    }
    if (!result) return;
    const IdInfo& info = module_.info(caller);
    const Type& type = module_.types[info.type];
    if (!result->pointer && !result->image && result->scalars.size() != module_.valueScalars(type))
        fail("the result of call " + name(caller) + " does not fit its type");
    frames_.back().values[info.index] = *result;
    if (program_.options.observer == nullptr) return;
    // The call stands before the instruction that its frame comes to next.
    const Frame& frame = frames_.back();
    observe(frame.function->instructions[frame.next - 1]);
}

template <class Number>
void Machine<Number>::enterBlock(Id label) {
    Frame& frame = frames_.back();
    const auto found = frame.function->blockOf.find(label);
    if (found == frame.function->blockOf.end())
        fail("branch to " + name(label) + ", which is no block of the function");
    const Block& block = frame.function->blocks[found->second];
    // Phis see the values from before the branch: all are read before any is written.
    std::vector<std::pair<const Instruction*, Value<Number>>> phis;
    size_t next = block.begin;
    for (; next < block.end && frame.function->instructions[next].op == spv::OpPhi; ++next) {
        const Instruction& phi = frame.function->instructions[next];
        Id incoming = 0;
        for (size_t k = 0; k + 1 < phi.operands.size(); k += 2)
            if (phi.operands[k + 1] == frame.block) incoming = phi.operands[k];
        if (incoming == 0) fail("phi " + name(phi.result) + " has no value for predecessor " + name(frame.block));
        charge(1);
        phis.emplace_back(&phi, value(incoming));
    }
    noteLoops(frame, block);
    frame.block = label;
    frame.blockRank = block.rank;
    frame.next = next;
    for (auto& [phi, incoming] : phis) {
        setValue(*phi, std::move(incoming));
        if (program_.options.observer != nullptr) observe(*phi);
    }
}

/// Keeps the loops around the frame's place: those that `target` is outside of are left, a back edge counts.
template <class Number>
void Machine<Number>::noteLoops(Frame& frame, const Block& target) {
    auto& loops = frame.loops;
    while (!loops.empty() && (target.rank < loops.back().first || target.rank >= loops.back().end)) loops.pop_back();
    if (!loops.empty() && target.rank == loops.back().first) {
        ++loops.back().iteration;
    } else if (target.loopEnd != 0) {
        loops.push_back({target.rank, target.loopEnd, 0});
    }
}

template <class Number>
void Machine<Number>::demote() {
    helper_ = true;
    discarded_ = true;
    for (const InterfaceLayout& layout : module_.entryPointData[program_.entryPoint].layouts) {
        const Variable& variable = module_.variables[layout.variable];
        if (layout.output || !module_.decorationsOf(variable.id).isVolatile) continue;
        for (const InterfaceCell& cell : layout.cells)
            if (cell.isBuiltin && cell.builtin == spv::BuiltInHelperInvocation)
                variables_[layout.variable]->object->cells[cell.cell].bits = 1;
    }
}

template <class Number>
const Value<Number>& Machine<Number>::value(Id id) const {
    const IdInfo& info = module_.info(id);
    if (info.kind == IdKind::constant) return program_.constants[info.index];
    const Frame& frame = frames_.back();
    if (info.kind != IdKind::local || &module_.functions[info.function] != frame.function)
        fail(name(id) + " is no value here");
    const Value<Number>& result = frame.values[info.index];
    if (!result.defined) fail(name(id) + " is used before it is defined");
    return result;
}

template <class Number>
const Scalars<Number>& Machine<Number>::data(Id id) const {
    const Value<Number>& v = value(id);
    if (v.pointer && v.scalars.empty()) const_cast<Value<Number>&>(v).scalars = {pointerScalar(*v.pointer)};
    if (v.scalars.empty()) fail(name(id) + " is no numeric value");
    return v.scalars;
}

template <class Number>
const Scalars<Number>& Machine<Number>::data(Id id, size_t count) const {
    const Scalars<Number>& scalars = data(id);
    if (scalars.size() != count)
        fail(name(id) + " has " + std::to_string(scalars.size()) + " scalars where " + std::to_string(count) +
             " are needed");
    return scalars;
}

template <class Number>
int64_t Machine<Number>::signedInteger(Id id) const {
    const Type& type = module_.valueType(id);
    if (type.kind != TypeKind::integer) fail(name(id) + " is no integer");
    return asSigned(bits(id), type.width);
}

template <class Number>
Value<Number>& Machine<Number>::slot(const Instruction& i) {
    return frames_.back().values[module_.info(i.result).index];
}

template <class Number>
void Machine<Number>::setValue(const Instruction& i, Value<Number> v) {
    charge(v.scalars.size() / kScalarsPerStep);
    if (!v.pointer && !v.image && v.scalars.size() != resultCount(i))
        fail(name(i.op) + " " + name(i.result) + " has a value that does not fit its type");
    const Type& type = resultType(i);
    if (!v.pointer && !v.image && type.kind == TypeKind::pointer) v.pointer = scalarPointer(type, v.scalars[0].bits);
    v.defined = true;
    slot(i) = std::move(v);
}

template <class Number>
void Machine<Number>::setResult(const Instruction& i, Scalars<Number> scalars) {
    const Type& type = module_.scalarType(resultType(i));
    if (type.kind == TypeKind::floating)
        for (Scalar<Number>& s : scalars) round(s, type.width);
    Value<Number> v;
    v.scalars = std::move(scalars);
    setValue(i, std::move(v));
}

template <class Number>
std::vector<uint64_t> Machine<Number>::position() const {
    std::vector<uint64_t> result;
    for (const Frame& frame : frames_) {
        for (const auto& loop : frame.loops) {
            result.push_back(loop.first);
            result.push_back(loop.iteration);
        }
        result.push_back(frame.blockRank);
        result.push_back(frame.next);
    }
    return result;
}

template <class Number>
bool Machine<Number>::meet(Meeting meeting, Scalars<Number> offer) {
    if (group_) return true;
    meeting_ = meeting;
    offer_ = std::move(offer);
    status_ = Status::waiting;
    --frames_.back().next;  // the instruction runs again when the others are there
    return false;
}

template <class Number>
bool Machine<Number>::exchange(const std::vector<Number>& offer) {
    Scalars<Number> scalars;
    for (const Number& number : offer) scalars.push_back(Scalar<Number>::ofNumber(number));
    return meet(Meeting::exchange, std::move(scalars));
}

template <class Number>
void Machine<Number>::resume(GroupValues values) {
    group_ = std::move(values);
    status_ = Status::running;
}

/// P(right) - P(left) or P(lower) - P(upper), SPIR-V specification, "Derivative Instructions": fine in the
/// invocation's own row or column, coarse in the first one that is there.
template <class Number>
Number Machine<Number>::difference(size_t component, bool alongX, bool coarse) const {
    const uint32_t step = alongX ? 1 : 2, other = alongX ? 2 : 1;
    const std::array<uint32_t, 2> starts{coarse ? 0 : invocation_ & other, coarse ? other : invocation_ & other};
    for (const uint32_t start : starts) {
        const Scalars<Number>&from = (*group_)[start], &to = (*group_)[start + step];
        if (component < from.size() && component < to.size()) return to[component].number - from[component].number;
    }
    return Number(0);
}

template <class Number>
void Machine<Number>::derivative(const Instruction& i) {
    using std::fabs;
    const Scalars<Number>& p = data(i.operand(0), resultCount(i));
    std::vector<Number> offer;
    for (const Scalar<Number>& s : p) offer.push_back(s.number);
    if (!exchange(offer)) return;
    const bool coarse =
        i.op == spv::OpDPdxCoarse || i.op == spv::OpDPdyCoarse || i.op == spv::OpFwidthCoarse ||
        ((i.op == spv::OpDPdx || i.op == spv::OpDPdy || i.op == spv::OpFwidth) && program_.options.coarseDerivatives);
    const bool x = i.op == spv::OpDPdx || i.op == spv::OpDPdxFine || i.op == spv::OpDPdxCoarse;
    const bool y = i.op == spv::OpDPdy || i.op == spv::OpDPdyFine || i.op == spv::OpDPdyCoarse;
    // Fwidth is the sum of two results of instructions, each of which is rounded to the type if steps are.
    const bool single = program_.options.stepwise && module_.scalarType(resultType(i)).width == 32;
    const auto change = [&](size_t k, bool alongX) {
        const Number exact = difference(k, alongX, coarse);
        return single ? Number(toFloat32(exact)) : exact;
    };
    Scalars<Number> result;
    for (size_t k = 0; k < p.size(); ++k) {
        result.push_back(
            Scalar<Number>::ofNumber(x || y ? change(k, x) : fabs(change(k, true)) + fabs(change(k, false))));
    }
    group_.reset();
    setResult(i, std::move(result));
}

template class Machine<float>;
template class Machine<double>;
template class Machine<Real>;

}  // namespace vernier::reference
