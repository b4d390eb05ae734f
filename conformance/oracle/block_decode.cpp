#include "conformance/oracle/block_decode.h"

#include "conformance/oracle/astc_decode.h"
#include "conformance/oracle/bptc_decode.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vernier::conformance::exact {
namespace {

/// What a format's blocks are made of, from the first byte on.
enum class Layout : uint8_t { bc1, bc1Alpha, bc2, bc3, bc4, bc5, etc2, etc2Punch, etc2Eac, eac, eac2, bc6h, bc7, astc };

struct BlockFormat {
    VkFormat format;
    Layout layout;
    bool isSigned = false, srgb = false;
};

constexpr BlockFormat kFormats[] = {
    {VK_FORMAT_BC1_RGB_UNORM_BLOCK, Layout::bc1},
    {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, Layout::bc1Alpha},
    {VK_FORMAT_BC2_UNORM_BLOCK, Layout::bc2},
    {VK_FORMAT_BC3_UNORM_BLOCK, Layout::bc3},
    {VK_FORMAT_BC3_SRGB_BLOCK, Layout::bc3, false, true},
    {VK_FORMAT_BC4_UNORM_BLOCK, Layout::bc4},
    {VK_FORMAT_BC4_SNORM_BLOCK, Layout::bc4, true},
    {VK_FORMAT_BC5_UNORM_BLOCK, Layout::bc5},
    {VK_FORMAT_BC5_SNORM_BLOCK, Layout::bc5, true},
    {VK_FORMAT_BC6H_UFLOAT_BLOCK, Layout::bc6h},
    {VK_FORMAT_BC6H_SFLOAT_BLOCK, Layout::bc6h, true},
    {VK_FORMAT_BC7_UNORM_BLOCK, Layout::bc7},
    {VK_FORMAT_BC7_SRGB_BLOCK, Layout::bc7, false, true},
    {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, Layout::etc2},
    {VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, Layout::etc2Punch},
    {VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, Layout::etc2Eac},
    {VK_FORMAT_EAC_R11_UNORM_BLOCK, Layout::eac},
    {VK_FORMAT_EAC_R11G11_UNORM_BLOCK, Layout::eac2},
};

/// Vulkan numbers the footprints of ASTC from small to large, each without sRGB and with it.
constexpr BlockFormat kAstc[] = {{VK_FORMAT_ASTC_4x4_UNORM_BLOCK, Layout::astc},
                                 {VK_FORMAT_ASTC_4x4_SRGB_BLOCK, Layout::astc, false, true}};
constexpr VkExtent2D kAstcExtents[] = {{4, 4}, {5, 4},  {5, 5},  {6, 5},  {6, 6},   {8, 5},   {8, 6},
                                       {8, 8}, {10, 5}, {10, 6}, {10, 8}, {10, 10}, {12, 10}, {12, 12}};

bool isAstc(VkFormat format) {
    return format >= VK_FORMAT_ASTC_4x4_UNORM_BLOCK && format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
}

const BlockFormat* find(VkFormat format) {
    if (isAstc(format)) return &kAstc[(format - VK_FORMAT_ASTC_4x4_UNORM_BLOCK) % 2];
    const auto found = std::ranges::find(kFormats, format, &BlockFormat::format);
    return found == std::end(kFormats) ? nullptr : found;
}

uint64_t littleEndian(std::span<const std::byte> bytes) {
    uint64_t word = 0;
    for (size_t i = 0; i < 8; ++i) word |= std::to_integer<uint64_t>(bytes[i]) << (8 * i);
    return word;
}

uint64_t bigEndian(std::span<const std::byte> bytes) {
    uint64_t word = 0;
    for (size_t i = 0; i < 8; ++i) word = word << 8 | std::to_integer<uint64_t>(bytes[i]);
    return word;
}

// ---- BC1 to BC5 ----

// Direct3D 11.3 Functional Specification, "Error Tolerance" of BC1 to BC5: an interpolated value may be off by a code
// of eight bits and 3 % of the distance between the end points. The Khronos specification names no precision.
Interval blended(double first, double second, double weight, double code = 1.0 / 255) {
    const double value = first + (second - first) * weight;
    const double slack = code + 0.03 * std::abs(second - first);
    return {value, value - slack, value + slack};
}

using Rgb = std::array<double, 3>;

Rgb fiveSixFive(uint64_t code) {
    return {static_cast<double>(code >> 11 & 31) / 31, static_cast<double>(code >> 5 & 63) / 63,
            static_cast<double>(code & 31) / 31};
}

/// `threeColors`: the mode of three colours and black is chosen by the order of the end points; it is that of BC1
/// alone.
Color bc1Texel(uint64_t word, uint32_t texel, bool threeColors, bool punchThrough) {
    const uint64_t first = word & 0xffff, second = word >> 16 & 0xffff, index = word >> (32 + 2 * texel) & 3;
    const Rgb a = fiveSixFive(first), b = fiveSixFive(second);
    Color color{0.0, 0.0, 0.0, 1.0};
    const bool four = !threeColors || first > second;
    if (!four && index == 3) {
        if (punchThrough) color[3] = 0.0;
        return color;
    }
    for (size_t c = 0; c < 3; ++c) {
        if (index < 2) {
            // Bits repeated up to eight are less than a code of eight bits away.
            const double end = index == 0 ? a[c] : b[c];
            color[c] = blended(end, end, 0);
        } else if (four) {
            color[c] = blended(a[c], b[c], index == 2 ? 1.0 / 3 : 2.0 / 3);
        } else {
            color[c] = blended(a[c], b[c], 0.5);
        }
    }
    return color;
}

/// RGTC: the order of the end points chooses between six interpolated values and four with the ends of the range.
Interval bc4Value(uint64_t word, uint32_t texel, bool isSigned) {
    const auto end = [&](uint64_t code) {
        if (!isSigned) return static_cast<double>(code);
        return std::max(-127.0, static_cast<double>(static_cast<int8_t>(code)));
    };
    const double scale = isSigned ? 127 : 255, lowest = isSigned ? -1 : 0;
    const double a = end(word & 255), b = end(word >> 8 & 255);
    const uint64_t index = word >> (16 + 3 * texel) & 7;
    if (index < 2) return (index == 0 ? a : b) / scale;
    const bool six = isSigned ? static_cast<int8_t>(word & 255) > static_cast<int8_t>(word >> 8 & 255) : a > b;
    if (!six && index >= 6) return index == 6 ? lowest : 1.0;
    return blended(a / scale, b / scale, static_cast<double>(index - 1) / (six ? 7 : 5), 1 / scale);
}

// ---- ETC2 and EAC ----

constexpr int kModifiers[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
constexpr int kDistances[8] = {3, 6, 11, 16, 23, 32, 41, 64};
constexpr int kEacModifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}};

