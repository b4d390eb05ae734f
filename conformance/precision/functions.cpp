#include "conformance/precision/vector_math.h"
// After the declarations of vector functions.
#include "conformance/precision/formula.h"
#include "conformance/precision/function.h"

#include <vector>

namespace vernier::precision {
namespace {

using reference::Real;

template <class Exact, class Permitted>
Function make(const char* name, const char* glsl, uint32_t operands, const char* limit, const Promises& promises,
              Exact exact, Permitted permitted) {
    Function f;
    f.name = name;
    f.glsl = glsl;
    f.operands = operands;
    f.domain = operands == 1 ? Domain::floats : Domain::stratified;
    f.limitText = limit;
    f.approximate = valueRow(exact);
    f.exact = exact;
    f.permitted = errorRow(permitted);
    f.promises = promises;
    return f;
}

void addTrigonometry(std::vector<Function>& all) {
    all.push_back(make("sin", "sin(a)", 1, "2^-11 absolute in [-π, π]", kAngles, VERNIER_FORMULA(sin(x[0])),
                       VERNIER_FORMULA(sin(x[0]))));
    all.push_back(make("cos", "cos(a)", 1, "2^-11 absolute in [-π, π]", kAngles, VERNIER_FORMULA(cos(x[0])),
                       VERNIER_FORMULA(cos(x[0]))));
    all.push_back(make("tan", "tan(a)", 1, "sin / cos", kUsual, VERNIER_FORMULA(tan(x[0])),
                       VERNIER_FORMULA(sin(x[0]) / cos(x[0]))));
    all.push_back(make("asin", "asin(a)", 1, "atan2(x, sqrt(1 - x²))", kUsual, VERNIER_FORMULA(asin(x[0])),
                       VERNIER_FORMULA(atan2(x[0], sqrt(T(1) - x[0] * x[0])))));
    all.push_back(make("acos", "acos(a)", 1, "atan2(sqrt(1 - x²), x)", kUsual, VERNIER_FORMULA(acos(x[0])),
                       VERNIER_FORMULA(atan2(sqrt(T(1) - x[0] * x[0]), x[0]))));
    all.push_back(
        make("atan", "atan(a)", 1, "4096 ULP", kUsual, VERNIER_FORMULA(atan(x[0])), VERNIER_FORMULA(atan(x[0]))));
    all.push_back(make("atan2", "atan(a, b)", 2, "4096 ULP", kUsual, VERNIER_FORMULA(atan2(x[0], x[1])),
                       VERNIER_FORMULA(atan2(x[0], x[1]))));
}

void addHyperbolic(std::vector<Function>& all) {
    all.push_back(make("sinh", "sinh(a)", 1, "(exp(x) - exp(-x)) * 0.5", kUsual, VERNIER_FORMULA(sinh(x[0])),
                       VERNIER_FORMULA((exp(x[0]) - exp(-x[0])) * T(0.5))));
    all.push_back(make("cosh", "cosh(a)", 1, "(exp(x) + exp(-x)) * 0.5", kUsual, VERNIER_FORMULA(cosh(x[0])),
                       VERNIER_FORMULA((exp(x[0]) + exp(-x[0])) * T(0.5))));
    all.push_back(make("tanh", "tanh(a)", 1, "sinh / cosh", kUsual, VERNIER_FORMULA(tanh(x[0])),
                       VERNIER_FORMULA(((exp(x[0]) - exp(-x[0])) * T(0.5)) / ((exp(x[0]) + exp(-x[0])) * T(0.5)))));
    all.push_back(make("asinh", "asinh(a)", 1, "log(x + sqrt(x² + 1))", kUsual, VERNIER_FORMULA(asinh(x[0])),
                       VERNIER_FORMULA(log(x[0] + sqrt(x[0] * x[0] + T(1))))));
    all.push_back(make("acosh", "acosh(a)", 1, "log(x + sqrt(x² - 1))", kUsual, VERNIER_FORMULA(acosh(x[0])),
                       VERNIER_FORMULA(log(x[0] + sqrt(x[0] * x[0] - T(1))))));
    all.push_back(make("atanh", "atanh(a)", 1, "log((1 + x) / (1 - x)) * 0.5", kUsual, VERNIER_FORMULA(atanh(x[0])),
                       VERNIER_FORMULA(log((T(1) + x[0]) / (T(1) - x[0])) * T(0.5))));
}

void addExponential(std::vector<Function>& all) {
    all.push_back(
        make("exp", "exp(a)", 1, "3 + 2 abs(x) ULP", kUsual, VERNIER_FORMULA(exp(x[0])), VERNIER_FORMULA(exp(x[0]))));
    all.push_back(make("exp2", "exp2(a)", 1, "3 + 2 abs(x) ULP", kUsual, VERNIER_FORMULA(exp2(x[0])),
                       VERNIER_FORMULA(exp2(x[0]))));
    const auto positive = [](const double* x) { return x[0] >= 0; };
    all.push_back(make("log", "log(a)", 1, "3 ULP; 2^-21 absolute in [0.5, 2]", kUsual, VERNIER_FORMULA(log(x[0])),
                       VERNIER_FORMULA(log(x[0]))));
    all.push_back(make("log2", "log2(a)", 1, "3 ULP; 2^-21 absolute in [0.5, 2]", kUsual, VERNIER_FORMULA(log2(x[0])),
                       VERNIER_FORMULA(log2(x[0]))));
    for (size_t k = all.size() - 2; k < all.size(); ++k) all[k].covers = positive;
    all.push_back(make("pow", "pow(a, b)", 2, "exp2(y * log2(x))", kUsual, VERNIER_FORMULA(pow(x[0], x[1])),
                       VERNIER_FORMULA(pow(x[0], x[1]))));
    all.back().covers = [](const double* x) { return x[0] > 0; };
    all.back().scale = powScale;
    all.back().scaleText = kPowScale;
    all.back().promises[2] = {1, 0};
    all.push_back(make("sqrt", "sqrt(a)", 1, "1 / inversesqrt", kRounded, VERNIER_FORMULA(sqrt(x[0])),
                       VERNIER_FORMULA(sqrt(x[0]))));
    all.push_back(make("inversesqrt", "inversesqrt(a)", 1, "2 ULP", kUsual, VERNIER_FORMULA(inversesqrt(x[0])),
                       VERNIER_FORMULA(inversesqrt(x[0]))));
    all.back().promises[1] = {1.5, 0};
    all.back().covers = [](const double* x) { return x[0] > 0; };
}

void addArithmetic(std::vector<Function>& all) {
    all.push_back(make("a / b", "a / b", 2, "2.5 ULP for abs(b) in [2^-126, 2^126]", kRounded,
                       VERNIER_FORMULA(x[0] / x[1]), VERNIER_FORMULA(x[0] / x[1])));
    all.push_back(make("a + b", "a + b", 2, "correctly rounded", kRounded, VERNIER_FORMULA(x[0] + x[1]),
                       VERNIER_FORMULA(x[0] + x[1])));
    all.push_back(make("a * b", "a * b", 2, "correctly rounded", kRounded, VERNIER_FORMULA(x[0] * x[1]),
                       VERNIER_FORMULA(x[0] * x[1])));
    all.push_back(make("fma", "fma(a, b, c)", 3, "OpFMul, OpFAdd", kRounded, VERNIER_FORMULA(x[0] * x[1] + x[2]),
                       VERNIER_FORMULA(x[0] * x[1] + x[2])));
    all.back().cancels = true;
    all.push_back(make("fract", "fract(a)", 1, "correctly rounded", kInherited, VERNIER_FORMULA(x[0] - floor(x[0])),
                       [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) { return rounded(x[0].value - std::floor(x[0].value), 0); });
    // Off by 2^-29 ULP at most in double; the error of small negative operands is that of 1 for a billion of them.
    all.back().exact = nullptr;
    all.back().covers = [](const double* x) { return std::isfinite(x[0]); };
    all.push_back(make("mod", "mod(a, b)", 2, "x - y * floor(x / y)", kInherited,
                       VERNIER_FORMULA(x[0] - x[1] * floor(x[0] / x[1])), [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) {
        const Bounded quotient = x[0] / x[1];
        const double whole = std::floor(quotient.value);
        // Where rounding the quotient may cross an integer, the formula may be off by y.
        const bool crosses = std::floor(quotient.value - quotient.error) != std::floor(quotient.value + quotient.error);
        const Bounded result = x[0] - x[1] * Bounded(whole, crosses ? 1 : 0);
        return Bounded(result.value, std::isnan(result.error) ? kUnknown : result.error);
    });
    all.back().cancels = true;
    all.back().domain = Domain::moderate;
    all.push_back(make("ldexp", "ldexp(a, int(b))", 2, "correctly rounded", kRounded,
                       VERNIER_FORMULA(x[0] * exp2(x[1])), [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) { return rounded(x[0].value * std::exp2(x[1].value), 0); });
    all.back().covers = [](const double* x) { return std::fabs(x[1]) <= 128 && x[1] == std::trunc(x[1]); };
    all.push_back(make("radians", "radians(a)", 1, "x * (π / 180)", kInherited,
                       VERNIER_FORMULA(x[0] * (acos(T(-1)) / T(180))), [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) { return x[0] * rounded(M_PI / 180, 0); });
    all.push_back(make("degrees", "degrees(a)", 1, "x * (180 / π)", kInherited,
                       VERNIER_FORMULA(x[0] * (T(180) / acos(T(-1)))), [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) { return x[0] * rounded(180 / M_PI, 0); });
    all.push_back(make("mix", "mix(a, b, c)", 3, "x * (1 - a) + y * a", kInherited,
                       VERNIER_FORMULA(x[0] * (T(1) - x[2]) + x[1] * x[2]),
                       VERNIER_FORMULA(x[0] * (T(1) - x[2]) + x[1] * x[2])));
    all.push_back(make(
        "smoothstep", "smoothstep(a, b, c)", 3, "t * t * (3 - 2 * t)", kInherited,
        [](const auto* x) {
            using T = std::remove_cvref_t<decltype(*x)>;
            const T t = (x[2] - x[0]) / (x[1] - x[0]);
            const T u = t > T(0) ? t < T(1) ? t : T(1) : T(0);
            return T(u * u * (T(3) - T(2) * u));
        },
        [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) {
        const Bounded t = unitClamp((x[2] - x[0]) / (x[1] - x[0]));
        return t * t * (Bounded(3) - Bounded(2) * t);
    });
    all.back().covers = [](const double* x) { return x[0] < x[1]; };
    for (size_t k = all.size() - 2; k < all.size(); ++k) {
        all[k].cancels = true;
        all[k].domain = Domain::moderate;
    }
}

#define VERNIER_DOT(a, b) (x[a] * x[b] + x[(a) + 1] * x[(b) + 1] + x[(a) + 2] * x[(b) + 2])

void addGeometric(std::vector<Function>& all) {
    const size_t first = all.size();
    all.push_back(make("dot", "dot(u, v)", 6, "sum of products", kInherited, VERNIER_FORMULA(VERNIER_DOT(0, 3)),
                       VERNIER_FORMULA(VERNIER_DOT(0, 3))));
    all.push_back(make("length", "length(u)", 3, "sqrt(dot(x, x))", kInherited,
                       VERNIER_FORMULA(sqrt(VERNIER_DOT(0, 0))), VERNIER_FORMULA(sqrt(VERNIER_DOT(0, 0)))));
    const auto distance = [](const auto* p) {
        using std::sqrt;
        using T = std::remove_cvref_t<decltype(*p)>;
        const T x[3] = {p[0] - p[3], p[1] - p[4], p[2] - p[5]};
        return T(sqrt(VERNIER_DOT(0, 0)));
    };
    all.push_back(make("distance", "distance(u, v)", 6, "length(x - y)", kInherited, distance, distance));
    all.push_back(make("normalize", "normalize(u).x", 3, "x * inversesqrt(dot(x, x))", kInherited,
                       VERNIER_FORMULA(x[0] / sqrt(VERNIER_DOT(0, 0))), [](const auto* x) { return x[0]; }));
    all.back().permitted = errorRow([](const Bounded* x) { return x[0] * inversesqrt(VERNIER_DOT(0, 0)); });
    all.push_back(make("cross", "cross(u, v).x", 6, "OpFSub(OpFMul, OpFMul)", kInherited,
                       VERNIER_FORMULA(x[1] * x[5] - x[4] * x[2]), VERNIER_FORMULA(x[1] * x[5] - x[4] * x[2])));
    all.push_back(make("reflect", "reflect(u, v).x", 6, "x - 2 * dot(y, x) * y", kInherited,
                       VERNIER_FORMULA(x[0] - T(2) * VERNIER_DOT(3, 0) * x[3]),
                       VERNIER_FORMULA(x[0] - T(2) * VERNIER_DOT(3, 0) * x[3])));
    const auto refract = [](const auto* x) {
        using std::sqrt;
        using T = std::remove_cvref_t<decltype(*x)>;
        const T eta(0.75), d = VERNIER_DOT(3, 0), k = T(1) - eta * eta * (T(1) - d * d);
        return T(eta * x[0] - (eta * d + sqrt(k)) * x[3]);
    };
    all.push_back(make("refract", "refract(u, v, 0.75).x", 6, "its formula", kInherited, refract, refract));
    // Total reflection gives 0 whatever the rounding, and cannot be told near its border.
    all.back().covers = [](const double* x) { return 1 - 0.5625 * (1 - VERNIER_DOT(3, 0) * VERNIER_DOT(3, 0)) > 0.01; };
    for (size_t k = first; k < all.size(); ++k) {
        all[k].cancels = true;
        all[k].domain = Domain::moderate;
    }
}

}  // namespace

std::span<const Function> functions() {
    static const std::vector<Function> kAll = [] {
        std::vector<Function> all;
        addTrigonometry(all);
        addHyperbolic(all);
        addExponential(all);
        addArithmetic(all);
        addGeometric(all);
        addConversions(all);
        addHalves(all);
        addDoubles(all);
        return all;
    }();
    return kAll;
}

}  // namespace vernier::precision
