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

#include "runtime/texture/block_cache.h"
#include "runtime/texture/lod-inl.h"
#include "runtime/texture/routing.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

constexpr uint32_t kVectorLanes = hn::MaxLanes(F32());

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

/// Texels of four bytes as they lie in memory. kWide: the offsets in the level may exceed int32.
template <bool kWide>
HWY_INLINE VU loadWord(const TextureLevel& level, const TexelPosition& at) {
    if constexpr (kWide) {
        alignas(64) int32_t x[kVectorLanes], y[kVectorLanes], slice[kVectorLanes];
        alignas(64) uint32_t words[kVectorLanes];
        hn::Store(at.x, I32(), x);
        hn::Store(at.y, I32(), y);
        hn::Store(at.slice, I32(), slice);
        for (uint32_t i = 0; i < kVectorLanes; ++i) {
            std::memcpy(&words[i],
                        level.data + static_cast<uint64_t>(slice[i]) * level.slicePitch +
                            static_cast<uint64_t>(y[i]) * level.rowPitch + static_cast<uint64_t>(x[i]) * 4,
                        4);
        }
        return hn::Load(U32(), words);
    } else {
        const VI row = hn::Mul(at.y, splatInt(static_cast<int32_t>(level.rowPitch)));
        const VI slice = hn::Mul(at.slice, splatInt(static_cast<int32_t>(level.slicePitch)));
        const VI offset = hn::Add(hn::Add(row, slice), hn::ShiftLeft<2>(at.x));
        return hn::GatherOffset(U32(), reinterpret_cast<const uint32_t*>(level.data), offset);
    }
}

/// The texels of a 2x2 footprint, tap 2j + i at (x[i], y[j]); the offsets fit int32. Texels that lie side by side in
/// memory are read two at a time: a gather costs by the number of places it reads.
HWY_INLINE void loadWordSquare(const TextureLevel& level, const AxisTaps& x, const AxisTaps& y, VI slice,
                               VU (&words)[4]) {
    if (HWY_UNLIKELY(!hn::AllTrue(I32(), hn::Eq(x.index[1], hn::Add(x.index[0], splatInt(1)))))) {
        unrolled<4>([&](auto t) VERNIER_INLINE_LAMBDA {
            words[t] = loadWord<false>(level, TexelPosition{x.index[t & 1], y.index[t >> 1], slice});
        });
        return;
    }
    const hn::RepartitionToWide<U32> d64;
    const hn::RebindToSigned<decltype(d64)> i64;
    const hn::Half<I32> half;
    const auto* base = reinterpret_cast<const uint64_t*>(level.data);
    const VI first =
        hn::Add(hn::Mul(slice, splatInt(static_cast<int32_t>(level.slicePitch))), hn::ShiftLeft<2>(x.index[0]));
    unrolled<2>([&](auto j) VERNIER_INLINE_LAMBDA {
        const VI offset = hn::Add(hn::Mul(y.index[j], splatInt(static_cast<int32_t>(level.rowPitch))), first);
        const VU low = hn::BitCast(U32(), hn::GatherOffset(d64, base, hn::PromoteTo(i64, hn::LowerHalf(half, offset))));
        const VU high =
            hn::BitCast(U32(), hn::GatherOffset(d64, base, hn::PromoteTo(i64, hn::UpperHalf(half, offset))));
        words[2 * j] = hn::ConcatEven(U32(), high, low);
        words[2 * j + 1] = hn::ConcatOdd(U32(), high, low);
    });
}

/// Four 8-bit components in any order. unorm stays in codes until finish(); sRGB is decoded at once.
template <bool kSrgb, bool kWide>
struct Rgba8Source {
    static constexpr bool kFinite = true;
    static constexpr int kPlanes = 4;
    uint8_t planeOf[4];

