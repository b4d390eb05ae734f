// Structured control flow of every shape: the same text as GLSL and as C++, and the shapes that compilers do not write,
// in assembly.
#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/shader_run.h"

namespace vernier::test {
namespace {

#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#define VERNIER_BOTH(name, ...) \
    int name(int lane) {        \
        __VA_ARGS__             \
    }                           \
    constexpr const char* name##Text = #__VA_ARGS__;

VERNIER_BOTH(
    switchInLoop, int s = lane; for (int i = 0; i < 12; ++i) {
        switch ((lane + i) % 7) {
            case 0:
                continue;
            case 1:
                s += 1;
            default:
                s += 10;
            case 3:
                s *= 3;
                break;
            case 4:
                if (s > 100000) return s;
                s -= 7;
            case 5:
                if (i > 9) break;
                s ^= 85;
                continue;
        }
        s += i;
    } return s;)

VERNIER_BOTH(
    nestedLoops, int s = 0; for (int i = 0; i < lane % 9; ++i) {
        int j = 0;
        while (true) {
            if (j > i + 3) break;
            ++j;
            if ((i + j) % 3 == 0) continue;
            int k = 0;
            do {
                if (k == 4) return s + 1000;
                if ((s + k) % 11 == 10) break;
                s += k * j;
                ++k;
            } while (k < (lane & 7));
            if (s > 500) break;
        }
        if (s > 800) return s - i;
    } return s;)

VERNIER_BOTH(
    earlyReturns,
    if (lane < 5) {
        if (lane == 2) return 22;
        for (int i = 0; i < 10; ++i) {
            if (i == lane * 2) return i * 100;
        }
    } else if (lane < 20) {
        switch (lane) {
            case 7:
                return 7;
            case 8:
                for (int i = 0;; ++i) {
                    if (i * i > 50) return i;
                }
            default:
                break;
        }
        return lane * 3;
    } int x = 0;
    for (int i = 0; i < lane; ++i) {
        if ((i & 3) == 3) continue;
        x += i;
        if (x > 200) break;
    } return x;)

VERNIER_BOTH(
    switchInSwitch, int s = 5; for (int i = 0; i < 6; ++i) {
        switch (i + lane % 3) {
            case 0:
            case 2:
                switch (lane % 4) {
                    case 0:
                        s += 2;
                        break;
                    case 1:
                        s += 3;
                    case 2:
                        s += 4;
                        if (lane > 40) break;
                        s *= 2;
                    default:
                        for (int k = 0; k < 3; ++k) {
                            if (k == lane % 3) break;
                            s += k + 1;
                        }
                }
                s -= 1;
                break;
            case 1:
                s += 100;
            case 4:
                break;
            default:
                s = -s;
        }
        if (s < -5000) break;
    } return s;)

struct Both {
    const char* name;
    int (*run)(int);
    const char* text;
};

TEST(ControlFlow, TheSameAsInCpp) {
    const Both all[] = {{"switchInLoop", switchInLoop, switchInLoopText},
                        {"nestedLoops", nestedLoops, nestedLoopsText},
                        {"earlyReturns", earlyReturns, earlyReturnsText},
                        {"switchInSwitch", switchInSwitch, switchInSwitchText}};
    for (const Both& both : all) {
        ShaderRun shader;
        const Words plain =
            laneShader("", std::string("layout(location = 0) out int o; int f(int lane) {") + both.text + "}",
                       "o = f(lane) + f(lane + 1);");
        for (const Words& words : {plain, optimised(plain)}) {
            shader.words = words;
            for (const Isa isa : isas()) {
                ASSERT_TRUE(shader.run(isa)) << both.name;
                for (int lane = 0; lane < 64; ++lane) {
                    EXPECT_EQ(static_cast<int>(shader.output(0, static_cast<uint32_t>(lane))),
                              both.run(lane) + both.run(lane + 1))
                        << both.name << " lane " << lane;
                }
            }
        }
    }
}

constexpr const char* kHead = R"(
OpCapability Shader
OpExtension "SPV_KHR_terminate_invocation"
OpMemoryModel Logical GLSL450
OpEntryPoint Fragment %main "main" %lane %o
OpExecutionMode %main OriginUpperLeft
OpDecorate %lane Location 0
OpDecorate %lane Flat
OpDecorate %o Location 0
%void = OpTypeVoid
%fn = OpTypeFunction %void
%bool = OpTypeBool
%int = OpTypeInt 32 1
%ifn = OpTypeFunction %int %int
%pin = OpTypePointer Input %int
%pout = OpTypePointer Output %int
%lane = OpVariable %pin Input
%o = OpVariable %pout Output
%true = OpConstantTrue %bool
%false = OpConstantFalse %bool
%u = OpUndef %int
%c0 = OpConstant %int 0
%c1 = OpConstant %int 1
%c2 = OpConstant %int 2
%c3 = OpConstant %int 3
%c4 = OpConstant %int 4
%c7 = OpConstant %int 7
%c9 = OpConstant %int 9
%c40 = OpConstant %int 40
%main = OpFunction %void None %fn
%entry = OpLabel
OpNop
%n = OpLoad %int %lane
%result = OpFunctionCall %int %f %n
OpStore %o %result
OpReturn
OpFunctionEnd
%f = OpFunction %int None %ifn
%x = OpFunctionParameter %int
%start = OpLabel
)";

void expectEach(const char* body, int (*expected)(int), bool terminates = false) {
    ShaderRun shader;
    shader.words = assemble(std::string(kHead) + body + "\nOpFunctionEnd\n", 5);
    for (const Isa isa : isas()) {
        ASSERT_TRUE(shader.run(isa));
        for (int lane = 0; lane < 64; ++lane) {
            const auto at = static_cast<uint32_t>(lane);
            const int want = expected(lane);
            if (terminates) {
                EXPECT_EQ(shader.live[at] != 0, want >= 0) << lane;
            }
            if (want >= 0) {
                EXPECT_EQ(static_cast<int>(shader.output(0, at)), want) << lane;
            }
        }
    }
}

TEST(ControlFlow, LoopOfOneBlock) {
    expectEach(R"(
OpBranch %loop
%loop = OpLabel
%i = OpPhi %int %c0 %start %i1 %loop
%s = OpPhi %int %c0 %start %s1 %loop
%s1 = OpIAdd %int %s %i
%i1 = OpIAdd %int %i %c1
%go = OpSLessThan %bool %i1 %x
OpLoopMerge %done %loop None
OpBranchConditional %go %loop %done
%done = OpLabel
OpReturnValue %s1
)",
               [](int n) { return n < 2 ? 0 : n * (n - 1) / 2; });
}

