// Conversions between formats, and the functions of 16-bit floats.
#include <cmath>

#include "conformance/precision/vector_math.h"
// After the declarations of vector functions.
#include "conformance/precision/function.h"

namespace vernier::precision {
namespace {

using reference::Real;

constexpr std::array<Promise, 4> kRounded = {{{0.5, 0}, {0.5, 0}, {0.5, 0}, {0.5, 0}}};
constexpr std::array<Promise, 4> kExact = {{{0, 0}, {0, 0}, {0, 0}, {0, 0}}};

/// The half in the low bits of an operand.
#define VERNIER_HALF(x) "unpackFloat2x16(floatBitsToUint(" x ")).x"

const Row kSame = valueRow([](const double* x) { return x[0]; });
const Row kTruncated = valueRow([](const double* x) { return std::trunc(x[0]); });

struct Conversion {
    const char *name, *glsl;
    Domain domain;
    Word operand, result;
    const std::array<Promise, 4>& promises;
    Row approximate = kSame;
    bool (*covers)(const double*) = nullptr;
    uint32_t operands = 1;
};

bool fitsInt(const double* x) {
    return x[0] > -0x1p31 - 1 && x[0] < 0x1p31;
}
bool fitsUint(const double* x) {
    return x[0] > -1 && x[0] < 0x1p32;
}

// "float16_t(...)" is rounded by its conversion; float() of it is exact.
const Conversion kConversions[] = {
    {"int to float", "float(floatBitsToInt(a))", Domain::floats, Word::int32, Word::float32, kRounded},
    {"uint to float", "float(floatBitsToUint(a))", Domain::floats, Word::uint32, Word::float32, kRounded},
    {"float to int", "intBitsToFloat(int(a))", Domain::floats, Word::float32, Word::int32, kExact, kTruncated, fitsInt},
    {"float to uint", "uintBitsToFloat(uint(a))", Domain::floats, Word::float32, Word::uint32, kExact, kTruncated,
     fitsUint},
    {"double to float", "float(packDouble2x32(uvec2(floatBitsToUint(a), floatBitsToUint(b))))", Domain::stratified,
     Word::uint32, Word::float32, kRounded, valueRow([](const double* x) {
         return std::bit_cast<double>(static_cast<uint64_t>(x[1]) << 32 | static_cast<uint64_t>(x[0]));
     }),
     nullptr, 2},
    {"float to half", "float(float16_t(a))", Domain::floats, Word::float32, Word::float16, kRounded},
    {"half to float", "float(" VERNIER_HALF("a") ")", Domain::codes, Word::float16, Word::float32, kExact},
    {"packHalf2x16", "unpackHalf2x16(packHalf2x16(vec2(0, a))).y", Domain::floats, Word::float32, Word::float16,
     kRounded},
    {"unpackHalf2x16", "unpackHalf2x16(floatBitsToUint(a)).x", Domain::codes, Word::float16, Word::float32, kExact},
    {"int to half", "float(float16_t(floatBitsToInt(a)))", Domain::floats, Word::int32, Word::float16, kRounded},
    {"uint to half", "float(float16_t(floatBitsToUint(a)))", Domain::floats, Word::uint32, Word::float16, kRounded},
    {"half to int", "intBitsToFloat(int(" VERNIER_HALF("a") "))", Domain::codes, Word::float16, Word::int32, kExact,
     kTruncated, fitsInt},
    {"half to uint", "uintBitsToFloat(uint(" VERNIER_HALF("a") "))", Domain::codes, Word::float16, Word::uint32, kExact,
     kTruncated, fitsUint},
};

// Formulas for doubles and for exact numbers.
#define VERNIER_FORMULA(expression)                                                                            \
    [](const auto* x) {                                                                                        \
        using std::acos, std::asin, std::atan, std::atan2, std::cos, std::exp, std::exp2, std::log, std::log2, \
            std::pow, std::sin, std::sqrt, std::tan;                                                           \
        using T = std::remove_cvref_t<decltype(*x)>;                                                           \
        return T(expression);                                                                                  \
    }

struct HalfFunction {
    const char *name, *glsl;
    uint32_t operands;
    const char* limitText;
    Row approximate;
    Real (*exact)(const Real*);
    Row permitted;
    bool rounded;  // correctly, in every tier
    bool (*covers)(const double*) = nullptr;
};

#define VERNIER_BOTH(expression) valueRow(VERNIER_FORMULA(expression)), VERNIER_FORMULA(expression)
#define VERNIER_ULP(value, count) errorRow([](const Bounded* x) { return Bounded(value, (count)*halfUlp(value)); })
#define X (x[0].value)
#define Y (x[1].value)

bool positive(const double* x) {
    return x[0] > 0;
}

Bounded halfLog(double x, double value) {
    return {value, x >= 0.5 && x <= 2 ? 0x1p-7 : 3 * halfUlp(value)};
}

// The half-precision column of the Vulkan specification, "Precision and Operation of SPIR-V Instructions".
const HalfFunction kHalfFunctions[] = {
    {"a + b", "p + q", 2, "correctly rounded", VERNIER_BOTH(x[0] + x[1]), VERNIER_ULP(X + Y, 1), true},
    {"a * b", "p * q", 2, "correctly rounded", VERNIER_BOTH(x[0] * x[1]), VERNIER_ULP(X* Y, 1), true},
    {"a / b", "p / q", 2, "2.5 ULP for abs(b) in [2^-14, 2^14]", VERNIER_BOTH(x[0] / x[1]),
     errorRow([](const Bounded* x) {
         const bool stated = std::fabs(Y) >= 0x1p-14 && std::fabs(Y) <= 0x1p14;
         return Bounded(X / Y, stated ? 2.5 * halfUlp(X / Y) : kUnknown);
     }),
     true},
    {"sqrt", "sqrt(p)", 1, "1 / inversesqrt", VERNIER_BOTH(sqrt(x[0])), nullptr, true},
    {"inversesqrt", "inversesqrt(p)", 1, "2 ULP", VERNIER_BOTH(T(1) / sqrt(x[0])), VERNIER_ULP(1 / std::sqrt(X), 2),
     false, positive},
    {"exp", "exp(p)", 1, "1 + 2 abs(x) ULP", VERNIER_BOTH(exp(x[0])), VERNIER_ULP(std::exp(X), 1 + 2 * std::fabs(X)),
     false},
    {"exp2", "exp2(p)", 1, "1 + 2 abs(x) ULP", VERNIER_BOTH(exp2(x[0])),
     VERNIER_ULP(std::exp2(X), 1 + 2 * std::fabs(X)), false},
    {"log", "log(p)", 1, "3 ULP; 2^-7 absolute in [0.5, 2]", VERNIER_BOTH(log(x[0])),
     errorRow([](const Bounded* x) { return halfLog(X, std::log(X)); }), false, positive},
    {"log2", "log2(p)", 1, "3 ULP; 2^-7 absolute in [0.5, 2]", VERNIER_BOTH(log2(x[0])),
     errorRow([](const Bounded* x) { return halfLog(X, std::log2(X)); }), false, positive},
    {"sin", "sin(p)", 1, "2^-7 absolute in [-π, π]", VERNIER_BOTH(sin(x[0])),
     errorRow([](const Bounded* x) { return Bounded(std::sin(X), std::fabs(X) <= M_PI ? 0x1p-7 : kUnknown); }), false},
    {"cos", "cos(p)", 1, "2^-7 absolute in [-π, π]", VERNIER_BOTH(cos(x[0])),
     errorRow([](const Bounded* x) { return Bounded(std::cos(X), std::fabs(X) <= M_PI ? 0x1p-7 : kUnknown); }), false},
    {"tan", "tan(p)", 1, "sin / cos", VERNIER_BOTH(tan(x[0])), nullptr, false},
    {"asin", "asin(p)", 1, "atan2(x, sqrt(1 - x²))", VERNIER_BOTH(asin(x[0])), nullptr, false},
    {"acos", "acos(p)", 1, "atan2(sqrt(1 - x²), x)", VERNIER_BOTH(acos(x[0])), nullptr, false},
    {"atan", "atan(p)", 1, "5 ULP", VERNIER_BOTH(atan(x[0])), VERNIER_ULP(std::atan(X), 5), false},
    {"atan2", "atan(p, q)", 2, "5 ULP", VERNIER_BOTH(atan2(x[0], x[1])), VERNIER_ULP(std::atan2(X, Y), 5), false},
    {"pow", "pow(p, q)", 2, "exp2(y * log2(x))", VERNIER_BOTH(pow(x[0], x[1])), nullptr, false, positive},
};
#undef X
#undef Y

}  // namespace

void addConversions(std::vector<Function>& all) {
    for (const Conversion& row : kConversions) {
        Function f;
        f.name = row.name;
        f.glsl = row.glsl;
        f.operands = row.operands;
        f.domain = row.domain;
        f.operand = row.operand;
        f.result = row.result;
        f.limitText = &row.promises == &kExact ? "exact" : "correctly rounded";
        f.approximate = row.approximate;
        f.covers = row.covers;
        f.promises = row.promises;
        all.push_back(f);
    }
}

void addHalves(std::vector<Function>& all) {
    for (const HalfFunction& row : kHalfFunctions) {
        Function f;
        f.name = std::string("half ") + row.name;
        std::string expression = row.glsl;
        f.glsl = "0; { float16_t p = " VERNIER_HALF("a") ", q = " VERNIER_HALF("b") "; result = float(" + expression +
                 "); }";
        f.operands = row.operands;
        f.domain = row.operands == 1 ? Domain::codes : Domain::halves;
        f.operand = f.result = Word::float16;
        f.limitText = row.limitText;
        f.approximate = row.approximate;
        f.exact = row.exact;
        f.permitted = row.permitted;
        f.covers = row.covers;
        // A float of its tier, rounded once more: 2^-13 of its ULP and half one of a half's.
        f.promises = {{{1, 0x1p-11}, {0.501, 0}, {0.5002, 0}, {0.5001, 0}}};
        if (row.rounded) f.promises = kRounded;
        // As that of floats: errors of y * log2(x) grow with it.
        if (f.name == "half pow") f.scale = [](const double* x) { return 1 + std::fabs(x[1] * std::log2(x[0])); };
        all.push_back(f);
    }
}

}  // namespace vernier::precision
