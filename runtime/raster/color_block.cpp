#include "runtime/raster/color_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/raster/color_block.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "runtime/format/convert-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

constexpr uint32_t kLanes = hn::MaxLanes(U32());
constexpr uint32_t kHalf = kLanes / 2;
using HalfRow = hn::Half<U32>;

// --- A vector of texels on the screen

/// In rows, a vector is part of a row, one row, or two of them; in quads, two half vectors one above the other.
struct TexelPlace {
    uint32_t* upper;
    uint32_t* lower;  // where the upper half of the lanes goes
};

template <LaneOrder kOrder>
HWY_INLINE TexelPlace placeOf(const BlockColorInput& in, uint32_t lane) {
    std::byte* first = in.texels + rowOf(kOrder, lane) * in.rowPitch + size_t{columnOf(kOrder, lane)} * 4;
    const bool below = kOrder == LaneOrder::quads || kLanes > 8;
    return {reinterpret_cast<uint32_t*>(first),
            reinterpret_cast<uint32_t*>(first + (below ? in.rowPitch : size_t{kHalf} * 4))};
}

struct LanePermutation {
    alignas(64) int32_t index[kLanes];
};

/// Lanes in quads from two half vectors of rows.
constexpr LanePermutation quadsFromRows() {
    LanePermutation p{};
    for (uint32_t lane = 0; lane < kLanes; ++lane)
        p.index[lane] = static_cast<int32_t>(lane / 4 * 2 + lane % 2 + kHalf * (lane / 2 % 2));
    return p;
}

constexpr LanePermutation rowsFromQuads() {
    constexpr LanePermutation kInverse = quadsFromRows();
    LanePermutation p{};
    for (uint32_t lane = 0; lane < kLanes; ++lane)
        p.index[static_cast<uint32_t>(kInverse.index[lane])] = static_cast<int32_t>(lane);
    return p;
}

template <LaneOrder kOrder>
HWY_INLINE VU loadTexels(const TexelPlace& at) {
    const VU rows = hn::Combine(U32(), hn::LoadU(HalfRow(), at.lower), hn::LoadU(HalfRow(), at.upper));
    if constexpr (kOrder == LaneOrder::rows) return rows;
    static constexpr LanePermutation kPermutation = quadsFromRows();
    return hn::TableLookupLanes(rows, hn::SetTableIndices(U32(), kPermutation.index));
}

template <LaneOrder kOrder>
HWY_INLINE void storeTexels(VU texels, const TexelPlace& at) {
    if constexpr (kOrder == LaneOrder::quads) {
        static constexpr LanePermutation kPermutation = rowsFromQuads();
        texels = hn::TableLookupLanes(texels, hn::SetTableIndices(U32(), kPermutation.index));
    }
    hn::StoreU(hn::LowerHalf(HalfRow(), texels), HalfRow(), at.upper);
    hn::StoreU(hn::UpperHalf(HalfRow(), texels), HalfRow(), at.lower);
}

// --- Components: [0..2] in the order of the bytes of a texel, [3] alpha

struct Colors {
    VF c[4];
};

/// The codes of values in [0, 1], and a little above where a blend equation rounds up.
template <bool kSrgb>
HWY_INLINE VU packTexels(const Colors& colors) {
    if constexpr (kSrgb) {
        const VU low = hn::Or(encodeSrgbV(colors.c[0]), hn::ShiftLeft<8>(encodeSrgbV(colors.c[1])));
        const VU high =
            hn::Or(hn::ShiftLeft<16>(encodeSrgbV(colors.c[2])), hn::ShiftLeft<24>(encodeUnormV(colors.c[3], 8)));
        return hn::Or(low, high);
    } else {
        // A float of the magnitude of kMagic has its last bit worth 1: adding it rounds the product to the nearest
        // integer, ties to even, into the low bits. The other bits are the same for all, so that one exclusive or
        // takes the four of them away.
        constexpr float kMagic = 0x1.8p23f;
        constexpr uint32_t kBits = std::bit_cast<uint32_t>(kMagic);
        const auto code = [](VF value) HWY_ATTR {
            return bitsOf(fusedMulAdd(F32(), value, splatFloat(255.0f), splatFloat(kMagic)));
        };
        const VU low = hn::Xor(code(colors.c[0]), hn::ShiftLeft<8>(code(colors.c[1])));
        const VU high = hn::Xor(hn::ShiftLeft<16>(code(colors.c[2])), hn::ShiftLeft<24>(code(colors.c[3])));
        return hn::Xor(hn::Xor(low, high), splatBits(kBits ^ kBits << 8 ^ kBits << 16 ^ kBits << 24));
    }
}

