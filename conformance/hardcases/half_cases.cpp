#include "conformance/hardcases/half_cases.h"

#include "conformance/hardcases/value_input.h"
#include "conformance/oracle/encode.h"
#include "conformance/oracle/quantise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vernier::conformance::hardcases {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr double kLeastNormal = 0x1p-14, kLargest = 65504;
constexpr exact::Component kHalf{0, 0, 16, exact::Encoding::sfloat};

/// The distance between neighbouring halves around a number.
double halfUlp(double value) {
    return std::ldexp(1.0, std::ilogb(std::max(std::abs(value), kLeastNormal)) - 10);
}

/// Exact when it is the nearest half, zeros with their sign; permitted when it is the other neighbour, a zero of the
/// other sign, or within the tolerance. Denormals may be flushed. Where `exactly` is NaN nothing is asked. With `own`
/// it is a function of floats, rounded: declared within the driver's own bounds and half a step of halves.
ValueJudge halfOf(double exactly, double tolerance = 0, std::optional<OwnTolerance> own = std::nullopt) {
    return [=](uint32_t bits, const Declared& declared) -> Verdict {
        const double got = std::bit_cast<float>(bits);
        if (std::isnan(exactly)) return {};
        double nearest = exactly, below = exactly, above = exactly;
        if (std::isfinite(exactly) && exactly != 0) {
            const exact::CodeSet codes = exact::encode(kHalf, exact::rational(exactly));
            nearest = std::copysign(exact::decodeNumber(kHalf, codes.nearest), exactly);
            below = exact::decodeNumber(kHalf, codes.below);
            above = exact::decodeNumber(kHalf, codes.above);
        }
        if (got == nearest && std::signbit(got) == std::signbit(nearest)) return {};
        const std::string text =
            "exactly " + std::to_string(exactly) + ", the nearest half is " + std::to_string(nearest);
        if (own && declared.own && std::abs(got - exactly) <= halfUlp(exactly) / 2 + own->of(exactly, *declared.own))
            return Verdict::declared(text);
        const bool flushed = got == 0 && std::abs(exactly) < kLeastNormal;
        const bool legal =
            got == nearest || got == below || got == above || flushed || std::abs(got - exactly) <= tolerance;
        return Verdict::inexact(legal, text);
    };
}

/// A half of `a` and `b`, which are halves, or of inputs by f, i and u.
void addHalves(CaseInput& input, std::string_view name, const std::string& half, std::vector<ValueRow> rows) {
    ValueShader shader;
    shader.extensions = "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require\n";
    shader.declarations =
        "uint half_() { float16_t a = float16_t(f(0)), b = float16_t(f(1)); return floatBitsToUint(float(" + half +
        ")); }\n";
    addValues(input, name, "half_()", std::move(rows), shader);
}

void addRelaxed(CaseInput& input, std::string_view name, const std::string& expression, std::vector<ValueRow> rows) {
    addValues(input, name, "relaxed()", std::move(rows),
              "uint relaxed() { mediump float a = f(0), b = f(1); mediump float r = " + expression +
                  "; return floatBitsToUint(r); }\n");
}

// ---- Elementary functions, by the table for halves (Vulkan, Precision of GLSL.std.450 Instructions) ----

struct HalfFunction {
    const char* text;  // of a
    double (*exactly)(double a);
    double (*tolerance)(double a, double exactly);
    std::vector<float> inputs;
    OwnTolerance own{};
};

double logTolerance(double a, double exactly) {
    return a >= 0.5 && a <= 2 ? 0x1p-7 : 3 * halfUlp(exactly);
}

double expTolerance(double a, double exactly) {
    return (1 + 2 * std::abs(a)) * halfUlp(exactly);
}

/// sin and cos within [-pi, pi].
double turnTolerance(double, double) {
    return 0x1p-7;
}

std::vector<HalfFunction> halfFunctions() {
    const std::vector<float> powers{0, 1, -1, 0.5f, -0.333251953125f, 3.7109375f, 9.8984375f};
    const std::vector<float> positives{1, 1.0009765625f, 0.99951171875f, 0.5f, 2, 10, 0.1f, 65504, 0x1p-14f};
    const std::vector<float> angles{0, 0.5f, -2, 1.5703125f, 3.140625f, -3.140625f, 0.0009765625f};
    std::vector<float> exponents = powers;
    for (const float x : {15.0f, 15.9921875f, 16.0f, -14.0f, -23.0f}) exponents.push_back(x);
    return {{"exp2(a)", [](double a) { return std::exp2(a); }, expTolerance, exponents},
            {"exp(a)", [](double a) { return std::exp(a); }, expTolerance, powers},
            {"log2(a)", [](double a) { return std::log2(a); }, logTolerance, positives},
            {"log(a)", [](double a) { return std::log(a); }, logTolerance, positives},
            {"inversesqrt(a)", [](double a) { return 1 / std::sqrt(a); },
             [](double, double exactly) { return 2 * halfUlp(exactly); }, positives},
            {"sin(a)", [](double a) { return std::sin(a); }, turnTolerance, angles, {1, true}},
            {"cos(a)", [](double a) { return std::cos(a); }, turnTolerance, angles, {1, true}},
            {"atan(a)",
             [](double a) { return std::atan(a); },
             [](double, double exactly) { return 5 * halfUlp(exactly); },
             {0, 1, -1, 0.0009765625f, 3, 65504, -65504}}};
}

}  // namespace

