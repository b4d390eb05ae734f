// The tables of srgb.h, computed by the compiler in integer arithmetic: no rounding but the last.
//
// For v = h / 510 (h even: a code; h odd: half-way between two) the curve's linear value is
//     v / 12.92 = 5h / 32946                                     up to v = 0.04045,
//     ((v + 0.055) / 1.055)^2.4 = ((20h + 561) / 10761)^(12/5)   above,
// so that a float m * 2^-e is at most that value if and only if
//     m * 32946 <= 5h * 2^e,   or   m^5 * 10761^12 <= (20h + 561)^12 * 2^5e.
#include "runtime/format/srgb.h"

#include <cstddef>
#include <utility>

namespace vernier {
namespace {

/// Unsigned integers below 2^448, enough for the products above: 5 * 25 + 162 bits on the left, 162 + 5 * 39
/// on the right.
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

constexpr bool isLinear(uint32_t h) {
    return h * 100000 <= 4045 * 510;
}  // h / 510 <= 0.04045

/// m * 2^-e <= the curve's value at h / 510, for one h and e.
struct AtMostCurve {
    bool linear;
    uint64_t linearLimit = 0;
    BigUint powerLimit{0};

    constexpr AtMostCurve(uint32_t h, int e) : linear(isLinear(h)) {
        if (linear) {
            linearLimit = (uint64_t{5} * h) << e;
        } else {
            powerLimit = power(20 * h + 561, 12);
            for (int i = 0; i < 5; ++i) {
                powerLimit *= 1u << (e / 2);
                powerLimit *= 1u << (e - e / 2);
            }
        }
    }

    constexpr bool operator()(uint32_t m) const {
        if (linear) return m * uint64_t{32946} <= linearLimit;
        BigUint left = kDenominator;
        for (int i = 0; i < 5; ++i) left *= m;
        return left <= powerLimit;
    }

    static constexpr BigUint kDenominator = power(10761, 12);
};

/// The value at h / 510 rounded down to 25 significant bits: m * 2^-e with 2^24 <= m < 2^25.
struct Truncated {
    uint32_t m;
    int e;
};

/// The curve in double precision, within a few units in the 16th digit: a first guess, checked exactly below.
constexpr double approximateCurve(uint32_t h) {
    if (isLinear(h)) return 5.0 * h / 32946.0;
    const double x = (20.0 * h + 561.0) / 10761.0;
    const double x2 = x * x, x4 = x2 * x2, x12 = x4 * x4 * x4;
    double y = 1.0;  // Newton's method for y^5 = x^12, from above
    for (int i = 0; i < 40; ++i) {
        const double y4 = y * y * y * y;
        y -= (y - x12 / y4) / 5.0;
    }
    return y;
}

constexpr Truncated truncateCurve(uint32_t h) {
    double scaled = approximateCurve(h) * (1u << 24);
    int e = 24;
    for (; scaled < (1u << 24); scaled *= 2) ++e;
    const AtMostCurve atMost(h, e);
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
template <uint32_t kCode>
constexpr float kDecoded = [] {
    if (kCode == 0 || kCode == 255) return static_cast<float>(kCode / 255);
    const Truncated t = truncateCurve(2 * kCode);
    return toFloat((t.m + 1) & ~1u, t.e);
}();

/// The bits of the first float above the threshold between kCode and kCode + 1.
template <uint32_t kCode>
constexpr uint32_t kThreshold = [] {
    const Truncated t = truncateCurve(2 * kCode + 1);
    return std::bit_cast<uint32_t>(toFloat((t.m & ~1u) + 2, t.e));
}();

template <std::size_t... kCodes>
constexpr std::array<float, 256> decodeTable(std::index_sequence<kCodes...>) {
    return {kDecoded<kCodes>...};
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

constexpr std::array<float, 256> kSrgbToLinear = decodeTable(std::make_index_sequence<256>{});
constexpr std::array<uint32_t, kSrgbBuckets> kSrgbFromLinear = encodeTable();

}  // namespace vernier