template <bool kSrgb>
HWY_INLINE Colors unpackTexels(VU texels) {
    const VU mask = splatBits(0xff);
    const VU codes[3] = {hn::And(texels, mask), hn::And(hn::ShiftRight<8>(texels), mask),
                         hn::And(hn::ShiftRight<16>(texels), mask)};
    Colors colors;
    for (int c = 0; c < 3; ++c) colors.c[c] = kSrgb ? decodeSrgbV(codes[c]) : decodeUnormV(codes[c], 8);
    colors.c[3] = decodeUnormV(hn::ShiftRight<24>(texels), 8);
    return colors;
}

// --- Blend equations: source * factor + destination * factor

enum class Factor { zero, one, sourceAlpha, oneMinusSourceAlpha };

/// A product with 0 or 1 is left out: what is multiplied lies in [0, 1].
template <Factor kFactor>
HWY_INLINE VF weighted(VF value, VF alpha, VF oneMinusAlpha) {
    if constexpr (kFactor == Factor::zero) return hn::Zero(F32());
    if constexpr (kFactor == Factor::one) return value;
    return hn::Mul(value, kFactor == Factor::sourceAlpha ? alpha : oneMinusAlpha);
}

template <Factor kSource, Factor kDestination>
HWY_INLINE VF combined(VF source, VF destination, VF alpha, VF oneMinusAlpha) {
    const VF s = weighted<kSource>(source, alpha, oneMinusAlpha);
    if constexpr (kDestination == Factor::zero) return s;
    const VF d = weighted<kDestination>(destination, alpha, oneMinusAlpha);
    if constexpr (kSource == Factor::zero) return d;
    return hn::Add(s, d);
}

struct Equation {
    Factor colorSource, colorDestination, alphaSource, alphaDestination;
};

template <bool kSrgb, Factor kColorSource, Factor kColorDestination, Factor kAlphaSource, Factor kAlphaDestination>
struct Kernel {
    static constexpr bool kBlends = kColorDestination != Factor::zero || kAlphaDestination != Factor::zero;

    template <LaneOrder kOrder>
    static HWY_INLINE void run(const BlockColorInput& in) {
        const ColorPlan& plan = *in.plan;
        const float* planes[4] = {nullptr, nullptr, nullptr, in.source[3]};
        for (uint32_t c = 0; c < 3; ++c) planes[plan.ops.layout.rgba[c].offset / 8] = in.source[c];
        uint32_t writeBits;
        std::memcpy(&writeBits, plan.writeBits.data(), 4);
        const VF zero = hn::Zero(F32()), one = splatFloat(1.0f);
        for (uint32_t n = 0; n < in.lanes; n += kLanes) {
            Colors source;
            // NaN becomes 0.
            for (int c = 0; c < 4; ++c) source.c[c] = clampOrLowV(hn::LoadU(F32(), planes[c] + n), zero, one);
            const TexelPlace place = placeOf<kOrder>(in, n);
            VU texels, before;
            if constexpr (kBlends) {
                before = loadTexels<kOrder>(place);
                const Colors destination = unpackTexels<kSrgb>(before);
                const VF alpha = source.c[3], rest = hn::Sub(one, alpha);
                Colors result;
                for (int c = 0; c < 3; ++c)
                    result.c[c] = combined<kColorSource, kColorDestination>(source.c[c], destination.c[c], alpha, rest);
                result.c[3] = combined<kAlphaSource, kAlphaDestination>(alpha, destination.c[3], alpha, rest);
                for (int c = 0; c < 4; ++c) result.c[c] = minOrSecond(result.c[c], one);
                texels = packTexels<kSrgb>(result);
            } else {
                texels = packTexels<kSrgb>(source);
            }
            if (plan.partialMask || in.mask != nullptr) {
                if constexpr (!kBlends) before = loadTexels<kOrder>(place);
                VU written = splatBits(writeBits);
                if (in.mask != nullptr) written = hn::And(written, hn::LoadU(U32(), in.mask + n));
                texels = hn::Or(hn::And(texels, written), hn::AndNot(written, before));
            }
            storeTexels<kOrder>(texels, place);
        }
    }