    explicit Rgba8Source(const TextureView& view) {
        for (int c = 0; c < 4; ++c) planeOf[c] = view.ops.layout.rgba[c].offset / 8;
    }

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const {
        for (int c = 0; c < 4; ++c) {
            planes[planeOf[c]] = std::bit_cast<uint32_t>(kSrgb ? color.float32[c] : 255.0f * color.float32[c]);
        }
    }

    template <int kTaps>
    HWY_INLINE void load(const TextureView&, const TextureLevel& level, const TexelPosition (&at)[kTaps], uint32_t,
                         Texel (&texels)[kTaps]) const {
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA { unpack(loadWord<kWide>(level, at[t]), texels[t]); });
    }

    static constexpr bool kWords = !kWide;
    /// Of the four texels of loadWordSquare().
    HWY_INLINE void loadSquare(const TextureLevel& level, const AxisTaps& x, const AxisTaps& y, VI slice,
                               Texel (&texels)[4]) const {
        VU words[4];
        loadWordSquare(level, x, y, slice, words);
        unrolled<4>([&](auto t) VERNIER_INLINE_LAMBDA { unpack(words[t], texels[t]); });
    }

    HWY_INLINE VU finish(VU plane) const {
        return kSrgb ? plane : bitsOf(divideExact(floatOf(plane), splatFloat(255.0f), splatFloat(1.0f / 255)));
    }

  private:
    static HWY_INLINE void unpack(VU word, Texel& texel) {
        const VU mask = splatBits(0xff);
        const VU codes[4] = {hn::And(word, mask), hn::And(hn::ShiftRight<8>(word), mask),
                             hn::And(hn::ShiftRight<16>(word), mask), hn::ShiftRight<24>(word)};
        unrolled<3>([&](auto p) VERNIER_INLINE_LAMBDA {
            texel[p] = bitsOf(kSrgb ? decodeSrgbV(codes[p]) : toFloatV(codes[p]));
        });
        texel[3] = bitsOf(kSrgb ? decodeUnormV(codes[3], 8) : toFloatV(codes[3]));
    }
};

/// Gathers address texels by a signed 32-bit offset from the level's first one.
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

enum class Rgba8Kind : uint8_t { none, unorm, srgb };

/// Whether an Rgba8Source reads the view, and which.
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

/// One component in four bytes: a float, or (kFixed24) the low 24 bits of the texel as unorm.
template <bool kFixed24>
struct R32Source {
    static constexpr bool kFinite = false;
    static constexpr int kPlanes = 1;
    static constexpr uint8_t planeOf[4] = {0, kConstantPlane, kConstantPlane, kConstantPlane};

    explicit R32Source(const TextureView&) {}

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const { planes[0] = color.uint32[0]; }

    template <int kTaps>
    HWY_INLINE void load(const TextureView&, const TextureLevel& level, const TexelPosition (&at)[kTaps], uint32_t,
                         Texel (&texels)[kTaps]) const {
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
            const VU word = loadWord<false>(level, at[t]);
            texels[t][0] = kFixed24 ? bitsOf(decodeUnormV(hn::And(word, splatBits(0xffffff)), 24)) : word;
        });
    }

    HWY_INLINE VU finish(VU plane) const { return plane; }
};

/// Any format, through its conversion of rows. kPlaneCount is 1 for formats of one component, else 4.
template <int kPlaneCount>
struct AnySource {
    static constexpr bool kFinite = false;
    static constexpr int kPlanes = kPlaneCount;
    static constexpr uint8_t planeOf[4] = {0, kPlanes > 1 ? 1 : kConstantPlane, kPlanes > 2 ? 2 : kConstantPlane,
                                           kPlanes > 3 ? 3 : kConstantPlane};
    TexelLayout layout;

    explicit AnySource(const TextureView& view) : layout(view.ops.layout) {}

    void borderPlanes(const VkClearColorValue& color, uint32_t (&planes)[4]) const {
        // "Texel Replacement" covers the components that the format has; the others are substituted as ever.
        for (int c = 0; c < 4; ++c) {
            planes[c] = layout.rgba[c].bits != 0 ? color.uint32[c] : constantBits(layout, c == 3);
        }
    }

