// Elementwise float operations and sums of products.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/float_ops.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {
namespace element {

using ::vernier::HWY_NAMESPACE::maxOrSecond;
using ::vernier::HWY_NAMESPACE::minOrSecond;

HWY_INLINE VF number(float value) {
    return hn::Set(kF32, value);
}
/// The smaller operand; a NaN gives way to the other operand (NMin). Of two zeros it is the second.
HWY_INLINE VF smaller(VF a, VF b) {
    return hn::IfThenElse(hn::IsNaN(b), a, minOrSecond(a, b));
}
HWY_INLINE VF larger(VF a, VF b) {
    return hn::IfThenElse(hn::IsNaN(b), a, maxOrSecond(a, b));
}
HWY_INLINE VF clamped(VF x, VF low, VF high) {
    return smaller(larger(x, low), high);
}

VERNIER_ELEMENT(fadd, float, float, (V a, V b), return hn::Add(a, b);)
VERNIER_ELEMENT(fsub, float, float, (V a, V b), return hn::Sub(a, b);)
VERNIER_ELEMENT(fmul, float, float, (V a, V b), return hn::Mul(a, b);)
VERNIER_ELEMENT(fdiv, float, float, (V a, V b), return hn::Div(a, b);)
VERNIER_ELEMENT(frem, float, float, (V a, V b), return hn::Sub(a, hn::Mul(b, hn::Trunc(hn::Div(a, b))));)
VERNIER_ELEMENT(fmod, float, float, (V a, V b), return hn::Sub(a, hn::Mul(b, hn::Floor(hn::Div(a, b))));)
VERNIER_ELEMENT(fneg, float, float, (V a), return hn::Xor(a, number(-0.0f));)
VERNIER_ELEMENT(ffma, float, float, (V a, V b, V c), return ::vernier::HWY_NAMESPACE::fusedMulAdd(kF32, a, b, c);)
VERNIER_ELEMENT(fabs, float, float, (V a), return hn::Abs(a);)
VERNIER_ELEMENT(fsign, float, float, (V a), const V below = hn::IfThenElseZero(hn::Lt(a, number(0.0f)), number(-1.0f));
                return hn::IfThenElse(hn::Gt(a, number(0.0f)), number(1.0f), below);)
VERNIER_ELEMENT(ffloor, float, float, (V a), return hn::Floor(a);)
VERNIER_ELEMENT(fceil, float, float, (V a), return hn::Ceil(a);)
VERNIER_ELEMENT(ftrunc, float, float, (V a), return hn::Trunc(a);)
VERNIER_ELEMENT(froundEven, float, float, (V a), return hn::Round(a);)
// x - floor(x) rounds up to 1 just below an integer; the largest float below 1 keeps the result in [0, 1).
VERNIER_ELEMENT(ffract, float, float, (V a), return minOrSecond(number(0x1.fffffep-1f), hn::Sub(a, hn::Floor(a)));)
VERNIER_ELEMENT(fmin, float, float, (V a, V b), return smaller(a, b);)
VERNIER_ELEMENT(fmax, float, float, (V a, V b), return larger(a, b);)
VERNIER_ELEMENT(fclamp, float, float, (V x, V low, V high), return clamped(x, low, high);)
VERNIER_ELEMENT(fmix, float, float, (V x, V y, V a),
                return hn::Add(hn::Mul(x, hn::Sub(number(1.0f), a)), hn::Mul(y, a));)
VERNIER_ELEMENT(fstep, float, float, (V edge, V x), return hn::IfThenZeroElse(hn::Lt(x, edge), number(1.0f));)
VERNIER_ELEMENT(fsmoothstep, float, float, (V edge0, V edge1, V x),
                const V t = clamped(hn::Div(hn::Sub(x, edge0), hn::Sub(edge1, edge0)), number(0.0f), number(1.0f));
                return hn::Mul(hn::Mul(t, t), hn::Sub(number(3.0f), hn::Mul(number(2.0f), t)));)
VERNIER_ELEMENT(fsqrt, float, float, (V a), return hn::Sqrt(a);)

VERNIER_ELEMENT(multiplyAdd, float, float, (V a, V b, V c), return hn::Add(hn::Mul(a, b), c);)
VERNIER_ELEMENT(multiplySubtract, float, float, (V a, V b, V c), return hn::Sub(hn::Mul(a, b), c);)
VERNIER_ELEMENT(subtractMultiply, float, float, (V a, V b, V c), return hn::Sub(c, hn::Mul(a, b));)

}  // namespace element

/// Sums of products; the second factors are rows or scalars.
template <size_t kTerms, Source kFactor>
struct Dot {
    static constexpr size_t kInsts = instsFor(1 + 2 * kTerms);

    template <size_t K, Source kSource>
    static HWY_INLINE VF at(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        VF sum = hn::Add(product<K, 0, kSource>(rows, scalars, inst, accumulator),
                         product<K, 1>(rows, scalars, inst, accumulator));
        if constexpr (kTerms > 2) sum = hn::Add(sum, product<K, 2>(rows, scalars, inst, accumulator));
        if constexpr (kTerms > 3) sum = hn::Add(sum, product<K, 3>(rows, scalars, inst, accumulator));
        return sum;
    }

  private:
    template <size_t K, size_t kTerm, Source kSource = Source::row>
    static HWY_INLINE VF product(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        const VF a = StripOperand<float, kSource>::template at<K>(rows, scalars, (*inst)[1 + 2 * kTerm], accumulator);
        return hn::Mul(
            a, StripOperand<float, kFactor>::template at<K>(rows, scalars, (*inst)[2 + 2 * kTerm], accumulator));
    }
};

}  // namespace

void addFloatOps(HandlerTables& tables) {
#define VERNIER_BATCH_FLOAT(name, operands) addElement<element::name, operands, formSet(Op::name)>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
    addCompound<Dot<2, Source::row>>(tables, Op::dot2);
    addCompound<Dot<3, Source::row>>(tables, Op::dot3);
    addCompound<Dot<4, Source::row>>(tables, Op::dot4);
    addCompound<Dot<2, Source::scalar>>(tables, Op::dot2Scalar);
    addCompound<Dot<3, Source::scalar>>(tables, Op::dot3Scalar);
    addCompound<Dot<4, Source::scalar>>(tables, Op::dot4Scalar);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectFloatOps(Isa isa) {
    VERNIER_SELECT_ISA(isa, addFloatOps)
}
}  // namespace
void addFloatOps(Isa isa, HandlerTables& tables) {
    selectFloatOps(isa)(tables);
}
}  // namespace vernier::batch
#endif
