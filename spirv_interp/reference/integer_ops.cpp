#include "spirv_interp/reference/integer_ops.h"

#include <bit>

namespace vernier::reference {
namespace {

uint64_t signedDivide(int64_t a, int64_t b) {
    if (b == 0) return 0;
    // Negating in unsigned arithmetic wraps for the smallest number instead of trapping.
    if (b == -1) return uint64_t{0} - static_cast<uint64_t>(a);
    return static_cast<uint64_t>(a / b);
}

/// Sign of the dividend.
int64_t signedRemainder(int64_t a, int64_t b) {
    return b == 0 || b == -1 ? 0 : a % b;
}

/// Sign of the divisor.
int64_t signedModulo(int64_t a, int64_t b) {
    const int64_t remainder = signedRemainder(a, b);
    return remainder != 0 && (remainder < 0) != (b < 0) ? remainder + b : remainder;
}

uint64_t lowBits(uint64_t count) {
    return count >= 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
}

struct Field {
    uint64_t offset, count;
};

/// Fields that stick out of the word are cut off at its end (SPIR-V leaves them undefined).
Field clampField(uint64_t offset, uint64_t count, uint32_t width) {
    offset &= 0xFFFFFFFFu;
    count &= 0xFFFFFFFFu;
    if (offset >= width) return {0, 0};
    return {offset, count > width - offset ? width - offset : count};
}

uint64_t extractField(uint64_t base, uint64_t offset, uint64_t count, uint32_t width, bool isSigned) {
    const Field field = clampField(offset, count, width);
    if (field.count == 0) return 0;
    const uint64_t bits = (base >> field.offset) & lowBits(field.count);
    const bool negative = isSigned && ((bits >> (field.count - 1)) & 1) != 0;
    return negative ? bits | ~lowBits(field.count) : bits;
}

uint64_t insertField(uint64_t base, uint64_t insert, uint64_t offset, uint64_t count, uint32_t width) {
    const Field field = clampField(offset, count, width);
    if (field.count == 0) return base;
    const uint64_t mask = lowBits(field.count) << field.offset;
    return (base & ~mask) | ((insert << field.offset) & mask);
}

uint64_t reverseBits(uint64_t bits, uint32_t width) {
    uint64_t result = 0;
    for (uint32_t i = 0; i < width; ++i) result |= ((bits >> i) & 1) << (width - 1 - i);
    return result;
}

}  // namespace

uint32_t integerOperandCount(spv::Op op) {
    switch (op) {
        case spv::OpSNegate:
        case spv::OpNot:
        case spv::OpLogicalNot:
        case spv::OpBitReverse:
        case spv::OpBitCount:
            return 1;
        case spv::OpIAdd:
        case spv::OpISub:
        case spv::OpIMul:
        case spv::OpUDiv:
        case spv::OpSDiv:
        case spv::OpUMod:
        case spv::OpSRem:
        case spv::OpSMod:
        case spv::OpShiftRightLogical:
        case spv::OpShiftRightArithmetic:
        case spv::OpShiftLeftLogical:
        case spv::OpBitwiseOr:
        case spv::OpBitwiseXor:
        case spv::OpBitwiseAnd:
        case spv::OpLogicalEqual:
        case spv::OpLogicalNotEqual:
        case spv::OpLogicalOr:
        case spv::OpLogicalAnd:
        case spv::OpIEqual:
        case spv::OpINotEqual:
        case spv::OpUGreaterThan:
        case spv::OpSGreaterThan:
        case spv::OpUGreaterThanEqual:
        case spv::OpSGreaterThanEqual:
        case spv::OpULessThan:
        case spv::OpSLessThan:
        case spv::OpULessThanEqual:
        case spv::OpSLessThanEqual:
            return 2;
        case spv::OpBitFieldSExtract:
        case spv::OpBitFieldUExtract:
            return 3;
        case spv::OpBitFieldInsert:
            return 4;
        default:
            return 0;
    }
}

std::optional<uint64_t> integerOperation(spv::Op op, uint32_t width, const std::array<uint64_t, 4>& operands) {
    const uint64_t mask = widthMask(width);
    const uint64_t a = operands[0], b = operands[1];
    const int64_t sa = asSigned(a, width), sb = asSigned(b, width);
    const uint64_t shift = b & (width - 1);
    switch (op) {
        case spv::OpSNegate:
            return (uint64_t{0} - a) & mask;
        case spv::OpNot:
            return ~a & mask;
        case spv::OpIAdd:
            return (a + b) & mask;
        case spv::OpISub:
            return (a - b) & mask;
        case spv::OpIMul:
            return (a * b) & mask;
        case spv::OpUDiv:
            return b == 0 ? 0 : a / b;
        case spv::OpSDiv:
            return signedDivide(sa, sb) & mask;
        case spv::OpUMod:
            return b == 0 ? 0 : a % b;
        case spv::OpSRem:
            return static_cast<uint64_t>(signedRemainder(sa, sb)) & mask;
        case spv::OpSMod:
            return static_cast<uint64_t>(signedModulo(sa, sb)) & mask;
        case spv::OpShiftRightLogical:
            return a >> shift;
        case spv::OpShiftRightArithmetic:
            return static_cast<uint64_t>(sa >> shift) & mask;
        case spv::OpShiftLeftLogical:
            return (a << shift) & mask;
        case spv::OpBitwiseOr:
            return a | b;
        case spv::OpBitwiseXor:
            return a ^ b;
        case spv::OpBitwiseAnd:
            return a & b;
        case spv::OpBitReverse:
            return reverseBits(a, width);
        case spv::OpBitCount:
            return static_cast<uint64_t>(std::popcount(a));
        case spv::OpBitFieldInsert:
            return insertField(a, b, operands[2], operands[3], width) & mask;
        case spv::OpBitFieldSExtract:
            return extractField(a, b, operands[2], width, true) & mask;
        case spv::OpBitFieldUExtract:
            return extractField(a, b, operands[2], width, false) & mask;
        case spv::OpLogicalNot:
            return a == 0 ? 1 : 0;
        case spv::OpLogicalEqual:
        case spv::OpIEqual:
            return a == b ? 1 : 0;
        case spv::OpLogicalNotEqual:
        case spv::OpINotEqual:
            return a != b ? 1 : 0;
        case spv::OpLogicalOr:
            return a | b;
        case spv::OpLogicalAnd:
            return a & b;
        case spv::OpUGreaterThan:
            return a > b ? 1 : 0;
        case spv::OpSGreaterThan:
            return sa > sb ? 1 : 0;
        case spv::OpUGreaterThanEqual:
            return a >= b ? 1 : 0;
        case spv::OpSGreaterThanEqual:
            return sa >= sb ? 1 : 0;
        case spv::OpULessThan:
            return a < b ? 1 : 0;
        case spv::OpSLessThan:
            return sa < sb ? 1 : 0;
        case spv::OpULessThanEqual:
            return a <= b ? 1 : 0;
        case spv::OpSLessThanEqual:
            return sa <= sb ? 1 : 0;
        default:
            return std::nullopt;
    }
}

uint64_t multiplyHigh(uint64_t a, uint64_t b, uint32_t width, bool isSigned) {
    __extension__ using Wide = __int128;
    const Wide x = isSigned ? Wide(asSigned(a, width)) : Wide(a);
    const Wide y = isSigned ? Wide(asSigned(b, width)) : Wide(b);
    __extension__ using UnsignedWide = unsigned __int128;
    // Unsigned multiplication: the full product of two 64-bit numbers does not fit the signed type.
    const UnsignedWide product = static_cast<UnsignedWide>(x) * static_cast<UnsignedWide>(y);
    return static_cast<uint64_t>(product >> width) & widthMask(width);
}

}  // namespace vernier::reference
