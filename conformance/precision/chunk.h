// A stretch of the calls that are measured: the operands, and what all tiers' results are held against.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "conformance/precision/evaluator.h"

namespace vernier::precision {

/// Rows of equal length, one element per call. A plain value, kept between chunks for its memory.
struct Chunk {
    Operands operands;                                     // as bits
    std::array<std::vector<double>, kMaxOperands> values;  // as numbers
    std::vector<double> approximate;                       // in double, infinities included
    std::vector<double> bounded;                           // the same, infinities as the power of two after the largest
    std::vector<double> ulp, inverseUlp;                   // of the result
    std::vector<double> permitted;                         // error that Vulkan permits; infinite where it states none
    std::vector<double> scale;                             // of the promises

    /// The calls first .. first + count - 1 of a function whose operands are every stride-th of their domain, but for
    /// those that it does not cover.
    void fill(const Function& function, uint64_t first, uint64_t count, uint64_t stride);
    size_t size() const { return approximate.size(); }
    std::array<double, kMaxOperands> call(size_t i) const;
    /// The bits of the call's operands, of either width.
    std::array<uint64_t, kMaxOperands> callBits(const Function& function, size_t i) const;
};

/// Calls in a function's domain: `samples` of those domains that are too large to be gone through.
uint64_t callCount(const Function& function, uint64_t stride, uint64_t samples);

}  // namespace vernier::precision
