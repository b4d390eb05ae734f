// Two decoders that share nothing, the renderer's and the oracle's, on random blocks of every mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "conformance/oracle/block_decode.h"
#include "runtime/format/format.h"

namespace vernier {
namespace {

using conformance::exact::blockExtent;
using conformance::exact::decodeBlockTexel;
using Block = std::array<std::byte, 16>;

std::array<double, 4> rendered(VkFormat format, const Block& block, uint32_t x, uint32_t y) {
    const FormatInfo& info = *findFormat(format);
    std::array<std::byte, kMaxBlockTexels * kMaxDecodedBytes> decoded{};
    info.block->decode(block.data(), decoded.data());
    const VkClearColorValue value =
        unpackTexel(info.color, decoded.data() + (y * info.blockWidth() + x) * info.color.bytes);
    return {value.float32[0], value.float32[1], value.float32[2], value.float32[3]};
}

struct Case {
    VkFormat format;
    const char* name;
    // Of the first byte, made to take all values alike; 0: the first byte is as random as the rest; 11: ASTC.
    uint32_t modeBits;
};

/// Random bits are mostly error blocks: these have few partitions, end points of low range, or are void extents.
void likelierAstc(Block& block, uint32_t round, std::mt19937& random) {
    const auto set = [&block](uint32_t at, uint32_t bits, uint32_t value) {
        for (uint32_t i = 0; i < bits; ++i) {
            const std::byte one = static_cast<std::byte>(1u << (at + i) % 8);
            block[(at + i) / 8] = (value >> i & 1) != 0 ? block[(at + i) / 8] | one : block[(at + i) / 8] & ~one;
        }
    };
    constexpr uint32_t kLowRange[] = {0, 1, 4, 5, 6, 8, 9, 10, 12, 13};
    const uint32_t mode = kLowRange[random() % 10], partitions = random() % 4;
    if (round % 16 == 0) {
        set(0, 9, 0x1fc);
        set(9, 3, random() % 2 == 0 ? 6 : random() % 8);
        if (random() % 2 == 0) set(12, 52, ~0u);
        for (uint32_t at = 12; random() % 2 == 0 && at < 64; at += 26) set(at + 12, 1, 0);
        return;
    }
    if (round % 3 == 0) return;
    set(11, 2, partitions);
    if (partitions == 0) set(13, 4, mode);
    if (partitions != 0 && round % 2 == 0) {
        set(23, 2, 0);
        set(25, 4, mode);
    }
}

class Blocks : public testing::TestWithParam<Case> {};

TEST_P(Blocks, AreDecodedAlike) {
    const Case& tested = GetParam();
    std::mt19937 random(7);
    for (uint32_t round = 0; round < 4000; ++round) {
        Block block;
        for (std::byte& b : block) b = static_cast<std::byte>(random() & 255);
        if (tested.modeBits == 8) {
            // BC7 counts zeros; the last turn is the reserved block.
            const uint32_t mode = round % 9, rest = random();
            block[0] = static_cast<std::byte>(mode == 8 ? 0 : (rest | 1) << mode);
        } else if (tested.modeBits == 5) {
            block[0] = (block[0] & std::byte{0xe0}) | static_cast<std::byte>(round % 32);
        }
        if (tested.modeBits == 11) likelierAstc(block, round, random);
        const VkExtent2D extent = blockExtent(tested.format);
        for (uint32_t texel = 0; texel < extent.width * extent.height; ++texel) {
            const uint32_t x = texel % extent.width, y = texel / extent.width;
            const auto ours = rendered(tested.format, block, x, y);
            const conformance::exact::Color oracle = decodeBlockTexel(tested.format, block, x, y);
            for (size_t c = 0; c < 4; ++c) {
                const double slack = 1e-6 * std::max(1.0, std::abs(oracle[c].value));
                ASSERT_GE(ours[c], oracle[c].low - slack)
                    << "round " << round << ", texel " << texel << ", channel " << c;
                ASSERT_LE(ours[c], oracle[c].high + slack)
                    << "round " << round << ", texel " << texel << ", channel " << c;
                ASSERT_NEAR(ours[c], oracle[c].value, 1e-5 * std::max(1.0, std::abs(oracle[c].value)))
                    << "round " << round << ", texel " << texel << ", channel " << c;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Blocks,
    testing::Values(Case{VK_FORMAT_BC1_RGB_UNORM_BLOCK, "BC1", 0}, Case{VK_FORMAT_BC3_SRGB_BLOCK, "BC3_SRGB", 0},
                    Case{VK_FORMAT_BC5_SNORM_BLOCK, "BC5_SNORM", 0},
                    Case{VK_FORMAT_BC6H_UFLOAT_BLOCK, "BC6H_UFLOAT", 5},
                    Case{VK_FORMAT_BC6H_SFLOAT_BLOCK, "BC6H_SFLOAT", 5}, Case{VK_FORMAT_BC7_UNORM_BLOCK, "BC7", 8},
                    Case{VK_FORMAT_BC7_SRGB_BLOCK, "BC7_SRGB", 8}, Case{VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, "ETC2", 0},
                    Case{VK_FORMAT_EAC_R11G11_UNORM_BLOCK, "EAC", 0}),
    [](const auto& tested) { return std::string(tested.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Astc, Blocks, testing::ValuesIn([] {
        std::vector<Case> cases;
        for (uint32_t i = 0; i < 28; ++i)
            cases.push_back({static_cast<VkFormat>(VK_FORMAT_ASTC_4x4_UNORM_BLOCK + i), "ASTC", 11});
        return cases;
    }()),
    [](const auto& tested) { return "ASTC_" + std::to_string(tested.param.format); });

/// Bits of a block set one by one.
struct BlockBits {
    Block block{};
    void set(uint32_t at, uint32_t bits, uint32_t value) {
        for (uint32_t i = 0; i < bits; ++i) {
            if ((value >> i & 1) != 0) block[(at + i) / 8] |= static_cast<std::byte>(1u << (at + i) % 8);
        }
    }
    /// A weight of `bits` bits: the last bit of the block is the first one of the first weight.
    void setWeight(uint32_t index, uint32_t bits, uint32_t value) {
        for (uint32_t i = 0; i < bits; ++i) set(127 - index * bits - i, 1, value >> i & 1);
    }
};

// BC7, mode 6: end points 0 and 255 of red with both low bits set, index 15 in texel 1.
TEST(BlocksByHand, Bc7ByHand) {
    BlockBits bits;
    const auto set = [&bits](uint32_t at, uint32_t count, uint32_t value) { bits.set(at, count, value); };
    const Block& block = bits.block;
    set(6, 1, 1);
    set(7 + 7, 7, 127);   // the second red
    set(7 + 49, 7, 127);  // the second alpha
    set(63, 1, 0);
    set(64, 1, 1);
    set(65 + 3, 4, 15);  // texel 0 has three bits
    set(65 + 7, 4, 7);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC7_UNORM_BLOCK, block, 0, 0)[0].value, 0);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC7_UNORM_BLOCK, block, 1, 0)[0].value, 1);
    // 255 * 30 / 64, rounded.
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC7_UNORM_BLOCK, block, 2, 0)[0].value, 120 / 255.0);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC7_UNORM_BLOCK, block, 1, 0)[1].value, 1 / 255.0) << "the low bit alone";
}

