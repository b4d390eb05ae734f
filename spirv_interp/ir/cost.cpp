#include "spirv_interp/ir/cost.h"

#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

constexpr uint32_t kDear = 8;

}  // namespace

uint32_t costOf(const Program& program, const Inst& inst) {
    if (!isMovable(program, inst)) return kTooDear;
    switch (inst.op) {
        case Op::constant:
        case Op::undef:
        case Op::copy:
            return 0;
        case Op::fdiv:
        case Op::fsqrt:
        case Op::finverseSqrt:
        case Op::loadBuffer:
        case Op::fsmoothstep:
            return 4;
        case Op::frem:
        case Op::fmod:
        case Op::ffma:
        case Op::sdiv:
        case Op::udiv:
        case Op::srem:
        case Op::smod:
        case Op::umod:
        case Op::fldexp:
        case Op::inputIndexed:
        case Op::interpolateAtCentroid:
        case Op::interpolateAtSample:
        case Op::interpolateAtOffset:
            return kDear;
        default:
            return inst.op >= Op::fsin && inst.op <= Op::fpow ? kDear : 1;
    }
}

}  // namespace vernier::ir
