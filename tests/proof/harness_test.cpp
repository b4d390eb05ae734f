// The judge is judged: a program that computes something else is found out, and the corpus leaves something to compare.
#include <gtest/gtest.h>

#include <set>

#include "tests/proof/corpus.h"

namespace vernier::proof {
namespace {

std::vector<std::string> allFiles() {
    std::vector<std::string> files = corpusFiles(".vert");
    const std::vector<std::string> fragments = corpusFiles(".frag");
    files.insert(files.end(), fragments.begin(), fragments.end());
    return files;
}

TEST(Harness, EveryCorpusProgramWritesDifferentValues) {
    for (const std::string& file : allFiles()) {
        const CorpusProgram program = loadCorpusProgram(file);
        const Program lowered = lower(program.subject);
        ASSERT_EQ(lowered.error, "") << file;
        const Shape all = maskShapes(program.subject)[0];
        const Ending ending = runBatch(program.subject, lowered.ir, all, {bestIsa(), MathTier::standard, 64});
        size_t most = 0;
        for (size_t s = 0; s < ending.outputs.size(); ++s) {
            std::set<uint32_t> values;
            for (uint32_t k = 0; k < program.subject.invocations; ++k)
                if (ending.live[k] && (ending.outputs[s][k] & 0x7FFFFFFFu) <= 0x7F800000u)
                    values.insert(ending.outputs[s][k]);
            most = std::max(most, values.size());
        }
        EXPECT_GE(most, 5u) << file;
    }
}

/// What an operation is turned into; integers stay, so that loops that count still end.
ir::Op mutated(ir::Op op) {
    switch (op) {
        case ir::Op::fadd:
            return ir::Op::fsub;
        case ir::Op::fmul:
            return ir::Op::fadd;
        case ir::Op::folt:
            return ir::Op::fole;
        case ir::Op::fmin:
            return ir::Op::fmax;
        default:
            return op;
    }
}

TEST(Harness, EveryComputeProgramChangesItsMemory) {
    for (const std::string& file : corpusFiles(".comp")) {
        const CorpusProgram program = loadCorpusProgram(file);
        const Program lowered = lower(program.subject);
        ASSERT_EQ(lowered.error, "") << file;
        const Ending ending =
            runBatch(program.subject, lowered.ir, maskShapes(program.subject)[0], {bestIsa(), MathTier::standard, 64});
        size_t changed = 0;
        for (const auto& [slot, bytes] : ending.memory->buffers())
            changed += bytes != program.subject.world.bufferContents(slot) ? 1 : 0;
        for (const auto& [slot, image] : ending.memory->images())
            changed += image.texels() != program.subject.world.imageContents(slot).texels() ? 1 : 0;
        EXPECT_GE(changed, 1u) << file;
    }
}

TEST(Harness, MutatedProgramsAreFound) {
    size_t mutants = 0, found = 0;
    for (const char* file : {"julia.frag", "noise_value.frag", "bytecode_vm.frag", "skinning.vert"}) {
        const CorpusProgram program = loadCorpusProgram(file);
        const Program lowered = lower(program.subject);
        const Shape all = maskShapes(program.subject)[0];
        const Ending expected = runReference(program.subject, lowered.ir, all, MathTier::standard);
        size_t each = 0;
        for (size_t b = 0; b < lowered.ir.blocks.size(); ++b) {
            for (size_t i = 0; i < lowered.ir.blocks[b].insts.size(); ++i) {
                ir::Program mutant = lowered.ir;
                ir::Inst& inst = mutant.blocks[b].insts[i];
                if (mutated(inst.op) == inst.op || ++each % 5 != 0) continue;
                inst.op = mutated(inst.op);
                const Ending got = runBatch(program.subject, mutant, all, {bestIsa(), MathTier::standard, 64});
                ++mutants;
                found += compare(mutant, all, expected, got).empty() ? 0 : 1;
            }
        }
    }
    // A comparison of two floats that are never equal, and the like, cannot be found.
    EXPECT_GE(mutants, 20u);
    EXPECT_GE(found * 10, mutants * 7) << found << " of " << mutants;
}

}  // namespace
}  // namespace vernier::proof