using Texel = std::array<double, 4>;
Texel astc(const BlockBits& bits, uint32_t x, uint32_t y, VkFormat format = VK_FORMAT_ASTC_4x4_UNORM_BLOCK) {
    const conformance::exact::Color color = decodeBlockTexel(format, bits.block, x, y);
    return {color[0].value, color[1].value, color[2].value, color[3].value};
}

// Luminance, 4 x 4 weights of two bits: W = B + 4, H = A + 2 with B = 0, A = 2, range 4 (R2 R1 R0 = 100).
BlockBits luminance(uint32_t first, uint32_t second) {
    BlockBits bits;
    bits.set(0, 11, 0b00'0'00'10'0'00'10);
    bits.set(17, 8, first);
    bits.set(25, 8, second);
    return bits;
}

TEST(BlocksByHand, AstcLuminance) {
    BlockBits bits = luminance(0, 255);
    bits.setWeight(1, 2, 1);
    bits.setWeight(2, 2, 2);
    bits.setWeight(15, 2, 3);
    EXPECT_EQ(astc(bits, 0, 0), (Texel{0, 0, 0, 1}));
    // Weights 21 and 43 of 64: (65535 * 21 + 32) / 64 = 21504, and eleven bits of it.
    EXPECT_EQ(astc(bits, 1, 0)[0], 21504 / 65536.0);
    EXPECT_EQ(astc(bits, 2, 0)[1], 44000 / 65536.0) << "44031 to eleven bits, towards zero";
    EXPECT_EQ(astc(bits, 3, 3), (Texel{1, 1, 1, 1}));
    // With sRGB end points are 0x0080 and 0xff80: (0x80 * 43 + 0xff80 * 21 + 32) / 64 >> 8 = 84.
    const double linear = std::pow((84 / 255.0 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(astc(bits, 1, 0, VK_FORMAT_ASTC_4x4_SRGB_BLOCK)[0], linear, 1e-9);
    EXPECT_EQ(astc(bits, 1, 0, VK_FORMAT_ASTC_4x4_SRGB_BLOCK)[3], 1);
}

TEST(BlocksByHand, AstcWeightsAreInterpolated) {
    // In a block of 8 x 8 each weight stands for 7 / 3 texels: texel 1 is 3 * 146 + 32 >> 6 = 7 sixteenths on.
    BlockBits bits = luminance(0, 255);
    for (uint32_t row = 0; row < 4; ++row) bits.setWeight(row * 4 + 1, 2, 3);
    const uint32_t weight = (64 * 7 + 8) / 16;
    const uint32_t exact = (65535 * weight + 32) / 64;
    EXPECT_NEAR(astc(bits, 1, 0, VK_FORMAT_ASTC_8x8_UNORM_BLOCK)[0], exact / 65536.0, 0x1p-12);
    EXPECT_EQ(astc(bits, 0, 5, VK_FORMAT_ASTC_8x8_UNORM_BLOCK)[0], 0);
}

/// Texels of the block as the renderer decodes it that are not what the oracle makes of another one.
uint32_t astcTexelsOutside(const BlockBits& judged, const BlockBits& drawn, VkFormat format) {
    const VkExtent2D extent = blockExtent(format);
    uint32_t outside = 0;
    for (uint32_t texel = 0; texel < extent.width * extent.height; ++texel) {
        const uint32_t x = texel % extent.width, y = texel / extent.width;
        const auto ours = rendered(format, drawn.block, x, y);
        const conformance::exact::Color oracle = decodeBlockTexel(format, judged.block, x, y);
        bool inside = true;
        for (size_t c = 0; c < 4; ++c) inside = inside && ours[c] >= oracle[c].low && ours[c] <= oracle[c].high;
        outside += !inside;
    }
    return outside;
}

// A fault of a decoder is a right decoder's answer to other bits.
TEST(BlocksMutation, AstcFaultsAreCaught) {
    constexpr VkFormat kFour = VK_FORMAT_ASTC_4x4_UNORM_BLOCK, kEight = VK_FORMAT_ASTC_8x8_UNORM_BLOCK;
    BlockBits right = luminance(10, 240);
    for (uint32_t i = 0; i < 16; ++i) right.setWeight(i, 2, i * 5 % 4);
    EXPECT_EQ(astcTexelsOutside(right, right, kFour), 0u);
    EXPECT_EQ(astcTexelsOutside(right, right, kEight), 0u);
    BlockBits weight = right;
    weight.block[15] ^= std::byte{0x80};  // the lowest bit of the first weight
    EXPECT_EQ(astcTexelsOutside(right, weight, kFour), 1u);
    EXPECT_GT(astcTexelsOutside(right, weight, kEight), 1u) << "its neighbours are mixed with it";
    BlockBits end = right;
    end.block[2] ^= std::byte{2};  // the lowest bit of the darker end point
    EXPECT_GT(astcTexelsOutside(right, end, kFour), 8u);
    // Two partitions of luminance.
    BlockBits parts;
    parts.set(0, 11, 0b00'0'00'10'0'00'10);
    parts.set(11, 2, 1);
    parts.set(13, 10, 77);
    for (uint32_t at = 29; at < 61; ++at) parts.set(at, 1, at / 5 % 2);
    BlockBits seed = parts;
    seed.set(13 + 4, 1, 1);
    EXPECT_EQ(astcTexelsOutside(parts, parts, kFour), 0u);
    EXPECT_GT(astcTexelsOutside(parts, seed, kFour), 0u) << "another pattern";
}

TEST(BlocksByHand, AstcErrorsAreMagenta) {
    const Texel magenta{1, 0, 1, 1};
    EXPECT_EQ(astc({}, 0, 0), magenta) << "a reserved mode";
    BlockBits high = luminance(0, 255);
    high.set(13, 4, 2);
    EXPECT_EQ(astc(high, 0, 0), magenta) << "end points of high range";
    BlockBits wide = luminance(0, 255);
    wide.set(7, 2, 3);
    EXPECT_EQ(astc(wide, 0, 0), magenta) << "seven weights in a row of four texels";
}

TEST(BlocksByHand, AstcVoidExtents) {
    BlockBits bits;
    bits.set(0, 12, 0xdfc);
    bits.set(12, 32, ~0u);
    bits.set(44, 20, ~0u);
    bits.set(64, 16, 65535);
    bits.set(80, 16, 32768);
    bits.set(112, 16, 3);
    EXPECT_EQ(astc(bits, 3, 2), (Texel{1, 0.5, 0, 3 / 65536.0}));
    bits.block[3] = std::byte{0};
    EXPECT_EQ(astc(bits, 3, 2), (Texel{1, 0, 1, 1})) << "an extent that ends before it begins";
}

// BC6H, mode 3: two end points of ten bits, red 0 and the largest.
TEST(BlocksByHand, Bc6hByHand) {
    Block block{};
    block[0] = std::byte{3};
    for (uint32_t at = 5 + 30; at < 5 + 40; ++at) block[at / 8] |= static_cast<std::byte>(1u << at % 8);
    for (uint32_t at = 65 + 3; at < 65 + 7; ++at) block[at / 8] |= static_cast<std::byte>(1u << at % 8);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC6H_UFLOAT_BLOCK, block, 0, 0)[0].value, 0);
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC6H_UFLOAT_BLOCK, block, 1, 0)[0].value, 65504) << "the largest half";
    EXPECT_EQ(decodeBlockTexel(VK_FORMAT_BC6H_UFLOAT_BLOCK, block, 1, 0)[3].value, 1);
    // The same bits with a sign are -1: -(0x40 * 31 >> 5) of a half.
    EXPECT_LT(decodeBlockTexel(VK_FORMAT_BC6H_SFLOAT_BLOCK, block, 1, 0)[0].value, 0);
}

}  // namespace
}  // namespace vernier
