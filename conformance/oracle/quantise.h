// Storing a range in a format: what may be read back. The double-precision companion of encode.h, for whole
// images.
#pragma once

#include "conformance/oracle/interval.h"
#include "conformance/oracle/pixel_format.h"

#include <cstddef>
#include <cstdint>

namespace vernier::conformance::exact {

/// Distance from a code, in codes, within which a number counts as that code: a float pipeline cannot know it
/// better, and without it every code would admit its two neighbours as soon as a range has any width.
inline constexpr double kCodeTolerance = 1e-3;

/// Value read back after storing: value through the nearest code (ties to even), low through the code below,
/// high through the code above. Fixed-point formats clamp. NaN in a fixed-point component leaves the
/// component's whole range.
/// `budget` further codes are allowed between the exact number and the stored code of a fixed-point
/// component: with 1, every code less than or exactly one code away.
Interval quantise(const Component& component, const Interval& number, double budget = 0);

/// The encoded (not linear) counterpart of an sRGB value and back; used where averaging encoded values is
/// legal.
double srgbEncode(double linear);
double srgbDecode(double encoded);

/// The number of a stored code, correctly rounded up to sRGB's power. Infinities and NaN come back as such.
double decodeNumber(const Component& component, uint64_t code);

/// A whole texel; absent channels are 0, alpha 1. Integers come back as numbers.
std::array<double, 4> decodeTexel(const PixelFormat& format, const std::byte* texel);

}  // namespace vernier::conformance::exact
