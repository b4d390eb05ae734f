// Every subgroup operation with all lanes, some, and lanes that went different ways, against a plain model.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/compute_harness.h"
#include "tests/spirv_interp/front_support.h"
#include "tests/spirv_interp/half_model.h"

namespace vernier::test {
namespace {

constexpr uint32_t kSize = 32;
constexpr uint32_t kInvocations = 80;  // the third subgroup is half there

/// One subgroup at the instruction.
struct Group {
    uint32_t active = 0;
    uint32_t u[kSize] = {};
    float f[kSize] = {};
    bool runs(uint32_t lane) const { return lane < kSize && (active >> lane & 1) != 0; }
    uint32_t first() const { return static_cast<uint32_t>(std::countr_zero(active)); }
    uint32_t taken(uint32_t lane) const { return runs(lane) ? u[lane] : 0; }
};

struct Case {
    std::string expression;  // of u (uint), f (float) and place (uint): a uint
    std::function<uint32_t(const Group&, uint32_t lane)> model;
};

enum class Mode : uint8_t { reduce, inclusive, exclusive };

template <class T, class Value, class Op>
T reduced(const Group& g, uint32_t lane, Mode mode, uint32_t cluster, T identity, Value&& value, Op&& op) {
    T sum = identity;
    bool any = false;
    for (uint32_t k = lane / cluster * cluster; k < lane / cluster * cluster + cluster; ++k) {
        if (!g.runs(k)) continue;
        if (mode == Mode::inclusive && k > lane) break;
        if (mode == Mode::exclusive && k >= lane) break;
        sum = any ? op(sum, value(g, k)) : value(g, k);
        any = true;
    }
    return sum;
}

struct Half {
    uint16_t bits = 0;
    double value() const { return test::valueOf(bits); }
};

template <class T>
T laneValue(const Group& g, uint32_t lane) {
    if constexpr (std::is_same_v<T, Half>) {
        return {halfOf(g.f[lane])};
    } else if constexpr (std::is_floating_point_v<T>) {
        return static_cast<T>(g.f[lane]);
    } else if constexpr (sizeof(T) == 8) {
        return static_cast<T>(g.u[lane]) << 20;
    } else {
        return static_cast<T>(g.u[lane]);
    }
}

/// Narrow integers as uint(x) of GLSL.
template <class T>
uint32_t wordOf(T x) {
    return static_cast<uint32_t>(x);
}
uint32_t wordOf(Half x) {
    return x.bits;
}
uint32_t wordOf(float x) {
    return std::bit_cast<uint32_t>(x);
}
uint32_t wordOf(uint64_t x) {
    return static_cast<uint32_t>(x) ^ static_cast<uint32_t>(x >> 32);
}
uint32_t wordOf(double x) {
    return wordOf(std::bit_cast<uint64_t>(x));
}

/// The four modes of one arithmetic operation. `glsl` is Add and the like; `value` a GLSL expression, `word` turns the
/// result into a uint.
template <class T, class Op>
void addArithmetic(std::vector<Case>& cases, const std::string& glsl, const std::string& value,
                   const std::pair<std::string, std::string>& word, T identity, Op op) {
    const auto add = [&](const std::string& call, Mode mode, uint32_t cluster) {
        cases.push_back({word.first + call + word.second, [=](const Group& g, uint32_t lane) {
                             return wordOf(reduced<T>(g, lane, mode, cluster, identity, laneValue<T>, op));
                         }});
    };
    add("subgroup" + glsl + "(" + value + ")", Mode::reduce, kSize);
    add("subgroupInclusive" + glsl + "(" + value + ")", Mode::inclusive, kSize);
    add("subgroupExclusive" + glsl + "(" + value + ")", Mode::exclusive, kSize);
    for (const uint32_t cluster : {1u, 2u, 4u, 8u, 16u, 32u}) {
        add("subgroupClustered" + glsl + "(" + value + ", " + std::to_string(cluster) + ")", Mode::reduce, cluster);
    }
}

std::vector<Case> integerCases() {
    std::vector<Case> cases;
    const std::pair<std::string, std::string> plain{"", ""}, cast{"uint(", ")"};
    addArithmetic<uint32_t>(cases, "Add", "u", plain, 0, [](uint32_t a, uint32_t b) { return a + b; });
    addArithmetic<uint32_t>(cases, "Mul", "u", plain, 1, [](uint32_t a, uint32_t b) { return a * b; });
    addArithmetic<uint32_t>(cases, "Min", "u", plain, ~0u, [](uint32_t a, uint32_t b) { return std::min(a, b); });
    addArithmetic<uint32_t>(cases, "Max", "u", plain, 0, [](uint32_t a, uint32_t b) { return std::max(a, b); });
    addArithmetic<int32_t>(cases, "Min", "int(u)", cast, std::numeric_limits<int32_t>::max(),
                           [](int32_t a, int32_t b) { return std::min(a, b); });
    addArithmetic<int32_t>(cases, "Max", "int(u)", cast, std::numeric_limits<int32_t>::min(),
                           [](int32_t a, int32_t b) { return std::max(a, b); });
    addArithmetic<uint32_t>(cases, "And", "u", plain, ~0u, [](uint32_t a, uint32_t b) { return a & b; });
    addArithmetic<uint32_t>(cases, "Or", "u", plain, 0, [](uint32_t a, uint32_t b) { return a | b; });
    addArithmetic<uint32_t>(cases, "Xor", "u", plain, 0, [](uint32_t a, uint32_t b) { return a ^ b; });
    return cases;
}

template <class T>
std::vector<Case> floatCases(const std::string& value, const std::pair<std::string, std::string>& word) {
    std::vector<Case> cases;
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    addArithmetic<T>(cases, "Add", value, word, 0, [](T a, T b) { return a + b; });
    addArithmetic<T>(cases, "Mul", value, word, 1, [](T a, T b) { return a * b; });
    addArithmetic<T>(cases, "Min", value, word, kInfinity, [](T a, T b) { return b < a ? b : a; });
    addArithmetic<T>(cases, "Max", value, word, -kInfinity, [](T a, T b) { return b > a ? b : a; });
    return cases;
}

std::vector<Case> wideIntegerCases() {
    std::vector<Case> cases;
    const std::pair<std::string, std::string> word{"fold64(", ")"};
    const std::string value = "(uint64_t(u) << 20)";
    addArithmetic<uint64_t>(cases, "Add", value, word, 0, [](uint64_t a, uint64_t b) { return a + b; });
    addArithmetic<uint64_t>(cases, "Max", value, word, 0, [](uint64_t a, uint64_t b) { return std::max(a, b); });
    addArithmetic<uint64_t>(cases, "And", value, word, ~uint64_t{0}, [](uint64_t a, uint64_t b) { return a & b; });
    return cases;
}

/// Every arithmetic operation on an integer of another width than 32; `type` is its GLSL name.
template <class T>
std::vector<Case> narrowIntegerCases(const std::string& type) {
    using Limits = std::numeric_limits<T>;
    std::vector<Case> cases;
    const std::pair<std::string, std::string> word{"uint(", ")"};
    const std::string value = type + "(u)";
    const auto add = [&](const char* glsl, T identity, auto op) {
        addArithmetic<T>(cases, glsl, value, word, identity, [op](T a, T b) { return static_cast<T>(op(a, b)); });
    };
    add("Add", 0, [](T a, T b) { return wordOf(a) + wordOf(b); });
    add("Mul", 1, [](T a, T b) { return wordOf(a) * wordOf(b); });
    add("Min", Limits::max(), [](T a, T b) { return std::min(a, b); });
    add("Max", Limits::min(), [](T a, T b) { return std::max(a, b); });
    add("And", static_cast<T>(-1), [](T a, T b) { return a & b; });
    add("Or", 0, [](T a, T b) { return a | b; });
    add("Xor", 0, [](T a, T b) { return a ^ b; });
    return cases;
}

std::vector<Case> halfCases() {
    std::vector<Case> cases;
    const std::pair<std::string, std::string> word{"uint(float16BitsToUint16(", "))"};
    const auto add = [&](const char* glsl, double identity, auto op) {
        addArithmetic<Half>(cases, glsl, "float16_t(f)", word, Half{halfOf(identity)},
                            [op](Half a, Half b) { return Half{halfOf(op(a.value(), b.value()))}; });
    };
    // Every step is rounded: a double holds sums and products of two halves exactly.
    add("Add", 0, [](double a, double b) { return a + b; });
    add("Mul", 1, [](double a, double b) { return a * b; });
    add("Min", HUGE_VAL, [](double a, double b) { return std::min(a, b); });
    add("Max", -HUGE_VAL, [](double a, double b) { return std::max(a, b); });
    return cases;
}

/// Votes and exchanges of values of 8, 16 and 64 bits.
std::vector<Case> otherWidthCases() {
    const auto allEqual = [](auto value) {
        return [value](const Group& g, uint32_t) {
            bool same = true;
            for (uint32_t k = 0; k < kSize; ++k)
                same = same && (!g.runs(k) || value(g, k) == value(g, g.first() % kSize));
            return same ? 1u : 0u;
        };
    };
    const auto halfBits = [](const Group& g, uint32_t lane) { return g.runs(lane) ? halfOf(g.f[lane]) : 0u; };
    return {
        {"uint(subgroupAllEqual(uint8_t(u & 1)))", allEqual([](const Group& g, uint32_t k) { return g.u[k] & 1; })},
        {"uint(subgroupAllEqual(int16_t(0x7F00 + (u & 0x10000))))", [](const Group&, uint32_t) { return 1u; }},
        {"uint(subgroupAllEqual(uint64_t(u & 2) << 40))",
         allEqual([](const Group& g, uint32_t k) { return g.u[k] & 2; })},
        {"uint(subgroupAllEqual(float16_t(f)))", allEqual([](const Group& g, uint32_t k) { return halfOf(g.f[k]); })},
        {"uint(subgroupBroadcast(uint8_t(u), 5))", [](const Group& g, uint32_t) { return g.taken(5) & 0xFF; }},
        {"fold64(subgroupBroadcastFirst(uint64_t(u) << 20))",
         [](const Group& g, uint32_t) { return wordOf(uint64_t{g.taken(g.first())} << 20); }},
        {"uint(subgroupShuffle(int8_t(u), place))",
         [](const Group& g, uint32_t l) { return wordOf(static_cast<int8_t>(g.taken(g.u[l] % kSize))); }},
        {"uint(subgroupShuffle(u16vec2(7, u), place).y)",
         [](const Group& g, uint32_t l) { return g.taken(g.u[l] % kSize) & 0xFFFF; }},
        {"uint(float16BitsToUint16(subgroupShuffleXor(float16_t(f), 3)))",
         [=](const Group& g, uint32_t l) { return halfBits(g, l ^ 3); }},
        {"uint(float16BitsToUint16(subgroupShuffleDown(float16_t(f), 6)))",
         [=](const Group& g, uint32_t l) { return halfBits(g, l + 6); }},
        {"uint(subgroupQuadSwapDiagonal(int16_t(u)))",
         [](const Group& g, uint32_t l) { return wordOf(static_cast<int16_t>(g.taken(l ^ 3))); }},
        {"fold64(subgroupQuadBroadcast(int64_t(u) << 31, 1))",
         [](const Group& g, uint32_t l) { return wordOf(uint64_t{g.taken((l & ~3u) + 1)} << 31); }},
    };
}

uint32_t maskOf(const Group& g, const std::function<bool(uint32_t)>& condition) {
    uint32_t mask = 0;
    for (uint32_t k = 0; k < kSize; ++k) mask |= (g.runs(k) && condition(k) ? 1u : 0u) << k;
    return mask;
}
uint32_t below(uint32_t lane) {
    return (1u << lane) - 1;
}

std::vector<Case> otherCases() {
    const auto odd = [](const Group& g) { return maskOf(g, [&](uint32_t k) { return (g.u[k] & 1) != 0; }); };
    const auto popcount = [](uint32_t x) { return static_cast<uint32_t>(std::popcount(x)); };
    std::vector<Case> cases = {
        // basic
        {"gl_SubgroupSize", [](const Group&, uint32_t) { return kSize; }},
        {"gl_NumSubgroups", [](const Group&, uint32_t) { return 3u; }},
        {"gl_SubgroupInvocationID", [](const Group&, uint32_t l) { return l; }},
        {"gl_SubgroupID * 32 + gl_SubgroupInvocationID - gl_LocalInvocationIndex",
         [](const Group&, uint32_t) { return 0u; }},
        {"gl_SubgroupEqMask.x + gl_SubgroupEqMask.y", [](const Group&, uint32_t l) { return 1u << l; }},
        {"gl_SubgroupGeMask.x", [](const Group&, uint32_t l) { return ~below(l); }},
        {"gl_SubgroupGtMask.x", [](const Group&, uint32_t l) { return ~below(l) & ~(1u << l); }},
        {"gl_SubgroupLeMask.x", [](const Group&, uint32_t l) { return below(l) | 1u << l; }},
        {"gl_SubgroupLtMask.x + gl_SubgroupLtMask[u % 3 + 1]", [](const Group&, uint32_t l) { return below(l); }},
        {"uint(subgroupElect())", [](const Group& g, uint32_t l) { return l == g.first() ? 1u : 0u; }},
        // vote
        {"uint(subgroupAll(u < 3000000000u))",
         [](const Group& g, uint32_t) {
             return maskOf(g, [&](uint32_t k) { return g.u[k] < 3000000000u; }) == g.active ? 1u : 0u;
         }},
        {"uint(subgroupAny(u > 4000000000u))",
         [](const Group& g, uint32_t) {
             return maskOf(g, [&](uint32_t k) { return g.u[k] > 4000000000u; }) != 0 ? 1u : 0u;
         }},
        {"uint(subgroupAllEqual(u)) + uint(subgroupAllEqual(u & 0u)) * 2",
         [](const Group& g, uint32_t) {
             return 2 + (maskOf(g, [&](uint32_t k) { return g.u[k] == g.u[g.first()]; }) == g.active ? 1u : 0u);
         }},
        {"uint(subgroupAllEqual(vec2(f, 1))) + uint(subgroupAllEqual((u & 1) != 0)) * 2",
         [](const Group& g, uint32_t) {
             const uint32_t a = maskOf(g, [&](uint32_t k) { return g.f[k] == g.f[g.first()]; });
             const uint32_t b = maskOf(g, [&](uint32_t k) { return (g.u[k] & 1) == (g.u[g.first()] & 1); });
             return (a == g.active ? 1u : 0u) + (b == g.active ? 2u : 0u);
         }},
        // ballot
        {"subgroupBallot((u & 1) != 0).x", [=](const Group& g, uint32_t) { return odd(g); }},
        {"subgroupBallot(true).x + subgroupBallot(true).w", [](const Group& g, uint32_t) { return g.active; }},
        {"uint(subgroupInverseBallot(uvec4(0x12345678)))",
         [](const Group&, uint32_t l) { return 0x12345678u >> l & 1; }},
        {"uint(subgroupBallotBitExtract(subgroupBallot((u & 1) != 0), place))",
         [=](const Group& g, uint32_t l) { return odd(g) >> g.u[l] % kSize & 1; }},
        {"subgroupBallotBitCount(subgroupBallot((u & 1) != 0))",
         [=](const Group& g, uint32_t) { return popcount(odd(g)); }},
        {"subgroupBallotInclusiveBitCount(subgroupBallot((u & 1) != 0))",
         [=](const Group& g, uint32_t l) { return popcount(odd(g) & (below(l) | 1u << l)); }},
        {"subgroupBallotExclusiveBitCount(subgroupBallot((u & 1) != 0))",
         [=](const Group& g, uint32_t l) { return popcount(odd(g) & below(l)); }},
        {"subgroupBallotFindLSB(subgroupBallot(true))", [](const Group& g, uint32_t) { return g.first(); }},
        {"subgroupBallotFindMSB(subgroupBallot(true))",
         [](const Group& g, uint32_t) { return 31u - static_cast<uint32_t>(std::countl_zero(g.active)); }},
        {"subgroupBroadcast(u, 5)", [](const Group& g, uint32_t) { return g.taken(5); }},
        {"subgroupBroadcast(uvec3(u, 7, u), 12).z", [](const Group& g, uint32_t) { return g.taken(12); }},
        {"subgroupBroadcastFirst(u)", [](const Group& g, uint32_t) { return g.taken(g.first()); }},
        {"uint(subgroupBroadcastFirst(u % 3 == 0))",
         [](const Group& g, uint32_t) { return g.taken(g.first()) % 3 == 0 ? 1u : 0u; }},
        {"fold64(packDouble2x32(uvec2(u, 77)), 6)",
         [](const Group& g, uint32_t) { return g.taken(6) ^ (g.runs(6) ? 77 : 0); }},
        // shuffle
        {"subgroupShuffle(u, place)", [](const Group& g, uint32_t l) { return g.taken(g.u[l] % kSize); }},
        {"subgroupShuffle(u, place + 16)", [](const Group& g, uint32_t l) { return g.taken(g.u[l] % kSize + 16); }},
        {"subgroupShuffleXor(u, 9)", [](const Group& g, uint32_t l) { return g.taken(l ^ 9); }},
        {"subgroupShuffleUp(u, 3)", [](const Group& g, uint32_t l) { return g.taken(l - 3); }},
        {"subgroupShuffleDown(u, 6)", [](const Group& g, uint32_t l) { return g.taken(l + 6); }},
        // quad
        {"subgroupQuadBroadcast(u, 2)", [](const Group& g, uint32_t l) { return g.taken((l & ~3u) + 2); }},
        {"subgroupQuadSwapHorizontal(u)", [](const Group& g, uint32_t l) { return g.taken(l ^ 1); }},
        {"subgroupQuadSwapVertical(u)", [](const Group& g, uint32_t l) { return g.taken(l ^ 2); }},
        {"subgroupQuadSwapDiagonal(u)", [](const Group& g, uint32_t l) { return g.taken(l ^ 3); }},
        // logic on booleans
        {"uint(subgroupAnd((u & 1) != 0)) + 2 * uint(subgroupOr((u & 1) != 0)) + 4 * uint(subgroupXor((u & 1) != 0))",
         [=](const Group& g, uint32_t) {
             return (odd(g) == g.active ? 1u : 0u) + (odd(g) != 0 ? 2u : 0u) + (popcount(odd(g)) % 2) * 4;
         }},
        {"uint(subgroupExclusiveAnd((u & 1) != 0)) + 2 * uint(subgroupInclusiveOr((u & 1) != 0))",
         [=](const Group& g, uint32_t l) {
             const uint32_t before = g.active & below(l);
             return ((odd(g) & before) == before ? 1u : 0u) + ((odd(g) & (below(l) | 1u << l)) != 0 ? 2u : 0u);
         }},
    };
    return cases;
}

constexpr const char* kExtensions = R"(#version 450
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_ARB_gpu_shader_int64 : require
)";

constexpr const char* kPrologue = R"(layout(local_size_x = 80) in;
layout(set = 0, binding = 0) readonly buffer A { uint a[]; };
layout(set = 0, binding = 1) readonly buffer F { float b[]; };
layout(set = 0, binding = 2) buffer O { uint o[]; };
uint fold64(uint64_t x) { return uint(x) ^ uint(x >> 32); }
uint fold64(int64_t x) { return fold64(uint64_t(x)); }
uint fold64(double x) { uvec2 w = unpackDouble2x32(x); return w.x ^ w.y; }
uint fold64(double x, const int lane) { return fold64(subgroupBroadcast(x, 6)); }
void main() {
uint i = gl_LocalInvocationIndex, u = a[i], place = u % 32; float f = b[i];
)";

/// Which lanes run the instruction together with lane `lane` of an invocation.
struct Flow {
    std::string head;  // before the statements
    std::function<bool(uint32_t self, uint32_t other, const std::vector<uint32_t>& a)> together;
};

const std::vector<Flow>& flows() {
    using Words = const std::vector<uint32_t>&;
    static const std::vector<Flow> all = {
        {"{", [](uint32_t, uint32_t, Words) { return true; }},
        {"if (i < 50) {", [](uint32_t, uint32_t other, Words) { return other < 50; }},
        {"if (i % 3 == 1) {", [](uint32_t, uint32_t other, Words) { return other % 3 == 1; }},
        {"if ((u & 4) != 0) {", [](uint32_t, uint32_t other, Words a) { return (a[other] & 4) != 0; }},
        {"if (i == 37) {", [](uint32_t, uint32_t other, Words) { return other == 37; }},
        {"if (i % 2 == 0) o[i] = 1; if (i % 5 == 0) return; {",
         [](uint32_t, uint32_t other, Words) { return other % 5 != 0; }},
        // The last round of an invocation is run together with those that are not done yet.
        {"for (uint k = 0; k <= i % 4; ++k) {",
         [](uint32_t self, uint32_t other, Words) { return other % 4 >= self % 4; }},
    };
    return all;
}

void check(const std::vector<Case>& cases) {
    std::mt19937 random(7);
    std::vector<uint32_t> a(kInvocations);
    for (uint32_t& word : a) word = random();
    std::vector<float> b(kInvocations);
    for (float& value : b) value = static_cast<float>(random() % 2000) / 64.0f - 3.0f;
    for (const Flow& flow : flows()) {
        std::string text = std::string(kExtensions) + kPrologue + flow.head + "\n";
        for (size_t n = 0; n < cases.size(); ++n) {
            text += "o[i + " + std::to_string(n * kInvocations) + "] = " + cases[n].expression + ";\n";
        }
        text += "} }\n";
        const ir::Program program = loadCompute(text);
        EXPECT_TRUE(program.usesSubgroups);
        const auto o = dispatchEverywhere(
            program, {{2, 1, 1}, {}},
            {{0, a}, {1, wordsOf(b)}, {2, std::vector<uint32_t>(cases.size() * kInvocations)}}, {}, kSize)[2];
        for (uint32_t i = 0; i < kInvocations; ++i) {
            Group group;
            for (uint32_t k = 0; k < kSize && i / kSize * kSize + k < kInvocations; ++k) {
                const uint32_t other = i / kSize * kSize + k;
                group.u[k] = a[other];
                group.f[k] = b[other];
                group.active |= (flow.together(i, other, a) ? 1u : 0u) << k;
            }
            if (!group.runs(i % kSize)) continue;
            for (size_t n = 0; n < cases.size(); ++n) {
                ASSERT_EQ(o[n * kInvocations + i], cases[n].model(group, i % kSize))
                    << cases[n].expression << ", invocation " << i << ", " << flow.head;
            }
        }
    }
}

TEST(Subgroup, IntegerArithmetic) {
    check(integerCases());
}

TEST(Subgroup, FloatArithmetic) {
    check(floatCases<float>("f", {"floatBitsToUint(", ")"}));
}

TEST(Subgroup, DoubleArithmetic) {
    check(floatCases<double>("double(f)", {"fold64(", ")"}));
}

TEST(Subgroup, WideIntegerArithmetic) {
    check(wideIntegerCases());
}

TEST(Subgroup, NarrowIntegerArithmetic) {
    check(narrowIntegerCases<int8_t>("int8_t"));
    check(narrowIntegerCases<uint8_t>("uint8_t"));
    check(narrowIntegerCases<int16_t>("int16_t"));
    check(narrowIntegerCases<uint16_t>("uint16_t"));
}

TEST(Subgroup, HalfArithmetic) {
    check(halfCases());
}

TEST(Subgroup, OtherWidths) {
    check(otherWidthCases());
}

TEST(Subgroup, VotesBallotsShufflesAndQuads) {
    check(otherCases());
}

// A sum begins with the first value, and a NaN gives way to a number.
TEST(Subgroup, SpecialFloats) {
    const ir::Program program = loadCompute(std::string(kExtensions) + kPrologue +
                                            "o[i] = floatBitsToUint(subgroupAdd(f)); o[80 + i] = "
                                            "floatBitsToUint(subgroupMin(f)); o[160 + i] = "
                                            "floatBitsToUint(subgroupMax(f)); }");
    std::vector<float> b(kInvocations, -0.0f);
    for (uint32_t i = kSize; i < kInvocations; ++i) b[i] = i % 2 == 0 ? std::nanf("") : static_cast<float>(i);
    const auto o = dispatchEverywhere(
        program, {},
        {{0, std::vector<uint32_t>(kInvocations)}, {1, wordsOf(b)}, {2, std::vector<uint32_t>(3 * kInvocations)}}, {},
        kSize)[2];
    EXPECT_EQ(o[0], 0x80000000u);
    EXPECT_EQ(o[80 + 40], std::bit_cast<uint32_t>(33.0f));
    EXPECT_EQ(o[160 + 40], std::bit_cast<uint32_t>(63.0f));
}

// The older instructions of SPV_KHR_shader_ballot and SPV_KHR_subgroup_vote.
TEST(Subgroup, OlderForms) {
    const Words words = assemble(R"(OpCapability Shader
OpCapability SubgroupBallotKHR
OpCapability SubgroupVoteKHR
OpExtension "SPV_KHR_shader_ballot"
OpExtension "SPV_KHR_subgroup_vote"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %index %lane
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %index BuiltIn LocalInvocationIndex
OpDecorate %lane BuiltIn SubgroupLocalInvocationId
OpDecorate %block BufferBlock
OpMemberDecorate %block 0 Offset 0
OpDecorate %words ArrayStride 4
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
%void = OpTypeVoid
%bool = OpTypeBool
%fn = OpTypeFunction %void
%uint = OpTypeInt 32 0
%uvec4 = OpTypeVector %uint 4
%c0 = OpConstant %uint 0
%c1 = OpConstant %uint 1
%c2 = OpConstant %uint 2
%c4 = OpConstant %uint 4
%c8 = OpConstant %uint 8
%c16 = OpConstant %uint 16
%c20 = OpConstant %uint 20
%c64 = OpConstant %uint 64
%words = OpTypeRuntimeArray %uint
%block = OpTypeStruct %words
%pin = OpTypePointer Input %uint
%pblock = OpTypePointer Uniform %block
%pword = OpTypePointer Uniform %uint
%index = OpVariable %pin Input
%lane = OpVariable %pin Input
%out = OpVariable %pblock Uniform
%main = OpFunction %void None %fn
%ml = OpLabel
%i = OpLoad %uint %index
%l = OpLoad %uint %lane
%low = OpULessThan %bool %l %c20
%small = OpULessThan %bool %l %c64
OpSelectionMerge %end None
OpBranchConditional %low %then %end
%then = OpLabel
%bit = OpBitwiseAnd %uint %l %c2
%cond = OpINotEqual %bool %bit %c0
%ballot = OpSubgroupBallotKHR %uvec4 %cond
%word = OpCompositeExtract %uint %ballot 0
%first = OpSubgroupFirstInvocationKHR %uint %i
%read = OpSubgroupReadInvocationKHR %uint %i %c8
%all = OpSubgroupAllKHR %bool %low
%any = OpSubgroupAnyKHR %bool %cond
%same = OpSubgroupAllEqualKHR %bool %cond
%same2 = OpSubgroupAllEqualKHR %bool %small
%v1 = OpSelect %uint %all %c1 %c0
%v2 = OpSelect %uint %any %c2 %c0
%v3 = OpSelect %uint %same %c4 %c0
%v4 = OpSelect %uint %same2 %c8 %c0
%s1 = OpIAdd %uint %v1 %v2
%s2 = OpIAdd %uint %v3 %v4
%votes = OpIAdd %uint %s1 %s2
%at = OpIMul %uint %i %c4
%at1 = OpIAdd %uint %at %c1
%at2 = OpIAdd %uint %at1 %c1
%at3 = OpIAdd %uint %at2 %c1
%p0 = OpAccessChain %pword %out %c0 %at
%p1 = OpAccessChain %pword %out %c0 %at1
%p2 = OpAccessChain %pword %out %c0 %at2
%p3 = OpAccessChain %pword %out %c0 %at3
OpStore %p0 %word
OpStore %p1 %first
OpStore %p2 %read
OpStore %p3 %votes
OpBranch %end
%end = OpLabel
OpReturn
OpFunctionEnd
)");
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::compute;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    const auto o = dispatchEverywhere(*program, {}, {{0, std::vector<uint32_t>(256)}}, {}, kSize)[0];
    for (uint32_t i = 0; i < 64; ++i) {
        const bool runs = i % kSize < 20;
        EXPECT_EQ(o[4 * i], runs ? 0x000CCCCCu : 0) << i;
        EXPECT_EQ(o[4 * i + 1], runs ? i / kSize * kSize : 0) << i;
        EXPECT_EQ(o[4 * i + 2], runs ? i / kSize * kSize + 8 : 0) << i;
        EXPECT_EQ(o[4 * i + 3], runs ? 1u + 2 + 8 : 0) << i;
    }
}

// In a fragment program a subgroup is 32 lanes of a batch; helper lanes run, discarded ones do not.
TEST(Subgroup, FragmentPrograms) {
    const Words words = compileGlsl(ir::Stage::fragment, std::string(kExtensions) + R"(
layout(location = 0) flat in uint v;
layout(location = 0) out uint sum;
layout(location = 1) out uint neighbour;
layout(location = 2) out uint place;
void main() {
    neighbour = subgroupQuadSwapHorizontal(v);
    if (v % 5 == 0) discard;
    sum = subgroupAdd(v);
    place = gl_SubgroupInvocationID + gl_SubgroupSize * 100;
}
)");
    ShaderSource source;
    source.words = words;
    source.stage = ir::Stage::fragment;
    const Result<ir::Program> program = loadShader(source);
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_TRUE(program->usesQuads);
    std::vector<uint32_t> v(64);
    for (uint32_t i = 0; i < 64; ++i) v[i] = i * i + 1;
    for (const Isa isa : isas()) {
        for (const uint32_t capacity : {32u, 64u}) {
            RunSetup setup;
            setup.isa = isa;
            setup.capacity = capacity;
            setup.lanes = std::min(capacity, 56u);
            setup.store.assign(64, ~0u);
            setup.store[3] = 0;
            const RunResult result = runBatch(*program, {v}, setup);
            const auto output = [&](uint32_t location) {
                for (uint32_t k = 0; k < program->outputs.size(); ++k) {
                    if (program->outputs[k].location == location) return result.outputs[k];
                }
                return std::vector<uint32_t>(setup.lanes);
            };
            for (uint32_t lane = 0; lane < setup.lanes; ++lane) {
                if (v[lane] % 5 == 0) continue;
                uint32_t sum = 0;
                for (uint32_t k = lane / kSize * kSize; k < std::min(lane / kSize * kSize + kSize, setup.lanes); ++k) {
                    sum += v[k] % 5 == 0 ? 0 : v[k];
                }
                EXPECT_EQ(output(0)[lane], sum);
                EXPECT_EQ(output(1)[lane], v[lane ^ 1]);
                EXPECT_EQ(output(2)[lane], lane % kSize + 3200);
            }
        }
    }
}

TEST(Subgroup, NarrowBatchesAreRefused) {
    const ir::Program program = loadCompute(std::string(kExtensions) + kPrologue + "o[i] = subgroupAdd(u); }");
    const auto compiled = BatchProgram::compile(program, {Isa::sse4, MathTier::standard, 16});
    ASSERT_FALSE(compiled.ok());
    EXPECT_EQ(compiled.error().message, "BatchOptions::lanes is 16; 'main' uses subgroups, which have 32 invocations");
}

}  // namespace
}  // namespace vernier::test
