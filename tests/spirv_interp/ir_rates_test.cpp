// What analyses tell of small programs: facts and rates.
#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/rates.h"
#include "tests/spirv_interp/ir_pass_support.h"

namespace vernier::ir {
namespace {

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
