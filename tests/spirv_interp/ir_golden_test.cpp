// The IR before and after every pass, as prints kept in golden/. NAME.ir is a program as the front end lowers it,
// NAME.passes what the passes make of it, one after the other. With VERNIER_WRITE_GOLDEN=1 the prints are written anew.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "spirv_interp/ir/optimise.h"
#include "spirv_interp/ir/parse.h"
#include "spirv_interp/ir/print.h"

namespace vernier {
namespace {

std::string contentsOf(const std::string& path) {
    std::ifstream file(path);
    EXPECT_TRUE(file) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

class IrGolden : public testing::TestWithParam<const char*> {};

TEST_P(IrGolden, PassesPrintWhatTheyDid) {
    const std::string path = std::string(VERNIER_GOLDEN_FOLDER) + "/" + GetParam();
    auto program = ir::parse(contentsOf(path + ".ir"));
    ASSERT_TRUE(program) << program.error().message;
    std::string prints;
    const ir::PassObserver observer = [&](std::string_view pass, const ir::Program& after) {
        prints += "; after " + std::string(pass) + "\n" + ir::print(after) + "\n";
    };
    ir::optimise(*program, {.contract = true, .observer = &observer});
    if (std::getenv("VERNIER_WRITE_GOLDEN") != nullptr) std::ofstream(path + ".passes") << prints;
    EXPECT_EQ(prints, contentsOf(path + ".passes"));
}

INSTANTIATE_TEST_SUITE_P(Programs, IrGolden, testing::Values("branch", "hoist", "light", "scale"),
                         [](const testing::TestParamInfo<const char*>& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace vernier
