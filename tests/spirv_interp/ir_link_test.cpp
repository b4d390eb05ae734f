// linkStages: what one stage writes and the other reads.
#include <gtest/gtest.h>

#include "spirv_interp/ir/link.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {
namespace {

Program read(const char* text) {
    Result<Program> program = parse(text);
    EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().message);
    EXPECT_TRUE(verify(*program).ok()) << verify(*program).error().message;
    return *program;
}

constexpr const char* kVertex = R"(program vertex "main"
input 0 f32 user 0.0
input 1 f32 user 1.0
output 0 f32 position 0.0
output 1 f32 user 0.0
output 2 f32 user 3.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fsin %1
  storeOutput #0 %0
  storeOutput #1 %0
  storeOutput #2 %2
  ret
)";

TEST(Link, DropsWhatIsNotReadAndZeroesWhatIsNotWritten) {
    Program vertex = read(kVertex);
    Program fragment = read(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 2.0 smooth center
input 2 f32 fragCoord 0.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = input #2
  %3 f32 = fmul %0 %2
  %4 f32 = fsub %2 %1
  storeOutput #0 %3
  storeOutput #1 %4
  ret
)");
    const Status status = linkStages(vertex, fragment);
    ASSERT_TRUE(status.ok()) << status.error().message;
    EXPECT_EQ(print(vertex), R"(program vertex "main"
input 0 f32 user 0.0
output 0 f32 position 0.0
output 1 f32 user 0.0
b0:
  %0 f32 = input #0
  storeOutput #0 %0
  storeOutput #1 %0
  ret
)");
    EXPECT_EQ(print(fragment), R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 fragCoord 0.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fmul %0 %1
  storeOutput #0 %2
  storeOutput #1 %1
  ret
)");
}

// Somebody else, transform feedback, reads them.
TEST(Link, KeepsWhatItIsTold) {
    Program vertex = read(kVertex);
    Program fragment = read("program fragment \"main\"\nb0:\n  ret\n");
    InterfaceSlot kept;
    kept.location = 3;
    kept.component = 1;
    LinkFacts facts;
    LinkOptions options;
    options.kept = {&kept, 1};
    ASSERT_TRUE(linkStages(vertex, fragment, &facts, options).ok());
    EXPECT_EQ(print(vertex), R"(program vertex "main"
input 0 f32 user 0.0
input 1 f32 user 1.0
output 0 f32 position 0.0
output 1 f32 user 3.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fsin %1
  storeOutput #0 %0
  storeOutput #1 %2
  ret
)");
    EXPECT_EQ(facts.removedOutputs, 1u);
}

TEST(Link, FillsIndexedInputs) {
    Program vertex = read(kVertex);
    Program fragment = read(R"(program fragment "main"
input 0 f32 user 0.0 smooth center
input 1 f32 user 1.0 smooth center
input 2 i32 primitiveId 0.0 flat center
output 0 f32 user 0.0
b0:
  %0 i32 = input #2
  %1 f32 = inputIndexed #0:2 %0
  storeOutput #0 %1
  ret
)");
    ASSERT_TRUE(linkStages(vertex, fragment).ok());
    EXPECT_EQ(fragment.inputs.size(), 3u);
    EXPECT_EQ(print(vertex), R"(program vertex "main"
input 0 f32 user 0.0
output 0 f32 position 0.0
output 1 f32 user 0.0
output 2 f32 user 1.0
b0:
  %0 f32 = constant 0x0
  %1 f32 = input #0
  storeOutput #0 %1
  storeOutput #1 %1
  storeOutput #2 %0
  ret
)");
    EXPECT_TRUE(verify(vertex).ok());
}

