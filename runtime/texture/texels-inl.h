// Reading the texels of a footprint into vectors: one source per kind of format, fast for four bytes per
// texel, general for all others. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_TEXELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_TEXELS_INL_H
#undef VERNIER_TEXTURE_TEXELS_INL_H
#else
#define VERNIER_TEXTURE_TEXELS_INL_H
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "runtime/texture/block_cache.h"
#include "runtime/texture/footprint-inl.h"
#include "runtime/texture/routing.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// Where one texel of the footprint is, in all lanes; indices are in range. slice: array layer, cube face or
/// z.
struct TexelPosition {
    VI x, y, slice;
};

/// Four planes of one texel per lane: floats, or the bits of integers. Which component a plane holds is the
/// source's affair.
using Texel = VU[4];

// A source has
//   kFinite               its planes hold finite floats, so that a plain interpolation is safe
//   kPlanes               the number of planes it fills
//   planeOf[4]            the plane of each component, kConstantPlane if the format has none
//   borderPlanes()        the border colour as the planes of a texel
//   load<kTaps>()         the texels of kTaps positions
//   finish()              from a filtered plane to the value of its component

constexpr uint8_t kConstantPlane = 4;

/// Whether the texels of all levels can be addressed by a signed 32-bit offset from the level's first one, as gathers
/// do.
inline bool offsetsFitInt32(const TextureView& view) {
    for (uint32_t i = 0; i < view.levelCount; ++i) {
        const TextureLevel& level = view.levels[i];
        const uint64_t slices = view.type == VK_IMAGE_VIEW_TYPE_3D ? level.depth : view.layerCount;
        const uint64_t end = (slices - 1) * level.slicePitch + uint64_t{level.height} * level.rowPitch;
        constexpr uint64_t kLimit = std::numeric_limits<int32_t>::max();
        if (end > kLimit || (slices > 1 && level.slicePitch > kLimit) || level.rowPitch > kLimit) return false;
    }
    return true;
}

/// Calls step(lane, address of the texel's slice, x, y).
template <class Step>
HWY_INLINE void forEachLane(const TextureLevel& level, const TexelPosition& at, Step step) {
    alignas(64) int32_t x[kVectorLanes], y[kVectorLanes], slice[kVectorLanes];
    hn::Store(at.x, I32(), x);
    hn::Store(at.y, I32(), y);
    hn::Store(at.slice, I32(), slice);
    for (uint32_t i = 0; i < kVectorLanes; ++i) {
        step(i, level.data + static_cast<uint64_t>(slice[i]) * level.slicePitch, static_cast<uint32_t>(x[i]),
             static_cast<uint32_t>(y[i]));
    }
}

HWY_NOINLINE static VU loadDistantWord(const TextureLevel& level, const TexelPosition& at) {
    alignas(64) uint32_t words[kVectorLanes];
    forEachLane(level, at, [&](uint32_t lane, const std::byte* slice, uint32_t x, uint32_t y) {
        std::memcpy(&words[lane], slice + uint64_t{y} * level.rowPitch + uint64_t{x} * 4, 4);
    });
    return hn::Load(U32(), words);
}

/// Texels of four bytes as they lie in memory. `distant`: the offsets in a level may exceed int32.
HWY_INLINE VU loadWord(const TextureLevel& level, const TexelPosition& at, bool distant) {
    if (HWY_UNLIKELY(distant)) return loadDistantWord(level, at);
    const VI row = hn::Mul(at.y, splatInt(static_cast<int32_t>(level.rowPitch)));
    const VI slice = hn::Mul(at.slice, splatInt(static_cast<int32_t>(level.slicePitch)));
    const VI offset = hn::Add(hn::Add(row, slice), hn::ShiftLeft<2>(at.x));
    return hn::GatherOffset(U32(), reinterpret_cast<const uint32_t*>(level.data), offset);
}

enum class Rgba8Kind : uint8_t { none, unorm, srgb };

