// Branches, loops, switches, calls, and the ways an invocation can end.
#include "tests/reference/reference_support.h"

namespace vernier::reference::test {
namespace {

std::array<int32_t, 4> run(std::string_view declarations, std::string_view body, int vulkanMinor = 1) {
    Resources<float> none;
    return intsAt(runFragment<float>(compileFragment(fragmentSource(declarations, body), vulkanMinor),
                                     standardInputs<float>(), none));
}
using Ints = std::array<int32_t, 4>;

TEST(ControlFlow, IfElse) {
    EXPECT_EQ(run("", "if (i.x > 5) { if (i.y > 0) ri.x = 1; else ri.x = 2; } else ri.x = 3; ri.yzw = ivec3(0);"),
              (Ints{2, 0, 0, 0}));
}

TEST(ControlFlow, Loops) {
    EXPECT_EQ(run("", R"(
        int sum = 0, odd = 0, nested = 0, k = 0;
        for (int n = 0; n < i.z; ++n) { if (n % 2 == 0) continue; if (n > 50) break; sum += n; }
        while (k < i.x) { k++; odd += k & 1; }
        do { for (int m = 0; m < 3; ++m) { if (m == k) break; nested += 10; } k -= 3; } while (k > 0);
        ri = ivec4(sum, odd, nested, k);)"),
              (Ints{625, 4, 30 + 30 + 10, -2}));
}

TEST(ControlFlow, SwitchWithFallThrough) {
    const char* declarations = R"(int f(int x) {
        int y = 0;
        switch (x) { case 1: y += 1; case -2: y += 10; break; case 3: return 77; default: y = -1; }
        return y; })";
    EXPECT_EQ(run(declarations, "ri = ivec4(f(i.x - 6), f(i.x - 9), f(i.x - 4), f(i.x));"), (Ints{11, 10, 77, -1}));
}

TEST(ControlFlow, EarlyReturnFromLoop) {
    EXPECT_EQ(run("int f(int limit) { for (int n = 0;; ++n) if (n * n > limit) return n; }",
                  "ri = ivec4(f(i.x), f(i.z), f(i.y), 0);"),
              (Ints{3, 11, 0, 0}));
}

TEST(ControlFlow, PointerArguments) {
    EXPECT_EQ(run(R"(struct S { int a; ivec2 b; };
        void f(inout int x, out int y, in int z) { x += z; y = x * 2; z = 0; }
        void g(inout S s) { s.a++; s.b.yx = s.b; }
        int total = 5;)",
                  R"(int x = i.x, y, z = 3; f(x, y, z); S s = S(1, ivec2(2, 3)); g(s); total += s.b.x;
        f(s.a, s.b.y, z); ri = ivec4(x, y + z, s.a * 100 + s.b.y, total);)"),
              (Ints{10, 23, 510, 8}));
}

TEST(ControlFlow, Phis) {
    // glslang makes phis only of && and ||; these swap two values, each the other's input.
    const Words words = assemble(R"(
        OpCapability Shader
        OpMemoryModel Logical GLSL450
        OpEntryPoint Fragment %main "main" %out
        OpExecutionMode %main OriginUpperLeft
        OpDecorate %out Location 1
        %void = OpTypeVoid
        %fn = OpTypeFunction %void
        %int = OpTypeInt 32 1
        %bool = OpTypeBool
        %ivec4 = OpTypeVector %int 4
        %ptr = OpTypePointer Output %ivec4
        %out = OpVariable %ptr Output
        %c0 = OpConstant %int 0
        %c1 = OpConstant %int 1
        %c2 = OpConstant %int 2
        %c5 = OpConstant %int 5
        %main = OpFunction %void None %fn
        %entry = OpLabel
        OpBranch %head
        %head = OpLabel
        %a = OpPhi %int %c1 %entry %b %next
        %b = OpPhi %int %c2 %entry %a %next
        %n = OpPhi %int %c0 %entry %n1 %next
        OpLoopMerge %done %next None
        OpBranch %test
        %test = OpLabel
        %more = OpSLessThan %bool %n %c5
        OpBranchConditional %more %next %done
        %next = OpLabel
        %n1 = OpIAdd %int %n %c1
        OpBranch %head
        %done = OpLabel
        %v = OpCompositeConstruct %ivec4 %a %b %n %c0
        OpStore %out %v
        OpReturn
        OpFunctionEnd)");
    Resources<float> none;
    EXPECT_EQ(intsAt(runFragment<float>(words, {}, none)), (Ints{2, 1, 5, 0}));
}

