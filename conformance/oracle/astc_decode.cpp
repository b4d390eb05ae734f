#include "conformance/oracle/astc_decode.h"

#include "conformance/oracle/astc_sequences.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

namespace vernier::conformance::exact {
namespace {

using Rgba = std::array<int, 4>;
constexpr std::array<uint32_t, 4> kErrorColor{0xffff, 0, 0xffff, 0xffff};

/// "Block Mode".
struct BlockMode {
    uint32_t width = 0, height = 0;  // of the grid of weights
    bool dualPlane = false;
    AstcRange range;  // of weights
    uint32_t weights() const { return width * height * (dualPlane ? 2 : 1); }
};

/// By the three bits of a range from 2 on, without and with the bit that asks for precision.
constexpr AstcRange kWeightRanges[2][6] = {
    {{1, false, false}, {0, true, false}, {2, false, false}, {0, false, true}, {1, true, false}, {3, false, false}},
    {{1, false, true}, {2, true, false}, {4, false, false}, {2, false, true}, {3, true, false}, {5, false, false}}};

/// Nothing for modes that are reserved.
std::optional<BlockMode> blockMode(const AstcBits& bits) {
    const auto f = [&](size_t high, size_t low) { return astcField(bits, low, high - low + 1); };
    BlockMode mode;
    bool precise = bits[9];
    mode.dualPlane = bits[10];
    const uint32_t a = f(6, 5);
    uint32_t range = f(4, 4);
    if (f(1, 0) != 0) {
        range |= f(1, 0) << 1;
        const uint32_t b = f(8, 7);
        switch (f(3, 2)) {
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
                if (bits[8]) {
                    mode.width = f(7, 7) + 2, mode.height = a + 2;
                } else {
                    mode.width = a + 2, mode.height = f(7, 7) + 6;
                }
                break;
        }
    } else {
        range |= f(3, 2) << 1;
        switch (f(8, 7)) {
            case 0:
                mode.width = 12, mode.height = a + 2;
                break;
            case 1:
                mode.width = a + 2, mode.height = 12;
                break;
            case 2:
                mode.width = a + 6, mode.height = f(10, 9) + 6;
                mode.dualPlane = precise = false;
                break;
            default:
                if (a > 1) return std::nullopt;
                mode.width = a == 0 ? 6 : 10, mode.height = a == 0 ? 10 : 6;
                break;
        }
    }
    if (range < 2) return std::nullopt;
    mode.range = kWeightRanges[precise ? 1 : 0][range - 2];
    return mode;
}

/// "Partition Pattern Generation".
uint32_t partitionOf(uint32_t seed, uint32_t x, uint32_t y, uint32_t partitions, bool small) {
    if (partitions == 1) return 0;
    const uint32_t scale = small ? 2 : 1;
    const uint32_t s = seed + (partitions - 1) * 1024;
    uint32_t p = s;
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
    const uint32_t byMode = (s & 2) != 0 ? 4 : 5, byCount = partitions == 3 ? 6 : 5;
    const uint32_t odd = (s & 1) != 0 ? byMode : byCount, even = (s & 1) != 0 ? byCount : byMode;
    const auto factor = [p](uint32_t at, uint32_t shift) {
        const uint32_t nibble = p >> at & 15;
        return nibble * nibble >> shift;
    };
    std::array<uint32_t, 4> rank{};
    constexpr std::array<uint32_t, 4> kOffsets{14, 10, 6, 2};
    for (uint32_t i = 0; i < partitions; ++i) {
        rank[i] = (factor(8 * i, odd) * (x * scale) + factor(8 * i + 4, even) * (y * scale) + (p >> kOffsets[i])) & 63;
    }
    // The first of the largest; those that there are not have 0, as the specification's have.
    return static_cast<uint32_t>(std::max_element(rank.begin(), rank.end()) - rank.begin());
}

struct EndPoints {
    std::array<Rgba, 2> ends{};
    bool highRange = false;
};

Rgba blueContracted(const Rgba& c) {
    return {(c[0] + c[2]) >> 1, (c[1] + c[2]) >> 1, c[2], c[3]};
}

/// "bit_transfer_signed": the offset of six bits with a sign, and the base.
struct Offset {
    int by, base;
};
Offset transferred(int offset, int base) {
    int by = offset >> 1 & 0x3f;
    if ((by & 0x20) != 0) by -= 0x40;
    return {by, base >> 1 | (offset & 0x80)};
}

/// "LDR Endpoint Decoding". `v` has two values, and two more for each class that the mode is above the lowest.
EndPoints endPointsOf(uint32_t mode, const int* v) {
    EndPoints result;
    auto& [first, second] = result.ends;
    const bool alpha = mode >= 12;  // of the modes 8, 9, 12 and 13
    switch (mode) {
        case 0:
            first = {v[0], v[0], v[0], 255};
            second = {v[1], v[1], v[1], 255};
            break;
        case 1: {
            const int low = v[0] >> 2 | (v[1] & 0xc0), high = low + (v[1] & 0x3f);
            first = {low, low, low, 255};
            second = {high, high, high, 255};
            break;
        }
        case 4:
            first = {v[0], v[0], v[0], v[2]};
            second = {v[1], v[1], v[1], v[3]};
            break;
        case 5: {
            const Offset l = transferred(v[1], v[0]), a = transferred(v[3], v[2]);
            const int high = l.base + l.by;
            first = {l.base, l.base, l.base, a.base};
            second = {high, high, high, a.base + a.by};
            break;
        }
        case 6:
        case 10:
            first = {v[0] * v[3] >> 8, v[1] * v[3] >> 8, v[2] * v[3] >> 8, mode == 10 ? v[4] : 255};
            second = {v[0], v[1], v[2], mode == 10 ? v[5] : 255};
            break;
        case 8:
        case 12: {
            const Rgba low{v[0], v[2], v[4], alpha ? v[6] : 255}, high{v[1], v[3], v[5], alpha ? v[7] : 255};
            const bool ordered = high[0] + high[1] + high[2] >= low[0] + low[1] + low[2];
            first = ordered ? low : blueContracted(high);
            second = ordered ? high : blueContracted(low);
            break;
        }
        case 9:
        case 13: {
            Rgba base{0, 0, 0, 255}, sum{0, 0, 0, 255};
            int offsets = 0;
            for (size_t c = 0; c < (alpha ? 4u : 3u); ++c) {
                const Offset o = transferred(v[2 * c + 1], v[2 * c]);
                base[c] = o.base;
                sum[c] = o.base + o.by;
                if (c < 3) offsets += o.by;
            }
            first = offsets >= 0 ? base : blueContracted(sum);
            second = offsets >= 0 ? sum : blueContracted(base);
            break;
        }
        default:
            result.highRange = true;
            break;
    }
    for (Rgba& end : result.ends) {
        for (int& c : end) c = std::clamp(c, 0, 255);
    }
    return result;
}

/// The ranges of end points, from the finest down.
constexpr AstcRange kColorRanges[] = {
    {8, false, false}, {6, true, false}, {5, false, true}, {7, false, false}, {5, true, false}, {4, false, true},
    {6, false, false}, {4, true, false}, {3, false, true}, {5, false, false}, {3, true, false}, {2, false, true},
    {4, false, false}, {2, true, false}, {1, false, true}, {3, false, false}, {1, true, false}};

class Block {
  public:
    Block(const AstcBits& bits, uint32_t width, uint32_t height) : bits_(bits), width_(width), height_(height) {
        valid_ = readLayout() && readColors();
    }

