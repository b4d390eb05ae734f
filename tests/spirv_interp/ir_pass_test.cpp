// The passes, each on a small program, with the text that must come out.
#include <gtest/gtest.h>

#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/cfg.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/passes.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/rates.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {
namespace {

constexpr const char* kHead = R"(program fragment "t"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
resource 0 storageBuffer 0.0 x1
resource 1 uniformBuffer 0.1 x1 read
)";

Program program(const std::string& body) {
    Result<Program> parsed = parse(kHead + body);
    EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message);
    const Status status = verify(*parsed);
    EXPECT_TRUE(status.ok()) << status.error().message;
    return *parsed;
}

/// The blocks of a program after a pass, values renumbered.
std::string blocksOf(Program& p) {
    compact(p);
    const std::string text = print(p);
    return text.substr(text.find("\nb0:") + 1);
}

/// Two passes in one, both run.
auto both(bool (*first)(Program&), bool (*second)(Program&)) {
    return [=](Program& p) {
        const bool changed = first(p);
        return second(p) || changed;
    };
}

template <class Pass>
std::string after(const Pass& pass, const std::string& body) {
    Program p = program(body);
    EXPECT_TRUE(pass(p));
    const std::string text = blocksOf(p);
    EXPECT_FALSE(pass(p)) << "a second run changes something again";
    return text;
}

