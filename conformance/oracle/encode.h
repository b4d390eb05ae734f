// Exact conversion between numbers and the stored codes of a format component.
//
// Vulkan, Conversion From Floating-Point to Normalized Fixed-Point: either of the two codes around the exact
// value is legal, the nearest one should be used. The same holds for float formats (rounding mode undefined;
// overflow may go to the largest finite value or to infinity).
#pragma once

#include "conformance/oracle/exact.h"
#include "conformance/oracle/pixel_format.h"

#include <array>
#include <cstdint>
#include <optional>

namespace vernier::conformance::exact {

/// The codes permitted for a value: those of the neighbours below and above (equal when the value is
/// representable), and the nearest one, ties to the even code.
struct CodeSet {
    uint64_t below = 0, above = 0, nearest = 0;
    bool permits(uint64_t code) const { return code == below || code == above; }
};

/// Codes for a value in one component. sRGB takes linear values, integer formats integers. Not for
/// sharedExponent.
CodeSet encode(const Component& component, const Rational& value);

/// The value of a code; nothing for infinities and NaN. sRGB codes are rounded to the nearest double after an
/// exact power. Not for sharedExponent.
std::optional<Rational> decode(const Component& component, uint64_t code);

/// E5B9G9R9 by the formula of the specification (Shared Exponent to RGB): the shared exponent is raised when
/// the largest channel would round up to 2^9.
uint32_t encodeSharedExponent(const std::array<Rational, 3>& rgb);
std::array<Rational, 3> decodeSharedExponent(uint32_t code);

/// Whether the sRGB encoding of a linear value is at least `encoded`, both in [0, 1]: decided without roots,
/// since 1.055 x^(1/2.4) - 0.055 >= t exactly when x^5 >= ((t + 0.055) / 1.055)^12.
bool srgbReaches(const Rational& linear, const Rational& encoded);

}  // namespace vernier::conformance::exact
