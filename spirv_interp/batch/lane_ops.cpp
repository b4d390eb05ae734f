// Rarer elementwise operations on 32-bit lanes, one lane at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/lane_ops.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/scalar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {
namespace lane {

constexpr auto& smulHigh = scalar::smulHigh<int32_t>;
constexpr auto& umulHigh = scalar::umulHigh<uint32_t>;
constexpr auto& sdiv = scalar::sdiv<int32_t>;
constexpr auto& udiv = scalar::udiv<uint32_t>;
constexpr auto& srem = scalar::srem<int32_t>;
constexpr auto& smod = scalar::smod<int32_t>;
constexpr auto& umod = scalar::umod<uint32_t>;
constexpr auto& bitFieldInsert = scalar::bitFieldInsert<uint32_t>;
constexpr auto& bitFieldSExtract = scalar::bitFieldSExtract<uint32_t>;
constexpr auto& bitFieldUExtract = scalar::bitFieldUExtract<uint32_t>;
constexpr auto& bitReverse = scalar::bitReverse<uint32_t>;
constexpr auto& bitCount = scalar::bitCount<uint32_t>;
constexpr auto& findILsb = scalar::findILsb<uint32_t>;
constexpr auto& findSMsb = scalar::findSMsb<uint32_t>;
constexpr auto& findUMsb = scalar::findUMsb<uint32_t>;
constexpr auto& addCarry = scalar::addCarry<uint32_t>;
constexpr auto& subBorrow = scalar::subBorrow<uint32_t>;
constexpr auto& fldexp = scalar::ldexp<float>;
float ffrexpMantissa(float x) {
    return scalar::frexp(x).mantissa;
}
int32_t ffrexpExponent(float x) {
    return scalar::frexp(x).exponent;
}
uint32_t packHalf(float low, float high) {
    return scalar::toHalf(low) | scalar::toHalf(high) << 16;
}
float unpackHalfLow(uint32_t halves) {
    return scalar::fromHalf(halves & 0xFFFFu);
}
float unpackHalfHigh(uint32_t halves) {
    return scalar::fromHalf(halves >> 16);
}
/// Denormal halves become zeros, as OpQuantizeToF16 asks.
float quantizeF16(float x) {
    const uint32_t half = scalar::toHalf(x);
    return scalar::fromHalf((half & 0x7C00u) == 0 ? half & 0x8000u : half);
}

}  // namespace lane
}  // namespace

void addLaneOps(HandlerTables& tables) {
#define VERNIER_BATCH_LANES(name, operands) addLanes<lane::name>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectLaneOps(Isa isa) {
    VERNIER_SELECT_ISA(isa, addLaneOps)
}
}  // namespace
void addLaneOps(Isa isa, HandlerTables& tables) {
    selectLaneOps(isa)(tables);
}
}  // namespace vernier::batch
#endif
