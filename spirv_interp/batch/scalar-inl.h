// Integer and float operations on one value, for the lane-at-a-time handlers of both widths. Total functions:
// no input is undefined behaviour.
#if defined(VERNIER_BATCH_SCALAR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERNIER_BATCH_SCALAR_INL_H
#undef VERNIER_BATCH_SCALAR_INL_H
#else
#define VERNIER_BATCH_SCALAR_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE::scalar {

template <class T>
inline constexpr int kBits = static_cast<int>(sizeof(T) * 8);
template <class T>
using Double = std::conditional_t<sizeof(T) == 8, __int128, int64_t>;
template <class T>
using UnsignedDouble = std::conditional_t<sizeof(T) == 8, unsigned __int128, uint64_t>;

template <class T>
inline T smulHigh(T a, T b) {
    return static_cast<T>((static_cast<Double<T>>(a) * b) >> kBits<T>);
}
template <class T>
inline T umulHigh(T a, T b) {
    return static_cast<T>((static_cast<UnsignedDouble<T>>(a) * b) >> kBits<T>);
}

/// Whether integers of 32 bits are divided as doubles: loops over them become vector code, if there are no branches,
/// not even those of a choice.
template <class T>
inline constexpr bool kVectorQuotients = HWY_TARGET == HWY_AVX3 && sizeof(T) == 4;

/// 1 instead of 0.
template <class T>
inline T divisorOf(T b) {
    return static_cast<T>(b | static_cast<T>(b == 0));
}
/// The quotient, towards zero. A double has room for it and for how far it is from the next integer: the division
/// rounds to no other. What vectors of doubles convert to is an integer of 64 bits at most. `b` is not 0.
template <class T>
inline T quotient(T a, T b) {
    return static_cast<T>(static_cast<int64_t>(static_cast<double>(a) / static_cast<double>(b)));
}
/// b where `condition`, else 0.
template <class T>
inline T keptIf(bool condition, T b) {
    using U = std::make_unsigned_t<T>;
    return static_cast<T>(static_cast<U>(b) & (U{0} - static_cast<U>(condition)));
}

/// INT_MIN / -1 is INT_MIN; a division by zero gives 0, remainders included.
template <class T>
inline T sdiv(T a, T b) {
    using U = std::make_unsigned_t<T>;
    if constexpr (kVectorQuotients<T>) return keptIf(b != 0, quotient(a, divisorOf(b)));
    if (b == 0) return 0;
    return b == -1 ? static_cast<T>(U{0} - static_cast<U>(a)) : a / b;
}
template <class T>
inline T srem(T a, T b) {
    if constexpr (kVectorQuotients<T>) {
        using U = std::make_unsigned_t<T>;
        const T divisor = divisorOf(b);  // 1 leaves 0
        return static_cast<T>(static_cast<U>(a) - static_cast<U>(quotient(a, divisor)) * static_cast<U>(divisor));
    }
    return b == 0 || b == -1 ? 0 : a % b;
}
template <class T>
inline T smod(T a, T b) {
    using U = std::make_unsigned_t<T>;
    const T remainder = srem(a, b);
    const bool otherSign = (remainder != 0) & ((remainder ^ b) < 0);
    return static_cast<T>(static_cast<U>(remainder) + static_cast<U>(keptIf(otherSign, b)));
}
template <class T>
inline T udiv(T a, T b) {
    if constexpr (kVectorQuotients<T>) return keptIf(b != 0, quotient(a, divisorOf(b)));
    return b == 0 ? 0 : a / b;
}
template <class T>
inline T umod(T a, T b) {
    if constexpr (kVectorQuotients<T>) return a - quotient(a, divisorOf(b)) * divisorOf(b);
    return b == 0 ? 0 : a % b;
}

