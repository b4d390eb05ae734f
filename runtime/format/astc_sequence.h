// ASTC's integer sequences: values of ranges 2^n, 3 * 2^n and 5 * 2^n packed into bits, and the way back from these
// ranges to 0..255 (colours) and 0..64 (weights) ("ASTC", sections "Integer Sequence Encoding", "Endpoint
// Unquantization" and "Weight Unquantization").
#pragma once

#include <cstdint>

#include "runtime/format/block_bits.h"

namespace vernier {

/// A range: values 0 .. (3^trits * 5^quints * 2^bits) - 1.
struct AstcRange {
    uint8_t trits, quints, bits;

    /// Bits that `count` values take.
    constexpr uint32_t size(uint32_t count) const {
        return (count * 8 * trits + 4) / 5 + (count * 7 * quints + 2) / 3 + count * bits;
    }
};

/// Reads `count` values that begin at bit `first` of the block into `values`; the bits from `first + range.size(count)`
/// on count as 0.
void readAstcSequence(const BlockBits& block, uint32_t first, AstcRange range, uint32_t count, uint8_t* values);

/// An encoded value of a colour range (which has at least 6 values) as 0..255.
uint8_t unquantiseAstcColor(AstcRange range, uint32_t value);

/// An encoded weight as 0..64.
uint8_t unquantiseAstcWeight(AstcRange range, uint32_t value);

}  // namespace vernier
