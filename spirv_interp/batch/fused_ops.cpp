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

HWY_INLINE VU scalarAt(const uint32_t* scalars, const Inst* inst, size_t k) {
    return hn::Set(kU32, scalars[(*inst)[k]]);
}

/// float(word & mask) * scale, then + or - a last operand. These scalars are operands kFirst, kFirst + kStep, ...
template <int kSign, size_t kFirst, size_t kStep>
HWY_INLINE VF unpacked(const uint32_t* scalars, const Inst* inst, VU word) {
    const VI bits = hn::BitCast(kI32, hn::And(word, scalarAt(scalars, inst, kFirst)));
    const VF product = hn::Mul(hn::ConvertTo(kF32, bits), hn::BitCast(kF32, scalarAt(scalars, inst, kFirst + kStep)));
    if constexpr (kSign == 0) {
        return product;
    } else {
        const VF last = hn::BitCast(kF32, scalarAt(scalars, inst, kFirst + 2 * kStep));
        return kSign > 0 ? hn::Add(product, last) : hn::Sub(product, last);
    }
}

template <int kSign>
struct Unpack {
    static constexpr size_t kInsts = instsFor(kSign == 0 ? 4 : 5);

    template <size_t K, Source kSource>
    static HWY_INLINE VF at(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        return unpacked<kSign, 2, 1>(
            scalars, inst, StripOperand<uint32_t, kSource>::template at<K>(rows, scalars, (*inst)[1], accumulator));
    }
};

struct UnpackDot3 {
    static constexpr size_t kTerms = 3, kInsts = instsFor(2 + 4 * kTerms);

    template <size_t K, Source kSource>
    static HWY_INLINE VF at(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU accumulator) {
        const VU word = StripOperand<uint32_t, kSource>::template at<K>(rows, scalars, (*inst)[1], accumulator);
        const VF sum = hn::Add(term<K, 0>(rows, scalars, inst, word), term<K, 1>(rows, scalars, inst, word));
        return hn::Add(sum, term<K, 2>(rows, scalars, inst, word));
    }

  private:
    template <size_t K, size_t kTerm>
    static HWY_INLINE VF term(const std::byte* rows, const uint32_t* scalars, const Inst* inst, VU word) {
        const VF factor =
            StripOperand<float, Source::row>::template at<K>(rows, scalars, (*inst)[2 + kTerm], hn::Zero(kU32));
        return hn::Mul(unpacked<-1, 2 + kTerms + kTerm, kTerms>(scalars, inst, word), factor);
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
    addCompound<element::UnpackDot3>(tables, Op::unpackDot3);
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
