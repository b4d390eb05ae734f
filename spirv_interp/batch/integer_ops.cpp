// Elementwise integer operations, comparisons and conversions on 32-bit lanes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/integer_ops.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {
namespace element {

HWY_INLINE VF number(float value) {
    return hn::Set(kF32, value);
}
HWY_INLINE VI number(int32_t value) {
    return hn::Set(kI32, value);
}

VERNIER_ELEMENT(iadd, int32_t, int32_t, (V a, V b), return hn::Add(a, b);)
VERNIER_ELEMENT(isub, int32_t, int32_t, (V a, V b), return hn::Sub(a, b);)
VERNIER_ELEMENT(imul, int32_t, int32_t, (V a, V b), return hn::Mul(a, b);)
VERNIER_ELEMENT(ineg, int32_t, int32_t, (V a), return hn::Neg(a);)
VERNIER_ELEMENT(iabs, int32_t, int32_t, (V a), return hn::Abs(a);)
VERNIER_ELEMENT(isign, int32_t, int32_t, (V a), return hn::Max(hn::Min(a, number(1)), number(-1));)
VERNIER_ELEMENT(smin, int32_t, int32_t, (V a, V b), return hn::Min(a, b);)
VERNIER_ELEMENT(smax, int32_t, int32_t, (V a, V b), return hn::Max(a, b);)
VERNIER_ELEMENT(umin, uint32_t, uint32_t, (V a, V b), return hn::Min(a, b);)
VERNIER_ELEMENT(umax, uint32_t, uint32_t, (V a, V b), return hn::Max(a, b);)
VERNIER_ELEMENT(iand, uint32_t, uint32_t, (V a, V b), return hn::And(a, b);)
VERNIER_ELEMENT(ior, uint32_t, uint32_t, (V a, V b), return hn::Or(a, b);)
VERNIER_ELEMENT(ixor, uint32_t, uint32_t, (V a, V b), return hn::Xor(a, b);)
VERNIER_ELEMENT(inot, uint32_t, uint32_t, (V a), return hn::Not(a);)
VERNIER_ELEMENT(shl, uint32_t, uint32_t, (V a, V b), return shiftedLeft(a, b);)
VERNIER_ELEMENT(lshr, uint32_t, uint32_t, (V a, V b), return shiftedRight(a, b);)
VERNIER_ELEMENT(ashr, int32_t, int32_t, (V a, V b), return hn::Shr(a, hn::And(b, number(31)));)
VERNIER_ELEMENT(foeq, float, uint32_t, (V a, V b), return boolRow(hn::Eq(a, b));)
VERNIER_ELEMENT(fone, float, uint32_t, (V a, V b), return boolRow(hn::Or(hn::Lt(a, b), hn::Gt(a, b)));)
VERNIER_ELEMENT(folt, float, uint32_t, (V a, V b), return boolRow(hn::Lt(a, b));)
VERNIER_ELEMENT(fole, float, uint32_t, (V a, V b), return boolRow(hn::Le(a, b));)
VERNIER_ELEMENT(fueq, float, uint32_t, (V a, V b), return boolRow(hn::Not(hn::Or(hn::Lt(a, b), hn::Gt(a, b))));)
VERNIER_ELEMENT(fune, float, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Eq(a, b)));)
VERNIER_ELEMENT(fult, float, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Ge(a, b)));)
VERNIER_ELEMENT(fule, float, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Gt(a, b)));)
VERNIER_ELEMENT(fisnan, float, uint32_t, (V a), return boolRow(hn::IsNaN(a));)
VERNIER_ELEMENT(fisinf, float, uint32_t, (V a),
                return boolRow(hn::Eq(hn::BitCast(kU32, hn::Abs(a)), hn::Set(kU32, 0x7F800000u)));)
VERNIER_ELEMENT(ieq, uint32_t, uint32_t, (V a, V b), return boolRow(hn::Eq(a, b));)
VERNIER_ELEMENT(ine, uint32_t, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Eq(a, b)));)
VERNIER_ELEMENT(slt, int32_t, uint32_t, (V a, V b), return boolRow(hn::Lt(a, b));)
VERNIER_ELEMENT(sle, int32_t, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Gt(a, b)));)
VERNIER_ELEMENT(ult, uint32_t, uint32_t, (V a, V b), return boolRow(hn::Lt(a, b));)
VERNIER_ELEMENT(ule, uint32_t, uint32_t, (V a, V b), return hn::Not(boolRow(hn::Gt(a, b)));)
VERNIER_ELEMENT(select, uint32_t, uint32_t, (V condition, V yes, V no), return hn::IfVecThenElse(condition, yes, no);)

using ::vernier::HWY_NAMESPACE::minOrSecond;
using ::vernier::HWY_NAMESPACE::truncateInRange;

VERNIER_ELEMENT(ftos, float, int32_t, (V a), const VI whole = truncateInRange(hn::IfThenZeroElse(hn::IsNaN(a), a));
                const auto tooLarge = hn::RebindMask(kI32, hn::Ge(a, number(0x1p31f)));
                return hn::IfThenElse(tooLarge, number(INT32_MAX), whole);)
