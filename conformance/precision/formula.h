// Formulas of functions, written once for doubles, for exact numbers and for what Vulkan permits.
// To be included after vector_math.h.
#pragma once

#include <cmath>
#include <type_traits>

#include "conformance/precision/bounded.h"
#include "spirv_interp/reference/number.h"

namespace vernier::precision {

inline double inversesqrt(double x) {
    return 1 / std::sqrt(x);
}
inline reference::Real inversesqrt(const reference::Real& x) {
    return reference::Real(1) / sqrt(x);
}

}  // namespace vernier::precision

/// An expression in x[0], x[1]..., and T, their type. Unqualified names are those of that type.
#define VERNIER_FORMULA(expression)                                                                                   \
    [](const auto* x) {                                                                                               \
        using std::acos, std::acosh, std::asin, std::asinh, std::atan, std::atan2, std::atanh, std::cos, std::cosh,   \
            std::exp, std::exp2, std::fabs, std::floor, std::fma, std::log, std::log2, std::pow, std::sin, std::sinh, \
            std::sqrt, std::tan, std::tanh, std::trunc;                                                               \
        using T = std::remove_cvref_t<decltype(*x)>;                                                                  \
        return T(expression);                                                                                         \
    }
