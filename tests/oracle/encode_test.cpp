// Hand-computed conversions, blending and depth codes.
#include "conformance/oracle/encode.h"
#include "conformance/oracle/blending.h"
#include "conformance/oracle/depth_exact.h"

#include <gtest/gtest.h>

namespace vernier::conformance::exact {
namespace {

const Component kUnorm8{0, 0, 8, Encoding::unorm};
const Component kSnorm8{0, 0, 8, Encoding::snorm};
const Component kSrgb8{0, 0, 8, Encoding::srgb};
const Component kHalf{0, 0, 16, Encoding::sfloat};
const Component kFloat{0, 0, 32, Encoding::sfloat};
const Component kFloat11{0, 0, 11, Encoding::ufloat};
const Component kFloat10{0, 0, 10, Encoding::ufloat};

void expectCodes(const CodeSet& set, uint64_t below, uint64_t above, uint64_t nearest) {
    EXPECT_EQ(set.below, below);
    EXPECT_EQ(set.above, above);
    EXPECT_EQ(set.nearest, nearest);
}

// B01, B02.
TEST(Encode, Unorm8) {
    expectCodes(encode(kUnorm8, rational(0.25)), 63, 64, 64);
    expectCodes(encode(kUnorm8, rational(0.5)), 127, 128, 128);
    expectCodes(encode(kUnorm8, rational(1)), 255, 255, 255);
    expectCodes(encode(kUnorm8, rational(-3)), 0, 0, 0);
    expectCodes(encode(kUnorm8, rational(7)), 255, 255, 255);
    expectCodes(encode(kUnorm8, fraction(200, 255)), 200, 200, 200);
    EXPECT_FALSE(encode(kUnorm8, rational(0.25)).permits(65));
}

// B03, B04, T10: every code survives decode and encode.
TEST(Encode, CodesAreFixedPoints) {
    for (uint64_t code = 0; code < 256; ++code) {
        EXPECT_EQ(encode(kUnorm8, *decode(kUnorm8, code)).nearest, code);
        EXPECT_EQ(encode(kSrgb8, *decode(kSrgb8, code)).nearest, code);
        EXPECT_EQ(encode(kSnorm8, *decode(kSnorm8, code)).nearest, code == 0x80 ? 0x81 : code);
    }
    EXPECT_EQ(*decode(kSnorm8, 0x80), -1);
    EXPECT_EQ(*decode(kSnorm8, 0x81), -1);
}

// B11.
TEST(Encode, Half) {
    expectCodes(encode(kHalf, rational(65504)), 0x7bff, 0x7bff, 0x7bff);
    expectCodes(encode(kHalf, rational(65519.99)), 0x7bff, 0x7c00, 0x7bff);
    expectCodes(encode(kHalf, rational(65520)), 0x7bff, 0x7c00, 0x7c00);
    expectCodes(encode(kHalf, rational(1e6)), 0x7bff, 0x7c00, 0x7c00);
    expectCodes(encode(kHalf, powerOfTwo(-24)), 1, 1, 1);
    expectCodes(encode(kHalf, powerOfTwo(-25)), 0, 1, 0);
    expectCodes(encode(kHalf, rational(-1)), 0xbc00, 0xbc00, 0xbc00);
    // 1 + 2^-11 is the tie between 0x3c00 and 0x3c01; below and above swap with the sign.
    expectCodes(encode(kHalf, 1 + powerOfTwo(-11)), 0x3c00, 0x3c01, 0x3c00);
    expectCodes(encode(kHalf, -1 - powerOfTwo(-12)), 0xbc01, 0xbc00, 0xbc00);
    for (uint64_t code = 0; code < 0x7c00; ++code) EXPECT_EQ(encode(kHalf, *decode(kHalf, code)).nearest, code);
    EXPECT_FALSE(decode(kHalf, 0x7c00));
    EXPECT_EQ(encode(kFloat, rational(1)).nearest, 0x3f800000u);
    EXPECT_EQ(encode(kFloat, powerOfTwo(-149)).nearest, 1u);
}

// B12.
TEST(Encode, PackedFloats) {
    EXPECT_EQ(*decode(kFloat11, 0x7bf), 65024);
    EXPECT_EQ(*decode(kFloat10, 0x3df), 64512);
    EXPECT_EQ(*decode(kFloat11, 1), powerOfTwo(-20));
    EXPECT_EQ(*decode(kFloat10, 1), powerOfTwo(-19));
    expectCodes(encode(kFloat11, rational(-5)), 0, 0, 0);
    for (uint64_t code = 0; code < 0x7c0; ++code) EXPECT_EQ(encode(kFloat11, *decode(kFloat11, code)).nearest, code);
    for (uint64_t code = 0; code < 0x3e0; ++code) EXPECT_EQ(encode(kFloat10, *decode(kFloat10, code)).nearest, code);
}

// B13: a channel of 511.75 quanta rounds to 512 and raises the exponent.
TEST(Encode, SharedExponentBump) {
    const Rational bump = 1 - powerOfTwo(-11);
    const uint32_t code = encodeSharedExponent({bump, Rational(0), Rational(0)});
    EXPECT_EQ(code >> 27, 16u);
    EXPECT_EQ(code & 511u, 256u);
    EXPECT_EQ(decodeSharedExponent(code)[0], 1);
    EXPECT_EQ(decodeSharedExponent(encodeSharedExponent({rational(1e9), rational(-1), rational(1)}))[0], 65408);
    EXPECT_EQ(encodeSharedExponent({Rational(0), Rational(0), Rational(0)}), 0u);
}

// B05: 0.0031308 is met by both segments; 0.5 linear is code 188 (187.5160...).
TEST(Encode, Srgb) {
    expectCodes(encode(kSrgb8, rational(0.5)), 187, 188, 188);
    expectCodes(encode(kSrgb8, rational(0)), 0, 0, 0);
    expectCodes(encode(kSrgb8, rational(1)), 255, 255, 255);
    expectCodes(encode(kSrgb8, fraction(10, 255) / fraction(1292, 100)), 10, 10, 10);
    uint64_t last = 0;
    for (int i = 0; i <= 4096; ++i) {
        const uint64_t code = encode(kSrgb8, fraction(i, 4096 * 100)).nearest;
        EXPECT_GE(code, last);
        last = code;
    }
}

// B14: 565 and 10-10-10-2 bit places.
TEST(Formats, PackedPlaces) {
    const PixelFormat* rgb565 = findPixelFormat(VK_FORMAT_R5G6B5_UNORM_PACK16);
    ASSERT_TRUE(rgb565);
    std::byte texel[4]{};
    insertBits(texel, rgb565->channel(0)->offset, 5, 31);
    EXPECT_EQ(extractBits(texel, 0, 16), 0xf800u);
    EXPECT_EQ(rgb565->channel(3), nullptr);
    const PixelFormat* rgb10 = findPixelFormat(VK_FORMAT_A2B10G10R10_UNORM_PACK32);
    ASSERT_TRUE(rgb10);
    EXPECT_EQ(rgb10->channel(3)->offset, 30);
    EXPECT_EQ(rgb10->channel(0)->offset, 0);
    EXPECT_EQ(findPixelFormat(VK_FORMAT_B8G8R8A8_UNORM)->channel(0)->offset, 16);
    EXPECT_EQ(findPixelFormat(VK_FORMAT_R8G8B8A8_SRGB)->channel(3)->encoding, Encoding::unorm);
}

// D01, D02, D05, D06.
TEST(Depth, CodesAndBias) {
    expectCodes(encodeDepth(VK_FORMAT_D16_UNORM, rational(0.25)), 16383, 16384, 16384);
    expectCodes(encodeDepth(VK_FORMAT_D24_UNORM_S8_UINT, rational(1)), 0xffffff, 0xffffff, 0xffffff);
    expectCodes(encodeDepth(VK_FORMAT_D16_UNORM, rational(0)), 0, 0, 0);
    const std::array<Rational, 3> z{rational(0.3), rational(0.6), rational(0.6)};
    EXPECT_EQ(biasUnit(VK_FORMAT_D32_SFLOAT, z).low, powerOfTwo(-24));
    EXPECT_EQ(biasUnit(VK_FORMAT_D16_UNORM, z).high, powerOfTwo(-15));
    const BiasRange flat = depthBias(VK_FORMAT_D16_UNORM, z, 0, 0, 1, 0, 0);
    EXPECT_EQ(flat.low, 0x1p-16);
    EXPECT_EQ(flat.high, 0x1p-15);
    // D07: slope 3-4-5: the largest derivative is 4, the exact one 5.
    const BiasRange slope = depthBias(VK_FORMAT_D32_SFLOAT, z, 3, 4, 0, 0, 2);
    EXPECT_EQ(slope.low, 8);
    EXPECT_EQ(slope.high, 10);
    EXPECT_EQ(depthBias(VK_FORMAT_D32_SFLOAT, z, 3, 4, 0, 1.5f, 2).high, 1.5);
}

VkPipelineColorBlendAttachmentState blendState(VkBlendFactor source, VkBlendFactor destination) {
    VkPipelineColorBlendAttachmentState state{};
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = source;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = destination;
    state.colorWriteMask = 0xf;
    return state;
}

// B06: alpha 1 gives the source, alpha 0 the destination, for every pair of codes.
TEST(Blend, AlphaZeroAndOneAreExact) {
    const PixelFormat& format = *findPixelFormat(VK_FORMAT_R8G8B8A8_UNORM);
    const auto state = blendState(VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    for (uint64_t s = 0; s < 256; s += 5) {
        for (uint64_t d = 0; d < 256; d += 3) {
            const Rational c = fraction(static_cast<int64_t>(s), 255);
            EXPECT_EQ(blendExactly(format, state, {}, {c, c, c, 1}, {d, d, d, d}).nearest[0], s);
            EXPECT_EQ(blendExactly(format, state, {}, {c, c, c, 0}, {d, d, d, d}).nearest[0], d);
        }
    }
}

// B07: 255 additive passes of 1/255.
TEST(Blend, AdditiveStepsCount) {
    const PixelFormat& format = *findPixelFormat(VK_FORMAT_R8G8B8A8_UNORM);
    const auto state = blendState(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE);
    Codes codes{};
    const Rational one = fraction(1, 255);
    for (int i = 0; i < 255; ++i) codes = blendExactly(format, state, {}, {one, one, one, one}, codes).nearest;
    EXPECT_EQ(codes[0], 255u);
    EXPECT_EQ(codes[3], 255u);
}

// B09, B16, B17.
TEST(Blend, SubtractMaskAndMissingAlpha) {
    auto state = blendState(VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE);
    state.colorBlendOp = VK_BLEND_OP_SUBTRACT;
    state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
    const PixelFormat& rgba = *findPixelFormat(VK_FORMAT_R8G8B8A8_UNORM);
    const Codes result = blendExactly(rgba, state, {}, {fraction(1, 5), 1, 1, 1}, {100, 7, 8, 9}).nearest;
    EXPECT_EQ(result, (Codes{0, 7, 8, 9}));
    const PixelFormat& rgb = *findPixelFormat(VK_FORMAT_R5G6B5_UNORM_PACK16);
    auto byDestination = blendState(VK_BLEND_FACTOR_DST_ALPHA, VK_BLEND_FACTOR_ZERO);
    EXPECT_EQ(blendExactly(rgb, byDestination, {}, {1, 1, 1, 1}, {}).nearest[0], 31u);
}

TEST(Blend, ReplaySeparatesNewFromInheritedError) {
    const PixelFormat& format = *findPixelFormat(VK_FORMAT_R8_UNORM);
    const auto state = blendState(VK_BLEND_FACTOR_CONSTANT_COLOR, VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR);
    const std::array<Rational, 4> half{fraction(1, 2), fraction(1, 2), fraction(1, 2), fraction(1, 2)};
    const std::vector<std::array<Rational, 4>> sources(3, {1, 1, 1, 1});
    // 0 -> 127.5 -> (from 127) 191 -> (from 191) 223; every step legal although the first was rounded down.
    EXPECT_EQ(checkBlendChain(format, state, half, {}, sources, {{127}, {191}, {223}}), "");
    const std::string wrong = checkBlendChain(format, state, half, {}, sources, {{127}, {192}, {223}});
    EXPECT_NE(wrong.find("write 1"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace vernier::conformance::exact
