// ASTC, LDR profile ("ASTC Compressed Texture Image Formats" of the Khronos Data Format Specification).
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include "runtime/format/astc_sequence.h"
#include "runtime/format/block.h"
#include "runtime/format/convert.h"

namespace vernier {
namespace {

using Color = std::array<int32_t, 4>;

/// The footprint, and whether R, G and B are sRGB codes of 8 bits.
struct Target {
    uint32_t width, height;
    bool srgb;
};

/// "Weight Application": a UNORM16 component as a half float, rounded towards zero.
uint16_t halfOfUnorm16(uint32_t c) {
    if (c == 65535) return 0x3c00;
    const auto exponent = static_cast<uint32_t>(std::bit_width(c));  // c < 2^exponent; the half's exponent field less 2
    if (exponent <= 2) return static_cast<uint16_t>(c << 8);         // denormal: c * 2^-16 = (c << 8) * 2^-24
    const uint32_t mantissa = exponent > 11 ? c >> (exponent - 11) : c << (11 - exponent);
    return static_cast<uint16_t>((exponent - 2) << 10 | (mantissa & 0x3ff));
}

void putUnorm16(const Target& target, void* texels, uint32_t texel, const std::array<uint32_t, 4>& color) {
    if (target.srgb) {
        float* const out = static_cast<float*>(texels) + 4 * texel;
        for (uint32_t c = 0; c < 3; ++c) out[c] = kSrgbToLinear[color[c] >> 8];
        out[3] = decodeHalf(halfOfUnorm16(color[3]));
    } else {
        for (uint32_t c = 0; c < 4; ++c) static_cast<uint16_t*>(texels)[4 * texel + c] = halfOfUnorm16(color[c]);
    }
}

constexpr std::array<uint32_t, 4> kErrorColor{65535, 0, 65535, 65535};

void fill(const Target& target, void* texels, const std::array<uint32_t, 4>& color) {
    for (uint32_t i = 0; i < target.width * target.height; ++i) putUnorm16(target, texels, i, color);
}

/// The weight grid.
struct BlockMode {
    uint32_t width = 0, height = 0;
    bool dualPlane = false;
    AstcRange range{};
    uint32_t weightCount() const { return width * height * (dualPlane ? 2 : 1); }
};

/// "Block Mode", for 2D blocks; nothing for reserved modes and for grids that break a limit.
std::optional<BlockMode> readBlockMode(const BlockBits& block, const Target& target) {
    // By R, then H.
    constexpr AstcRange kRanges[8][2] = {{},
                                         {},
                                         {{0, 0, 1}, {0, 1, 1}},
                                         {{1, 0, 0}, {1, 0, 2}},
                                         {{0, 0, 2}, {0, 0, 4}},
                                         {{0, 1, 0}, {0, 1, 2}},
                                         {{1, 0, 1}, {1, 0, 3}},
                                         {{0, 0, 3}, {0, 0, 5}}};
    const uint32_t a = block.at(5, 2);
    const bool firstRows = block.at(0, 2) != 0;
    const uint32_t r = (firstRows ? block.at(0, 2) : block.at(2, 2)) << 1 | block.at(4, 1);
    BlockMode mode;
    bool high = block.at(9, 1) != 0;
    mode.dualPlane = block.at(10, 1) != 0;
    if (firstRows) {
        const uint32_t b = block.at(7, 2), oneBit = block.at(7, 1);
        switch (block.at(2, 2)) {
            case 0:
                mode.width = b + 4, mode.height = a + 2;
                break;
            case 1:
                mode.width = b + 8, mode.height = a + 2;
                break;
            case 2:
                mode.width = a + 2, mode.height = b + 8;
                break;
            default:
                mode.width = block.at(8, 1) != 0 ? oneBit + 2 : a + 2;
                mode.height = block.at(8, 1) != 0 ? a + 2 : oneBit + 6;
                break;
        }
    } else {
        switch (block.at(7, 2)) {
            case 0:
                mode.width = 12, mode.height = a + 2;
                break;
            case 1:
                mode.width = a + 2, mode.height = 12;
                break;
            case 2:
                mode.width = a + 6, mode.height = block.at(9, 2) + 6;
                mode.dualPlane = high = false;
                break;
            default:
                if (a >= 2) return {};
                mode.width = a == 0 ? 6 : 10, mode.height = a == 0 ? 10 : 6;
                break;
        }
    }
    if (r < 2) return {};
    mode.range = kRanges[r][high ? 1 : 0];
    const uint32_t bits = mode.range.size(mode.weightCount());
    const bool fits = mode.width <= target.width && mode.height <= target.height && mode.weightCount() <= 64;
    if (!fits || bits < 24 || bits > 96) return {};
    return mode;
}

/// Colour endpoint modes per partition, where the colour values lie, and the component of the second plane.
struct ColorLayout {
    uint32_t partitions = 1, partitionIndex = 0;
    std::array<uint32_t, 4> modes{};
    uint32_t valueCount = 0;
    uint32_t first = 17, bits = 0;
    uint32_t planeComponent = 4;  // 4: none
};

std::optional<ColorLayout> readColorLayout(const BlockBits& block, const BlockMode& mode) {
    ColorLayout layout;
    layout.partitions = block.at(11, 2) + 1;
    uint32_t end = 128 - mode.range.size(mode.weightCount());  // what lies below the weights
    if (layout.partitions == 1) {
        layout.modes[0] = block.at(13, 4);
    } else {
        layout.partitionIndex = block.at(13, 10);
        layout.first = 29;
        const uint32_t selector = block.at(23, 2);
        uint32_t modeBits = block.at(25, 4);
        if (selector == 0) {
            layout.modes.fill(modeBits);
        } else {
            const uint32_t extra = 3 * layout.partitions - 4;
            if (end < layout.first + extra) return {};
            end -= extra;
            modeBits |= block.at(end, extra) << 4;
            for (uint32_t i = 0; i < layout.partitions; ++i) {
                const uint32_t low = modeBits >> (layout.partitions + 2 * i) & 3;
                layout.modes[i] = (selector - 1 + (modeBits >> i & 1)) << 2 | low;
            }
        }
    }
    if (mode.dualPlane) {
        if (layout.partitions == 4 || end < layout.first + 2) return {};
        end -= 2;
        layout.planeComponent = block.at(end, 2);
    }
    for (uint32_t i = 0; i < layout.partitions; ++i) layout.valueCount += 2 * ((layout.modes[i] >> 2) + 1);
    if (end < layout.first) return {};
    layout.bits = end - layout.first;
    if (layout.valueCount > 18 || layout.bits < (13 * layout.valueCount + 4) / 5) return {};
    return layout;
}

/// The largest range that fits ("Data Size Determination"), unquantised.
std::array<int32_t, 18> readColorValues(const BlockBits& block, const ColorLayout& layout) {
    constexpr AstcRange kRanges[] = {{0, 0, 8}, {1, 0, 6}, {0, 1, 5}, {0, 0, 7}, {1, 0, 5}, {0, 1, 4},
                                     {0, 0, 6}, {1, 0, 4}, {0, 1, 3}, {0, 0, 5}, {1, 0, 3}, {0, 1, 2},
                                     {0, 0, 4}, {1, 0, 2}, {0, 1, 1}, {0, 0, 3}, {1, 0, 1}};
    const AstcRange* range = kRanges;
    while (range->size(layout.valueCount) > layout.bits) ++range;  // the last one fits: checked with the layout
    uint8_t raw[18];
    readAstcSequence(block, layout.first, *range, layout.valueCount, raw);
    std::array<int32_t, 18> values{};
    for (uint32_t i = 0; i < layout.valueCount; ++i) values[i] = unquantiseAstcColor(*range, raw[i]);
    return values;
}

struct Endpoints {
    Color e0{}, e1{};
    bool hdr = false;
};

Color blueContract(const Color& c) {
    return {(c[0] + c[2]) >> 1, (c[1] + c[2]) >> 1, c[2], c[3]};
}

void bitTransferSigned(int32_t& a, int32_t& b) {
    b = (b >> 1) | (a & 0x80);
    a = (a >> 1) & 0x3f;
    if ((a & 0x20) != 0) a -= 0x40;
}

/// Endpoints of the offset modes: e0, and e0 + d.
void setByOffset(Endpoints& ends, const Color& base, const Color& offset) {
    Color sum;
    for (size_t c = 0; c < 4; ++c) sum[c] = base[c] + offset[c];
    const bool contract = offset[0] + offset[1] + offset[2] < 0;
    ends.e0 = contract ? blueContract(sum) : base;
    ends.e1 = contract ? blueContract(base) : sum;
    for (Color* color : {&ends.e0, &ends.e1}) {
        for (int32_t& c : *color) c = clampToByte(c);
    }
}

void setDirect(Endpoints& ends, const Color& low, const Color& high) {
    const bool contract = high[0] + high[1] + high[2] < low[0] + low[1] + low[2];
    ends.e0 = contract ? blueContract(high) : low;
    ends.e1 = contract ? blueContract(low) : high;
}

/// "LDR Endpoint Decoding". v: the values of one partition.
Endpoints decodeEndpoints(uint32_t mode, const int32_t* values) {
    Endpoints ends;
    int32_t v[8];
    std::memcpy(v, values, sizeof(int32_t) * 2 * ((mode >> 2) + 1));
    switch (mode) {
        case 0:
            ends.e0 = {v[0], v[0], v[0], 255};
            ends.e1 = {v[1], v[1], v[1], 255};
            break;
        case 1: {
            const int32_t low = v[0] >> 2 | (v[1] & 0xc0), high = std::min(low + (v[1] & 0x3f), 255);
            ends.e0 = {low, low, low, 255};
            ends.e1 = {high, high, high, 255};
            break;
        }
        case 4:
            ends.e0 = {v[0], v[0], v[0], v[2]};
            ends.e1 = {v[1], v[1], v[1], v[3]};
            break;
        case 5:
            bitTransferSigned(v[1], v[0]);
            bitTransferSigned(v[3], v[2]);
            for (size_t c = 0; c < 4; ++c) {
                const size_t i = c < 3 ? 0 : 2;
                ends.e0[c] = v[i];
                ends.e1[c] = clampToByte(v[i] + v[i + 1]);
            }
            break;
        case 6:
        case 10:
            ends.e0 = {v[0] * v[3] >> 8, v[1] * v[3] >> 8, v[2] * v[3] >> 8, mode == 6 ? 255 : v[4]};
            ends.e1 = {v[0], v[1], v[2], mode == 6 ? 255 : v[5]};
            break;
        case 8:
            setDirect(ends, {v[0], v[2], v[4], 255}, {v[1], v[3], v[5], 255});
            break;
        case 12:
            setDirect(ends, {v[0], v[2], v[4], v[6]}, {v[1], v[3], v[5], v[7]});
            break;
        case 9:
        case 13:
            for (int i = 0; i < (mode == 9 ? 6 : 8); i += 2) bitTransferSigned(v[i + 1], v[i]);
            setByOffset(ends, {v[0], v[2], v[4], mode == 9 ? 255 : v[6]}, {v[1], v[3], v[5], mode == 9 ? 0 : v[7]});
            break;
        default:
            ends.hdr = true;
            break;
    }
    return ends;
}

/// "Partition Pattern Generation" for 2D blocks.
class PartitionPattern {
  public:
    PartitionPattern(uint32_t seed, uint32_t count, bool smallBlock) : count_(count), scale_(smallBlock ? 1 : 0) {
        seed += (count - 1) * 1024;
        random_ = hash(seed);
        uint32_t odd = count == 3 ? 6 : 5, even = (seed & 2) != 0 ? 4 : 5;  // shifts of seeds 1, 3, .. and 2, 4, ..
        if ((seed & 1) != 0) std::swap(odd, even);
        for (uint32_t i = 0; i < 8; ++i) {
            const uint32_t part = random_ >> 4 * i & 15;
            factors_[i] = (part * part & 0xff) >> (i % 2 == 0 ? odd : even);
        }
    }

