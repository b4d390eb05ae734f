// X: shader arithmetic.
#include "conformance/hardcases/groups.h"
#include "conformance/hardcases/half_cases.h"
#include "conformance/hardcases/judges.h"
#include "conformance/hardcases/subgroup_cases.h"
#include "conformance/hardcases/value_input.h"
#include "conformance/scenes/recorder.h"
#include "conformance/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vernier::conformance::hardcases {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kMax = std::numeric_limits<float>::max();
constexpr double kPi = 3.14159265358979323846;

using Exactly = double (*)(double);
using Tolerance = double (*)(double x, double exactly);

// One function of one float: exact when nearest, permitted within a tolerance.
void unary(CaseInput& input, std::string_view name, const char* function, std::vector<float> inputs, Exactly exactly,
           Tolerance tolerance, OwnTolerance own = {}) {
    std::vector<ValueRow> rows;
    for (const float x : inputs) {
        const double y = exactly(static_cast<double>(x));
        rows.push_back({{bitsOf(x)}, floatNear(y, tolerance(static_cast<double>(x), y), own)});
    }
    addValues(input, name, std::string("floatBitsToUint(") + function + "(f(0)))", std::move(rows));
}

void x01(CaseInput& input) {
    std::vector<float> inputs;
    for (int k = -126; k <= 127; ++k) inputs.push_back(static_cast<float>(k));
    for (const float x : {-150.0f, -149.0f, -127.0f, 128.0f, 0.5f, -0.5f, 1e-30f, 127.99f, -125.999f}) {
        for (const float y : {x, std::nextafter(x, kInf), std::nextafter(x, -kInf)}) inputs.push_back(y);
    }
    unary(
        input, "X01", "exp2", inputs, [](double x) { return std::exp2(x); },
        [](double x, double y) { return (3 + 2 * std::abs(x)) * ulpOf(y); });
}

void x02(CaseInput& input) {
    std::vector<float> inputs{1};
    for (int k = 1; k <= 24; ++k) {
        inputs.push_back(1 + std::ldexp(1.0f, -k));
        inputs.push_back(1 - std::ldexp(1.0f, -k));
    }
    for (int k = -126; k <= 127; k += 11) inputs.push_back(std::ldexp(1.0f, k));
    inputs.push_back(kMax);
    unary(
        input, "X02", "log2", inputs, [](double x) { return std::log2(x); },
        [](double x, double y) { return x >= 0.5 && x <= 2 ? 0x1p-21 : 3 * ulpOf(y); });
}

// exp2(y * log2 x): the error of the logarithm, multiplied, and that of exp2.
double powTolerance(double x, double y) {
    const double product = y * std::log2(x), result = std::pow(x, y);
    const double logError = x >= 0.5 && x <= 2 ? 0x1p-21 : 3 * ulpOf(std::log2(x));
    return result * std::log(2.0) * (std::abs(y) * logError + ulpOf(product)) +
           (3 + 2 * std::abs(product)) * ulpOf(result);
}

void x03(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const auto& [x, y] : {std::pair{2.0f, 10.0f},
                               {1.0f, 37.5f},
                               {1.0f, -1e10f},
                               {3.7f, 1.0f},
                               {10.0f, -3.0f},
                               {0.5f, 100.0f},
                               {1.0000001f, 1e6f},
                               {0.9999999f, 1e7f},
                               {1e-20f, 1.5f},
                               {1e30f, 1.2f},
                               {7, 0.5f},
                               {2, -126}}) {
        const double base = static_cast<double>(x), exponent = static_cast<double>(y);
        // The error of the logarithm is multiplied by what the result's own is.
        const OwnTolerance own{1 + std::abs(exponent * std::log2(base))};
        rows.push_back(
            {{bitsOf(x), bitsOf(y)}, floatNear(std::pow(base, exponent), powTolerance(base, exponent), own)});
    }
    rows.push_back({{bitsOf(0), bitsOf(5)}, oneOf({bitsOf(0)})});
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {-2.0f, 2.0f}, {-1.0f, 0.5f}, {0.0f, -1.0f}})
        rows.push_back({{bitsOf(x), bitsOf(y)}, anything()});
    addValues(input, "X03", "floatBitsToUint(pow(f(0), f(1)))", std::move(rows));
}

