// The sharpest test of the lowering and the passes: what a shader means must not depend on the way it is run. Each
// snippet is run for random inputs as lowered, as optimised, and both again for the module that spirv-opt makes of it.
#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include "spirv_interp/front/lower_module.h"
#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/print.h"
#include "spirv_interp/ir/verify.h"
#include "spirv_interp/program.h"
#include "tests/spirv_interp/front_meaning.h"
#include "tests/spirv_interp/front_snippets.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {
namespace {

/// Builds the compiler's tables once.
class Meaning : public testing::TestWithParam<Snippet> {
  protected:
    static void SetUpTestSuite() { vnRetainGlslCompiler(); }
    static void TearDownTestSuite() { vnReleaseGlslCompiler(); }
};

std::string source(const Snippet& snippet) {
    return std::string(kSnippetPrologue) + snippet.functions + "\nvoid main() {\no = vec4(0); p = ivec4(0);\n" +
           snippet.body + "\n}\n";
}

TEST_P(Meaning, IsTheSameOnEveryWay) {
    const Words plain = compileGlsl(ir::Stage::fragment, source(GetParam()));
    ASSERT_FALSE(plain.empty());
    for (const Words& words : {plain, optimised(plain)}) {
        const bool exact = words == plain;
        ShaderSource shader;
        shader.words = words;
        shader.stage = ir::Stage::fragment;
        const Status valid = checkModule(words);
        ASSERT_TRUE(valid.ok()) << valid.error().message;
        Result<ir::Program> lowered = lowerModule(shader);
        ASSERT_TRUE(lowered.ok()) << lowered.error().message;
        ir::Program better = *lowered;
        ir::optimise(better);
        const Status verified = ir::verify(better);
        ASSERT_TRUE(verified.ok()) << verified.error().message << "\n" << ir::print(better);
        // Optimising again must not break anything, and finds little to do.
        ir::Program again = better;
        ir::optimise(again);
        ASSERT_TRUE(ir::verify(again).ok()) << ir::verify(again).error().message;
        for (uint32_t seed = 0; seed < 60; ++seed) {
            const Ending reference = runReference(words, seed);
            compare(reference, runProgram(*lowered, seed), 2e-5, "lowered, seed " + std::to_string(seed));
            compare(reference, runProgram(better, seed), 2e-5, "optimised, seed " + std::to_string(seed));
            compare(runProgram(*lowered, seed), runProgram(better, seed), 0, "passes, seed " + std::to_string(seed));
            compare(runProgram(better, seed), runProgram(again, seed), 0, "passes again, seed " + std::to_string(seed));
            if (HasFailure()) {
                ADD_FAILURE() << (exact ? "as compiled\n" : "after spirv-opt\n") << ir::print(better);
                return;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Snippets, Meaning, testing::ValuesIn(snippets()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vernier::test