using Ints = std::array<int, 3>;

/// Bits `high` down to `low`.
int field(uint64_t word, int high, int low) {
    return static_cast<int>(word >> low & ((uint64_t{1} << (high - low + 1)) - 1));
}

/// `bits` bits repeated up to eight.
int expanded(int value, int bits) {
    return bits >= 8 ? value : value << (8 - bits) | value >> (2 * bits - 8);
}

Color colorOf(const Ints& codes) {
    Color color{0.0, 0.0, 0.0, 1.0};
    for (size_t c = 0; c < 3; ++c) color[c] = std::clamp(codes[c], 0, 255) / 255.0;
    return color;
}

Ints shifted(const Ints& base, int by) {
    return {base[0] + by, base[1] + by, base[2] + by};
}

Color etc2Texel(uint64_t word, uint32_t x, uint32_t y, bool punchThrough) {
    const uint32_t texel = x * 4 + y;  // columns first
    const int index = field(word, static_cast<int>(texel) + 16, static_cast<int>(texel) + 16) << 1 |
                      field(word, static_cast<int>(texel), static_cast<int>(texel));
    // With punch-through alpha this bit says that all texels are opaque, and blocks are always differential.
    const bool bit33 = field(word, 33, 33) != 0, transparent = punchThrough && !bit33 && index == 2;
    const Color clear{0.0, 0.0, 0.0, 0.0};
    const auto subBlocks = [&](const Ints& first, const Ints& second) {
        const bool flip = field(word, 32, 32) != 0, isSecond = flip ? y >= 2 : x >= 2;
        const int* modifiers = kModifiers[isSecond ? field(word, 36, 34) : field(word, 39, 37)];
        int by = modifiers[index & 1] * (index >= 2 ? -1 : 1);
        if (punchThrough && !bit33 && index == 0) by = 0;
        return transparent ? clear : colorOf(shifted(isSecond ? second : first, by));
    };
    if (!bit33 && !punchThrough) {
        Ints first, second;
        for (int c = 0; c < 3; ++c) {
            first[static_cast<size_t>(c)] = expanded(field(word, 63 - 8 * c, 60 - 8 * c), 4);
            second[static_cast<size_t>(c)] = expanded(field(word, 59 - 8 * c, 56 - 8 * c), 4);
        }
        return subBlocks(first, second);
    }
    Ints base, sum;
    for (int c = 0; c < 3; ++c) {
        const int delta = field(word, 58 - 8 * c, 56 - 8 * c);
        base[static_cast<size_t>(c)] = field(word, 63 - 8 * c, 59 - 8 * c);
        sum[static_cast<size_t>(c)] = base[static_cast<size_t>(c)] + (delta >= 4 ? delta - 8 : delta);
    }
    const auto inRange = [](int value) { return value >= 0 && value <= 31; };
    if (!inRange(sum[0])) {  // T
        if (transparent) return clear;
        const Ints first{expanded(field(word, 60, 59) << 2 | field(word, 57, 56), 4), expanded(field(word, 55, 52), 4),
                         expanded(field(word, 51, 48), 4)};
        const Ints second{expanded(field(word, 47, 44), 4), expanded(field(word, 43, 40), 4),
                          expanded(field(word, 39, 36), 4)};
        const int distance = kDistances[field(word, 35, 34) << 1 | field(word, 32, 32)];
        if (index == 0) return colorOf(first);
        return colorOf(shifted(second, index == 1 ? distance : index == 3 ? -distance : 0));
    }
    if (!inRange(sum[1])) {  // H
        if (transparent) return clear;
        const Ints first{field(word, 62, 59), field(word, 58, 56) << 1 | field(word, 52, 52),
                         field(word, 51, 51) << 3 | field(word, 49, 47)};
        const Ints second{field(word, 46, 43), field(word, 42, 39), field(word, 38, 35)};
        const int distance =
            kDistances[field(word, 34, 34) << 2 | field(word, 32, 32) << 1 | (first >= second ? 1 : 0)];
        Ints chosen = index < 2 ? first : second;
        for (int& c : chosen) c = expanded(c, 4);
        return colorOf(shifted(chosen, (index & 1) != 0 ? -distance : distance));
    }
    if (!inRange(sum[2])) {  // planar, opaque whatever bit 33 says
        const Ints origin{expanded(field(word, 62, 57), 6), expanded(field(word, 56, 56) << 6 | field(word, 54, 49), 7),
                          expanded(field(word, 48, 48) << 5 | field(word, 44, 43) << 3 | field(word, 41, 39), 6)};
        const Ints across{expanded(field(word, 38, 34) << 1 | field(word, 32, 32), 6), expanded(field(word, 31, 25), 7),
                          expanded(field(word, 24, 19), 6)};
        const Ints down{expanded(field(word, 18, 13), 6), expanded(field(word, 12, 6), 7),
                        expanded(field(word, 5, 0), 6)};
        Ints result;
        for (size_t c = 0; c < 3; ++c) {
            result[c] = (static_cast<int>(x) * (across[c] - origin[c]) + static_cast<int>(y) * (down[c] - origin[c]) +
                         4 * origin[c] + 2) >>
                        2;
        }
        return colorOf(result);
    }
    for (size_t c = 0; c < 3; ++c) {
        base[c] = expanded(base[c], 5);
        sum[c] = expanded(sum[c], 5);
    }
    return subBlocks(base, sum);
}