// Above 2^31 the value less 2^31 is exact and fits a signed integer; the top bit is put back afterwards.
VERNIER_ELEMENT(ftou, float, uint32_t, (V a), const V positive = hn::IfThenElseZero(hn::Gt(a, number(0.0f)), a);
                const V inside = minOrSecond(positive, number(0x1.fffffep31f));
                const auto upper = hn::Ge(inside, number(0x1p31f));
                const VI low = truncateInRange(hn::Sub(inside, hn::IfThenElseZero(upper, number(0x1p31f))));
                const VU value = hn::Xor(hn::BitCast(kU32, low), hn::And(boolRow(upper), hn::Set(kU32, 0x80000000u)));
                return hn::Or(value, boolRow(hn::Ge(positive, number(0x1p32f))));)
VERNIER_ELEMENT(stof, int32_t, float, (V a), return hn::ConvertTo(kF32, a);)
// Both halves are exact as floats, so their sum is rounded once.
VERNIER_ELEMENT(utof, uint32_t, float, (V a),
                const VF high = hn::ConvertTo(kF32, hn::BitCast(kI32, hn::ShiftRight<16>(a)));
                const VF low = hn::ConvertTo(kF32, hn::BitCast(kI32, hn::And(a, hn::Set(kU32, 0xFFFFu))));
                return hn::Add(hn::Mul(high, number(65536.0f)), low);)

/// The parts of a float on the way to a half. Magnitudes compare like integers.
struct HalfParts {
    HWY_INLINE explicit HalfParts(VF a)
        : sign(hn::And(hn::BitCast(kU32, a), hn::Set(kU32, 0x80000000u))),
          magnitude(hn::BitCast(kI32, hn::Xor(hn::BitCast(kU32, a), sign))) {}
    /// Puts together what stands for normal and for denormal halves; a NaN keeps the upper bits of its payload.
    HWY_INLINE VF join(VI normal, VF denormal, VI tooLarge) const {
        VI half = hn::IfThenElse(hn::Lt(magnitude, number(0x38800000)), hn::BitCast(kI32, denormal), normal);
        half = hn::IfThenElse(hn::Gt(half, number(0x477FFFFF)), tooLarge, half);
        const VI nan = hn::Or(hn::And(magnitude, number(~0x1FFF)), number(0x00400000));
        half = hn::IfThenElse(hn::Gt(magnitude, number(0x7F800000)), nan, half);
        return hn::BitCast(kF32, hn::Or(hn::BitCast(kU32, half), sign));
    }
    VU sign;
    VI magnitude;
};
// The last of a half's bits is bit 13 of the float. Denormal halves are multiples of 2^-24, the last bit of floats from
// 1/2 on: adding 1/2 makes the float adder round to them.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
// The machine's conversions give the same bits, those of NaNs, too (Intel SDM 2C, VCVTPS2PH).
VERNIER_ELEMENT(ftoh, float, float, (V a), const hn::Rebind<hwy::float16_t, decltype(kF32)> kF16;
                return hn::PromoteTo(kF32, hn::DemoteTo(kF16, a));)
#else
VERNIER_ELEMENT(ftoh, float, float, (V a), const HalfParts parts(a);
                const VI odd = hn::And(hn::ShiftRight<13>(parts.magnitude), number(1));
                const VI up = hn::Add(hn::Add(parts.magnitude, number(0xFFF)), odd); const VF halfway = number(0.5f);
                const VF denormal = hn::Sub(hn::Add(hn::BitCast(kF32, parts.magnitude), halfway), halfway);
                return parts.join(hn::And(up, number(~0x1FFF)), denormal, number(0x7F800000));)
#endif
VERNIER_ELEMENT(ftohZero, float, float, (V a), const HalfParts parts(a);
                const VF units = hn::Mul(hn::BitCast(kF32, parts.magnitude), number(0x1p24f));
                const VF denormal = hn::Mul(hn::Trunc(minOrSecond(units, number(1024.0f))), number(0x1p-24f));
                const VI infinity = number(0x7F800000);
                const VI tooLarge = hn::IfThenElse(hn::Eq(parts.magnitude, infinity), infinity, number(0x477FE000));
                return parts.join(hn::And(parts.magnitude, number(~0x1FFF)), denormal, tooLarge);)
VERNIER_ELEMENT(boolToInt, uint32_t, uint32_t, (V a), return hn::ShiftRight<31>(a);)

}  // namespace element
}  // namespace

void addIntegerOps(HandlerTables& tables) {
#define VERNIER_BATCH_INTEGER(name, operands) addElement<element::name, operands, formSet(Op::name)>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectIntegerOps(Isa isa) {
    VERNIER_SELECT_ISA(isa, addIntegerOps)
}
}  // namespace
void addIntegerOps(Isa isa, HandlerTables& tables) {
    selectIntegerOps(isa)(tables);
}
}  // namespace vernier::batch
#endif