    uint32_t of(uint32_t x, uint32_t y) const {
        if (count_ == 1) return 0;
        x <<= scale_;
        y <<= scale_;
        constexpr uint32_t kShift[4] = {14, 10, 6, 2};
        uint32_t values[4] = {};
        for (uint32_t i = 0; i < count_; ++i) {
            values[i] = (factors_[2 * i] * x + factors_[2 * i + 1] * y + (random_ >> kShift[i])) & 0x3f;
        }
        uint32_t best = 0;
        for (uint32_t i = 1; i < 4; ++i) {
            if (values[i] > values[best]) best = i;
        }
        return best;
    }

  private:
    static uint32_t hash(uint32_t p) {
        p ^= p >> 15;
        p -= p << 17;
        p += p << 7;
        p += p << 4;
        p ^= p >> 5;
        p += p << 16;
        p ^= p >> 7;
        p ^= p >> 3;
        p ^= p << 6;
        p ^= p >> 17;
        return p;
    }

    uint32_t count_, scale_;
    uint32_t random_ = 0;
    uint32_t factors_[8] = {};
};

/// The unquantised weights of the grid, plane by plane, and "Weight Infill".
class Weights {
  public:
    Weights(const BlockBits& block, const BlockMode& mode, const Target& target) : mode_(mode), target_(target) {
        uint8_t raw[64];
        readAstcSequence(block.reversed(), 0, mode.range, mode.weightCount(), raw);
        const uint32_t planes = mode.dualPlane ? 2 : 1;
        for (uint32_t i = 0; i < mode.weightCount(); ++i) {
            grid_[i % planes][i / planes] = unquantiseAstcWeight(mode.range, raw[i]);
        }
    }

