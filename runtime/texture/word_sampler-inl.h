// The fast routines: flat images of four-byte texels, one known address mode, one filter for magnification and
// minification. A vector of lanes goes from coordinates to outputs in registers. Included once per target (see
// base/simd.h).
#if defined(VERNIER_TEXTURE_WORD_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_WORD_SAMPLER_INL_H
#undef VERNIER_TEXTURE_WORD_SAMPLER_INL_H
#else
#define VERNIER_TEXTURE_WORD_SAMPLER_INL_H
#endif

#include <algorithm>
#include <bit>
#include <optional>

#include "runtime/texture/word_taps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

// What a word holds. Each has
//   kOutputs       outputs there are
//   kLevels        also sampled with mipmaps
//   kBorder        sampled with borders: shadow maps; others are repeated
//   kLooksUp       value() costs a look-up per lane: equal texels are worth being found out
//   constant(c)    the bits of output c if no texel has a say in it
//   beginVector()  before value() is called for a vector of lanes
//   value()        output c of a texel, as it is filtered
//   finish()       from a filtered value to what the program receives

/// Outputs as bytes of a word of four components.
class ByteRoutes {
  public:
    HWY_NOINLINE explicit ByteRoutes(const SampleCall& call) {
        const VI block = hn::ShiftLeft<2>(hn::And(hn::Iota(I32(), 0), splatInt(3)));
        for (uint32_t c = 0; c < 4; ++c) {
            const Route route = routeOf(call.view.swizzle, c);
            const bool isByte = route <= Route::a;
            const uint32_t byte = isByte ? call.view.ops.layout.rgba[static_cast<uint32_t>(route)].offset / 8 : 0u;
            // Indices of bytes for a table look-up; those with bit 7 set give 0.
            const VU bytes = hn::Or(hn::BitCast(U32(), block), splatBits(0x80808000u | byte));
            hn::Store(bytes, U32(), shuffle_[c]);
            isConstant_[c] = !isByte;
            constant_[c] = constantBits(call.view.ops.layout, route == Route::one);
            isAlpha_[c] = route == Route::a;
        }
    }
    /// The bits of output c if no texel has a say in it.
    std::optional<uint32_t> constant(uint32_t c) const {
        return isConstant_[c] ? std::optional(constant_[c]) : std::nullopt;
    }
    HWY_INLINE VU code(VU word, uint32_t c) const {
        const hn::Repartition<uint8_t, U32> bytes;
        return hn::BitCast(
            U32(), hn::TableLookupBytesOr0(hn::BitCast(bytes, word), hn::BitCast(bytes, hn::Load(U32(), shuffle_[c]))));
    }
    HWY_INLINE bool isAlpha(uint32_t c) const { return isAlpha_[c]; }

  private:
    alignas(64) uint32_t shuffle_[4][kVectorLanes];
    uint32_t constant_[4];
    bool isConstant_[4], isAlpha_[4];
};

struct Unorm8Words {
    static constexpr int kOutputs = 4;
    static constexpr bool kLevels = true, kBorder = false, kLooksUp = false;
    ByteRoutes routes;

    explicit Unorm8Words(const SampleCall& call) : routes(call) {}
    std::optional<uint32_t> constant(uint32_t c) const { return routes.constant(c); }
    HWY_INLINE void beginVector(uint32_t, uint32_t) {}
    HWY_INLINE VF value(VU word, uint32_t c) const { return toFloatV(routes.code(word, c)); }
    HWY_INLINE VF finish(VF codes) const { return finishUnorm8(codes); }
};

struct Srgb8Words {
    static constexpr int kOutputs = 4;
    static constexpr bool kLevels = true, kBorder = false, kLooksUp = true;
    ByteRoutes routes;

    explicit Srgb8Words(const SampleCall& call) : routes(call) {}
    std::optional<uint32_t> constant(uint32_t c) const { return routes.constant(c); }
    HWY_INLINE void beginVector(uint32_t, uint32_t) {}
    HWY_INLINE VF value(VU word, uint32_t c) const {
        const VU code = routes.code(word, c);
        return routes.isAlpha(c) ? finishUnorm8(toFloatV(code)) : decodeSrgbV(code);
    }
    HWY_INLINE VF finish(VF value) const { return value; }
};

