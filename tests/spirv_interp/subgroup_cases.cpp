#include "tests/spirv_interp/subgroup_cases.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/spirv_interp/half_model.h"

namespace vernier::test {
namespace {

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

template <class T>
std::vector<Case> floatCasesOf(const std::string& value, const std::pair<std::string, std::string>& word) {
    std::vector<Case> cases;
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    addArithmetic<T>(cases, "Add", value, word, 0, [](T a, T b) { return a + b; });
    addArithmetic<T>(cases, "Mul", value, word, 1, [](T a, T b) { return a * b; });
    addArithmetic<T>(cases, "Min", value, word, kInfinity, [](T a, T b) { return b < a ? b : a; });
    addArithmetic<T>(cases, "Max", value, word, -kInfinity, [](T a, T b) { return b > a ? b : a; });
    return cases;
}

/// Every arithmetic operation on an integer of another width than 32; `type` is its GLSL name.
template <class T>
std::vector<Case> narrowCasesOf(const std::string& type) {
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

uint32_t maskOf(const Group& g, const std::function<bool(uint32_t)>& condition) {
    uint32_t mask = 0;
    for (uint32_t k = 0; k < kSize; ++k) mask |= (g.runs(k) && condition(k) ? 1u : 0u) << k;
    return mask;
}
uint32_t below(uint32_t lane) {
    return (1u << lane) - 1;
}

}  // namespace

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

std::vector<Case> wideIntegerCases() {
    std::vector<Case> cases;
    const std::pair<std::string, std::string> word{"fold64(", ")"};
    const std::string value = "(uint64_t(u) << 20)";
    addArithmetic<uint64_t>(cases, "Add", value, word, 0, [](uint64_t a, uint64_t b) { return a + b; });
    addArithmetic<uint64_t>(cases, "Max", value, word, 0, [](uint64_t a, uint64_t b) { return std::max(a, b); });
    addArithmetic<uint64_t>(cases, "And", value, word, ~uint64_t{0}, [](uint64_t a, uint64_t b) { return a & b; });
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

std::vector<Case> floatCases() {
    return floatCasesOf<float>("f", {"floatBitsToUint(", ")"});
}
std::vector<Case> doubleCases() {
    return floatCasesOf<double>("double(f)", {"fold64(", ")"});
}
std::vector<Case> narrowIntegerCases() {
    std::vector<Case> all;
    for (const auto& cases : {narrowCasesOf<int8_t>("int8_t"), narrowCasesOf<uint8_t>("uint8_t"),
                              narrowCasesOf<int16_t>("int16_t"), narrowCasesOf<uint16_t>("uint16_t")}) {
        all.insert(all.end(), cases.begin(), cases.end());
    }
    return all;
}

}  // namespace vernier::test
