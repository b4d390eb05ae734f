#include "conformance/oracle/bptc_decode.h"

#include "conformance/oracle/pixel_format.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace vernier::conformance::exact {
namespace {

// Which subset each texel belongs to, texel 0 in the lowest bits: one bit for two subsets, two for three.
constexpr uint16_t kTwoSubsets[64] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa, 0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696,
    0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc, 0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720,
    0xc936, 0x936c, 0x39c6, 0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22};
constexpr uint32_t kThreeSubsets[64] = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050,
    0xaa550000, 0xaa555500, 0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250,
    0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0, 0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500,
    0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414, 0x50a4a450, 0x6a5a0200,
    0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600,
    0xaa444444, 0x54a854a8, 0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000,
    0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000, 0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254};
// The texels whose indices lack their highest bit, beside texel 0: of the second of two, and of the second and third of
// three subsets.
constexpr uint8_t kAnchorOfTwo[64] = {15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15,
                                      15, 2,  8,  2,  2,  8,  8,  15, 2,  8,  2,  2,  8,  8,  2,  2,
                                      15, 15, 6,  8,  2,  8,  15, 15, 2,  8,  2,  2,  2,  15, 15, 6,
                                      6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2,  15};
constexpr uint8_t kSecondOfThree[64] = {
    3, 3,  15, 15, 8, 3,  15, 15, 8,  8, 6,  6, 6,  5,  3,  3,  3, 3,  8, 15, 3, 3, 6, 10, 5, 8,  8, 6,  8,  5,  15, 15,
    8, 15, 3,  5,  6, 10, 8,  15, 15, 3, 15, 5, 15, 15, 15, 15, 3, 15, 5, 5,  5, 8, 5, 10, 5, 10, 8, 13, 15, 12, 3,  3};
constexpr uint8_t kThirdOfThree[64] = {15, 8, 8,  3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,
                                       15, 8, 15, 3,  15, 8,  15, 8,  3,  15, 6,  10, 15, 15, 10, 8,
                                       15, 3, 15, 10, 10, 8,  9,  10, 6,  15, 8,  15, 3,  6,  6,  8,
                                       15, 3, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

/// Sixty-fourths of the second end point, by the bits of an index.
int weightOf(uint32_t index, uint32_t bits) {
    constexpr int kTwo[] = {0, 21, 43, 64};
    constexpr int kThree[] = {0, 9, 18, 27, 37, 46, 55, 64};
    constexpr int kFour[] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
    return bits == 2 ? kTwo[index] : bits == 3 ? kThree[index] : kFour[index];
}

int64_t interpolated(int64_t first, int64_t second, int weight) {
    return (first * (64 - weight) + second * weight + 32) >> 6;
}

/// Reads fields one after the other, from the lowest bit of the first byte on.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> block) : block_(block) {}

    uint32_t take(uint32_t bits) {
        const auto value = static_cast<uint32_t>(extractBits(block_.data(), at_, bits));
        at_ += bits;
        return value;
    }
    void skip(uint32_t bits) { at_ += bits; }

  private:
    std::span<const std::byte> block_;
    uint32_t at_ = 0;
};

uint32_t subsetOf(uint32_t subsets, uint32_t partition, uint32_t texel) {
    if (subsets == 1) return 0;
    return subsets == 2 ? kTwoSubsets[partition] >> texel & 1u : kThreeSubsets[partition] >> 2 * texel & 3u;
}

bool isAnchor(uint32_t subsets, uint32_t partition, uint32_t texel) {
    if (texel == 0) return true;
    if (subsets == 2) return texel == kAnchorOfTwo[partition];
    return subsets == 3 && (texel == kSecondOfThree[partition] || texel == kThirdOfThree[partition]);
}

/// The index of one texel in a run of sixteen; leaves the reader behind the run.
uint32_t takeIndex(Reader& reader, uint32_t bits, uint32_t subsets, uint32_t partition, uint32_t texel) {
    uint32_t index = 0;
    for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t value = reader.take(isAnchor(subsets, partition, i) ? bits - 1 : bits);
        if (i == texel) index = value;
    }
    return index;
}

// ---- BC7 ----

