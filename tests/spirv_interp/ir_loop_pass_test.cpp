// The passes that change loops, each on a small program, with the text that must come out.
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/passes.h"
#include "tests/spirv_interp/ir_pass_support.h"

namespace vernier::ir {
namespace {

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

TEST(Pass, UnrollLoopsOfWhichMuchIsConstant) {
    // A body of `filling` additions to what a buffer has, and `known` of constants.
    const auto loop = [](size_t filling, size_t known) {
        std::string text = R"(b0:
  %0 i32 = constant 0x0
  %1 i32 = constant 0x1
  %2 i32 = constant 0x10
  %3 i32 = loadBuffer #1 %0 %0
  jump b1
b1 loop b3 <- b0 b2:
  %4 i32 = phi %0 %6
  %5 b1 = slt.i32 %4 %2
  branch %5 b2 b3
b2 <- b1:
  %6 i32 = iadd %4 %1
)";
        size_t next = 7, sum = 3;
        for (size_t k = 0; k < filling + known; ++k, ++next) {
            text += "  %" + std::to_string(next) + " i32 = iadd %4 %" + std::to_string(k < filling ? sum : 1) + "\n";
            if (k < filling) sum = next;
        }
        return text + "  storeBuffer #0 %0 %0 %" + std::to_string(sum) + "\n  jump b1\nb3 <- b1:\n  ret\n";
    };
    const auto unrolls = [](const std::string& text) {
        Program p = program(text);
        EXPECT_FALSE(unrollLoops(p)) << text;
        const bool changed = unrollConstantLoops(p);
        EXPECT_TRUE(verify(p).ok()) << verify(p).error().message;
        return changed;
    };
    EXPECT_TRUE(unrolls(loop(60, 2)));
    EXPECT_FALSE(unrolls(loop(80, 0)));    // less than a sixteenth is known
    EXPECT_FALSE(unrolls(loop(120, 10)));  // too large
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

TEST(Pass, HoistInvariants) {
    // What every round runs and the loop does not change goes before it, with what follows from it; what only some
    // rounds run stays.
    EXPECT_EQ(after(hoistInvariants, R"(b0:
  %0 f32 = input #0
  %1 i32 = constant 0x0
  %2 i32 = constant 0x8
  jump b1
b1 loop b5 <- b0 b4:
  %3 i32 = phi %1 %11
  %4 f32 = phi %0 %8
  %5 b1 = slt.i32 %3 %2
  branch %5 b2 b5
b2 <- b1:
  %6 f32 = fsqrt %0
  %7 f32 = fmul %6 %0
  %8 f32 = fadd %4 %7
  %9 b1 = folt.f32 %0 %4
  branch %9 b3 b4
b3 <- b2:
  %10 f32 = fneg %0
  storeBuffer #0 %1 %3 %10
  jump b4
b4 <- b2 b3:
  %11 i32 = iadd %3 %2
  jump b1
b5 <- b1:
  %12 f32 = phi %4
  storeOutput #0 %12
  ret
)"),
              R"(b0:
  %0 f32 = input #0
  %1 i32 = constant 0x0
  %2 i32 = constant 0x8
  %3 f32 = fsqrt %0
  %4 f32 = fmul %3 %0
  jump b1
b1 loop b5 <- b0 b4:
  %5 i32 = phi %1 %11
  %6 f32 = phi %0 %8
  %7 b1 = slt.i32 %5 %2
  branch %7 b2 b5
b2 <- b1:
  %8 f32 = fadd %6 %4
  %9 b1 = folt.f32 %0 %6
  branch %9 b3 b4
b3 <- b2:
  %10 f32 = fneg %0
  storeBuffer #0 %1 %5 %10
  jump b4
b4 <- b2 b3:
  %11 i32 = iadd %5 %2
  jump b1
b5 <- b1:
  %12 f32 = phi %6
  storeOutput #0 %12
  ret
)");
}

// Of two readings of the clock none is the other, and none moves; one that nobody uses is not taken.
TEST(Pass, ClocksAreReadWhereTheyStand) {
    const std::string text = R"(b0:
  %0 i64 = readClock
  %1 f32 = input #0
  %2 b1 = folt.f32 %1 %1
  jump b1
b1 loop b3 <- b0 b2:
  %3 i64 = readClock
  branch %2 b2 b3
b2 <- b1:
  %4 i64 = isub %3 %0
  %5 i32 = lowWord %4
  storeBuffer #0 %5 %5 %5
  jump b1
b3 <- b1:
  ret
)";
    Program clocks = program(text);
    EXPECT_FALSE(eliminateCommon(clocks));
    EXPECT_FALSE(hoistInvariants(clocks));
    EXPECT_FALSE(removeDead(clocks));
    EXPECT_EQ(after(removeDead, "b0:\n  %0 i64 = readClock\n  ret\n"), "b0:\n  ret\n");
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

}  // namespace
}  // namespace vernier::ir
