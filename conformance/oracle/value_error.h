// By how much what a shader computes may be off.
#pragma once

#include "conformance/oracle/oracle.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::exact {

/// Relative to the larger of a value and 1.
struct ValueError {
    double functions = 0;  // of the built-in functions that the module uses
    double interpolation = OracleRules().interpolationError;

    /// Of a value of this size; `varies`: with the inputs. What does not is off by a few roundings of floats.
    double of(double value, bool varies) const {
        constexpr double kRoundings = 0x1p-22;
        const double magnitude = std::isfinite(value) ? std::max(1.0, std::abs(value)) : 1.0;
        return (functions + (varies ? interpolation : kRoundings)) * magnitude;
    }
};

}  // namespace vernier::conformance::exact