void x04(CaseInput& input) {
    std::vector<float> inputs;
    for (int k = -4; k <= 4; ++k) {
        const auto near = static_cast<float>(k * kPi / 2);
        for (const float x : {near, std::nextafter(near, kInf)}) inputs.push_back(x);
    }
    for (const float x : {0.1f, 1e4f, 1e5f, 1e8f, 0x1p30f, -54321.125f}) inputs.push_back(x);
    // Outside [-pi, pi] the specification asks nothing; the conformance tests ask |x| 2^-12.
    const Tolerance tolerance = [](double x, double) {
        return std::abs(x) <= kPi ? 0x1p-11 : std::min(2.0, std::abs(x) * 0x1p-12);
    };
    unary(input, "X04_sin", "sin", inputs, [](double x) { return std::sin(x); }, tolerance, {1, true});
    unary(input, "X04_cos", "cos", inputs, [](double x) { return std::cos(x); }, tolerance, {1, true});
    std::vector<ValueRow> rows;
    for (const float x : inputs) rows.push_back({{bitsOf(x)}, oneOf({1})});
    addValues(input, "X04_range", "(abs(sin(f(0))) <= 1.0 && abs(cos(f(0))) <= 1.0) ? 1u : 0u", std::move(rows));
}

void x05(CaseInput& input) {
    const std::vector<float> inputs{1, 2, 3, 4, 9, 16, 0.25f, 1e-30f, 1e30f, kMax, 0x1p-126f, 123.456f};
    unary(
        input, "X05_inversesqrt", "inversesqrt", inputs, [](double x) { return 1 / std::sqrt(x); },
        [](double, double y) { return 2 * ulpOf(y); });
    // 1 / inversesqrt(x): 2 ULP and a division's 2.5.
    unary(
        input, "X05_sqrt", "sqrt", inputs, [](double x) { return std::sqrt(x); },
        [](double, double y) { return 5 * ulpOf(y); });
    unary(
        input, "X05_zero", "sqrt", {0.0f, 0x1p-140f}, [](double x) { return std::sqrt(x); },
        [](double x, double) { return x == 0 ? 0.0 : 1e-20; });
}

void x06(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const float x : {1.0f, 3.0f, 7.0f, 1e10f, 1e-10f, kMax, 0x1p-126f, 0.1f}) {
        for (const float y : {1.0f, 3.0f, 10.0f, 0x1p126f, 0x1p-126f, 0.7f, x}) {
            const double quotient = static_cast<double>(x) / static_cast<double>(y);
            rows.push_back({{bitsOf(x), bitsOf(y)}, floatWithin(quotient, 2.5)});
        }
    }
    rows.push_back({{bitsOf(1), bitsOf(0x1p-140f)}, anything()});
    addValues(input, "X06", "floatBitsToUint(f(0) / f(1))", std::move(rows));
}

void x07(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const float x : {1.0000001f, 3.1415927f, 1.1f, 12345.679f}) {
        const float product = x * x;
        const double fused = static_cast<double>(x) * static_cast<double>(x) - static_cast<double>(product);
        rows.push_back({{bitsOf(x), bitsOf(x), bitsOf(-product)},
                        oneOf({bitsOf(static_cast<float>(fused)), bitsOf(0), bitsOf(-0.0f)})});
    }
    addValues(input, "X07", "floatBitsToUint(fma(f(0), f(1), f(2)))", std::move(rows));
}

void x08(CaseInput& input) {
    std::vector<ValueRow> zero, sums;
    for (const float a : {1.1f, 3.3333333f, 1e10f, 7.7e-12f}) {
        for (const float b : {0.3f, 1.0000001f, 12345.679f}) {
            zero.push_back({{bitsOf(a), bitsOf(b)}, oneOf({bitsOf(0), bitsOf(-0.0f)})});
            const float sum = a + b;
            sums.push_back({{bitsOf(a), bitsOf(b)}, oneOf({bitsOf(sum - a)})});
        }
    }
    const char* declarations =
        "float twice(float a, float b) { precise float r = a * b - a * b; return r; }\n"
        "float sum(float a, float b) { precise float s = a + b; precise float r = s - a; return r; }\n";
    addValues(input, "X08_product", "floatBitsToUint(twice(f(0), f(1)))", std::move(zero), declarations);
    addValues(input, "X08_sum", "floatBitsToUint(sum(f(0), f(1)))", std::move(sums), declarations);
}

