#include "conformance/precision/chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vernier::precision {
namespace {

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
uint64_t scrambled(uint64_t n) {
    n += 0x9E3779B97F4A7C15;
    n = (n ^ n >> 30) * 0xBF58476D1CE4E5B9;
    n = (n ^ n >> 27) * 0x94D049BB133111EB;
    return n ^ n >> 31;
}

float moderateOperand(const Function& function, uint64_t call, uint32_t k) {
    const uint64_t random = scrambled(call * kMaxOperands + k);
    const auto bits = static_cast<uint32_t>(random);
    const double unit = static_cast<double>(random >> 32) * 0x1p-32, sign = (bits & 1) != 0 ? -1 : 1;
    const uint64_t stratum = call % 4;
    if (function.domain == Domain::stratified) {
        if (stratum == 0) return std::bit_cast<float>(bits);
        if (stratum == 1 && k == 0) return static_cast<float>(1 + sign * std::exp2(-24 * unit));
        if (stratum == 1) return static_cast<float>(sign * std::exp2(40 * unit - 20));
    }
    if (stratum == 2) return static_cast<float>(sign * std::exp2(20 * unit - 10));
    return stratum == 3 && function.name == "ldexp" && k == 1 ? static_cast<float>(bits % 257) - 128
                                                              : static_cast<float>(16 * unit - 8);
}

/// Operands of 64 bits: integers of any length, doubles as above, with all their digits.
uint64_t wideOperand(const Function& function, uint64_t call, uint32_t k) {
    const uint64_t random = scrambled(call * kMaxOperands + k), digits = scrambled(random);
    if (function.operand == Word::int64) return static_cast<uint64_t>(static_cast<int64_t>(digits) >> random % 64);
    if (function.operand == Word::uint64) return digits >> random % 64;
    const double unit = static_cast<double>(digits >> 11) * 0x1p-53, sign = (random & 1) != 0 ? -1 : 1;
    const uint64_t stratum = call % 4;
    const bool exponent = function.name == "double ldexp" && k == 1;
    const auto number = [&]() -> double {
        if (exponent) return static_cast<double>(random % 2049) - 1024;
        if (function.domain == Domain::stratified && stratum == 1) {
            return k == 0 ? 1 + sign * std::exp2(-53 * unit) : sign * std::exp2(40 * unit - 20);
        }
        return stratum == 2 ? sign * std::exp2(20 * unit - 10) : 16 * unit - 8;
    };
    const bool anyBits = function.domain == Domain::stratified && stratum == 0 && !exponent;
    return anyBits ? digits : std::bit_cast<uint64_t>(number());
}

uint64_t operandBits(const Function& function, uint64_t call, uint32_t k, uint64_t stride) {
    if (wordsOf(function.operand) == 2) return wideOperand(function, call, k);
    switch (function.domain) {
        case Domain::floats:
            return static_cast<uint32_t>(call * stride);
        case Domain::codes:
            return static_cast<uint32_t>(call);
        case Domain::halves:
            return static_cast<uint32_t>(scrambled(call * kMaxOperands + k) >> 48);
        default:
            return std::bit_cast<uint32_t>(moderateOperand(function, call, k));
    }
}

}  // namespace

void Chunk::fill(const Function& function, uint64_t first, uint64_t count, uint64_t stride) {
    const uint32_t words = wordsOf(function.operand);
    const auto resize = [&](size_t size) {
        for (uint32_t k = 0; k < function.operands * words; ++k) operands[k].resize(size);
        for (uint32_t k = 0; k < function.operands; ++k) values[k].resize(size);
    };
    resize(count);
    size_t calls = 0;
    for (uint64_t index = first; index < first + count; ++index) {
        double x[kMaxOperands] = {};
        bool usable = true;
        for (uint32_t k = 0; k < function.operands; ++k) {
            const uint64_t bits = operandBits(function, index, k, stride);
            operands[k * words][calls] = std::bit_cast<float>(static_cast<uint32_t>(bits));
            if (words == 2) operands[k * 2 + 1][calls] = std::bit_cast<float>(static_cast<uint32_t>(bits >> 32));
            x[k] = values[k][calls] = operandValue(function.operand, bits);
            usable = usable & ((std::fabs(x[k]) < kUnknown) | (function.exact == nullptr));
        }
        usable = usable && (function.covers == nullptr || function.covers(x));
        calls += usable ? 1 : 0;
    }
    resize(calls);
    const double* rows[kMaxOperands];
    for (size_t k = 0; k < kMaxOperands; ++k) rows[k] = values[k < function.operands ? k : 0].data();
    for (auto* row : {&approximate, &bounded, &ulp, &inverseUlp, &permitted, &scale}) row->resize(calls);
    function.approximate(rows, calls, approximate.data());
    const double overflow = overflowOf(function.result);
    for (size_t i = 0; i < calls; ++i) {
        const double result = approximate[i];
        bounded[i] = result > overflow ? overflow : result < -overflow ? -overflow : result;
        ulp[i] = ulpOf(function.result, bounded[i]);
        inverseUlp[i] = 1 / ulp[i];
    }
    std::fill(permitted.begin(), permitted.end(), kUnknown);
    if (function.permitted != nullptr) function.permitted(rows, calls, permitted.data());
    for (size_t i = 0; i < calls; ++i) {
        // Overflow is no error where the permitted interval reaches it.
        const double allowed = permitted[i], size = std::fabs(approximate[i]);
        permitted[i] = ((allowed < overflow) & (size < overflow)) ? allowed : kUnknown;
    }
    std::fill(scale.begin(), scale.end(), 1.0);
    for (size_t i = 0; function.scale != nullptr && i < calls; ++i) scale[i] = function.scale(call(i).data());
}

std::array<double, kMaxOperands> Chunk::call(size_t i) const {
    std::array<double, kMaxOperands> result{};
    for (size_t k = 0; k < kMaxOperands && !values[k].empty(); ++k) result[k] = values[k][i];
    return result;
}

std::array<uint64_t, kMaxOperands> Chunk::callBits(const Function& function, size_t i) const {
    std::array<uint64_t, kMaxOperands> result{};
    const uint32_t words = wordsOf(function.operand);
    for (uint32_t k = 0; k < function.operands; ++k) {
        result[k] = std::bit_cast<uint32_t>(operands[k * words][i]);
        if (words == 2) result[k] |= uint64_t{std::bit_cast<uint32_t>(operands[k * 2 + 1][i])} << 32;
    }
    return result;
}

uint64_t callCount(const Function& function, uint64_t stride, uint64_t samples) {
    if (function.domain == Domain::codes) return 1u << 16;
    constexpr uint64_t kFloats = uint64_t{1} << 32;
    return function.domain == Domain::floats ? (kFloats + stride - 1) / stride : samples;
}

}  // namespace vernier::precision