    /// The weights of a texel in both planes; without a second plane that of the first.
    std::array<int32_t, 2> at(uint32_t x, uint32_t y) const {
        const uint32_t gs = position(x, target_.width, mode_.width), gt = position(y, target_.height, mode_.height);
        const uint32_t fs = gs & 15, ft = gt & 15;
        const uint32_t w11 = (fs * ft + 8) >> 4, w10 = ft - w11, w01 = fs - w11, w00 = 16 - fs - ft + w11;
        const uint32_t first = (gs >> 4) + (gt >> 4) * mode_.width;
        std::array<int32_t, 2> result;
        for (uint32_t p = 0; p < 2; ++p) {
            const uint8_t* const grid = grid_[mode_.dualPlane ? p : 0].data() + first;
            result[p] = static_cast<int32_t>(
                (grid[0] * w00 + grid[1] * w01 + grid[mode_.width] * w10 + grid[mode_.width + 1] * w11 + 8) >> 4);
        }
        return result;
    }

  private:
    /// The texel's place in the grid, in sixteenths.
    static uint32_t position(uint32_t texel, uint32_t blockSize, uint32_t gridSize) {
        const uint32_t scale = (1024 + blockSize / 2) / (blockSize - 1);
        return (scale * texel * (gridSize - 1) + 32) >> 6;
    }

