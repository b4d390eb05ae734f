// Block decoders on blocks made by hand, with results computed by hand from the specification.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <cstring>
#include <random>

#include "runtime/format/format.h"
#include "runtime/format/srgb.h"

namespace vernier {
namespace {

using Bytes = std::array<uint8_t, 16>;
using Texel = std::array<float, 4>;

/// Texel (x, y) of a block.
Texel texelOf(VkFormat format, const Bytes& block, uint32_t x, uint32_t y) {
    const FormatInfo& info = *findFormat(format);
    std::array<std::byte, kMaxBlockTexels * kMaxDecodedBytes> decoded{};
    info.block->decode(reinterpret_cast<const std::byte*>(block.data()), decoded.data());
    const VkClearColorValue value =
        unpackTexel(info.color, decoded.data() + (y * info.blockWidth() + x) * info.color.bytes);
    return {value.float32[0], value.float32[1], value.float32[2], value.float32[3]};
}

TEST(Block, TableDescribesTheBlocks) {
    const FormatInfo& astc = *findFormat(VK_FORMAT_ASTC_12x10_SRGB_BLOCK);
    EXPECT_EQ(astc.blockWidth(), 12u);
    EXPECT_EQ(astc.blockHeight(), 10u);
    EXPECT_EQ(astc.bytesPerTexel, 16);
    EXPECT_EQ(astc.columns(13), 2u);
    EXPECT_EQ(astc.rows(1), 1u);
    for (uint32_t format = VK_FORMAT_BC1_RGB_UNORM_BLOCK; format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK; ++format) {
        const FormatInfo* info = findFormat(static_cast<VkFormat>(format));
        ASSERT_NE(info, nullptr) << format;
        ASSERT_NE(info->block, nullptr) << info->name;
        EXPECT_EQ(findFormat(info->block->decoded)->bytesPerTexel, info->color.bytes) << info->name;
        EXPECT_LE(info->color.bytes, kMaxDecodedBytes);
        EXPECT_EQ(info->optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, 0u);
    }
}

TEST(Block, Bc1MixesInThirdsAndHalves) {
    // color0 = (31, 63, 0) > color1 = (0, 0, 31); codes 0 to 3 in the first row.
    const Bytes thirds{0xe0, 0xff, 0x1f, 0x00, 0xe4, 0, 0, 0};
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGB_UNORM_BLOCK, thirds, 0, 0), (Texel{1, 1, 0, 1}));
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGB_UNORM_BLOCK, thirds, 1, 0), (Texel{0, 0, 1, 1}));
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGB_UNORM_BLOCK, thirds, 2, 0), (Texel{2.0f / 3, 2.0f / 3, 1.0f / 3, 1}));
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGB_UNORM_BLOCK, thirds, 3, 0), (Texel{1.0f / 3, 1.0f / 3, 2.0f / 3, 1}));
    const Bytes halves{0x1f, 0x00, 0xe0, 0xff, 0xe4, 0, 0, 0};
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGBA_UNORM_BLOCK, halves, 2, 0), (Texel{0.5f, 0.5f, 0.5f, 1}));
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGBA_UNORM_BLOCK, halves, 3, 0), (Texel{0, 0, 0, 0}));
    EXPECT_EQ(texelOf(VK_FORMAT_BC1_RGB_UNORM_BLOCK, halves, 3, 0), (Texel{0, 0, 0, 1}));
}

