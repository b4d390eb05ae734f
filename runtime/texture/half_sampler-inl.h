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
        const VF width = splatFloat(static_cast<float>(level_.width));
        const VF height = splatFloat(static_cast<float>(level_.height));
        call_.forEachVector([&](uint32_t first, uint32_t count) HWY_ATTR {
            const VF t = call_.isOneDimensional() ? splatFloat(0.5f) : call_.coordinate(1, first, count);
            const WordAxis x =
                linearIndices<kWrap>(call_.coordinate(0, first, count), width, static_cast<int32_t>(level_.width));
            const WordAxis y = linearIndices<kWrap>(t, height, static_cast<int32_t>(level_.height));
            Footprint4 texels;
            for (int tap = 0; tap < 4; ++tap) locate(x.index[tap & 1], y.index[tap >> 1], texels, tap);
            alignas(64) float filtered[4 * kVectorLanes];
            if (HWY_UNLIKELY(!filter<true>(texels, x.weight, y.weight, filtered)))
                filter<false>(texels, x.weight, y.weight, filtered);
            VF planes[4];
            hn::LoadInterleaved4(F32(), filtered, planes[0], planes[1], planes[2], planes[3]);
            for (uint32_t c = 0; c < 4; ++c) {
                const Route route = routeOf(call_.view.swizzle, c);
                if (call_.request.out[c] != nullptr && route <= Route::a)
                    storeLanes(bitsOf(planes[static_cast<uint32_t>(route)]), call_.request.out[c], first, count);
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
    static constexpr int32_t kTexelBytes = 8;

    /// Where the texels of each tap are, a quarter of the lanes after the other; in the image, or copied side by side.
    struct Footprint4 {
        const std::byte* texels[4][4];
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
            table.lane[1][n] = static_cast<int32_t>(n % kRun) * kTexelBytes;
        }
        return table;
    }

    HWY_INLINE void locate(VI column, VI row, Footprint4& footprint, int tap) const {
        static constexpr LaneTable kLanes = runLanes();
        const VI offset =
            hn::Add(hn::Mul(row, splatInt(static_cast<int32_t>(level_.rowPitch))), hn::ShiftLeft<3>(column));
        const VI origin = hn::Sub(offset, hn::Load(I32(), kLanes.lane[1]));
        const VI first = hn::TableLookupLanes(origin, hn::SetTableIndices(I32(), kLanes.lane[0]));
        alignas(64) int32_t offsets[kVectorLanes];
        hn::Store(offset, I32(), offsets);
        if (hn::AllTrue(I32(), hn::Eq(origin, first))) {
            for (uint32_t quarter = 0; quarter < 4; ++quarter)
                footprint.texels[tap][quarter] = level_.data + offsets[quarter * kTexels];
            return;
        }
        for (uint32_t lane = 0; lane < kVectorLanes; ++lane)
            std::memcpy(footprint.copies[tap] + lane * kTexelBytes, level_.data + offsets[lane], kTexelBytes);
        for (uint32_t quarter = 0; quarter < 4; ++quarter)
            footprint.texels[tap][quarter] = footprint.copies[tap] + quarter * kTexels * kTexelBytes;
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
    HWY_FLATTEN static bool filter(const Footprint4& footprint, VF wx, VF wy, float* filtered) {
        static constexpr LaneTable kLanes = quarterLanes();
        const Halves d;
        hn::Vec<Halves> greatest = hn::Zero(d);
        for (uint32_t quarter = 0; quarter < 4; ++quarter) {
            VU taps[4];
            unrolled<4>([&](auto tap) VERNIER_INLINE_LAMBDA {
                const auto halves = hn::LoadU(d, reinterpret_cast<const uint16_t*>(footprint.texels[tap][quarter]));
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

    const SampleCall& call_;
    const TextureLevel& level_;
};

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#endif  // include guard
