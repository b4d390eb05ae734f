// Subgroup operations as GLSL expressions, each with a plain model.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vernier::test {

inline constexpr uint32_t kSize = 32;
inline constexpr uint32_t kInvocations = 80;  // the third subgroup is half there

/// One subgroup at the instruction.
struct Group {
    uint32_t active = 0;
    uint32_t u[kSize] = {};
    float f[kSize] = {};
    bool runs(uint32_t lane) const { return lane < kSize && (active >> lane & 1) != 0; }
    uint32_t first() const { return static_cast<uint32_t>(std::countr_zero(active)); }
    uint32_t taken(uint32_t lane) const { return runs(lane) ? u[lane] : 0; }
};

struct Case {
    std::string expression;  // of u (uint), f (float) and place (uint): a uint
    std::function<uint32_t(const Group&, uint32_t lane)> model;
};

std::vector<Case> integerCases();
std::vector<Case> floatCases();
std::vector<Case> doubleCases();
std::vector<Case> wideIntegerCases();
/// Of 8 and 16 bits, signed and unsigned.
std::vector<Case> narrowIntegerCases();
std::vector<Case> halfCases();
/// Votes and exchanges of values of 8, 16 and 64 bits.
std::vector<Case> otherWidthCases();
/// Votes, ballots, shuffles, quads, logic.
std::vector<Case> otherCases();

}  // namespace vernier::test
