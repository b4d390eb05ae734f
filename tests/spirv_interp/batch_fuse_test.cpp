// Superinstructions: each is found, and gives the bits of the operations that it stands for.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/ir_evaluator.h"

namespace vernier {
namespace {

/// Operations from %a and %c (i32 rows), %x (an f32 row) and constants to %r; `type` is that of %r.
struct FuseCase {
    const char* op;
    const char* type;
    const char* body;
};

#define DOT_TERMS                                                                                    \
    "%40 i32 = iand A %12\n%41 f32 = stof.i32 %40\n%42 f32 = fmul %13 %41\n%43 f32 = fsub %42 %14\n" \
    "%44 i32 = iand %11 A\n%45 f32 = stof.i32 %44\n%46 f32 = fmul %45 %14\n%47 f32 = fsub %46 %13\n" \
    "%56 i32 = iand A %16\n%57 f32 = stof.i32 %56\n%48 f32 = fmul %57 %13\n%49 f32 = fsub %48 %14\n" \
    "%53 f32 = fabs %2\n%50 f32 = fmul %43 %2\n%51 f32 = fmul %13 %47\n%52 f32 = fmul %49 %53\n"

constexpr FuseCase kCases[] = {
    {"shiftRightAnd", "i32", "%20 i32 = lshr A %10\n%21 i32 = iand %20 %12\n"},
    {"shiftRightXor", "i32", "%20 i32 = lshr A %10\n%21 i32 = ixor %1 %20\n"},
    {"shiftLeftXor", "i32", "%20 i32 = shl A %10\n%21 i32 = ixor %20 %1\n"},
    {"shiftLeftAdd", "i32", "%20 i32 = shl A %10\n%21 i32 = iadd %1 %20\n"},
    {"shiftLeftOr", "i32", "%20 i32 = shl A %10\n%21 i32 = ior %20 %1\n"},
    {"rotateLeft", "i32", "%20 i32 = shl A %10\n%22 i32 = lshr A %11\n%21 i32 = ior %22 %20\n"},
    {"xorShiftRight", "i32", "%20 i32 = lshr A %10\n%21 i32 = ixor A %20\n"},
    {"xorShiftLeft", "i32", "%20 i32 = shl A %10\n%21 i32 = ixor %20 A\n"},
    {"xorShiftMultiply", "i32", "%20 i32 = lshr A %10\n%22 i32 = ixor A %20\n%21 i32 = imul %12 %22\n"},
    {"xorMultiply", "i32", "%20 i32 = ixor A %1\n%21 i32 = imul %12 %20\n"},
    {"xorMultiply", "i32", "%20 i32 = ixor %12 A\n%21 i32 = imul %20 %12\n"},
    {"xor3", "i32", "%20 i32 = ixor A %1\n%21 i32 = ixor %12 %20\n"},
    {"andOr", "i32", "%20 i32 = iand A %12\n%21 i32 = ior %1 %20\n"},
    {"integerMultiplyAdd", "i32", "%20 i32 = imul A %1\n%21 i32 = iadd %20 %12\n"},
    {"convertMultiply", "f32", "%20 f32 = stof.i32 A\n%21 f32 = fmul %13 %20\n"},
    {"convertMultiplyAdd", "f32", "%20 f32 = stof.i32 A\n%22 f32 = fmul %13 %20\n%21 f32 = fadd %2 %22\n"},
    {"convertMultiplySubtract", "f32", "%20 f32 = stof.i32 A\n%22 f32 = fmul %20 %13\n%21 f32 = fsub %22 %14\n"},
    {"convertMultiply", "f32", "%20 i32 = lshr A %10\n%22 f32 = stof.i32 %20\n%21 f32 = fmul %22 %13\n"},
    {"unpackMultiply", "f32", "%20 i32 = iand A %12\n%22 f32 = stof.i32 %20\n%21 f32 = fmul %22 %13\n"},
    {"unpackMultiplyAdd", "f32",
     "%20 i32 = lshr A %10\n%22 i32 = iand %12 %20\n%23 f32 = stof.i32 %22\n%24 f32 = fmul %13 %23\n"
     "%21 f32 = fadd %14 %24\n"},
    {"unpackMultiplySubtract", "f32",
     "%20 i32 = iand A %12\n%23 f32 = stof.i32 %20\n%24 f32 = fmul %13 %23\n%21 f32 = fsub %24 %14\n"},
    // Three fields, the second of another mask and scale, times two rows and a constant, in the orders that there are.
    {"unpackDot3", "f32", DOT_TERMS "%55 f32 = fadd %50 %51\n%21 f32 = fadd %55 %52\n"},
    {"unpackDot3", "f32", DOT_TERMS "%55 f32 = fadd %52 %51\n%21 f32 = fadd %50 %55\n"},
};

/// `chained`: A is what the operation before leaves in the accumulator. `kept`: the result has another reader.
std::string programOf(const FuseCase& c, bool chained, bool kept) {
    std::string body = c.body;
    for (size_t at = body.find('A'); at != std::string::npos; at = body.find('A', at)) {
        body.replace(at, 1, chained ? "%15" : "%0");
    }
    const std::string last = std::string(c.type) == "f32" ? "fneg" : "inot";
    return std::string("program fragment \"main\"\n") +
           "input 0 i32 user 0.0 flat center\ninput 1 i32 user 0.1 flat center\ninput 2 f32 user 0.2 flat center\n" +
           "output 0 " + c.type + " user 0.0\noutput 1 " + c.type + " user 0.1\n" +
           "b0:\n%0 i32 = input #0\n%1 i32 = input #1\n%2 f32 = input #2\n%10 i32 = constant 11\n"
           "%11 i32 = constant 21\n%12 i32 = constant 0x2d51\n%13 f32 = constant 0x3dcccccd\n"
           "%14 f32 = constant 0x3fe00000\n%16 i32 = constant 0x80000ff0\n%15 i32 = imul %0 %1\n" +
           body + "%30 " + c.type + " = " + last + " %21\nstoreOutput #0 %30\n" + (kept ? "storeOutput #1 %21\n" : "") +
           "ret\n";
}

class Superinstruction : public testing::TestWithParam<FuseCase> {};

TEST_P(Superinstruction, GivesTheBitsOfItsParts) {
    std::mt19937 random(3);
    std::vector<std::vector<uint32_t>> inputs(3, std::vector<uint32_t>(64));
    for (auto& slot : inputs)
        for (uint32_t& word : slot) word = random();
    for (uint32_t& word : inputs[2]) word = std::bit_cast<uint32_t>(static_cast<float>(static_cast<int32_t>(word)));
    inputs[0][0] = 0;
    inputs[0][1] = 0x80000000u;
    inputs[0][2] = ~0u;
    for (const bool chained : {false, true}) {
        for (const bool kept : {false, true}) {
            const std::string text = programOf(GetParam(), chained, kept);
            const ir::Program program = test::parseProgram(text);
            const auto compiled = BatchProgram::compile(program, {kLowestIsa, MathTier::standard, 64});
            ASSERT_TRUE(compiled.ok()) << compiled.error().message;
            const std::string listing = (*compiled)->disassemble();
            EXPECT_NE(listing.find(std::string("  ") + GetParam().op + " "), std::string::npos) << text << listing;
            for (const Isa isa : test::isas()) {
                test::RunSetup setup;
                setup.isa = isa;
                for (const uint32_t lanes : {16u, 64u}) {
                    setup.lanes = setup.capacity = lanes;
                    const test::RunResult result = test::runBatch(program, inputs, setup);
                    for (uint32_t lane = 0; lane < std::min(lanes, 16u); ++lane) {
                        const auto expected =
                            test::evaluateInvocation(program, {inputs[0][lane], inputs[1][lane], inputs[2][lane]});
                        EXPECT_EQ(result.outputs[0][lane], expected.outputs[0]) << isaName(isa) << text;
                        if (kept) {
                            EXPECT_EQ(result.outputs[1][lane], expected.outputs[1]) << isaName(isa) << text;
                        }
                    }
                }
            }
        }
    }
}

#undef DOT_TERMS

INSTANTIATE_TEST_SUITE_P(All, Superinstruction, testing::ValuesIn(kCases), [](const auto& instance) {
    return std::string(instance.param.op) + "_" + std::to_string(instance.index);
});

}  // namespace
}  // namespace vernier
