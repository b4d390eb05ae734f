// ETC2 and EAC ("ETC2 Compressed Texture Image Formats"). Bits are numbered as in the specification, 63 first in
// memory; texels a to p go down the columns.
#include <array>
#include <cstring>

#include "runtime/format/block.h"
#include "runtime/format/block_bits.h"

namespace vernier {
namespace {

struct Rgb {
    int32_t r, g, b;
};

constexpr int32_t kModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
constexpr int32_t kDistances[8] = {3, 6, 11, 16, 23, 32, 41, 64};
constexpr int8_t kAlphaModifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8},
};

void put(uint8_t* texel, const Rgb& color, int32_t added) {
    texel[0] = clampToByte(color.r + added);
    texel[1] = clampToByte(color.g + added);
    texel[2] = clampToByte(color.b + added);
    texel[3] = 255;
}

Rgb widen(uint32_t r, uint32_t g, uint32_t b, uint32_t bits) {
    return {static_cast<int32_t>(widenToByte(r, bits)), static_cast<int32_t>(widenToByte(g, bits)),
            static_cast<int32_t>(widenToByte(b, bits))};
}

/// The index of the texel in column x and row y.
uint32_t pixelIndex(uint64_t bits, uint32_t x, uint32_t y) {
    const uint32_t pixel = 4 * x + y;
    return bitField(bits, 16 + pixel, 1) << 1 | bitField(bits, pixel, 1);
}

/// A block, and whether index 2 means a transparent texel (punch-through blocks that are not opaque).
struct ColorBlock {
    uint64_t bits;
    bool transparent;
    uint8_t* texels;

    template <class Paint>
    void forEachTexel(Paint paint) const {
        for (uint32_t y = 0; y < 4; ++y) {
            for (uint32_t x = 0; x < 4; ++x) {
                uint8_t* const texel = texels + 4 * (4 * y + x);
                const uint32_t index = pixelIndex(bits, x, y);
                if (transparent && index == 2) {
                    std::memset(texel, 0, 4);
                } else {
                    paint(texel, index, x, y);
                }
            }
        }
    }

    /// The individual and differential modes.
    void decodeSubblocks(const Rgb (&base)[2]) const {
        const uint32_t tables[2] = {bitField(bits, 37, 3), bitField(bits, 34, 3)};
        const bool flip = bitField(bits, 32, 1) != 0;
        forEachTexel([&](uint8_t* texel, uint32_t index, uint32_t x, uint32_t y) {
            const uint32_t half = (flip ? y : x) / 2;
            const bool large = (index & 1) != 0;
            const int32_t modifier = transparent && !large ? 0 : kModifiers[tables[half]][large ? 1 : 0];
            put(texel, base[half], (index & 2) != 0 ? -modifier : modifier);
        });
    }

    void paint(const Rgb (&colors)[4], const int32_t (&added)[4]) const {
        forEachTexel(
            [&](uint8_t* texel, uint32_t index, uint32_t, uint32_t) { put(texel, colors[index], added[index]); });
    }

    void decodeT() const {
        const Rgb first =
            widen(bitField(bits, 59, 2) << 2 | bitField(bits, 56, 2), bitField(bits, 52, 4), bitField(bits, 48, 4), 4);
        const Rgb second = widen(bitField(bits, 44, 4), bitField(bits, 40, 4), bitField(bits, 36, 4), 4);
        const int32_t d = kDistances[bitField(bits, 34, 2) << 1 | bitField(bits, 32, 1)];
        paint({first, second, second, second}, {0, d, 0, -d});
    }

    void decodeH() const {
        const uint32_t r1 = bitField(bits, 59, 4), g1 = bitField(bits, 56, 3) << 1 | bitField(bits, 52, 1),
                       b1 = bitField(bits, 51, 1) << 3 | bitField(bits, 47, 3);
        const uint32_t r2 = bitField(bits, 43, 4), g2 = bitField(bits, 39, 4), b2 = bitField(bits, 35, 4);
        const uint32_t order = (r1 << 8 | g1 << 4 | b1) >= (r2 << 8 | g2 << 4 | b2) ? 1 : 0;
        const int32_t d = kDistances[bitField(bits, 34, 1) << 2 | bitField(bits, 32, 1) << 1 | order];
        const Rgb first = widen(r1, g1, b1, 4), second = widen(r2, g2, b2, 4);
        paint({first, first, second, second}, {d, -d, d, -d});
    }