    std::array<uint32_t, 4> texel(uint32_t x, uint32_t y, bool srgb) const {
        if (!valid_) return kErrorColor;
        const uint32_t partition = partitionOf(astcField(bits_, 13, 10), x, y, partitions_, width_ * height_ < 31);
        const EndPoints& ends = ends_[partition];
        if (ends.highRange) return kErrorColor;
        std::array<uint32_t, 4> result{};
        for (size_t c = 0; c < 4; ++c) {
            const auto wide = [&](int value) {
                const auto code = static_cast<uint32_t>(value);
                return code << 8 | (srgb && c < 3 ? 0x80 : code);
            };
            const uint32_t weight = weightAt(x, y, mode_.dualPlane && c == selector_ ? 1 : 0);
            result[c] = (wide(ends.ends[0][c]) * (64 - weight) + wide(ends.ends[1][c]) * weight + 32) / 64;
        }
        return result;
    }

  private:
    /// Whether the block is one: "Illegal Encodings".
    bool readLayout() {
        const std::optional<BlockMode> mode = blockMode(bits_);
        if (!mode) return false;
        mode_ = *mode;
        partitions_ = astcField(bits_, 11, 2) + 1;
        const uint32_t size = mode_.range.size(mode_.weights());
        if (mode_.weights() > 64 || size < 24 || size > 96) return false;
        if (mode_.width > width_ || mode_.height > height_) return false;
        if (mode_.dualPlane && partitions_ == 4) return false;
        // Weights stand at the end, the last bit first.
        AstcBits reversed;
        for (size_t i = 0; i < 128; ++i) reversed[i] = bits_[127 - i];
        for (const AstcValue& value : astcSequence(reversed, 0, size, mode_.range, mode_.weights()))
            weights_.push_back(astcWeight(mode_.range, value));
        colorEnd_ = 128 - size;
        return true;
    }

