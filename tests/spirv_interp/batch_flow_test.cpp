// Control flow: hand-written cases, and random structured programs against the plain evaluator, on every
// instruction set, for many lane counts and masks.
#include <random>

#include <gtest/gtest.h>

#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"
#include "tests/spirv_interp/batch_harness.h"
#include "tests/spirv_interp/ir_evaluator.h"
#include "tests/spirv_interp/random_program.h"

namespace vernier {
namespace {

/// One uniform buffer.
struct Uniforms {
    explicit Uniforms(std::vector<uint32_t>& words) {
        buffer = {reinterpret_cast<std::byte*>(words.data()), static_cast<uint32_t>(words.size() * 4)};
        bindings.buffers = &buffer;
        bindings.base = &base;
        bindings.count = &count;
    }
    BufferBinding buffer;
    uint32_t base = 0, count = 1;
    ResourceBindings bindings;
};

void checkAgainstEvaluator(const ir::Program& program, const std::vector<std::vector<uint32_t>>& inputs,
                           std::vector<uint32_t> uniform, const test::RunSetup& given) {
    test::RunSetup setup = given;
    const Uniforms uniforms(uniform);
    setup.bindings = uniforms.bindings;
    const test::RunResult run = test::runBatch(program, inputs, setup);
    ASSERT_TRUE(run.ok);
    for (uint32_t lane = 0; lane < setup.lanes; ++lane) {
        if (!setup.exec.empty() && setup.exec[lane] == 0) {
            ASSERT_EQ(run.live[lane], 0u);
            continue;
        }
        std::vector<uint32_t> own;
        for (const auto& words : inputs) own.push_back(words[lane]);
        const test::Evaluation expected = test::evaluateInvocation(program, own, uniform);
        const bool stored = setup.store.empty() || setup.store[lane] != 0;
        ASSERT_EQ(run.live[lane], stored && !expected.killed && !expected.demoted ? ~0u : 0u) << "lane " << lane;
        if (expected.killed) continue;
        for (uint32_t slot = 0; slot < program.outputs.size(); ++slot) {
            ASSERT_EQ(run.outputs[slot][lane], expected.outputs[slot])
                << "lane " << lane << " output " << slot << " of " << setup.lanes << " lanes on " << isaName(setup.isa);
        }
    }
}

TEST(BatchFlow, RandomStructuredPrograms) {
    uint32_t loops = 0;
    for (uint64_t seed = 1; seed <= 1500; ++seed) {
        const ir::Program program = test::randomProgram(seed);
        const Status status = ir::verify(program);
        ASSERT_TRUE(status.ok()) << status.error().message << "\n" << ir::print(program);
        for (const ir::Block& block : program.blocks) loops += block.loopHeader ? 1 : 0;
        std::mt19937 random(static_cast<uint32_t>(seed));
        test::RunSetup setup;
        setup.capacity = 16u << random() % 3;
        setup.lanes = 4 * (1 + random() % (setup.capacity / 4));
        std::vector<std::vector<uint32_t>> inputs(program.inputs.size(), std::vector<uint32_t>(setup.lanes));
        for (auto& words : inputs) {
            for (uint32_t& word : words) word = random() % 3 == 0 ? random() : random() % 10;
        }
        std::vector<uint32_t> uniform(test::kUniformWords);
        for (uint32_t& word : uniform) word = random() % 6;
        if (seed % 3 == 0) {
            setup.exec.resize(setup.lanes);
            setup.store.resize(setup.lanes);
            for (uint32_t lane = 0; lane < setup.lanes; ++lane) {
                setup.exec[lane] = random() % 4 != 0 ? ~0u : 0u;
                setup.store[lane] = random() % 4 != 0 ? setup.exec[lane] : 0u;
            }
        }
        // Helpers differ from the evaluator's invocations only in what isHelper tells, which these programs
        // do not ask.
        for (const Isa isa : test::isas()) {
            setup.isa = isa;
            checkAgainstEvaluator(program, inputs, uniform, setup);
            if (HasFatalFailure()) {
                FAIL() << "seed " << seed << "\n"
                       << ir::print(program)
                       << (*BatchProgram::compile(program, {isa, MathTier::standard, setup.capacity}))->disassemble();
            }
        }
    }
    EXPECT_GT(loops, 1000u);
}

std::vector<std::vector<uint32_t>> ramp(uint32_t inputs, uint32_t lanes) {
    std::vector<std::vector<uint32_t>> words(inputs, std::vector<uint32_t>(lanes));
    for (uint32_t k = 0; k < inputs; ++k) {
        for (uint32_t lane = 0; lane < lanes; ++lane) words[k][lane] = lane * (k + 1) + k;
    }
    return words;
}

TEST(BatchFlow, PhisThatTradePlaces) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
output 1 i32 user 0.1
output 2 i32 user 0.2
b0:
  %0 i32 = input #0
  %1 i32 = constant 0
  %2 i32 = constant 1
  %3 i32 = constant 2
  jump b1
b1 loop b3 <- b0 b2:
  %4 i32 = phi %1 %8
  %5 i32 = phi %1 %6
  %6 i32 = phi %2 %7
  %7 i32 = phi %3 %5
  %9 b1 = slt.i32 %4 %0
  branch %9 b2 b3
b2 <- b1:
  %8 i32 = iadd %4 %2
  jump b1
b3 <- b1:
  %10 i32 = phi %5
  %11 i32 = phi %6
  %12 i32 = phi %7
  storeOutput #0 %10
  storeOutput #1 %11
  storeOutput #2 %12
  ret
)");
    for (const Isa isa : test::isas()) {
        for (uint32_t lanes = 4; lanes <= 64; lanes += 4) {
            test::RunSetup setup;
            setup.isa = isa;
            setup.lanes = lanes;
            const test::RunResult run = test::runBatch(program, ramp(1, lanes), setup);
            for (uint32_t lane = 0; lane < lanes; ++lane) {
                for (uint32_t k = 0; k < 3; ++k) ASSERT_EQ(run.outputs[k][lane], (lane + k) % 3);
            }
        }
    }
}

