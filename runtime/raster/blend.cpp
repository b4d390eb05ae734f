#include "runtime/raster/blend.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/blend.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using VF = hn::Vec<F>;

struct Pixels {
    VF source[4], second[4], destination[4], constant[4];
};

HWY_INLINE VF oneMinus(VF v) {
    return hn::Sub(hn::Set(F(), 1.0f), v);
}

/// The factor for component c (3 = alpha).
VF factorOf(VkBlendFactor factor, const Pixels& p, int c) {
    const F f;
    switch (factor) {
        case VK_BLEND_FACTOR_ZERO:
            return hn::Zero(f);
        case VK_BLEND_FACTOR_SRC_COLOR:
            return p.source[c];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
            return oneMinus(p.source[c]);
        case VK_BLEND_FACTOR_DST_COLOR:
            return p.destination[c];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
            return oneMinus(p.destination[c]);
        case VK_BLEND_FACTOR_SRC_ALPHA:
            return p.source[3];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
            return oneMinus(p.source[3]);
        case VK_BLEND_FACTOR_DST_ALPHA:
            return p.destination[3];
        case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
            return oneMinus(p.destination[3]);
        case VK_BLEND_FACTOR_CONSTANT_COLOR:
            return p.constant[c];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
            return oneMinus(p.constant[c]);
        case VK_BLEND_FACTOR_CONSTANT_ALPHA:
            return p.constant[3];
        case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
            return oneMinus(p.constant[3]);
        case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE:
            return c == 3 ? hn::Set(f, 1.0f) : minOrSecond(p.source[3], oneMinus(p.destination[3]));
        case VK_BLEND_FACTOR_SRC1_COLOR:
            return p.second[c];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR:
            return oneMinus(p.second[c]);
        case VK_BLEND_FACTOR_SRC1_ALPHA:
            return p.second[3];
        case VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA:
            return oneMinus(p.second[3]);
        default:
            return hn::Set(f, 1.0f);
    }
}

VF combine(VkBlendOp op, VkBlendFactor sourceFactor, VkBlendFactor destinationFactor, const Pixels& p, int c) {
    const VF s = p.source[c], d = p.destination[c];
    switch (op) {
        case VK_BLEND_OP_MIN:
            return minOrSecond(s, d);
        case VK_BLEND_OP_MAX:
            return maxOrSecond(s, d);
        default:
            break;
    }
    const VF weightedSource = hn::Mul(s, factorOf(sourceFactor, p, c));
    const VF weightedDestination = hn::Mul(d, factorOf(destinationFactor, p, c));
    switch (op) {
        case VK_BLEND_OP_SUBTRACT:
            return hn::Sub(weightedSource, weightedDestination);
        case VK_BLEND_OP_REVERSE_SUBTRACT:
            return hn::Sub(weightedDestination, weightedSource);
        default:
            return hn::Add(weightedSource, weightedDestination);
    }
}

void blend(const BlendInput& in) {
    const F f;
    const ColorPlan& plan = *in.plan;
    const VkPipelineColorBlendAttachmentState& state = plan.blend;
    const auto limit = [&](VF v) HWY_ATTR {
        const VF low = hn::Set(f, plan.clampLow);  // also for NaN
        return plan.clampInputs ? hn::IfThenElse(hn::Gt(v, low), minOrSecond(v, hn::Set(f, 1.0f)), low) : v;
    };
    Pixels p;
    for (int c = 0; c < 4; ++c) p.constant[c] = limit(hn::Set(f, in.constants[c]));
    for (uint32_t n = 0; n < in.count; n += hn::Lanes(f)) {
        for (int c = 0; c < 4; ++c) {
            p.source[c] = limit(hn::LoadU(f, in.source[c] + n));
            p.destination[c] = hn::LoadU(f, in.destination[c] + n);
            p.second[c] = in.secondSource[c] != nullptr ? limit(hn::LoadU(f, in.secondSource[c] + n)) : hn::Zero(f);
        }
        for (int c = 0; c < 3; ++c)
            hn::StoreU(combine(state.colorBlendOp, state.srcColorBlendFactor, state.dstColorBlendFactor, p, c), f,
                       in.result[c] + n);
        hn::StoreU(combine(state.alphaBlendOp, state.srcAlphaBlendFactor, state.dstAlphaBlendFactor, p, 3), f,
                   in.result[3] + n);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {

BlendFn blendFunction(Isa isa) {
    VERNIER_SELECT_ISA(isa, blend)
}

}  // namespace vernier
#endif