int eacModifier(uint64_t word, uint32_t x, uint32_t y) {
    const int low = 45 - 3 * static_cast<int>(x * 4 + y);
    return kEacModifiers[field(word, 51, 48)][field(word, low + 2, low)];
}

double eacAlpha(uint64_t word, uint32_t x, uint32_t y) {
    return std::clamp(field(word, 63, 56) + eacModifier(word, x, y) * field(word, 55, 52), 0, 255) / 255.0;
}

double eac11(uint64_t word, uint32_t x, uint32_t y) {
    const int multiplier = field(word, 55, 52), step = multiplier == 0 ? 1 : 8 * multiplier;
    return std::clamp(field(word, 63, 56) * 8 + 4 + eacModifier(word, x, y) * step, 0, 2047) / 2047.0;
}

}  // namespace

bool isDecodedBlockFormat(VkFormat format) {
    return find(format) != nullptr;
}

uint32_t blockBytes(VkFormat format) {
    switch (find(format)->layout) {
        case Layout::bc2:
        case Layout::bc3:
        case Layout::bc5:
        case Layout::etc2Eac:
        case Layout::eac2:
        case Layout::bc6h:
        case Layout::bc7:
        case Layout::astc:
            return 16;
        default:
            return 8;
    }
}

VkExtent2D blockExtent(VkFormat format) {
    return isAstc(format) ? kAstcExtents[(format - VK_FORMAT_ASTC_4x4_UNORM_BLOCK) / 2] : VkExtent2D{4, 4};
}

