// Random numbers that are the same everywhere: std::uniform_real_distribution may differ between libraries.
#pragma once

#include <cstdint>

namespace samples {

/// Numbers drawn in one expression come in an order that C++ leaves to the compiler: draw them into variables, or
/// between braces, which go from left to right.
class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed) {}

    /// 32 bits: the splitmix64 generator (Steele, Lea, Flood 2014), upper half.
    uint32_t bits() {
        uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return static_cast<uint32_t>((z ^ (z >> 31)) >> 32);
    }
    /// low <= x < high.
    float between(float low, float high) {
        return low + (high - low) * (static_cast<float>(bits() >> 8) * (1.0f / 16777216));
    }
    /// 0 .. count - 1.
    uint32_t below(uint32_t count) { return static_cast<uint32_t>(uint64_t{bits()} * count >> 32); }

  private:
    uint64_t state_;
};

}  // namespace samples