/// `count` ones from bit `offset` on. Offsets and counts beyond the word are cut to it.
template <class T>
inline T fieldMask(uint32_t offset, uint32_t count) {
    constexpr uint32_t kWidth = kBits<T>;
    if (offset >= kWidth) return 0;
    const T ones = count >= kWidth ? ~T{0} : static_cast<T>((T{1} << count) - 1);
    return static_cast<T>(ones << offset);
}
template <class T>
inline T bitFieldInsert(T base, T insert, uint32_t offset, uint32_t count) {
    const T mask = fieldMask<T>(offset, count);
    const T moved = offset >= static_cast<uint32_t>(kBits<T>) ? T{0} : static_cast<T>(insert << offset);
    return (base & ~mask) | (moved & mask);
}
template <class T>
inline T bitFieldUExtract(T base, uint32_t offset, uint32_t count) {
    if (offset >= static_cast<uint32_t>(kBits<T>)) return 0;
    return (base & fieldMask<T>(offset, count)) >> offset;
}
template <class T>
inline T bitFieldSExtract(T base, uint32_t offset, uint32_t count) {
    constexpr uint32_t kWidth = kBits<T>;
    if (offset >= kWidth || count == 0) return 0;
    const uint32_t width = count < kWidth - offset ? count : kWidth - offset;
    const T top = static_cast<T>(bitFieldUExtract(base, offset, width) << (kWidth - width));
    return static_cast<T>(static_cast<std::make_signed_t<T>>(top) >> (kWidth - width));
}
template <class T>
inline T bitReverse(T a) {
    T result = 0;
    for (int k = 0; k < kBits<T>; ++k) result = static_cast<T>(result << 1 | (a >> k & 1));
    return result;
}
template <class T>
inline T bitCount(T a) {
    return static_cast<T>(std::popcount(a));
}
/// -1 when there is no such bit.
template <class T>
inline T findILsb(T a) {
    return a == 0 ? ~T{0} : static_cast<T>(std::countr_zero(a));
}
template <class T>
inline T findUMsb(T a) {
    return static_cast<T>(kBits<T> - 1 - std::countl_zero(a));
}
template <class T>
inline T findSMsb(T a) {
    return findUMsb(static_cast<T>(static_cast<std::make_signed_t<T>>(a) < 0 ? ~a : a));
}
template <class T>
inline T addCarry(T a, T b) {
    return static_cast<T>(a + b) < a ? 1 : 0;
}
template <class T>
inline T subBorrow(T a, T b) {
    return a < b ? 1 : 0;
}

/// The layout of an IEEE format.
template <class F>
struct Format;
template <>
struct Format<float> {
    using Bits = uint32_t;
    static constexpr int kMantissa = 23, kBias = 127;
};
template <>
struct Format<double> {
    using Bits = uint64_t;
    static constexpr int kMantissa = 52, kBias = 1023;
};

/// 2^exponent; `exponent` within the normal range.
template <class F>
inline F powerOfTwo(int exponent) {
    using B = typename Format<F>::Bits;
    return std::bit_cast<F>(static_cast<B>(exponent + Format<F>::kBias) << Format<F>::kMantissa);
}

/// x * 2^exponent, rounded once: of the three factors at most the last can round.
template <class F>
inline F ldexp(F x, int32_t exponent) {
    constexpr int kStep = Format<F>::kBias - 1;
    const int wanted = exponent > 4 * kStep ? 4 * kStep : exponent < -4 * kStep ? -4 * kStep : exponent;
    if (wanted >= 0) {
        F result = x;
        int left = wanted;
        for (; left > kStep; left -= kStep) result *= powerOfTwo<F>(kStep);
        return result * powerOfTwo<F>(left);
    }
    // Downwards: the value is first made at least twice the smallest normal number away from rounding.
    const F unit = x != x || x == 0 || x - x != 0 ? F{1} : x;
    const auto bits = std::bit_cast<typename Format<F>::Bits>(unit);
    const int biased = static_cast<int>(bits >> Format<F>::kMantissa & (2 * Format<F>::kBias + 1));
    const int lowest = 1 - Format<F>::kBias;
    // A step that keeps the value normal is exact; what is left is done in one multiplication.
    F result = x;
    int left = wanted;
    int room = biased == 0 ? 0 : (biased - Format<F>::kBias) - lowest;
    while (left < 0 && room > 0) {
        const int step = -left < room ? -left : room;
        const int part = step < kStep ? step : kStep;
        result *= powerOfTwo<F>(-part);
        left += part;
        room -= part;
    }
    if (left < lowest) return result * powerOfTwo<F>(lowest) * powerOfTwo<F>(lowest);
    return left == 0 ? result : result * powerOfTwo<F>(left);
}

