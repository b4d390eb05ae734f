// The functions of 64-bit floats.
#include "conformance/precision/vector_math.h"
// After the declarations of vector functions.
#include "conformance/precision/formula.h"
#include "conformance/precision/function.h"

namespace vernier::precision {
namespace {

using reference::Real;

/// The root and the quotient are both rounded.
constexpr Promises kTwice = {{{1.5, 0}, {1.5, 0}, {1.5, 0}, {1.5, 0}}};

struct DoubleFunction {
    const char *name, *glsl;
    uint32_t operands;
    const char* limitText;
    const Promises& promises;
    Row approximate;
    Real (*exact)(const Real*);
    Row permitted;
    Domain domain = Domain::stratified;
    bool (*covers)(const double*) = nullptr;
};

#define VERNIER_VALUES(expression) valueRow(VERNIER_FORMULA(expression)), VERNIER_FORMULA(expression)
#define VERNIER_ALL(expression) VERNIER_VALUES(expression), errorRow<DoubleBounded>(VERNIER_FORMULA(expression))

bool isExponent(const double* x) {
    return std::fabs(x[1]) <= 1024 && x[1] == std::trunc(x[1]);
}
bool positive(const double* x) {
    return x[0] > 0;
}

const Row kRoundedProduct = errorRow<DoubleBounded>(
    [](const DoubleBounded* x) { return roundedBy<DoublePrecision>(x[0].value * std::exp2(x[1].value), 0); });

// "The precision of double-precision instructions is at least that of single precision" (the same section). The
// transcendental functions have no double-precision form.
const DoubleFunction kDoubleFunctions[] = {
    {"a + b", "p + q", 2, "as of floats", kRounded, VERNIER_ALL(x[0] + x[1])},
    {"a * b", "p * q", 2, "as of floats", kRounded, VERNIER_ALL(x[0] * x[1])},
    {"a / b", "p / q", 2, "2.5 ULP of floats", kRounded, VERNIER_ALL(x[0] / x[1])},
    {"fma", "fma(p, q, r)", 3, "OpFMul, OpFAdd", kRounded, VERNIER_ALL(x[0] * x[1] + x[2])},
    {"sqrt", "sqrt(p)", 1, "1 / inversesqrt", kRounded, VERNIER_ALL(sqrt(x[0]))},
    {"inversesqrt", "inversesqrt(p)", 1, "2 ULP of floats", kTwice, VERNIER_ALL(inversesqrt(x[0])), Domain::stratified,
     positive},
    {"ldexp", "ldexp(p, int(q))", 2, "as of floats", kRounded, VERNIER_VALUES(x[0] * exp2(x[1])), kRoundedProduct,
     Domain::stratified, isExponent},
    {"fract", "fract(p)", 1, "as of floats", kInherited, VERNIER_ALL(x[0] - floor(x[0]))},
    {"mod", "mod(p, q)", 2, "x - y * floor(x / y)", kInherited, VERNIER_ALL(x[0] - x[1] * floor(x[0] / x[1])),
     Domain::moderate},
    {"mix", "mix(p, q, r)", 3, "x * (1 - a) + y * a", kInherited, VERNIER_ALL(x[0] * (T(1) - x[2]) + x[1] * x[2]),
     Domain::moderate},
};

}  // namespace

void addDoubles(std::vector<Function>& all) {
    for (const DoubleFunction& row : kDoubleFunctions) {
        Function f;
        f.name = std::string("double ") + row.name;
        f.glsl = row.glsl;
        f.operands = row.operands;
        f.domain = row.domain;
        f.operand = f.result = Word::float64;
        f.limitText = row.limitText;
        f.approximate = row.approximate;
        f.exact = row.exact;
        f.permitted = row.permitted;
        f.cancels = true;  // doubles tell nothing about errors of doubles
        f.covers = row.covers;
        f.promises = row.promises;
        all.push_back(f);
    }
}

}  // namespace vernier::precision
