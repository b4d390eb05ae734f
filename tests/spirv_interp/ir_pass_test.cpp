// The passes, each on a small program, with the text that must come out.
#include "spirv_interp/ir/passes.h"
#include "tests/spirv_interp/ir_pass_support.h"

namespace vernier::ir {
namespace {

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

/// What reduceStrength makes of a program that stores %9, computed from %1 (f32) and its bits %0 (i32).
std::string reduced(const std::string& code) {
    Program p =
        program("b0:\n  %1 f32 = input #1\n  %0 i32 = bitcast.f32 %1\n" + code + "  storeOutput #0 %9\n  ret\n");
    if (!reduceStrength(p)) return "nothing";
    removeDead(p);
    EXPECT_TRUE(verify(p).ok()) << verify(p).error().message;
    const std::string text = blocksOf(p);
    return text.substr(4, text.size() - 4 - 6);
}

TEST(Pass, ReduceStrengthOfFields) {
    const auto field = [](const char* shift, const char* mask, const char* scale) {
        return std::string("  %2 i32 = constant ") + shift + "\n  %3 i32 = constant " + mask +
               "\n  %4 f32 = constant " + scale +
               "\n  %5 i32 = lshr %0 %2\n  %6 i32 = iand %5 %3\n  %7 f32 = stof.i32 %6\n  %9 f32 = fmul %4 %7\n";
    };
    EXPECT_EQ(reduced(field("0xa", "0x3ff", "0x3b002008")), R"(  %0 i32 = constant 0xffc00
  %1 f32 = constant 0x36002008
  %2 f32 = input #1
  %3 i32 = bitcast.f32 %2
  %4 i32 = iand %3 %0
  %5 f32 = stof.i32 %4
  %6 f32 = fmul %1 %5
  storeOutput #0 %6
)");
    EXPECT_NE(reduced(field("0x15", "0x3ff", "0x3b002008")), "nothing");
    EXPECT_EQ(reduced(field("0x16", "0x3ff", "0x3b002008")), "nothing");  // with the sign
    EXPECT_EQ(reduced(field("0xa", "0x3ff", "0x02000000")), "nothing");   // the scale would be denormal
    EXPECT_EQ(reduced(field("0xa", "0x3ff", "0x7f800000")), "nothing");
    // What is masked or converted is wanted elsewhere.
    const std::string more = "  storeBuffer #0 %2 %2 ";
    EXPECT_EQ(reduced(field("0xa", "0x3ff", "0x3b002008") + more + "%6\n"), "nothing");
    EXPECT_EQ(reduced(field("0xa", "0x3ff", "0x3b002008") + more + "%7\n"), "nothing");
}

TEST(Pass, ReduceStrengthOfRemainders) {
    const auto remainder = [](const char* op, const char* divisor) {
        return std::string("  %2 f32 = constant ") + divisor + "\n  %9 f32 = " + op + " %1 %2\n";
    };
    EXPECT_EQ(reduced(remainder("fmod", "0xc0800000")), R"(  %0 f32 = constant 0xbe800000
  %1 f32 = input #1
  %2 f32 = constant 0xc0800000
  %3 f32 = fmul %1 %0
  %4 f32 = ffloor %3
  %5 f32 = fmul %2 %4
  %6 f32 = fsub %1 %5
  storeOutput #0 %6
)");
    EXPECT_NE(reduced(remainder("frem", "0x40000000")).find("ftrunc"), std::string::npos);
    for (const char* divisor : {"0x40400000", "0x7f000000", "0x00400000", "0x0"})
        EXPECT_EQ(reduced(remainder("fmod", divisor)), "nothing") << divisor;
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

// The bits of halves between operations on them.
TEST(Pass, FoldHalves) {
    const auto run = [](const std::string& code) { return folded(code + "  storeOutput #0 %9\n"); };
    const std::string rounded = "  %0 f32 = input #0\n  %1 f32 = ftoh.f32 %0\n  storeOutput #0 %1\n";
    const std::string zero = "  %2 f32 = constant 0x0\n";
    // What is a half stays what it is; anything else is rounded as its bits would have been.
    EXPECT_EQ(run(zero + "  %3 f32 = ftoh.f32 %0\n  %4 i32 = packHalf %3 %2\n  %9 f32 = unpackHalfLow %4\n"), rounded);
    EXPECT_EQ(run(zero + "  %4 i32 = packHalf %0 %2\n  %9 f32 = unpackHalfLow %4\n"), rounded);
    EXPECT_EQ(run(zero + "  %4 i32 = packHalf %2 %0\n  %9 f32 = unpackHalfHigh %4\n"), rounded);
    EXPECT_EQ(run("  %2 f32 = ftoh.f32 %0\n  %3 f32 = constant 0x3c000000\n  %4 f32 = fmax %2 %3\n"
                  "  %9 f32 = ftoh.f32 %4\n"),
              "  %0 f32 = input #0\n  %1 f32 = ftoh.f32 %0\n  %2 f32 = constant 0x3c000000\n  %3 f32 = fmax %1 %2\n"
              "  storeOutput #0 %3\n");
    // Neither sums nor floats that no half is.
    for (const char* code : {"  %4 f32 = fadd %2 %2\n", "  %3 f32 = constant 0x3c000001\n  %4 f32 = fmax %2 %3\n"}) {
        const std::string kept = run("  %2 f32 = ftoh.f32 %0\n" + std::string(code) + "  %9 f32 = ftoh.f32 %4\n");
        EXPECT_NE(kept.find("ftoh", kept.find("ftoh") + 1), std::string::npos) << kept;
    }
    EXPECT_NE(run("  %2 i32 = bitcast.f32 %0\n  %3 f32 = unpackHalfLow %2\n  %4 f32 = constant 0x0\n"
                  "  %5 i32 = packHalf %3 %4\n  %9 f32 = stof.i32 %5\n")
                  .find("iand"),
              std::string::npos);
}

TEST(Pass, FoldConversionsOfWhatIsNotNegative) {
    const auto run = [](const std::string& code) {
        return folded("  %2 i32 = ftos.f32 %0\n  %3 i32 = constant 0xa\n  %4 i32 = constant 0x80000001\n" + code +
                      "  %19 f32 = utof.i32 %18\n  storeOutput #0 %19\n");
    };
    for (const char* code : {"  %18 i32 = iand %2 %3\n", "  %18 i32 = iand %3 %2\n", "  %18 i32 = lshr %2 %3\n",
                             "  %18 i32 = umod %2 %3\n"}) {
        EXPECT_NE(run(code).find("stof.i32"), std::string::npos) << code;
    }
    for (const char* code : {"  %18 i32 = iand %2 %4\n", "  %18 i32 = ashr %2 %3\n", "  %18 i32 = umod %2 %4\n",
                             "  %18 i32 = iadd %2 %3\n", "  %18 i32 = umod %3 %2\n"}) {
        EXPECT_NE(run(code).find("utof.i32"), std::string::npos) << code;
    }
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

}  // namespace
}  // namespace vernier::ir