Color decodeBlockTexel(VkFormat format, std::span<const std::byte> block, uint32_t x, uint32_t y) {
    const BlockFormat& how = *find(format);
    const uint32_t texel = y * 4 + x;  // rows first, of all but ETC2 and EAC
    const bool two = block.size() > 8;
    const auto second = two ? block.subspan(8) : block;
    Color color{0.0, 0.0, 0.0, 1.0};
    switch (how.layout) {
        case Layout::bc1:
        case Layout::bc1Alpha:
            color = bc1Texel(littleEndian(block), texel, true, how.layout == Layout::bc1Alpha);
            break;
        case Layout::bc2:
            color = bc1Texel(littleEndian(second), texel, false, false);
            color[3] = static_cast<double>(littleEndian(block) >> (4 * texel) & 15) / 15;
            break;
        case Layout::bc3:
            color = bc1Texel(littleEndian(second), texel, false, false);
            color[3] = bc4Value(littleEndian(block), texel, false);
            break;
        case Layout::bc4:
            color[0] = bc4Value(littleEndian(block), texel, how.isSigned);
            break;
        case Layout::bc5:
            color[0] = bc4Value(littleEndian(block), texel, how.isSigned);
            color[1] = bc4Value(littleEndian(second), texel, how.isSigned);
            break;
        case Layout::etc2:
        case Layout::etc2Punch:
            color = etc2Texel(bigEndian(block), x, y, how.layout == Layout::etc2Punch);
            break;
        case Layout::etc2Eac:
            color = etc2Texel(bigEndian(second), x, y, false);
            color[3] = eacAlpha(bigEndian(block), x, y);
            break;
        case Layout::eac:
            color[0] = eac11(bigEndian(block), x, y);
            break;
        case Layout::eac2:
            color[0] = eac11(bigEndian(block), x, y);
            color[1] = eac11(bigEndian(second), x, y);
            break;
        case Layout::bc6h:
            return bc6hTexel(block, texel, how.isSigned);
        case Layout::bc7:
            color = bc7Texel(block, texel);
            break;
        case Layout::astc: {
            const VkExtent2D extent = blockExtent(format);
            const auto codes = astcTexel(block, extent.width, extent.height, x, y, how.srgb);
            // "Weight Application": with sRGB the upper eight bits of R, G and B.
            for (size_t c = 0; c < 4; ++c) color[c] = how.srgb && c < 3 ? (codes[c] >> 8) / 255.0 : astcHalf(codes[c]);
            break;
        }
    }
    const double low = how.isSigned ? -1 : 0;
    for (Interval& c : color) c = c.clamped(low, 1);
    if (how.srgb) {
        for (size_t c = 0; c < 3; ++c)
            color[c] = {srgbDecode(color[c].value), srgbDecode(color[c].low), srgbDecode(color[c].high)};
    }
    return color;
}

}  // namespace vernier::conformance::exact