/// x = mantissa * 2^exponent with |mantissa| in [0.5, 1); zero, infinities and NaN give themselves and 0.
template <class F>
struct Split {
    F mantissa;
    int32_t exponent;
};
template <class F>
inline Split<F> frexp(F x) {
    using B = typename Format<F>::Bits;
    if (x == 0 || x - x != 0) return {x, 0};
    constexpr int kMantissa = Format<F>::kMantissa;
    constexpr B kField = 2 * Format<F>::kBias + 1;
    int shift = 0;
    B bits = std::bit_cast<B>(x);
    if ((bits >> kMantissa & kField) == 0) {
        bits = std::bit_cast<B>(x * powerOfTwo<F>(kMantissa + 1));
        shift = kMantissa + 1;
    }
    const int exponent = static_cast<int>(bits >> kMantissa & kField) - (Format<F>::kBias - 1) - shift;
    bits = (bits & ~(kField << kMantissa)) | static_cast<B>(Format<F>::kBias - 1) << kMantissa;
    return {std::bit_cast<F>(bits), exponent};
}

/// Float to integer: truncates, saturates; NaN gives 0.
template <class I, class F>
inline I toInteger(F x) {
    if (x != x) return 0;
    constexpr F kEnd = static_cast<F>(std::numeric_limits<I>::max() / 2 + 1) * 2;  // one past the largest
    if (x >= kEnd) return std::numeric_limits<I>::max();
    if (x <= static_cast<F>(std::numeric_limits<I>::min())) return std::numeric_limits<I>::min();
    return static_cast<I>(x);
}

/// binary32 to binary16, ties to even.
inline uint32_t toHalf(float x) {
    const auto bits = std::bit_cast<uint32_t>(x);
    const uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7FFFFFFFu;
    if (magnitude > 0x7F800000u) {
        const uint32_t payload = magnitude >> 13 & 0x3FFu;
        return sign | 0x7C00u | (payload != 0 ? payload : 0x200u);
    }
    if (magnitude >= 0x47800000u) return sign | 0x7C00u;
    if (magnitude < 0x38800000u) {
        // Denormal halves are multiples of 2^-24: adding 1/2 makes the float adder round to them.
        const float rounded = std::bit_cast<float>(magnitude) + 0.5f;
        return sign | (std::bit_cast<uint32_t>(rounded) - 0x3F000000u);
    }
    const uint32_t rounded = magnitude + 0xFFFu + (magnitude >> 13 & 1u);
    return sign | ((rounded - 0x38000000u) >> 13);
}
inline float fromHalf(uint32_t half) {
    const uint32_t sign = (half & 0x8000u) << 16, magnitude = half & 0x7FFFu;
    if (magnitude >= 0x7C00u) return std::bit_cast<float>(sign | 0x7F800000u | (magnitude & 0x3FFu) << 13);
    // Exact: the float whose exponent is too small by 112, put right by a multiplication.
    return std::bit_cast<float>(sign | magnitude << 13) * 0x1p112f;
}

}  // namespace vernier::batch::HWY_NAMESPACE::scalar
HWY_AFTER_NAMESPACE();

#endif  // include guard