/// Whether an Rgba8Source reads the view, and which codes it has.
inline Rgba8Kind rgba8Kind(const TextureView& view, const SamplerState& sampler) {
    const TexelLayout& layout = view.ops.layout;
    if (layout.bytes != 4 || view.texelPitch != 4 || view.block != nullptr || sampler.compareEnable) {
        return Rgba8Kind::none;
    }
    for (const Component& part : layout.rgba) {
        if (part.bits != 8 || part.offset % 8 != 0) return Rgba8Kind::none;
    }
    const ComponentKind kind = layout.rgba[0].kind;
    return kind == ComponentKind::unorm  ? Rgba8Kind::unorm
           : kind == ComponentKind::srgb ? Rgba8Kind::srgb
                                         : Rgba8Kind::none;
}

/// Codes of 8 bits, filtered as such, to values: codes / 255, correctly rounded. The reciprocal in two parts is exact
/// to 2^-48 or so, and the rounding of the lesser product does not matter more: a quotient by 255 comes no closer than
/// 2^-33 of itself to the middle of two floats (25 bits for the middle, 8 for the divisor).
HWY_INLINE VF finishUnorm8(VF codes) {
#if HWY_TARGET == HWY_SSE4
    return hn::Div(codes, splatFloat(255.0f));
#else
    constexpr float kHigh = 1.0f / 255;
    constexpr auto kLow = static_cast<float>(1.0 / 255 - static_cast<double>(kHigh));
    return hn::MulAdd(codes, splatFloat(kHigh), hn::Mul(codes, splatFloat(kLow)));
#endif
}

/// Four 8-bit components in any order. unorm stays in codes until finish(); sRGB is decoded at once.
struct Rgba8Source {
    static constexpr bool kFinite = true;
    static constexpr int kPlanes = 4;
    uint8_t planeOf[4];

    explicit Rgba8Source(const TextureView& view)
        : srgb_(view.ops.layout.rgba[0].kind == ComponentKind::srgb), distant_(!offsetsFitInt32(view)) {
        for (int c = 0; c < 4; ++c) planeOf[c] = view.ops.layout.rgba[c].offset / 8;
    }

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const {
        for (int c = 0; c < 4; ++c) {
            planes[planeOf[c]] = std::bit_cast<uint32_t>(srgb_ ? color.float32[c] : 255.0f * color.float32[c]);
        }
    }

    template <int kTaps>
    HWY_INLINE void load(const TextureView&, const TextureLevel& level, const TexelPosition (&at)[kTaps], uint32_t,
                         Texel (&texels)[kTaps]) const {
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA { unpack(loadWord(level, at[t], distant_), texels[t]); });
        if (!srgb_) return;
        for (Texel& texel : texels) decodeSrgb(texel);
    }

    HWY_INLINE VU finish(VU plane) const { return srgb_ ? plane : bitsOf(finishUnorm8(floatOf(plane))); }

  private:
    static HWY_INLINE void unpack(VU word, Texel& texel) {
        const VU mask = splatBits(0xff);
        const VU codes[4] = {hn::And(word, mask), hn::And(hn::ShiftRight<8>(word), mask),
                             hn::And(hn::ShiftRight<16>(word), mask), hn::ShiftRight<24>(word)};
        unrolled<4>([&](auto p) VERNIER_INLINE_LAMBDA { texel[p] = bitsOf(toFloatV(codes[p])); });
    }
    static HWY_NOINLINE void decodeSrgb(Texel& texel) {
        for (int p = 0; p < 3; ++p)
            texel[p] = bitsOf(decodeSrgbV(hn::BitCast(U32(), hn::ConvertTo(I32(), floatOf(texel[p])))));
        texel[3] = bitsOf(finishUnorm8(floatOf(texel[3])));
    }

    bool srgb_, distant_;
};

/// Whether an R32Source reads the view: one component in four bytes, a float or the low 24 bits as unorm.
inline bool isOneWord(const TextureView& view) {
    const TexelLayout& layout = view.ops.layout;
    const Component& first = layout.rgba[0];
    return view.block == nullptr && layout.bytes == 4 && view.texelPitch == 4 && layout.rgba[1].bits == 0 &&
           first.offset == 0 && (first.bits == 32 || first.bits == 24);
}