    /// "Color Endpoint Mode" and "Data Size Determination".
    bool readColors() {
        size_t first = 17;
        std::array<uint32_t, 4> modes{};
        if (partitions_ == 1) {
            modes[0] = astcField(bits_, 13, 4);
        } else {
            first = 29;
            const uint32_t kind = astcField(bits_, 23, 2);
            if (kind == 0) {
                modes.fill(astcField(bits_, 25, 4));
            } else {
                // One bit a partition that adds to its class, then two bits a partition; what has no place in the
                // field stands below the weights.
                const uint32_t further = 3 * partitions_ - 4;
                if (colorEnd_ < further) return false;
                colorEnd_ -= further;
                const uint32_t all = astcField(bits_, 25, 4) | astcField(bits_, colorEnd_, further) << 4;
                for (uint32_t i = 0; i < partitions_; ++i) {
                    const uint32_t kindOf = kind - 1 + (all >> i & 1);
                    modes[i] = kindOf << 2 | (all >> (partitions_ + 2 * i) & 3);
                }
            }
        }
        if (mode_.dualPlane) {
            if (colorEnd_ < 2) return false;
            colorEnd_ -= 2;
            selector_ = astcField(bits_, colorEnd_, 2);
        }
        uint32_t count = 0;
        for (uint32_t i = 0; i < partitions_; ++i) count += 2 * ((modes[i] >> 2) + 1);
        if (count > 18 || colorEnd_ < first) return false;
        const auto room = static_cast<uint32_t>(colorEnd_ - first);
        if (room < (13 * count + 4) / 5) return false;
        const auto fits = [&](const AstcRange& range) { return range.size(count) <= room; };
        const AstcRange range = *std::ranges::find_if(kColorRanges, fits);
        std::vector<int> values;
        for (const AstcValue& value : astcSequence(bits_, first, first + range.size(count), range, count))
            values.push_back(static_cast<int>(astcColor(range, value)));
        size_t at = 0;
        for (uint32_t i = 0; i < partitions_; ++i) {
            ends_[i] = endPointsOf(modes[i], values.data() + at);
            at += 2 * ((modes[i] >> 2) + 1);
        }
        return true;
    }

    /// "Weight Infill".
    uint32_t weightAt(uint32_t x, uint32_t y, uint32_t plane) const {
        const auto place = [](uint32_t at, uint32_t size, uint32_t grid) {
            const uint32_t scale = (1024 + size / 2) / (size - 1);
            return (scale * at * (grid - 1) + 32) >> 6;
        };
        const uint32_t gs = place(x, width_, mode_.width), gt = place(y, height_, mode_.height);
        const uint32_t fs = gs & 15, ft = gt & 15, corner = (gs >> 4) + (gt >> 4) * mode_.width;
        const auto stored = [&](uint32_t at) {
            const size_t index = size_t{at} * (mode_.dualPlane ? 2 : 1) + plane;
            return index < weights_.size() ? weights_[index] : 0;  // has no weight there
        };
        const uint32_t w11 = (fs * ft + 8) >> 4, w10 = ft - w11, w01 = fs - w11, w00 = 16 - fs - ft + w11;
        return (stored(corner) * w00 + stored(corner + 1) * w01 + stored(corner + mode_.width) * w10 +
                stored(corner + mode_.width + 1) * w11 + 8) >>
               4;
    }

    const AstcBits& bits_;
    const uint32_t width_, height_;
    bool valid_ = false;
    BlockMode mode_;
    uint32_t partitions_ = 1, selector_ = 0;
    size_t colorEnd_ = 0;            // the first bit behind those of colours
    std::vector<uint32_t> weights_;  // of two planes in turn
    std::array<EndPoints, 4> ends_;
};

/// "Void-Extent Blocks".
std::array<uint32_t, 4> voidExtent(const AstcBits& bits) {
    const bool highRange = bits[9], reserved = !bits[10] || !bits[11];
    const auto coordinate = [&](size_t i) { return astcField(bits, 12 + 13 * i, 13); };
    const bool without =
        coordinate(0) == 8191 && coordinate(1) == 8191 && coordinate(2) == 8191 && coordinate(3) == 8191;
    const bool empty = !without && (coordinate(0) >= coordinate(1) || coordinate(2) >= coordinate(3));
    if (highRange || reserved || empty) return kErrorColor;
    return {astcField(bits, 64, 16), astcField(bits, 80, 16), astcField(bits, 96, 16), astcField(bits, 112, 16)};
}

}  // namespace

std::array<uint32_t, 4> astcTexel(std::span<const std::byte> block, uint32_t width, uint32_t height, uint32_t x,
                                  uint32_t y, bool srgb) {
    AstcBits bits;
    for (size_t i = 0; i < 128; ++i) bits[i] = (std::to_integer<uint32_t>(block[i / 8]) >> i % 8 & 1) != 0;
    if (astcField(bits, 0, 9) == 0x1fc) return voidExtent(bits);
    return Block(bits, width, height).texel(x, y, srgb);
}

double astcHalf(uint32_t component) {
    if (component == 65535) return 1;
    // A half float has eleven bits; the smallest one is below 1 / 65536.
    const int drop = std::max(0, static_cast<int>(std::bit_width(component)) - 11);
    return std::ldexp(static_cast<double>(component >> drop << drop), -16);
}

}  // namespace vernier::conformance::exact