struct Bc7Mode {
    uint32_t subsets, partitionBits, rotationBits, selectionBits, colorBits, alphaBits;
    uint32_t lowBitsEach, lowBitsShared;  // the bit below an end point: one for each, or one for both of a subset
    uint32_t indexBits, secondIndexBits;
};
constexpr Bc7Mode kBc7Modes[8] = {{3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
                                  {3, 6, 0, 0, 5, 0, 0, 0, 2, 0}, {2, 6, 0, 0, 7, 0, 1, 0, 2, 0},
                                  {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
                                  {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0}};

/// `bits` bits repeated up to eight.
uint32_t toEightBits(uint32_t value, uint32_t bits) {
    const uint32_t high = value << (8 - bits);
    return high | high >> bits;
}

// ---- BC6H ----

/// Where the bits of a mode's end points are: pairs of a letter and a digit (r0 the red of the first end point) with
/// the range of bits that follows, the lowest bit first: "r0:0-9", or the highest first where the order is turned
/// round.
struct Bc6hMode {
    uint32_t code, codeBits;
    bool twoSubsets, deltas;
    uint32_t endBits;                   // of the first end point
    std::array<uint32_t, 3> deltaBits;  // of the others
    std::string_view layout;
};
constexpr Bc6hMode kBc6hModes[] = {
    {0x00,
     2,
     true,
     true,
     10,
     {5, 5, 5},
     "g2:4 b2:4 b3:4 r0:0-9 g0:0-9 b0:0-9 r1:0-4 g3:4 g2:0-3 g1:0-4 b3:0 g3:0-3 b1:0-4 b3:1 b2:0-3 r2:0-4 b3:2 r3:0-4 "
     "b3:3"},
    {0x01,
     2,
     true,
     true,
     7,
     {6, 6, 6},
     "g2:5 g3:4 g3:5 r0:0-6 b3:0 b3:1 b2:4 g0:0-6 b2:5 b3:2 g2:4 b0:0-6 b3:3 b3:5 b3:4 r1:0-5 g2:0-3 g1:0-5 g3:0-3 "
     "b1:0-5 b2:0-3 r2:0-5 r3:0-5"},
    {0x02,
     5,
     true,
     true,
     11,
     {5, 4, 4},
     "r0:0-9 g0:0-9 b0:0-9 r1:0-4 r0:10 g2:0-3 g1:0-3 g0:10 b3:0 g3:0-3 b1:0-3 b0:10 b3:1 b2:0-3 r2:0-4 b3:2 r3:0-4 "
     "b3:3"},
    {0x06,
     5,
     true,
     true,
     11,
     {4, 5, 4},
     "r0:0-9 g0:0-9 b0:0-9 r1:0-3 r0:10 g3:4 g2:0-3 g1:0-4 g0:10 g3:0-3 b1:0-3 b0:10 b3:1 b2:0-3 r2:0-3 b3:0 b3:2 "
     "r3:0-3 g2:4 b3:3"},
    {0x0a,
     5,
     true,
     true,
     11,
     {4, 4, 5},
     "r0:0-9 g0:0-9 b0:0-9 r1:0-3 r0:10 b2:4 g2:0-3 g1:0-3 g0:10 b3:0 g3:0-3 b1:0-4 b0:10 b2:0-3 r2:0-3 b3:1 b3:2 "
     "r3:0-3 b3:4 b3:3"},
    {0x0e,
     5,
     true,
     true,
     9,
     {5, 5, 5},
     "r0:0-8 b2:4 g0:0-8 g2:4 b0:0-8 b3:4 r1:0-4 g3:4 g2:0-3 g1:0-4 b3:0 g3:0-3 b1:0-4 b3:1 b2:0-3 r2:0-4 b3:2 r3:0-4 "
     "b3:3"},
    {0x12,
     5,
     true,
     true,
     8,
     {6, 5, 5},
     "r0:0-7 g3:4 b2:4 g0:0-7 b3:2 g2:4 b0:0-7 b3:3 b3:4 r1:0-5 g2:0-3 g1:0-4 b3:0 g3:0-3 b1:0-4 b3:1 b2:0-3 r2:0-5 "
     "r3:0-5"},
    {0x16,
     5,
     true,
     true,
     8,
     {5, 6, 5},
     "r0:0-7 b3:0 b2:4 g0:0-7 g2:5 g2:4 b0:0-7 g3:5 b3:4 r1:0-4 g3:4 g2:0-3 g1:0-5 g3:0-3 b1:0-4 b3:1 b2:0-3 r2:0-4 "
     "b3:2 r3:0-4 b3:3"},
    {0x1a,
     5,
     true,
     true,
     8,
     {5, 5, 6},
     "r0:0-7 b3:1 b2:4 g0:0-7 b2:5 g2:4 b0:0-7 b3:5 b3:4 r1:0-4 g3:4 g2:0-3 g1:0-4 b3:0 g3:0-3 b1:0-5 b2:0-3 r2:0-4 "
     "b3:2 r3:0-4 b3:3"},
    {0x1e,
     5,
     true,
     false,
     6,
     {6, 6, 6},
     "r0:0-5 g3:4 b3:0 b3:1 b2:4 g0:0-5 g2:5 b2:5 b3:2 g2:4 b0:0-5 g3:5 b3:3 b3:5 b3:4 r1:0-5 g2:0-3 g1:0-5 g3:0-3 "
     "b1:0-5 b2:0-3 r2:0-5 r3:0-5"},
    {0x03, 5, false, false, 10, {10, 10, 10}, "r0:0-9 g0:0-9 b0:0-9 r1:0-9 g1:0-9 b1:0-9"},
    {0x07, 5, false, true, 11, {9, 9, 9}, "r0:0-9 g0:0-9 b0:0-9 r1:0-8 r0:10 g1:0-8 g0:10 b1:0-8 b0:10"},
    {0x0b, 5, false, true, 12, {8, 8, 8}, "r0:0-9 g0:0-9 b0:0-9 r1:0-7 r0:11-10 g1:0-7 g0:11-10 b1:0-7 b0:11-10"},
    {0x0f, 5, false, true, 16, {4, 4, 4}, "r0:0-9 g0:0-9 b0:0-9 r1:0-3 r0:15-10 g1:0-3 g0:15-10 b1:0-3 b0:15-10"}};

using EndPoints = std::array<std::array<int64_t, 3>, 4>;  // by end point and channel

EndPoints takeEndPoints(Reader& reader, std::string_view layout) {
    EndPoints ends{};
    const auto number = [&layout] {
        int value = 0;
        while (!layout.empty() && layout[0] >= '0' && layout[0] <= '9') {
            value = value * 10 + (layout[0] - '0');
            layout.remove_prefix(1);
        }
        return value;
    };
    while (!layout.empty()) {
        const size_t channel = layout[0] == 'r' ? 0 : layout[0] == 'g' ? 1 : 2;
        const auto end = static_cast<size_t>(layout[1] - '0');
        layout.remove_prefix(3);
        const int first = number();
        int last = first;
        if (!layout.empty() && layout[0] == '-') {
            layout.remove_prefix(1);
            last = number();
        }
        const int step = last < first ? -1 : 1;
        for (int bit = first; bit != last + step; bit += step) ends[end][channel] |= int64_t{reader.take(1)} << bit;
        if (!layout.empty()) layout.remove_prefix(1);
    }
    return ends;
}

int64_t signExtended(int64_t value, uint32_t bits) {
    const int64_t sign = int64_t{1} << (bits - 1);
    return ((value & (2 * sign - 1)) ^ sign) - sign;
}

int64_t unquantised(int64_t value, uint32_t bits, bool isSigned) {
    if (!isSigned) {
        if (bits >= 15 || value == 0) return value;
        return value == (int64_t{1} << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
    }
    if (bits >= 16 || value == 0) return value;
    const int64_t size = value < 0 ? -value : value, most = (int64_t{1} << (bits - 1)) - 1;
    const int64_t result = size >= most ? 0x7fff : ((size << 15) + 0x4000) >> (bits - 1);
    return value < 0 ? -result : result;
}

/// The half float that an interpolated number stands for.
double halfOf(int64_t value, bool isSigned) {
    const Component half{0, 0, 16, Encoding::sfloat};
    if (!isSigned) return decodeNumber(half, static_cast<uint64_t>(value * 31 >> 6));
    const int64_t size = (value < 0 ? -value : value) * 31 >> 5;
    return decodeNumber(half, static_cast<uint64_t>(size | (value < 0 ? 0x8000 : 0)));
}

}  // namespace

Color bc7Texel(std::span<const std::byte> block, uint32_t texel) {
    Reader reader(block);
    uint32_t number = 0;
    while (number < 8 && reader.take(1) == 0) ++number;
    if (number == 8) return {0.0, 0.0, 0.0, 0.0};  // reserved
    const Bc7Mode& mode = kBc7Modes[number];
    const uint32_t partition = reader.take(mode.partitionBits), rotation = reader.take(mode.rotationBits),
                   selection = reader.take(mode.selectionBits), ends = 2 * mode.subsets;
    std::array<std::array<uint32_t, 4>, 6> points{};
    for (size_t c = 0; c < 4; ++c) {
        const uint32_t bits = c == 3 ? mode.alphaBits : mode.colorBits;
        for (uint32_t e = 0; e < ends && bits != 0; ++e) points[e][c] = reader.take(bits);
    }
    std::array<uint32_t, 6> low{};
    for (uint32_t e = 0; e < ends; ++e) {
        if (mode.lowBitsEach != 0) low[e] = reader.take(1);
        if (mode.lowBitsShared != 0) low[e] = e % 2 == 0 ? reader.take(1) : low[e - 1];
    }
    const uint32_t extra = mode.lowBitsEach + mode.lowBitsShared;
    for (uint32_t e = 0; e < ends; ++e) {
        for (size_t c = 0; c < 4; ++c) {
            const uint32_t bits = c == 3 ? mode.alphaBits : mode.colorBits;
            points[e][c] =
                bits == 0 ? 255 : toEightBits(points[e][c] << extra | (extra != 0 ? low[e] : 0), bits + extra);
        }
    }
    const uint32_t index = takeIndex(reader, mode.indexBits, mode.subsets, partition, texel);
    int colorWeight = weightOf(index, mode.indexBits), alphaWeight = colorWeight;
    if (mode.secondIndexBits != 0) {
        alphaWeight = weightOf(takeIndex(reader, mode.secondIndexBits, 1, 0, texel), mode.secondIndexBits);
        if (selection != 0) std::swap(colorWeight, alphaWeight);
    }
    const uint32_t subset = subsetOf(mode.subsets, partition, texel);
    std::array<int64_t, 4> codes{};
    for (size_t c = 0; c < 4; ++c)
        codes[c] = interpolated(points[2 * subset][c], points[2 * subset + 1][c], c == 3 ? alphaWeight : colorWeight);
    if (rotation != 0) std::swap(codes[3], codes[rotation - 1]);
    Color color;
    for (size_t c = 0; c < 4; ++c) color[c] = static_cast<double>(codes[c]) / 255;
    return color;
}

Color bc6hTexel(std::span<const std::byte> block, uint32_t texel, bool isSigned) {
    const auto found = std::ranges::find_if(
        kBc6hModes, [&](const Bc6hMode& mode) { return extractBits(block.data(), 0, mode.codeBits) == mode.code; });
    if (found == std::end(kBc6hModes)) return {0.0, 0.0, 0.0, 1.0};  // reserved
    Reader reader(block);
    reader.skip(found->codeBits);
    EndPoints ends = takeEndPoints(reader, found->layout);
    const uint32_t subsets = found->twoSubsets ? 2 : 1, partition = found->twoSubsets ? reader.take(5) : 0;
    for (size_t c = 0; c < 3; ++c) {
        if (isSigned) ends[0][c] = signExtended(ends[0][c], found->endBits);
        for (size_t e = 1; e < 2 * subsets; ++e) {
            if (isSigned || found->deltas) ends[e][c] = signExtended(ends[e][c], found->deltaBits[c]);
            if (!found->deltas) continue;
            const int64_t sum = ends[0][c] + ends[e][c], mask = (int64_t{1} << found->endBits) - 1;
            ends[e][c] = isSigned ? signExtended(sum, found->endBits) : sum & mask;
        }
    }
    const uint32_t bits = found->twoSubsets ? 3 : 4;
    const int weight = weightOf(takeIndex(reader, bits, subsets, partition, texel), bits);
    const uint32_t subset = subsetOf(subsets, partition, texel);
    Color color{0.0, 0.0, 0.0, 1.0};
    for (size_t c = 0; c < 3; ++c) {
        const int64_t first = unquantised(ends[2 * subset][c], found->endBits, isSigned),
                      second = unquantised(ends[2 * subset + 1][c], found->endBits, isSigned);
        color[c] = halfOf(interpolated(first, second, weight), isSigned);
    }
    return color;
}

}  // namespace vernier::conformance::exact
