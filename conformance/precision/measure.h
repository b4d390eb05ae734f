// Measures errors: of every tier over the operands of a function's domain, against MPFR.
#pragma once

#include <optional>
#include <vector>

#include "conformance/precision/evaluator.h"

namespace vernier::precision {

struct Worst {
    double value = 0;
    std::array<uint64_t, kMaxOperands> operands{};  // their bits
};

/// Errors of one implementation of a function. ULP are those of the exact result; an infinite result counts as 2^128.
struct Figures {
    uint64_t calls = 0;
    Worst ulp, absolute;
    Worst limit;             // greatest share of what Vulkan permits: above 1 is outside
    Worst promise;           // greatest share of what the tier promises
    double ulpSum = 0;       // of errors against doubles: off by 2^-22 ULP a call at most
    uint64_t correct = 0;    // correctly rounded
    uint64_t wrongNaNs = 0;  // NaN where there is a result, or a number where there is none

    double mean() const { return calls == 0 ? 0 : ulpSum / static_cast<double>(calls); }
    double correctShare() const { return calls == 0 ? 0 : static_cast<double>(correct) / static_cast<double>(calls); }
    void merge(const Figures& other);
};

struct MeasureOptions {
    uint64_t stride = 61;        // of functions of one operand: every stride-th float; 1 = all 2^32
    uint64_t samples = 1 << 18;  // of the others
    uint32_t threads = 2;
    Isa isa = kLowestIsa;
    VulkanRunner* driver = nullptr;  // measured beside, over `driverSamples` calls
    uint64_t driverSamples = 1 << 20;
};

struct Measurement {
    const Function* function = nullptr;
    std::array<Figures, kTiers.size()> tiers;
    std::optional<Figures> driver;
};

Result<Measurement> measure(const Function& function, const MeasureOptions& options);

}  // namespace vernier::precision
