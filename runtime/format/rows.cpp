// Rows of texels to planes of values and back, for every layout of the table.
#include "runtime/format/format.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/format/rows.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstring>

#include "runtime/format/convert-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier {
namespace HWY_NAMESPACE {

/// How texels of kBytes lie in memory while they are converted: words 32-bit words each, 3- and 6-byte texels
/// widened.
template <int kBytes>
struct Memory {
    static constexpr int kPaddedBytes = kBytes == 3 ? 4 : kBytes == 6 ? 8 : kBytes;
    static constexpr int kWords = kPaddedBytes <= 4 ? 1 : kPaddedBytes / 4;
};

constexpr size_t kLanes = hn::MaxLanes(U32());

template <int kBytes>
HWY_INLINE void loadWords(const uint8_t* texels, VU (&words)[4]) {
    const U32 d;
    if constexpr (kBytes == 3 || kBytes == 6) {
        constexpr int kPadded = Memory<kBytes>::kPaddedBytes;
        alignas(64) uint8_t padded[kLanes * kPadded] = {};
        for (size_t i = 0; i < kLanes; ++i) std::memcpy(padded + i * kPadded, texels + i * kBytes, kBytes);
        loadWords<kPadded>(padded, words);
    } else if constexpr (kBytes == 1) {
        words[0] = hn::PromoteTo(d, hn::LoadU(hn::Rebind<uint8_t, U32>(), texels));
    } else if constexpr (kBytes == 2) {
        const hn::Rebind<uint16_t, U32> d16;
        words[0] = hn::PromoteTo(d, hn::BitCast(d16, hn::LoadU(hn::Repartition<uint8_t, decltype(d16)>(), texels)));
    } else {
        const auto* const source = reinterpret_cast<const uint32_t*>(texels);
        if constexpr (kBytes == 4) words[0] = hn::LoadU(d, source);
        if constexpr (kBytes == 8) hn::LoadInterleaved2(d, source, words[0], words[1]);
        if constexpr (kBytes == 12) hn::LoadInterleaved3(d, source, words[0], words[1], words[2]);
        if constexpr (kBytes == 16) hn::LoadInterleaved4(d, source, words[0], words[1], words[2], words[3]);
    }
}

template <int kBytes>
HWY_INLINE void storeWords(const VU (&words)[4], uint8_t* texels) {
    const U32 d;
    if constexpr (kBytes == 3 || kBytes == 6) {
        constexpr int kPadded = Memory<kBytes>::kPaddedBytes;
        alignas(64) uint8_t padded[kLanes * kPadded];
        storeWords<kPadded>(words, padded);
        for (size_t i = 0; i < kLanes; ++i) std::memcpy(texels + i * kBytes, padded + i * kPadded, kBytes);
    } else if constexpr (kBytes == 1) {
        const hn::Rebind<uint8_t, U32> d8;
        hn::StoreU(hn::DemoteTo(d8, hn::BitCast(I32(), words[0])), d8, texels);
    } else if constexpr (kBytes == 2) {
        const hn::Rebind<uint16_t, U32> d16;
        const hn::Repartition<uint8_t, decltype(d16)> d8;
        hn::StoreU(hn::BitCast(d8, hn::DemoteTo(d16, hn::BitCast(I32(), words[0]))), d8, texels);
    } else {
        auto* const target = reinterpret_cast<uint32_t*>(texels);
        if constexpr (kBytes == 4) hn::StoreU(words[0], d, target);
        if constexpr (kBytes == 8) hn::StoreInterleaved2(words[0], words[1], d, target);
        if constexpr (kBytes == 12) hn::StoreInterleaved3(words[0], words[1], words[2], d, target);
        if constexpr (kBytes == 16) hn::StoreInterleaved4(words[0], words[1], words[2], words[3], d, target);
    }
}

/// sRGB formats keep A linear.
template <ComponentKind kKind, int kComponent>
inline constexpr ComponentKind kKindOf = kKind == ComponentKind::srgb&& kComponent == 3 ? ComponentKind::unorm : kKind;

/// One vector of texels. `offset` counts values in the planes.
template <ComponentKind kKind, int kBytes, bool kShared>
HWY_INLINE void unpackVector(const TexelLayout& layout, const uint8_t* texels, void* const planes[4], size_t offset) {
    VU words[4];
    loadWords<kBytes>(texels, words);
    const auto component = [&]<int kC>(std::integral_constant<int, kC>) {
        if (planes[kC] == nullptr) return;
        const Component& part = layout.rgba[kC];
        VU value = hn::Zero(U32());
        if (part.bits != 0) {
            const VU code =
                hn::And(hn::ShiftRightSame(words[part.offset / 32 % Memory<kBytes>::kWords], part.offset % 32),
                        splatBits(lowBits(part.bits)));
            if constexpr (kShared) {
                // fraction * 2^(exponent - 24), both factors exact.
                const VU exponent = hn::Add(hn::ShiftRight<27>(words[0]), splatBits(127 - 24));
                value = bitsOf(hn::Mul(toFloatV(code), floatOf(hn::ShiftLeft<23>(exponent))));
            } else {
                value = decodeV<kKindOf<kKind, kC>>(code, part.bits);
            }
        } else if constexpr (kC == 3) {
            value = splatBits(layout.type == ValueType::floating ? std::bit_cast<uint32_t>(1.0f) : 1u);
        }
        hn::StoreU(value, U32(), static_cast<uint32_t*>(planes[kC]) + offset);
    };
    component(std::integral_constant<int, 0>());
    component(std::integral_constant<int, 1>());
    component(std::integral_constant<int, 2>());
    component(std::integral_constant<int, 3>());
}

template <ComponentKind kKind, int kBytes, bool kShared>
void unpackRow(const TexelLayout& layout, const void* texels, size_t n, void* const planes[4]) {
    alignas(64) uint8_t rest[kLanes * kBytes];
    alignas(64) uint32_t values[4][kLanes];
    void* const valuePlanes[4] = {values[0], values[1], values[2], values[3]};
    for (size_t i = 0; i < n; i += kLanes) {
        const uint8_t* source = static_cast<const uint8_t*>(texels) + i * kBytes;
        const size_t count = n - i;
        const bool whole = count >= kLanes;
        if (!whole) {
            std::memset(rest, 0, sizeof rest);
            std::memcpy(rest, source, count * kBytes);
            source = rest;
        }
        unpackVector<kKind, kBytes, kShared>(layout, source, whole ? planes : valuePlanes, whole ? i : 0);
        if (whole) continue;
        for (int c = 0; c < 4; ++c) {
            if (planes[c] == nullptr) continue;
            std::memcpy(static_cast<uint8_t*>(planes[c]) + i * sizeof(uint32_t), values[c], count * sizeof(uint32_t));
        }
    }
}

template <ComponentKind kKind, int kBytes>
HWY_INLINE void packVector(const TexelLayout& layout, const void* const planes[4], size_t offset, uint8_t* texels) {
    VU words[4] = {hn::Zero(U32()), hn::Zero(U32()), hn::Zero(U32()), hn::Zero(U32())};
    if (layout.keepOtherBits) {
        loadWords<kBytes>(texels, words);
        const Component& part = layout.rgba[0];
        VU& word = words[part.offset / 32 % Memory<kBytes>::kWords];
        word = hn::AndNot(splatBits(lowBits(part.bits) << part.offset % 32), word);
    }
    const auto component = [&]<int kC>(std::integral_constant<int, kC>) {
        const Component& part = layout.rgba[kC];
        if (part.bits == 0) return;
        const VU value = hn::LoadU(U32(), static_cast<const uint32_t*>(planes[kC]) + offset);
        const VU code = hn::And(encodeV<kKindOf<kKind, kC>>(value, part.bits), splatBits(lowBits(part.bits)));
        VU& word = words[part.offset / 32 % Memory<kBytes>::kWords];
        word = hn::Or(word, hn::ShiftLeftSame(code, part.offset % 32));
    };
    component(std::integral_constant<int, 0>());
    component(std::integral_constant<int, 1>());
    component(std::integral_constant<int, 2>());
    component(std::integral_constant<int, 3>());
    storeWords<kBytes>(words, texels);
}

template <ComponentKind kKind, int kBytes>
void packRow(const TexelLayout& layout, const void* const planes[4], size_t n, void* texels) {
    alignas(64) uint8_t rest[kLanes * kBytes];
    alignas(64) uint32_t values[4][kLanes];
    const void* const valuePlanes[4] = {values[0], values[1], values[2], values[3]};
    for (size_t i = 0; i < n; i += kLanes) {
        uint8_t* const target = static_cast<uint8_t*>(texels) + i * kBytes;
        const size_t count = n - i;
        const bool whole = count >= kLanes;
        if (!whole) {
            std::memset(values, 0, sizeof values);
            for (int c = 0; c < 4; ++c) {
                if (layout.rgba[c].bits == 0) continue;
                std::memcpy(values[c], static_cast<const uint8_t*>(planes[c]) + i * sizeof(uint32_t),
                            count * sizeof(uint32_t));
            }
            std::memset(rest, 0, sizeof rest);
            if (layout.keepOtherBits) std::memcpy(rest, target, count * kBytes);
        }
        packVector<kKind, kBytes>(layout, whole ? planes : valuePlanes, whole ? i : 0, whole ? target : rest);
        if (!whole) std::memcpy(target, rest, count * kBytes);
    }
}

/// For layouts that no attachment has: written by clears and copies only, so without SIMD.
void packRareRow(const TexelLayout& layout, const void* const planes[4], size_t n, void* texels) {
    for (size_t i = 0; i < n; ++i) {
        VkClearColorValue value{};
        for (int c = 0; c < 4; ++c) {
            if (layout.rgba[c].bits == 0) continue;
            std::memcpy(&value.uint32[c], static_cast<const uint8_t*>(planes[c]) + i * sizeof(uint32_t),
                        sizeof(uint32_t));
        }
        packTexel(layout, value, static_cast<uint8_t*>(texels) + i * layout.bytes);
    }
}

/// kBytes: the sizes of texels there are; in packing, those of attachments and storage images.
template <ComponentKind kKind, int... kBytes>
void chooseUnpack(FormatOps& ops) {
    const auto tryBytes = [&]<int kB>(std::integral_constant<int, kB>) {
        if (ops.layout.bytes == kB) ops.unpackFn = unpackRow<kKind, kB, false>;
    };
    (tryBytes(std::integral_constant<int, kBytes>()), ...);
}
template <ComponentKind kKind, int... kBytes>
void choosePack(FormatOps& ops) {
    const auto tryBytes = [&]<int kB>(std::integral_constant<int, kB>) {
        if (ops.layout.bytes == kB) ops.packFn = packRow<kKind, kB>;
    };
    (tryBytes(std::integral_constant<int, kBytes>()), ...);
}

void selectRows(FormatOps& ops) {
    ops.packFn = packRareRow;
    switch (ops.layout.rgba[0].kind) {
        case ComponentKind::unorm:
            chooseUnpack<ComponentKind::unorm, 1, 2, 3, 4, 6, 8>(ops);
            choosePack<ComponentKind::unorm, 1, 2, 4, 8>(ops);
            break;
        case ComponentKind::snorm:
            chooseUnpack<ComponentKind::snorm, 1, 2, 3, 4, 6, 8>(ops);
            choosePack<ComponentKind::snorm, 1, 2, 4, 8>(ops);
            break;
        case ComponentKind::uscaled:
            chooseUnpack<ComponentKind::uscaled, 1, 2, 3, 4, 6, 8>(ops);
            break;
        case ComponentKind::sscaled:
            chooseUnpack<ComponentKind::sscaled, 1, 2, 3, 4, 6, 8>(ops);
            break;
        case ComponentKind::uint:
            chooseUnpack<ComponentKind::uint, 1, 2, 3, 4, 6, 8, 12, 16>(ops);
            choosePack<ComponentKind::uint, 1, 2, 4, 8, 16>(ops);
            break;
        case ComponentKind::sint:
            chooseUnpack<ComponentKind::sint, 1, 2, 3, 4, 6, 8, 12, 16>(ops);
            choosePack<ComponentKind::sint, 1, 2, 4, 8, 16>(ops);
            break;
        case ComponentKind::sfloat:
            chooseUnpack<ComponentKind::sfloat, 2, 4, 6, 8, 12, 16>(ops);
            choosePack<ComponentKind::sfloat, 2, 4, 8, 16>(ops);
            break;
        case ComponentKind::srgb:
            chooseUnpack<ComponentKind::srgb, 1, 2, 3, 4>(ops);
            choosePack<ComponentKind::srgb, 1, 2, 4>(ops);
            break;
        case ComponentKind::ufloat:
            if (ops.layout.sharedExponent) {
                ops.unpackFn = unpackRow<ComponentKind::uint, 4, true>;
            } else {
                chooseUnpack<ComponentKind::ufloat, 4>(ops);
                choosePack<ComponentKind::ufloat, 4>(ops);
            }
            break;
        case ComponentKind::none:
            break;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vernier
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier {
namespace {

auto rowSelector(Isa isa) {
    VERNIER_SELECT_ISA(isa, selectRows)
}

}  // namespace

FormatOps formatOps(VkFormat format, VkImageAspectFlags aspect, Isa isa) {
    FormatOps ops;
    ops.layout = findFormat(format)->layout(aspect);
    rowSelector(isa)(ops);
    return ops;
}

FormatOps formatOps(VkFormat format, Isa isa) {
    return formatOps(format, defaultAspect(*findFormat(format)), isa);
}

}  // namespace vernier
#endif