void x09(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const float y : {1.0f, -1.0f, 0.001f, 1e10f, -1e-10f, 3.0f}) {
        for (const float x : {1.0f, -1.0f, 1000.0f, -1e-10f, 2.5f}) {
            rows.push_back({{bitsOf(y), bitsOf(x)},
                            floatWithin(std::atan2(static_cast<double>(y), static_cast<double>(x)), 4096)});
        }
    }
    rows.push_back({{bitsOf(0), bitsOf(0)}, anything()});
    addValues(input, "X09", "floatBitsToUint(atan(f(0), f(1)))", std::move(rows));
}

void x10(CaseInput& input) {
    const auto values = [&](const char* function, std::vector<std::pair<float, std::vector<float>>> table) {
        std::vector<ValueRow> rows;
        for (const auto& [x, permitted] : table) {
            std::vector<uint32_t> bits;
            for (const float y : permitted) bits.push_back(bitsOf(y));
            rows.push_back({{bitsOf(x)}, oneOf(bits)});
        }
        addValues(input, std::string("X10_") + function, std::string("floatBitsToUint(") + function + "(f(0)))",
                  std::move(rows));
    };
    values("fract",
           {{-0x1p-30f, {std::nextafter(1.0f, 0.0f), 1.0f}}, {1.75f, {0.75f}}, {-1.25f, {0.75f}}, {16777216.0f, {0}}});
    values("floor", {{-0.5f, {-1}}, {0.5f, {0}}, {-1.0f, {-1}}, {8388607.5f, {8388607}}, {-8388607.5f, {-8388608.0f}}});
    values("round", {{0.5f, {0, 1}},
                     {1.5f, {2, 1}},
                     {2.5f, {2, 3}},
                     {-0.5f, {-0.0f, 0.0f, -1}},
                     {8388607.5f, {8388608.0f, 8388607}}});
    values("roundEven",
           {{0.5f, {0}}, {1.5f, {2}}, {2.5f, {2}}, {3.5f, {4}}, {-2.5f, {-2}}, {8388607.5f, {8388608.0f}}});
    values("trunc", {{-0.75f, {-0.0f, 0.0f}}, {1e10f, {1e10f}}, {-3.99f, {-3}}});
    std::vector<ValueRow> rows;
    for (const float x : {3.0f, 0.1f, 1e10f, 7.7f})
        rows.push_back({{bitsOf(x), bitsOf(x)}, oneOf({bitsOf(0), bitsOf(x)})});
    rows.push_back({{bitsOf(-1), bitsOf(3)}, oneOf({bitsOf(2)})});
    rows.push_back({{bitsOf(5.5f), bitsOf(2)}, oneOf({bitsOf(1.5f)})});
    addValues(input, "X10_mod", "floatBitsToUint(mod(f(0), f(1)))", std::move(rows));
}

// What a half of these bits is worth.
double halfValue(uint32_t bits) {
    const int exponent = static_cast<int>(bits >> 10 & 31);
    const double mantissa = bits & 1023, sign = (bits & 0x8000) != 0 ? -1 : 1;
    if (exponent == 31) return mantissa != 0 ? std::nan("") : sign * static_cast<double>(kInf);
    return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(mantissa + 1024, exponent - 25));
}

