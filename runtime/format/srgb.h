// The sRGB transfer function (Khronos Data Format Specification, "sRGB transfer functions"), exact: decoding
// gives the float nearest to the curve, encoding the code nearest to it, for every float.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace vernier {

/// Code -> the nearest float of its linear value.
extern const std::array<float, 256> kSrgbToLinear;

/// The nearest float of the linear value of i / 186 and i / 378: colours between 5- and 6-bit codes in thirds and
/// halves.
extern const std::array<float, 187> kSrgbToLinear186;
extern const std::array<float, 379> kSrgbToLinear378;

/// Encoding by thresholds. Threshold c is where the nearest code changes from c to c + 1. The floats between
/// 2^-13 and 1 are cut into buckets by exponent and 7 bits of mantissa (the upper half of their bits); a
/// bucket contains one threshold at most. An entry holds the code below the threshold in bits 17 and up, and
/// in bits 0..16 the lower half of the first float above the threshold, 0x10000 when there is none in the
/// bucket.
inline constexpr uint32_t kSrgbFirstBits = 114u << 23;  // 2^-13, below the first threshold
inline constexpr uint32_t kSrgbFirstBucket = kSrgbFirstBits >> 16;
inline constexpr std::size_t kSrgbBuckets = (0x3f800000u >> 16) - kSrgbFirstBucket + 1;  // the last is that of 1.0
extern const std::array<uint32_t, kSrgbBuckets> kSrgbFromLinear;

/// Clamps to [0, 1]; NaN gives 0.
inline uint32_t encodeSrgb8(float linear) {
    const float low = std::bit_cast<float>(kSrgbFirstBits);
    const float clamped = linear > low ? (linear < 1.0f ? linear : 1.0f) : low;
    const uint32_t bits = std::bit_cast<uint32_t>(clamped);
    const uint32_t entry = kSrgbFromLinear[(bits >> 16) - kSrgbFirstBucket];
    return (entry >> 17) + ((bits & 0xffffu) >= (entry & 0x1ffffu) ? 1u : 0u);
}

}  // namespace vernier
