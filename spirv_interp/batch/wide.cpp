// Operations with 64-bit values, one lane at a time: rare in shaders, so plain rather than fast.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv_interp/batch/wide.cpp"
#include "base/simd_targets.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>

#include "spirv_interp/batch/element-inl.h"
#include "spirv_interp/batch/half.h"
#include "spirv_interp/batch/handlers.h"
#include "spirv_interp/batch/scalar-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vernier::batch::HWY_NAMESPACE {
namespace {
namespace wide {

using F = double;
using S = int64_t;
using U = uint64_t;

F smaller(F a, F b) {
    return b != b ? a : a < b ? a : b;
}
F larger(F a, F b) {
    return b != b ? a : a > b ? a : b;
}
F clamped(F x, F low, F high) {
    return smaller(larger(x, low), high);
}

F fadd64(F a, F b) {
    return a + b;
}
F fsub64(F a, F b) {
    return a - b;
}
F fmul64(F a, F b) {
    return a * b;
}
F fdiv64(F a, F b) {
    return a / b;
}
F frem64(F a, F b) {
    return a - b * std::trunc(a / b);
}
F fmod64(F a, F b) {
    return a - b * std::floor(a / b);
}
F fneg64(F a) {
    return std::bit_cast<F>(std::bit_cast<U>(a) ^ U{1} << 63);
}
/// IEEE 754 leaves one possible result, so the C library's is the hardware's.
F ffma64(F a, F b, F c) {
    return std::fma(a, b, c);
}
F fabs64(F a) {
    return std::bit_cast<F>(std::bit_cast<U>(a) & ~U{0} >> 1);
}
F fsign64(F a) {
    return a > 0 ? 1.0 : a < 0 ? -1.0 : 0.0;
}
F ffloor64(F a) {
    return std::floor(a);
}
F fceil64(F a) {
    return std::ceil(a);
}
F ftrunc64(F a) {
    return std::trunc(a);
}
F froundEven64(F a) {
    return std::nearbyint(a);
}
F ffract64(F a) {
    const F fraction = a - std::floor(a);
    return fraction > 0x1.fffffffffffffp-1 ? 0x1.fffffffffffffp-1 : fraction;
}
F fmin64(F a, F b) {
    return smaller(a, b);
}
F fmax64(F a, F b) {
    return larger(a, b);
}
F fclamp64(F x, F low, F high) {
    return clamped(x, low, high);
}
F fmix64(F x, F y, F a) {
    return x * (1.0 - a) + y * a;
}
F fstep64(F edge, F x) {
    return x < edge ? 0.0 : 1.0;
}
F fsmoothstep64(F edge0, F edge1, F x) {
    const F t = clamped((x - edge0) / (edge1 - edge0), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
F fsqrt64(F a) {
    return std::sqrt(a);
}
F finverseSqrt64(F a) {
    return 1.0 / std::sqrt(a);
}
constexpr auto& fldexp64 = scalar::ldexp<F>;
F ffrexpMantissa64(F x) {
    return scalar::frexp(x).mantissa;
}
int32_t ffrexpExponent64(F x) {
    return scalar::frexp(x).exponent;
}

U iadd64(U a, U b) {
    return a + b;
}
U isub64(U a, U b) {
    return a - b;
}
U imul64(U a, U b) {
    return a * b;
}
constexpr auto& smulHigh64 = scalar::smulHigh<S>;
constexpr auto& umulHigh64 = scalar::umulHigh<U>;
constexpr auto& sdiv64 = scalar::sdiv<S>;
constexpr auto& udiv64 = scalar::udiv<U>;
constexpr auto& srem64 = scalar::srem<S>;
constexpr auto& smod64 = scalar::smod<S>;
constexpr auto& umod64 = scalar::umod<U>;
U ineg64(U a) {
    return U{0} - a;
}
U iabs64(U a) {
    return static_cast<S>(a) < 0 ? U{0} - a : a;
}
S isign64(S a) {
    return a > 0 ? 1 : a < 0 ? -1 : 0;
}
S smin64(S a, S b) {
    return a < b ? a : b;
}
S smax64(S a, S b) {
    return a > b ? a : b;
}
U umin64(U a, U b) {
    return a < b ? a : b;
}
U umax64(U a, U b) {
    return a > b ? a : b;
}
U iand64(U a, U b) {
    return a & b;
}
U ior64(U a, U b) {
    return a | b;
}
U ixor64(U a, U b) {
    return a ^ b;
}
U inot64(U a) {
    return ~a;
}
U shl64(U a, U b) {
    return a << (b & 63);
}
U lshr64(U a, U b) {
    return a >> (b & 63);
}
S ashr64(S a, U b) {
    return a >> (b & 63);
}
constexpr auto& addCarry64 = scalar::addCarry<U>;
constexpr auto& subBorrow64 = scalar::subBorrow<U>;
constexpr auto& bitFieldInsert64 = scalar::bitFieldInsert<U>;
constexpr auto& bitFieldSExtract64 = scalar::bitFieldSExtract<U>;
constexpr auto& bitFieldUExtract64 = scalar::bitFieldUExtract<U>;
constexpr auto& bitReverse64 = scalar::bitReverse<U>;
constexpr auto& bitCount64 = scalar::bitCount<U>;
constexpr auto& findILsb64 = scalar::findILsb<U>;
constexpr auto& findSMsb64 = scalar::findSMsb<U>;
constexpr auto& findUMsb64 = scalar::findUMsb<U>;

bool foeq64(F a, F b) {
    return a == b;
}
bool fone64(F a, F b) {
    return a < b || a > b;
}
bool folt64(F a, F b) {
    return a < b;
}
bool fole64(F a, F b) {
    return a <= b;
}
bool fueq64(F a, F b) {
    return !(a < b || a > b);
}
bool fune64(F a, F b) {
    return a != b;
}
bool fult64(F a, F b) {
    return !(a >= b);
}
bool fule64(F a, F b) {
    return !(a > b);
}
bool fisnan64(F a) {
    return a != a;
}
bool fisinf64(F a) {
    return std::bit_cast<U>(fabs64(a)) == U{0x7FF} << 52;
}
bool ieq64(U a, U b) {
    return a == b;
}
bool ine64(U a, U b) {
    return a != b;
}
bool slt64(S a, S b) {
    return a < b;
}
bool sle64(S a, S b) {
    return a <= b;
}
bool ult64(U a, U b) {
    return a < b;
}
bool ule64(U a, U b) {
    return a <= b;
}

int32_t ftosFrom64(F a) {
    return scalar::toInteger<int32_t>(a);
}
uint32_t ftouFrom64(F a) {
    return scalar::toInteger<uint32_t>(a);
}
S ftosTo64(float a) {
    return scalar::toInteger<S>(a);
}
U ftouTo64(float a) {
    return scalar::toInteger<U>(a);
}
S ftos64(F a) {
    return scalar::toInteger<S>(a);
}
U ftou64(F a) {
    return scalar::toInteger<U>(a);
}
float stofFrom64(S a) {
    return static_cast<float>(a);
}
float utofFrom64(U a) {
    return static_cast<float>(a);
}
F stofTo64(int32_t a) {
    return a;
}
F utofTo64(uint32_t a) {
    return a;
}
F stof64(S a) {
    return static_cast<F>(a);
}
F utof64(U a) {
    return static_cast<F>(a);
}
float ftofFrom64(F a) {
    return static_cast<float>(a);
}
F ftofTo64(float a) {
    return a;
}
float ftohFrom64(F a) {
    return nearestHalf(a);
}
float ftohZeroFrom64(F a) {
    return halfTowardsZero(a);
}
S sextTo64(int32_t a) {
    return a;
}
U zextTo64(uint32_t a) {
    return a;
}
U boolTo64(uint32_t a) {
    return a >> 31;
}

}  // namespace wide
}  // namespace

void addWide(HandlerTables& tables) {
#define VERNIER_BATCH_WIDE(name, operands) addLanes<wide::name>(tables, Op::name);
#include "spirv_interp/batch/ops.def"
}

}  // namespace vernier::batch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vernier::batch {
namespace {
AddHandlers selectWide(Isa isa) {
    VERNIER_SELECT_ISA(isa, addWide)
}
}  // namespace
void addWide(Isa isa, HandlerTables& tables) {
    selectWide(isa)(tables);
}
}  // namespace vernier::batch
#endif