TEST(Pass, RemoveDead) {
    EXPECT_EQ(after(removeDead, R"(b0:
  %0 f32 = input #0
  %1 f32 = fadd %0 %0
  %2 f32 = undef
  %3 i32 = constant 0x0
  %4 f32 = loadBuffer #1 %3 %3
  storeBuffer #0 %3 %3 %0
  storeOutput #0 %2
  storeOutput #1 %0
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 i32 = constant 0x0
  storeBuffer #0 %1 %1 %0
  storeOutput #1 %0
  ret
)");
}

TEST(Pass, RemoveDeadLoopPhis) {
    // A counter that only feeds itself.
    EXPECT_EQ(after(removeDead, R"(b0:
  %0 i32 = constant 0x0
  %1 b1 = constant 0x0
  jump b1
b1 loop b2 <- b0 b1:
  %2 i32 = phi %0 %3
  %3 i32 = iadd %2 %2
  branch %1 b1 b2
b2 <- b1:
  ret
)"),
              R"(b0:
  %0 b1 = constant 0x0
  jump b1
b1 loop b2 <- b0 b1:
  branch %0 b1 b2
b2 <- b1:
  ret
)");
}

TEST(Pass, UnrollLoops) {
    // Two phis that change places, a branch in the body, a value of the header used behind the loop.
    EXPECT_EQ(after(unrollLoops, R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x2
  %3 f32 = input #0
  %4 f32 = input #1
  %5 b1 = folt.f32 %3 %4
  jump b1
b1 loop b5 <- b0 b4:
  %6 i32 = phi %0 %14
  %7 f32 = phi %3 %8
  %8 f32 = phi %4 %7
  %9 f32 = fadd %7 %8
  %10 b1 = slt.i32 %6 %2
  branch %10 b2 b5
b2 <- b1:
  branch %5 b3 b4
b3 <- b2:
  storeBuffer #0 %0 %6 %7
  jump b4
b4 <- b2 b3:
  %14 i32 = iadd %6 %1
  jump b1
b5 <- b1:
  %15 f32 = phi %9
  %16 f32 = phi %8
  storeOutput #0 %15
  storeOutput #1 %16
  ret
)"),
              R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x2
  %3 f32 = input #0
  %4 f32 = input #1
  %5 b1 = folt.f32 %3 %4
  jump b1
b1 <- b0:
  %6 f32 = fadd %3 %4
  %7 b1 = slt.i32 %0 %2
  jump b2
b2 <- b1:
  branch %5 b3 b4
b3 <- b2:
  storeBuffer #0 %0 %0 %3
  jump b4
b4 <- b2 b3:
  %8 i32 = iadd %0 %1
  jump b5
b5 <- b4:
  %9 f32 = fadd %4 %3
  %10 b1 = slt.i32 %8 %2
  jump b6
b6 <- b5:
  branch %5 b7 b8
b7 <- b6:
  storeBuffer #0 %0 %8 %4
  jump b8
b8 <- b6 b7:
  %11 i32 = iadd %8 %1
  jump b9
b9 <- b8:
  %12 f32 = fadd %3 %4
  %13 b1 = slt.i32 %11 %2
  jump b10
b10 <- b9:
  %14 f32 = phi %12
  %15 f32 = phi %4
  storeOutput #0 %14
  storeOutput #1 %15
  ret
)");
}

TEST(Pass, UnrollFourRoundsOfALongLoop) {
    // 252 rounds become 63 of four; the values behind the loop are still the header's.
    EXPECT_EQ(after(unrollLoops, R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0xfc
  %3 f32 = input #0
  jump b1
b1 loop b3 <- b0 b2:
  %4 i32 = phi %0 %8
  %5 f32 = phi %3 %7
  %6 b1 = slt.i32 %4 %2
  branch %6 b2 b3
b2 <- b1:
  %7 f32 = fmul %5 %3
  %8 i32 = iadd %4 %1
  jump b1
b3 <- b1:
  %9 f32 = phi %5
  storeOutput #0 %9
  ret
)"),
              R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0xfc
  %3 f32 = input #0
  jump b1
b1 loop b9 <- b0 b8:
  %4 i32 = phi %0 %17
  %5 f32 = phi %3 %16
  %6 b1 = slt.i32 %4 %2
  branch %6 b2 b9
b2 <- b1:
  %7 f32 = fmul %5 %3
  %8 i32 = iadd %4 %1
  jump b3
b3 <- b2:
  %9 b1 = slt.i32 %8 %2
  jump b4
b4 <- b3:
  %10 f32 = fmul %7 %3
  %11 i32 = iadd %8 %1
  jump b5
b5 <- b4:
  %12 b1 = slt.i32 %11 %2
  jump b6
b6 <- b5:
  %13 f32 = fmul %10 %3
  %14 i32 = iadd %11 %1
  jump b7
b7 <- b6:
  %15 b1 = slt.i32 %14 %2
  jump b8
b8 <- b7:
  %16 f32 = fmul %13 %3
  %17 i32 = iadd %14 %1
  jump b1
b9 <- b1:
  %18 f32 = phi %5
  storeOutput #0 %18
  ret
)");
}

TEST(Pass, UnrollNestedLoopsAndLoopsThatNeverRun) {
    // The inner loop goes round once, its counter doubling; the outer one, which has the inner one's copies then,
    // twice.
    Program p = program(R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x2
  %3 i32 = constant 0x4
  jump b1
b1 loop b5 <- b0 b4:
  %4 i32 = phi %0 %9
  %5 b1 = slt.i32 %4 %2
  branch %5 b2 b5
b2 <- b1:
  jump b3
b3 loop b4 <- b2 b3:
  %6 i32 = phi %2 %7
  storeBuffer #0 %0 %6 %4
  %7 i32 = imul %6 %2
  %8 b1 = slt.i32 %7 %3
  branch %8 b3 b4
b4 <- b3:
  %9 i32 = iadd %4 %1
  jump b1
b5 <- b1:
  jump b6
b6 loop b8 <- b5 b7:
  %10 i32 = phi %1 %10
  %11 b1 = slt.i32 %3 %10
  branch %11 b7 b8
b7 <- b6:
  storeBuffer #0 %0 %0 %10
  jump b6
b8 <- b6:
  ret
)");
    EXPECT_TRUE(unrollLoops(p));
    optimise(p);
    const Status status = verify(p);
    ASSERT_TRUE(status.ok()) << status.error().message;
    EXPECT_EQ(blocksOf(p), R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x2
  storeBuffer #0 %0 %2 %0
  storeBuffer #0 %0 %2 %1
  ret
)");
}

TEST(Pass, LoopsThatAreNotUnrolled) {
    const auto stays = [](const std::string& body) {
        Program p = program(body);
        EXPECT_FALSE(unrollLoops(p)) << body;
    };
    const auto counted = [](const std::string& limit, const std::string& inLatch) {
        return R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = )" + limit +
               R"(
  jump b1
b1 loop b3 <- b0 b2:
  %3 i32 = phi %0 %5
  %4 b1 = slt.i32 %3 %2
  branch %4 b2 b3
b2 <- b1:
  storeBuffer #0 %0 %0 %3
  %5 i32 = iadd %3 %1
)" + inLatch + R"(b3 <- b1:
  ret
)";
    };
    stays(counted("constant 0x21", "  jump b1\n"));        // too often
    stays(counted("loadBuffer #1 %0 %0", "  jump b1\n"));  // nobody knows how often
    stays(R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x4
  %3 f32 = input #0
  %4 b1 = folt.f32 %3 %3
  jump b1
b1 loop b4 <- b0 b3:
  %5 i32 = phi %0 %7
  %6 b1 = slt.i32 %5 %2
  branch %6 b2 b4
b2 <- b1:
  branch %4 b4 b3
b3 <- b2:
  %7 i32 = iadd %5 %1
  jump b1
b4 <- b1 b2:
  ret
)");
}