    void decodePlanar() const {
        const auto color = [](uint32_t r, uint32_t g, uint32_t b) {
            return Rgb{static_cast<int32_t>(widenToByte(r, 6)), static_cast<int32_t>(widenToByte(g, 7)),
                       static_cast<int32_t>(widenToByte(b, 6))};
        };
        const Rgb o = color(bitField(bits, 57, 6), bitField(bits, 56, 1) << 6 | bitField(bits, 49, 6),
                            bitField(bits, 48, 1) << 5 | bitField(bits, 43, 2) << 3 | bitField(bits, 39, 3));
        const Rgb h =
            color(bitField(bits, 34, 5) << 1 | bitField(bits, 32, 1), bitField(bits, 25, 7), bitField(bits, 19, 6));
        const Rgb v = color(bitField(bits, 13, 6), bitField(bits, 6, 7), bitField(bits, 0, 6));
        for (int32_t y = 0; y < 4; ++y) {
            for (int32_t x = 0; x < 4; ++x) {
                const auto at = [&](int32_t co, int32_t ch, int32_t cv) {
                    return (x * (ch - co) + y * (cv - co) + 4 * co + 2) >> 2;
                };
                put(texels + 4 * (4 * y + x), {at(o.r, h.r, v.r), at(o.g, h.g, v.g), at(o.b, h.b, v.b)}, 0);
            }
        }
    }
};

template <bool kPunchThrough>
void decodeColors(const std::byte* block, uint8_t* texels) {
    const uint64_t bits = loadBigEndian(block);
    const bool flag = bitField(bits, 33, 1) != 0;  // differential, or opaque
    const ColorBlock color{bits, kPunchThrough && !flag, texels};
    if (!kPunchThrough && !flag) {
        return color.decodeSubblocks({widen(bitField(bits, 60, 4), bitField(bits, 52, 4), bitField(bits, 44, 4), 4),
                                      widen(bitField(bits, 56, 4), bitField(bits, 48, 4), bitField(bits, 40, 4), 4)});
    }
    uint32_t base[3], second[3];
    for (uint32_t c = 0; c < 3; ++c) {
        base[c] = bitField(bits, 59 - 8 * c, 5);
        second[c] = base[c] + static_cast<uint32_t>(signExtended(bitField(bits, 56 - 8 * c, 3), 3));
    }
    if (second[0] > 31) return color.decodeT();
    if (second[1] > 31) return color.decodeH();
    if (second[2] > 31) return color.decodePlanar();
    color.decodeSubblocks({widen(base[0], base[1], base[2], 5), widen(second[0], second[1], second[2], 5)});
}

/// Calls store(texel, modifier, base, multiplier) for the 16 texels of an EAC block.
template <class Store>
void forEachEacTexel(const std::byte* block, Store store) {
    const uint64_t bits = loadBigEndian(block);
    const auto multiplier = static_cast<int32_t>(bitField(bits, 52, 4));
    const auto& modifiers = kAlphaModifiers[bitField(bits, 48, 4)];
    for (uint32_t y = 0; y < 4; ++y) {
        for (uint32_t x = 0; x < 4; ++x) {
            store(4 * y + x, modifiers[bitField(bits, 45 - 3 * (4 * x + y), 3)], bitField(bits, 56, 8), multiplier);
        }
    }
}

template <bool kSigned>
void decodeEac11(const std::byte* block, float* texels, size_t stride) {
    forEachEacTexel(block, [&](size_t texel, int32_t modifier, uint32_t base, int32_t multiplier) {
        const int32_t added = multiplier == 0 ? modifier : modifier * multiplier * 8;
        constexpr int32_t kMax = kSigned ? 1023 : 2047;
        const int32_t start = kSigned ? std::max(signExtended(base, 8), -127) * 8 : static_cast<int32_t>(base) * 8 + 4;
        texels[texel * stride] = static_cast<float>(std::clamp(start + added, kSigned ? -kMax : 0, kMax)) / kMax;
    });
}

}  // namespace

void decodeEtc2Rgb(const std::byte* block, void* texels) {
    decodeColors<false>(block, static_cast<uint8_t*>(texels));
}
void decodeEtc2RgbA1(const std::byte* block, void* texels) {
    decodeColors<true>(block, static_cast<uint8_t*>(texels));
}
void decodeEtc2Rgba(const std::byte* block, void* texels) {
    auto* const out = static_cast<uint8_t*>(texels);
    decodeColors<false>(block + 8, out);
    forEachEacTexel(block, [&](size_t texel, int32_t modifier, uint32_t base, int32_t multiplier) {
        out[4 * texel + 3] = clampToByte(static_cast<int32_t>(base) + modifier * multiplier);
    });
}
void decodeEacR11Unorm(const std::byte* block, void* texels) {
    decodeEac11<false>(block, static_cast<float*>(texels), 1);
}
void decodeEacR11Snorm(const std::byte* block, void* texels) {
    decodeEac11<true>(block, static_cast<float*>(texels), 1);
}
void decodeEacRg11Unorm(const std::byte* block, void* texels) {
    decodeEac11<false>(block, static_cast<float*>(texels), 2);
    decodeEac11<false>(block + 8, static_cast<float*>(texels) + 1, 2);
}
void decodeEacRg11Snorm(const std::byte* block, void* texels) {
    decodeEac11<true>(block, static_cast<float*>(texels), 2);
    decodeEac11<true>(block + 8, static_cast<float*>(texels) + 1, 2);
}

}  // namespace vernier
