// The verifier: one broken program per invariant, each refused with its message.
#include <gtest/gtest.h>

#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/verify.h"

namespace vernier::ir {
namespace {

constexpr const char* kHead = R"(program fragment "t"
input 0 f32 user 0.0 smooth center
output 0 f32 user 0.0
resource 0 storageBuffer 0.0 x1
resource 1 uniformBuffer 0.1 x1 read
resource 2 combinedImageSampler 0.2 x1 read
imageOp 0 sampleImplicit d2 image 2 sampler 2 coords 2
local 4
)";

struct Case {
    const char* body;
    const char* message;  // without "IR of 't': "; empty = it verifies
};

const Case kCases[] = {
    {"b0:\n  ret\n", ""},
    {"b0:\n  %0 f32 = input #0\n  storeOutput #0 %0\n  ret\n", ""},
    {"", "no blocks"},
    {"b0:\n", "block 0: no instructions"},
    {"b0:\n  %0 f32 = undef\n", "block 0: undef (instruction 0): the last instruction is no terminator"},
    {"b0:\n  ret\n  ret\n", "block 0: ret (instruction 0): a terminator inside a block"},
    {"b0:\n  jump b1\nb1 <- b0:\n  %0 f32 = undef\n  %1 f32 = phi %0\n  ret\n",
     "block 1: phi (instruction 1): phis come first in a block"},
    {"b0:\n  jump\n", "block 0: 0 successors, the terminator wants 1"},
    {"b0:\n  jump b7\n", "block 0: a successor does not exist"},
    {"b0:\n  jump b1\nb1 <- b0 b9:\n  ret\n", "block 1: a predecessor does not exist"},
    {"b0:\n  jump b1\nb1:\n  ret\n", "block 0: the edges to block 1 are not its predecessors"},
    {"b0:\n  ret\nb1 <- b0:\n  ret\n", "block 1: predecessor 0 does not go there"},
    {"b0 loop b1 <- b0:\n  jump b0\n", "block 0: the entry has predecessors"},
    {"b0:\n  ret\nb1:\n  ret\n", "block 1: unreachable"},
    {"b0:\n  jump b1\nb1 <- b0 b1:\n  jump b1\n", "block 1: a back edge to a block that is no loop header"},
    {"b0:\n  jump b1\nb1 loop b2 <- b0 b2:\n  jump b2\nb2 <- b1:\n  jump b1\n",
     "block 1: a back edge from outside the loop"},
    {"b0:\n  jump b1\nb1 loop b9 <- b0 b1:\n  jump b1\n", "block 1: the loop ends before it begins"},
    {"b0:\n  jump b1\nb1 loop b3 <- b0 b2:\n  jump b2\nb2 loop b4 <- b1 b3:\n  %0 b1 = constant 0x0\n  branch %0 b1 "
     "b3\n"
     "b3 <- b2:\n  jump b2\n",
     "block 2: the loop reaches out of the loop around it"},
    {"b0:\n  %0 b1 = constant 0x0\n  branch %0 b1 b2\nb1 loop b3 <- b0 b2:\n  jump b2\nb2 <- b0 b1:\n  jump b1\n",
     "block 2: an edge into the middle of a loop"},
    {"b0:\n  %0 f32 = undef\n  %0 f32 = undef\n  ret\n", "block 0: undef (instruction 1): value %0 is defined twice"},
    {"b0:\n  storeOutput #0 %0\n  %0 f32 = undef\n  ret\n",
     "block 0: storeOutput (instruction 0): the definition of %0 does not dominate the use"},
    {"b0:\n  storeOutput #0 %5\n  ret\n",
     "block 0: storeOutput (instruction 0): an operand is no value of the program"},
    {"b0:\n  %0 b1 = constant 0x0\n  branch %0 b1 b2\nb1 <- b0:\n  %1 f32 = undef\n  jump b2\nb2 <- b0 b1:\n"
     "  storeOutput #0 %1\n  ret\n",
     "block 2: storeOutput (instruction 0): the definition of %1 does not dominate the use"},
    {"b0:\n  jump b1\nb1 loop b2 <- b0 b1:\n  %0 f32 = input #0\n  %1 b1 = folt.f32 %0 %0\n  branch %1 b1 b2\n"
     "b2 <- b1:\n  storeOutput #0 %0\n  ret\n",
     "block 2: storeOutput (instruction 0): %0 is defined in a loop and used outside it without a phi"},
    {"b0:\n  jump b1\nb1 loop b2 <- b0 b1:\n  %0 f32 = input #0\n  %1 b1 = folt.f32 %0 %0\n  branch %1 b1 b2\n"
     "b2 <- b1:\n  %2 f32 = phi %0\n  storeOutput #0 %2\n  ret\n",
     ""},
    {"b0:\n  %0 f32 = undef\n  %1 f32 = fadd %0\n  ret\n", "block 0: fadd (instruction 1): 1 operands instead of 2"},
    {"b0:\n  %0 f32 = undef\n  %1 f32 = undef\n  jump b1\nb1 <- b0:\n  %2 f32 = phi %0 %1\n  ret\n",
     "block 1: phi (instruction 0): 2 operands instead of 1"},
    {"b0:\n  %0 i32 = undef\n  %1 f32 = fneg %0\n  ret\n", "block 0: fneg (instruction 1): operand %0 has type i32"},
    {"b0:\n  %0 i32 = undef\n  %1 i32 = fneg %0\n  ret\n", "block 0: fneg (instruction 1): a result of type i32"},
    {"b0:\n  %0 i32 = undef\n  %1 b1 = folt.i32 %0 %0\n  ret\n",
     "block 0: folt (instruction 1): the operand type is not a float"},
    {"b0:\n  %0 f32 = undef\n  %1 i64 = bitcast.f32 %0\n  ret\n",
     "block 0: bitcast (instruction 1): the widths differ"},
    {"b0:\n  %0 b1 = constant 0x1\n  ret\n",
     "block 0: constant (instruction 0): a boolean constant that is neither all zeros nor all ones"},
    {"b0:\n  %0 f32 = constant 0x100000000\n  ret\n",
     "block 0: constant (instruction 0): a 32-bit constant with more bits"},
    {"b0:\n  %0 f32 = input #1\n  ret\n", "block 0: input (instruction 0): an input that does not exist"},
    {"b0:\n  %0 i32 = input #0\n  ret\n", "block 0: input (instruction 0): the input has another type"},
    {"b0:\n  %0 f32 = undef\n  storeOutput #1 %0\n  ret\n",
     "block 0: storeOutput (instruction 1): an output that does not exist"},
    {"b0:\n  %0 i32 = undef\n  %1 f32 = inputIndexed #0:2 %0\n  ret\n",
     "block 0: inputIndexed (instruction 1): inputs that do not exist"},
    {"b0:\n  %0 i32 = undef\n  %1 f32 = loadBuffer #3 %0 %0\n  ret\n",
     "block 0: loadBuffer (instruction 1): a resource that does not exist"},
    {"b0:\n  %0 i32 = undef\n  %1 f32 = loadBuffer #2 %0 %0\n  ret\n",
     "block 0: loadBuffer (instruction 1): the resource is no buffer"},
    {"b0:\n  %0 i32 = undef\n  storeBuffer #1 %0 %0 %0\n  ret\n",
     "block 0: storeBuffer (instruction 1): a store to a buffer that cannot be written"},
    {"b0:\n  %0 i32 = undef\n  %1 i32 = atomicBuffer #0:99 %0 %0 %0\n  ret\n",
     "block 0: atomicBuffer (instruction 1): an unknown atomic operation"},
    {"b0:\n  %0 i32 = undef\n  %1 i32 = loadLocal #2:3 %0\n  ret\n",
     "block 0: loadLocal (instruction 1): outside the local memory"},
    {"b0:\n  %0 i32 = undef\n  %1..%4 f32 = image #0 %0 %0 %0\n  ret\n",
     "block 0: image (instruction 1): operand %0 has type i32"},
    {"b0:\n  %0 i32 = undef\n  imageStore #0 %0 %0 %0\n  ret\n",
     "block 0: imageStore (instruction 1): the kind of image operation does not fit"},
    {"b0:\n  %0 i32 = undef\n  %1 b1 = undef\n  branch %0 b1 b1\nb1 <- b0 b0:\n  ret\n",
     "block 0: branch (instruction 2): operand %0 has type i32"},
};

TEST(Verify, EveryInvariant) {
    for (const Case& c : kCases) {
        const Result<Program> program = parse(std::string(kHead) + c.body);
        ASSERT_TRUE(program.ok()) << program.error().message << "\n" << c.body;
        const Status status = verify(*program);
        const std::string wanted = *c.message == '\0' ? "" : std::string("IR of 't': ") + c.message;
        EXPECT_EQ(status.ok() ? "" : status.error().message, wanted) << c.body;
    }
}

TEST(Verify, Tables) {
    const std::pair<const char*, const char*> cases[] = {
        {"input 0 f64 user 0.0 smooth center\n", "IR of '': input slot of type f64"},
        {"output 0 i64 user 0.0\n", "IR of '': output slot of type i64"},
        {"imageOp 0 fetch d2 image 0 coords 2\n", "IR of '': image operation 0 names a resource that does not exist"},
        {"resource 0 sampledImage 0.0 x1\nimageOp 0 fetch d2 image 0 coords 9\n",
         "IR of '': image operation 0 has too many coordinates, gradients or offsets"},
    };
    for (const auto& [text, message] : cases) {
        const Result<Program> program = parse(text);
        ASSERT_TRUE(program.ok()) << program.error().message;
        ASSERT_FALSE(verify(*program).ok());
        EXPECT_EQ(verify(*program).error().message, message);
    }
}

}  // namespace
}  // namespace vernier::ir
