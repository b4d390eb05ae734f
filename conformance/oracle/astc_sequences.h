// Integer sequence encoding of ASTC (Khronos Data Format Specification 1.3, "Integer Sequence Encoding", "Endpoint
// Unquantization", "Weight Decoding"): what a range of values takes in bits, reading values, and unquantising them.
#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

namespace vernier::conformance::exact {

using AstcBits = std::bitset<128>;

/// `count` bits from `first` on, the first being the lowest; bits beyond the block are 0.
uint32_t astcField(const AstcBits& bits, size_t first, size_t count);

/// Values of 0 to 2^bits - 1, times 3 with a trit or times 5 with a quint.
struct AstcRange {
    uint32_t bits = 0;
    bool trit = false, quint = false;

    uint32_t levels() const { return (trit ? 3u : quint ? 5u : 1u) << bits; }
    /// Bits of a sequence of `count` values.
    uint32_t size(uint32_t count) const;
};

/// A value taken apart: its trit or quint, and its bits below.
struct AstcValue {
    uint32_t high = 0, low = 0;
};

/// `count` values from bit `first` on, `end` being the first bit that is no longer theirs.
std::vector<AstcValue> astcSequence(const AstcBits& bits, size_t first, size_t end, AstcRange range, uint32_t count);

/// Of colour end points: 0..255.
uint32_t astcColor(AstcRange range, AstcValue value);
/// Of weights: 0..64.
uint32_t astcWeight(AstcRange range, AstcValue value);

}  // namespace vernier::conformance::exact
