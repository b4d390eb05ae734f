// The instructions that work component by component, by the types they work on: for random programs, and for the test
// of each by itself.
#pragma once

#include <cstdint>

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp>

namespace vernier::proof {

struct Operation {
    uint32_t op;
    uint8_t operands;
    bool extended = false;
};
inline constexpr Operation kFloatOps[] = {
    {spv::OpFNegate, 1},
    {spv::OpFAdd, 2},
    {spv::OpFSub, 2},
    {spv::OpFMul, 2},
    {spv::OpFDiv, 2},
    {spv::OpFAdd, 2},
    {spv::OpFMul, 2},
    {spv::OpFRem, 2},
    {spv::OpFMod, 2},
    {GLSLstd450FAbs, 1, true},
    {GLSLstd450Floor, 1, true},
    {GLSLstd450Ceil, 1, true},
    {GLSLstd450Trunc, 1, true},
    {GLSLstd450RoundEven, 1, true},
    {GLSLstd450Fract, 1, true},
    {GLSLstd450FSign, 1, true},
    {GLSLstd450Sqrt, 1, true},
    {GLSLstd450InverseSqrt, 1, true},
    {GLSLstd450FMin, 2, true},
    {GLSLstd450FMax, 2, true},
    {GLSLstd450Step, 2, true},
    {GLSLstd450NMin, 2, true},
    {GLSLstd450FClamp, 3, true},
    {GLSLstd450FMix, 3, true},
    {GLSLstd450SmoothStep, 3, true},
    {GLSLstd450Fma, 3, true},
};
/// Of 32-bit floats only.
inline constexpr Operation kElementaryOps[] = {
    {GLSLstd450Sin, 1, true},     {GLSLstd450Cos, 1, true},     {GLSLstd450Tan, 1, true},  {GLSLstd450Exp2, 1, true},
    {GLSLstd450Log2, 1, true},    {GLSLstd450Exp, 1, true},     {GLSLstd450Log, 1, true},  {GLSLstd450Pow, 2, true},
    {GLSLstd450Atan2, 2, true},   {GLSLstd450Asin, 1, true},    {GLSLstd450Acos, 1, true}, {GLSLstd450Tanh, 1, true},
    {GLSLstd450Radians, 1, true}, {GLSLstd450Degrees, 1, true}, {spv::OpQuantizeToF16, 1},
};
inline constexpr Operation kIntegerOps[] = {
    {spv::OpSNegate, 1},
    {spv::OpNot, 1},
    {spv::OpIAdd, 2},
    {spv::OpISub, 2},
    {spv::OpIMul, 2},
    {spv::OpSDiv, 2},
    {spv::OpSRem, 2},
    {spv::OpSMod, 2},
    {spv::OpShiftLeftLogical, 2},
    {spv::OpShiftRightLogical, 2},
    {spv::OpShiftRightArithmetic, 2},
    {spv::OpBitwiseAnd, 2},
    {spv::OpBitwiseOr, 2},
    {spv::OpBitwiseXor, 2},
    {spv::OpIAdd, 2},
    {spv::OpISub, 2},
    {GLSLstd450SMin, 2, true},
    {GLSLstd450SMax, 2, true},
    {GLSLstd450UMin, 2, true},
    {GLSLstd450UMax, 2, true},
    {GLSLstd450SClamp, 3, true},
    {GLSLstd450UClamp, 3, true},
    {GLSLstd450SAbs, 1, true},
    {GLSLstd450SSign, 1, true},
};
/// Of 32-bit integers only (Vulkan).
inline constexpr Operation kBitOps[] = {
    {spv::OpBitReverse, 1},        {spv::OpBitCount, 1},          {GLSLstd450FindILsb, 1, true},
    {GLSLstd450FindSMsb, 1, true}, {GLSLstd450FindUMsb, 1, true}, {spv::OpBitFieldInsert, 4},
    {spv::OpBitFieldSExtract, 3},  {spv::OpBitFieldUExtract, 3},
};
inline constexpr uint32_t kFloatTests[] = {
    spv::OpFOrdEqual,         spv::OpFUnordEqual,         spv::OpFOrdNotEqual,         spv::OpFUnordNotEqual,
    spv::OpFOrdLessThan,      spv::OpFUnordLessThan,      spv::OpFOrdGreaterThan,      spv::OpFUnordGreaterThan,
    spv::OpFOrdLessThanEqual, spv::OpFUnordLessThanEqual, spv::OpFOrdGreaterThanEqual, spv::OpFUnordGreaterThanEqual,
};
inline constexpr uint32_t kIntegerTests[] = {
    spv::OpIEqual,         spv::OpINotEqual,         spv::OpUGreaterThan,
    spv::OpSGreaterThan,   spv::OpUGreaterThanEqual, spv::OpSGreaterThanEqual,
    spv::OpULessThan,      spv::OpSLessThan,         spv::OpULessThanEqual,
    spv::OpSLessThanEqual,
};
inline constexpr uint32_t kLogicalOps[] = {spv::OpLogicalAnd, spv::OpLogicalOr, spv::OpLogicalEqual,
                                           spv::OpLogicalNotEqual};

}  // namespace vernier::proof