TEST(BatchFlow, LanesKilledInALoopAreNotLive) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = constant 0
  %2 i32 = constant 1
  %3 i32 = constant 20
  jump b1
b1 loop b5 <- b0 b4:
  %4 i32 = phi %1 %5
  %6 b1 = slt.i32 %4 %0
  branch %6 b2 b5
b2 <- b1:
  %7 b1 = ieq.i32 %4 %3
  branch %7 b3 b4
b3 <- b2:
  kill
b4 <- b2:
  %5 i32 = iadd %4 %2
  jump b1
b5 <- b1:
  %8 i32 = phi %4
  storeOutput #0 %8
  ret
)");
    for (const Isa isa : test::isas()) {
        test::RunSetup setup;
        setup.isa = isa;
        const test::RunResult run = test::runBatch(program, ramp(1, 64), setup);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            EXPECT_EQ(run.live[lane], lane <= 20 ? ~0u : 0u) << lane;
            if (lane > 20) continue;
            EXPECT_EQ(run.outputs[0][lane], lane);
        }
    }
}

TEST(BatchFlow, LanesThatWaitInALoopAreNotLeftBehind) {
    // Every other lane leaves the loop in the first round, through the loop's last block.
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = constant 0
  %2 i32 = constant 1
  %3 i32 = iand %0 %2
  %4 b1 = ieq.i32 %3 %1
  jump b1
b1 loop b4 <- b0 b2:
  %5 i32 = phi %1 %6
  branch %4 b2 b3
b2 <- b1:
  %6 i32 = iadd %5 %2
  %7 b1 = slt.i32 %6 %0
  branch %7 b1 b4
b3 <- b1:
  %8 i32 = iadd %0 %0
  jump b4
b4 <- b2 b3:
  %9 i32 = phi %6 %8
  storeOutput #0 %9
  ret
)");
    for (const Isa isa : test::isas()) {
        test::RunSetup setup;
        setup.isa = isa;
        const test::RunResult run = test::runBatch(program, ramp(1, 64), setup);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t expected = lane % 2 != 0 ? 2 * lane : std::max(lane, 1u);
            EXPECT_EQ(run.outputs[0][lane], expected) << lane;
        }
    }
}

TEST(BatchFlow, DemotedLanesRunOnAsHelpers) {
    const ir::Program program = test::parseProgram(R"(program fragment "main"
input 0 i32 user 0.0 flat center
output 0 i32 user 0.0
b0:
  %0 i32 = input #0
  %1 i32 = constant 1
  %2 i32 = iand %0 %1
  %3 b1 = ieq.i32 %2 %1
  branch %3 b1 b2
b1 <- b0:
  demote
  jump b2
b2 <- b0 b1:
  %4 b1 = isHelper
  %5 i32 = zext.b1 %4
  storeOutput #0 %5
  ret
)");
    for (const Isa isa : test::isas()) {
        test::RunSetup setup;
        setup.isa = isa;
        setup.store.assign(64, ~0u);
        setup.store[6] = 0;  // a helper from the start
        const test::RunResult run = test::runBatch(program, ramp(1, 64), setup);
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const bool helper = lane % 2 == 1 || lane == 6;
            EXPECT_EQ(run.live[lane], helper ? 0u : ~0u);
            EXPECT_EQ(run.outputs[0][lane], helper ? 1u : 0u);
        }
    }
}

TEST(BatchFlow, EndlessLoopLosesTheDevice) {
    const ir::Program program = test::parseProgram(R"(program compute "main"
b0:
  jump b1
b1 loop b2 <- b0 b1:
  jump b1
)");
    for (const Isa isa : test::isas()) {
        test::RunSetup setup;
        setup.isa = isa;
        EXPECT_FALSE(test::runBatch(program, {}, setup).ok);
    }
}

TEST(BatchFlow, OptionsAreChecked) {
    const ir::Program program = test::parseProgram("program vertex \"main\"\nb0:\n  ret\n");
    const auto wrong = BatchProgram::compile(program, {kLowestIsa, MathTier::standard, 48});
    ASSERT_FALSE(wrong.ok());
    EXPECT_NE(wrong.error().message.find("48"), std::string::npos);
    ir::Program broken = program;
    broken.blocks[0].insts.clear();
    EXPECT_FALSE(BatchProgram::compile(broken, {}).ok());
}

}  // namespace
}  // namespace vernier
