// The functions of 16-bit floats.
#include "conformance/precision/vector_math.h"
// After the declarations of vector functions.
#include "conformance/precision/formula.h"
#include "conformance/precision/function.h"

namespace vernier::precision {
namespace {

using reference::Real;

struct HalfFunction {
    const char *name, *glsl;
    uint32_t operands;
    const char* limitText;
    Row approximate;
    Real (*exact)(const Real*);
    Row permitted;
    bool rounded = false;  // correctly, in every tier
    bool (*covers)(const double*) = nullptr;
};

/// A formula three times: its values, exactly, and what Vulkan permits.
#define VERNIER_ALL(expression)                                         \
    valueRow(VERNIER_FORMULA(expression)), VERNIER_FORMULA(expression), \
        errorRow<HalfBounded>(VERNIER_FORMULA(expression))

bool positive(const double* x) {
    return x[0] > 0;
}

// The half-precision column of the Vulkan specification, "Precision and Operation of SPIR-V Instructions".
const HalfFunction kHalfFunctions[] = {
    {"a + b", "p + q", 2, "correctly rounded", VERNIER_ALL(x[0] + x[1]), true},
    {"a * b", "p * q", 2, "correctly rounded", VERNIER_ALL(x[0] * x[1]), true},
    {"a / b", "p / q", 2, "2.5 ULP for abs(b) in [2^-14, 2^14]", VERNIER_ALL(x[0] / x[1]), true},
    {"sqrt", "sqrt(p)", 1, "1 / inversesqrt", VERNIER_ALL(sqrt(x[0])), true},
    {"inversesqrt", "inversesqrt(p)", 1, "2 ULP", VERNIER_ALL(inversesqrt(x[0])), false, positive},
    {"exp", "exp(p)", 1, "1 + 2 abs(x) ULP", VERNIER_ALL(exp(x[0]))},
    {"exp2", "exp2(p)", 1, "1 + 2 abs(x) ULP", VERNIER_ALL(exp2(x[0]))},
    {"log", "log(p)", 1, "3 ULP; 2^-7 absolute in [0.5, 2]", VERNIER_ALL(log(x[0])), false, positive},
    {"log2", "log2(p)", 1, "3 ULP; 2^-7 absolute in [0.5, 2]", VERNIER_ALL(log2(x[0])), false, positive},
    {"sin", "sin(p)", 1, "2^-7 absolute in [-π, π]", VERNIER_ALL(sin(x[0]))},
    {"cos", "cos(p)", 1, "2^-7 absolute in [-π, π]", VERNIER_ALL(cos(x[0]))},
    {"tan", "tan(p)", 1, "sin / cos", VERNIER_ALL(tan(x[0]))},
    {"asin", "asin(p)", 1, "atan2(x, sqrt(1 - x²))", VERNIER_ALL(asin(x[0]))},
    {"acos", "acos(p)", 1, "atan2(sqrt(1 - x²), x)", VERNIER_ALL(acos(x[0]))},
    {"atan", "atan(p)", 1, "5 ULP", VERNIER_ALL(atan(x[0]))},
    {"atan2", "atan(p, q)", 2, "5 ULP", VERNIER_ALL(atan2(x[0], x[1]))},
    {"pow", "pow(p, q)", 2, "exp2(y * log2(x))", VERNIER_ALL(pow(x[0], x[1])), false, positive},
};

/// A float of its tier, rounded once more: 2^-13 of its ULP and half one of a half's.
constexpr Promises kOfFloat = {{{1, 0x1p-11}, {0.501, 0}, {0.5002, 0}, {0.5001, 0}}};

}  // namespace

void addHalves(std::vector<Function>& all) {
    for (const HalfFunction& row : kHalfFunctions) {
        Function f;
        f.name = std::string("half ") + row.name;
        f.glsl = row.glsl;
        f.operands = row.operands;
        f.domain = row.operands == 1 ? Domain::codes : Domain::halves;
        f.operand = f.result = Word::float16;
        f.limitText = row.limitText;
        f.approximate = row.approximate;
        f.exact = row.exact;
        f.permitted = row.permitted;
        f.covers = row.covers;
        f.promises = row.rounded ? kRounded : kOfFloat;
        if (f.name == "half pow") {
            f.scale = powScale;
            f.scaleText = kPowScale;
        }
        all.push_back(f);
    }
}

}  // namespace vernier::precision
