// Texels of four bytes, read in one or two pieces per row: where the fast routines take them from. The taps and the
// weights are those of address-inl.h, found with fewer steps because both axes have one known address mode, the same,
// and there is no texel offset. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_WORD_TAPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_WORD_TAPS_INL_H
#undef VERNIER_TEXTURE_WORD_TAPS_INL_H
#else
#define VERNIER_TEXTURE_WORD_TAPS_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/texture/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// The one level that all samples come from, whatever their level of detail; nothing if there are several.
inline std::optional<uint32_t> onlyLevel(const TextureView& view, const SamplerState& sampler) {
    if (view.levelCount == 1) return 0;
    // chooseLevels() at both ends of the sampler's range; in between it is monotonic.
    const auto last = static_cast<float>(view.levelCount - 1);
    const bool linear = sampler.mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR;
    const float first = linear ? view.minLod : std::floor(view.minLod);
    const auto at = [&](float lambda) { return std::min(std::max(lambda, first), last); };
    float low = at(std::min(sampler.minLod, sampler.maxLod)), high = at(sampler.maxLod);
    if (!linear) {
        low = std::ceil(low + 0.5f) - 1.0f;
        high = std::ceil(high + 0.5f) - 1.0f;
    }
    if (low != high || low != std::floor(low)) return std::nullopt;
    return static_cast<uint32_t>(low);
}

/// The address mode of both axes.
enum class WordWrap { repeat, clampToEdge, clampToBorder };

/// A level with what all its vectors need of it.
struct WordLevel {
    const std::byte* data;
    int32_t columns, rows;
    VF width, height;
    VI rowPitch;
    VI sliceOffset;  // bytes from `data` to the layer of each lane

    HWY_INLINE WordLevel(const TextureLevel& level, VI slice)
        : data(level.data),
          columns(static_cast<int32_t>(level.width)),
          rows(static_cast<int32_t>(level.height)),
          width(splatFloat(static_cast<float>(level.width))),
          height(splatFloat(static_cast<float>(level.height))),
          rowPitch(splatInt(static_cast<int32_t>(level.rowPitch))),
          sliceOffset(hn::Mul(slice, splatInt(static_cast<int32_t>(level.slicePitch)))) {}

    HWY_INLINE VI rowOffset(VI y) const { return hn::Add(hn::Mul(y, rowPitch), sliceOffset); }
    HWY_INLINE VU word(VI x, VI row) const {
        return hn::GatherOffset(U32(), reinterpret_cast<const uint32_t*>(data), hn::Add(row, hn::ShiftLeft<2>(x)));
    }
    /// The words at x and x + 1. A gather costs by the number of places it reads.
    HWY_INLINE void wordPair(VI x, VI row, VU& left, VU& right) const {
        const hn::RepartitionToWide<U32> d64;
        const hn::RebindToSigned<decltype(d64)> i64;
        const hn::Half<I32> half;
        const auto* base = reinterpret_cast<const uint64_t*>(data);
        const VI offset = hn::Add(row, hn::ShiftLeft<2>(x));
        const VU low = hn::BitCast(U32(), hn::GatherOffset(d64, base, hn::PromoteTo(i64, hn::LowerHalf(half, offset))));
        const VU high =
            hn::BitCast(U32(), hn::GatherOffset(d64, base, hn::PromoteTo(i64, hn::UpperHalf(half, offset))));
        left = hn::ConcatEven(U32(), high, low);
        right = hn::ConcatOdd(U32(), high, low);
    }
};

/// Coordinates in texels for `repeat`: from 0 to less than the size.
HWY_INLINE VF repeated(VF s, VF size) {
    const VF fraction = hn::Sub(s, hn::Floor(s));
    return hn::Mul(clampOrLowV(fraction, hn::Zero(F32()), splatFloat(kBelowOne)), size);
}

/// One axis of the texel at a point.
template <WordWrap kWrap>
HWY_INLINE VI nearestIndex(VF s, VF size, int32_t count, VI& inside) {
    const VF zero = hn::Zero(F32());
    if constexpr (kWrap == WordWrap::repeat) return truncateInRange(repeated(s, size));
    if constexpr (kWrap == WordWrap::clampToEdge) {
        return truncateInRange(clampOrLowV(hn::Mul(s, size), zero, splatFloat(static_cast<float>(count - 1))));
    }
    const VI i = truncateInRange(hn::Floor(clampOrLowV(hn::Mul(s, size), splatFloat(-1.0f), size)));
    const VI index = clampIndex(i, count);
    inside = hn::VecFromMask(I32(), hn::Eq(index, i));
    return index;
}

/// One axis of the two texels around a point.
struct WordAxis {
    VI index[2];
    VF weight;     // of index[1]
    VI inside[2];  // clampToBorder only
};

