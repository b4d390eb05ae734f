#include "conformance/hardcases/block_cases.h"

#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/texture_input.h"
#include "conformance/oracle/block_decode.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace vernier::conformance::hardcases {
namespace {

/// What decoded channels are: the precision that is left open follows from it.
enum class Light : uint8_t { linear, srgb, halves };

struct BlockSample {
    VkFormat format;
    const char* name;
    std::vector<Bytes> blocks;
    Light light = Light::linear;
};

// ---- Making blocks ----

Bytes bytesOfWords(std::initializer_list<uint64_t> words, bool bigEndian) {
    Bytes bytes;
    for (const uint64_t word : words) {
        for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<std::byte>(word >> (bigEndian ? 56 - 8 * i : 8 * i)));
    }
    return bytes;
}

void setBits(Bytes& block, uint32_t at, uint32_t bits, uint32_t value) {
    for (uint32_t i = at; i < at + bits; ++i, value >>= 1) {
        const std::byte one = static_cast<std::byte>(1u << i % 8);
        block[i / 8] = (value & 1) != 0 ? block[i / 8] | one : block[i / 8] & ~one;
    }
}

Bytes joined(const Bytes& first, const Bytes& second) {
    Bytes both = first;
    both.insert(both.end(), second.begin(), second.end());
    return both;
}

/// Blocks of 16 bytes that are all 0, all ones, and random.
std::vector<Bytes> fillings(std::mt19937_64& random) {
    return {bytesOfWords({0, 0}, false), bytesOfWords({~uint64_t{0}, ~uint64_t{0}}, false),
            bytesOfWords({random(), random()}, false), bytesOfWords({random(), random()}, false)};
}

/// Indices that name every entry of a palette of four in every row.
constexpr uint64_t kAllOfFour = 0xe4e4e4e4;
/// Indices 0 to 7, twice, of three bits.
constexpr uint64_t kAllOfEight = 0xfac688fac688;

Bytes bc1(uint64_t first, uint64_t second) {
    return bytesOfWords({first | second << 16 | kAllOfFour << 32}, false);
}
Bytes bc4(uint64_t first, uint64_t second) {
    return bytesOfWords({(first & 255) | (second & 255) << 8 | kAllOfEight << 16}, false);
}

// End points at the ends of their ranges, equal ones, both orders, and some in between.
std::vector<Bytes> colorBlocks() {
    return {bc1(0xffff, 0x0000), bc1(0x0000, 0xffff), bc1(0x8410, 0x8410),
            bc1(0xf800, 0x001f), bc1(0x001f, 0xf800), bc1(0x07e0, 0x07df)};
}
std::vector<Bytes> unsignedBlocks() {
    return {bc4(255, 0), bc4(0, 255), bc4(128, 128), bc4(200, 13)};
}
std::vector<Bytes> signedBlocks() {
    return {bc4(127, 0x80), bc4(0x80, 127), bc4(0x81, 0x80), bc4(100, 0xf0)};
}

/// Each block of one list before each of another.
std::vector<Bytes> pairs(const std::vector<Bytes>& first, const std::vector<Bytes>& second) {
    std::vector<Bytes> all;
    for (const Bytes& a : first) {
        for (const Bytes& b : second) all.push_back(joined(a, b));
    }
    return all;
}

// ---- Drawing and judging them ----

/// Whether a channel is one that the decoder may give. No precision is stated for decoding sRGB: the value reads back
/// as the same code of eight bits.
bool permitted(double seen, const exact::Interval& exactly, Light light, uint8_t channel) {
    if (light == Light::halves) return seen == exactly.value;
    if (light == Light::linear || channel == 3) return seen >= exactly.low - 1e-5 && seen <= exactly.high + 1e-5;
    const double code = exact::srgbEncode(seen) * 255, half = 0.5;
    return code >= exact::srgbEncode(exactly.low) * 255 - half && code <= exact::srgbEncode(exactly.high) * 255 + half;
}

