// Modules that are not modules: an Error, or a run within its budget, and never anything worse (run under
// sanitizers).
#include <random>

#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

/// Uses most of what can go wrong: nested types, dynamic indices, calls, phis, images, derivatives, struct
/// results.
Words sampleModule() {
    return compileFragment(fragmentSource(R"(
        struct S { mat2 m; float f[3]; };
        layout(constant_id = 0) const int n = 3;
        layout(set = 0, binding = 0) buffer B { layout(row_major) mat3 m; S s[2]; int tail[]; } b;
        layout(set = 0, binding = 1) uniform sampler2D t[2];
        float g[n];
        vec2 f(inout vec2 x, int k) { x += b.s[k & 1].m[1]; if (k > 5) return x; return x * 2.0; })",
                                          R"(
        vec2 p = v.xy;
        for (int k = 0; k < i.x; ++k) { g[k % n] = float(k); p = f(p, k); if (p.x > 100.0 && p.y > 3.0) break; }
        switch (i.y) { case 1: p.x = 1.0; case 2: p.y = modf(p.x, g[0]); break; default: p += g[u.x % 3u]; }
        r = texture(t[i.x & 1], p) + dFdx(v) + vec4(inverse(b.m)[1], b.tail.length());
        ri = ivec4(atomicAdd(b.tail[i.x], 1), bitfieldExtract(i.x, 1, 3), packHalf2x16(p), 0);
        if (p.x < -1e9) discard;)"));
}

/// Whether the module got so far as to run without an Error.
bool exercise(const Words& words) {
    const auto module = Module::parse(words);
    if (!module) {
        EXPECT_FALSE(module.error().message.empty());
        return false;
    }
    bool ran = true;
    for (const EntryPoint& entry : module->entryPoints()) {
        const auto interpreter = Interpreter<float>::create(*module, entry.model, entry.name, {.stepBudget = 5000});
        if (!interpreter) return false;
        TestBuffers<float> buffers;
        buffers.buffers[{0, 0, 0}] = std::vector<std::byte>(300);
        const auto inputs = standardInputs<float>();
        const auto outcome =
            interpreter->runQuad({inputs, inputs, inputs, inputs}, {false, false, true, false}, buffers);
        ran = ran && outcome.ok();
    }
    return ran && !module->entryPoints().empty();
}

TEST(BrokenModule, TheSampleItselfRuns) {
    EXPECT_TRUE(exercise(sampleModule()));
}

TEST(BrokenModule, TruncatedAtEveryWord) {
    const Words words = sampleModule();
    for (size_t size = 0; size < words.size(); ++size)
        EXPECT_FALSE(exercise(Words(words.begin(), words.begin() + static_cast<ptrdiff_t>(size)))) << size;
}

TEST(BrokenModule, BitFlips) {
    const Words words = sampleModule();
    std::mt19937 random(1);
    for (int round = 0; round < 6000; ++round) {
        Words broken = words;
        for (uint32_t flips = 1 + random() % 3; flips > 0; --flips)
            broken[random() % broken.size()] ^= 1u << (random() % 32);
        exercise(broken);
    }
}

TEST(BrokenModule, WordsReplaced) {
    const Words words = sampleModule();
    std::mt19937 random(2);
    for (int round = 0; round < 6000; ++round) {
        Words broken = words;
        for (uint32_t n = 1 + random() % 2; n > 0; --n) {
            // Another id or small number, most of the time: that gets through the parser.
            const uint32_t value = random() % 8 == 0 ? static_cast<uint32_t>(random()) : random() % words[3];
            broken[5 + random() % (broken.size() - 5)] = value;
        }
        exercise(broken);
    }
}

TEST(BrokenModule, InstructionsDroppedAndDoubled) {
    const Words words = sampleModule();
    std::vector<std::pair<size_t, size_t>> instructions;
    for (size_t at = 5; at < words.size(); at += words[at] >> 16) instructions.emplace_back(at, words[at] >> 16);
    for (const auto& [at, length] : instructions) {
        Words dropped = words, doubled = words;
        const auto begin = words.begin() + static_cast<ptrdiff_t>(at);
        dropped.erase(dropped.begin() + static_cast<ptrdiff_t>(at),
                      dropped.begin() + static_cast<ptrdiff_t>(at + length));
        doubled.insert(doubled.begin() + static_cast<ptrdiff_t>(at), begin, begin + static_cast<ptrdiff_t>(length));
        exercise(dropped);
        exercise(doubled);
    }
}

TEST(BrokenModule, HugeAndDeepTypes) {
    const auto program = [](const std::string& types, const std::string& type) {
        return assemble(
            "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint Fragment %main \"main\"\n"
            "OpExecutionMode %main OriginUpperLeft\n%void = OpTypeVoid\n%fn = OpTypeFunction %void\n"
            "%float = OpTypeFloat 32\n%uint = OpTypeInt 32 0\n%big = OpConstant %uint 4000000000\n" +
            types + "%ptr = OpTypePointer Function " + type +
            "\n%main = OpFunction %void None %fn\n%l = OpLabel\n"
            "%v = OpVariable %ptr Function\n%x = OpLoad " +
            type + " %v\nOpReturn\nOpFunctionEnd");
    };
    EXPECT_FALSE(
        exercise(program("%a = OpTypeArray %float %big\n%b = OpTypeArray %a %big\n%c = OpTypeArray %b %big\n", "%c")));
    // Every struct holds the one before twice: 2^60 floats.
    std::string doubling = "%s0 = OpTypeStruct %float\n";
    for (int k = 1; k <= 60; ++k) {
        const std::string before = "%s" + std::to_string(k - 1);
        doubling += "%s" + std::to_string(k) + " = OpTypeStruct " + before + " " + before + "\n";
    }
    EXPECT_FALSE(exercise(program(doubling, "%s60")));
    std::string deep = "%s0 = OpTypeStruct %float\n";
    for (int k = 1; k <= 5000; ++k)
        deep += "%s" + std::to_string(k) + " = OpTypeStruct %s" + std::to_string(k - 1) + "\n";
    EXPECT_FALSE(exercise(program(deep, "%s5000")));
}

}  // namespace
}  // namespace vernier::reference::test