// What depends on flat inputs alone is computed by the vertex program, from the values it stored to them.
TEST(Link, LiftsWorkOnFlatInputs) {
    Program vertex = read(R"(program vertex "main"
input 0 i32 user 0.0
input 1 f32 user 1.0
output 0 f32 position 0.0
output 1 i32 user 0.0
output 2 f32 user 1.0
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  storeOutput #0 %1
  storeOutput #1 %0
  storeOutput #2 %1
  ret
)");
    Program fragment = read(R"(program fragment "main"
input 0 i32 user 0.0 flat center
input 1 f32 user 1.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  %2 f32 = utof.i32 %0
  %3 f32 = fsqrt %2
  %4 f32 = fsin %3
  %5 f32 = fmul %4 %1
  %6 i32 = constant 0x7
  %7 b1 = ult.i32 %0 %6
  %8 f32 = select %7 %5 %1
  storeOutput #0 %5
  storeOutput #1 %8
  ret
)");
    LinkFacts facts;
    ASSERT_TRUE(linkStages(vertex, fragment, &facts).ok());
    EXPECT_EQ(facts.lifted.flat, 4u);
    EXPECT_EQ(facts.removedOutputs, 1u);
    EXPECT_TRUE(verify(vertex).ok()) << verify(vertex).error().message;
    EXPECT_TRUE(verify(fragment).ok()) << verify(fragment).error().message;
    EXPECT_EQ(print(vertex), R"(program vertex "main"
input 0 i32 user 0.0
input 1 f32 user 1.0
output 0 f32 position 0.0
output 1 f32 user 1.0
output 2 f32 user 2.0
output 3 i32 user 2.1
b0:
  %0 i32 = input #0
  %1 f32 = input #1
  storeOutput #0 %1
  storeOutput #1 %1
  %2 f32 = utof.i32 %0
  %3 f32 = fsqrt %2
  %4 f32 = fsin %3
  storeOutput #2 %4
  %5 i32 = constant 0x7
  %6 b1 = ult.i32 %0 %5
  %7 i32 = zext.b1 %6
  storeOutput #3 %7
  ret
)");
    EXPECT_EQ(print(fragment), R"(program fragment "main"
input 0 f32 user 1.0 smooth center
input 1 f32 user 2.0 flat center
input 2 i32 user 2.1 flat center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = input #1
  %2 f32 = fmul %0 %1
  %3 i32 = input #2
  %4 i32 = constant 0x0
  %5 b1 = ine.i32 %4 %3
  %6 f32 = select %5 %2 %0
  storeOutput #0 %2
  storeOutput #1 %6
  ret
)");
}

TEST(Link, LeavesLittleWorkOnFlatInputs) {
    Program vertex = read(R"(program vertex "main"
input 0 f32 user 0.0
output 0 f32 user 0.0
b0:
  %0 f32 = input #0
  storeOutput #0 %0
  ret
)");
    Program fragment = read(R"(program fragment "main"
input 0 f32 user 0.0 flat center
output 0 f32 user 0.0
output 1 f32 user 0.1
b0:
  %0 f32 = input #0
  %1 f32 = fmul %0 %0
  storeOutput #0 %1
  storeOutput #1 %0
  ret
)");
    const std::string before = print(fragment);
    LinkFacts facts;
    ASSERT_TRUE(linkStages(vertex, fragment, &facts).ok());
    EXPECT_EQ(facts.lifted.flat, 0u);
    EXPECT_EQ(print(fragment), before);
}

TEST(Link, RefusesTypesThatDiffer) {
    Program vertex = read(kVertex);
    Program fragment = read(R"(program fragment "main"
input 0 i32 user 3.1 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  storeOutput #0 %0
  ret
)");
    const std::string before = print(vertex);
    const Status status = linkStages(vertex, fragment);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "location 3, component 1: the vertex shader writes f32, the fragment shader reads i32");
    EXPECT_EQ(print(vertex), before);
    EXPECT_FALSE(linkStages(fragment, vertex).ok());
}

TEST(Link, TellsWhatRunsUnlinked) {
    const auto runs = [](const std::string& input) {
        Program vertex = read(kVertex);
        Program fragment = read(("program fragment \"main\"\ninput 0 " + input + R"(
input 1 f32 fragCoord 0.0 smooth center
output 0 f32 user 0.0
b0:
  %0 f32 = input #1
  storeOutput #0 %0
  ret
)")
                                    .c_str());
        const bool before = writesAll(vertex, fragment);
        if (linkStages(vertex, fragment).ok()) {
            EXPECT_TRUE(writesAll(vertex, fragment)) << input;
        }
        return before;
    };
    EXPECT_TRUE(runs("f32 user 0.0 smooth center"));
    EXPECT_TRUE(runs("f32 user 3.1 flat center"));
    EXPECT_FALSE(runs("f32 user 3.0 smooth center")) << "nobody writes it";
    EXPECT_FALSE(runs("i32 user 0.0 flat center")) << "of another type";
}

}  // namespace
}  // namespace vernier::ir
