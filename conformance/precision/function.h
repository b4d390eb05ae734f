// The functions whose precision is measured: how a shader calls each, its exact value, what Vulkan permits, and what
// each math tier promises.
#pragma once

#include <array>
#include <span>
#include <string>

#include "conformance/precision/bounded.h"
#include "spirv_interp/program.h"
#include "spirv_interp/reference/number.h"

namespace vernier::precision {

inline constexpr size_t kMaxOperands = 6;
inline constexpr std::array<MathTier, 4> kTiers = {MathTier::fast, MathTier::standard, MathTier::fine,
                                                   MathTier::reference};
inline constexpr std::array<const char*, 4> kTierNames = {"fast", "standard", "fine", "reference"};

/// What a tier promises: an error of at most `ulp` ULP, or of at most `absolute`, whichever is more. Negative: nothing
/// beyond what Vulkan demands.
struct Promise {
    double ulp = -1, absolute = 0;
};

/// Which operands are tried.
enum class Domain : uint8_t {
    floats,      // every float, by stride (one operand)
    stratified,  // random bits, moderate numbers, all magnitudes, near one
    moderate,    // [-8, 8] and magnitudes 2^-10 to 2^10
};

struct Function {
    std::string name;
    std::string glsl;  // in the floats a, b, c or the vectors u and v
    uint32_t operands = 1;
    Domain domain = Domain::floats;
    std::string limitText;  // Vulkan's limit in words

    double (*approximate)(const double*) = nullptr;  // good to 2^-25 ULP of float, unless `cancels`
    reference::Real (*exact)(const reference::Real*) = nullptr;
    Bounded (*permitted)(const Bounded*) = nullptr;  // by Vulkan
    bool cancels = false;                            // the formula loses digits: only exact() tells the error
    bool (*covers)(const double*) = nullptr;         // operands for which the result is defined; nullptr: all
    std::array<Promise, 4> promises;                 // by tier
    /// Multiplies the promises: errors that grow with the operands by nature (pow).
    double (*scale)(const double*) = nullptr;
};

std::span<const Function> functions();

}  // namespace vernier::precision