template <WordWrap kWrap>
HWY_INLINE WordAxis linearIndices(VF s, VF size, int32_t count) {
    WordAxis axis;
    const VI last = splatInt(count - 1), one = splatInt(1);
    VF u;
    if constexpr (kWrap == WordWrap::repeat) u = repeated(s, size);
    // Beyond the edge both texels are the same one, whatever the weight.
    if constexpr (kWrap == WordWrap::clampToEdge) u = clampOrLowV(hn::Mul(s, size), hn::Zero(F32()), size);
    if constexpr (kWrap == WordWrap::clampToBorder) {
        u = clampOrLowV(hn::Mul(s, size), splatFloat(-1.0f), hn::Add(size, splatFloat(1.0f)));
    }
    u = hn::Sub(u, splatFloat(0.5f));
    const VF whole = hn::Floor(u);
    axis.weight = hn::Sub(u, whole);
    const VI i = truncateInRange(whole), next = hn::Add(i, one);
    if constexpr (kWrap == WordWrap::repeat) {
        // -1 is the last texel: as an unsigned number it is beyond it.
        axis.index[0] = hn::BitCast(I32(), hn::Min(hn::BitCast(U32(), i), hn::BitCast(U32(), last)));
        axis.index[1] = hn::IfThenZeroElse(hn::Eq(i, last), next);
    } else {
        axis.index[0] = clampIndex(i, count);
        axis.index[1] = clampIndex(next, count);
        if constexpr (kWrap == WordWrap::clampToBorder) {
            axis.inside[0] = hn::VecFromMask(I32(), hn::Eq(axis.index[0], i));
            axis.inside[1] = hn::VecFromMask(I32(), hn::Eq(axis.index[1], next));
        }
    }
    return axis;
}

/// The texels of a point as they lie in memory; of the linear filter tap 2j + i is (i, j), and wx and wy are the
/// weights of i = 1 and j = 1.
template <bool kLinear>
struct WordTaps {
    VU words[kLinear ? 4 : 1];
    VF wx, wy;
};

template <WordWrap kWrap>
HWY_INLINE void readTaps(const WordLevel& level, VF s, VF t, VU border, WordTaps<false>& taps) {
    VI insideX = hn::Zero(I32()), insideY = hn::Zero(I32());
    const VI x = nearestIndex<kWrap>(s, level.width, level.columns, insideX);
    const VI y = nearestIndex<kWrap>(t, level.height, level.rows, insideY);
    const VU word = level.word(x, level.rowOffset(y));
    if constexpr (kWrap == WordWrap::clampToBorder) {
        const auto inside = hn::MaskFromVec(hn::BitCast(U32(), hn::And(insideX, insideY)));
        taps.words[0] = hn::IfThenElse(inside, word, border);
    } else {
        taps.words[0] = word;
    }
}

template <WordWrap kWrap>
HWY_INLINE void readTaps(const WordLevel& level, VF s, VF t, VU border, WordTaps<true>& taps) {
    const WordAxis x = linearIndices<kWrap>(s, level.width, level.columns);
    const WordAxis y = linearIndices<kWrap>(t, level.height, level.rows);
    taps.wx = x.weight;
    taps.wy = y.weight;
    const VI rows[2] = {level.rowOffset(y.index[0]), level.rowOffset(y.index[1])};
    if constexpr (kWrap == WordWrap::repeat) {
        if (HWY_LIKELY(hn::AllTrue(I32(), hn::Gt(x.index[1], x.index[0])))) {
            unrolled<2>([&](auto j) VERNIER_INLINE_LAMBDA {
                level.wordPair(x.index[0], rows[j], taps.words[2 * j], taps.words[2 * j + 1]);
            });
        } else {  // across the seam, or a single column
            unrolled<4>([&](auto k)
                            VERNIER_INLINE_LAMBDA { taps.words[k] = level.word(x.index[k & 1], rows[k >> 1]); });
        }
    } else if (HWY_UNLIKELY(level.columns == 1)) {
        unrolled<2>([&](auto j) VERNIER_INLINE_LAMBDA {
            taps.words[2 * j] = taps.words[2 * j + 1] = level.word(x.index[0], rows[j]);
        });
    } else {
        // Two columns of which one or both are wanted.
        const VI first = hn::Min(x.index[0], splatInt(level.columns - 2));
        const auto takeRight = hn::RebindMask(U32(), hn::Gt(x.index[0], first));
        const auto takeLeft = hn::RebindMask(U32(), hn::Eq(x.index[1], first));
        unrolled<2>([&](auto j) VERNIER_INLINE_LAMBDA {
            VU left, right;
            level.wordPair(first, rows[j], left, right);
            taps.words[2 * j] = hn::IfThenElse(takeRight, right, left);
            taps.words[2 * j + 1] = hn::IfThenElse(takeLeft, left, right);
        });
    }
    if constexpr (kWrap == WordWrap::clampToBorder) {
        unrolled<4>([&](auto k) VERNIER_INLINE_LAMBDA {
            const VI inside = hn::And(x.inside[k & 1], y.inside[k >> 1]);
            taps.words[k] = hn::IfThenElse(hn::MaskFromVec(hn::BitCast(U32(), inside)), taps.words[k], border);
        });
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
