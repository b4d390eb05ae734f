// What atomic operations do to words of 32 bits, for the tests to compare with; the engine has its own
// (spirv_interp/atomic.h).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "spirv_interp/ir/ir.h"

namespace vernier::test {

/// What the operation leaves in memory that held `old`. `comparator`: of compareExchange alone.
inline uint32_t atomicResult(ir::AtomicOp op, uint32_t old, uint32_t value, uint32_t comparator) {
    const auto s = [](uint32_t x) { return static_cast<int32_t>(x); };
    const auto f = [](uint32_t x) { return std::bit_cast<float>(x); };
    const bool valueIsNan = f(value) != f(value);
    switch (op) {
        case ir::AtomicOp::add:
            return old + value;
        case ir::AtomicOp::sub:
            return old - value;
        case ir::AtomicOp::smin:
            return s(old) < s(value) ? old : value;
        case ir::AtomicOp::smax:
            return s(old) > s(value) ? old : value;
        case ir::AtomicOp::umin:
            return std::min(old, value);
        case ir::AtomicOp::umax:
            return std::max(old, value);
        case ir::AtomicOp::iand:
            return old & value;
        case ir::AtomicOp::ior:
            return old | value;
        case ir::AtomicOp::ixor:
            return old ^ value;
        case ir::AtomicOp::exchange:
        case ir::AtomicOp::store:
            return value;
        case ir::AtomicOp::compareExchange:
            return old == comparator ? value : old;
        case ir::AtomicOp::load:
            return old;
        case ir::AtomicOp::fadd:
            return std::bit_cast<uint32_t>(f(old) + f(value));
        // Of two zeros the value; a NaN gives way to the other operand.
        case ir::AtomicOp::fmin:
            return valueIsNan || f(old) < f(value) ? old : value;
        case ir::AtomicOp::fmax:
            return valueIsNan || f(old) > f(value) ? old : value;
    }
    return old;
}

}  // namespace vernier::test
