// What programs are compiled to: golden listings.
#include <gtest/gtest.h>

#include "tests/spirv_interp/batch_harness.h"

namespace vernier {
namespace {

std::string listing(const std::string& text) {
    const auto compiled = BatchProgram::compile(test::parseProgram(text), {Isa::sse4, MathTier::standard, 64});
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
              "");
}

}  // namespace
}  // namespace vernier
