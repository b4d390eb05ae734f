// Two decoders that share nothing, the renderer's and the oracle's, on random blocks of every mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "conformance/oracle/block_decode.h"
#include "runtime/format/format.h"

namespace vernier {
namespace {

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
    uint32_t modeBits;  // of the first byte, made to take all values alike; 0: the first byte is as random as the rest
};

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
        for (uint32_t texel = 0; texel < 16; ++texel) {
            const auto ours = rendered(tested.format, block, texel % 4, texel / 4);
            const conformance::exact::Color oracle = decodeBlockTexel(tested.format, block, texel % 4, texel / 4);
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

// BC7, mode 6: end points 0 and 255 of red with both low bits set, index 15 in texel 1.
TEST(BlocksByHand, Bc7ByHand) {
    Block block{};
    const auto set = [&block](uint32_t at, uint32_t bits, uint32_t value) {
        for (uint32_t i = 0; i < bits; ++i) {
            if ((value >> i & 1) != 0) block[(at + i) / 8] |= static_cast<std::byte>(1u << (at + i) % 8);
        }
    };
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