/// Depth in 32-bit floats, compared: 1 where the comparison passes. Output 0 alone.
struct DepthWords {
    static constexpr int kOutputs = 1;
    static constexpr bool kLevels = false, kBorder = true, kLooksUp = false;
    const SampleCall& call;
    VF dref;

    explicit DepthWords(const SampleCall& samples) : call(samples) {}
    std::optional<uint32_t> constant(uint32_t) const { return std::nullopt; }
    HWY_INLINE void beginVector(uint32_t first, uint32_t count) { dref = loadLanes(call.request.dref, first, count); }
    HWY_INLINE VF value(VU word, uint32_t) const {
        return floatOf(compareTexel(call.sampler.compareOp, dref, floatOf(word)));
    }
    HWY_INLINE VF finish(VF value) const { return value; }
};

/// kLevels: each lane chooses its level or its two levels; otherwise all take the only one.
template <class Words, WordWrap kWrap, bool kLinear, bool kLevels>
class WordSampler {
  public:
    explicit WordSampler(const SampleCall& call)
        : call_(call), words_(call), border_(splatBits(call.sampler.borderColor.uint32[0])) {
        for (uint32_t c = 0; c < Words::kOutputs; ++c) out_[c] = words_.constant(c) ? nullptr : call.request.out[c];
    }

    HWY_INLINE void sample() {
        sampleTexels();
        // Last, for outputs may take the place of coordinates.
        for (uint32_t c = 0; c < Words::kOutputs; ++c) {
            const std::optional<uint32_t> constant = words_.constant(c);
            if (!constant || call_.request.out[c] == nullptr) continue;
            std::fill_n(call_.request.out[c], call_.request.lanes, std::bit_cast<float>(*constant));
        }
    }

  private:
    using Taps = WordTaps<kLinear>;
    static constexpr size_t kTaps = kLinear ? 4 : 1;
    struct Point {
        VF s, t;
        VI slice;
    };

    HWY_INLINE void sampleTexels() {
        const TextureView& view = call_.view;
        if constexpr (kLevels) {
            alignas(64) float lambdas[kLambdaLanes];
            lambdaPrimes<Shape::flat>(call_, lambdas);
            call_.forEachVector([&](uint32_t first, uint32_t count) VERNIER_INLINE_LAMBDA {
                const Point at = point(first, count);
                const LevelChoice choice =
                    chooseLevels(view, call_.sampler, lowestLod(call_.sampler, call_.request, first, count),
                                 hn::Load(F32(), lambdas + first));
                Taps high;
                readLevels(choice.high, at, high);
                const bool highEven = isEven(high);
                if (hn::AllTrue(F32(), hn::Eq(choice.weight, hn::Zero(F32())))) {
                    write(first, count, [&](uint32_t c) VERNIER_INLINE_LAMBDA { return filtered(high, highEven, c); });
                    return;
                }
                Taps low;
                readLevels(choice.low, at, low);
                const bool lowEven = isEven(low);
                write(first, count, [&](uint32_t c) VERNIER_INLINE_LAMBDA {
                    return lerpFinite(filtered(high, highEven, c), filtered(low, lowEven, c), choice.weight);
                });
            });
        } else {
            const TextureLevel& level = view.levels[onlyLevel(view, call_.sampler).value_or(0)];
            const WordLevel whole(level, hn::Zero(I32()));
            const auto read = [&](uint32_t first, Taps& taps) VERNIER_INLINE_LAMBDA {
                const Point at = point(first, call_.request.lanes - first);
                if (HWY_LIKELY(view.layerCount == 1)) {
                    readTaps<kWrap>(whole, at.s, at.t, border_, taps);
                } else {
                    readLevel(level, at, taps);
                }
            };
            // The texels of the next vector are on their way while this one is filtered.
            uint32_t first = call_.activeVector(0);
            if (first >= call_.request.lanes) return;
            Taps next;
            read(first, next);
            while (first < call_.request.lanes) {
                const Taps taps = next;
                const uint32_t after = call_.activeVector(first + kVectorLanes);
                if (after < call_.request.lanes) read(after, next);
                const bool even = isEven(taps);
                write(first, call_.request.lanes - first,
                      [&](uint32_t c) VERNIER_INLINE_LAMBDA { return filtered(taps, even, c); });
                first = after;
            }
        }
    }

