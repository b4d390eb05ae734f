// Reading the bits of a block.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vernier {

template <class T>
T loadLittleEndian(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// ETC2 and EAC number their bits from the last byte.
inline uint64_t loadBigEndian(const std::byte* bytes) {
    return __builtin_bswap64(loadLittleEndian<uint64_t>(bytes));
}

/// `count` bits (at most 32) from bit `first` of a number; bits beyond its end are 0.
constexpr uint32_t bitField(uint64_t word, uint32_t first, uint32_t count) {
    return static_cast<uint32_t>(word >> first & ((uint64_t{1} << count) - 1));
}

/// A block of 128 bits, little-endian.
class BlockBits {
  public:
    explicit BlockBits(const std::byte* block)
        : low_(loadLittleEndian<uint64_t>(block)), high_(loadLittleEndian<uint64_t>(block + 8)) {}

    /// The block with its bits in reverse order: bit 127 first.
    BlockBits reversed() const { return {reverse(high_), reverse(low_)}; }

    /// `count` bits (at most 32) from bit `first`; bits from 128 on are 0.
    uint32_t at(uint32_t first, uint32_t count) const {
        if (first >= 128) return 0;
        if (first >= 64) return bitField(high_, first - 64, count);
        uint64_t word = low_ >> first;
        if (first != 0) word |= high_ << (64 - first);
        return bitField(word, 0, count);
    }

  private:
    BlockBits(uint64_t low, uint64_t high) : low_(low), high_(high) {}

    static constexpr uint64_t reverse(uint64_t word) {
        const auto swap = [&](uint32_t by, uint64_t mask) { word = (word >> by & mask) | (word & mask) << by; };
        swap(1, 0x5555555555555555);
        swap(2, 0x3333333333333333);
        swap(4, 0x0f0f0f0f0f0f0f0f);
        return __builtin_bswap64(word);
    }

    uint64_t low_, high_;
};

/// The value of the low `bits` bits, two's complement; 0 < bits <= 32.
constexpr int32_t signExtended(uint32_t value, uint32_t bits) {
    return static_cast<int32_t>(value << (32 - bits)) >> (32 - bits);
}

constexpr uint8_t clampToByte(int32_t value) {
    return static_cast<uint8_t>(std::clamp(value, 0, 255));
}

/// n bits widened to 8 by repeating the highest ones; 4 <= n <= 8.
constexpr uint32_t widenToByte(uint32_t value, uint32_t bits) {
    return (value << (8 - bits) | value >> (2 * bits - 8)) & 0xff;
}

}  // namespace vernier
