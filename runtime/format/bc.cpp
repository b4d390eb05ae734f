// BC1 to BC5: colours and single components between two end points ("S3TC" and "RGTC Compressed Texture Image
// Formats"). The specification's formulas are over real numbers; each value here is the float nearest to its formula.
#include <array>
#include <cstring>

#include "runtime/format/block.h"
#include "runtime/format/block_bits.h"
#include "runtime/format/srgb.h"

namespace vernier {
namespace {

using Color = std::array<float, 4>;

/// What codes 2 and 3 mean in a colour block.
enum class Palette : uint8_t { byOrder, fourColors };

/// A component of a colour block: n / (6 * max), for code max 31 or 63. Both thirds and halves of the end points are
/// whole numbers of these units.
template <uint32_t kMax, bool kSrgb>
float component(uint32_t sixths) {
    if constexpr (!kSrgb) return static_cast<float>(sixths) / (6 * kMax);
    return kMax == 31 ? kSrgbToLinear186[sixths] : kSrgbToLinear378[sixths];
}

/// The colour w0 * c0 + w1 * c1, in sixths, of 5:6:5 colours.
template <bool kSrgb>
Color mixed(uint32_t c0, uint32_t c1, uint32_t w0, uint32_t w1) {
    const auto mix = [&](uint32_t shift, uint32_t max) { return w0 * (c0 >> shift & max) + w1 * (c1 >> shift & max); };
    return {component<31, kSrgb>(mix(11, 31)), component<63, kSrgb>(mix(5, 63)), component<31, kSrgb>(mix(0, 31)), 1};
}

template <Palette kPalette, bool kSrgb>
void decodeColors(const std::byte* block, float blackAlpha, Color* texels) {
    const uint32_t c0 = loadLittleEndian<uint16_t>(block), c1 = loadLittleEndian<uint16_t>(block + 2);
    const bool four = kPalette == Palette::fourColors || c0 > c1;
    const std::array<Color, 4> palette{mixed<kSrgb>(c0, c1, 6, 0), mixed<kSrgb>(c0, c1, 0, 6),
                                       four ? mixed<kSrgb>(c0, c1, 4, 2) : mixed<kSrgb>(c0, c1, 3, 3),
                                       four ? mixed<kSrgb>(c0, c1, 2, 4) : Color{0, 0, 0, blackAlpha}};
    uint32_t codes = loadLittleEndian<uint32_t>(block + 4);
    for (int i = 0; i < 16; ++i, codes >>= 2) texels[i] = palette[codes & 3];
}

/// A component block: texel i goes to texels[i * stride]. kMax: 255, or 127 if signed.
template <bool kSigned>
void decodeComponent(const std::byte* block, float* texels, size_t stride) {
    constexpr int32_t kMax = kSigned ? 127 : 255;
    int32_t e[2];
    for (int i = 0; i < 2; ++i) e[i] = kSigned ? static_cast<int8_t>(block[i]) : static_cast<uint8_t>(block[i]);
    const bool sevenths = e[0] > e[1];  // of the codes as they are: -128 is less than -127
    for (int32_t& end : e) end = std::max(end, -kMax);
    const int32_t parts = sevenths ? 7 : 5;
    std::array<float, 8> palette{static_cast<float>(e[0]) / kMax, static_cast<float>(e[1]) / kMax};
    for (int32_t i = 1; i < parts; ++i) {
        palette[static_cast<size_t>(i) + 1] =
            static_cast<float>((parts - i) * e[0] + i * e[1]) / static_cast<float>(parts * kMax);
    }
    if (!sevenths) {
        palette[6] = kSigned ? -1.0f : 0.0f;
        palette[7] = 1.0f;
    }
    uint64_t codes = loadLittleEndian<uint64_t>(block) >> 16;
    for (size_t i = 0; i < 16; ++i, codes >>= 3) texels[i * stride] = palette[codes & 7];
}

template <bool kSrgb>
void decodeBc2Block(const std::byte* block, Color* texels) {
    decodeColors<Palette::fourColors, kSrgb>(block + 8, 1, texels);
    uint64_t alpha = loadLittleEndian<uint64_t>(block);
    for (int i = 0; i < 16; ++i, alpha >>= 4) texels[i][3] = static_cast<float>(alpha & 15) / 15.0f;
}

template <bool kSrgb>
void decodeBc3Block(const std::byte* block, Color* texels) {
    decodeColors<Palette::fourColors, kSrgb>(block + 8, 1, texels);
    decodeComponent<false>(block, &texels[0][3], 4);
}

template <bool kSigned>
void decodeTwoComponents(const std::byte* block, void* texels) {
    decodeComponent<kSigned>(block, static_cast<float*>(texels), 2);
    decodeComponent<kSigned>(block + 8, static_cast<float*>(texels) + 1, 2);
}

}  // namespace

void decodeBc1Rgb(const std::byte* block, void* texels) {
    decodeColors<Palette::byOrder, false>(block, 1, static_cast<Color*>(texels));
}
void decodeBc1RgbSrgb(const std::byte* block, void* texels) {
    decodeColors<Palette::byOrder, true>(block, 1, static_cast<Color*>(texels));
}
void decodeBc1Rgba(const std::byte* block, void* texels) {
    decodeColors<Palette::byOrder, false>(block, 0, static_cast<Color*>(texels));
}
void decodeBc1RgbaSrgb(const std::byte* block, void* texels) {
    decodeColors<Palette::byOrder, true>(block, 0, static_cast<Color*>(texels));
}
void decodeBc2(const std::byte* block, void* texels) {
    decodeBc2Block<false>(block, static_cast<Color*>(texels));
}
void decodeBc2Srgb(const std::byte* block, void* texels) {
    decodeBc2Block<true>(block, static_cast<Color*>(texels));
}
void decodeBc3(const std::byte* block, void* texels) {
    decodeBc3Block<false>(block, static_cast<Color*>(texels));
}
void decodeBc3Srgb(const std::byte* block, void* texels) {
    decodeBc3Block<true>(block, static_cast<Color*>(texels));
}
void decodeBc4Unorm(const std::byte* block, void* texels) {
    decodeComponent<false>(block, static_cast<float*>(texels), 1);
}
void decodeBc4Snorm(const std::byte* block, void* texels) {
    decodeComponent<true>(block, static_cast<float*>(texels), 1);
}
void decodeBc5Unorm(const std::byte* block, void* texels) {
    decodeTwoComponents<false>(block, texels);
}
void decodeBc5Snorm(const std::byte* block, void* texels) {
    decodeTwoComponents<true>(block, texels);
}

}  // namespace vernier
