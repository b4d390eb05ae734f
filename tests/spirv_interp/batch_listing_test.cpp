// What programs are compiled to: golden listings.
#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"

namespace vernier {
namespace {

std::string listing(const std::string& text) {
    const auto compiled = BatchProgram::compile(test::parseProgram(text), {kLowestIsa, MathTier::standard, 64});
    return compiled.ok() ? (*compiled)->disassemble() : compiled.error().message;
}

TEST(BatchListing, UniformsAreScalarsAndDotProductsOneInstruction) {
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
resource 0 uniformBuffer 0.0 x1 read
b0:
  %0 i32 = constant 0
  %1 i32 = constant 4
  %2 f32 = loadBuffer #0 %0 %0
  %3 f32 = loadBuffer #0 %0 %1
  %4 f32 = fmul %2 %3
  %5 f32 = input #0
  %6 f32 = input #1
  %7 f32 = fmul %5 %2
  %8 f32 = fmul %6 %4
  %9 f32 = fadd %7 %8
  %10 f32 = constant 0x3f800000
  %12 f32 = constant 0
  %11 f32 = fclamp %9 %12 %10
  storeOutput #0 %11
  ret
)"),
              R"(registers 2
input 0 r0
input 1 r1
output 0 r0
draw:
    0  loadBuffer s0, 0x00000000, 0x00000000, 0
    1  loadBuffer s4, 0x00000000, 0x00000004, 0
    2  fmul s1, s0, s4
    3  end
batch:
    0  dot2Scalar acc, r0, s0, r1, s1
    2  fclamp r0, acc, 0x00000000, 0x3f800000
    3  end
)");
}

TEST(BatchListing, CountersOfAllLanesAreScalarsAndUniformBranchesNeedNoRow) {
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
resource 0 uniformBuffer 0.0 x1 read
b0:
  %0 i32 = input #0
  %1 i32 = constant 0
  %2 i32 = constant 1
  %3 i32 = loadBuffer #0 %1 %1
  %4 b1 = ieq.i32 %3 %1
  branch %4 b1 b2
b1 <- b0:
  kill
b2 <- b0:
  jump b3
b3 loop b5 <- b2 b4:
  %5 i32 = phi %1 %7
  %6 b1 = slt.i32 %5 %0
  branch %6 b4 b5
b4 <- b3:
  %7 i32 = iadd %5 %2
  jump b3
b5 <- b3:
  %8 i32 = phi %5
  storeOutput #0 %8
  ret
)"),
              R"(registers 2
input 0 r0
output 0 r1
draw:
    0  loadBuffer s5, 0x00000000, 0x00000000, 0
    1  ieq s0, s5, 0x00000000
    2  end
batch:
    0  splitScalarInto s0, m2, m3, @2
    1  enter m2, @3
    2  discard
    3  enter m3, @6
    4  moveScalar s1, 0x00000000
    5  leaveInto m4, @7
    6  enter m4, @16
    7  slt acc, s1, r0
    8  splitInto acc, m5, m7, @13
    9  skipEmpty m7, @12
   10  broadcastMasked r1, s1, m7
   11  follow m6, m7
   12  enter m5, @15
   13  iadd s1, s1, 0x00000001
   14  again m4, @7
   15  repeat m4, @6
   16  enter m6, @17
   17  end
)");
}

TEST(BatchListing, LoopsKeepTheCountersOfTheirLanesInPlace) {
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = constant 100
  jump b1
b1 loop b3 <- b0 b2:
  %2 i32 = phi %0 %4
  %3 b1 = slt.i32 %2 %1
  branch %3 b2 b3
b2 <- b1:
  %4 i32 = iadd %2 %0
  jump b1
b3 <- b1:
  %5 i32 = phi %2
  storeOutput #0 %5
  ret
)"),
              R"(registers 3
input 0 r0
output 0 r2
batch:
    0  copy r1, r0
    1  leaveInto m2, @3
    2  enter m2, @12
    3  slt acc, r1, 0x00000064
    4  splitInto acc, m3, m5, @9
    5  skipEmpty m5, @8
    6  copyMasked r2, r1, m5
    7  follow m4, m5
    8  enter m3, @11
    9  iadd r1, r1, r0
   10  again m2, @3
   11  repeat m2, @2
   12  enter m4, @13
   13  end
)");
}

TEST(BatchListing, SwappedPhisGoThroughATemporary) {
    const std::string text = listing(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 i32 user 0.1 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = input #1
  jump b1
b1 loop b3 <- b0 b2:
  %2 i32 = phi %0 %3
  %3 i32 = phi %1 %2
  %4 b1 = slt.i32 %2 %3
  branch %4 b2 b3
b2 <- b1:
  jump b1
b3 <- b1:
  %5 i32 = phi %2
  storeOutput #0 %5
  ret
)");
    EXPECT_NE(text.find("copy acc, r0\n"), std::string::npos) << text;
}

TEST(BatchListing, ResultsGoThroughTheAccumulator) {
    // A chain needs no rows; what has another reader later is stored too; a commutative operation takes the accumulator
    // first.
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fdiv %0 %1
  %3 f32 = fsqrt %0
  %4 f32 = fsub %3 %2
  %5 f32 = fmul %1 %4
  %6 f32 = fmul %5 %5
  %7 f32 = fmax %6 %4
  storeOutput #0 %7
  storeOutput #1 %4
  ret
)"),
              R"(registers 3