// The continue target is never reached: every way through the body leaves.
TEST(ControlFlow, UnreachableContinueAndMerge) {
    expectEach(R"(
OpBranch %loop
%loop = OpLabel
OpLoopMerge %done %again None
OpBranch %body
%body = OpLabel
%low = OpSLessThan %bool %x %c9
OpSelectionMerge %never None
OpBranchConditional %low %yes %no
%yes = OpLabel
OpReturnValue %c7
%no = OpLabel
OpBranch %done
%never = OpLabel
OpUnreachable
%again = OpLabel
OpBranch %loop
%done = OpLabel
%small = OpSLessThan %bool %x %c40
OpSelectionMerge %end None
OpBranchConditional %small %a %b
%a = OpLabel
OpReturnValue %x
%b = OpLabel
%twice = OpIMul %int %x %c2
OpReturnValue %twice
%end = OpLabel
OpUnreachable
)",
               [](int n) { return n < 9    ? 7
                                  : n < 40 ? n
                                           : 2 * n; });
}

// A merge block nothing goes to that leads on, a phi of an undefined value, a loop whose condition is in the continue
// block.
TEST(ControlFlow, ConditionInTheContinueBlock) {
    expectEach(R"(
OpBranch %loop
%loop = OpLabel
%i = OpPhi %int %c0 %start %i1 %again
%s = OpPhi %int %u %start %t %again
OpLoopMerge %done %again None
OpBranch %body
%body = OpLabel
%first = OpIEqual %bool %i %c0
%base = OpSelect %int %first %c3 %s
%odd = OpBitwiseAnd %int %i %c1
%isOdd = OpINotEqual %bool %odd %c0
OpSelectionMerge %joined None
OpBranchConditional %isOdd %skip %joined
%skip = OpLabel
%less = OpISub %int %base %c1
OpBranch %again
%joined = OpLabel
%more = OpIAdd %int %base %i
%large = OpSGreaterThan %bool %more %c40
OpBranchConditional %large %done %again
%again = OpLabel
%t = OpPhi %int %less %skip %more %joined
%i1 = OpIAdd %int %i %c1
%go = OpSLessThan %bool %i1 %x
OpBranchConditional %go %loop %done
%done = OpLabel
%r = OpPhi %int %more %joined %t %again
OpReturnValue %r
)",
               [](int n) {
                   int s = 3;
                   for (int i = 0;; ++i) {
                       if (i % 2 != 0) {
                           --s;
                       } else {
                           s += i;
                           if (s > 40) return s;
                       }
                       if (i + 1 >= n) return s;
                   }
               });
}

TEST(ControlFlow, ConstantConditionsAndTermination) {
    expectEach(R"(
OpSelectionMerge %m None
OpBranchConditional %false %dead %m
%dead = OpLabel
OpTerminateInvocation
%m = OpLabel
OpSelectionMerge %m2 None
OpBranchConditional %true %alive %dead2
%alive = OpLabel
%bit = OpBitwiseAnd %int %x %c7
%eq = OpIEqual %bool %bit %c3
OpSelectionMerge %m3 None
OpBranchConditional %eq %stop %m3
%stop = OpLabel
OpTerminateInvocation
%m3 = OpLabel
OpBranch %m2
%dead2 = OpLabel
OpBranch %m2
%m2 = OpLabel
%r = OpPhi %int %bit %m3 %c9 %dead2
OpSelectionMerge %m4 None
OpSwitch %c4 %m4 4 %four 5 %five
%four = OpLabel
%r4 = OpIAdd %int %r %c40
OpBranch %five
%five = OpLabel
%r5 = OpPhi %int %r4 %four %c1 %m2
OpBranch %m4
%m4 = OpLabel
%end = OpPhi %int %r5 %five %c2 %m2
OpReturnValue %end
)",
               [](int n) { return (n & 7) == 3 ? -1 : (n & 7) + 40; }, true);
}

}  // namespace
}  // namespace vernier::test
