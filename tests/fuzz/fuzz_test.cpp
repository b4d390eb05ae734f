// What the fuzzers start from, and a short run of what they do, in every build: the modules of the corpus as they are,
// findings of the past among them, and some hundred changed ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/exercise.h"
#include "tests/fuzz/mutate.h"
#include "tests/proof/proof.h"

namespace vernier::proof {
namespace {

std::vector<std::filesystem::path> corpus() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(VERNIER_FUZZ_CORPUS)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

Words read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    Words words(bytes.size() / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

TEST(Fuzz, TheCorpusRuns) {
    size_t valid = 0;
    for (const auto& file : corpus()) {
        const Words words = read(file);
        exercise(words);
        valid += checkModule(words).ok() ? 1 : 0;
    }
    EXPECT_GE(valid, 6u);
}

// Most changed modules are not valid; the lowering refuses them by itself, or makes something of them that runs.
TEST(Fuzz, InvalidModulesAreRefusedOrLowered) {
    std::mt19937 random(9);
    size_t lowered = 0, refused = 0;
    for (const auto& file : corpus()) {
        const Words words = read(file);
        for (int round = 0; round < 40; ++round) {
            Words changed = words;
            for (int n = 0; n < 3; ++n) mutateModule(changed, random);
            for (const ir::Stage stage : kStages) {
                const Result<ir::Program> program = lowerUnvalidated(changed, stage);
                (program.ok() ? lowered : refused) += 1;
                EXPECT_TRUE(program.ok() || !program.error().message.empty());
            }
        }
    }
    EXPECT_GT(lowered, 20u);
    EXPECT_GT(refused, 20u);
}

TEST(Fuzz, ChangedModulesAreRefusedOrRun) {
    std::mt19937 random(5);
    size_t valid = 0, all = 0;
    for (const auto& file : corpus()) {
        const Words words = read(file);
        for (int round = 0; round < 25; ++round) {
            Words changed = words;
            mutateModule(changed, random);
            exercise(changed);
            ++all;
            valid += checkModule(changed).ok() ? 1 : 0;
        }
    }
    // The mutator has to leave something that gets past validation.
    EXPECT_GE(valid * 10, all);
}

}  // namespace
}  // namespace vernier::proof