    static void run(const BlockColorInput& in) {
        if (in.order == LaneOrder::quads) {
            run<LaneOrder::quads>(in);
        } else {
            run<LaneOrder::rows>(in);
        }
    }
};

template <bool kSrgb>
BlockColorFn kernelFor(ColorPath path, const Equation& e) {
    using enum Factor;
    if (path == ColorPath::store) return Kernel<kSrgb, one, zero, one, zero>::run;
#define VERNIER_EQUATION(cs, cd, as, ad)                                                                            \
    if (e.colorSource == (cs) && e.colorDestination == (cd) && e.alphaSource == (as) && e.alphaDestination == (ad)) \
        return Kernel<kSrgb, cs, cd, as, ad>::run;
    VERNIER_EQUATION(sourceAlpha, oneMinusSourceAlpha, one, oneMinusSourceAlpha)
    VERNIER_EQUATION(sourceAlpha, oneMinusSourceAlpha, sourceAlpha, oneMinusSourceAlpha)
    VERNIER_EQUATION(sourceAlpha, oneMinusSourceAlpha, one, zero)
    VERNIER_EQUATION(sourceAlpha, oneMinusSourceAlpha, zero, one)
    VERNIER_EQUATION(one, oneMinusSourceAlpha, one, oneMinusSourceAlpha)
    VERNIER_EQUATION(sourceAlpha, one, sourceAlpha, one)
    VERNIER_EQUATION(sourceAlpha, one, one, one)
    VERNIER_EQUATION(sourceAlpha, one, zero, one)
    VERNIER_EQUATION(one, one, one, one)
    VERNIER_EQUATION(one, one, zero, one)
#undef VERNIER_EQUATION
    return nullptr;
}

/// Of the alpha component, a source colour is the source's alpha. Returns false for a factor that has no routine.
bool factorOf(VkBlendFactor factor, bool ofAlpha, Factor& result) {
    switch (factor) {
        case VK_BLEND_FACTOR_ZERO:
            result = Factor::zero;
            return true;
        case VK_BLEND_FACTOR_ONE:
            result = Factor::one;
            return true;
        case VK_BLEND_FACTOR_SRC_COLOR:
            result = Factor::sourceAlpha;
            return ofAlpha;
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
            result = Factor::oneMinusSourceAlpha;
            return ofAlpha;
        case VK_BLEND_FACTOR_SRC_ALPHA:
            result = Factor::sourceAlpha;
            return true;
        case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
            result = Factor::oneMinusSourceAlpha;
            return true;
        default:
            return false;
    }
}

BlockColorFn select(const ColorPlan& plan) {
    const TexelLayout& layout = plan.ops.layout;
    const ComponentKind kind = layout.rgba[0].kind;
    if (plan.texelBytes != 4 || (kind != ComponentKind::unorm && kind != ComponentKind::srgb)) return nullptr;
    for (const Component& part : layout.rgba)
        if (part.bits != 8 || part.offset % 8 != 0) return nullptr;
    if (layout.rgba[3].offset != 24 || plan.path == ColorPath::logic) return nullptr;
    Equation e{};
    const VkPipelineColorBlendAttachmentState& blend = plan.blend;
    if (plan.path == ColorPath::blend &&
        (blend.colorBlendOp != VK_BLEND_OP_ADD || blend.alphaBlendOp != VK_BLEND_OP_ADD ||
         !factorOf(blend.srcColorBlendFactor, false, e.colorSource) ||
         !factorOf(blend.dstColorBlendFactor, false, e.colorDestination) ||
         !factorOf(blend.srcAlphaBlendFactor, true, e.alphaSource) ||
         !factorOf(blend.dstAlphaBlendFactor, true, e.alphaDestination)))
        return nullptr;
    return kind == ComponentKind::srgb ? kernelFor<true>(plan.path, e) : kernelFor<false>(plan.path, e);
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {
namespace {

auto selector(Isa isa) {
    VERNIER_SELECT_ISA(isa, select)
}

}  // namespace

BlockColorFn blockColorFunction(const ColorPlan& plan, Isa isa) {
    return selector(isa)(plan);
}

}  // namespace vernier
#endif
