// Random modules by batches and one invocation at a time. A failing seed is made small and printed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include "tests/proof/random_module.h"

namespace vernier::proof {
namespace {

constexpr spv_target_env kEnvironment = SPV_ENV_VULKAN_1_2;

std::string validated(const Words& words) {
    spvtools::SpirvTools tools(kEnvironment);
    std::string message;
    tools.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message += text; });
    return tools.Validate(words) ? "" : "invalid: " + message;
}
std::string disassembled(const Words& words) {
    std::string text;
    spvtools::SpirvTools(kEnvironment).Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES);
    return text;
}

/// After SPIRV-Tools' optimiser: phis, selects and control flow that no generator writes. Its folding of narrow
/// integers makes invalid constants at times; then there is nothing to prove.
Words optimised(const Words& words) {
    spvtools::Optimizer optimizer(kEnvironment);
    optimizer.RegisterPerformancePasses();
    Words result;
    return optimizer.Run(words.data(), words.size(), &result) && validated(result).empty() ? result : words;
}

/// What is wrong with the program; empty: nothing.
std::string findings(const RandomProgram& program, uint64_t seed) {
    Case subject = caseOf(program, seed);
    if (std::string text = validated(subject.words); !text.empty()) return text;
    constexpr uint32_t kLanes[] = {16, 32, 64, 128};
    ProofOptions options;
    options.lanes = {kLanes[seed % 4]};
    options.allShapes = seed % 2 == 0;
    if (seed % 5 == 4) subject.words = optimised(subject.words);
    return differences(subject, options);
}

void prove(uint64_t first, uint64_t count) {
    for (uint64_t seed = first; seed < first + count; ++seed) {
        const RandomProgram program = generateProgram(seed);
        const std::string text = findings(program, seed);
        if (text.empty()) continue;
        // Something of the same sort has to go wrong in the smaller one.
        const std::string sort = text.substr(0, 8);
        const RandomProgram small = shrink(
            program, [&](const RandomProgram& p) { return findings(p, seed).starts_with(sort); }, 400);
        ADD_FAILURE() << "seed " << seed << "\n" << findings(small, seed) << "\n" << disassembled(emitProgram(small));
        if (testing::Test::HasFailure()) return;
    }
}

uint64_t fromEnvironment(const char* name, uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// What the generator is there to write occurs.
TEST(RandomModules, HaveEverySortOfInstruction) {
    std::map<std::string, int> found;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const std::string text = disassembled(emitProgram(generateProgram(seed)));
        for (const char* sort :
             {"OpGroupNonUniformIAdd", "OpGroupNonUniformFMin", "OpGroupNonUniformBallot ", "OpGroupNonUniformAll ",
              "OpTypeInt 8 1", "OpTypeInt 16 0", "OpTypeFloat 16", "OpTypeInt 64 1", "OpTypeFloat 64", "OpImageFetch",
              "OpImageSampleExplicitLod", "OpControlBarrier", "OpSwitch", "OpLoopMerge", "OpKill", "OpFunctionCall"})
            if (text.find(sort) != std::string::npos)
                ++found[sort];
            else
                found.emplace(sort, 0);
    }
    for (const auto& [sort, modules] : found) EXPECT_GE(modules, 3) << sort;
}

TEST(RandomModules, AreTheSameByBatches) {
    prove(0, 200);
}

/// VERNIER_RANDOM_SEED and VERNIER_RANDOM_COUNT choose others.
TEST(RandomModules, DISABLED_ManyAreTheSameByBatches) {
    prove(fromEnvironment("VERNIER_RANDOM_SEED", 1000), fromEnvironment("VERNIER_RANDOM_COUNT", 5000));
}

}  // namespace
}  // namespace vernier::proof
