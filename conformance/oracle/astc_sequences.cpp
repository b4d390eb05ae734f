#include "conformance/oracle/astc_sequences.h"

#include <array>
#include <string_view>

namespace vernier::conformance::exact {
namespace {

uint32_t bit(uint32_t word, uint32_t at) {
    return word >> at & 1;
}

/// "Trits decoding": five trits from eight bits.
std::array<uint32_t, 5> tritsOf(uint32_t t) {
    std::array<uint32_t, 5> trits{};
    uint32_t c = t & 31;
    if ((t >> 2 & 7) == 7) {
        c = (t >> 5 & 7) << 2 | (t & 3);
        trits[3] = trits[4] = 2;
    } else if ((t >> 5 & 3) == 3) {
        trits[4] = 2;
        trits[3] = bit(t, 7);
    } else {
        trits[4] = bit(t, 7);
        trits[3] = t >> 5 & 3;
    }
    if ((c & 3) == 3) {
        trits[2] = 2;
        trits[1] = bit(c, 4);
        trits[0] = bit(c, 3) << 1 | (bit(c, 2) & ~bit(c, 3));
    } else if ((c >> 2 & 3) == 3) {
        trits[2] = trits[1] = 2;
        trits[0] = c & 3;
    } else {
        trits[2] = bit(c, 4);
        trits[1] = c >> 2 & 3;
        trits[0] = bit(c, 1) << 1 | (bit(c, 0) & ~bit(c, 1));
    }
    return trits;
}

/// "Quints decoding": three quints from seven bits.
std::array<uint32_t, 3> quintsOf(uint32_t q) {
    if ((q >> 1 & 3) == 3 && (q >> 5 & 3) == 0) {
        const uint32_t open = ~bit(q, 0) & 1;
        return {4, 4, bit(q, 0) << 2 | (bit(q, 4) & open) << 1 | (bit(q, 3) & open)};
    }
    std::array<uint32_t, 3> quints{};
    uint32_t c = q & 31;
    if ((q >> 1 & 3) == 3) {
        quints[2] = 4;
        c = (q >> 3 & 3) << 3 | (~(q >> 5) & 3) << 1 | bit(q, 0);
    } else {
        quints[2] = q >> 5 & 3;
    }
    const bool four = (c & 7) == 5;
    quints[1] = four ? 4 : c >> 3 & 3;
    quints[0] = four ? c >> 3 & 3 : c & 7;
    return quints;
}

/// Bits repeated until they fill `width`.
uint32_t repeated(uint32_t value, uint32_t bits, uint32_t width) {
    uint32_t result = 0;
    for (uint32_t i = 0; i < width; ++i) result |= bit(value, bits - 1 - (width - 1 - i) % bits) << i;
    return result;
}

/// How the tables of unquantization spell their B: of nine or seven letters each is a bit of the value ('b' the second
/// lowest, and so on) or '0'.
uint32_t spelled(std::string_view letters, uint32_t value) {
    uint32_t result = 0;
    for (const char letter : letters) result = result << 1 | (letter == '0' ? 0 : bit(value, letter - 'a'));
    return result;
}

struct Spelling {
    std::string_view b;
    uint32_t c;
};

// "Endpoint Unquantization", by number of bits from 1 on.
constexpr Spelling kColorTrits[] = {{"000000000", 204}, {"b000b0bb0", 93}, {"cb000cbcb", 44},
                                    {"dcb000dcb", 22},  {"edcb000ed", 11}, {"fedcb000f", 5}};
constexpr Spelling kColorQuints[] = {
    {"000000000", 113}, {"b0000bb00", 54}, {"cb0000cbc", 26}, {"dcb0000dc", 13}, {"edcb0000e", 6}};
// "Weight Decoding".
constexpr Spelling kWeightTrits[] = {{"0000000", 50}, {"b000b0b", 23}, {"cb000cb", 11}};
constexpr Spelling kWeightQuints[] = {{"0000000", 28}, {"b0000b0", 13}};

/// T = D * C + B; T = T ^ A; T = (A & top) | (T >> 2), A being the lowest bit repeated.
uint32_t combined(const Spelling& how, AstcValue value, uint32_t width) {
    const uint32_t all = (1u << width) - 1, a = bit(value.low, 0) != 0 ? all : 0;
    const uint32_t t = (value.high * how.c + spelled(how.b, value.low)) ^ a;
    return (a & 1u << (width - 2)) | t >> 2;
}

}  // namespace

uint32_t astcField(const AstcBits& bits, size_t first, size_t count) {
    uint32_t result = 0;
    for (size_t i = 0; i < count && first + i < bits.size(); ++i) result |= uint32_t{bits[first + i]} << i;
    return result;
}

uint32_t AstcRange::size(uint32_t count) const {
    return count * bits + (trit ? (count * 8 + 4) / 5 : 0) + (quint ? (count * 7 + 2) / 3 : 0);
}

std::vector<AstcValue> astcSequence(const AstcBits& bits, size_t first, size_t end, AstcRange range, uint32_t count) {
    size_t at = first;
    const auto take = [&](uint32_t number) {
        uint32_t result = 0;
        for (uint32_t i = 0; i < number; ++i, ++at) result |= (at < end ? uint32_t{bits[at]} : 0u) << i;
        return result;
    };
    // Behind each value's bits stand some of those that its group has together.
    constexpr std::array<uint32_t, 5> kTritBits{2, 2, 1, 2, 1};
    constexpr std::array<uint32_t, 3> kQuintBits{3, 2, 2};
    const size_t group = range.trit ? 5 : range.quint ? 3 : 1;
    std::vector<AstcValue> values;
    while (values.size() < count) {
        std::array<AstcValue, 5> some{};
        uint32_t together = 0, taken = 0;
        for (size_t i = 0; i < group; ++i) {
            some[i].low = take(range.bits);
            const uint32_t more = range.trit ? kTritBits[i] : range.quint ? kQuintBits[i] : 0;
            together |= take(more) << taken;
            taken += more;
        }
        const auto trits = tritsOf(together);
        const auto quints = quintsOf(together);
        for (size_t i = 0; i < group && values.size() < count; ++i) {
            some[i].high = range.trit ? trits[i] : range.quint ? quints[i] : 0;
            values.push_back(some[i]);
        }
    }
    return values;
}

uint32_t astcColor(AstcRange range, AstcValue value) {
    if (!range.trit && !range.quint) return repeated(value.low, range.bits, 8);
    return combined(range.trit ? kColorTrits[range.bits - 1] : kColorQuints[range.bits - 1], value, 9);
}

uint32_t astcWeight(AstcRange range, AstcValue value) {
    constexpr uint32_t kTrits[] = {0, 32, 63}, kQuints[] = {0, 16, 32, 47, 63};
    const uint32_t weight = range.trit && range.bits == 0    ? kTrits[value.high]
                            : range.quint && range.bits == 0 ? kQuints[value.high]
                            : range.trit                     ? combined(kWeightTrits[range.bits - 1], value, 7)
                            : range.quint                    ? combined(kWeightQuints[range.bits - 1], value, 7)
                                                             : repeated(value.low, range.bits, 6);
    return weight > 32 ? weight + 1 : weight;
}

}  // namespace vernier::conformance::exact
