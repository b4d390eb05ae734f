// What an atomic operation leaves in a word of memory, and the operation on memory that several threads see. U is
// uint32_t or uint64_t; floats are words that hold the bits of a float or a double.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "spirv_interp/ir/ir.h"

namespace vernier {

/// The word after the operation on one that held `old`. `comparator` counts for compareExchange alone.
template <class U>
U atomicCombined(ir::AtomicOp operation, U old, U value, U comparator) {
    using Signed = std::make_signed_t<U>;
    using Float = std::conditional_t<sizeof(U) == sizeof(float), float, double>;
    const auto asSigned = [](U x) { return static_cast<Signed>(x); };
    const auto asFloat = [](U x) { return std::bit_cast<Float>(x); };
    const auto isNan = [&](U x) { return asFloat(x) != asFloat(x); };
    switch (operation) {
        case ir::AtomicOp::add:
            return old + value;
        case ir::AtomicOp::sub:
            return old - value;
        case ir::AtomicOp::iand:
            return old & value;
        case ir::AtomicOp::ior:
            return old | value;
        case ir::AtomicOp::ixor:
            return old ^ value;
        case ir::AtomicOp::exchange:
        case ir::AtomicOp::store:
            return value;
        case ir::AtomicOp::load:
            return old;
        case ir::AtomicOp::smin:
            return asSigned(old) < asSigned(value) ? old : value;
        case ir::AtomicOp::smax:
            return asSigned(old) > asSigned(value) ? old : value;
        case ir::AtomicOp::umin:
            return old < value ? old : value;
        case ir::AtomicOp::umax:
            return old > value ? old : value;
        case ir::AtomicOp::compareExchange:
            return old == comparator ? value : old;
        case ir::AtomicOp::fadd:
            return std::bit_cast<U>(asFloat(old) + asFloat(value));
        // A NaN gives way to the other operand, as in fmin and fmax.
        case ir::AtomicOp::fmin:
            return isNan(value) || asFloat(old) < asFloat(value) ? old : value;
        case ir::AtomicOp::fmax:
            return isNan(value) || asFloat(old) > asFloat(value) ? old : value;
    }
    return old;
}

/// Runs the operation in one step that other threads cannot come between; the word as it was, 0 for a store. `word` is
/// aligned to its size.
template <class U>
U atomicApply(ir::AtomicOp operation, U* word, U value, U comparator) {
    const std::atomic_ref target(*word);
    switch (operation) {
        case ir::AtomicOp::add:
            return target.fetch_add(value);
        case ir::AtomicOp::sub:
            return target.fetch_sub(value);
        case ir::AtomicOp::exchange:
            return target.exchange(value);
        case ir::AtomicOp::load:
            return target.load();
        case ir::AtomicOp::store:
            target.store(value);
            return 0;
        default:
            break;
    }
    U old = target.load(std::memory_order_relaxed);
    while (!target.compare_exchange_weak(old, atomicCombined(operation, old, value, comparator),
                                         std::memory_order_acq_rel, std::memory_order_relaxed)) {
    }
    return old;
}

}  // namespace vernier