    /// `needed`: bit c set = component c is wanted.
    template <int kTaps>
    HWY_NOINLINE void load(const TextureView& view, const TextureLevel& level, const TexelPosition (&at)[kTaps],
                           uint32_t needed, Texel (&texels)[kTaps]) const {
        const std::byte* pointers[kTaps * kVectorLanes];
        for (int t = 0; t < kTaps; ++t) {
            alignas(64) int32_t x[kVectorLanes], y[kVectorLanes], slice[kVectorLanes];
            hn::Store(at[t].x, I32(), x);
            hn::Store(at[t].y, I32(), y);
            hn::Store(at[t].slice, I32(), slice);
            for (uint32_t i = 0; i < kVectorLanes; ++i) {
                pointers[static_cast<uint32_t>(t) * kVectorLanes + i] =
                    level.data + static_cast<uint64_t>(slice[i]) * level.slicePitch +
                    static_cast<uint64_t>(y[i]) * level.rowPitch + static_cast<uint64_t>(x[i]) * view.texelPitch;
            }
        }
        alignas(64) uint32_t values[kPlanes][kTaps * kVectorLanes];
        void* planes[4];
        for (int c = 0; c < 4; ++c)
            planes[c] = c < kPlanes && (needed >> c & 1) != 0 ? values[c < kPlanes ? c : 0] : nullptr;
        view.ops.unpackEach(pointers, kTaps * kVectorLanes, planes);
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
            unrolled<kPlanes>([&](auto c) VERNIER_INLINE_LAMBDA {
                texels[t][c] = planes[c] == nullptr ? hn::Zero(U32()) : hn::Load(U32(), values[c] + t * kVectorLanes);
            });
        });
    }

    HWY_INLINE VU finish(VU plane) const { return plane; }
};

/// Compressed formats: texels of decoded blocks, through their conversion of rows.
template <int kPlaneCount>
struct BlockSource : AnySource<kPlaneCount> {
    mutable BlockCache cache;

    explicit BlockSource(const TextureView& view) : AnySource<kPlaneCount>(view), cache(view) {}

    template <int kTaps>
    HWY_NOINLINE void load(const TextureView& view, const TextureLevel& level, const TexelPosition (&at)[kTaps],
                           uint32_t needed, Texel (&texels)[kTaps]) const {
        constexpr uint32_t kCount = kTaps * kVectorLanes;
        alignas(16) std::byte packed[kCount * kMaxDecodedBytes];
        const uint32_t bytes = view.ops.layout.bytes;
        for (uint32_t t = 0; t < kTaps; ++t) {
            alignas(64) int32_t x[kVectorLanes], y[kVectorLanes], slice[kVectorLanes];
            hn::Store(at[t].x, I32(), x);
            hn::Store(at[t].y, I32(), y);
            hn::Store(at[t].slice, I32(), slice);
            for (uint32_t i = 0; i < kVectorLanes; ++i) {
                cache.read(view, level, level.data + static_cast<uint64_t>(slice[i]) * level.slicePitch,
                           static_cast<uint32_t>(x[i]), static_cast<uint32_t>(y[i]),
                           packed + (t * kVectorLanes + i) * bytes);
            }
        }
        alignas(64) uint32_t values[kPlaneCount][kCount];
        void* planes[4] = {};
        for (int c = 0; c < kPlaneCount; ++c) {
            if ((needed >> c & 1) != 0) planes[c] = values[c];
        }
        view.ops.unpack(packed, kCount, planes);
        unrolled<kTaps>([&](auto t) VERNIER_INLINE_LAMBDA {
            unrolled<kPlaneCount>([&](auto c) VERNIER_INLINE_LAMBDA {
                texels[t][c] = planes[c] == nullptr ? hn::Zero(U32()) : hn::Load(U32(), values[c] + t * kVectorLanes);
            });
        });
    }
};

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