struct R32Source {
    static constexpr bool kFinite = false;
    static constexpr int kPlanes = 1;
    static constexpr uint8_t planeOf[4] = {0, kConstantPlane, kConstantPlane, kConstantPlane};

    explicit R32Source(const TextureView& view)
        : fixed24_(view.ops.layout.rgba[0].bits == 24), distant_(!offsetsFitInt32(view)) {}

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const { planes[0] = color.uint32[0]; }

    template <int kTaps>
    HWY_INLINE void load(const TextureView&, const TextureLevel& level, const TexelPosition (&at)[kTaps], uint32_t,
                         Texel (&texels)[kTaps]) const {
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
            const VU word = loadWord(level, at[t], distant_);
            texels[t][0] = fixed24_ ? bitsOf(decodeUnormV(hn::And(word, splatBits(0xffffff)), 24)) : word;
        });
    }

    HWY_INLINE VU finish(VU plane) const { return plane; }

  private:
    bool fixed24_, distant_;
};

/// Any format, through its conversion of rows; compressed ones by the texels of decoded blocks. kPlaneCount is 1 for
/// formats of one component, else 4.
template <int kPlaneCount>
struct AnySource {
    static constexpr bool kFinite = false;
    static constexpr int kPlanes = kPlaneCount;
    static constexpr uint8_t planeOf[4] = {0, kPlanes > 1 ? 1 : kConstantPlane, kPlanes > 2 ? 2 : kConstantPlane,
                                           kPlanes > 3 ? 3 : kConstantPlane};

    explicit AnySource(const TextureView& view) : layout_(view.ops.layout), distant_(!offsetsFitInt32(view)) {
        if (view.block != nullptr) cache_.emplace(view);
    }

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const {
        // "Texel Replacement" covers the components that the format has; the others are substituted as ever.
        for (int c = 0; c < 4; ++c) {
            planes[c] = layout_.rgba[c].bits != 0 ? color.uint32[c] : constantBits(layout_, c == 3);
        }
    }

    /// `needed`: bit c set = component c is wanted.
    template <int kTaps>
    HWY_NOINLINE void load(const TextureView& view, const TextureLevel& level, const TexelPosition (&at)[kTaps],
                           uint32_t needed, Texel (&texels)[kTaps]) const {
        constexpr uint32_t kCount = kTaps * kVectorLanes;
        alignas(64) uint32_t values[kPlanes][kCount];
        void* planes[4] = {};
        for (int c = 0; c < kPlanes; ++c) {
            if ((needed >> c & 1) != 0) planes[c] = values[c];
        }
        if (cache_) {
            unpackBlocks(view, level, at, kTaps, planes);
        } else {
            const std::byte* pointers[kCount];
            for (uint32_t t = 0; t < kTaps; ++t) locate(view, level, at[t], pointers + t * kVectorLanes);
            view.ops.unpackEach(pointers, kCount, planes);
        }
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
            unrolled<kPlanes>([&](auto c) VERNIER_INLINE_LAMBDA {
                texels[t][c] = planes[c] == nullptr ? hn::Zero(U32()) : hn::Load(U32(), values[c] + t * kVectorLanes);
            });
        });
    }

    HWY_INLINE VU finish(VU plane) const { return plane; }

  private:
    HWY_INLINE void locate(const TextureView& view, const TextureLevel& level, const TexelPosition& at,
                           const std::byte** texels) const {
        if (HWY_UNLIKELY(distant_)) {
            forEachLane(level, at, [&](uint32_t lane, const std::byte* slice, uint32_t x, uint32_t y) {
                texels[lane] = slice + uint64_t{y} * level.rowPitch + uint64_t{x} * view.texelPitch;
            });
            return;
        }
        const VI row = hn::Mul(at.y, splatInt(static_cast<int32_t>(level.rowPitch)));
        const VI slice = hn::Mul(at.slice, splatInt(static_cast<int32_t>(level.slicePitch)));
        const VI column = hn::Mul(at.x, splatInt(static_cast<int32_t>(view.texelPitch)));
        alignas(64) int32_t offsets[kVectorLanes];
        hn::Store(hn::Add(hn::Add(row, slice), column), I32(), offsets);
        for (uint32_t lane = 0; lane < kVectorLanes; ++lane) texels[lane] = level.data + offsets[lane];
    }

    /// At most four taps.
    HWY_NOINLINE void unpackBlocks(const TextureView& view, const TextureLevel& level, const TexelPosition* at,
                                   uint32_t taps, void* const (&planes)[4]) const {
        alignas(16) std::byte packed[4 * kVectorLanes * kMaxDecodedBytes];
        const uint32_t bytes = view.ops.layout.bytes;
        for (uint32_t t = 0; t < taps; ++t) {
            forEachLane(level, at[t], [&](uint32_t lane, const std::byte* slice, uint32_t x, uint32_t y) {
                cache_->read(view, level, slice, x, y, packed + (t * kVectorLanes + lane) * bytes);
            });
        }
        view.ops.unpack(packed, taps * kVectorLanes, planes);
    }

    const TexelLayout& layout_;
    bool distant_;  // offsets in a level may exceed int32
    mutable std::optional<BlockCache> cache_;
};

