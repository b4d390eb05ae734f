// The fast routine for texels of four halves, as targets of high dynamic range have them: flat images of one level and
// layer, linear filters, one known address mode. Filters texels as they lie in memory, the four components of as many
// lanes as a vector has room for, and takes them apart at the end. Included once per target (see base/simd.h).
#if defined(VERNIER_TEXTURE_HALF_SAMPLER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_TEXTURE_HALF_SAMPLER_INL_H
#undef VERNIER_TEXTURE_HALF_SAMPLER_INL_H
#else
#define VERNIER_TEXTURE_HALF_SAMPLER_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/texture/word_taps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// Whether the target converts halves by an instruction; without one the general routine is as good.
constexpr bool kConvertsHalves = HWY_TARGET != HWY_SSE4;

/// Whether a HalfSampler reads the texels of the view.
inline bool isFourHalves(const TextureView& view) {
    const TexelLayout& layout = view.ops.layout;
    if (view.texelPitch != 8 || layout.bytes != 8 || view.block != nullptr) return false;
    for (uint32_t c = 0; c < 4; ++c) {
        const Component& part = layout.rgba[c];
        if (part.kind != ComponentKind::sfloat || part.bits != 16 || part.offset != 16 * c) return false;
    }
    return true;
}

/// `view` and `sampler` have passed isFourHalves(), and the tests of selectHalves() in sample.cpp.
template <WordWrap kWrap>
class HalfSampler {
  public:
    explicit HalfSampler(const SampleCall& call)
        : call_(call), level_(call.view.levels[onlyLevel(call.view, call.sampler).value_or(0)]) {}

