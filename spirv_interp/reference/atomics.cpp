// Atomics on buffers, work-group memory and texels.
#include <cmath>

#include "spirv_interp/reference/integer_ops.h"
#include "spirv_interp/reference/machine.h"

namespace vernier::reference {

template <class Number>
bool Machine<Number>::executeAtomic(const Instruction& i) {
    const bool integers = i.op >= spv::OpAtomicExchange && i.op <= spv::OpAtomicXor;
    combining_ =
        integers || i.op == spv::OpAtomicFAddEXT || i.op == spv::OpAtomicFMinEXT || i.op == spv::OpAtomicFMaxEXT;
    if (combining_ && !helper_) tellCombined(i);
    const bool known = executeKnownAtomic(i);
    combining_ = false;
    return known;
}

template <class Number>
void Machine<Number>::tellCombined(const Instruction& i) {
    const Pointer<Number>& p = pointer(i.operand(0));
    if (!p.isBuffer || p.isPhysical || p.outside || p.atDescriptors) return;
    const bool counts = i.op == spv::OpAtomicIIncrement || i.op == spv::OpAtomicIDecrement;
    resources_.combined(
        accessOf(p, module_.types[p.type], p.offset), i.op,
        counts ? Scalar<Number>::ofBits(1) : scalar(i.operand(i.op == spv::OpAtomicCompareExchange ? 4 : 3)));
}

/// One invocation runs at a time, so an atomic is a load and a store. Helpers read but do not write.
template <class Number>
bool Machine<Number>::executeKnownAtomic(const Instruction& i) {
    const auto modify = [&](auto combine) {
        const Pointer<Number> p = pointer(i.operand(0));
        const Type& type = module_.types[p.type];
        if (type.kind != TypeKind::integer) failUnsupported(name(i.op) + " on type " + name(type.id));
        const uint64_t old = loadScalars(p)[0].bits & widthMask(type.width);
        store(p, {Scalar<Number>::ofBits(combine(old, type.width) & widthMask(type.width))});
        if (i.result != 0) setResult(i, Scalar<Number>::ofBits(old));
        return true;
    };
    // Operands: pointer, scope, semantics, value; exchange-compare: ..., semantics if unequal, value,
    // comparator.
    const auto operand = [&](size_t index) { return bits(i.operand(index)); };
    const auto arithmetic = [&](spv::Op op) {
        return modify([&, op](uint64_t old, uint32_t width) {
            return *integerOperation(op, width, {old, operand(3), 0, 0});
        });
    };
    const auto extreme = [&](bool isSigned, bool larger) {
        return modify([&, isSigned, larger](uint64_t old, uint32_t width) {
            const uint64_t v = operand(3);
            const bool greater = isSigned ? asSigned(v, width) > asSigned(old, width) : v > old;
            return greater == larger ? v : old;
        });
    };
    switch (i.op) {
        case spv::OpAtomicLoad:
            setResult(i, loadScalars(pointer(i.operand(0))));
            return true;
        case spv::OpAtomicStore:
            store(pointer(i.operand(0)), data(i.operand(3), 1));
            return true;
        case spv::OpAtomicExchange: {
            const Pointer<Number> p = pointer(i.operand(0));
            Scalars<Number> old = loadScalars(p);
            store(p, data(i.operand(3), 1));
            setResult(i, std::move(old));
            return true;
        }
        case spv::OpAtomicCompareExchange:
            return modify([&](uint64_t old, uint32_t) { return old == operand(5) ? operand(4) : old; });
        case spv::OpAtomicIIncrement:
            return modify([](uint64_t old, uint32_t) { return old + 1; });
        case spv::OpAtomicIDecrement:
            return modify([](uint64_t old, uint32_t) { return old - 1; });
        case spv::OpAtomicIAdd:
            return arithmetic(spv::OpIAdd);
        case spv::OpAtomicISub:
            return arithmetic(spv::OpISub);
        case spv::OpAtomicAnd:
            return arithmetic(spv::OpBitwiseAnd);
        case spv::OpAtomicOr:
            return arithmetic(spv::OpBitwiseOr);
        case spv::OpAtomicXor:
            return arithmetic(spv::OpBitwiseXor);
        case spv::OpAtomicSMin:
            return extreme(true, false);
        case spv::OpAtomicUMin:
            return extreme(false, false);
        case spv::OpAtomicSMax:
            return extreme(true, true);
        case spv::OpAtomicUMax:
            return extreme(false, true);
        case spv::OpAtomicFAddEXT:
        case spv::OpAtomicFMinEXT:
        case spv::OpAtomicFMaxEXT: {
            using std::isnan;
            const Pointer<Number> p = pointer(i.operand(0));
            const Scalar<Number> old = loadScalars(p)[0], v = scalar(i.operand(3));
            Scalar<Number> next = v;
            if (i.op == spv::OpAtomicFAddEXT)
                next.number = old.number + v.number;
            else if (isnan(v.number) || (i.op == spv::OpAtomicFMinEXT ? old.number < v.number : v.number < old.number))
                next = old;
            round(next, module_.types[p.type].width);
            store(p, {next});
            setResult(i, old);
            return true;
        }
        case spv::OpMemoryBarrier:
            return true;
        default:
            return false;
    }
}

template bool Machine<float>::executeAtomic(const Instruction&);
template bool Machine<double>::executeAtomic(const Instruction&);
template bool Machine<Real>::executeAtomic(const Instruction&);

}  // namespace vernier::reference
