// The functions whose precision is measured: how a shader calls each, its exact value, what Vulkan permits, and what
// each math tier promises.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "conformance/precision/bounded.h"
#include "conformance/precision/promise.h"
#include "conformance/precision/word.h"
#include "spirv_interp/program.h"
#include "spirv_interp/reference/number.h"

namespace vernier::precision {

inline constexpr size_t kMaxOperands = 6;
inline constexpr std::array<MathTier, 4> kTiers = {MathTier::fast, MathTier::standard, MathTier::fine,
                                                   MathTier::reference};
inline constexpr std::array<const char*, 4> kTierNames = {"fast", "standard", "fine", "reference"};

/// Which operands are tried.
enum class Domain : uint8_t {
    floats,      // every float, by stride (one operand)
    codes,       // all 2^16 (one operand)
    stratified,  // random bits, moderate numbers, all magnitudes, near one; integers of any length
    moderate,    // [-8, 8] and magnitudes 2^-10 to 2^10
    halves,      // random codes of halves
};

/// Computes results[i] from operands[k][i]; all kMaxOperands rows can be read.
using Row = void (*)(const double* const* operands, size_t count, double* results);

/// The loops of a formula for one call, in a form that compilers vectorise: of its values, and of its errors.
template <class Formula>
Row valueRow(Formula) {
    return [](const double* const* x, size_t count, double* results) {
        for (size_t i = 0; i < count; ++i) {
            const double call[kMaxOperands] = {x[0][i], x[1][i], x[2][i], x[3][i], x[4][i], x[5][i]};
            results[i] = Formula{}(static_cast<const double*>(call));
        }
    };
}
template <class B = Bounded, class Formula>
Row errorRow(Formula) {
    return [](const double* const* x, size_t count, double* results) {
        for (size_t i = 0; i < count; ++i) {
            const B call[kMaxOperands] = {x[0][i], x[1][i], x[2][i], x[3][i], x[4][i], x[5][i]};
            results[i] = Formula{}(static_cast<const B*>(call)).error;
        }
    };
}

struct Function {
    std::string name;
    /// A value of the result's type in the floats a, b, c or the vectors u and v; in p, q and r where operands are no
    /// floats.
    std::string glsl;
    uint32_t operands = 1;
    Domain domain = Domain::floats;
    Word operand = Word::float32, result = Word::float32;
    std::string limitText;  // Vulkan's limit in words

    Row approximate = nullptr;  // good to 2^-25 ULP of float, unless `cancels`
    /// nullptr: what `approximate` gives is exact, or as good.
    reference::Real (*exact)(const reference::Real*) = nullptr;
    Row permitted = nullptr;                  // the errors that Vulkan permits; nullptr: it states none
    bool cancels = false;                     // the formula loses digits: only exact() tells the error
    bool (*covers)(const double*) = nullptr;  // operands for which the result is defined; nullptr: all
    Promises promises;                        // by tier
    /// Multiplies the promises: errors that grow with the operands by nature (pow).
    double (*scale)(const double*) = nullptr;
    std::string scaleText;  // in words
};

std::span<const Function> functions();

/// Of pow: errors of y * log2(x) grow with it.
inline double powScale(const double* x) {
    return 1 + std::fabs(x[1] * std::log2(x[0]));
}
inline constexpr const char* kPowScale = "(1 + abs(y * log2(x)))";

/// Appends the conversions between formats, and the functions of 16-bit and of 64-bit floats.
void addConversions(std::vector<Function>& all);
void addHalves(std::vector<Function>& all);
void addDoubles(std::vector<Function>& all);

}  // namespace vernier::precision