void x14(CaseInput& input) {
    struct Operation {
        const char* text;  // of a and b
        double (*exactly)(double a, double b);
        double ulps;  // beyond the two neighbours
    };
    const Operation operations[] = {{"a + b", [](double a, double b) { return a + b; }, 0},
                                    {"a - b", [](double a, double b) { return a - b; }, 0},
                                    {"a * b", [](double a, double b) { return a * b; }, 0},
                                    {"a / b", [](double a, double b) { return a / b; }, 2.5},
                                    {"sqrt(a)", [](double a, double) { return std::sqrt(a); }, 3}};
    const std::vector<std::pair<float, float>> pairs{
        {1.0f, 0.0009765625f},   {1.0f, 0.00048828125f}, {3.0f, 7.0f},      {1.0009765625f, 1.5f}, {127.0f, 129.0f},
        {0.333251953125f, 3.0f}, {2048.0f, 1.0f},        {0.125f, 0.0625f}, {5.5f, 0.099975586f}};
    for (const Operation& operation : operations) {
        std::vector<ValueRow> halves, relaxed;
        for (const auto& [a, b] : pairs) {
            const double exactly = operation.exactly(static_cast<double>(a), static_cast<double>(b));
            halves.push_back({{bitsOf(a), bitsOf(b)}, halfOf(exactly, operation.ulps * halfUlp(exactly))});
            // A relative error of 2^-10 beside that of the function (Vulkan, Precision of RelaxedPrecision operations).
            relaxed.push_back(
                {{bitsOf(a), bitsOf(b)},
                 floatNear(exactly, (1 + operation.ulps) * std::max(std::abs(exactly), kLeastNormal) * 0x1p-10)});
        }
        addHalves(input, "X14_half", operation.text, std::move(halves));
        addRelaxed(input, "X14_relaxed", operation.text, std::move(relaxed));
    }
}

// Ties, the step from the largest half to infinity, denormals, signs of zero.
void x16(CaseInput& input) {
    using Pairs = std::vector<std::pair<float, float>>;
    const auto add = [&input](const char* operation, const Pairs& pairs, double (*exactly)(double, double),
                              double ulps) {
        std::vector<ValueRow> rows;
        for (const auto& [a, b] : pairs) {
            const double result = exactly(static_cast<double>(a), static_cast<double>(b));
            rows.push_back({{bitsOf(a), bitsOf(b)}, halfOf(result, ulps == 0 ? 0 : ulps * halfUlp(result))});
        }
        addHalves(input, "X16", operation, std::move(rows));
    };
    const Pairs sums{{2048, 1},
                     {2050, 1},
                     {2048, 3},
                     {65504, 15.9921875f},
                     {65504, 16},
                     {-65504, -16},
                     {65504, 32},
                     {1, -1},
                     {-0.0f, -0.0f},
                     {-0.0f, 0},
                     {kInf, -kInf},
                     {kInf, -65504},
                     {1, 0x1p-11f},
                     {1, 0x1.8p-10f},
                     {0x1p-24f, 0x1p-24f},
                     {0x1p-14f, -0x1p-24f}};
    add(
        "a + b", sums, [](double a, double b) { return a + b; }, 0);
    const Pairs products{{0x1p-24f, 0.5f},
                         {0x1.8p-23f, 0.5f},
                         {-0x1p-24f, 0.5f},
                         {0x1p-14f, 0.5f},
                         {0x1.ffcp-14f, 0.5f},
                         {256, 255.875f},
                         {256, 256},
                         {-256, 256},
                         {0, kInf},
                         {-0.0f, 3},
                         {1.0009765625f, 1.0009765625f}};
    add(
        "a * b", products, [](double a, double b) { return a * b; }, 0);
    const Pairs quotients{{1, 65504}, {65504, 65504}, {1, 0x1p-14f}, {65504, 0.5f}, {0, -3}, {1, kInf}, {0, 0}};
    add(
        "a / b", quotients, [](double a, double b) { return a / b; }, 2.5);
    std::vector<ValueRow> floats, integers;
    for (const float x : {65519.99609375f, 65520.0f, 65535.0f, 1e30f, -65520.0f, 0x1p-25f, 0x1.000002p-25f, -0x1p-26f,
                          1.00048828125f, 1.00146484375f, 0x1.ffep-15f, 0x1p-149f, -0.0f, kInf})
        floats.push_back({{bitsOf(x)}, halfOf(static_cast<double>(x))});
    addHalves(input, "X16_from_float", "float16_t(f(0))", std::move(floats));
    for (const int32_t x : {2049, 2051, -2049, 65519, 65520, -65520, 0x7fffffff, -0x7fffffff - 1, 0})
        integers.push_back({{static_cast<uint32_t>(x)}, halfOf(x)});
    addHalves(input, "X16_from_int", "float16_t(i(0))", std::move(integers));
}

void x17(CaseInput& input) {
    for (const HalfFunction& function : halfFunctions()) {
        std::vector<ValueRow> halves, relaxed;
        for (const float x : function.inputs) {
            // A half, as what the function gets.
            const auto a =
                exact::decodeNumber(kHalf, exact::encode(kHalf, exact::rational(static_cast<double>(x))).nearest);
            const double exactly = function.exactly(a), tolerance = function.tolerance(a, exactly);
            const uint32_t bits = bitsOf(static_cast<float>(a));
            halves.push_back({{bits}, halfOf(exactly, tolerance, function.own)});
            if (std::abs(exactly) <= kLargest) relaxed.push_back({{bits}, floatNear(exactly, tolerance, function.own)});
        }
        addHalves(input, "X17_half", function.text, std::move(halves));
        addRelaxed(input, "X17_relaxed", function.text, std::move(relaxed));
    }
}

}  // namespace vernier::conformance::hardcases
