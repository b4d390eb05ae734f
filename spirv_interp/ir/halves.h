// Operations on f32 values that round nothing when their operands are binary16 values.
#pragma once

#include "spirv_interp/ir/ir.h"

namespace vernier::ir {

/// Whether halves as operands give a half.
constexpr bool keepsHalves(Op op) {
    switch (op) {
        case Op::fneg:
        case Op::fabs:
        case Op::fsign:
        case Op::ffloor:
        case Op::fceil:
        case Op::ftrunc:
        case Op::froundEven:
        case Op::fmin:
        case Op::fmax:
        case Op::fclamp:
        case Op::fstep:
        case Op::ffrexpMantissa:
            return true;
        default:
            return false;
    }
}

}  // namespace vernier::ir