/// 1 where the comparison of the reference with the texel passes, else 0.
HWY_INLINE VU compareTexel(VkCompareOp op, VF dref, VF texel) {
    hn::Mask<F32> pass;
    switch (op) {
        case VK_COMPARE_OP_LESS:
            pass = hn::Lt(dref, texel);
            break;
        case VK_COMPARE_OP_EQUAL:
            pass = hn::Eq(dref, texel);
            break;
        case VK_COMPARE_OP_LESS_OR_EQUAL:
            pass = hn::Le(dref, texel);
            break;
        case VK_COMPARE_OP_GREATER:
            pass = hn::Gt(dref, texel);
            break;
        case VK_COMPARE_OP_NOT_EQUAL:
            pass = hn::Not(hn::Eq(dref, texel));  // hn::Ne() is false for NaN on some targets
            break;
        case VK_COMPARE_OP_GREATER_OR_EQUAL:
            pass = hn::Ge(dref, texel);
            break;
        case VK_COMPARE_OP_ALWAYS:
            return bitsOf(splatFloat(1.0f));
        default:
            return hn::Zero(U32());
    }
    return bitsOf(hn::IfThenElseZero(pass, splatFloat(1.0f)));
}

/// a where t = 0, towards b: a + t (b - a), the same bits as a where a = b.
HWY_INLINE VF lerpFinite(VF a, VF b, VF t) {
    return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

/// The same for any floats: a texel of weight 0 has no say even if it is infinite or NaN, equal infinities
/// stay, and a difference that overflows is avoided.
HWY_INLINE VF lerpAny(VF a, VF b, VF t) {
    const F32 df;
    const VF difference = hn::Sub(b, a);
    const auto overflows = hn::Not(hn::Le(hn::Abs(difference), splatFloat(0x1.fffffep127f)));
    VF result = hn::Add(a, hn::Mul(t, difference));
    if (!hn::AllFalse(df, overflows)) {
        const VF weighted = hn::Add(hn::Mul(a, hn::Sub(splatFloat(1.0f), t)), hn::Mul(b, t));
        result = hn::IfThenElse(overflows, weighted, result);
    }
    return hn::IfThenElse(hn::Or(hn::Eq(t, hn::Zero(df)), hn::Eq(a, b)), a, result);
}

template <class Source>
HWY_INLINE VU lerpPlane(VU a, VU b, VF t) {
    return bitsOf(Source::kFinite ? lerpFinite(floatOf(a), floatOf(b), t) : lerpAny(floatOf(a), floatOf(b), t));
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
