// Superinstructions on integers, and from integers to floats.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/fused_ops.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {
namespace element {

VERNIER_ELEMENT(shiftRightAnd, uint32_t, uint32_t, (V a, V b, V c), return hn::And(shiftedRight(a, b), c);)
VERNIER_ELEMENT(shiftRightXor, uint32_t, uint32_t, (V a, V b, V c), return hn::Xor(shiftedRight(a, b), c);)
VERNIER_ELEMENT(shiftLeftXor, uint32_t, uint32_t, (V a, V b, V c), return hn::Xor(shiftedLeft(a, b), c);)
VERNIER_ELEMENT(xorMultiply, uint32_t, uint32_t, (V a, V b, V c), return hn::Mul(hn::Xor(a, b), c);)
VERNIER_ELEMENT(xor3, uint32_t, uint32_t, (V a, V b, V c), return hn::Xor3(a, b, c);)
VERNIER_ELEMENT(andOr, uint32_t, uint32_t, (V a, V b, V c), return hn::OrAnd(c, a, b);)
VERNIER_ELEMENT(integerMultiplyAdd, int32_t, int32_t, (V a, V b, V c), return hn::Add(hn::Mul(a, b), c);)
VERNIER_ELEMENT(shiftLeftAdd, uint32_t, uint32_t, (V a, V b, V c), return hn::Add(shiftedLeft(a, b), c);)
VERNIER_ELEMENT(shiftLeftOr, uint32_t, uint32_t, (V a, V b, V c), return hn::Or(shiftedLeft(a, b), c);)
VERNIER_ELEMENT(rotateLeft, uint32_t, uint32_t, (V a, V b),
                return hn::Or(shiftedLeft(a, b), shiftedRight(a, hn::Sub(hn::Zero(kU32), b)));)
VERNIER_ELEMENT(xorShiftRight, uint32_t, uint32_t, (V a, V b), return hn::Xor(shiftedRight(a, b), a);)
VERNIER_ELEMENT(xorShiftLeft, uint32_t, uint32_t, (V a, V b), return hn::Xor(shiftedLeft(a, b), a);)
VERNIER_ELEMENT(xorShiftMultiply, uint32_t, uint32_t, (V a, V b, V c),
                return hn::Mul(hn::Xor(shiftedRight(a, b), a), c);)

/// The float of a signed integer that lies in the place of a float.
HWY_INLINE VF converted(VF bits) {
    return hn::ConvertTo(kF32, hn::BitCast(kI32, bits));
}
VERNIER_ELEMENT(convertMultiply, float, float, (V a, V b), return hn::Mul(converted(a), b);)
VERNIER_ELEMENT(convertMultiplyAdd, float, float, (V a, V b, V c), return hn::Add(hn::Mul(converted(a), b), c);)
VERNIER_ELEMENT(convertMultiplySubtract, float, float, (V a, V b, V c), return hn::Sub(hn::Mul(converted(a), b), c);)

/// What unpacking operations have in common, and then what they do with their last operand. Their scalars stand from
/// operand kScalars on.
template <int kSign, size_t kScalars = 2>
struct Unpack {
    static constexpr size_t kInsts = instsFor(kScalars + (kSign == 0 ? 3 : 4));

    template <size_t K, Source kSource>
    static HWY_INLINE VF at(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        const VU from = StripOperand<uint32_t, kSource>::template at<K>(rows, scalars, (*inst)[1], accumulator);
        const VU bits =
            hn::And(shiftedRight(from, scalarAt(scalars, inst, kScalars)), scalarAt(scalars, inst, kScalars + 1));
        const VF product = hn::Mul(hn::ConvertTo(kF32, hn::BitCast(kI32, bits)),
                                   hn::BitCast(kF32, scalarAt(scalars, inst, kScalars + 2)));
        if constexpr (kSign == 0) {
            return product;
        } else {
            const VF last = hn::BitCast(kF32, scalarAt(scalars, inst, kScalars + 3));
            return kSign > 0 ? hn::Add(product, last) : hn::Sub(product, last);
        }
    }

  private:
    static HWY_INLINE VU scalarAt(const uint32_t* scalars, const Inst* inst, size_t k) {
        return hn::Set(kU32, scalars[(*inst)[k]]);
    }
};

/// What is unpacked times a factor; with kAdds, in front of the factor stands what is added.
template <bool kAdds>
struct UnpackTerm {
    static constexpr size_t kFactor = kAdds ? 3 : 2;
    using Value = Unpack<-1, kFactor + 1>;
    static constexpr size_t kInsts = Value::kInsts;

    static constexpr bool has(Form form) {
        const Source factor = form.sources[kFactor - 1];
        // What is unpacked is taken apart more than once, so that it lies in a row.
        if (form.sources[0] != Source::row || factor == Source::accumulator) return false;
        if (!kAdds) return form.sources[2] == Source::row;
        return form.sources[1] != Source::scalar;
    }

    template <size_t K, uint8_t kForm>
    static HWY_INLINE VF at(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        constexpr Form form = Form::at(kForm);
        const VF value = Value::template at<K, form.sources[0]>(rows, scalars, inst, accumulator);
        const VF factor = StripOperand<float, form.sources[kFactor - 1]>::template at<K>(rows, scalars,
                                                                                         (*inst)[kFactor], accumulator);
        const VF product = hn::Mul(value, factor);
        if constexpr (kAdds) {
            return hn::Add(
                product, StripOperand<float, form.sources[1]>::template at<K>(rows, scalars, (*inst)[2], accumulator));
        } else {
            return product;
        }
    }
};

}  // namespace element
}  // namespace

void addFusedOps(HandlerTables& tables) {
#define VERNIER_BATCH_FUSED(name, operands) addElement<element::name, operands, formSet(Op::name)>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
    addCompound<element::Unpack<0>>(tables, Op::unpackMultiply);
    addCompound<element::Unpack<1>>(tables, Op::unpackMultiplyAdd);
    addCompound<element::Unpack<-1>>(tables, Op::unpackMultiplySubtract);
    addFormed<element::UnpackTerm<false>>(tables, Op::unpackSubtractTimes);
    addFormed<element::UnpackTerm<true>>(tables, Op::unpackSubtractTimesAdd);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectFusedOps(Isa isa) {
    VERNIER_SELECT_ISA(isa, addFusedOps)
}
}  // namespace
void addFusedOps(Isa isa, HandlerTables& tables) {
    selectFusedOps(isa)(tables);
}
}  // namespace vernier::batch
#endif