input 0 r0
input 1 r1
output 0 r1
output 1 r0
batch:
    0  fsqrt r2, r0
    1  fdiv acc, r0, r1
    2  fsub r0, r2, acc
    3  fmul acc, acc, r1
    4  fmul acc, acc, acc
    5  fmax r1, acc, r0
    6  end
)");
}

TEST(BatchListing, ShiftsAndWhatMasksOrMixesThemAreOneInstruction) {
    EXPECT_EQ(listing(R"(program fragment "hash"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = constant 0xf
  %2 i32 = constant 0x3ff
  %3 i32 = lshr %0 %1
  %4 i32 = ixor %0 %3
  %5 i32 = shl %4 %1
  %6 i32 = ixor %5 %4
  %7 i32 = lshr %6 %1
  %8 i32 = iand %2 %7
  storeOutput #0 %8
  ret
)"),
              R"(registers 1
input 0 r0
output 0 r0
batch:
    0  xorShiftRight acc, r0, 0x0000000f
    1  xorShiftLeft acc, acc, 0x0000000f
    2  shiftRightAnd r0, acc, 0x0000000f, 0x000003ff
    3  end
)");
}

TEST(BatchListing, StoresOfWordsOneBehindTheOtherAreOneInstruction) {
    // Four words in any order; but not what a load stands between, nor those that leave a word out.
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 f32 user 0.1 smooth center
resource 0 storageBuffer 0.0 x1
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  %2 i32 = constant 0
  %3 i32 = constant 4
  %4 i32 = constant 8
  %5 i32 = constant 12
  %6 i32 = constant 16
  %7 i32 = iadd %0 %5
  storeBuffer #0 %2 %7 %1
  storeBuffer #0 %2 %0 %0
  %8 i32 = iadd %3 %0
  %9 f32 = fneg %1
  storeBuffer #0 %2 %8 %9
  %10 i32 = iadd %0 %4
  storeBuffer #0 %2 %10 %6
  storeBuffer #0 %2 %0 %1
  %11 i32 = loadBuffer #0 %2 %0
  storeBuffer #0 %2 %8 %11
  %12 i32 = iadd %0 %6
  storeBuffer #0 %2 %12 %1
  ret
)"),
              R"(registers 5
input 0 r0
input 1 r1
batch:
    0  iadd r2, r0, 0x00000004
    1  fneg r3, r1
    2  broadcast r4, 0x00000010
    3  storeWords 0x00000000, r0, r0, r3, r4, r1, 0, 4
    5  storeBuffer 0x00000000, r0, r1, 0
    6  loadBuffer r3, 0x00000000, r0, 0
    7  storeBuffer 0x00000000, r2, r3, 0
    8  iadd r0, r0, 0x00000010
    9  storeBuffer 0x00000000, r0, r1, 0
   10  end
)");
}

TEST(BatchListing, IndependentChainsAreComputedOneAfterTheOther) {
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fsqrt %0
  %3 f32 = fsqrt %1
  %4 f32 = ffloor %2
  %5 f32 = ffloor %3
  %6 f32 = fneg %4
  %7 f32 = fneg %5
  storeOutput #0 %6
  storeOutput #1 %7
  ret
)"),
              R"(registers 2
input 0 r0
input 1 r1
output 0 r0
output 1 r1
batch:
    0  fsqrt acc, r0
    1  ffloor acc, acc
    2  fneg r0, acc
    3  fsqrt acc, r1
    4  ffloor acc, acc
    5  fneg r1, acc
    6  end
)");
}

TEST(BatchListing, WhatAPhiBecomesIsComputedAfterItsLastUse) {
    // Both phis keep their rows: %5 comes first in the program, but %6 still reads what it replaces.
    EXPECT_EQ(listing(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 0.1 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  jump b1
b1 loop b3 <- b0 b2:
  %2 f32 = phi %0 %5
  %3 f32 = phi %1 %6
  %4 b1 = folt.f32 %2 %3
  branch %4 b2 b3
b2 <- b1:
  %5 f32 = fadd %2 %1
  %6 f32 = fmax %2 %3
  jump b1
b3 <- b1:
  %7 f32 = phi %2
  %8 f32 = phi %3
  storeOutput #0 %7
  storeOutput #1 %8
  ret
)"),
              R"(registers 5
input 0 r0
input 1 r1
output 0 r3
output 1 r4
batch:
    0  copy r2, r1
    1  leaveInto m2, @3
    2  enter m2, @14
    3  folt acc, r0, r2
    4  splitInto acc, m3, m5, @10
    5  skipEmpty m5, @9
    6  copyMasked r3, r0, m5
    7  copyMasked r4, r2, m5
    8  follow m4, m5
    9  enter m3, @13
   10  fmax r2, r0, r2
   11  fadd r0, r0, r1
   12  again m2, @3
   13  repeat m2, @2
   14  enter m4, @15
   15  end
)");
}

}  // namespace
}  // namespace vernier