TEST(ControlFlow, ShortCircuit) {
    EXPECT_EQ(run("int calls = 0; bool f(bool x) { calls++; return x; }",
                  "bool a = f(i.x > 0) || f(true); bool b = f(i.x < 0) && f(true); ri = ivec4(calls, a, b, 0);"),
              (Ints{2, 1, 0, 0}));
}

TEST(ControlFlow, DiscardEndsTheInvocation) {
    // 1.1 emits OpKill, 1.3 OpTerminateInvocation.
    for (const int vulkanMinor : {0, 1, 2, 3}) {
        Resources<float> none;
        const Words words = compileFragment(fragmentSource("", "r = v; if (i.x == 7) discard; ri = i;"), vulkanMinor);
        const auto outcome = runFragment<float>(words, standardInputs<float>(), none);
        EXPECT_TRUE(outcome.discarded);
        EXPECT_FALSE(outcome.outputs.locations.contains(Location(1)));
    }
}

TEST(ControlFlow, DemoteGoesOn) {
    Resources<float> none;
    const Words words = compileFragment(
        fragmentSource("#extension GL_EXT_demote_to_helper_invocation : require\n",
                       "ri.x = int(helperInvocationEXT()); demote; ri.yzw = ivec3(helperInvocationEXT());"),
        2);
    const auto outcome = runFragment<float>(words, standardInputs<float>(), none);
    EXPECT_TRUE(outcome.discarded);
    EXPECT_EQ(intsAt(outcome), (Ints{0, 1, 1, 1}));
}

TEST(ControlFlow, InfiniteLoopIsAnError) {
    const auto module = Module::parse(compileFragment(fragmentSource("", "r = v; while (i.x == 7) r += v; ri = i;")));
    ASSERT_TRUE(module.ok());
    Resources<float> none;
    const auto outcome = interpreterOf<float>(*module, spv::ExecutionModelFragment, {.stepBudget = 10000})
                             .run(standardInputs<float>(), none);
    ASSERT_FALSE(outcome.ok());
    EXPECT_NE(outcome.error().message.find("10000"), std::string::npos);
}

TEST(ControlFlow, RecursionAndUnreachableAreErrors) {
    const auto program = [](const char* body) {
        return assemble(std::string(R"(
            OpCapability Shader
            OpMemoryModel Logical GLSL450
            OpEntryPoint Fragment %main "main"
            OpExecutionMode %main OriginUpperLeft
            %void = OpTypeVoid
            %fn = OpTypeFunction %void
            %main = OpFunction %void None %fn
            %entry = OpLabel
            )") + body + "\nOpFunctionEnd");
    };
    for (const auto& [body, text] :
         {std::pair{"%x = OpFunctionCall %void %main\nOpReturn", "deep"}, std::pair{"OpUnreachable", "OpUnreachable"},
          std::pair{"OpEmitVertex\nOpReturn", "OpEmitVertex"}}) {
        const auto module = Module::parse(program(body));
        ASSERT_TRUE(module.ok()) << module.error().message;
        Resources<float> none;
        const auto outcome = interpreterOf<float>(*module, spv::ExecutionModelFragment).run({}, none);
        ASSERT_FALSE(outcome.ok());
        EXPECT_NE(outcome.error().message.find(text), std::string::npos) << outcome.error().message;
    }
}

}  // namespace
}  // namespace vernier::reference::test
