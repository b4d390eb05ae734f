#include "runtime/format/astc_sequence.h"

namespace vernier {
namespace {

void unpackTrits(uint32_t packed, uint8_t (&t)[5]) {
    uint32_t c;
    if (bitField(packed, 2, 3) == 7) {
        c = bitField(packed, 5, 3) << 2 | bitField(packed, 0, 2);
        t[4] = t[3] = 2;
    } else {
        c = bitField(packed, 0, 5);
        const bool both = bitField(packed, 5, 2) == 3;
        t[4] = both ? 2 : static_cast<uint8_t>(bitField(packed, 7, 1));
        t[3] = static_cast<uint8_t>(both ? bitField(packed, 7, 1) : bitField(packed, 5, 2));
    }
    const auto pair = [](uint32_t bits) { return static_cast<uint8_t>((bits & 2) | (bits & 1 & ~(bits >> 1))); };
    if (bitField(c, 0, 2) == 3) {
        t[2] = 2;
        t[1] = static_cast<uint8_t>(bitField(c, 4, 1));
        t[0] = pair(bitField(c, 2, 2));
    } else if (bitField(c, 2, 2) == 3) {
        t[2] = t[1] = 2;
        t[0] = static_cast<uint8_t>(bitField(c, 0, 2));
    } else {
        t[2] = static_cast<uint8_t>(bitField(c, 4, 1));
        t[1] = static_cast<uint8_t>(bitField(c, 2, 2));
        t[0] = pair(bitField(c, 0, 2));
    }
}

void unpackQuints(uint32_t packed, uint8_t (&q)[5]) {
    const uint32_t low = bitField(packed, 0, 1);
    if (bitField(packed, 1, 2) == 3 && bitField(packed, 5, 2) == 0) {
        const uint32_t rest = low != 0 ? 0 : bitField(packed, 3, 2);
        q[2] = static_cast<uint8_t>(low << 2 | rest);
        q[1] = q[0] = 4;
        return;
    }
    uint32_t c;
    if (bitField(packed, 1, 2) == 3) {
        q[2] = 4;
        c = bitField(packed, 3, 2) << 3 | (~bitField(packed, 5, 2) & 3) << 1 | low;
    } else {
        q[2] = static_cast<uint8_t>(bitField(packed, 5, 2));
        c = bitField(packed, 0, 5);
    }
    const bool four = bitField(c, 0, 3) == 5;
    q[1] = four ? 4 : static_cast<uint8_t>(bitField(c, 3, 2));
    q[0] = static_cast<uint8_t>(four ? bitField(c, 3, 2) : bitField(c, 0, 3));
}

/// Bits of a value spread over the B column of the specification's tables: bit i of `value` goes where `places[i]` has
/// ones.
uint32_t spread(uint32_t value, const uint16_t (&places)[6]) {
    uint32_t result = 0;
    for (uint32_t i = 0; i < 6; ++i) {
        if ((value >> i & 1) != 0) result |= places[i];
    }
    return result;
}

/// One row of an unquantisation table: C, and where bits b, c, d, e, f of the value go in B (bit a goes nowhere).
struct Unquantisation {
    uint16_t c;
    uint16_t places[6];
};

// Index: number of low bits.
constexpr Unquantisation kColorTrits[7] = {
    {},
    {204, {}},
    {93, {0, 0b100010110}},
    {44, {0, 0b010000101, 0b100001010}},
    {22, {0, 0b001000001, 0b010000010, 0b100000100}},
    {11, {0, 0b000100000, 0b001000000, 0b010000001, 0b100000010}},
    {5, {0, 0b000010000, 0b000100000, 0b001000000, 0b010000000, 0b100000001}},
};
constexpr Unquantisation kColorQuints[6] = {
    {},
    {113, {}},
    {54, {0, 0b100001100}},
    {26, {0, 0b010000010, 0b100000101}},
    {13, {0, 0b001000000, 0b010000001, 0b100000010}},
    {6, {0, 0b000100000, 0b001000000, 0b010000000, 0b100000001}},
};
constexpr Unquantisation kWeightTrits[4] = {{}, {50, {}}, {23, {0, 0b1000101}}, {11, {0, 0b0100001, 0b1000010}}};
constexpr Unquantisation kWeightQuints[3] = {{}, {28, {}}, {13, {0, 0b1000010}}};

/// The bits of a value repeated from the highest one down over `width` bits.
uint32_t replicate(uint32_t value, uint32_t bits, uint32_t width) {
    uint32_t result = 0;
    for (int32_t at = static_cast<int32_t>(width - bits); at > -static_cast<int32_t>(bits);
         at -= static_cast<int32_t>(bits)) {
        result |= at >= 0 ? value << at : value >> -at;
    }
    return result;
}

/// The general procedure; `width` is that of A and B, 9 for colours and 7 for weights.
uint32_t unquantise(const Unquantisation& row, uint32_t digit, uint32_t low, uint32_t width) {
    const uint32_t a = (low & 1) != 0 ? (1u << width) - 1 : 0;
    const uint32_t t = (digit * row.c + spread(low, row.places)) ^ a;
    return (a & 1u << (width - 2)) | t >> 2;
}

}  // namespace

void readAstcSequence(const BlockBits& block, uint32_t first, AstcRange range, uint32_t count, uint8_t* values) {
    const uint32_t end = first + range.size(count);
    const auto take = [&](uint32_t bits) {
        const uint32_t present = first >= end ? 0 : std::min(bits, end - first);
        const uint32_t value = block.at(first, present);
        first += bits;
        return value;
    };
    if (range.trits == 0 && range.quints == 0) {
        for (uint32_t i = 0; i < count; ++i) values[i] = static_cast<uint8_t>(take(range.bits));
        return;
    }
    // Where the bits of T or Q lie: after each value's low bits come this many of them.
    constexpr uint8_t kTritBits[5] = {2, 2, 1, 2, 1}, kQuintBits[3] = {3, 2, 2};
    const uint32_t group = range.trits != 0 ? 5 : 3;
    for (uint32_t i = 0; i < count; i += group) {
        uint32_t packed = 0, shift = 0;
        uint32_t low[5];
        for (uint32_t k = 0; k < group; ++k) {
            low[k] = take(range.bits);
            const uint32_t bits = range.trits != 0 ? kTritBits[k] : kQuintBits[k];
            packed |= take(bits) << shift;
            shift += bits;
        }
        uint8_t digits[5];
        if (range.trits != 0) {
            unpackTrits(packed, digits);
        } else {
            unpackQuints(packed, digits);
        }
        for (uint32_t k = 0; k < group && i + k < count; ++k) {
            values[i + k] = static_cast<uint8_t>(static_cast<uint32_t>(digits[k]) << range.bits | low[k]);
        }
    }
}

uint8_t unquantiseAstcColor(AstcRange range, uint32_t value) {
    const uint32_t digit = value >> range.bits, low = value & ((1u << range.bits) - 1);
    if (range.trits != 0) return static_cast<uint8_t>(unquantise(kColorTrits[range.bits], digit, low, 9));
    if (range.quints != 0) return static_cast<uint8_t>(unquantise(kColorQuints[range.bits], digit, low, 9));
    return static_cast<uint8_t>(replicate(value, range.bits, 8));
}

uint8_t unquantiseAstcWeight(AstcRange range, uint32_t value) {
    constexpr uint8_t kThree[3] = {0, 32, 63}, kFive[5] = {0, 16, 32, 47, 63};
    const uint32_t digit = value >> range.bits, low = value & ((1u << range.bits) - 1);
    uint32_t weight;
    if (range.trits != 0) {
        weight = range.bits == 0 ? kThree[digit] : unquantise(kWeightTrits[range.bits], digit, low, 7);
    } else if (range.quints != 0) {
        weight = range.bits == 0 ? kFive[digit] : unquantise(kWeightQuints[range.bits], digit, low, 7);
    } else {
        weight = replicate(value, range.bits, 6);
    }
    return static_cast<uint8_t>(weight > 32 ? weight + 1 : weight);
}

}  // namespace vernier