    const BlockMode& mode_;
    const Target& target_;
    // Beyond the last row and column lie zeros, which enter with weight 0.
    std::array<std::array<uint8_t, 64 + 16>, 2> grid_{};
};

void decodeVoidExtent(const BlockBits& block, const Target& target, void* texels) {
    const uint32_t lowS = block.at(12, 13), highS = block.at(25, 13), lowT = block.at(38, 13), highT = block.at(51, 13);
    const bool noExtent = (lowS & highS & lowT & highT) == 0x1fff;
    const bool valid =
        block.at(9, 1) == 0 && block.at(10, 2) == 3 && (noExtent || (lowS < highS && lowT < highT));  // bit 9: HDR
    fill(target, texels,
         valid ? std::array{block.at(64, 16), block.at(80, 16), block.at(96, 16), block.at(112, 16)} : kErrorColor);
}

void decode(const std::byte* bytes, const Target& target, void* texels) {
    const BlockBits block(bytes);
    if (block.at(0, 9) == 0x1fc) return decodeVoidExtent(block, target, texels);
    const std::optional<BlockMode> mode = readBlockMode(block, target);
    const std::optional<ColorLayout> layout = mode ? readColorLayout(block, *mode) : std::nullopt;
    if (!layout) return fill(target, texels, kErrorColor);

    const std::array<int32_t, 18> values = readColorValues(block, *layout);
    std::array<Endpoints, 4> ends;
    for (uint32_t i = 0, first = 0; i < layout->partitions; ++i) {
        ends[i] = decodeEndpoints(layout->modes[i], values.data() + first);
        first += 2 * ((layout->modes[i] >> 2) + 1);
    }
    const Weights weights(block, *mode, target);
    const PartitionPattern pattern(layout->partitionIndex, layout->partitions, target.width * target.height < 31);
    for (uint32_t y = 0; y < target.height; ++y) {
        for (uint32_t x = 0; x < target.width; ++x) {
            const Endpoints& pair = ends[pattern.of(x, y)];
            const std::array<int32_t, 2> weight = weights.at(x, y);
            std::array<uint32_t, 4> color = kErrorColor;
            for (uint32_t c = 0; c < 4 && !pair.hdr; ++c) {
                const auto widen = [&](int32_t v) { return v << 8 | (target.srgb && c < 3 ? 0x80 : v); };
                const int32_t w = weight[c == layout->planeComponent ? 1 : 0];
                color[c] = static_cast<uint32_t>((widen(pair.e0[c]) * (64 - w) + widen(pair.e1[c]) * w + 32) >> 6);
            }
            putUnorm16(target, texels, y * target.width + x, color);
        }
    }
}

}  // namespace

template <int kWidth, int kHeight, bool kSrgb>
void decodeAstc(const std::byte* block, void* texels) {
    decode(block, {kWidth, kHeight, kSrgb}, texels);
}

#define VERNIER_INSTANTIATE(width, height)                                   \
    template void decodeAstc<width, height, false>(const std::byte*, void*); \
    template void decodeAstc<width, height, true>(const std::byte*, void*);
VERNIER_ASTC_FOOTPRINTS(VERNIER_INSTANTIATE)
#undef VERNIER_INSTANTIATE

}  // namespace vernier
