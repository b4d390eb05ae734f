// Small shaders to IR, for the tests of the lowering.
#pragma once

#include <gtest/gtest.h>
#include <vernier/vernier_glsl.h>

#include <string>

#include "spirv_interp/ir/print.h"
#include "spirv_interp/program.h"
#include "tests/spirv_interp/front_support.h"

namespace vernier::test {

class Lowering : public testing::Test {
  protected:
    static void SetUpTestSuite() { vnRetainGlslCompiler(); }
    static void TearDownTestSuite() { vnReleaseGlslCompiler(); }
};

inline ir::Program load(const Words& words, ir::Stage stage, bool contract = false) {
    ShaderSource source;
    source.words = words;
    source.stage = stage;
    source.contract = contract;
    Result<ir::Program> program = loadShader(source);
    EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().message);
    return program.ok() ? *program : ir::Program{};
}

inline ir::Program fragment(const std::string& text, bool debug = false, bool contract = false) {
    return load(compileGlsl(ir::Stage::fragment, "#version 450\n" + text, debug), ir::Stage::fragment, contract);
}

inline ir::Program vertex(const std::string& text) {
    return load(compileGlsl(ir::Stage::vertex, "#version 450\n" + text), ir::Stage::vertex);
}

/// The lines of a program's text that begin with `word`.
inline std::string linesOf(const ir::Program& program, const std::string& word) {
    const std::string text = ir::print(program);
    std::string result;
    for (size_t at = 0; at < text.size();) {
        const size_t end = text.find('\n', at);
        const std::string line = text.substr(at, end - at);
        if (line.starts_with(word)) result += line + "\n";
        at = end + 1;
    }
    return result;
}

}  // namespace vernier::test