void x11(CaseInput& input) {
    constexpr VkExtent2D kCodes{256, 256};
    SceneRecorder record("X11", "All halves unpacked.");
    const uint32_t target = record.colorTarget("floats", VK_FORMAT_R32_UINT, kCodes);
    record.pass(kCodes).color(target, {0, 0, 0, 0});
    record.draw(record.pipeline(record.vertex(kCoverVertexGlsl), record.fragment(R"(#version 450
layout(location = 0) out uint result;
void main() {
    uint code = uint(gl_FragCoord.y) * 256u + uint(gl_FragCoord.x);
    result = floatBitsToUint(unpackHalf2x16(code).x);
}
)")),
                3);
    record.output(target);
    const size_t scene = input.scene(record.finish());
    judgePixels(input, scene, 0, kCodes, [](const PixelReader& pixels, const Declared&) -> Verdict {
        Verdict worst;
        for (uint32_t code = 0; code < 65536; ++code) {
            const double expected = halfValue(code), got = pixels.number(code % 256, code / 256, 0);
            if (std::isnan(expected) ? std::isnan(got) : got == expected) continue;
            const std::string text = "half " + std::to_string(code) + " unpacks to " + std::to_string(got) +
                                     ", exactly " + std::to_string(expected);
            const bool flushed = got == 0 && std::abs(expected) < 0x1p-14;
            worst = worst.worse(flushed ? Verdict::allowed(text + ": denormal halves may be flushed")
                                        : Verdict::wrong(text));
        }
        return worst;
    });
    std::vector<ValueRow> packed;
    for (const auto& [x, down, up] : {std::tuple{1.0f, 0x3c00u, 0x3c00u},
                                      {1.00048828125f, 0x3c00u, 0x3c01u},
                                      {65504.0f, 0x7bffu, 0x7bffu},
                                      {65520.0f, 0x7c00u, 0x7bffu},
                                      {0x1p-24f, 1u, 1u},
                                      {0.1f, 0x2e66u, 0x2e67u},
                                      {-2.0f, 0xc000u, 0xc000u}})
        packed.push_back({{bitsOf(x)}, oneOf({down, up})});
    addValues(input, "X11_pack", "packHalf2x16(vec2(f(0), 0.0))", std::move(packed));
    std::vector<ValueRow> unorm;
    for (const auto& [x, code] :
         {std::pair{0.0f, 0u}, {1.0f, 255u}, {2.0f, 255u}, {-1.0f, 0u}, {0.25f, 64u}, {0.75f, 191u}})
        unorm.push_back({{bitsOf(x)}, oneOf({code})});
    addValues(input, "X11_unorm", "packUnorm4x8(vec4(f(0), 0.0, 0.0, 0.0))", std::move(unorm));
    std::vector<ValueRow> scaled;
    for (const auto& [x, e, y] :
         {std::tuple{1.0f, 10, 1024.0f}, {1.5f, -126, 0x1.8p-126f}, {1.0f, 127, 0x1p127f}, {0.0f, 100, 0.0f}})
        scaled.push_back({{bitsOf(x), static_cast<uint32_t>(e)}, oneOf({bitsOf(y)})});
    addValues(input, "X11_ldexp", "floatBitsToUint(ldexp(f(0), i(1)))", std::move(scaled));
}

void x12(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const auto& [x, y] : {std::pair{3.0f, 4.0f}, {1e10f, 0.0f}, {0.5f, -1.2f}}) {
        rows.push_back(
            {{bitsOf(x), bitsOf(y)}, floatWithin(std::hypot(static_cast<double>(x), static_cast<double>(y)), 8)});
    }
    // Squares overflow or vanish: by the formula infinite or 0, with scaling right.
    rows.push_back(
        {{bitsOf(1e20f), bitsOf(1e20f)},
         oneOf({bitsOf(static_cast<float>(std::hypot(static_cast<double>(1e20f), static_cast<double>(1e20f)))),
                bitsOf(kInf)},
               bitsOf(kInf))});
    rows.push_back({{bitsOf(0), bitsOf(0)}, oneOf({bitsOf(0)})});
    addValues(input, "X12_length", "floatBitsToUint(length(vec2(f(0), f(1))))", std::move(rows));
    std::vector<ValueRow> undefined{{{bitsOf(0), bitsOf(0)}, anything()}, {{bitsOf(1e20f), bitsOf(0)}, anything()}};
    addValues(input, "X12_normalize", "floatBitsToUint(normalize(vec2(f(0), f(1))).x)", std::move(undefined));
    std::vector<ValueRow> refracted{{{bitsOf(0.6f), bitsOf(0.8f), bitsOf(1.5f)}, oneOf({bitsOf(0), bitsOf(-0.0f)})}};
    addValues(input, "X12_refract", "floatBitsToUint(refract(vec2(f(1), -f(0)), vec2(0.0, 1.0), f(2)).x)",
              std::move(refracted));
}

// Sums of three products in any order.
void x13(CaseInput& input) {
    std::vector<ValueRow> rows;
    for (const auto& v : {std::array{1e8f, 1.0f, -1e8f}, {0.1f, 0.2f, 0.3f}, {16777216.0f, 1.0f, 1.0f}}) {
        std::vector<uint32_t> permitted;
        std::array<size_t, 3> order{0, 1, 2};
        do {
            permitted.push_back(bitsOf((v[order[0]] + v[order[1]]) + v[order[2]]));
        } while (std::ranges::next_permutation(order).found);
        const float nearest =
            static_cast<float>(static_cast<double>(v[0]) + static_cast<double>(v[1]) + static_cast<double>(v[2]));
        const bool reached = std::ranges::count(permitted, bitsOf(nearest)) != 0;
        if (reached) permitted.insert(permitted.begin(), bitsOf(nearest));
        rows.push_back({{bitsOf(v[0]), bitsOf(v[1]), bitsOf(v[2])}, oneOf(permitted, bitsOf((v[0] + v[1]) + v[2]))});
    }
    addValues(input, "X13", "floatBitsToUint(dot(vec3(f(0), f(1), f(2)), vec3(1.0)))", std::move(rows));
}

