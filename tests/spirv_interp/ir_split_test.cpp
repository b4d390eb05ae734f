// splitSamples: what of a program that runs per sample runs per pixel.
#include <gtest/gtest.h>

#include "spirv_interp/ir/analyse.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/split_samples.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {
namespace {

std::string fragmentText(const std::string& body, const std::string& sampling = "center") {
    return "program fragment \"main\"\ninput 0 f32 user 0.0 smooth " + sampling +
           "\ninput 1 i32 sampleId 0.0 flat center\noutput 0 f32 user 0.0\noutput 1 f32 user 0.1\nb0:\n"
           "  %0 f32 = input #0\n  %1 i32 = input #1\n" +
           body;
}

Program read(const std::string& text) {
    Result<Program> program = parse(text);
    EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().message);
    EXPECT_TRUE(verify(*program).ok()) << verify(*program).error().message;
    analyse(*program);
    return *program;
}

constexpr const char* kWork =
    "  %2 f32 = fsin %0\n  %3 f32 = fcos %2\n  %4 f32 = fmul %3 %2\n  %5 b1 = folt.f32 %4 %0\n"
    "  %6 f32 = stof.i32 %1\n  %7 f32 = fmul %4 %6\n  %8 f32 = select %5 %7 %6\n"
    "  storeOutput #0 %8\n  storeOutput #1 %4\n  ret\n";

TEST(SplitSamples, CarriesWhatSamplesShare) {
    const auto split = splitSamples(read(fragmentText(kWork)));
    ASSERT_TRUE(split);
    EXPECT_EQ(split->operations, 4u);
    EXPECT_TRUE(verify(split->pixel).ok()) << verify(split->pixel).error().message;
    EXPECT_TRUE(verify(split->sample).ok()) << verify(split->sample).error().message;
    EXPECT_EQ(print(split->pixel), R"(program fragment "main"
input 0 f32 user 0.0 smooth center
output 0 f32 user 65408.0
output 1 i32 user 65408.1
b0:
  %0 f32 = input #0
  %1 f32 = fsin %0
  %2 f32 = fcos %1
  %3 f32 = fmul %1 %2
  %4 b1 = folt.f32 %3 %0
  storeOutput #0 %3
  %5 i32 = zext.b1 %4
  storeOutput #1 %5
  ret
)");
    EXPECT_EQ(print(split->sample), R"(program fragment "main"
input 0 i32 sampleId 0.0 flat center
input 1 f32 user 65408.0 flat center
input 2 i32 user 65408.1 flat center
output 0 f32 user 0.0
output 1 f32 user 0.1
facts perSample
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  %2 i32 = input #2
  %3 i32 = constant 0x0
  %4 b1 = ine.i32 %2 %3
  %5 f32 = stof.i32 %0
  %6 f32 = fmul %1 %5
  %7 f32 = select %4 %6 %5
  storeOutput #0 %7
  storeOutput #1 %1
  ret
)");
}

TEST(SplitSamples, NotWhatDiffers) {
    EXPECT_FALSE(splitSamples(read(fragmentText(kWork, "sample"))));
    EXPECT_FALSE(splitSamples(read(fragmentText(kWork, "centroid"))));
    // Too little work.
    EXPECT_FALSE(splitSamples(
        read(fragmentText("  %2 f32 = fadd %0 %0\n  %3 f32 = stof.i32 %1\n  %4 f32 = fmul %2 %3\n  storeOutput #0 %4\n"
                          "  storeOutput #1 %2\n  ret\n"))));
}

// A derivative behind a branch sees the lanes that take it: it stays where it is.
TEST(SplitSamples, DerivativesOnlyWhereAllLanesRun) {
    const char* const body =
        "  %2 f32 = fsin %0\n  %3 f32 = fcos %2\n  %4 f32 = fexp %3\n  %5 f32 = ddxFine %4\n  %6 i32 = constant 0x0\n"
        "  %7 b1 = ieq.i32 %1 %6\n  branch %7 b1 b2\nb1 <- b0:\n  %8 f32 = ddyFine %4\n  jump b2\nb2 <- b0 b1:\n"
        "  %9 f32 = phi %5 %8\n  storeOutput #0 %9\n  storeOutput #1 %4\n  ret\n";
    const auto split = splitSamples(read(fragmentText(body)));
    ASSERT_TRUE(split);
    EXPECT_TRUE(split->pixel.usesQuads);
    EXPECT_NE(print(split->pixel).find("ddxFine"), std::string::npos);
    EXPECT_EQ(print(split->pixel).find("ddyFine"), std::string::npos);
    EXPECT_EQ(print(split->sample).find("ddxFine"), std::string::npos);
    EXPECT_NE(print(split->sample).find("ddyFine"), std::string::npos);
}

}  // namespace
}  // namespace vernier::ir
