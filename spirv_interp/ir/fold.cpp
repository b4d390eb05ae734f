#include "spirv_interp/ir/fold.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "spirv_interp/ir/ops.h"

namespace vernier::ir {
namespace {

template <class F>
struct BitsOf {
    using type = uint32_t;
};
template <>
struct BitsOf<double> {
    using type = uint64_t;
};

template <class F>
F asFloat(uint64_t bits) {
    return std::bit_cast<F>(static_cast<typename BitsOf<F>::type>(bits));
}

/// A NaN's bits differ between processors and instructions: such a result is left to the interpreter.
template <class F>
std::optional<uint64_t> floatBits(F value) {
    if (value != value) return std::nullopt;
    return std::bit_cast<typename BitsOf<F>::type>(value);
}

template <class F>
std::optional<uint64_t> foldFloat(Op op, std::span<const uint64_t> operands) {
    const F x = operands.empty() ? F{} : asFloat<F>(operands[0]);
    const F y = operands.size() > 1 ? asFloat<F>(operands[1]) : F{};
    const F z = operands.size() > 2 ? asFloat<F>(operands[2]) : F{};
    if (x != x || y != y || z != z) return std::nullopt;
    switch (op) {
        case Op::fadd:
            return floatBits<F>(x + y);
        case Op::fsub:
            return floatBits<F>(x - y);
        case Op::fmul:
            return floatBits<F>(x * y);
        case Op::fdiv:
            return floatBits<F>(x / y);
        case Op::fneg:
            return floatBits<F>(-x);
        case Op::fabs:
            return floatBits<F>(std::fabs(x));
        case Op::ffloor:
            return floatBits<F>(std::floor(x));
        case Op::fceil:
            return floatBits<F>(std::ceil(x));
        case Op::ftrunc:
            return floatBits<F>(std::trunc(x));
        case Op::fsqrt:
            return floatBits<F>(std::sqrt(x));
        case Op::ffma:
            return floatBits<F>(std::fma(x, y, z));
        case Op::fmin:
        case Op::fmax:
            // Which zero comes out of min(-0, +0) is the interpreter's affair.
            if (x == y) return operands[0] == operands[1] ? floatBits<F>(x) : std::nullopt;
            return floatBits<F>((op == Op::fmin) == (x < y) ? x : y);
        case Op::fsign:
            if (x == F{}) return std::nullopt;
            return floatBits<F>(x > F{} ? F{1} : F{-1});
        default:
            return std::nullopt;
    }
}

template <class U>
std::optional<uint64_t> foldInteger(Op op, std::span<const uint64_t> operands) {
    using S = std::make_signed_t<U>;
    constexpr U kWidth = sizeof(U) * 8;
    const U x = operands.empty() ? U{} : static_cast<U>(operands[0]);
    const U y = operands.size() > 1 ? static_cast<U>(operands[1]) : U{};
    const S sx = static_cast<S>(x), sy = static_cast<S>(y);
    const bool overflow = sx == std::numeric_limits<S>::min() && sy == -1;
    const auto bits = [](U value) { return std::optional<uint64_t>(value); };
    switch (op) {
        case Op::iadd:
            return bits(x + y);
        case Op::isub:
            return bits(x - y);
        case Op::imul:
            return bits(x * y);
        case Op::udiv:
            return bits(y == 0 ? 0 : x / y);
        case Op::umod:
            return bits(y == 0 ? 0 : x % y);
        case Op::sdiv:
            return bits(y == 0 ? 0 : overflow ? x : static_cast<U>(sx / sy));
        case Op::srem:
            if (y == 0) return std::nullopt;
            return bits(overflow ? 0 : static_cast<U>(sx % sy));
        case Op::smod: {
            if (y == 0) return std::nullopt;
            const S rest = overflow ? S{0} : static_cast<S>(sx % sy);
            return bits(static_cast<U>(rest != 0 && (rest < 0) != (sy < 0) ? rest + sy : rest));
        }
        case Op::ineg:
            return bits(U{0} - x);
        case Op::iabs:
            return bits(sx < 0 ? U{0} - x : x);
        case Op::isign:
            return bits(static_cast<U>(sx > 0 ? 1 : sx < 0 ? -1 : 0));
        case Op::smin:
            return bits(sx < sy ? x : y);
        case Op::smax:
            return bits(sx > sy ? x : y);
        case Op::umin:
            return bits(x < y ? x : y);
        case Op::umax:
            return bits(x > y ? x : y);
        case Op::iand:
            return bits(x & y);
        case Op::ior:
            return bits(x | y);
        case Op::ixor:
            return bits(x ^ y);
        case Op::inot:
            return bits(~x);
        case Op::shl:
            return bits(x << (y % kWidth));
        case Op::lshr:
            return bits(x >> (y % kWidth));
        case Op::ashr:
            return bits(static_cast<U>(sx >> (y % kWidth)));
        case Op::bitCount:
            return bits(static_cast<U>(std::popcount(x)));
        case Op::addCarry:
            return bits(static_cast<U>(x + y) < x ? 1 : 0);
        case Op::subBorrow:
            return bits(x < y ? 1 : 0);
        case Op::umulHigh:
            if constexpr (sizeof(U) == 4) return bits(static_cast<U>(static_cast<uint64_t>(x) * y >> 32));
            return std::nullopt;
        case Op::smulHigh:
            if constexpr (sizeof(U) == 4) return bits(static_cast<U>(static_cast<int64_t>(sx) * sy >> 32));
            return std::nullopt;
        default:
            return std::nullopt;
    }
}

template <class F>
std::optional<uint64_t> foldFloatCompare(Op op, std::span<const uint64_t> operands) {
    const F x = asFloat<F>(operands[0]);
    const F y = operands.size() > 1 ? asFloat<F>(operands[1]) : F{};
    const bool unordered = x != x || y != y;
    switch (op) {
        case Op::foeq:
            return !unordered && x == y;
        case Op::fone:
            return !unordered && x != y;
        case Op::folt:
            return x < y;
        case Op::fole:
            return x <= y;
        case Op::fueq:
            return unordered || x == y;
        case Op::fune:
            return unordered || x != y;
        case Op::fult:
            return unordered || x < y;
        case Op::fule:
            return unordered || x <= y;
        case Op::fisnan:
            return x != x;
        case Op::fisinf:
            return std::isinf(x);
        default:
            return std::nullopt;
    }
}

template <class U>
std::optional<uint64_t> foldIntegerCompare(Op op, std::span<const uint64_t> operands) {
    using S = std::make_signed_t<U>;
    const U x = static_cast<U>(operands[0]), y = static_cast<U>(operands[1]);
    switch (op) {
        case Op::ieq:
            return x == y;
        case Op::ine:
            return x != y;
        case Op::slt:
            return static_cast<S>(x) < static_cast<S>(y);
        case Op::sle:
            return static_cast<S>(x) <= static_cast<S>(y);
        case Op::ult:
            return x < y;
        case Op::ule:
            return x <= y;
        default:
            return std::nullopt;
    }
}

/// Truncates, saturates; NaN gives 0.
template <class I, class F>
uint64_t toInteger(F value) {
    using U = std::make_unsigned_t<I>;
    if (value != value) return 0;
    constexpr F kLow = static_cast<F>(std::numeric_limits<I>::min());
    // max + 1 is a power of two, exact in any float.
    const F above = std::ldexp(F{1}, std::numeric_limits<I>::digits);
    if (value >= above) return static_cast<U>(std::numeric_limits<I>::max());
    if (value <= kLow) return static_cast<U>(std::numeric_limits<I>::min());
    return static_cast<U>(static_cast<I>(value));
}

template <class F>
uint64_t floatToInteger(Op op, Type type, F value) {
    if (op == Op::ftos) return type == Type::i32 ? toInteger<int32_t>(value) : toInteger<int64_t>(value);
    return type == Type::i32 ? toInteger<uint32_t>(value) : toInteger<uint64_t>(value);
}

template <class F>
std::optional<uint64_t> integerToFloat(Op op, Type from, uint64_t bits) {
    if (from == Type::i32) {
        const auto word = static_cast<uint32_t>(bits);
        return floatBits<F>(op == Op::stof ? static_cast<F>(static_cast<int32_t>(word)) : static_cast<F>(word));
    }
    return floatBits<F>(op == Op::stof ? static_cast<F>(static_cast<int64_t>(bits)) : static_cast<F>(bits));
}

/// The binary16 value next to x: a multiple of the last of its 11 bits, or of 2^-24 for denormals.
float toHalf(double x, bool towardsZero) {
    if (x == 0 || !std::isfinite(x)) return static_cast<float>(x);
    int exponent = 0;
    std::frexp(x, &exponent);
    const int step = std::max(exponent - 11, -24);
    const double units = std::ldexp(x, -step);
    const double rounded = std::ldexp(towardsZero ? std::trunc(units) : std::nearbyint(units), step);
    constexpr double kLargest = 65504;
    if (std::fabs(rounded) <= kLargest) return static_cast<float>(rounded);
    return static_cast<float>(std::copysign(towardsZero ? kLargest : HUGE_VAL, x));
}

std::optional<uint64_t> foldConversion(Op op, Type type, Type from, uint64_t x) {
    switch (op) {
        case Op::ftos:
        case Op::ftou:
            return from == Type::f32 ? floatToInteger(op, type, asFloat<float>(x))
                                     : floatToInteger(op, type, asFloat<double>(x));
        case Op::stof:
        case Op::utof:
            return type == Type::f32 ? integerToFloat<float>(op, from, x) : integerToFloat<double>(op, from, x);
        case Op::ftof:
            if (from == type) return std::nullopt;
            return type == Type::f32 ? floatBits<float>(static_cast<float>(asFloat<double>(x)))
                                     : floatBits<double>(static_cast<double>(asFloat<float>(x)));
        case Op::ftoh:
        case Op::ftohZero:
            return floatBits<float>(toHalf(
                from == Type::f32 ? static_cast<double>(asFloat<float>(x)) : asFloat<double>(x), op == Op::ftohZero));
        case Op::zext:
            return from == Type::b1 ? x & 1 : x;
        case Op::bitcast:
            return x;
        case Op::itrunc:
            return x & 0xFFFFFFFFu;
        case Op::sext:
            return type == Type::i64 ? static_cast<uint64_t>(static_cast<int64_t>(static_cast<int32_t>(x))) : x;
        default:
            return std::nullopt;
    }
}

std::optional<uint64_t> foldAny(Op op, Type type, uint64_t imm, std::span<const uint64_t> x) {
    if (x.empty() || opInfo(op).kind != 'P' || op == Op::phi) return std::nullopt;
    const auto from = static_cast<Type>(imm);
    if (op >= Op::fadd && op <= Op::ffrexpMantissa) {
        if (op == Op::fldexp) return std::nullopt;
        return type == Type::f32 ? foldFloat<float>(op, x) : foldFloat<double>(op, x);
    }
    if (op >= Op::iadd && op <= Op::subBorrow) {
        return type == Type::i32 ? foldInteger<uint32_t>(op, x) : foldInteger<uint64_t>(op, x);
    }
    if (op >= Op::foeq && op <= Op::fisinf) {
        return from == Type::f32 ? foldFloatCompare<float>(op, x) : foldFloatCompare<double>(op, x);
    }
    if (op >= Op::ieq && op <= Op::ule) {
        return from == Type::i32 ? foldIntegerCompare<uint32_t>(op, x) : foldIntegerCompare<uint64_t>(op, x);
    }
    if (op >= Op::ftos && op <= Op::bitcast) return foldConversion(op, type, from, x[0]);
    switch (op) {
        case Op::copy:
            return x[0];
        case Op::band:
            return x[0] & x[1];
        case Op::bor:
            return x[0] | x[1];
        case Op::bxor:
            return x[0] ^ x[1];
        case Op::bnot:
            return x[0] == 0;
        case Op::select:
            return x[0] != 0 ? x[1] : x[2];
        case Op::makeWide:
            return immPair(static_cast<uint32_t>(x[0]), static_cast<uint32_t>(x[1]));
        case Op::lowWord:
            return x[0] & 0xFFFFFFFFu;
        case Op::highWord:
            return x[0] >> 32;
        default:
            return std::nullopt;
    }
}

}  // namespace

std::optional<uint64_t> foldConstant(Op op, Type type, uint64_t imm, std::span<const uint64_t> operands) {
    std::optional<uint64_t> result = foldAny(op, type, imm, operands);
    if (result && type == Type::b1) result = *result != 0 ? kTrueBits : 0;
    return result;
}

}  // namespace vernier::ir