TEST(Block, Bc4SignedTreatsBothLowestCodesAsMinusOne) {
    // red0 = -128 <= red1 = 127: fifths; codes 0, 1, 2, 6, 7 in the first texels.
    const Bytes block{0x80, 0x7f, 0x88, 0x7c, 0, 0, 0, 0};
    EXPECT_EQ(texelOf(VK_FORMAT_BC4_SNORM_BLOCK, block, 0, 0)[0], -1.0f);
    EXPECT_EQ(texelOf(VK_FORMAT_BC4_SNORM_BLOCK, block, 1, 0)[0], 1.0f);
    EXPECT_EQ(texelOf(VK_FORMAT_BC4_SNORM_BLOCK, block, 2, 0)[0], -0.6f);
    EXPECT_EQ(texelOf(VK_FORMAT_BC4_SNORM_BLOCK, block, 3, 0)[0], -1.0f);
    EXPECT_EQ(texelOf(VK_FORMAT_BC4_SNORM_BLOCK, block, 0, 1)[0], 1.0f);
}

TEST(Block, ReservedModesAreBlack) {
    EXPECT_EQ(texelOf(VK_FORMAT_BC7_UNORM_BLOCK, Bytes{}, 1, 2), (Texel{0, 0, 0, 0}));
    for (const uint8_t mode : {0x13, 0x17, 0x1b, 0x1f}) {
        Bytes block;
        block.fill(0xff);
        block[0] = mode;
        EXPECT_EQ(texelOf(VK_FORMAT_BC6H_UFLOAT_BLOCK, block, 3, 3), (Texel{0, 0, 0, 1})) << int{mode};
    }
}

TEST(Block, Etc2PlanarExampleOfTheSpecification) {
    // O = (12, 64, 62), H = (50, 5, 37), V = (40, 112, 45) in 6:7:6 bits.
    uint64_t bits = 0;
    const auto put = [&](uint64_t value, int at) { bits |= value << at; };
    put(12, 57), put(64 >> 6, 56), put(64 & 63, 49), put(62 >> 5, 48), put(62 >> 3 & 3, 43), put(62 & 7, 39);
    put(50 >> 1, 34), put(50 & 1, 32), put(5, 25), put(37, 19), put(40, 13), put(112, 6), put(45, 0), put(1, 33);
    // Make blue's sum overflow and the others' not: B in bits 47..43 is ???xx with free bits 47..45, Bd in 42..40.
    for (uint64_t free = 0; free < 512; ++free) {
        const uint64_t tried =
            bits | (free >> 0 & 1) << 63 | (free >> 1 & 1) << 55 | (free >> 2 & 7) << 45 | (free >> 5 & 1) << 42;
        const auto sum = [&](int at) {
            const int base = static_cast<int>(tried >> at & 31), delta = static_cast<int>(tried >> (at - 3) & 7);
            return base + (delta >= 4 ? delta - 8 : delta);
        };
        const auto fits = [](int v) { return v >= 0 && v <= 31; };
        if (!fits(sum(59)) || !fits(sum(51)) || fits(sum(43))) continue;
        Bytes block{};
        for (int i = 0; i < 8; ++i) block[static_cast<size_t>(i)] = static_cast<uint8_t>(tried >> (56 - 8 * i));
        const auto codes = [](int r, int g, int b) {
            return Texel{static_cast<float>(r) / 255, static_cast<float>(g) / 255, static_cast<float>(b) / 255, 1};
        };
        EXPECT_EQ(texelOf(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, block, 0, 0), codes(48, 129, 251));
        EXPECT_EQ(texelOf(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, block, 3, 0), codes(164, 40, 175));
        EXPECT_EQ(texelOf(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, block, 1, 2), codes(144, 147, 191));
        EXPECT_EQ(texelOf(VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, block, 3, 3), codes(250, 112, 124));
        return;
    }
    FAIL() << "no choice of the free bits selects the planar mode";
}