    void sample() const {
        // Copies, which stores to the outputs cannot change.
        const TextureLevel level = level_;
        const VF width = splatFloat(static_cast<float>(level.width));
        const VF height = splatFloat(static_cast<float>(level.height));
        struct {
            float* target;
            uint32_t component;
        } outputs[4];
        uint32_t outputCount = 0;
        for (uint32_t c = 0; c < 4; ++c) {
            const Route route = routeOf(call_.view.swizzle, c);
            if (call_.request.out[c] != nullptr && route <= Route::a)
                outputs[outputCount++] = {call_.request.out[c], static_cast<uint32_t>(route)};
        }
        call_.forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
            const VF s = call_.coordinate(0, first, count);
            const VF t = call_.isOneDimensional() ? splatFloat(0.5f) : call_.coordinate(1, first, count);
            const WordAxis x = linearIndices<kWrap>(s, width, static_cast<int32_t>(level.width));
            const WordAxis y = linearIndices<kWrap>(t, height, static_cast<int32_t>(level.height));
            Places places;
            locate(level, x, y, places);
            alignas(64) float filtered[4 * kVectorLanes];
            if (HWY_UNLIKELY(!filter<true>(places, x.weight, y.weight, filtered)))
                filterAny(places, x.weight, y.weight, filtered);
            alignas(64) float planes[4][kVectorLanes];
            VF r, g, b, a;
            hn::LoadInterleaved4(F32(), filtered, r, g, b, a);
            hn::Store(r, F32(), planes[0]);
            hn::Store(g, F32(), planes[1]);
            hn::Store(b, F32(), planes[2]);
            hn::Store(a, F32(), planes[3]);
            for (uint32_t k = 0; k < outputCount; ++k) {
                const VF plane = hn::Load(F32(), planes[outputs[k].component]);
                storeLanes(bitsOf(plane), outputs[k].target, first, count);
            }
        });
        // Last, for outputs may take the place of coordinates.
        for (uint32_t c = 0; c < 4; ++c) {
            const Route route = routeOf(call_.view.swizzle, c);
            if (call_.request.out[c] == nullptr || route <= Route::a) continue;
            const uint32_t constant = constantBits(call_.view.ops.layout, route == Route::one);
            std::fill_n(call_.request.out[c], call_.request.lanes, std::bit_cast<float>(constant));
        }
    }

  private:
    /// A vector of halves is as many texels as a quarter of the lanes.
    using Halves = hn::Rebind<uint16_t, F32>;
    static constexpr uint32_t kTexels = kVectorLanes / 4;
    /// Lanes that lie side by side on the screen, when blocks of pixels are shaded row by row.
    static constexpr uint32_t kRun = kVectorLanes < 8 ? kVectorLanes : 8;
    static constexpr uint32_t kTexelBytes = 8;

    /// Where the texels are, a quarter of the lanes after the other: those of tap 0, and how far behind them those of
    /// each tap; in the image, or copied side by side.
    struct Places {
        const std::byte* texels[4];
        size_t taps[4];
        alignas(64) std::byte copies[4][kVectorLanes * kTexelBytes];
    };

    struct LaneTable {
        alignas(64) int32_t lane[4][kVectorLanes];
    };
    /// The lane of which each component of a quarter is.
    static constexpr LaneTable quarterLanes() {
        LaneTable table{};
        for (uint32_t quarter = 0; quarter < 4; ++quarter)
            for (uint32_t n = 0; n < kVectorLanes; ++n)
                table.lane[quarter][n] = static_cast<int32_t>(quarter * kTexels + n / 4);
        return table;
    }
    /// The first lane of the run of each lane, and bytes from its texel if all lie in a row.
    static constexpr LaneTable runLanes() {
        LaneTable table{};
        for (uint32_t n = 0; n < kVectorLanes; ++n) {
            table.lane[0][n] = static_cast<int32_t>(n / kRun * kRun);
            table.lane[1][n] = static_cast<int32_t>(n % kRun * kTexelBytes);
        }
        return table;
    }

    static HWY_INLINE void locate(const TextureLevel& level, const WordAxis& x, const WordAxis& y, Places& places) {
        static constexpr LaneTable kLanes = runLanes();
        const VI pitch = splatInt(static_cast<int32_t>(level.rowPitch)), one = splatInt(1);
        const VI rows[2] = {hn::Mul(y.index[0], pitch), hn::Mul(y.index[1], pitch)};
        const VI offset = hn::Add(rows[0], hn::ShiftLeft<3>(x.index[0]));
        const VI origin = hn::Sub(offset, hn::Load(I32(), kLanes.lane[1]));
        const VI first = hn::TableLookupLanes(origin, hn::SetTableIndices(I32(), kLanes.lane[0]));
        const auto inRows = hn::And(hn::Eq(origin, first), hn::And(hn::Eq(hn::Sub(x.index[1], x.index[0]), one),
                                                                   hn::Eq(hn::Sub(y.index[1], y.index[0]), one)));
        alignas(64) int32_t offsets[kVectorLanes];
        if (hn::AllTrue(I32(), inRows)) {
            hn::Store(offset, I32(), offsets);
            for (uint32_t quarter = 0; quarter < 4; ++quarter)
                places.texels[quarter] = level.data + offsets[quarter * kTexels];
            for (size_t tap = 0; tap < 4; ++tap)
                places.taps[tap] = (tap & 1) * kTexelBytes + (tap >> 1) * level.rowPitch;
            return;
        }
        for (size_t tap = 0; tap < 4; ++tap) {
            hn::Store(hn::Add(rows[tap >> 1], hn::ShiftLeft<3>(x.index[tap & 1])), I32(), offsets);
            for (uint32_t lane = 0; lane < kVectorLanes; ++lane)
                std::memcpy(places.copies[tap] + lane * kTexelBytes, level.data + offsets[lane], kTexelBytes);
            places.taps[tap] = tap * sizeof places.copies[0];
        }
        for (uint32_t quarter = 0; quarter < 4; ++quarter)
            places.texels[quarter] = places.copies[0] + quarter * kTexels * kTexelBytes;
    }

    template <bool kPlain>
    static HWY_INLINE VF decode(hn::Vec<Halves> halves) {
        if constexpr (kPlain) {
#if HWY_TARGET == HWY_AVX3
            return VF{_mm512_cvtph_ps(halves.raw)};
#elif HWY_TARGET == HWY_AVX2
            return VF{_mm256_cvtph_ps(halves.raw)};
#elif HWY_TARGET == HWY_NEON
            return VF{vcvt_f32_f16(vreinterpret_f16_u16(halves.raw))};
#endif
        }
        return decodeHalfV(hn::PromoteTo(U32(), halves));
    }

    /// kPlain: by the short interpolation, and false if some texel is not zero or a positive number, so that the
    /// result may not be that of the long one.
    template <bool kPlain>
    static HWY_INLINE bool filter(const Places& places, VF wx, VF wy, float* filtered) {
        static constexpr LaneTable kLanes = quarterLanes();
        const Halves d;
        hn::Vec<Halves> greatest = hn::Zero(d);
        for (uint32_t quarter = 0; quarter < 4; ++quarter) {
            VU taps[4];
            unrolled<4>([&](auto tap) VERNIER_INLINE_LAMBDA {
                const auto halves =
                    hn::LoadU(d, reinterpret_cast<const uint16_t*>(places.texels[quarter] + places.taps[tap]));
                if constexpr (kPlain) greatest = hn::Max(greatest, halves);
                taps[tap] = bitsOf(decode<kPlain>(halves));
            });
            const auto lanes = hn::SetTableIndices(F32(), kLanes.lane[quarter]);
            const VF x = hn::TableLookupLanes(wx, lanes), y = hn::TableLookupLanes(wy, lanes);
            const auto mix = [](VU a, VU b, VF weight) VERNIER_INLINE_LAMBDA {
                return bitsOf(kPlain ? lerpFinite(floatOf(a), floatOf(b), weight)
                                     : lerpAny(floatOf(a), floatOf(b), weight));
            };
            const VU value = mix(mix(taps[0], taps[1], x), mix(taps[2], taps[3], x), y);
            hn::Store(floatOf(value), F32(), filtered + quarter * kVectorLanes);
        }
        constexpr uint16_t kGreatestNumber = 0x7bff;
        return !kPlain ||
               hn::AllTrue(d, hn::Eq(hn::Max(greatest, hn::Set(d, kGreatestNumber)), hn::Set(d, kGreatestNumber)));
    }

    static HWY_NOINLINE void filterAny(const Places& places, VF wx, VF wy, float* filtered) {
        filter<false>(places, wx, wy, filtered);
    }

    const SampleCall& call_;
    const TextureLevel& level_;
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