/// Every texel of the blocks, fetched.
void addBlocks(CaseInput& input, std::string_view name, const BlockSample& sample) {
    const VkExtent2D size = exact::blockExtent(sample.format);
    TextureTable table;
    table.format = sample.format;
    table.extent = {static_cast<uint32_t>(sample.blocks.size()) * size.width, size.height};
    Bytes all;
    for (const Bytes& block : sample.blocks) all.insert(all.end(), block.begin(), block.end());
    table.levels = {all};
    table.sampler = filtered(VK_FILTER_NEAREST);
    table.expression = "texelFetch(picture, ivec2(c.xy), 0)";
    for (uint32_t x = 0; x < table.extent.width; ++x) {
        for (uint32_t y = 0; y < size.height; ++y)
            table.coordinates.push_back({static_cast<float>(x), static_cast<float>(y), 0, 0});
    }
    const size_t scene = input.scene(textureScene(name, table));
    judgePixels(input, scene, 0, extentOf(table), [=](const PixelReader& pixels, const Declared&) -> Verdict {
        const double close = sample.light == Light::halves ? 0 : 1e-6;
        Verdict worst;
        for (uint32_t i = 0; i < pixels.extent().width; ++i) {
            const uint32_t x = i / size.height, y = i % size.height, block = x / size.width;
            const exact::Color expected =
                exact::decodeBlockTexel(sample.format, sample.blocks[block], x % size.width, y);
            for (uint8_t c = 0; c < 4; ++c) {
                const double seen = pixels.number(i, 0, c);
                if (std::abs(seen - expected[c].value) <= close) continue;
                const std::string text = std::string(sample.name) + ", block " + std::to_string(block) + ", texel (" +
                                         std::to_string(x % size.width) + ", " + std::to_string(y) + "), channel " +
                                         "RGBA"[c] + ": " + std::to_string(seen) + ", exactly " +
                                         std::to_string(expected[c].value);
                worst = worst.worse(Verdict::inexact(permitted(seen, expected[c], sample.light, c), text));
            }
        }
        return worst;
    });
}

// ---- ASTC ----

/// Luminance of two end points with 4 x 4 weights of two bits, which are 0 to 3 in turn: block mode W = B + 4, H = A +
/// 2 with B = 0 and A = 2, weights of range 4.
Bytes astcLuminance(uint32_t first, uint32_t second) {
    Bytes block(16);
    setBits(block, 0, 11, 0b00'0'00'10'0'00'10);
    setBits(block, 17, 8, first);
    setBits(block, 25, 8, second);
    // The last bit of the block is the first one of the first weight.
    for (uint32_t i = 0; i < 32; ++i) setBits(block, 127 - i, 1, i / 2 % 4 >> i % 2 & 1);
    return block;
}

/// One colour for all texels, in 16 bits a channel.
Bytes astcVoid(std::array<uint32_t, 4> color) {
    Bytes block(16);
    setBits(block, 0, 12, 0xdfc);
    for (const uint32_t at : {12, 38}) setBits(block, at, 26, ~0u);
    for (uint32_t c = 0; c < 4; ++c) setBits(block, 64 + 16 * c, 16, color[c]);
    return block;
}

bool isMagenta(const exact::Color& color) {
    return color[0].value == 1 && color[1].value == 0 && color[2].value == 1 && color[3].value == 1;
}

/// Black to white, both orders, void extents at their ends, a block mode that is reserved, and random blocks that are
/// no errors, with up to four partitions.
std::vector<Bytes> astcBlocks(VkFormat format, std::mt19937_64& random) {
    std::vector<Bytes> blocks{astcLuminance(0, 255),        astcLuminance(255, 0),
                              astcLuminance(127, 128),      astcVoid({65535, 32768, 0, 65535}),
                              astcVoid({65534, 257, 1, 3}), Bytes(16)};
    while (blocks.size() < 14) {
        Bytes block = bytesOfWords({random(), random()}, false);
        constexpr uint32_t kLowRange[] = {0, 4, 6, 8, 10, 12};
        setBits(block, 11, 2, static_cast<uint32_t>(blocks.size() % 4));
        if (blocks.size() % 4 == 0) setBits(block, 13, 4, kLowRange[random() % 6]);
        if (!isMagenta(exact::decodeBlockTexel(format, block, 0, 0))) blocks.push_back(block);
    }
    return blocks;
}

}  // namespace

