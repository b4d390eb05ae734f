// BC6H: half-float RGB in fourteen modes ("BPTC Compressed Texture Image Formats", BC6H).
#include <array>
#include <cstring>
#include <string_view>

#include "runtime/format/block.h"
#include "runtime/format/bptc.h"

namespace vernier {
namespace {

/// `count` bits of the block go to bits `low` and up of a field: 3 * endpoint + component.
struct Run {
    uint8_t field, low, count;
    bool reversed;  // the first one to the highest place
};

struct Mode {
    bool transformed = false;
    uint8_t endpointBits = 0;  // 0: a reserved mode
    std::array<uint8_t, 3> deltaBits{};
    uint8_t runCount = 0;
    uint8_t headerBits = 0;  // where the partition number or the indices begin
    std::array<Run, 24> runs{};
    constexpr uint32_t subsets() const { return headerBits == 77 ? 2 : 1; }
};

/// `format` is a row of the specification's table "Block formats for BC6H block modes", without the mode bits: fields
/// like r0[9:0] or b3[4], the first one lowest; [10:11] takes the bits in reverse.
constexpr Mode makeMode(uint32_t modeBits, bool transformed, uint8_t endpointBits, std::array<uint8_t, 3> deltaBits,
                        std::string_view format) {
    Mode mode{transformed, endpointBits, deltaBits, 0, static_cast<uint8_t>(modeBits), {}};
    size_t at = 0;
    const auto number = [&] {
        uint8_t value = 0;
        for (; at < format.size() && format[at] >= '0' && format[at] <= '9'; ++at) {
            value = static_cast<uint8_t>(10 * value + (format[at] - '0'));
        }
        return value;
    };
    while (at < format.size()) {
        Run run{};
        const auto component = static_cast<uint8_t>(format[at] == 'r' ? 0 : format[at] == 'g' ? 1 : 2);
        ++at;
        run.field = static_cast<uint8_t>(3 * number() + component);
        ++at;  // [
        const uint8_t first = number();
        uint8_t last = first;
        if (format[at] == ':') {
            ++at;
            last = number();
        }
        at += 2;  // ] and the space
        run.reversed = first < last;
        run.low = run.reversed ? first : last;
        run.count = static_cast<uint8_t>((run.reversed ? last - first : first - last) + 1);
        mode.runs[mode.runCount++] = run;
        mode.headerBits = static_cast<uint8_t>(mode.headerBits + run.count);
    }
    return mode;
}

/// By the low five bits of the block, of which modes 0 and 1 use two.
constexpr std::array<Mode, 32> kModes = [] {
    std::array<Mode, 32> modes{};
    modes[0] = makeMode(2, true, 10, {5, 5, 5},
                        "g2[4] b2[4] b3[4] r0[9:0] g0[9:0] b0[9:0] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] b1[4:0] "
                        "b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3] ");
    modes[1] = makeMode(2, true, 7, {6, 6, 6},
                        "g2[5] g3[4] g3[5] r0[6:0] b3[0] b3[1] b2[4] g0[6:0] b2[5] b3[2] g2[4] b0[6:0] b3[3] b3[5] "
                        "b3[4] r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0] ");
    for (size_t i = 4; i < 32; i += 4) {
        modes[i] = modes[0];
        modes[i + 1] = modes[1];
    }
    modes[2] = makeMode(5, true, 11, {5, 4, 4},
                        "r0[9:0] g0[9:0] b0[9:0] r1[4:0] r0[10] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[3:0] b0[10] "
                        "b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3] ");
    modes[6] = makeMode(5, true, 11, {4, 5, 4},
                        "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] g3[4] g2[3:0] g1[4:0] g0[10] g3[3:0] b1[3:0] b0[10] "
                        "b3[1] b2[3:0] r2[3:0] b3[0] b3[2] r3[3:0] g2[4] b3[3] ");
    modes[10] = makeMode(5, true, 11, {4, 4, 5},
                         "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] b2[4] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[4:0] "
                         "b0[10] b2[3:0] r2[3:0] b3[1] b3[2] r3[3:0] b3[4] b3[3] ");
    modes[14] = makeMode(5, true, 9, {5, 5, 5},
                         "r0[8:0] b2[4] g0[8:0] g2[4] b0[8:0] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] "
                         "b1[4:0] b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3] ");
    modes[18] = makeMode(5, true, 8, {6, 5, 5},
                         "r0[7:0] g3[4] b2[4] g0[7:0] b3[2] g2[4] b0[7:0] b3[3] b3[4] r1[5:0] g2[3:0] g1[4:0] b3[0] "
                         "g3[3:0] b1[4:0] b3[1] b2[3:0] r2[5:0] r3[5:0] ");
    modes[22] = makeMode(5, true, 8, {5, 6, 5},
                         "r0[7:0] b3[0] b2[4] g0[7:0] g2[5] g2[4] b0[7:0] g3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[5:0] "
                         "g3[3:0] b1[4:0] b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3] ");
    modes[26] = makeMode(5, true, 8, {5, 5, 6},
                         "r0[7:0] b3[1] b2[4] g0[7:0] b2[5] g2[4] b0[7:0] b3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] "
                         "b3[0] g3[3:0] b1[5:0] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3] ");
    modes[30] = makeMode(5, false, 6, {6, 6, 6},
                         "r0[5:0] g3[4] b3[0] b3[1] b2[4] g0[5:0] g2[5] b2[5] b3[2] g2[4] b0[5:0] g3[5] b3[3] b3[5] "
                         "b3[4] r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0] ");
    modes[3] = makeMode(5, false, 10, {10, 10, 10}, "r0[9:0] g0[9:0] b0[9:0] r1[9:0] g1[9:0] b1[9:0] ");
    modes[7] =
        makeMode(5, true, 11, {9, 9, 9}, "r0[9:0] g0[9:0] b0[9:0] r1[8:0] r0[10] g1[8:0] g0[10] b1[8:0] b0[10] ");
    modes[11] = makeMode(5, true, 12, {8, 8, 8},
                         "r0[9:0] g0[9:0] b0[9:0] r1[7:0] r0[10:11] g1[7:0] g0[10:11] b1[7:0] b0[10:11] ");
    modes[15] = makeMode(5, true, 16, {4, 4, 4},
                         "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10:15] g1[3:0] g0[10:15] b1[3:0] b0[10:15] ");
    return modes;
}();
static_assert([] {
    for (size_t i = 0; i < 32; ++i) {
        const bool reserved = i == 19 || i == 23 || i == 27 || i == 31;
        const uint32_t expected = reserved ? 0 : i % 4 == 3 ? 65 : 77;
        if (kModes[i].headerBits != expected) return false;
    }
    return true;
}());

/// Endpoint fields as read, before sign extension.
std::array<uint32_t, 12> readFields(const BlockBits& block, const Mode& mode) {
    std::array<uint32_t, 12> fields{};
    uint32_t next = (block.at(0, 2) < 2) ? 2 : 5;
    for (uint32_t i = 0; i < mode.runCount; ++i) {
        const Run& run = mode.runs[i];
        uint32_t bits = block.at(next, run.count);
        next += run.count;
        if (run.reversed) {
            uint32_t turned = 0;
            for (uint32_t b = 0; b < run.count; ++b) turned |= (bits >> b & 1) << (run.count - 1u - b);
            bits = turned;
        }
        fields[run.field] |= bits << run.low;
    }
    return fields;
}

template <bool kSigned>
int32_t unquantise(int32_t x, uint32_t bits) {
    if constexpr (kSigned) {
        if (bits >= 16 || x == 0) return x;
        const int32_t magnitude = x < 0 ? -x : x;
        const int32_t wide = magnitude >= (1 << (bits - 1)) - 1 ? 0x7fff : ((magnitude << 15) + 0x4000) >> (bits - 1);
        return x < 0 ? -wide : wide;
    } else {
        if (bits >= 15 || x == 0) return x;
        return x == (1 << bits) - 1 ? 0xffff : ((x << 15) + 0x4000) >> (bits - 1);
    }
}

/// The bits of the half float.
template <bool kSigned>
uint16_t finish(int32_t value) {
    if constexpr (!kSigned) return static_cast<uint16_t>(value * 31 >> 6);
    return static_cast<uint16_t>(value < 0 ? 0x8000 | (-value * 31 >> 5) : value * 31 >> 5);
}

template <bool kSigned>
void decodeBc6(const std::byte* block, void* texels) {
    constexpr uint16_t kOne = 0x3c00;
    auto* const out = static_cast<uint16_t*>(texels);
    const BlockBits bits(block);
    const Mode& mode = kModes[bits.at(0, 5)];
    if (mode.endpointBits == 0) {
        for (int i = 0; i < 64; ++i) out[i] = i % 4 == 3 ? kOne : 0;
        return;
    }
    const std::array<uint32_t, 12> fields = readFields(bits, mode);
    const uint32_t width = mode.endpointBits;
    std::array<int32_t, 12> ends{};
    for (uint32_t i = 0; i < 6 * mode.subsets(); ++i) {
        const uint32_t c = i % 3;
        uint32_t value = fields[i];
        if (mode.transformed && i >= 3) {
            value = fields[c] + static_cast<uint32_t>(signExtended(value, mode.deltaBits[c]));
            value &= (1u << width) - 1;
        }
        ends[i] = unquantise<kSigned>(kSigned ? signExtended(value, width) : static_cast<int32_t>(value), width);
    }
    const bool two = mode.subsets() == 2;
    const BptcPartition partition(mode.subsets(), two ? bits.at(77, 5) : 0);
    const auto weights = readBptcWeights(bits, two ? 82 : 65, two ? 3 : 4, partition);
    for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t e = 6 * partition.of(i);
        for (uint32_t c = 0; c < 3; ++c)
            out[4 * i + c] = finish<kSigned>(bptcMix(ends[e + c], ends[e + 3 + c], weights[i]));
        out[4 * i + 3] = kOne;
    }
}

}  // namespace

void decodeBc6Ufloat(const std::byte* block, void* texels) {
    decodeBc6<false>(block, texels);
}
void decodeBc6Sfloat(const std::byte* block, void* texels) {
    decodeBc6<true>(block, texels);
}

}  // namespace vernier