TEST(Block, EacExamplesOfTheSpecification) {
    // Base codeword 103, table 13, index 3 (modifier -10) in texel a; multiplier 2, then 0.
    const Bytes two{103, 0x2d, 0x60}, none{103, 0x0d, 0x60};
    EXPECT_EQ(texelOf(VK_FORMAT_EAC_R11_UNORM_BLOCK, two, 0, 0)[0], 668.0f / 2047);
    EXPECT_EQ(texelOf(VK_FORMAT_EAC_R11_UNORM_BLOCK, none, 0, 0)[0], 818.0f / 2047);
    const Bytes signedTwo{60, 0x2d, 0x60}, lowest{0x80, 0x1d, 0x60};
    EXPECT_EQ(texelOf(VK_FORMAT_EAC_R11_SNORM_BLOCK, signedTwo, 0, 0)[0], 320.0f / 1023);
    EXPECT_EQ(texelOf(VK_FORMAT_EAC_R11_SNORM_BLOCK, lowest, 0, 0)[0], -1.0f);
}

TEST(Block, AstcVoidExtentsAndErrors) {
    // No extent: all coordinates ones. Colour (0x8000, 0xffff, 0x0001, 0x4000).
    Bytes block{0xfc, 0xfd, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00, 0x80, 0xff, 0xff, 0x01, 0x00, 0x00, 0x40};
    const Texel color{0.5f, 1.0f, 0x1p-16f, 0.25f}, magenta{1, 0, 1, 1};
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_4x4_UNORM_BLOCK, block, 3, 3), color);
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_12x12_UNORM_BLOCK, block, 11, 11), color);
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_8x5_SRGB_BLOCK, block, 7, 4), (Texel{kSrgbToLinear[0x80], 1, 0, 0.25f}));
    block[1] = 0xff;  // HDR
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_4x4_UNORM_BLOCK, block, 0, 0), magenta);
    block[1] = 0xfd;
    block[2] = 0x0f;  // an extent whose low coordinate is above the high one is none
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_4x4_UNORM_BLOCK, block, 0, 0), magenta);
    EXPECT_EQ(texelOf(VK_FORMAT_ASTC_6x6_UNORM_BLOCK, Bytes{}, 5, 5), magenta);  // a reserved block mode
}

TEST(Block, EverySequenceOfBitsDecodes) {
    std::mt19937 random(7);
    for (const FormatInfo& info : allFormats()) {
        if (info.block == nullptr) continue;
        for (int i = 0; i < 200; ++i) {
            std::array<uint8_t, 16> block;
            for (uint8_t& byte : block) byte = static_cast<uint8_t>(random() >> 9);
            // Exactly the bytes of the block, and exactly the room for its texels, on the heap for the sanitizer.
            std::vector<std::byte> source(info.bytesPerTexel);
            std::memcpy(source.data(), block.data(), source.size());
            std::vector<std::byte> texels(size_t{info.blockWidth()} * info.blockHeight() * info.color.bytes);
            info.block->decode(source.data(), texels.data());
        }
    }
}

TEST(Block, SrgbOfMixedColorsIsTheNearestFloat) {
    mpfr_t x, y, power;
    mpfr_inits2(200, x, y, power, nullptr);
    mpfr_set_str(power, "2.4", 10, MPFR_RNDN);
    const auto check = [&](const float* table, unsigned max) {
        for (unsigned i = 0; i <= max; ++i) {
            mpfr_set_ui(x, i, MPFR_RNDN);
            mpfr_div_ui(x, x, max, MPFR_RNDN);
            if (i * 100000ull <= 4045ull * max) {
                mpfr_mul_ui(y, x, 100, MPFR_RNDN);
                mpfr_div_ui(y, y, 1292, MPFR_RNDN);
            } else {
                mpfr_mul_ui(y, x, 1000, MPFR_RNDN);
                mpfr_add_ui(y, y, 55, MPFR_RNDN);
                mpfr_div_ui(y, y, 1055, MPFR_RNDN);
                mpfr_pow(y, y, power, MPFR_RNDN);
            }
            EXPECT_EQ(table[i], mpfr_get_flt(y, MPFR_RNDN)) << i << " / " << max;
        }
    };
    check(kSrgbToLinear186.data(), 186);
    check(kSrgbToLinear378.data(), 378);
    mpfr_clears(x, y, power, nullptr);
}

}  // namespace
}  // namespace vernier
