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

uint32_t operandBits(const Function& function, uint64_t call, uint32_t k, uint64_t stride) {
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
    for (uint32_t k = 0; k < function.operands; ++k) {
        operands[k].resize(count);
        values[k].resize(count);
    }
    size_t calls = 0;
    for (uint64_t index = first; index < first + count; ++index) {
        double x[kMaxOperands] = {};
        bool usable = true;
        for (uint32_t k = 0; k < function.operands; ++k) {
            const uint32_t bits = operandBits(function, index, k, stride);
            operands[k][calls] = std::bit_cast<float>(bits);
            x[k] = values[k][calls] = operandValue(function.operand, bits);
            usable = usable & ((std::fabs(x[k]) < kUnknown) | (function.exact == nullptr));
        }
        usable = usable && (function.covers == nullptr || function.covers(x));
        calls += usable ? 1 : 0;
    }
    for (uint32_t k = 0; k < function.operands; ++k) {
        operands[k].resize(calls);
        values[k].resize(calls);
    }
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

uint64_t callCount(const Function& function, uint64_t stride, uint64_t samples) {
    if (function.domain == Domain::codes) return 1u << 16;
    constexpr uint64_t kFloats = uint64_t{1} << 32;
    return function.domain == Domain::floats ? (kFloats + stride - 1) / stride : samples;
}

}  // namespace vernier::precision
