// The handlers of transcendental functions, per tier.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/math.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {

/// Calls `Function`, written for the lanes of `Tier`, with float vectors: for tiers in double, half a vector
/// at a time.
template <class Tier, class Function, class... V>
HWY_INLINE VF callFor(V... operands) {
    if constexpr (sizeof(typename Tier::T) == sizeof(float)) {
        return Function::apply(operands...);
    } else {
        const hn::Half<F32> half;
        const hn::RepartitionToWide<F32> wide;
        const auto lower = Function::apply(hn::PromoteTo(wide, hn::LowerHalf(half, operands))...);
        const auto upper = Function::apply(hn::PromoteTo(wide, hn::UpperHalf(half, operands))...);
        return hn::Combine(kF32, hn::DemoteTo(half, upper), hn::DemoteTo(half, lower));
    }
}

template <class Tier, class Function>
struct Element {
    using InType = float;
    template <class... V>
    static HWY_INLINE VF apply(V... operands) {
        return callFor<Tier, Function>(operands...);
    }
};

/// Functions<Tier>::name as a type.
#define VERNIER_MATH(irName, name)                           \
    template <class Tier>                                    \
    struct irName {                                          \
        template <class... V>                                \
        static HWY_INLINE auto apply(V... operands) {        \
            return math::Functions<Tier>::name(operands...); \
        }                                                    \
    };
namespace function {
VERNIER_MATH(fsin, sin)
VERNIER_MATH(fcos, cos)
VERNIER_MATH(ftan, tan)
VERNIER_MATH(fasin, asin)
VERNIER_MATH(facos, acos)
VERNIER_MATH(fatan, atan)
VERNIER_MATH(fatan2, atan2)
VERNIER_MATH(fsinh, sinh)
VERNIER_MATH(fcosh, cosh)
VERNIER_MATH(ftanh, tanh)
VERNIER_MATH(fasinh, asinh)
VERNIER_MATH(facosh, acosh)
VERNIER_MATH(fatanh, atanh)
VERNIER_MATH(fexp, exp)
VERNIER_MATH(fexp2, exp2)
VERNIER_MATH(flog, log)
VERNIER_MATH(flog2, log2)
VERNIER_MATH(fpow, pow)
VERNIER_MATH(finverseSqrt, inverseSqrt)
}  // namespace function
#undef VERNIER_MATH

template <class Tier>
void addTier(HandlerTables& tables) {
#define VERNIER_BATCH_MATH(name, operands) \
    addPlain<runRows<Element<Tier, function::name<Tier>>, operands>>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
}

}  // namespace

void addFastMath(HandlerTables& tables) {
    addTier<math::Fast>(tables);
}
void addStandardMath(HandlerTables& tables) {
    addTier<math::Standard>(tables);
}
void addFineMath(HandlerTables& tables) {
    addTier<math::Fine>(tables);
}
void addReferenceMath(HandlerTables& tables) {
    addTier<math::Reference>(tables);
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectFast(Isa isa){VERNIER_SELECT_ISA(isa, addFastMath)} AddHandlers
    selectStandard(Isa isa){VERNIER_SELECT_ISA(isa, addStandardMath)} AddHandlers
    selectFine(Isa isa){VERNIER_SELECT_ISA(isa, addFineMath)} AddHandlers selectReference(Isa isa) {
    VERNIER_SELECT_ISA(isa, addReferenceMath)
}
}  // namespace

void addMath(Isa isa, MathTier tier, HandlerTables& tables) {
    switch (tier) {
        case MathTier::fast:
            return selectFast(isa)(tables);
        case MathTier::standard:
            return selectStandard(isa)(tables);
        case MathTier::fine:
            return selectFine(isa)(tables);
        case MathTier::reference:
            return selectReference(isa)(tables);
    }
}
}  // namespace vernier::batch
#endif
