// The text form: what is printed parses back to the same program, and broken text is refused with its line.
#include <gtest/gtest.h>

#include <random>

#include "spirv_interp/ir/builder.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {
namespace {

constexpr const char* kText = R"(program fragment "main"
input 0 f32 user 1.2 noPerspective centroid
input 1 f32 user 1.3 noPerspective centroid
input 2 b1 frontFacing 0.0 smooth center
output 0 f32 user 0.0
output 1 f32 user 0.0.1
resource 0 storageBuffer 2.5 x4
resource 1 pushConstants 0.0 x1 bytes 80 read
resource 2 sampledImage 0.0 x0 read
resource 3 sampler 0.1 x1 read
imageOp 0 sampleImplicit d2 image 2 sampler 3 coords 2 offsets 2 arrayed depthCompare bias
imageOp 1 store d3 image 2 coords 3
facts earlyFragmentTests postDepthCoverage usesQuads canDiscard hasSideEffects
localSize 8 4 1
local 12
b0:
  %0 f32 = constant 0x3f800000
  %1 i32 = constant 0x7
  %2 f32 = input #0 @12
  %3 f32 = inputIndexed #0:2 %1
  %4 f32 = fmul %2 %3 !noContraction !relaxed @13
  %5 b1 = folt.f32 %4 %0
  %6 i64 = makeWide %1 %1
  %7 i32 = atomicBuffer #0:9 %1 %1 %1
  %8 f32 = loadLocal #4:8 %1
  storeLocal #0:12 %1 %8
  branch %5 b1 b4
b1 loop b4 <- b0 b3:
  %9 i32 = phi %1 %12
  switchOn %9 b2 [-1: b3] [7: b3]
b2 <- b1:
  %10 f32 = loadBuffer #1 %1 %9
  storeBuffer #0 %1 %9 %10
  jump b3
b3 <- b1 b1 b2:
  %12 i32 = iadd %9 %1
  branch %5 b1 b4
b4 <- b0 b3:
  %13..%16 f32 = image #0 %1 %1 %2 %3 %4 %0 %8 %1 %1
  storeOutput #1 %13
  ret
)";

TEST(Text, PrintsWhatItParsed) {
    const Result<Program> program = parse(kText);
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(print(*program), kText);
    EXPECT_EQ(program->blocks[1].cases, (std::vector<int32_t>{-1, 7}));
    EXPECT_EQ(program->outputs[1].index, 1);
    EXPECT_TRUE(program->blocks[0].insts[4].noContraction);
    EXPECT_EQ(program->blocks[0].insts[4].line, 13u);
    EXPECT_EQ(program->valueTypes[16], Type::f32);
    EXPECT_TRUE(program->imageOps[0].hasBias);
}

TEST(Text, ReadsCommentsAndBlankLines) {
    const Result<Program> program = parse("; nothing\nprogram vertex \"x\" ; a name\n\nb0: ; entry\n  ret ; done\n");
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(print(*program), "program vertex \"x\"\nb0:\n  ret\n");
    EXPECT_TRUE(verify(*program).ok());
}

TEST(Text, RefusesWhatItCannotRead) {
    const std::pair<const char*, const char*> cases[] = {
        {"program tessellation \"x\"", "line 1: expected a stage"},
        {"program vertex main", "line 1: expected a quoted name"},
        {"input 1 f32 user 0.0", "line 1: expected the next number in the list"},
        {"input 0 f16 user 0.0", "line 1: expected a type"},
        {"input 0 f32 colour 0.0", "line 1: expected a builtin"},
        {"resource 0 buffer 0.0 x1", "line 1: expected a kind of resource"},
        {"facts fast", "line 1: expected a fact"},
        {"  ret", "line 1: expected a block before the first instruction"},
        {"b0:\n  %0 f32 = fadd2 %1 %2", "line 2: expected an operation"},
        {"b0:\n  fadd %1 %2", "line 2: expected as many results as the operation has"},
        {"b0:\n  ret ret", "line 2: expected the end of the line"},
        {"b0:\n  %0 f32 = constant", "line 2: expected a number in range"},
        {"b0:\n  %99999999999 f32 = undef", "line 2: expected a number in range"},
        {"b1:\n", "line 1: expected the next block"},
        {"b0 loop:\n", "line 1: expected a block"},
    };
    for (const auto& [text, message] : cases) {
        const Result<Program> program = parse(text);
        ASSERT_FALSE(program.ok()) << text;
        EXPECT_EQ(program.error().message, std::string("IR text, ") + message);
    }
}

TEST(Text, SurvivesDamage) {
    std::mt19937 random(7);
    const std::string text = kText;
    for (int i = 0; i < 4000; ++i) {
        std::string broken = text;
        for (int k = 0; k < 3; ++k) {
            const size_t at = random() % broken.size();
            switch (random() % 3) {
                case 0:
                    broken[at] = static_cast<char>(' ' + random() % 95);
                    break;
                case 1:
                    broken.erase(at, random() % 8);
                    break;
                default:
                    broken.insert(at, text, random() % text.size(), random() % 12);
                    break;
            }
        }
        const Result<Program> program = parse(broken);
        if (!program) continue;
        // Whatever the text, verify() and print() are safe on it, and what verifies prints back.
        const std::string printed = print(*program);
        if (!verify(*program)) continue;
        const Result<Program> again = parse(printed);
        ASSERT_TRUE(again.ok()) << again.error().message;
        EXPECT_EQ(print(*again), printed);
    }
}

TEST(Builder, BuildsWhatVerifies) {
    Program program;
    program.name = "main";
    program.outputs.push_back({.builtin = Builtin::position});
    Builder builder(program);
    const BlockId entry = builder.newBlock(), header = builder.newBlock(), body = builder.newBlock(),
                  end = builder.newBlock();
    builder.setBlock(entry);
    const ValueId zero = builder.constant(Type::f32, 0), one = builder.constant(Type::f32, 0x3F800000);
    builder.jump(header);
    builder.setBlock(header);
    builder.markLoop(header, end);
    const ValueId less = builder.append(Op::folt, Type::b1, {zero, one}, static_cast<uint64_t>(Type::f32));
    builder.branch(less, body, end);
    builder.setBlock(body);
    builder.jump(header);
    builder.setBlock(end);
    builder.append(Op::storeOutput, Type::none, {one}, 0);
    builder.ret();
    const Status status = verify(program);
    EXPECT_TRUE(status.ok()) << status.error().message;
}

}  // namespace
}  // namespace vernier::ir