constexpr std::string_view kPrecision = "Vulkan, Precision and Operation of SPIR-V Instructions";
constexpr std::string_view kGroupOperations = "Vulkan, Group Operations; Helper Invocations";

const std::vector<HardCase> kCases{
    {"X01",
     "exp2 at integers, at the ends of its range and an ULP beside",
     "(3 + 2|x|) ULP; powers of two best exactly.",
     kPrecision,
     x01,
     {},
     {{"swiftshader", "clamps near -127 and 128 and uses a polynomial on the bits: beyond the bound"}}},
    {"X02", "log2 at 1 +- 2^-k and at powers of two", "2^-21 in [1/2, 2], 3 ULP outside; log2(1) = 0.", kPrecision,
     x02},
    {"X03", "pow near 1, with large exponents, at 0, of negative numbers",
     "exp2(y log2 x), errors inherited; x < 0 is undefined.", kPrecision, x03},
    {"X04",
     "sin and cos at multiples of pi/2, 10^4, 10^8, 2^30",
     "2^-11 in [-pi, pi]; never beyond [-1, 1].",
     kPrecision,
     x04,
     {},
     {{"swiftshader", "a polynomial of degree 5 on a scaled reduction: overshoots, loses large arguments"}}},
    {"X05", "inversesqrt and sqrt of squares, of 0 and of denormals", "2 ULP; sqrt inherits 1 / inversesqrt.",
     kPrecision, x05},
    {"X06",
     "Division at the ends of the range, x/x, x/1",
     "2.5 ULP for |y| in [2^-126, 2^126].",
     kPrecision,
     x06,
     {},
     {{"lavapipe", "its tests ask for 20 bits of a reciprocal: beyond the bound of a quotient"}}},
    {"X07", "fma with cancellation", "Fused or not; nothing in between.", kPrecision, x07},
    {"X08", "precise: a*b - a*b, (a+b) - a", "Every operation rounded by itself.", "Vulkan, NoContraction", x08},
    {"X09", "atan of two arguments in all quadrants", "4096 ULP.", kPrecision, x09},
    {"X10", "fract, floor, round, roundEven, trunc at ties, mod(x, x)", "Exact; fract may reach 1, mod(x, x) may be x.",
     kPrecision, x10},
    {"X11", "All halves unpacked; packing, unorm, ldexp at their ends", "Exact; packing rounds to either neighbour.",
     kPrecision, x11},
    {"X12", "length beyond the square root of the range, normalize(0), total refraction",
     "As the formula; scaling would be right.", kPrecision, x12},
    {"X13", "dot of numbers that cancel", "Any order of sums.", kPrecision, x13},
    {"X14", "Halves and RelaxedPrecision: sums, differences, products, quotients, roots",
     "Halves correctly rounded; relaxed no less exact than the table for halves.", kPrecision, x14},
    {"X15", "Subgroup and quad operations, over whole quads and in partly covered ones",
     "Active invocations count; helpers take part where they are active.", kGroupOperations, x15},
    {"X16", "Halves at ties, at the step to infinity, denormal, zeros with signs; conversions from floats and integers",
     "Correctly rounded: either neighbour, the largest or infinity.", kPrecision, x16},
    {"X17", "exp, log, inversesqrt, sin, cos and atan of halves and with RelaxedPrecision",
     "The table for halves: exp 1 + 2|x| ULP, log 3 ULP or 2^-7, sin and cos 2^-7, atan 5 ULP.", kPrecision, x17},
    {"X18", "Ballots, sums, scans, minima and bit operations of the invocations that triangles cover, quads in part",
     "Helper invocations that branched away do not count: the groups, made again from their ballots, give every "
     "result.",
     kGroupOperations, x18},
    {"X19", "Quad broadcasts and swaps in quads that triangles cover in part, and the fine derivatives",
     "Helper invocations are launched: each has its pixel's place; a fine derivative is the difference of a swap.",
     "Vulkan, Quad Group Operations; Derivative Operations", x19},
    {"X20", "Sums, products and scans of floats that cancel, over the invocations of a group",
     "Any order of sums. Declared: in the order of invocations, every step rounded; before the first 0 or 1.",
     kGroupOperations, x20},
};

}  // namespace

std::span<const HardCase> arithmeticCases() {
    return kCases;
}

}  // namespace vernier::conformance::hardcases
