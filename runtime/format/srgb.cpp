// The tables of srgb.h, computed by the compiler in integer arithmetic: no rounding but the last.
//
// For v = n / d the curve's linear value is
//     v / 12.92 = 25n / 323d                                          up to v = 0.04045,
//     ((v + 0.055) / 1.055)^2.4 = ((200n + 11d) / 211d)^(12/5)        above,
// so that a float m * 2^-e is at most that value if and only if
//     m * 323d <= 25n * 2^e,   or   m^5 * (211d)^12 <= (200n + 11d)^12 * 2^5e.
// The codes and the half-way points between them have d = 510.
#include "runtime/format/srgb.h"

#include <cstddef>
#include <utility>

namespace vernier {
namespace {

/// Unsigned integers below 2^448, enough for the products above with d <= 510: 5 * 25 + 12 * 17 bits on the left,
/// 12 * 17 + 5 * 39 on the right.
struct BigUint {
    std::array<uint32_t, 14> limb{};

    constexpr explicit BigUint(uint32_t value) { limb[0] = value; }

    constexpr BigUint& operator*=(uint32_t factor) {
        uint64_t carry = 0;
        for (uint32_t& l : limb) {
            carry += uint64_t{l} * factor;
            l = static_cast<uint32_t>(carry);
            carry >>= 32;
        }
        return *this;
    }

    constexpr bool operator<=(const BigUint& other) const {
        for (std::size_t i = limb.size(); i-- > 0;) {
            if (limb[i] != other.limb[i]) return limb[i] < other.limb[i];
        }
        return true;
    }
};

constexpr BigUint power(uint32_t base, int exponent) {
    BigUint result(1);
    for (int i = 0; i < exponent; ++i) result *= base;
    return result;
}

constexpr bool isLinear(uint32_t n, uint32_t d) {
    return n * 100000 <= 4045 * d;
}  // n / d <= 0.04045

/// m * 2^-e <= the curve's value at n / d, for one n, d and e.
struct AtMostCurve {
    bool linear;
    uint64_t linearFactor = 0, linearLimit = 0;
    BigUint powerLimit{0}, denominator{0};

    constexpr AtMostCurve(uint32_t n, uint32_t d, int e) : linear(isLinear(n, d)) {
        if (linear) {
            linearFactor = uint64_t{323} * d;
            linearLimit = (uint64_t{25} * n) << e;
        } else {
            denominator = power(211 * d, 12);
            powerLimit = power(200 * n + 11 * d, 12);
            for (int i = 0; i < 5; ++i) {
                powerLimit *= 1u << (e / 2);
                powerLimit *= 1u << (e - e / 2);
            }
        }
    }

    constexpr bool operator()(uint32_t m) const {
        if (linear) return m * linearFactor <= linearLimit;
        BigUint left = denominator;
        for (int i = 0; i < 5; ++i) left *= m;
        return left <= powerLimit;
    }
};

/// The value at n / d rounded down to 25 significant bits: m * 2^-e with 2^24 <= m < 2^25.
struct Truncated {
    uint32_t m;
    int e;
};

/// The curve in double precision, within a few units in the 16th digit: a first guess, checked exactly below.
constexpr double approximateCurve(uint32_t n, uint32_t d) {
    if (isLinear(n, d)) return 25.0 * n / (323.0 * d);
    const double x = (200.0 * n + 11.0 * d) / (211.0 * d);
    const double x2 = x * x, x4 = x2 * x2, x12 = x4 * x4 * x4;
    double y = 1.0;  // Newton's method for y^5 = x^12, from above
    for (int i = 0; i < 40; ++i) {
        const double y4 = y * y * y * y;
        y -= (y - x12 / y4) / 5.0;
    }
    return y;
}

constexpr Truncated truncateCurve(uint32_t n, uint32_t d) {
    double scaled = approximateCurve(n, d) * (1u << 24);
    int e = 24;
    for (; scaled < (1u << 24); scaled *= 2) ++e;
    const AtMostCurve atMost(n, d, e);
    auto m = static_cast<uint32_t>(scaled);
    while (!atMost(m)) --m;
    while (atMost(m + 1)) ++m;
    return {m, e};
}

constexpr float toFloat(uint32_t m, int e) {
    return static_cast<float>(m) / static_cast<float>(uint64_t{1} << e);
}

/// The curve crosses no float and no middle between floats inside (0, 1): 12/5 powers of these rationals are
/// irrational or not dyadic. So rounding to nearest has no ties, and a threshold lies strictly between two
/// floats.
template <uint32_t n, uint32_t d>
constexpr float kDecoded = [] {
    if (n == 0 || n == d) return static_cast<float>(n / d);
    const Truncated t = truncateCurve(n, d);
    return toFloat((t.m + 1) & ~1u, t.e);
}();

/// The bits of the first float above the threshold between kCode and kCode + 1.
template <uint32_t kCode>
constexpr uint32_t kThreshold = [] {
    const Truncated t = truncateCurve(2 * kCode + 1, 510);
    return std::bit_cast<uint32_t>(toFloat((t.m & ~1u) + 2, t.e));
}();

/// The curve at i / kMax, i from 0 to kMax.
template <uint32_t kMax, std::size_t... kCodes>
constexpr std::array<float, kMax + 1> decodeTable(std::index_sequence<kCodes...>) {
    return {kDecoded<kCodes, kMax>...};
}

template <std::size_t... kCodes>
constexpr std::array<uint32_t, 255> thresholds(std::index_sequence<kCodes...>) {
    return {kThreshold<kCodes>...};
}

constexpr std::array<uint32_t, kSrgbBuckets> encodeTable() {
    const std::array<uint32_t, 255> edges = thresholds(std::make_index_sequence<255>{});
    std::array<uint32_t, kSrgbBuckets> table{};
    uint32_t code = 0;
    for (uint32_t bucket = 0; bucket < kSrgbBuckets; ++bucket) {
        const uint32_t first = (kSrgbFirstBucket + bucket) << 16;
        table[bucket] = code << 17 | 0x10000u;
        if (code < 255 && edges[code] - first < 0x10000u) {
            table[bucket] = code << 17 | (edges[code] - first);
            ++code;
        }
    }
    return code == 255 ? table : throw "a bucket holds more than one threshold";
}

}  // namespace

constexpr std::array<float, 256> kSrgbToLinear = decodeTable<255>(std::make_index_sequence<256>{});
constexpr std::array<float, 187> kSrgbToLinear186 = decodeTable<186>(std::make_index_sequence<187>{});
constexpr std::array<float, 379> kSrgbToLinear378 = decodeTable<378>(std::make_index_sequence<379>{});
constexpr std::array<uint32_t, kSrgbBuckets> kSrgbFromLinear = encodeTable();

}  // namespace vernier