TEST(Pass, SimplifyPhis) {
    // %5 stands for %3 where it is undefined, then %3 is %0 all round the loop, then %6 is %0; %7 may not become %9,
    // which does not exist on the way past b2.
    EXPECT_EQ(after(simplifyPhis, R"(b0:
  %0 f32 = input #0
  %1 b1 = folt.f32 %0 %0
  %2 f32 = undef
  jump b1
b1 loop b4 <- b0 b3:
  %3 f32 = phi %0 %5
  %4 f32 = phi %2 %4
  branch %1 b2 b3
b2 <- b1:
  %9 f32 = fadd %3 %3
  jump b3
b3 <- b1 b2:
  %5 f32 = phi %3 %2
  %6 f32 = phi %3 %0
  %7 f32 = phi %2 %9
  branch %1 b1 b4
b4 <- b3:
  %8 f32 = phi %6
  %10 f32 = phi %7
  storeOutput #0 %8
  storeOutput #1 %10
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 b1 = folt.f32 %0 %0
  %2 f32 = undef
  jump b1
b1 loop b4 <- b0 b3:
  branch %1 b2 b3
b2 <- b1:
  %3 f32 = fadd %0 %0
  jump b3
b3 <- b1 b2:
  %4 f32 = phi %2 %3
  branch %1 b1 b4
b4 <- b3:
  storeOutput #0 %0
  storeOutput #1 %4
  ret
)");
}

/// The value stored to output 0 by a program that computes it from inputs %0, %1 (f32), after folding.
std::string folded(const std::string& code) {
    Program p = program("b0:\n  %0 f32 = input #0\n  %1 f32 = input #1\n" + code + "  ret\n");
    while (foldConstants(p)) {
    }
    removeDead(p);
    EXPECT_TRUE(verify(p).ok()) << verify(p).error().message;
    const std::string text = blocksOf(p);
    return text.substr(4, text.size() - 4 - 6);
}

TEST(Pass, FoldIdentities) {
    const std::string x = "  %0 f32 = input #0\n  storeOutput #0 %0\n";
    const auto constant = [](const char* bits) { return "  %2 f32 = constant " + std::string(bits) + "\n"; };
    EXPECT_EQ(folded(constant("0x3f800000") + "  %3 f32 = fmul %0 %2\n  storeOutput #0 %3\n"), x);
    EXPECT_EQ(folded(constant("0x3f800000") + "  %3 f32 = fdiv %0 %2\n  storeOutput #0 %3\n"), x);
    EXPECT_EQ(folded(constant("0x0") + "  %3 f32 = fsub %0 %2\n  storeOutput #0 %3\n"), x);
    EXPECT_EQ(folded(constant("0x80000000") + "  %3 f32 = fadd %2 %0\n  storeOutput #0 %3\n"), x);
    EXPECT_EQ(folded("  %2 f32 = fneg %0\n  %3 f32 = fneg %2\n  storeOutput #0 %3\n"), x);
    EXPECT_EQ(folded("  %2 f32 = copy %0\n  %3 f32 = copy %2\n  storeOutput #0 %3\n"), x);
    // x + 0 is not x for x = -0, x * 0 is not 0 for NaN, x - x not for infinity.
    for (const char* op : {"fadd %0 %2", "fmul %0 %2", "fsub %0 %0"}) {
        const std::string kept = folded(constant("0x0") + "  %3 f32 = " + op + "\n  storeOutput #0 %3\n");
        EXPECT_NE(kept.find(std::string(op).substr(0, 4)), std::string::npos) << kept;
    }
    EXPECT_EQ(folded("  %2 f32 = fneg %1\n  %3 f32 = fadd %0 %2\n  storeOutput #0 %3\n"),
              "  %0 f32 = input #0\n  %1 f32 = input #1\n  %2 f32 = fsub %0 %1\n  storeOutput #0 %2\n");
    // 8 has an exact reciprocal, 3 has not; neither has 2^-127 as a normal number.
    EXPECT_EQ(folded(constant("0x41000000") + "  %3 f32 = fdiv %0 %2\n  storeOutput #0 %3\n"),
              "  %0 f32 = constant 0x3e000000\n  %1 f32 = input #0\n  %2 f32 = fmul %1 %0\n  storeOutput #0 %2\n");
    for (const char* bits : {"0x40400000", "0x400000", "0x7f000000", "0x0"}) {
        const std::string kept = folded(constant(bits) + "  %3 f32 = fdiv %0 %2\n  storeOutput #0 %3\n");
        EXPECT_NE(kept.find("fdiv"), std::string::npos) << bits;
    }
}

TEST(Pass, FoldConstants) {
    const auto f32 = [](const char* expression) {
        return folded(
            "  %2 f32 = constant 0x40400000\n  %3 f32 = constant 0xc0000000\n  %4 i32 = constant 0xfffffff9\n"
            "  %5 i32 = constant 0x2\n" +
            std::string(expression) + "  storeOutput #0 %9\n");
    };
    EXPECT_EQ(f32("  %9 f32 = fdiv %2 %3\n"), "  %0 f32 = constant 0xbfc00000\n  storeOutput #0 %0\n");
    EXPECT_EQ(f32("  %8 i32 = sdiv %4 %5\n  %9 f32 = stof.i32 %8\n"),
              "  %0 f32 = constant 0xc0400000\n  storeOutput #0 %0\n");
    EXPECT_EQ(f32("  %8 i32 = smod %4 %5\n  %9 f32 = utof.i32 %8\n"),
              "  %0 f32 = constant 0x3f800000\n  storeOutput #0 %0\n");
    EXPECT_EQ(f32("  %8 b1 = folt.f32 %3 %2\n  %9 f32 = select %8 %0 %2\n"),
              "  %0 f32 = input #0\n  storeOutput #0 %0\n");
    // The square root of -2 is a NaN, whose bits are the processor's: left alone. So is what depends on the accuracy
    // tier.
    EXPECT_NE(f32("  %9 f32 = fsqrt %3\n").find("fsqrt"), std::string::npos);
    EXPECT_NE(f32("  %9 f32 = fsin %2\n").find("fsin"), std::string::npos);
}

TEST(Pass, FoldIntegersAndBooleans) {
    const auto run = [](const std::string& code) {
        return folded("  %2 i32 = ftos.f32 %0\n  %3 i32 = constant 0x8\n  %4 i32 = constant 0x5\n" + code +
                      "  %19 f32 = stof.i32 %18\n  storeOutput #0 %19\n");
    };
    EXPECT_NE(run("  %18 i32 = imul %2 %3\n").find("shl"), std::string::npos);
    EXPECT_NE(run("  %18 i32 = udiv %2 %3\n").find("lshr"), std::string::npos);
    EXPECT_NE(run("  %18 i32 = umod %2 %3\n").find("iand"), std::string::npos);
    EXPECT_NE(run("  %17 i32 = iadd %2 %3\n  %18 i32 = iadd %17 %4\n").find("constant 0xd\n"), std::string::npos);
    EXPECT_EQ(run("  %17 i32 = ixor %2 %2\n  %18 i32 = ior %17 %4\n"),
              "  %0 f32 = constant 0x40a00000\n  storeOutput #0 %0\n");
    const auto choose = [](const std::string& code) {
        return folded("  %2 b1 = folt.f32 %0 %1\n" + code + "  %9 f32 = select %8 %0 %1\n  storeOutput #0 %9\n");
    };
    EXPECT_NE(choose("  %8 b1 = bnot %2\n").find("fule.f32 %1 %0"), std::string::npos);
    EXPECT_NE(choose("  %3 b1 = constant 0xffffffff\n  %8 b1 = band %2 %3\n")
                  .find("%2 b1 = folt.f32 %0 %1\n  %3 f32 = select"),
              std::string::npos);
    EXPECT_EQ(choose("  %3 b1 = constant 0xffffffff\n  %8 b1 = bor %2 %3\n"),
              "  %0 f32 = input #0\n  storeOutput #0 %0\n");
}

TEST(Pass, EliminateCommon) {
    EXPECT_EQ(after(both(eliminateCommon, removeDead), R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 i32 = constant 0x0
  %3 f32 = fadd %0 %1
  %4 f32 = loadBuffer #1 %2 %2
  %5 f32 = loadBuffer #0 %2 %2
  %6 b1 = folt.f32 %0 %1
  branch %6 b1 b2
b1 <- b0:
  %7 f32 = fadd %1 %0
  %8 f32 = fmul %0 %1
  %9 f32 = loadBuffer #1 %2 %2
  %10 f32 = loadBuffer #0 %2 %2
  storeBuffer #0 %2 %2 %7
  storeBuffer #0 %2 %2 %8
  storeBuffer #0 %2 %2 %9
  storeBuffer #0 %2 %2 %10
  jump b2
b2 <- b0 b1:
  %11 f32 = fmul %0 %1
  %12 f32 = fsub %1 %0
  storeOutput #0 %11
  storeOutput #1 %12
  storeBuffer #0 %2 %2 %3
  storeBuffer #0 %2 %2 %4
  storeBuffer #0 %2 %2 %5
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 i32 = constant 0x0
  %3 f32 = fadd %0 %1
  %4 f32 = loadBuffer #1 %2 %2
  %5 f32 = loadBuffer #0 %2 %2
  %6 b1 = folt.f32 %0 %1
  branch %6 b1 b2
b1 <- b0:
  %7 f32 = fmul %0 %1
  %8 f32 = loadBuffer #0 %2 %2
  storeBuffer #0 %2 %2 %3
  storeBuffer #0 %2 %2 %7
  storeBuffer #0 %2 %2 %4
  storeBuffer #0 %2 %2 %8
  jump b2
b2 <- b0 b1:
  %9 f32 = fmul %0 %1
  %10 f32 = fsub %1 %0
  storeOutput #0 %9
  storeOutput #1 %10
  storeBuffer #0 %2 %2 %3
  storeBuffer #0 %2 %2 %4
  storeBuffer #0 %2 %2 %5
  ret
)");
}

TEST(Pass, FoldBranches) {
    EXPECT_EQ(after(foldBranches, R"(b0:
  %0 f32 = input #0
  %1 b1 = constant 0x0
  %2 b1 = folt.f32 %0 %0
  %3 b1 = bnot %2
  branch %1 b1 b2
b1 <- b0:
  jump b6
b2 <- b0:
  branch %3 b3 b4
b3 <- b2:
  jump b5
b4 <- b2:
  %4 f32 = fneg %0
  jump b5
b5 <- b3 b4:
  %5 f32 = phi %0 %4
  jump b6
b6 <- b1 b5:
  %6 f32 = phi %0 %5
  storeOutput #0 %6
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 b1 = constant 0x0
  %2 b1 = folt.f32 %0 %0
  %3 b1 = bnot %2
  branch %2 b1 b2
b1 <- b0:
  %4 f32 = fneg %0
  jump b2
b2 <- b1 b0:
  %5 f32 = phi %4 %0
  storeOutput #0 %5
  ret
)");
}

TEST(Pass, FoldBranchesTakesConstantCases) {
    EXPECT_EQ(after(foldBranches, R"(b0:
  %0 i32 = constant 0xffffffff
  switchOn %0 b3 [4: b1] [-1: b2]
b1 <- b0:
  jump b4
b2 <- b0:
  kill
b3 <- b0:
  jump b4
b4 <- b1 b3:
  ret
)"),
              "b0:\n  %0 i32 = constant 0xffffffff\n  kill\n");
}

TEST(Pass, FoldBranchesUnmakesLoops) {
    EXPECT_EQ(after(foldBranches, R"(b0:
  %0 b1 = constant 0x0
  jump b1
b1 loop b2 <- b0 b1:
  branch %0 b1 b2
b2 <- b1:
  ret
)"),
              "b0:\n  %0 b1 = constant 0x0\n  ret\n");
}

TEST(Pass, ConvertIfs) {
    // A diamond with a phi; the second if has a side effect and stays; the third is too dear.
    EXPECT_EQ(after(both(convertIfs, foldBranches), R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 b1 = folt.f32 %0 %1
  %3 i32 = constant 0x0
  branch %2 b1 b2
b1 <- b0:
  %4 f32 = fadd %0 %1
  jump b3
b2 <- b0:
  %5 f32 = fmul %0 %1
  jump b3
b3 <- b1 b2:
  %6 f32 = phi %4 %5
  branch %2 b4 b5
b4 <- b3:
  storeBuffer #0 %3 %3 %6
  jump b5
b5 <- b3 b4:
  branch %2 b6 b7
b6 <- b5:
  %7 f32 = fsin %6
  %8 f32 = fadd %7 %6
  jump b7
b7 <- b5 b6:
  %9 f32 = phi %6 %8
  storeOutput #0 %9
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 b1 = folt.f32 %0 %1
  %3 i32 = constant 0x0
  %4 f32 = fadd %0 %1
  %5 f32 = fmul %0 %1
  %6 f32 = select %2 %4 %5
  branch %2 b1 b2
b1 <- b0:
  storeBuffer #0 %3 %3 %6
  jump b2
b2 <- b0 b1:
  branch %2 b3 b4
b3 <- b2:
  %7 f32 = fsin %6
  %8 f32 = fadd %7 %6
  jump b4
b4 <- b2 b3:
  %9 f32 = phi %6 %8
  storeOutput #0 %9
  ret
)");
}

TEST(Pass, ConvertIfsLeavesUniformBranches) {
    Program p = program(R"(b0:
  %0 f32 = input #0
  %1 i32 = constant 0x0
  %2 f32 = loadBuffer #1 %1 %1
  %3 b1 = folt.f32 %2 %2
  branch %3 b1 b2
b1 <- b0:
  %4 f32 = fadd %0 %0
  %5 f32 = fmul %4 %4
  jump b2
b2 <- b0 b1:
  %6 f32 = phi %0 %5
  storeOutput #0 %6
  ret
)");
    EXPECT_FALSE(convertIfs(p));
}

TEST(Pass, Contract) {
    EXPECT_EQ(after(both(contract, removeDead), R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fmul %0 %1
  %3 f32 = fadd %2 %0
  %4 f32 = fmul %1 %1 !noContraction
  %5 f32 = fadd %4 %0
  %6 f32 = fmul %0 %0
  %7 f32 = fadd %6 %5
  %8 f32 = fadd %6 %3
  storeOutput #0 %7
  storeOutput #1 %8
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = ffma %0 %1 %0
  %3 f32 = fmul %1 %1 !noContraction
  %4 f32 = fadd %3 %0
  %5 f32 = fmul %0 %0
  %6 f32 = fadd %5 %4
  %7 f32 = fadd %5 %2
  storeOutput #0 %6
  storeOutput #1 %7
  ret
)");
}

TEST(Pass, CloseLoops) {
    // Out of two loops at once, and along two ways that meet.
    Result<Program> p = parse(std::string(kHead) + R"(b0:
  %0 f32 = input #0
  %1 b1 = folt.f32 %0 %0
  jump b1
b1 loop b5 <- b0 b4:
  jump b2
b2 loop b4 <- b1 b3:
  %2 f32 = fadd %0 %0
  branch %1 b3 b4
b3 <- b2:
  branch %1 b2 b6
b4 <- b2:
  branch %1 b1 b5
b5 <- b4:
  branch %1 b6 b7
b6 <- b3 b5:
  jump b7
b7 <- b5 b6:
  storeOutput #0 %2
  ret
)");
    ASSERT_TRUE(p.ok()) << p.error().message;
    EXPECT_FALSE(verify(*p).ok());
    EXPECT_TRUE(closeLoops(*p));
    const Status status = verify(*p);
    EXPECT_TRUE(status.ok()) << status.error().message << print(*p);
    EXPECT_FALSE(closeLoops(*p));
    EXPECT_EQ(blocksOf(*p), R"(b0:
  %0 f32 = input #0
  %1 b1 = folt.f32 %0 %0
  jump b1
b1 loop b5 <- b0 b4:
  jump b2
b2 loop b4 <- b1 b3:
  %2 f32 = fadd %0 %0
  branch %1 b3 b4
b3 <- b2:
  branch %1 b2 b6
b4 <- b2:
  %3 f32 = phi %2
  branch %1 b1 b5
b5 <- b4:
  %4 f32 = phi %3
  branch %1 b6 b7
b6 <- b3 b5:
  %5 f32 = phi %2 %4
  jump b7
b7 <- b5 b6:
  %6 f32 = phi %4 %5
  storeOutput #0 %6
  ret
)");
}

TEST(Analyse, Facts) {
    Program p = program(R"(b0:
  %0 f32 = input #1
  %1 f32 = ddxFine %0
  %2 i32 = constant 0x0
  %3 f32 = loadBuffer #0 %2 %2
  storeOutput #1 %1
  kill
)");
    analyse(p);
    EXPECT_TRUE(p.usesQuads);
    EXPECT_TRUE(p.canDiscard);
    EXPECT_FALSE(p.hasSideEffects);
    EXPECT_TRUE(p.resources[0].readOnly);
    ASSERT_EQ(p.inputs.size(), 1u);
    EXPECT_EQ(p.inputs[0].component, 1);
    ASSERT_EQ(p.outputs.size(), 1u);
    EXPECT_EQ(p.outputs[0].component, 1);
    EXPECT_TRUE(verify(p).ok());
}

TEST(Rates, LowestThatIsSafe) {
    const Program p = program(R"(b0:
  %0 i32 = constant 0x4
  %1 f32 = constant 0x40000000
  %2 f32 = fsin %1
  %3 f32 = loadBuffer #1 %0 %0
  %4 f32 = fmul %3 %2
  %5 i32 = ftos.f32 %4
  %6 f32 = loadBuffer #1 %0 %5
  %7 f32 = loadBuffer #0 %0 %0
  %8 f32 = input #0
  %9 f32 = fadd %8 %6
  %10 i32 = bufferSize #0 %0
  storeBuffer #0 %0 %0 %9
  jump b1
b1 <- b0:
  %11 f32 = phi %3
  ret
)");
    const std::vector<Rate> rates = computeRates(p);
    const std::vector<Rate> wanted = {Rate::constant, Rate::constant, Rate::constant, Rate::draw,
                                      Rate::draw,     Rate::draw,     Rate::draw,     Rate::invocation,
                                      Rate::pixel,    Rate::pixel,    Rate::draw,     Rate::invocation};
    EXPECT_EQ(rates, wanted);
}

Rate rateOfOutput(const char* head, const char* input) {
    const Result<Program> p = parse(std::string("program ") + head + "\ninput 0 " + input +
                                    "\nb0:\n  %0 i32 = input #0\n  %1 i32 = iadd %0 %0\n  ret\n");
    EXPECT_TRUE(p.ok()) << p.error().message;
    return computeRates(*p)[1];
}

TEST(Rates, FollowTheInputs) {
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 user 0.0 flat center"), Rate::primitive);
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 primitiveId 0.0 flat center"), Rate::primitive);
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 user 0.0 smooth centroid"), Rate::pixel);
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 user 0.0 smooth sample"), Rate::sample);
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 sampleId 0.0 flat center"), Rate::sample);
    EXPECT_EQ(rateOfOutput("fragment \"main\"", "i32 fragCoord 0.0 flat center"), Rate::pixel);
    EXPECT_EQ(rateOfOutput("vertex \"main\"", "i32 instanceIndex 0.0"), Rate::instance);
    EXPECT_EQ(rateOfOutput("vertex \"main\"", "i32 user 0.0"), Rate::invocation);
    EXPECT_EQ(rateOfOutput("compute \"main\"", "i32 numWorkgroups 0.0"), Rate::draw);
    EXPECT_EQ(rateOfOutput("compute \"main\"", "i32 workgroupId 0.0"), Rate::workGroup);
    EXPECT_EQ(rateOfOutput("compute \"main\"", "i32 localInvocationIndex 0.0"), Rate::invocation);
}

}  // namespace
}  // namespace vernier::ir
