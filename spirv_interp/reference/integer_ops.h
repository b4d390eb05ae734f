// Integer and boolean instructions on single scalars: used for shader code and for specialisation-constant
// expressions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <spirv/unified1/spirv.hpp>

namespace vernier::reference {

inline uint64_t widthMask(uint32_t width) {
    return width >= 64 ? ~uint64_t{0} : (uint64_t{1} << width) - 1;
}

inline int64_t asSigned(uint64_t bits, uint32_t width) {
    const uint32_t unused = 64 - width;
    return static_cast<int64_t>(bits << unused) >> unused;
}

/// The result of `op` on `operands` of `width` bits (8 to 64; ignored for booleans, which are 0 or 1).
/// Integer results are cut to `width`; comparisons give 0 or 1. Nothing if `op` is none of these
/// instructions.
std::optional<uint64_t> integerOperation(spv::Op op, uint32_t width, const std::array<uint64_t, 4>& operands);

/// Number of operands of such an instruction, 0 if it is none of them.
uint32_t integerOperandCount(spv::Op op);

/// The upper half of the product of two `width`-bit integers.
uint64_t multiplyHigh(uint64_t a, uint64_t b, uint32_t width, bool isSigned);

}  // namespace vernier::reference