void t20(CaseInput& input) {
    addBlocks(input, "T20", {VK_FORMAT_BC1_RGB_UNORM_BLOCK, "BC1", colorBlocks()});
    addBlocks(input, "T20", {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, "BC1 with alpha", colorBlocks()});
    addBlocks(input, "T20", {VK_FORMAT_BC4_UNORM_BLOCK, "BC4", unsignedBlocks()});
    addBlocks(input, "T20", {VK_FORMAT_BC4_SNORM_BLOCK, "BC4 signed", signedBlocks()});
    // ETC2: each of the five modes, and random ones. The two bits behind bit 33 choose the mode by overflow.
    std::vector<Bytes> etc2{bytesOfWords({0x0f5af0a5'00fce4b1 & ~(uint64_t{2} << 32)}, true),
                            bytesOfWords({0x8142c3ff'e4b12d87}, true),
                            bytesOfWords({0xff000000'5555aaaa | uint64_t{2} << 32}, true),   // red overflows: T
                            bytesOfWords({0x00ff0042'1b8de472 | uint64_t{2} << 32}, true),   // green overflows: H
                            bytesOfWords({0x0000ff42'72d81be4 | uint64_t{2} << 32}, true)};  // blue overflows: planar
    std::mt19937_64 random(20);
    for (int i = 0; i < 12; ++i) etc2.push_back(bytesOfWords({random()}, true));
    addBlocks(input, "T20", {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, "ETC2", etc2});
    addBlocks(input, "T20", {VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, "ETC2 with one bit of alpha", etc2});
    std::vector<Bytes> eac{bytesOfWords({0x00f0'0539'7705'3977}, true), bytesOfWords({0xfff3'0539'7705'3977}, true),
                           bytesOfWords({0x800d'fac6'88fa'c688}, true)};
    for (int i = 0; i < 6; ++i) eac.push_back(bytesOfWords({random()}, true));
    addBlocks(input, "T20", {VK_FORMAT_EAC_R11_UNORM_BLOCK, "EAC", eac});
}

void t22(CaseInput& input) {
    const std::vector<Bytes> alphas{bytesOfWords({0xfedcba9876543210}, false)};
    addBlocks(input, "T22", {VK_FORMAT_BC2_UNORM_BLOCK, "BC2", pairs(alphas, colorBlocks())});
    const std::vector<Bytes> bc3 = pairs(unsignedBlocks(), colorBlocks());
    addBlocks(input, "T22", {VK_FORMAT_BC3_UNORM_BLOCK, "BC3", bc3});
    addBlocks(input, "T22", {VK_FORMAT_BC3_SRGB_BLOCK, "BC3 sRGB", bc3, Light::srgb});
    addBlocks(input, "T22", {VK_FORMAT_BC5_UNORM_BLOCK, "BC5", pairs(unsignedBlocks(), unsignedBlocks())});
    addBlocks(input, "T22", {VK_FORMAT_BC5_SNORM_BLOCK, "BC5 signed", pairs(signedBlocks(), signedBlocks())});
}

void t23(CaseInput& input) {
    std::mt19937_64 random(23);
    // Five bits choose between 14 modes of BC6H; eighteen values are reserved or modes of two bits.
    std::vector<Bytes> bc6h;
    for (uint32_t mode = 0; mode < 32; ++mode) {
        for (Bytes& block : fillings(random)) {
            setBits(block, 0, 5, mode);
            bc6h.push_back(block);
        }
    }
    addBlocks(input, "T23", {VK_FORMAT_BC6H_UFLOAT_BLOCK, "BC6H", bc6h, Light::halves});
    addBlocks(input, "T23", {VK_FORMAT_BC6H_SFLOAT_BLOCK, "BC6H signed", bc6h, Light::halves});
    // Zeros before a one choose the mode of BC7; eight of them are reserved.
    std::vector<Bytes> bc7;
    for (uint32_t mode = 0; mode <= 8; ++mode) {
        for (Bytes& block : fillings(random)) {
            setBits(block, 0, std::min(mode + 1, 8u), mode < 8 ? 1u << mode : 0);
            bc7.push_back(block);
        }
    }
    addBlocks(input, "T23", {VK_FORMAT_BC7_UNORM_BLOCK, "BC7", bc7});
    addBlocks(input, "T23", {VK_FORMAT_BC7_SRGB_BLOCK, "BC7 sRGB", bc7, Light::srgb});
}

void t24(CaseInput& input) {
    const struct {
        VkFormat unorm, srgb;
        const char* name;
    } footprints[] = {{VK_FORMAT_ASTC_4x4_UNORM_BLOCK, VK_FORMAT_ASTC_4x4_SRGB_BLOCK, "ASTC 4x4"},
                      {VK_FORMAT_ASTC_6x5_UNORM_BLOCK, VK_FORMAT_ASTC_6x5_SRGB_BLOCK, "ASTC 6x5"},
                      {VK_FORMAT_ASTC_8x8_UNORM_BLOCK, VK_FORMAT_ASTC_8x8_SRGB_BLOCK, "ASTC 8x8"},
                      {VK_FORMAT_ASTC_12x12_UNORM_BLOCK, VK_FORMAT_ASTC_12x12_SRGB_BLOCK, "ASTC 12x12"}};
    std::mt19937_64 random(24);
    for (const auto& footprint : footprints) {
        const std::vector<Bytes> blocks = astcBlocks(footprint.unorm, random);
        addBlocks(input, "T24", {footprint.unorm, footprint.name, blocks});
        addBlocks(input, "T24_srgb", {footprint.srgb, footprint.name, blocks, Light::srgb});
    }
}

}  // namespace vernier::conformance::hardcases