    HWY_INLINE Point point(uint32_t first, uint32_t count) const {
        // A 1D image is one row, met in the middle.
        const VF t = call_.isOneDimensional() ? splatFloat(0.5f) : call_.coordinate(1, first, count);
        return {call_.coordinate(0, first, count), t, call_.layer(call_.view.layerCount, first, count)};
    }

    HWY_NOINLINE void readLevel(const TextureLevel& level, const Point& at, Taps& taps) const {
        readTaps<kWrap>(WordLevel(level, at.slice), at.s, at.t, border_, taps);
    }

    /// Each lane from its own level: one pass per level that occurs, nearly always one or two.
    HWY_INLINE void readLevels(VI levels, const Point& at, Taps& taps) const {
        const auto only = static_cast<uint32_t>(hn::GetLane(levels));
        readTaps<kWrap>(WordLevel(call_.view.levels[only], at.slice), at.s, at.t, border_, taps);
        auto left = hn::Ne(levels, splatInt(static_cast<int32_t>(only)));
        while (HWY_UNLIKELY(!hn::AllFalse(I32(), left))) {
            alignas(64) int32_t index[kVectorLanes];
            hn::Store(levels, I32(), index);
            const int32_t next = index[hn::FindFirstTrue(I32(), left)];
            const auto here = hn::Eq(levels, splatInt(next));
            Taps other;
            readLevel(call_.view.levels[static_cast<uint32_t>(next)], at, other);
            const auto wordsHere = hn::RebindMask(U32(), here);
            unrolled<kLinear ? 4 : 1>([&](auto k) VERNIER_INLINE_LAMBDA {
                taps.words[k] = hn::IfThenElse(wordsHere, other.words[k], taps.words[k]);
            });
            if constexpr (kLinear) {
                const auto floatsHere = hn::RebindMask(F32(), here);
                taps.wx = hn::IfThenElse(floatsHere, other.wx, taps.wx);
                taps.wy = hn::IfThenElse(floatsHere, other.wy, taps.wy);
            }
            left = hn::AndNot(here, left);
        }
    }

    /// Whether each lane has four equal texels: what they are filtered to.
    static HWY_INLINE bool isEven(const Taps& taps) {
        if constexpr (!kLinear || !Words::kLooksUp) return false;
        return hn::AllTrue(U32(), hn::And(hn::And(hn::Eq(taps.words[0], taps.words[1 % kTaps]),
                                                  hn::Eq(taps.words[2 % kTaps], taps.words[3 % kTaps])),
                                          hn::Eq(taps.words[0], taps.words[2 % kTaps])));
    }

    HWY_INLINE VF filtered(const Taps& taps, bool even, uint32_t c) const {
        if constexpr (kLinear) {
            if constexpr (Words::kLooksUp) {
                if (even) return words_.value(taps.words[0], c);
            }
            const VF top = lerpFinite(words_.value(taps.words[0], c), words_.value(taps.words[1], c), taps.wx);
            const VF bottom = lerpFinite(words_.value(taps.words[2], c), words_.value(taps.words[3], c), taps.wx);
            return lerpFinite(top, bottom, taps.wy);
        } else {
            return words_.value(taps.words[0], c);
        }
    }

    template <class Value>
    HWY_INLINE void write(uint32_t first, uint32_t count, Value value) {
        words_.beginVector(first, count);
        unrolled<Words::kOutputs>([&](auto c) VERNIER_INLINE_LAMBDA {
            if (out_[c] != nullptr) storeLanes(bitsOf(words_.finish(value(c))), out_[c], first, count);
        });
    }

    const SampleCall& call_;
    Words words_;
    float* out_[Words::kOutputs] = {};  // null: not wanted, or constant
    const VU border_;                   // of one component
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
